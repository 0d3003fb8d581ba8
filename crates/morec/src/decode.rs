//! From distances at every tick to one detection for each motion, with nothing taken back.

use crate::classes::ClassId;

/// Distance of a class that nothing has matched yet.
pub const FAR: f32 = 1e30;

/// How distances become detections. An index keeps the values it was trained with.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DecodeParams {
    /// A class's distance counts only while it is below this times the smallest distance to any negative
    /// template nearby.
    pub gate: f32,
    /// How many ticks before and after count as nearby.
    pub gate_ticks: usize,
    /// A candidate's distance must be the smallest of this many ticks before and after.
    pub peak_ticks: usize,
    /// A detection is held back until it ended this many ticks ago, in case a better one takes its place.
    pub lag_ticks: usize,
    /// A candidate may reach this many ticks into the detection before it; the overlap is cut off.
    pub overlap_ticks: usize,
    /// It may also reach this share of its own length into it, if that is more: what was reported a little too long
    /// must not swallow the motion that follows. Older indexes have 0.
    #[serde(default)]
    pub overlap_share: f32,
    /// A detection waits up to this many ticks while another class's match that encloses it is near enough and still
    /// coming nearer: a short motion may only be the end of a longer one. Older indexes have 0. Under
    /// [`Rule::Verify`] nothing waits.
    #[serde(default)]
    pub hold_ticks: usize,
    /// A match counts only if it is nearer than this share of the distance of a body that stands still in the mean
    /// pose of the matched stretch (see [`Matcher`](crate::templates::Matcher)). 0 admits everything.
    #[serde(default)]
    pub rest_gate: f32,
    /// The same under [`Rule::Verify`], where motion is evidence besides.
    #[serde(default)]
    pub rest_gate_verified: f32,
    /// A candidate may reach only [`overlap_ticks`](Self::overlap_ticks) into the last detection of its own class, so
    /// that the way out and the way out and back are not two detections.
    #[serde(default)]
    pub once: bool,
    /// A motion may end with the very last ticks of a stream only if its distance fell by less than this share over
    /// the last tick: a walk cut off in mid-step is nearest to a step at the cut, but still coming nearer.
    pub end_fall: f32,
}

impl Default for DecodeParams {
    /// The short windows: as accurate as the long ones on referee signals, and a fifth of a second earlier.
    fn default() -> Self {
        Self {
            gate: 1.0,
            gate_ticks: 1,
            peak_ticks: 1,
            lag_ticks: 0,
            overlap_ticks: 2,
            overlap_share: 0.5,
            hold_ticks: 2,
            rest_gate: 0.8,
            rest_gate_verified: 0.9,
            once: true,
            end_fall: 0.1,
        }
    }
}

impl DecodeParams {
    /// The values of the reference prototype.
    pub fn reference() -> Self {
        Self {
            gate: 1.2,
            gate_ticks: 3,
            peak_ticks: 2,
            lag_ticks: 3,
            overlap_ticks: 2,
            overlap_share: 0.0,
            hold_ticks: 0,
            rest_gate: 0.0,
            rest_gate_verified: 0.0,
            once: false,
            end_fall: f32::MAX,
        }
    }

    /// Says what is wrong with these values, if anything is.
    pub fn check(&self) -> Result<(), String> {
        if !(self.gate.is_finite() && self.gate > 0.0) {
            return Err(format!("gate must be above 0, found {}", self.gate));
        }
        let ticks = [
            ("gate_ticks", self.gate_ticks),
            ("peak_ticks", self.peak_ticks),
            ("lag_ticks", self.lag_ticks),
            ("overlap_ticks", self.overlap_ticks),
            ("hold_ticks", self.hold_ticks),
        ];
        if !(0.0..1.0).contains(&self.overlap_share) {
            return Err(format!(
                "overlap_share must be from 0 to below 1, found {}",
                self.overlap_share
            ));
        }
        let gates = [
            ("rest_gate", self.rest_gate),
            ("rest_gate_verified", self.rest_gate_verified),
        ];
        if let Some((name, value)) = gates.iter().find(|(_, v)| !(0.0..=2.0).contains(v)) {
            return Err(format!("{name} must be 0 to 2, found {value}"));
        }
        if self.end_fall.is_nan() || self.end_fall < 0.0 {
            return Err(format!(
                "end_fall must be 0 or more, found {}",
                self.end_fall
            ));
        }
        match ticks.iter().find(|(_, ticks)| *ticks > MOST_TICKS) {
            Some((name, ticks)) => Err(format!(
                "{name} must be at most {MOST_TICKS}, found {ticks}"
            )),
            None => Ok(()),
        }
    }

    /// Ticks that must follow a motion's last tick before it can be reported.
    pub fn look_ahead_ticks(&self, rule: Rule) -> usize {
        self.window_ticks(rule) + self.lag_ticks
    }

    /// Matches count below this share of a motionless body's distance.
    pub fn rest_share(&self, rule: Rule) -> f32 {
        match rule {
            Rule::Gate { .. } => self.rest_gate,
            Rule::Verify { .. } => self.rest_gate_verified,
        }
    }

    /// Ticks that must follow a tick before it is known whether it is a candidate.
    fn window_ticks(&self, rule: Rule) -> usize {
        match rule {
            Rule::Gate { .. } => self.gate_ticks + self.peak_ticks,
            Rule::Verify { .. } => self.peak_ticks,
        }
    }
}

/// How near one class is at one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassDistance {
    /// Smallest distance to any of the class's templates; [`FAR`] if none has matched.
    pub distance: f32,
    /// Ticks since that template's match began.
    pub age: usize,
}

/// What makes a candidate of a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// Distances below the class's threshold and below [`DecodeParams::gate`] times the smallest negative distance
    /// nearby; the score is 1 − distance / threshold.
    Gate {
        /// Distances at or above this are never reported, unless [`Decoder::set_thresholds`] says otherwise.
        threshold: f32,
    },
    /// Distances up to `reach`; a judge gives the score, and above 0 is accepted.
    Verify {
        /// Farther ones are not looked at.
        reach: f32,
    },
}

/// A stretch that may be a motion, for a judge to look at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// What it may be.
    pub class: ClassId,
    /// Its last tick.
    pub tick: i64,
    /// Ticks from its first to its last.
    pub age: usize,
    /// The class's distance there.
    pub distance: f32,
    /// Smallest distance of another class within [`DecodeParams::peak_ticks`]; [`FAR`] if there is none.
    pub other: f32,
    /// Smallest negative distance within the same ticks.
    pub negative: f32,
}

/// A motion recognised, in ticks of the present stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickDetection {
    /// What it is.
    pub class: ClassId,
    /// First tick.
    pub start: i64,
    /// One past the last tick.
    pub stop: i64,
    /// 0 just accepted … 1 certain.
    pub score: f64,
}

/// No window is wider than this: ten seconds of waiting are no live recognition.
const MOST_TICKS: usize = 300;

/// A stretch of fewer ticks than this after its first is no motion.
pub const MIN_AGE_TICKS: usize = 3;

/// The best sequence of detections that ends at or before a tick, as a chain.
#[derive(Debug, Clone, Copy, Default)]
struct PathCell {
    /// Sum of scores along it.
    total: f64,
    /// The detection that ends exactly here, if the best sequence has one.
    ends_here: Option<(i64, ClassId, f64)>,
    /// The last tick up to here at which a detection of it ends; 0 if there is none.
    last_end: i64,
}

/// Weighted interval scheduling over candidates as they come (Kleinberg and Tardos 2005, §6.1), made causal by
/// a fixed lag.
///
/// A tick costs O(classes × window). Memory is fixed at construction.
#[derive(Debug)]
pub struct Decoder {
    params: DecodeParams,
    rule: Rule,
    classes: usize,
    /// Of each class, under [`Rule::Gate`].
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
    /// Where the last detection of each class ended.
    ended: Vec<i64>,
    chain: Vec<TickDetection>,
}

impl Clone for Decoder {
    fn clone(&self) -> Self {
        // A derived copy of a vector has room for what it holds only, and pushing must not allocate.
        let mut chain = Vec::with_capacity(self.chain.capacity());
        chain.extend_from_slice(&self.chain);
        Self {
            params: self.params.clone(),
            thresholds: self.thresholds.clone(),
            ring: self.ring.clone(),
            negatives: self.negatives.clone(),
            paths: self.paths.clone(),
            ended: self.ended.clone(),
            chain,
            ..*self
        }
    }
}

impl Decoder {
    /// For `classes` classes whose matches are at most `longest` ticks long.
    pub fn new(params: &DecodeParams, rule: Rule, classes: usize, longest: usize) -> Self {
        let ring_len = (2 * (params.gate_ticks + params.peak_ticks) + 2).next_power_of_two();
        // A match of n template rows spans at most 2 n ticks; twice that leaves room for the chain behind it.
        let path_len = (4 * longest + params.look_ahead_ticks(rule) + params.overlap_ticks + 8)
            .next_power_of_two();
        Self {
            params: params.clone(),
            rule,
            classes,
            thresholds: vec![
                if let Rule::Gate { threshold } = rule {
                    threshold
                } else {
                    FAR
                };
                classes
            ],
            ring: vec![
                ClassDistance {
                    distance: FAR,
                    age: 0
                };
                ring_len * classes
            ],
            negatives: vec![FAR; ring_len],
            ring_len,
            paths: vec![PathCell::default(); path_len],
            ticks: 0,
            decided: 0,
            reported: 0,
            ended: vec![0; classes],
            chain: Vec::with_capacity(path_len),
        }
    }

    /// A threshold for each class instead of the common one; fewer than there are classes change the first only.
    pub fn set_thresholds(&mut self, thresholds: &[f32]) {
        self.thresholds
            .iter_mut()
            .zip(thresholds)
            .for_each(|(mine, given)| *mine = *given);
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.paths.fill(PathCell::default());
        self.ended.fill(0);
        (self.ticks, self.decided, self.reported) = (0, 0, 0);
    }

    /// Takes the next tick: one distance for each class and the smallest to any negative ([`FAR`] if there is
    /// none). Calls `out` with what is now certain; `judge` scores candidates under [`Rule::Verify`].
    pub fn push(
        &mut self,
        near: &[ClassDistance],
        negative: f32,
        judge: &mut impl FnMut(&Candidate) -> f64,
        out: &mut impl FnMut(TickDetection),
    ) {
        let slot = self.ticks as usize & (self.ring_len - 1);
        self.ring[slot * self.classes..][..self.classes].copy_from_slice(near);
        self.negatives[slot] = negative;
        self.ticks += 1;
        let wait = self.params.window_ticks(self.rule) as i64;
        if self.ticks > wait {
            self.decide(self.ticks - 1 - wait, judge);
            self.report(self.params.lag_ticks as i64, out);
        }
    }

    /// Ends the stretch: decides the last ticks with what there is and reports all that is left.
    pub fn finish(
        &mut self,
        judge: &mut impl FnMut(&Candidate) -> f64,
        out: &mut impl FnMut(TickDetection),
    ) {
        while self.decided < self.ticks {
            self.decide(self.decided, judge);
        }
        self.report(0, out);
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

    /// The class's score at `tick` if it is a candidate there: near enough, and no larger than any distance that
    /// counts nearby.
    fn score(
        &self,
        tick: i64,
        class: usize,
        judge: &mut impl FnMut(&Candidate) -> f64,
    ) -> Option<f64> {
        let distance = self.near(tick, class).distance;
        match self.rule {
            Rule::Gate { .. } => {
                let threshold = self.thresholds[class];
                if distance >= threshold || distance >= self.gate(tick) {
                    return None;
                }
                let beaten = self.around(tick).any(|t| {
                    let there = self.near(t, class).distance;
                    there < distance && there < self.gate(t)
                });
                (!beaten).then(|| 1.0 - f64::from(distance) / f64::from(threshold))
            }
            Rule::Verify { reach } => {
                let candidate = self.unverified(tick, class, reach)?;
                Some(judge(&candidate)).filter(|score| *score > 0.0)
            }
        }
    }

    fn unverified(&self, tick: i64, class: usize, reach: f32) -> Option<Candidate> {
        let ClassDistance { distance, age } = self.near(tick, class);
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
        Some(Candidate {
            class: ClassId(class as u16),
            tick,
            age,
            distance,
            other,
            negative,
        })
    }

    /// Whether the stream ends before the peak at `tick` could be told from a class still coming nearer.
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

    fn decide(&mut self, tick: i64, judge: &mut impl FnMut(&Candidate) -> f64) {
        let mut cell = PathCell {
            ends_here: None,
            ..*self.path(tick)
        };
        for class in 0..self.classes {
            let age = self.near(tick, class).age;
            let (start, slack) = (tick - age as i64, self.slack(age));
            if start < self.reported - slack || self.repeats(class, start) {
                continue;
            }
            if self.cut_off(tick, class) {
                continue;
            }
            let Some(score) = self.score(tick, class, judge) else {
                continue;
            };
            let start = start.max(self.reported);
            for begin in start..=(start + slack).min(tick) {
                let total = self.path(begin).total + score;
                if total > cell.total + 1e-12 {
                    let ends_here = Some((begin, ClassId(class as u16), score));
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

    /// Whether a candidate that starts here is the last detection of its class over again, longer.
    fn repeats(&self, class: usize, start: i64) -> bool {
        self.params.once && start < self.ended[class] - self.params.overlap_ticks as i64
    }

    /// Ticks that a candidate of this age may reach into the detection before it.
    fn slack(&self, age: usize) -> i64 {
        let share = (self.params.overlap_share * (age + 1) as f32) as usize;
        self.params.overlap_ticks.max(share) as i64
    }

    /// Whether a match of another class that encloses `detection` may yet become a better candidate.
    fn waits(&self, detection: &TickDetection) -> bool {
        let waited = self.decided - detection.stop;
        if !matches!(self.rule, Rule::Gate { .. }) || waited >= self.params.hold_ticks as i64 {
            return false;
        }
        let last = self.ticks - 1;
        let grows = |t: i64, class: usize| {
            let ClassDistance { distance, age } = self.near(t, class);
            let encloses = t - age as i64 <= detection.start;
            let near_enough = distance < self.thresholds[class] && distance < self.gate(t);
            encloses && near_enough && (t < last || distance < self.near(t - 1, class).distance)
        };
        let mut others = (0..self.classes).filter(|c| *c != detection.class.index());
        others.any(|class| (self.decided.max(1)..=last).any(|t| grows(t, class)))
    }

    /// Reports what lies on the best path and ended at least `lag` ticks ago, up to the first that must wait.
    fn report(&mut self, lag: i64, out: &mut impl FnMut(TickDetection)) {
        let mut chain = std::mem::take(&mut self.chain);
        chain.clear();
        let oldest = self
            .reported
            .max(self.decided - self.paths.len() as i64 + 1);
        let mut tick = self.path(self.decided).last_end;
        while tick > oldest {
            let Some((start, class, score)) = self.path(tick).ends_here else {
                break;
            };
            chain.push(TickDetection {
                class,
                start,
                stop: tick,
                score,
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
                self.ended[detection.class.index()] = detection.stop;
                out(TickDetection {
                    score: detection.score.min(1.0),
                    ..*detection
                });
            }
        }
        self.chain = chain;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs one class's distances (age: always 3 ticks) through a decoder and returns spans.
    fn spans(distances: &[f32], negatives: &[f32], params: &DecodeParams) -> Vec<(i64, i64)> {
        let rule = Rule::Gate { threshold: 2.0 };
        let mut decoder = Decoder::new(params, rule, 1, 4);
        let mut judge = |_: &Candidate| 0.0;
        let mut found = vec![];
        for (t, d) in distances.iter().enumerate() {
            let negative = negatives.get(t).copied().unwrap_or(FAR);
            let near = [ClassDistance {
                distance: *d,
                age: t.min(3),
            }];
            decoder.push(&near, negative, &mut judge, &mut |d| {
                found.push((d.start, d.stop))
            });
        }
        decoder.finish(&mut judge, &mut |d| found.push((d.start, d.stop)));
        found
    }

    #[test]
    fn a_dip_below_the_threshold_is_one_detection_at_its_bottom() {
        let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0, 1.5, 5.0, 5.0, 5.0];
        assert_eq!(spans(&dip, &[], &DecodeParams::default()), [(3, 7)]);
        assert_eq!(spans(&dip, &[], &DecodeParams::reference()), [(3, 7)]);
    }

    #[test]
    fn a_dip_in_the_last_ticks_counts_once_it_no_longer_falls() {
        let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5];
        assert_eq!(spans(&dip, &[], &DecodeParams::default()), []);
        assert_eq!(spans(&dip, &[], &DecodeParams::reference()), [(3, 7)]);
        let level = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.52, 0.5];
        assert_eq!(spans(&level, &[], &DecodeParams::default()), [(4, 8)]);
        let over = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0];
        assert_eq!(spans(&over, &[], &DecodeParams::default()), [(3, 7)]);
    }

    #[test]
    fn a_nearer_negative_silences_a_class() {
        let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0, 1.5, 5.0, 5.0, 5.0];
        assert_eq!(spans(&dip, &[0.3; 12], &DecodeParams::default()), []);
        assert_eq!(spans(&dip, &[0.6; 12], &DecodeParams::default()), [(3, 7)]);
    }

    #[test]
    fn of_two_overlapping_candidates_the_better_remains_when_the_lag_allows() {
        let params = DecodeParams {
            gate: 1.2,
            gate_ticks: 0,
            peak_ticks: 0,
            lag_ticks: 4,
            overlap_ticks: 0,
            overlap_share: 0.0,
            hold_ticks: 0,
            end_fall: 1.0,
            ..DecodeParams::reference()
        };
        let twice = [5.0, 5.0, 5.0, 1.5, 1.2, 0.2, 5.0, 5.0, 5.0, 5.0, 5.0];
        assert_eq!(spans(&twice, &[], &params), [(2, 6)]);
    }

    /// Runs several classes' distances and ages; returns class, span and the tick before which each was out.
    fn reports(ticks: &[Vec<(f32, usize)>], params: &DecodeParams) -> Vec<(u16, i64, i64, usize)> {
        let mut decoder = Decoder::new(params, Rule::Gate { threshold: 2.0 }, ticks[0].len(), 20);
        let mut judge = |_: &Candidate| 0.0;
        let mut found = vec![];
        for (t, near) in ticks.iter().enumerate() {
            let near: Vec<_> = near
                .iter()
                .map(|&(distance, age)| ClassDistance {
                    distance,
                    age: age.min(t),
                })
                .collect();
            decoder.push(&near, FAR, &mut judge, &mut |d| {
                found.push((d.class.0, d.start, d.stop, t))
            });
        }
        decoder.finish(&mut judge, &mut |d| {
            found.push((d.class.0, d.start, d.stop, ticks.len()))
        });
        found
    }

    const AWAY: (f32, usize) = (9.0, 0);

    /// A short class that ends with tick 20, six ticks long, and one that began ten ticks before it and ends with
    /// tick 21, at `distance`.
    fn short_inside_long(distance: f32) -> Vec<Vec<(f32, usize)>> {
        let mut ticks = vec![vec![AWAY, AWAY]; 30];
        for (t, d) in [(19, 1.5), (20, 1.0), (21, 1.5)] {
            ticks[t][0] = (d, t - 15);
        }
        for (t, d) in [(19, 1.9), (20, 1.0), (21, 0.0), (22, 1.0)] {
            ticks[t][1] = (distance + d, t - 5);
        }
        ticks
    }

    #[test]
    fn a_short_motion_waits_for_the_longer_one_that_it_ends() {
        let params = DecodeParams {
            hold_ticks: 2,
            ..DecodeParams::default()
        };
        let once = DecodeParams {
            hold_ticks: 0,
            ..params.clone()
        };
        assert_eq!(reports(&short_inside_long(0.2), &params), [(1, 5, 22, 23)]);
        assert_eq!(reports(&short_inside_long(0.2), &once), [(0, 15, 21, 22)]);
        // The longer one is not near enough: nothing waits.
        assert_eq!(reports(&short_inside_long(3.0), &params), [(0, 15, 21, 22)]);
    }

    #[test]
    fn what_waits_in_vain_is_reported_after_its_hold() {
        let mut ticks = short_inside_long(3.0);
        // A longer class comes nearer for ever and never arrives.
        for (t, near) in ticks.iter_mut().enumerate().skip(15) {
            near[1] = (1.95 - 0.01 * t as f32, t - 5);
        }
        let params = DecodeParams {
            hold_ticks: 3,
            ..DecodeParams::default()
        };
        assert_eq!(reports(&ticks, &params)[0], (0, 15, 21, 25));
    }

    #[test]
    fn a_motion_that_overlaps_the_one_before_is_cut_not_lost() {
        let mut ticks = vec![vec![AWAY]; 40];
        for (end, age) in [(15, 9), (30, 19)] {
            for (t, d) in [(end - 1, 1.0), (end, 0.5), (end + 1, 1.0)] {
                ticks[t][0] = (d, age);
            }
        }
        let spans = |params: &DecodeParams| -> Vec<_> {
            reports(&ticks, params).iter().map(|r| (r.1, r.2)).collect()
        };
        let default = DecodeParams::default();
        assert_eq!(
            spans(&default),
            [(6, 16), (16, 31)],
            "it reaches five of its twenty ticks into the first"
        );
        assert_eq!(
            spans(&DecodeParams {
                overlap_share: 0.2,
                ..default
            }),
            [(6, 16)]
        );
    }

    #[test]
    fn classes_may_have_thresholds_of_their_own() {
        let mut decoder = Decoder::new(
            &DecodeParams::default(),
            Rule::Gate { threshold: 1.0 },
            2,
            20,
        );
        decoder.set_thresholds(&[1.0, 3.0]);
        let mut found = vec![];
        for d in [9.0, 9.0, 9.0, 9.0, 9.0, 2.5, 2.0, 2.5, 9.0, 9.0, 9.0] {
            let near = [ClassDistance {
                distance: d,
                age: 4,
            }; 2];
            decoder.push(&near, FAR, &mut |_| 0.0, &mut |d| {
                found.push((d.class.0, d.stop, d.score))
            });
        }
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].0, found[0].1), (1, 7));
        assert!(
            (found[0].2 - 1.0 / 3.0).abs() < 1e-6,
            "the score is a share of the class's own threshold"
        );
    }

    #[test]
    fn long_silence_neither_grows_memory_nor_loses_what_follows() {
        let mut stream = vec![9.0; 5000];
        stream.extend([1.0, 0.5, 1.0, 9.0, 9.0, 9.0, 9.0]);
        assert_eq!(
            spans(&stream, &[], &DecodeParams::default()),
            [(4998, 5002)]
        );
    }
}
