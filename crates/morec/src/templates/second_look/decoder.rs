//! Decoding with the second look: from matches at every tick to one report for each motion, which is never revoked.

use crate::classes::ClassId;
use crate::decode::{ClassDistance, MIN_AGE_TICKS, TickDetection, copy_with_room};
use crate::math::portable;
use crate::templates::{Calibration, PerformerKind, TemplateModel};

use super::LOOK_COLUMNS;
use super::body::BodyTrack;
use super::comparison::{Comparison, Judged};
use super::extent::LookExtent;
use super::mapped::median_of;
use super::segment::{GrownExtent, LONG, SEGMENT_ROWS, SHORT, grow, write_segment};

/// Share of the shorter of two extents beyond which only the better one is reported.
const OVERLAP: f32 = 0.4;
/// Ticks that must follow a tick before its pace is taken as known.
const KNOWN_TICKS: i64 = 2;
/// Ticks after its end that a look waits for a better one.
const HOLD_TICKS: i64 = 3;
/// A motion goes on while its pace has not been below this share of its mean for as many ticks in a row.
const GOES_ON_SHARE: f32 = 0.3;
const GOES_ON_TICKS: usize = 3;
/// Of a performer's last scores the median counts, from the fourth on.
const SCORES: usize = 20;
const LEAST_SCORES: usize = 4;
/// Reports of a performer have at least this share of it.
const PERFORMER_SHARE: f32 = 0.5;
/// Candidates and looks that are open at once, at most; further ones are dropped.
const MOST_OPEN: usize = 128;
/// Extents whose judgement is remembered: different matches grow to the same motion.
const REMEMBERED: usize = 16;

/// A motion that was judged, in ticks of the present stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Look {
    extent: LookExtent,
    judged: Judged,
}

/// A match whose motion is not known to its end.
#[derive(Debug, Clone, Copy)]
struct OpenMatch {
    matched: LookExtent,
    /// The short growth was judged.
    is_judged: bool,
}

/// Scores of a performer's last reports.
#[derive(Debug, Clone, Copy)]
struct PerformerScores {
    performer: PerformerKind,
    /// The median score of the teacher's own samples.
    own: f32,
    last: [f32; SCORES],
    count: usize,
}

impl PerformerScores {
    /// The score that reports of the performer must have at least, whatever the bound is.
    fn least(&self) -> f32 {
        let mut sorted = self.last;
        let known = self.count.min(SCORES);
        let level = match self.performer {
            PerformerKind::Anyone => return f32::MIN,
            _ if known >= LEAST_SCORES => median_of(&mut sorted[..known]),
            PerformerKind::Teacher => self.own,
            PerformerKind::Auto => return f32::MIN,
        };
        PERFORMER_SHARE * level
    }

    fn take(&mut self, score: f32) {
        self.last[self.count % SCORES] = score;
        self.count += 1;
    }
}

/// Judges the motions around matches, and reports those that pass the bound. Memory is fixed at construction.
#[derive(Debug)]
pub struct LookDecoder {
    body: BodyTrack,
    comparison: Comparison,
    columns: Vec<usize>,
    /// True of classes that are activities, which their windows report.
    goes_on: Vec<bool>,
    bound: f32,
    reach: f32,
    calibration: Option<Calibration>,
    performer: PerformerScores,
    /// The last two ticks' distances of each class.
    near: [Vec<ClassDistance>; 2],
    open: Vec<OpenMatch>,
    waiting: Vec<Look>,
    judged: [Look; REMEMBERED],
    judgements: usize,
    reported: [LookExtent; REMEMBERED],
    reports: usize,
    full: Vec<f32>,
    segment: Vec<f32>,
    found: Vec<TickDetection>,
}

impl Clone for LookDecoder {
    fn clone(&self) -> Self {
        Self {
            body: self.body.clone(),
            comparison: self.comparison.clone(),
            columns: self.columns.clone(),
            goes_on: self.goes_on.clone(),
            near: self.near.clone(),
            open: copy_with_room(&self.open),
            waiting: copy_with_room(&self.waiting),
            full: self.full.clone(),
            segment: self.segment.clone(),
            found: copy_with_room(&self.found),
            ..*self
        }
    }
}

const NOWHERE: LookExtent = LookExtent {
    start: -1,
    stop: -1,
};
const NO_LOOK: Look = Look {
    extent: NOWHERE,
    judged: Judged {
        class: ClassId(0),
        score: f32::MIN,
    },
};

impl LookDecoder {
    /// Of a model with a second look, for matches of up to `longest` ticks. `None` of other models.
    pub fn new(model: &TemplateModel, longest: usize) -> Option<Self> {
        let look = model.look.as_ref()?;
        let columns = BodyTrack::columns(model.bones);
        let remembered = longest + 2 * LONG.ticks as usize + 16;
        Some(Self {
            body: BodyTrack::new(model.bones, &model.features, remembered),
            comparison: Comparison::for_reports(look),
            segment: vec![0.0; SEGMENT_ROWS * columns.len()],
            full: vec![0.0; SEGMENT_ROWS * LOOK_COLUMNS],
            columns,
            goes_on: (0..model.classes.len())
                .map(|class| {
                    let activities = model.activities.as_ref();
                    activities.is_some_and(|a| a.holds(ClassId(class as u16)))
                })
                .collect(),
            bound: look.bound,
            reach: look.reach,
            calibration: model.calibration,
            performer: PerformerScores {
                performer: look.performer,
                own: look.own_score,
                last: [0.0; SCORES],
                count: 0,
            },
            near: [(); 2].map(|()| vec![ClassDistance::NONE; model.classes.len()]),
            open: Vec::with_capacity(MOST_OPEN),
            waiting: Vec::with_capacity(MOST_OPEN),
            judged: [NO_LOOK; REMEMBERED],
            judgements: 0,
            reported: [NOWHERE; REMEMBERED],
            reports: 0,
            found: Vec::with_capacity(MOST_OPEN),
        })
    }

    /// Forgets how the performer moves.
    pub fn forget_performer(&mut self) {
        self.performer.count = 0;
    }

    /// Forgets the stream so far, but for the performer and what was [`found`](Self::found).
    pub fn reset(&mut self) {
        self.body.reset();
        self.near
            .iter_mut()
            .for_each(|near| near.fill(ClassDistance::NONE));
        self.open.clear();
        self.waiting.clear();
        (self.judgements, self.reports) = (0, 0);
        self.judged = [NO_LOOK; REMEMBERED];
        self.reported = [NOWHERE; REMEMBERED];
    }

    /// Reports of the last [`push`](Self::push) or [`finish`](Self::finish).
    pub fn found(&self) -> &[TickDetection] {
        &self.found
    }

    /// Takes the next tick's feature row and the nearest match of each class. No allocation.
    pub fn push(&mut self, row: &[f32], near: &[ClassDistance]) {
        self.found.clear();
        self.body.push(row);
        for class in 0..near.len() {
            let [before, last] = [0, 1].map(|k| self.near[k][class]);
            let is_nearest =
                last.distance <= before.distance && last.distance <= near[class].distance;
            if is_nearest {
                self.open_match(last, self.body.ticks() - 2);
            }
            self.near[0][class] = last;
            self.near[1][class] = near[class];
        }
        self.look(false);
        self.report(false);
    }

    /// Ends the stretch: what is known must do.
    pub fn finish(&mut self) {
        self.found.clear();
        for class in 0..self.near[1].len() {
            let [before, last] = [0, 1].map(|k| self.near[k][class]);
            if last.distance <= before.distance {
                self.open_match(last, self.body.ticks() - 1);
            }
        }
        self.look(true);
        self.report(true);
    }

    /// Takes a match that ends with `tick`, if it is within `reach` and long enough.
    fn open_match(&mut self, near: ClassDistance, tick: i64) {
        if near.distance >= self.reach || near.age < MIN_AGE_TICKS || self.open.len() == MOST_OPEN {
            return;
        }
        let matched = LookExtent {
            start: (tick - near.age as i64).max(self.body.first()),
            stop: tick + 1,
        };
        if self.open.iter().all(|open| open.matched != matched) {
            self.open.push(OpenMatch {
                matched,
                is_judged: false,
            });
        }
    }

    /// Judges the motions whose ends are known.
    fn look(&mut self, ended: bool) {
        let known = self.body.ticks() - KNOWN_TICKS;
        let mut k = 0;
        while k < self.open.len() {
            let OpenMatch { matched, is_judged } = self.open[k];
            if !is_judged
                && let GrownExtent::To(extent) = grow(&self.body, matched, SHORT, known, ended)
            {
                self.judge(extent);
                self.open[k].is_judged = true;
            }
            match grow(&self.body, matched, LONG, known, ended) {
                GrownExtent::To(extent) => {
                    self.judge(extent);
                    self.open.swap_remove(k);
                }
                GrownExtent::GoesOn => k += 1,
            }
        }
    }

    fn judge(&mut self, extent: LookExtent) {
        if self.judged.iter().any(|look| look.extent == extent) {
            return;
        }
        write_segment(&self.body, extent, &mut self.full);
        let rows = self.full.chunks_exact(LOOK_COLUMNS);
        for (row, out) in rows.zip(self.segment.chunks_exact_mut(self.columns.len())) {
            for (out, column) in out.iter_mut().zip(&self.columns) {
                *out = row[*column];
            }
        }
        let look = Look {
            extent,
            judged: self.comparison.judge(&self.segment),
        };
        self.judged[self.judgements % REMEMBERED] = look;
        self.judgements += 1;
        let is_reported = !self.goes_on[look.judged.class.index()];
        if is_reported && look.judged.score > self.bound.max(self.performer.least()) {
            self.offer(look);
        }
    }

    /// Lets a look wait for its report, if no better one is in its place.
    fn offer(&mut self, look: Look) {
        let rivals = |other: &LookExtent| {
            let shorter = other.len().min(look.extent.len());
            other.shared(look.extent) as f32 > OVERLAP * shorter as f32
        };
        let beats = |other: &Look| rivals(&other.extent) && other.judged.score >= look.judged.score;
        if self.reported.iter().any(rivals) || self.waiting.iter().any(beats) {
            return;
        }
        self.waiting.retain(|other| !rivals(&other.extent));
        if self.waiting.len() < MOST_OPEN {
            self.waiting.push(look);
        }
    }

    /// True while the look may be the beginning of a longer motion: its pace has not fallen yet, or a match that began before its end is
    /// still coming nearer.
    fn goes_on(&self, look: &Look) -> bool {
        let LookExtent { stop, .. } = look.extent;
        let now = self.body.ticks();
        if now - stop >= LONG.ticks {
            return false;
        }
        let level = GOES_ON_SHARE * self.body.mean_pace(look.extent);
        let slow = |tick: i64| self.body.pace(tick) <= level;
        let mut slow_ticks = 0;
        let rests = (stop..now - KNOWN_TICKS).any(|tick| {
            slow_ticks = if slow(tick) { slow_ticks + 1 } else { 0 };
            slow_ticks >= GOES_ON_TICKS
        });
        if !rests {
            return true;
        }
        let [before, last] = &self.near;
        before.iter().zip(last).any(|(before, last)| {
            let comes_nearer = last.distance < self.reach && last.distance < before.distance;
            comes_nearer && now - 1 - last.age as i64 <= stop
        })
    }

    /// Reports the looks that have waited long enough, the earliest first.
    fn report(&mut self, ended: bool) {
        let now = self.body.ticks();
        loop {
            let is_due = |look: &Look| {
                ended || (look.extent.stop + HOLD_TICKS <= now && !self.goes_on(look))
            };
            let due = self
                .waiting
                .iter()
                .enumerate()
                .filter(|(_, look)| is_due(look));
            let first = due.min_by_key(|(_, look)| (look.extent.stop, look.extent.start));
            let Some((place, _)) = first else {
                return;
            };
            let Look { extent, judged } = self.waiting.swap_remove(place);
            let last = self
                .reported
                .iter()
                .map(|r| r.stop)
                .max()
                .unwrap_or(0)
                .max(0);
            self.reported[self.reports % REMEMBERED] = extent;
            self.reports += 1;
            if extent.stop <= last || self.found.len() == MOST_OPEN {
                continue;
            }
            self.performer.take(judged.score);
            let margin = 1.0 - portable::exp(-f64::from(judged.score - self.bound));
            self.found.push(TickDetection {
                class: judged.class,
                start: extent.start.max(last),
                stop: extent.stop,
                score: self
                    .calibration
                    .map_or(margin, |c| c.probability(margin, 0.0, 0.0)),
                separation: 0.0,
                rest_share: 0.0,
                repetitions: None,
            });
        }
    }
}
