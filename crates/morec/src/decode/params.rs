//! The parameters of decoding.

/// Spread of a usual template of a body under a trained metric, the median over referee signals and Kinect gestures.
pub const TYPICAL_SPREAD: f32 = 1.7;

/// Parameters of decoding: from distances to detections. An index keeps the values it was trained with; fields that older indexes lack
/// take values that change nothing.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DecodeParams {
    /// A class's distance counts only while it is below this times the smallest distance to any negative
    /// template nearby.
    ///
    /// The prototype's 1.2 gave 59 false positives and 82 misses over 12 half splits, 1.0 gave 35 and 95.
    pub gate: f32,
    /// Number of ticks before and after that count as nearby.
    ///
    /// Short windows are as accurate as the prototype's long ones (3, 2, 3) and a quarter of a second earlier.
    pub gate_ticks: usize,
    /// A candidate's distance must be the smallest of this many ticks before and after.
    pub peak_ticks: usize,
    /// A detection is held back until it ended this many ticks ago, in case a better one takes its place.
    pub lag_ticks: usize,
    /// A candidate may reach this many ticks into the detection before it; the overlap is cut off.
    pub overlap_ticks: usize,
    /// It may also reach this share of its own length into a detection of another class, if that is more: what was
    /// reported a little too long must not swallow the motion that follows.
    ///
    /// Without it a quarter of the misses in half splits.
    #[serde(default)]
    pub overlap_share: f32,
    /// A detection waits up to this many ticks while another class's match that encloses it passes the threshold and still
    /// coming nearer: a short motion may only be the end of a longer one. Under [`CandidatePolicy::Verify`] nothing waits.
    ///
    /// 3 gives the same.
    #[serde(default)]
    pub hold_ticks: usize,
    /// Exponent by which distances are normalised with the spread of template and matched stretch, 0 … 1: see
    /// [`Matcher`](crate::templates::Matcher).
    ///
    /// F1 on referee by clip and by person, Kinect sessions by the same person and by others: 0.920, 0.872, 0.778,
    /// 0.724 at 0; 0.960, 0.901, 0.799, 0.754 at 0.75; 0.960, 0.864, 0.811, 0.762 at 1; chosen on these four; 0 in
    /// older indexes.
    #[serde(default)]
    pub spread_exponent: f32,
    /// Spread of a usual template, `V_0` of [`Matcher`](crate::templates::Matcher): a body's, or the median of those of the index.
    #[serde(default = "of_bodies")]
    pub typical_spread: f32,
    /// A match counts only if it is nearer than this share of the distance of a body that stands still in the mean
    /// pose of the matched stretch (see [`Matcher`](crate::templates::Matcher)). 0 admits everything.
    ///
    /// With `decode.rest_spread` at 0.5, F1 on referee by clip and by person, Kinect sessions by the same person
    /// and by others: 0.58: 0.917, 0.750, 0.855, 0.813; 0.60 (two faster copies): 0.949, 0.864, 0.855, 0.805; 0.62:
    /// 0.960, 0.889, 0.841, 0.808; 0.64: 0.960, 0.901, 0.818, 0.800; 0.66: 0.960, 0.901, 0.807, 0.774; 0 in older
    /// indexes.
    #[serde(default)]
    pub rest_gate: f32,
    /// The same under [`CandidatePolicy::Verify`], where motion is evidence besides.
    ///
    /// With many samples the verifier weighs motion itself: gestures by person, right and `dontcare` accepted,
    /// 0.70: 0.951, 0.040; 0.75: 0.978, 0.040; 0.85: 0.973, 0.020.
    #[serde(default)]
    pub rest_gate_verified: f32,
    /// Share of the matched stretch's own spread that is added to that distance, 0 … 1: a body that moves is not held against
    /// standing still alone.
    ///
    /// Each with its best `decode.rest_gate`, F1 as there: 0 (0.77): 0.959, 0.899, 0.836, 0.779; 0.25 (0.70):
    /// 0.960, 0.901, 0.830, 0.797; 0.5 (0.62): 0.960, 0.889, 0.841, 0.808; 1 (0.50): 0.949, 0.780, 0.834, 0.812.
    /// Not looked at while choosing: half splits of 17 referee classes 0.934 instead of 0.927; gestures by person
    /// from 5 and 10 samples a class 0.761 and 0.880 right instead of 0.735 and 0.845; 0 in older indexes.
    #[serde(default)]
    pub rest_spread: f32,
    /// At most this share of a distance is taken for noise, which is measured in the stream: see
    /// [`Matcher`](crate::templates::Matcher). 0: none is.
    ///
    /// 0.5 and 0.75 alike on referee signals and Kinect actions as a webcam sees them; a bound where the
    /// measurement errs; 0 in older indexes.
    #[serde(default)]
    pub noise_share: f32,
    /// True if a candidate may reach only [`overlap_ticks`](Self::overlap_ticks) into the last detection of its own
    /// class, so that a motion out and the same motion out and back are not two detections.
    ///
    /// Without it, a short template reports the way out and a long one the way out and back of the same motion.
    #[serde(default)]
    pub once: bool,
    /// Under [`CandidatePolicy::Gate`], a candidate is refused if another class has a match around its end that is nearer than
    /// this share of the candidate's distance; 0: never.
    ///
    /// 1.0, 1.05, 1.1: sessions, same person, 0.841, 0.844, 0.848, by others 0.808, 0.815, 0.813; everyday motion
    /// by style 0.576, 0.590, 0.588; half splits of 17 referee classes 0.934, 0.934, 0.933; figures 1 and 2 alike.
    /// Without it the first was 0.700, with it 0.790, both before later changes.
    #[serde(default)]
    pub rival_share: f32,
    /// Ticks around a candidate's end in which such a match may end.
    ///
    /// 3, 6, 10, 15: half splits of 17 referee classes, seeds 13 to 18, F1 0.929, 0.933, 0.939, 0.943; sessions,
    /// same person, 0.824 to 0.836; figures 1 and 2 alike.
    #[serde(default)]
    pub rival_ticks: usize,
    /// The match of the other class must cover this share of the candidate.
    ///
    /// As `decode.rival_share`: 0.3 a little better than 0.5, 0.8 worse.
    #[serde(default)]
    pub rival_overlap: f32,
    /// A candidate that starts within [`tail_ticks`](Self::tail_ticks) of the end of a detection of its class is the
    /// end of the last repetition, not another one, if its spread is below this share of the largest spread among
    /// those of the last second; 0: all are repetitions.
    ///
    /// The last, partial repetition of a run moved 0.24 to 0.60 of what the repetitions moved, repetitions 0.78 and
    /// more; seen on one class of one person, so it is the least sure of these.
    #[serde(default)]
    pub tail_spread: f32,
    /// See [`tail_spread`](Self::tail_spread).
    #[serde(default)]
    pub tail_ticks: usize,
    /// A motion may end with the very last ticks of a stream only if its distance fell by less than this share over
    /// the last tick: a walk cut off in mid-step is nearest to a step at the cut, but still coming nearer.
    pub end_fall: f32,
}

fn of_bodies() -> f32 {
    TYPICAL_SPREAD
}

impl Default for DecodeParams {
    /// Chosen on referee signals and on sessions before a Kinect; the fields have the reasons.
    fn default() -> Self {
        Self {
            gate: 1.0,
            gate_ticks: 0,
            peak_ticks: 1,
            lag_ticks: 0,
            overlap_ticks: 2,
            overlap_share: 0.5,
            hold_ticks: 2,
            spread_exponent: 0.85,
            typical_spread: TYPICAL_SPREAD,
            rest_gate: 0.60,
            rest_gate_verified: 0.85,
            rest_spread: 0.5,
            noise_share: 0.5,
            once: true,
            rival_share: 1.05,
            rival_ticks: 15,
            rival_overlap: 0.3,
            tail_spread: 0.7,
            tail_ticks: 6,
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
            spread_exponent: 0.0,
            typical_spread: TYPICAL_SPREAD,
            rest_gate: 0.0,
            rest_gate_verified: 0.0,
            rest_spread: 0.0,
            noise_share: 0.0,
            once: false,
            rival_share: 0.0,
            rival_ticks: 0,
            rival_overlap: 0.0,
            tail_spread: 0.0,
            tail_ticks: 0,
            end_fall: f32::MAX,
        }
    }

    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        if !(self.gate.is_finite() && self.gate > 0.0) {
            return Err(format!("gate must be above 0, found {}", self.gate));
        }
        if self.end_fall.is_nan() || self.end_fall < 0.0 {
            return Err(format!(
                "end_fall must be 0 or more, found {}",
                self.end_fall
            ));
        }
        if !(1e-6..=1e6).contains(&self.typical_spread) {
            return Err(format!(
                "typical_spread must be above 0, found {}",
                self.typical_spread
            ));
        }
        self.check_shares()?;
        let ticks = [
            ("gate_ticks", self.gate_ticks),
            ("peak_ticks", self.peak_ticks),
            ("lag_ticks", self.lag_ticks),
            ("overlap_ticks", self.overlap_ticks),
            ("hold_ticks", self.hold_ticks),
            ("rival_ticks", self.rival_ticks),
            ("tail_ticks", self.tail_ticks),
        ];
        match ticks.iter().find(|(_, ticks)| *ticks > MOST_TICKS) {
            Some((name, ticks)) => Err(format!(
                "{name} must be at most {MOST_TICKS}, found {ticks}"
            )),
            None => Ok(()),
        }
    }

    fn check_shares(&self) -> Result<(), String> {
        let shares = [
            ("overlap_share", self.overlap_share, 0.999),
            ("spread_exponent", self.spread_exponent, 1.0),
            ("rest_gate", self.rest_gate, 2.0),
            ("rest_gate_verified", self.rest_gate_verified, 2.0),
            ("rest_spread", self.rest_spread, 1.0),
            ("noise_share", self.noise_share, 0.99),
            ("rival_share", self.rival_share, 2.0),
            ("rival_overlap", self.rival_overlap, 1.0),
            ("tail_spread", self.tail_spread, 1.0),
        ];
        match shares
            .iter()
            .find(|(_, v, most)| !(0.0..=*most).contains(v))
        {
            Some((name, found, most)) => Err(format!("{name} must be 0 to {most}, found {found}")),
            None => Ok(()),
        }
    }

    /// Ticks that must follow a motion's last tick before it can be reported.
    pub fn look_ahead_ticks(&self, rule: CandidatePolicy) -> usize {
        self.window_ticks(rule) + self.lag_ticks
    }

    /// Matches count below this share of a motionless body's distance.
    pub fn rest_share(&self, rule: CandidatePolicy) -> f32 {
        match rule {
            CandidatePolicy::Gate { .. } => self.rest_gate,
            CandidatePolicy::Verify { .. } => self.rest_gate_verified,
        }
    }

    /// Ticks that must follow a tick before it is known whether it is a candidate.
    pub(super) fn window_ticks(&self, rule: CandidatePolicy) -> usize {
        match rule {
            CandidatePolicy::Gate { .. } => self.gate_ticks + self.peak_ticks,
            CandidatePolicy::Verify { .. } => self.peak_ticks,
        }
    }
}

/// Policy by which distances become candidates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CandidatePolicy {
    /// Distances below the class's threshold and below [`DecodeParams::gate`] times the smallest negative distance
    /// nearby; the score is 1 − distance / threshold.
    Gate {
        /// Distances at or above this are never reported, unless
        /// [`Decoder::set_thresholds`](super::Decoder::set_thresholds) says otherwise.
        threshold: f32,
    },
    /// Distances up to `reach`; a judge gives the score, and above 0 is accepted.
    Verify {
        /// Farther ones are not looked at.
        reach: f32,
    },
}

/// No window is wider than this: ten seconds of waiting are no live recognition.
const MOST_TICKS: usize = 300;
