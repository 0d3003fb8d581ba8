//! Measurements of a stream.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::features::Profile;

use super::role_set::RoleSet;

/// Offsets of joints towards the front of a body, as shares of its trunk's length; the front is where it would be if the
/// joint that is called the left hip were the left one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SideEvidence {
    /// Knees before the line from hip to ankle: positive in people.
    pub knees: Option<f64>,
    /// Elbows before the line from shoulder to wrist: negative in people.
    pub elbows: Option<f64>,
    /// Hands before the shoulders: positive, mostly.
    pub hands: Option<f64>,
}

impl SideEvidence {
    /// Evidence for the sides, weighed; negative if more speaks against them. `None` if too little is seen.
    ///
    /// The weights are those of a search for the widest margin over the 795 real clips of `examples/diagnose.rs`, whose
    /// sums lie from 0.03 to 0.6 (97 of 100 above 0.08); of mirrored clips they are the negative.
    pub fn sum(&self) -> Option<f64> {
        let knees = self.knees.map(|knees| 0.7 * knees.clamp(-0.2, 0.2));
        let elbows = self.elbows.map(|elbows| -0.5 * elbows);
        let hands = self.hands.map(|hands| 0.5 * hands.clamp(-0.5, 0.5));
        let all = [knees, elbows, hands];
        let known = all.iter().flatten().count();
        (known >= 2).then(|| all.into_iter().flatten().sum())
    }
}

/// Measurements of a stream, or of a clip, and [their meaning](Self::findings).
///
/// Lengths are metres by a [guess](Self::metres_per_unit) of the stream's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Frames looked at, late ones included.
    pub frames: u64,
    /// From the first to the last by their own times.
    pub secs: f64,
    /// Frames a second by their own times: one over the median interval.
    pub rate_hz: Option<f64>,
    /// Half the range of nine tenths of the intervals at which frames arrived.
    pub jitter_secs: Option<f64>,
    /// Share of the frames that were due and did not come, by gaps in their times.
    pub lost_share: f64,
    /// Share of the frames that show what the frame before showed.
    pub repeated_share: f64,
    /// Share of the frames whose time is not after that of the frame before.
    pub late_share: f64,
    /// Share of the frames that show no body.
    pub empty_share: f64,
    /// Metres in the stream's unit of length, guessed by the length of legs, of the trunk or of arms, the first that is seen.
    pub metres_per_unit: f64,
    /// True if the unit is a common one.
    pub unit_known: bool,
    /// From the ankles to the head joint along the bones, metres.
    pub height_m: Option<f64>,
    /// Thigh and shin, metres.
    pub leg_m: Option<f64>,
    /// Upper arm and forearm, metres.
    #[serde(default)]
    pub arm_m: Option<f64>,
    /// Mean direction of a standing body; a unit vector.
    pub up: Option<[f64; 3]>,
    /// True if `up` is that of a body seen standing straight, legs included.
    pub stands: bool,
    /// The angle of `up` with +Y, radians.
    pub tilt_rad: Option<f64>,
    /// Standard deviation of fast noise on each coordinate, metres.
    pub noise_m: Option<f64>,
    /// Share of the frames in which a joint is thrown aside.
    pub spike_share: f64,
    /// What is shown: a body, hands, tracked points.
    #[serde(default)]
    pub profile: Profile,
    /// A hand from the wrist to the tip of its middle finger, metres.
    #[serde(default)]
    pub hand_m: Option<f64>,
    /// How often a minute a hand is away for longer than [`MAX_GAP_SECS`](crate::features::MAX_GAP_SECS).
    #[serde(default)]
    pub losses_per_minute: f64,
    /// How often a minute the left and the right hand change places.
    #[serde(default)]
    pub swaps_per_minute: f64,
    /// What is seen at all.
    #[serde(default)]
    pub seen: RoleSet,
    /// Of what such a [`profile`](Self::profile) has, what is never seen.
    pub missing: RoleSet,
    /// Of that, what is seen in less than four fifths of the frames; points of a hand: of the frames that show the hand.
    pub flickering: RoleSet,
    /// Evidence on whether the sides are right.
    pub sides: SideEvidence,
    /// For how long nothing has moved (in a clip: the longest such time), seconds.
    pub still_secs: f64,
    /// Distance of the hips from their mean position, metres.
    pub hips_m: Option<f64>,
    /// Distance of the livelier hand from its mean position, as seen from the hips, metres.
    pub hands_m: Option<f64>,
    /// Of the time in which the feet do not move against each other, the share in which they stand.
    pub standing_share: Option<f64>,
    /// True if some joint has turned; `None` where nobody has [looked](super::Diagnoser::see_turns).
    #[serde(default)]
    pub turns: Option<bool>,
}

impl Diagnosis {
    /// The noise where its unit is known: points of a custom skeleton may be pixels of a picture.
    pub(super) fn metric_noise(&self) -> Option<f64> {
        self.noise_m.filter(|_| self.profile != Profile::Custom)
    }
}

impl fmt::Display for Diagnosis {
    /// The figures in a line: `body 1.52 m, legs 0.84 m, upright; noise 0.1 cm; 60.0 Hz ± 1 ms`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.height_m, self.leg_m) {
            (Some(height), Some(leg)) => write!(f, "body {height:.2} m, legs {leg:.2} m")?,
            (Some(height), None) => write!(f, "body {height:.2} m")?,
            (None, Some(leg)) => write!(f, "legs {leg:.2} m")?,
            (None, None) => match self.arm_m {
                Some(arm) => write!(f, "half a body, arms {arm:.2} m")?,
                None => match self.hand_m.filter(|_| self.profile != Profile::Body) {
                    Some(hand) => {
                        write!(f, "{}, {:.0} cm long", self.profile.words(), 100.0 * hand)?
                    }
                    None if matches!(self.profile, Profile::Points3 | Profile::Custom) => {
                        f.write_str(self.profile.words())?
                    }
                    None => f.write_str("no body")?,
                },
            },
        }
        match self.tilt_rad.map(f64::to_degrees) {
            Some(tilt) if tilt <= 12.0 => f.write_str(", upright")?,
            Some(tilt) if self.stands => write!(f, ", {tilt:.0}° from upright")?,
            _ => {}
        }
        if let Some(noise_m) = self.metric_noise() {
            write!(f, "; noise {:.1} cm", 100.0 * noise_m)?;
        }
        if let Some(rate_hz) = self.rate_hz {
            write!(f, "; {rate_hz:.1} Hz")?;
        }
        if let Some(jitter_secs) = self.jitter_secs {
            write!(f, " ± {:.0} ms", 1000.0 * jitter_secs)?;
        }
        if self.lost_share >= 0.005 {
            write!(f, ", {:.0} % lost", 100.0 * self.lost_share)?;
        }
        Ok(())
    }
}
