//! The decoder: follows the distances of all classes tick by tick and decides when a motion is reported.

use crate::classes::ClassId;

use super::{
    Candidate, CandidatePolicy, ClassDistance, DecodeParams, FAR, MIN_AGE_TICKS, TickDetection,
    copy_with_room,
};

/// Detections of a class within this many ticks count for [`DecodeParams::tail_spread`]: a second.
const RUN_TICKS: i64 = 30;

/// The best sequence of detections that ends at or before a tick, as a chain.
#[derive(Debug, Clone, Copy, Default)]
struct PathCell {
    /// Sum of scores along it.
    total: f64,
    /// The detection that ends exactly here, if the best sequence has one.
    ends_here: Option<Ending>,
    /// The last tick up to here at which a detection of it ends; 0 if there is none.
    last_end: i64,
}

/// A detection that ends at a tick.
#[derive(Debug, Clone, Copy)]
struct Ending {
    start: i64,
    class: ClassId,
    score: f64,
    spread: f32,
    separation: f32,
    rest_share: f32,
}

/// The last report of a class.
#[derive(Debug, Clone, Copy, Default)]
struct LastReport {
    stop: i64,
    /// Largest spread among detections that follow each other within [`RUN_TICKS`].
    spread: f32,
}

/// Weighted interval scheduling over candidates as they come (Kleinberg and Tardos 2005, §6.1), made causal by
/// a fixed lag.
///
/// A tick costs O(classes × window). Memory is fixed at construction.
#[derive(Debug)]
pub struct Decoder {
    params: DecodeParams,
    rule: CandidatePolicy,
    classes: usize,
    /// Of each class, under [`CandidatePolicy::Gate`].
    thresholds: Vec<f32>,
    /// The last few ticks' distances, `ring_len` × `classes`.
    ring: Vec<ClassDistance>,
    negatives: Vec<f32>,
    ring_len: usize,
    paths: Vec<PathCell>,
    /// Ticks pushed.
    ticks: i64,
    /// Ticks decided: `paths` is known up to here.
    decided: i64,
    /// Everything up to here has been reported.
    reported: i64,
    /// Of each class.
    last: Vec<LastReport>,
    chain: Vec<TickDetection>,
    /// One tick's candidates.
    candidates: Vec<ScoredCandidate>,
    /// Detections of the last report.
    found: Vec<TickDetection>,
}

/// A candidate and its score: known by its distance under [`CandidatePolicy::Gate`], and for the caller to set under
/// [`CandidatePolicy::Verify`], where 0 and less refuse it.
#[derive(Debug, Clone, Copy)]
pub struct ScoredCandidate {
    /// Class, stretch and distance.
    pub candidate: Candidate,
    /// Its score, above 0 and to 1.
    pub score: f64,
    spread: f32,
    rest_share: f32,
}

impl Clone for Decoder {
    fn clone(&self) -> Self {
        Self {
            params: self.params.clone(),
            thresholds: self.thresholds.clone(),
            ring: self.ring.clone(),
            negatives: self.negatives.clone(),
            paths: self.paths.clone(),
            last: self.last.clone(),
            chain: copy_with_room(&self.chain),
            candidates: copy_with_room(&self.candidates),
            found: copy_with_room(&self.found),
            ..*self
        }
    }
}

impl Decoder {
    /// For `classes` classes whose matches are at most `longest` ticks long.
    pub fn new(
        params: &DecodeParams,
        rule: CandidatePolicy,
        classes: usize,
        longest: usize,
    ) -> Self {
        let reach = (2 * (params.gate_ticks + params.peak_ticks))
            .max(params.look_ahead_ticks(rule) + params.rival_ticks);
        let ring_len = (reach + 2).next_power_of_two();
        // A match of n template rows spans at most 2 n ticks; twice that leaves room for the chain behind it.
        let path_len = (4 * longest + params.look_ahead_ticks(rule) + params.overlap_ticks + 8)
            .next_power_of_two();
        Self {
            params: params.clone(),
            rule,
            classes,
            thresholds: vec![
                if let CandidatePolicy::Gate { threshold } = rule {
                    threshold
                } else {
                    FAR
                };
                classes
            ],
            ring: vec![ClassDistance::NONE; ring_len * classes],
            negatives: vec![FAR; ring_len],
            ring_len,
            paths: vec![PathCell::default(); path_len],
            ticks: 0,
            decided: 0,
            reported: 0,
            last: vec![LastReport::default(); classes],
            chain: Vec::with_capacity(path_len),
            candidates: Vec::with_capacity(classes),
            found: Vec::with_capacity(path_len),
        }
    }

    /// A threshold for each class instead of the common one; fewer than there are classes change the first only.
    pub fn set_thresholds(&mut self, thresholds: &[f32]) {
        self.thresholds
            .iter_mut()
            .zip(thresholds)
            .for_each(|(mine, given)| *mine = *given);
    }

    /// Sets [`DecodeParams::rival_share`].
    pub fn set_rival_share(&mut self, share: f32) {
        self.params.rival_share = share;
    }

    /// Detections of the last [`report`](Self::report).
    pub fn found(&self) -> &[TickDetection] {
        &self.found
    }

    /// Forgets the stream so far, but for what was [`found`](Self::found).
    pub fn reset(&mut self) {
        self.paths.fill(PathCell::default());
        self.last.fill(LastReport::default());
        (self.ticks, self.decided, self.reported) = (0, 0, 0);
    }

    /// Takes the next tick: one distance for each class and the smallest to any negative ([`FAR`] if there is
    /// none). Then, while a tick [is due](Self::is_due), [`candidates`](Self::candidates) are to be scored and
    /// [`decide`](Self::decide) called, and [`report`](Self::report) at the end. No allocation.
    pub fn push(&mut self, near: &[ClassDistance], negative: f32) {
        let slot = self.ticks as usize & (self.ring_len - 1);
        self.ring[slot * self.classes..][..self.classes].copy_from_slice(near);
        self.negatives[slot] = negative;
        self.ticks += 1;
    }

    /// True if all is known that decides one more tick; with `ended`, what is known must do.
    pub fn is_due(&self, ended: bool) -> bool {
        let wait = match ended {
            true => 0,
            false => self.params.window_ticks(self.rule) as i64,
        };
        self.decided + wait < self.ticks
    }

    /// The candidates of the tick that is [due](Self::is_due), at most one for each class. Under
    /// [`CandidatePolicy::Verify`] their scores are to be set before [`decide`](Self::decide).
    pub fn candidates(&mut self) -> &mut [ScoredCandidate] {
        let tick = self.decided;
        self.candidates.clear();
        for class in 0..self.classes {
            let ClassDistance {
                age,
                spread,
                rest_share,
                ..
            } = self.near(tick, class);
            let start = tick - age as i64;
            if start < self.reported - self.slack(age)
                || self.repeats(class, start)
                || self.is_tail(class, start, spread)
                || self.cut_off(tick, class)
            {
                continue;
            }
            let candidate = match self.rule {
                CandidatePolicy::Gate { .. } => self.gated(tick, class),
                CandidatePolicy::Verify { reach } => self.unverified(tick, class, reach),
            };
            if let Some((candidate, score)) = candidate {
                self.candidates.push(ScoredCandidate {
                    candidate,
                    score,
                    spread,
                    rest_share,
                });
            }
        }
        &mut self.candidates
    }

    /// Decides the tick of the [candidates](Self::candidates): the best path that ends with it.
    pub fn decide(&mut self) {
        let tick = self.decided;
        let mut cell = PathCell {
            ends_here: None,
            ..*self.path(tick)
        };
        let verifies = matches!(self.rule, CandidatePolicy::Verify { .. });
        for scored in &self.candidates {
            let ScoredCandidate {
                candidate,
                score,
                spread,
                rest_share,
            } = *scored;
            let Candidate { class, age, .. } = candidate;
            if verifies && score <= 0.0 {
                continue;
            }
            let start = (tick - age as i64).max(self.reported);
            for begin in start..=(start + self.slack(age)).min(tick) {
                let total = self.path(begin).total + score;
                if total > cell.total + 1e-12 {
                    let ends_here = Some(Ending {
                        start: begin,
                        class,
                        score,
                        spread,
                        separation: candidate.separation(),
                        rest_share,
                    });
                    cell = PathCell {
                        total,
                        ends_here,
                        last_end: tick + 1,
                    };
                }
            }
        }
        let index = (tick + 1) as usize & (self.paths.len() - 1);
        self.paths[index] = cell;
        self.decided = tick + 1;
    }

    fn path(&self, tick: i64) -> &PathCell {
        &self.paths[tick as usize & (self.paths.len() - 1)]
    }

    fn near(&self, tick: i64, class: usize) -> ClassDistance {
        self.ring[(tick as usize & (self.ring_len - 1)) * self.classes + class]
    }

    /// Distances at `tick` count only below this.
    fn gate(&self, tick: i64) -> f32 {
        let reach = self.params.gate_ticks as i64;
        let (first, last) = ((tick - reach).max(0), (tick + reach).min(self.ticks - 1));
        let nearest = (first..=last).map(|t| self.negatives[t as usize & (self.ring_len - 1)]);
        self.params.gate * nearest.fold(FAR, f32::min)
    }

    /// Ticks around `tick` that a peak is compared with.
    fn around(&self, tick: i64) -> std::ops::RangeInclusive<i64> {
        let reach = self.params.peak_ticks as i64;
        (tick - reach).max(0)..=(tick + reach).min(self.ticks - 1)
    }

    /// The candidate of a class at `tick` and its score, if its distance passes the threshold, and is no larger than any
    /// distance that counts nearby.
    fn gated(&self, tick: i64, class: usize) -> Option<(Candidate, f64)> {
        let distance = self.near(tick, class).distance;
        let threshold = self.thresholds[class];
        if distance >= threshold || distance >= self.gate(tick) {
            return None;
        }
        let beaten = self.around(tick).any(|t| {
            let there = self.near(t, class).distance;
            there < distance && there < self.gate(t)
        });
        if beaten {
            return None;
        }
        let other = self.nearest_rival(tick, class);
        if other < distance * self.params.rival_share {
            return None;
        }
        let score = 1.0 - f64::from(distance) / f64::from(threshold);
        Some((self.candidate(tick, class, other, FAR), score))
    }

    /// The distance of the nearest match of another class that ends around `tick` and covers enough of the candidate.
    fn nearest_rival(&self, tick: i64, class: usize) -> f32 {
        let age = self.near(tick, class).age;
        let least = self.params.rival_overlap * (age + 1) as f32;
        let reach = self.params.rival_ticks as i64;
        let covers = |t: i64, other: &ClassDistance| {
            let start = (tick - age as i64).max(t - other.age as i64);
            (tick.min(t) - start + 1) as f32 >= least
        };
        ((tick - reach).max(0)..=(tick + reach).min(self.ticks - 1))
            .flat_map(|t| (0..self.classes).map(move |rival| (t, rival)))
            .filter(|(_, rival)| *rival != class)
            .map(|(t, rival)| (t, self.near(t, rival)))
            .filter(|(t, other)| covers(*t, other))
            .map(|(_, other)| other.distance)
            .fold(FAR, f32::min)
    }

    /// The candidate of a class at `tick`, without a score yet.
    fn unverified(&self, tick: i64, class: usize, reach: f32) -> Option<(Candidate, f64)> {
        let ClassDistance { distance, age, .. } = self.near(tick, class);
        if distance > reach || age < MIN_AGE_TICKS {
            return None;
        }
        let (mut other, mut negative) = (FAR, FAR);
        for t in self.around(tick) {
            if self.near(t, class).distance < distance {
                return None;
            }
            negative = negative.min(self.negatives[t as usize & (self.ring_len - 1)]);
            for rival in (0..self.classes).filter(|c| *c != class) {
                other = other.min(self.near(t, rival).distance);
            }
        }
        Some((self.candidate(tick, class, other, negative), 0.0))
    }

    fn candidate(&self, tick: i64, class: usize, other: f32, negative: f32) -> Candidate {
        let ClassDistance { distance, age, .. } = self.near(tick, class);
        Candidate {
            class: ClassId(class as u16),
            tick,
            age,
            distance,
            other,
            negative,
        }
    }

    /// True if the stream ends before the peak at `tick` could be distinguished from a class still coming nearer.
    fn cut_off(&self, tick: i64, class: usize) -> bool {
        if tick + (self.params.peak_ticks as i64) < self.ticks || tick == 0 {
            return false;
        }
        let (before, here) = (
            self.near(tick - 1, class).distance,
            self.near(tick, class).distance,
        );
        before > here * (1.0 + self.params.end_fall)
    }

    /// True if a candidate that starts here is the last detection of its class over again, longer.
    fn repeats(&self, class: usize, start: i64) -> bool {
        self.params.once && start < self.last[class].stop - self.params.overlap_ticks as i64
    }

    /// True if a candidate that follows a detection of its class moves too little to be one more repetition.
    fn is_tail(&self, class: usize, start: i64, spread: f32) -> bool {
        let last = self.last[class];
        last.stop > 0
            && start <= last.stop + self.params.tail_ticks as i64
            && spread < self.params.tail_spread * last.spread
    }

    /// Ticks that a candidate of this age may reach into the detection before it.
    fn slack(&self, age: usize) -> i64 {
        let share = (self.params.overlap_share * (age + 1) as f32) as usize;
        self.params.overlap_ticks.max(share) as i64
    }

    /// True if a match of another class that encloses `detection` may yet become a better candidate.
    fn waits(&self, detection: &TickDetection) -> bool {
        let waited = self.decided - detection.stop;
        if !matches!(self.rule, CandidatePolicy::Gate { .. })
            || waited >= self.params.hold_ticks as i64
        {
            return false;
        }
        let last = self.ticks - 1;
        let grows = |t: i64, class: usize| {
            let ClassDistance { distance, age, .. } = self.near(t, class);
            let encloses = t - age as i64 <= detection.start;
            let near_enough = distance < self.thresholds[class] && distance < self.gate(t);
            encloses && near_enough && (t < last || distance < self.near(t - 1, class).distance)
        };
        let mut others = (0..self.classes).filter(|c| *c != detection.class.index());
        others.any(|class| (self.decided.max(1)..=last).any(|t| grows(t, class)))
    }

    /// Detections that are now certain, in order of time: those on the best path that ended long enough ago, or all
    /// with `ended`, up to the first that must wait.
    pub fn report(&mut self, ended: bool) -> &mut [TickDetection] {
        let lag = match ended {
            true => 0,
            false => self.params.lag_ticks as i64,
        };
        self.found.clear();
        let mut chain = std::mem::take(&mut self.chain);
        chain.clear();
        let oldest = self
            .reported
            .max(self.decided - self.paths.len() as i64 + 1);
        let mut tick = self.path(self.decided).last_end;
        while tick > oldest {
            let Some(ending) = self.path(tick).ends_here else {
                break;
            };
            let start = ending.start;
            chain.push(TickDetection {
                class: ending.class,
                start,
                stop: tick,
                score: ending.score,
                separation: ending.separation,
                rest_share: ending.rest_share,
                repetitions: None,
            });
            // What begins before the oldest tick that is kept has nothing before it that could still be reported.
            tick = if start > oldest {
                self.path(start).last_end
            } else {
                oldest
            };
        }
        for detection in chain.iter().rev() {
            if self.waits(detection) {
                break;
            }
            if detection.start >= self.reported && self.decided - detection.stop >= lag {
                self.reported = detection.stop;
                self.note_report(detection);
                self.found.push(TickDetection {
                    score: detection.score.min(1.0),
                    ..*detection
                });
            }
        }
        self.chain = chain;
        &mut self.found
    }

    fn note_report(&mut self, detection: &TickDetection) {
        let ending = self.path(detection.stop).ends_here;
        let spread = ending.map_or(0.0, |e| e.spread);
        let last = &mut self.last[detection.class.index()];
        let follows = last.stop > 0 && detection.stop - last.stop <= RUN_TICKS;
        *last = LastReport {
            stop: detection.stop,
            spread: if follows {
                spread.max(last.spread)
            } else {
                spread
            },
        };
    }
}
