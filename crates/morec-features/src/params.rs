//! The parameters that turn observations into feature rows.

use crate::Profile;

/// The line whose turning about the vertical gives the heading: of a body, of which it says where the root is, too, of a custom
/// skeleton, or of a headset; none for hands.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Default,
    serde::Serialize,
    serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum HeadingLine {
    /// The hips; the shoulders until hips are seen.
    #[default]
    Hips,
    /// The shoulders, whether or not hips are seen.
    Shoulders,
    /// None: directions are the source's own, as of a device that stands still before the performer. Hands have this in any case.
    Sensor,
    /// Of a custom skeleton, the line between its points `left_point_1` and `right_point_1`.
    Points,
    /// Of a head and two hands, where the headset looks: from `head` to `face`. As of `sensor` while no `face` has been seen.
    Headset,
}

/// Parameters of resampling, smoothing and weighting. An index keeps the values it was trained with.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FeatureParams {
    /// Every source is resampled to this many frames a second before anything else.
    pub rate_hz: f64,
    /// A feature row is made of every n-th frame: 4 at 120 Hz gives 30 ticks a second.
    pub frames_per_tick: usize,
    /// Standard deviation of the Gaussian over bone directions, in frames.
    ///
    /// 25 ms.
    pub smooth_sigma_frames: f64,
    /// The Gaussian is cut off this many frames away: its half width, and its delay.
    ///
    /// 50 ms of delay.
    pub smooth_cut_frames: usize,
    /// Standard deviation of the Gaussian over root motion, in frames.
    ///
    /// Cut to the delay of the directions.
    pub root_sigma_frames: f64,
    /// Half width of the Gaussian over root motion, in frames.
    pub root_cut_frames: usize,
    /// Bone velocities saturate towards this speed, per second: people perform one motion at different speeds.
    pub velocity_saturation: f64,
    /// Weight of velocities against directions.
    pub velocity_weight: f64,
    /// Weight of root motion against directions.
    pub root_weight: f64,
    /// True if the filters follow the noise of the stream: as given while it is clean, longer as they must be.
    ///
    /// Without it 1 cm of white noise on referee signals by clip gave F1 0.765 instead of 0.947, 2 cm 0 instead of
    /// 0.911; nothing changes on clean clips.
    #[serde(default = "follows_noise")]
    pub follow_noise: bool,
    /// Line of the body that gives the heading and the root: `hips` (shoulders until hips are seen) or `shoulders`, which training
    /// takes by itself where a clip with samples shows no hips; `sensor` for directions as the source has them; `points` of a custom
    /// skeleton; `headset` of a head and two hands, which training takes where every clip with samples shows the `face`.
    #[serde(default)]
    pub heading: HeadingLine,
}

/// Indexes that say nothing of it gain by it: on clean streams nothing changes.
fn follows_noise() -> bool {
    true
}

impl FeatureParams {
    /// The usual ones of performers of this kind.
    pub fn usual(profile: Profile) -> Self {
        let body = Self::default();
        let sensor = Self {
            heading: HeadingLine::Sensor,
            ..body.clone()
        };
        match profile {
            Profile::Body => body,
            Profile::Points3 => sensor,
            Profile::Custom => Self {
                heading: HeadingLine::Points,
                ..body
            },
            // Fingers are faster for their length than limbs, and a hand's travel tells a push from a wave.
            Profile::Hand | Profile::Hands => Self {
                velocity_saturation: 4.0,
                root_weight: 0.6,
                ..sensor
            },
        }
    }
}

impl Default for FeatureParams {
    /// As chosen on referee signals, with the root's smoothing cut to the delay of the directions'.
    fn default() -> Self {
        Self {
            root_sigma_frames: 4.0,
            root_cut_frames: 6,
            follow_noise: true,
            ..Self::reference()
        }
    }
}

impl FeatureParams {
    /// [`root_weight`](Self::root_weight) unless said otherwise.
    pub const ROOT_WEIGHT: f64 = 0.3;

    /// The values of the reference prototype, whose golden figures the tests hold us to.
    pub fn reference() -> Self {
        Self {
            rate_hz: 120.0,
            frames_per_tick: 4,
            smooth_sigma_frames: 3.0,
            smooth_cut_frames: 6,
            root_sigma_frames: 6.0,
            root_cut_frames: 12,
            velocity_saturation: 2.0,
            velocity_weight: 0.5,
            root_weight: Self::ROOT_WEIGHT,
            follow_noise: false,
            heading: HeadingLine::Hips,
        }
    }

    /// Feature rows a second.
    pub fn tick_hz(&self) -> f64 {
        self.rate_hz / self.frames_per_tick as f64
    }

    /// Frames that must follow a frame before its features are known: the filters' half width and one more for
    /// the central difference.
    pub fn look_ahead_frames(&self) -> usize {
        self.smooth_cut_frames.max(self.root_cut_frames) + 1
    }

    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        let positive = [
            ("rate_hz", self.rate_hz),
            ("smooth_sigma_frames", self.smooth_sigma_frames),
            ("root_sigma_frames", self.root_sigma_frames),
            ("velocity_saturation", self.velocity_saturation),
        ];
        if let Some((name, value)) = positive.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
            return Err(format!("{name} must be above 0, found {value}"));
        }
        let weights = [
            ("velocity_weight", self.velocity_weight),
            ("root_weight", self.root_weight),
        ];
        // Directions have the weight 1: beside a weight beyond all use nothing else would count.
        if let Some((name, value)) = weights.iter().find(|(_, v)| !(0.0..=100.0).contains(v)) {
            return Err(format!("{name} must be 0 to 100, found {value}"));
        }
        if !(1..=64).contains(&self.frames_per_tick) {
            return Err(format!(
                "frames_per_tick must be 1 to 64, found {}",
                self.frames_per_tick
            ));
        }
        let widest = self.smooth_cut_frames.max(self.root_cut_frames);
        if widest > 63 {
            return Err(format!(
                "filters must be at most 63 frames a side, found {widest}"
            ));
        }
        // A push makes every frame since the one before: a rate without bounds would be a push without end. At a few frames a
        // second no motion is seen.
        if !(10.0..=1000.0).contains(&self.rate_hz) {
            return Err(format!(
                "rate_hz must be 10 to 1000, found {}",
                self.rate_hz
            ));
        }
        Ok(())
    }
}
