//! Held poses: signs of a hand that are recognised by the pose that is held, not by the motion that leads to it.
//!
//! A template says how a motion goes; a sign that is held for a second goes nowhere, and standing still is near it by definition.
//! Each tick's pose is compared with poses of the held classes and with poses of anything else, and a class whose poses stay the
//! nearest for long enough is reported when the pose is left.

use crate::classes::ClassId;
use crate::decode::TickDetection;
use crate::features::{RowLayout, Rows};

use super::early::OngoingMatch;
use super::reference::separation;
use super::verifier::squared_distance;
use super::{Metric, ReferenceRows};

/// Poses that are looked at for one distance.
const NEIGHBOURS: usize = 3;
/// Ticks over which distances are averaged: a third of a second.
const WINDOW: usize = 9;
/// A pose that is lost for no more ticks than this goes on.
const PAUSE: usize = 6;

/// Poses of held classes and of anything else, before the metric.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldPoses {
    /// The poses: directions of rows, `3 b` values.
    pub poses: ReferenceRows,
    /// Poses farther than this from those of a class do not belong to it.
    pub reach: f32,
    /// Ticks for which a pose must be held.
    pub least_ticks: usize,
}

impl HeldPoses {
    /// Checks that all parts fit together, for rows of `layout` and `classes` classes.
    ///
    /// # Errors
    /// A sentence about the first part that does not fit.
    pub fn check(&self, layout: RowLayout, classes: usize) -> Result<(), String> {
        let dim = layout.directions().len();
        self.poses.check("held poses", dim, classes)?;
        if self.reach.is_nan() || self.reach <= 0.0 {
            return Err(format!(
                "the reach of held poses must be above 0, found {}",
                self.reach
            ));
        }
        Ok(())
    }

    /// The part for rows that keep the columns `keep` of rows of `layout`.
    pub(super) fn restricted(&self, layout: RowLayout, keep: &[usize]) -> Self {
        let directions = layout.directions();
        let kept: Vec<usize> = (keep.iter().copied())
            .filter(|column| directions.contains(column))
            .collect();
        Self {
            poses: self.poses.restricted(&kept),
            ..self.clone()
        }
    }
}

/// The mean of the smallest few of some values, one after the other.
#[derive(Debug, Clone, Copy)]
struct NearestFew {
    values: [f32; NEIGHBOURS],
    count: usize,
}

impl NearestFew {
    const NONE: Self = Self {
        values: [f32::INFINITY; NEIGHBOURS],
        count: 0,
    };

    fn take(&mut self, value: f32) {
        self.count += 1;
        let mut value = value;
        for kept in &mut self.values {
            if value < *kept {
                std::mem::swap(kept, &mut value);
            }
        }
    }

    /// Infinite where there was none.
    fn mean(&self) -> f32 {
        let count = self.count.min(NEIGHBOURS);
        match count {
            0 => f32::INFINITY,
            _ => self.values[..count].iter().sum::<f32>() / count as f32,
        }
    }
}

/// Distance of `pose` from the nearest few of `poses`, all mapped; those that `counts` leaves out do not count.
pub(crate) fn distance_from(pose: &[f32], poses: &Rows, counts: impl Fn(usize) -> bool) -> f32 {
    let mut nearest = NearestFew::NONE;
    for (_, other) in poses.iter().enumerate().filter(|(n, _)| counts(*n)) {
        nearest.take(apart(pose, other));
    }
    nearest.mean()
}

fn apart(a: &[f32], b: &[f32]) -> f32 {
    squared_distance(a, b).sqrt()
}

/// A pose that is being held.
#[derive(Debug, Clone, Copy)]
struct Hold {
    class: usize,
    start: i64,
    /// The last tick at which it was seen.
    last: i64,
    /// Sum of the shares of the distance from anything else.
    shares: f64,
    ticks: usize,
}

impl Hold {
    /// Mean share of the distance from anything else.
    fn share(&self) -> f64 {
        self.shares / self.ticks as f64
    }
}

/// Recognises held poses in a stream of rows.
#[derive(Debug, Clone)]
pub(super) struct HoldDetector {
    metric: Metric,
    poses: Rows,
    /// Number of each pose's class among `classes`.
    of_class: Vec<usize>,
    classes: Vec<ClassId>,
    others: Rows,
    reach: f32,
    least_ticks: usize,
    mapped: Vec<f32>,
    nearest: Vec<NearestFew>,
    /// Distances of the last ticks from each class and, last, from anything else.
    recent: Vec<[f32; WINDOW]>,
    ticks: i64,
    hold: Option<Hold>,
    found: Option<TickDetection>,
}

impl HoldDetector {
    pub fn new(held: &HeldPoses) -> Self {
        let metric = held.poses.metric();
        let (classes, of_class) = held.poses.numbered();
        Self {
            poses: metric.apply_all(&held.poses.rows),
            others: metric.apply_all(&held.poses.others),
            of_class,
            mapped: vec![0.0; metric.dim()],
            nearest: vec![NearestFew::NONE; classes.len()],
            recent: vec![[0.0; WINDOW]; classes.len() + 1],
            classes,
            reach: held.reach,
            least_ticks: held.least_ticks,
            metric,
            ticks: 0,
            hold: None,
            found: None,
        }
    }

    /// The pose whose hold ended with the last tick.
    pub fn found(&self) -> Option<&TickDetection> {
        self.found.as_ref()
    }

    /// The pose that has been held long enough and still is; its distance is that of the report's score as a share of `farthest`.
    pub fn underway(&self, farthest: f32) -> Option<OngoingMatch> {
        let hold = self.hold.filter(|hold| self.is_long(hold))?;
        let age = (self.ticks - 1 - hold.start) as usize;
        Some(OngoingMatch {
            class: self.classes[hold.class],
            distance: (hold.share() / 2.0) as f32 * farthest,
            // It ends when it is left, whenever that is.
            progress: 0.5,
            pace: 1.0,
            age,
            goes_on: false,
            repetitions: None,
            whole: None,
        })
    }

    pub fn reset(&mut self) {
        self.ticks = 0;
        self.hold = None;
    }

    /// Takes the next row. O(poses · values), no allocation.
    pub fn push(&mut self, row: &[f32]) {
        self.found = None;
        let dim = self.metric.dim();
        self.metric.apply(&row[..dim], &mut self.mapped);
        self.nearest.fill(NearestFew::NONE);
        for (pose, class) in self.poses.iter().zip(&self.of_class) {
            self.nearest[*class].take(apart(&self.mapped, pose));
        }
        let others = distance_from(&self.mapped, &self.others, |_| true);
        let distances = self.nearest.iter().map(NearestFew::mean);
        let slot = self.ticks as usize % WINDOW;
        for (recent, distance) in self.recent.iter_mut().zip(distances.chain([others])) {
            recent[slot] = distance;
        }
        self.ticks += 1;
        if self.ticks >= WINDOW as i64 {
            self.decide();
        }
    }

    /// Ends the stretch: a pose that is still held counts.
    pub fn finish(&mut self) {
        self.found = None;
        self.end_hold();
        self.reset();
    }

    /// Looks at the tick in the middle of the window.
    fn decide(&mut self) {
        let tick = self.ticks - 1 - WINDOW as i64 / 2;
        let mean = |recent: &[f32; WINDOW]| recent.iter().sum::<f32>() / WINDOW as f32;
        let others = mean(&self.recent[self.classes.len()]);
        let nearest = (0..self.classes.len())
            .map(|class| (mean(&self.recent[class]), class))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|(distance, _)| *distance < others.min(self.reach));
        match (nearest, &mut self.hold) {
            (Some((distance, class)), Some(hold)) if hold.class == class => {
                hold.last = tick;
                hold.shares += f64::from(distance / others);
                hold.ticks += 1;
            }
            (None, Some(hold)) if tick - hold.last <= PAUSE as i64 => {}
            (nearest, _) => {
                self.end_hold();
                self.hold = nearest.map(|(distance, class)| Hold {
                    class,
                    start: tick,
                    last: tick,
                    shares: f64::from(distance / others),
                    ticks: 1,
                });
            }
        }
    }

    fn is_long(&self, hold: &Hold) -> bool {
        hold.last + 1 - hold.start >= self.least_ticks as i64
    }

    fn end_hold(&mut self) {
        let hold = self.hold.take().filter(|hold| self.is_long(hold));
        self.found = hold.map(|hold| {
            let share = hold.share();
            TickDetection {
                class: self.classes[hold.class],
                start: hold.start,
                stop: hold.last + 1,
                // Halfway where anything else was as near.
                score: 1.0 - share / 2.0,
                separation: separation(share),
                rest_share: 0.0,
                repetitions: None,
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::templates::PackedSymmetric;
    use nalgebra::DMatrix;

    fn held() -> HeldPoses {
        let eye = PackedSymmetric::pack(&DMatrix::identity(3, 3));
        let poses = ReferenceRows {
            rows: Rows::from_values(3, vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
            classes: vec![ClassId(4), ClassId(7)],
            others: Rows::from_values(3, vec![0.0, 0.0, 1.0]),
            ridged: eye.clone(),
            total: eye,
        };
        HeldPoses {
            poses,
            reach: 0.8,
            least_ticks: 20,
        }
    }

    fn found(poses: &[([f32; 3], usize)]) -> Vec<TickDetection> {
        let mut detector = HoldDetector::new(&held());
        let mut all = Vec::new();
        for (pose, ticks) in poses {
            for _ in 0..*ticks {
                detector.push(pose);
                all.extend(detector.found().copied());
            }
        }
        detector.finish();
        all.extend(detector.found().copied());
        all
    }

    const A: [f32; 3] = [1.0, 0.1, 0.0];
    const B: [f32; 3] = [0.0, 0.9, 0.1];
    const OTHER: [f32; 3] = [0.0, 0.1, 0.9];

    #[test]
    fn a_pose_that_is_held_is_one_event() {
        let events = found(&[(OTHER, 40), (A, 60), (OTHER, 40), (B, 30)]);
        let classes: Vec<u16> = events.iter().map(|event| event.class.0).collect();
        assert_eq!(classes, [4, 7], "{events:?}");
        assert!((events[0].start - 40).abs() <= 3 && (events[0].stop - 100).abs() <= 3);
        assert!(events.iter().all(|e| e.score > 0.5 && e.score <= 1.0));
    }

    #[test]
    fn what_passes_or_is_unlike_all_is_none_and_a_moments_loss_does_not_matter() {
        assert!(found(&[(OTHER, 40), (A, 12), (OTHER, 40)]).is_empty());
        let far = [-3.0, 0.0, 0.0];
        assert!(found(&[(far, 100)]).is_empty(), "beyond reach");
        assert_eq!(
            found(&[(OTHER, 40), (A, 30), (OTHER, 3), (A, 30), (OTHER, 40)]).len(),
            1
        );
    }
}
