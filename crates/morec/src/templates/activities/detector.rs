//! Activities in a stream of rows.

use std::sync::Arc;

use crate::classes::ClassId;
use crate::decode::TickDetection;
use crate::features::{RowLayout, Rows};
use crate::math::portable;

use super::repetitions::RepetitionCounter;
use super::windows::{STEP_TICKS, SlidingWindow, windows_of};
use super::{Activities, LEAST_WINDOWS};
use crate::templates::early::OngoingMatch;
use crate::templates::kernel::{self, LANES, Lanes};
use crate::templates::reference::separation;
use crate::templates::{Calibration, Metric};

/// Cost of a change of class on the path: three logarithms of distances' ratios; a window is looked at ten times a second.
const CHANGE_COST: f64 = 3.0;
/// Windows after the one that is decided.
const LAG: usize = 5;
/// Squared distances count as at least this: a sample that is seen again is not infinitely near.
const LEAST_DISTANCE: f32 = 1e-6;

/// Recognises activities in a stream of rows.
#[derive(Debug, Clone)]
pub(in crate::templates) struct ActivityDetector {
    metric: Metric,
    means: WindowTable,
    /// Number of each mean's class among `classes`.
    of_class: Vec<usize>,
    classes: Vec<ClassId>,
    others: WindowTable,
    share: f32,
    window: SlidingWindow,
    half: usize,
    statistics: Vec<f32>,
    mapped: Vec<f32>,
    ticks: usize,
    path: BestPath,
    run: Option<ActivityRun>,
    counter: RepetitionCounter,
    /// Makes scores probabilities.
    calibration: Option<Calibration>,
    found: Vec<TickDetection>,
}

/// An activity that goes on.
#[derive(Debug, Clone, Copy)]
struct ActivityRun {
    class: usize,
    /// Its first window, and the number of its windows.
    first: usize,
    count: usize,
    /// Sum of the windows' shares of the distance from anything else.
    shares: f64,
}

impl ActivityRun {
    fn share(&self) -> f64 {
        (self.shares / self.count as f64).min(1.0)
    }

    /// One past its last tick so far, in a stretch of `ticks`.
    fn stop(&self, ticks: usize) -> usize {
        ((self.first + self.count) * STEP_TICKS).min(ticks)
    }
}

impl Activities {
    /// For each activity, the mean of the distances of the windows of `rows` from it, as shares of those from anything else.
    /// O(windows · windows of anything else · statistics).
    pub fn shares(&self, layout: RowLayout, rows: &Rows) -> Vec<(ClassId, f64)> {
        let mut detector = ActivityDetector::new(self, layout, 1.0);
        let windows = windows_of(rows, layout, self.window_ticks);
        let mut sums = vec![0.0; detector.classes.len()];
        for window in windows.iter() {
            detector.statistics.copy_from_slice(window);
            detector.compare();
            for (class, sum) in sums.iter_mut().enumerate() {
                *sum += detector.path.share(0, class);
            }
        }
        let means = sums.iter().map(|sum| sum / windows.len().max(1) as f64);
        detector.classes.into_iter().zip(means).collect()
    }
}

impl ActivityDetector {
    /// Of rows of `layout`, `tick_hz` a second.
    pub fn new(activities: &Activities, layout: RowLayout, tick_hz: f64) -> Self {
        let windows = &activities.windows;
        let metric = windows.metric();
        let (classes, of_class) = windows.numbered();
        let half = activities.window_ticks / 2;
        Self {
            means: WindowTable::new(&metric.apply_all(&windows.rows)),
            others: WindowTable::new(&metric.apply_all(&windows.others)),
            of_class,
            share: activities.share,
            window: SlidingWindow::new(layout, 2 * half + 1),
            half,
            statistics: vec![0.0; metric.dim()],
            mapped: vec![0.0; metric.dim()],
            ticks: 0,
            path: BestPath::new(classes.len()),
            classes,
            metric,
            calibration: None,
            run: None,
            counter: RepetitionCounter::new(layout.dim(), tick_hz),
            // What can end at once: each activity lasts some windows, and at the end of a stream half a window and the lag are due.
            found: Vec::with_capacity(1 + (half / STEP_TICKS + LAG) / LEAST_WINDOWS + 1),
        }
    }

    /// The same with scores that are probabilities.
    pub fn calibrated(self, calibration: Option<Calibration>) -> Self {
        Self {
            calibration,
            ..self
        }
    }

    /// The activities that ended with the last tick.
    pub fn found(&self) -> &[TickDetection] {
        &self.found
    }

    /// The activity that goes on, if it has gone on long enough; its distance is that of the report's score as a share of `farthest`.
    pub fn underway(&self, farthest: f32) -> Option<OngoingMatch> {
        let run = self.run.filter(|run| run.count >= LEAST_WINDOWS)?;
        let undecided = self.ticks - run.stop(self.ticks);
        let whole = self.counter.whole();
        Some(OngoingMatch {
            class: self.classes[run.class],
            distance: (run.share() / 2.0) as f32 * farthest,
            // It ends when it is left, whenever that is.
            progress: 0.5,
            pace: 1.0,
            age: self.ticks - 1 - run.first * STEP_TICKS,
            goes_on: true,
            repetitions: self.counter.repetitions(undecided),
            whole: whole.map(|(count, ticks)| (count, undecided as f64 + ticks)),
        })
    }

    pub fn reset(&mut self) {
        self.window.clear();
        self.path.clear();
        self.counter.clear();
        self.ticks = 0;
        self.run = None;
    }

    /// Takes the next row. At every third, O(windows of anything else · statistics); no allocation.
    pub fn push(&mut self, row: &[f32]) {
        self.found.clear();
        self.window.push(row);
        self.counter.push(row);
        self.ticks += 1;
        let centre = (self.ticks - 1).checked_sub(self.half);
        if centre.is_some_and(|centre| centre.is_multiple_of(STEP_TICKS)) {
            self.look();
            if self.path.len() > LAG {
                self.decide(self.path.len() - 1 - LAG);
            }
        }
    }

    /// Ends the stretch: windows about its last rows are cut off, and an activity that goes on counts.
    pub fn finish(&mut self) {
        self.found.clear();
        let decided = self.path.len().saturating_sub(LAG);
        while self.path.len() * STEP_TICKS < self.ticks {
            let centre = self.path.len() * STEP_TICKS;
            self.window.drop_before(centre.saturating_sub(self.half));
            self.look();
            if self.path.len() > LAG {
                self.decide(self.path.len() - 1 - LAG);
            }
        }
        let first_open = decided.max(self.path.len().saturating_sub(LAG));
        for window in first_open..self.path.len() {
            self.decide(window);
        }
        self.end_run();
        self.reset();
    }

    /// Compares the window with all classes and takes the path one step further.
    fn look(&mut self) {
        self.window.write(&mut self.statistics);
        self.compare();
        self.path.take_step();
    }

    /// Compares the statistics with those of all classes and of anything else.
    fn compare(&mut self) {
        self.metric.apply(&self.statistics, &mut self.mapped);
        let others = self.others.squared_distances(&self.mapped).iter();
        let nearest = others.copied().fold(f32::INFINITY, f32::min);
        let bound = (self.share * self.share * nearest).max(LEAST_DISTANCE);
        let distances = self.path.begin_step(bound);
        let of_means = self.means.squared_distances(&self.mapped);
        for (distance, class) in of_means.iter().zip(&self.of_class) {
            distances[*class] = distances[*class].min(distance.max(LEAST_DISTANCE));
        }
    }

    /// Takes the class of `window` on the best path so far.
    fn decide(&mut self, window: usize) {
        let class = self.path.class_at(window);
        match (class, &mut self.run) {
            (Some(class), Some(run)) if run.class == class => {
                run.count += 1;
                run.shares += self.path.share(window, class);
            }
            _ => {
                self.end_run();
                self.run = class.map(|class| ActivityRun {
                    class,
                    first: window,
                    count: 1,
                    shares: self.path.share(window, class),
                });
                self.counter.begin(window * STEP_TICKS);
            }
        }
        if let Some(run) = &self.run {
            self.counter.advance(run.stop(self.ticks));
        }
    }

    /// Halfway where anything else was as near, or the probability that it is right.
    fn score(&self, share: f64) -> f64 {
        let margin = 1.0 - share / 2.0;
        self.calibration.map_or(margin, |calibration| {
            calibration.probability(margin, separation(share), 0.0)
        })
    }

    fn end_run(&mut self) {
        let run = self.run.take().filter(|run| run.count >= LEAST_WINDOWS);
        self.found.extend(run.map(|run| {
            let share = run.share();
            TickDetection {
                class: self.classes[run.class],
                start: (run.first * STEP_TICKS) as i64,
                stop: run.stop(self.ticks) as i64,
                score: self.score(share),
                separation: separation(share),
                rest_share: 0.0,
                repetitions: self.counter.repetitions(0),
            }
        }));
    }
}

/// Mapped windows, laid out for the kernel.
#[derive(Debug, Clone)]
struct WindowTable {
    rows: Arc<[Lanes]>,
    len: usize,
    /// The last squared distances.
    apart: Vec<Lanes>,
}

impl WindowTable {
    fn new(rows: &Rows) -> Self {
        Self {
            rows: kernel::interleaved(rows.len(), rows.dim(), rows.iter().enumerate()).into(),
            len: rows.len(),
            apart: vec![[0.0; LANES]; rows.len().div_ceil(LANES)],
        }
    }

    /// Of `window` from each row.
    fn squared_distances(&mut self, window: &[f32]) -> &[f32] {
        kernel::squared_distances(&self.rows, window, &mut self.apart);
        &self.apart.as_flattened()[..self.len]
    }
}

/// The best path through classes and none of them, window by window.
#[derive(Debug, Clone)]
struct BestPath {
    classes: usize,
    /// Of the best path that ends with each class and, last, with none; the largest is 0.
    totals: Vec<f64>,
    /// For the last windows, in a ring of `LAG + 1`: squared distances from each class and the bound of the distance.
    distances: Vec<f32>,
    /// The same, what came before each class on its best path.
    before: Vec<u16>,
    steps: usize,
}

impl BestPath {
    fn new(classes: usize) -> Self {
        let states = classes + 1;
        Self {
            classes,
            totals: vec![0.0; states],
            distances: vec![0.0; states * (LAG + 1)],
            before: vec![0; states * (LAG + 1)],
            steps: 0,
        }
    }

    fn clear(&mut self) {
        self.totals.fill(0.0);
        self.steps = 0;
    }

    /// Windows so far.
    fn len(&self) -> usize {
        self.steps
    }

    fn slot(&self, window: usize) -> std::ops::Range<usize> {
        let states = self.classes + 1;
        let first = window % (LAG + 1) * states;
        first..first + states
    }

    /// Room for the distances from each class, all infinite, of a window that is of none where all are above `bound`.
    fn begin_step(&mut self, bound: f32) -> &mut [f32] {
        let slot = self.slot(self.steps);
        let distances = &mut self.distances[slot];
        distances.fill(f32::INFINITY);
        let (distances, none) = distances.split_at_mut(self.classes);
        none[0] = bound;
        distances
    }

    /// The class, or none, that the best path ends with; the first of equals.
    fn best(&self) -> usize {
        let total = |state: &usize| self.totals[*state];
        let states = 0..self.totals.len();
        let best = states.max_by(|a, b| total(a).total_cmp(&total(b)).then(b.cmp(a)));
        best.unwrap_or(0)
    }

    /// Goes one window further.
    fn take_step(&mut self) {
        let slot = self.slot(self.steps);
        let best = self.best();
        let changed = self.totals[best] - if self.steps == 0 { 0.0 } else { CHANGE_COST };
        let (distances, before) = (&self.distances[slot.clone()], &mut self.before[slot]);
        for (state, total) in self.totals.iter_mut().enumerate() {
            let from = if *total >= changed { state } else { best };
            before[state] = from as u16;
            *total = total.max(changed) - portable::ln(f64::from(distances[state]));
        }
        let most = self.totals.iter().copied().fold(f64::MIN, f64::max);
        self.totals.iter_mut().for_each(|total| *total -= most);
        self.steps += 1;
    }

    /// The class of one of the last windows on the best path; `None` if it is none.
    fn class_at(&self, window: usize) -> Option<usize> {
        let mut state = self.best();
        for later in (window + 1..self.steps).rev() {
            state = usize::from(self.before[self.slot(later)][state]);
        }
        (state < self.classes).then_some(state)
    }

    /// Distance of one of the last windows from `class`, as a share of the bound.
    fn share(&self, window: usize, class: usize) -> f64 {
        let distances = &self.distances[self.slot(window)];
        f64::from(distances[class] / distances[self.classes]).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::BoneSet;
    use crate::templates::{PackedSymmetric, ReferenceRows};
    use nalgebra::DMatrix;

    const WINDOW: usize = 31;

    fn layout() -> RowLayout {
        RowLayout::of(BoneSet::NONE.with(0))
    }

    /// Rows of a bone that swings so fast and so far about a direction.
    fn swing(ticks: usize, period: f64, size: f64, up: f32) -> Rows {
        let values = (0..ticks).flat_map(|t| {
            let phase = std::f64::consts::TAU * t as f64 / period;
            let (at, speed) = (size * phase.sin(), size * phase.cos());
            [
                at as f32,
                up,
                0.0,
                speed as f32,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ]
        });
        Rows::from_values(10, values.collect())
    }

    fn activities() -> Activities {
        let mean_of = |rows: &Rows| {
            let windows = windows_of(rows, layout(), WINDOW);
            let mut mean = vec![0.0; windows.dim()];
            for window in windows.iter() {
                mean.iter_mut()
                    .zip(window)
                    .for_each(|(m, v)| *m += v / windows.len() as f32);
            }
            mean
        };
        let dim = Activities::statistics(layout());
        let eye = PackedSymmetric::pack(&DMatrix::identity(dim, dim));
        let mut rows = Rows::new(dim);
        rows.push(&mean_of(&swing(200, 20.0, 1.0, 0.0)));
        rows.push(&mean_of(&swing(200, 20.0, 1.0, 2.0)));
        let mut others = Rows::new(dim);
        others.push(&mean_of(&swing(200, 20.0, 0.0, 1.0)));
        others.push(&mean_of(&swing(200, 20.0, 3.0, 1.0)));
        let windows = ReferenceRows {
            rows,
            classes: vec![ClassId(3), ClassId(1)],
            others,
            ridged: eye.clone(),
            total: eye,
        };
        Activities {
            windows,
            window_ticks: WINDOW,
            share: 1.0,
            repetitions: Vec::new(),
            step: Vec::new(),
        }
    }

    fn found(parts: &[Rows]) -> Vec<TickDetection> {
        let mut detector = ActivityDetector::new(&activities(), layout(), 30.0);
        let mut all = Vec::new();
        for row in parts.iter().flat_map(Rows::iter) {
            detector.push(row);
            all.extend(detector.found().iter().copied());
        }
        detector.finish();
        all.extend(detector.found().iter().copied());
        all
    }

    #[test]
    fn an_activity_is_one_event_however_long_it_goes_on() {
        for ticks in [60, 150, 601] {
            let still = || swing(90, 20.0, 0.0, 1.0);
            let events = found(&[still(), swing(ticks, 20.0, 1.0, 0.0), still()]);
            assert_eq!(events.len(), 1, "{events:?}");
            assert_eq!(events[0].class, ClassId(3));
            assert!((events[0].start - 90).abs() <= 9, "{events:?}");
            assert!(
                (events[0].stop - 90 - ticks as i64).abs() <= 9,
                "{events:?}"
            );
            assert!(events[0].score > 0.5 && events[0].score <= 1.0);
            let repeated = events[0].repetitions.unwrap();
            assert!(
                repeated.count.abs_diff(ticks as u32 / 20) <= 1,
                "{repeated:?}"
            );
            assert!((repeated.period_secs - 20.0 / 30.0).abs() < 0.05);
        }
    }

    #[test]
    fn one_follows_another_and_the_end_of_a_stream_ends_it() {
        let events = found(&[swing(120, 20.0, 1.0, 0.0), swing(100, 20.0, 1.0, 2.0)]);
        let classes: Vec<u16> = events.iter().map(|event| event.class.0).collect();
        assert_eq!(classes, [3, 1], "{events:?}");
        assert_eq!((events[0].start, events[1].stop), (0, 220));
        assert_eq!(events[0].stop, events[1].start);
    }

    #[test]
    fn what_is_nearer_to_anything_else_is_none() {
        assert_eq!(found(&[swing(300, 20.0, 2.4, 1.0)]), []);
        assert_eq!(found(&[swing(300, 20.0, 0.1, 1.0)]), []);
        assert_eq!(found(&[swing(9, 20.0, 1.0, 0.0)]), [], "too short");
    }

    #[test]
    fn an_activity_that_goes_on_is_underway_until_it_ends() {
        let mut detector = ActivityDetector::new(&activities(), layout(), 30.0);
        let mut seen = Vec::new();
        for row in swing(240, 20.0, 1.0, 0.0).iter() {
            detector.push(row);
            seen.push(detector.underway(2.0).map(|underway| underway.age));
        }
        let first = seen.iter().position(Option::is_some).unwrap();
        assert!(
            first < WINDOW / 2 + (LAG + LEAST_WINDOWS) * STEP_TICKS + STEP_TICKS,
            "{first}"
        );
        assert!(seen[first..].iter().all(Option::is_some));
        assert_eq!(seen[239], Some(239));
        let repeated = detector.underway(2.0).unwrap().repetitions.unwrap();
        assert!((11..=13).contains(&repeated.count), "{repeated:?}");
        detector.reset();
        assert_eq!(detector.underway(2.0), None);
    }
}
