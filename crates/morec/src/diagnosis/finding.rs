//! Faults of a stream and their severity.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::math::Axis;
use crate::roles::Role;

use super::role_set::RoleSet;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Good to know; recognition works.
    Info,
    /// Recognition works less well, or some motions cannot be recognised.
    Warning,
    /// Nothing, or only nonsense, can be recognised in this stream.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Severity::Info => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

/// Something that is wrong with a stream, or worth knowing of it. Its [`Display`](fmt::Display) is a sentence with what
/// to do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// Frames come, but show no body: no joint at all, or all of them at one place.
    Nobody {
        /// Share of such frames.
        share: f64,
    },
    /// Times are not seconds.
    TimeUnit {
        /// From one frame to the next by the stream's own times.
        interval_secs: f64,
    },
    /// Times do not go on.
    TimeStands {
        /// Share of the frames whose time is not after that of the frame before.
        share: f64,
    },
    /// Neither both hip joints nor both shoulders are seen, so it is unknown which way the body faces.
    NoHeading,
    /// The body stands on its head: Y points down.
    UpsideDown {
        /// True if turning Y round is enough (the coordinates are left-handed); otherwise Z must be turned, too.
        mirrored: bool,
    },
    /// The body lies along an axis that is not Y: most likely that axis is up.
    UpIsNotY {
        /// The axis along which the body stands.
        axis: Axis,
        /// True if the body points against it.
        negative: bool,
        /// True if the coordinates are left-handed.
        mirrored: bool,
    },
    /// A standing body is not upright.
    Tilted {
        /// From the vertical, radians.
        tilt_rad: f64,
    },
    /// Left and right are exchanged, or the coordinates are left-handed: knees bend backwards.
    SidesExchanged,
    /// Nothing has moved for a while, not even by a tenth of a millimetre.
    Frozen {
        /// For how long, seconds.
        secs: f64,
    },
    /// Parts of the body are never seen.
    JointsMissing {
        /// Parts of the body that are concerned.
        roles: RoleSet,
    },
    /// Parts of the body come and go.
    JointsFlicker {
        /// Parts of the body that are concerned.
        roles: RoleSet,
    },
    /// The size of the body is not a person's in any common unit of length.
    UnknownUnit {
        /// Length of a leg, in the stream's unit.
        leg: f64,
    },
    /// Positions jitter.
    Noisy {
        /// Standard deviation on each coordinate, metres.
        noise_m: f64,
    },
    /// Joints are thrown aside in single frames.
    Spikes {
        /// Share of the frames in which one is.
        share: f64,
    },
    /// Few frames a second.
    SlowRate {
        /// Frames a second.
        rate_hz: f64,
    },
    /// Frames are missing.
    FramesLost {
        /// Share of the frames that were due.
        share: f64,
    },
    /// Frames show the same pose as the one before.
    FramesRepeated {
        /// Share of the frames.
        share: f64,
    },
    /// Frames come unevenly.
    UnevenArrival {
        /// Half the range of nine tenths of the intervals.
        jitter_secs: f64,
    },
    /// The feet never stand, though they move together: the body glides over the floor.
    MovingFloor,
    /// The hips do not move while the hands do.
    HipsFixed,
    /// A hand is away again and again, for longer than recognition bridges.
    HandLost {
        /// How often a minute.
        per_minute: f64,
    },
    /// Left and right hand change places.
    HandsSwap {
        /// How often a minute.
        per_minute: f64,
    },
}

/// Parts that most gestures are made of.
const ARMS: [Role; 6] = [
    Role::LeftArm,
    Role::LeftForearm,
    Role::LeftHand,
    Role::RightArm,
    Role::RightForearm,
    Role::RightHand,
];

impl Finding {
    /// Severity of the finding.
    pub fn severity(&self) -> Severity {
        use Finding::*;
        match *self {
            Nobody { share } if share < 0.9 => Severity::Warning,
            TimeStands { share } if share < 0.5 => Severity::Warning,
            SlowRate { rate_hz } if rate_hz < 3.0 => Severity::Error,
            Nobody { .. } | TimeUnit { .. } | TimeStands { .. } | NoHeading => Severity::Error,
            UpsideDown { .. } | UpIsNotY { .. } | SidesExchanged => Severity::Error,
            JointsMissing { roles } if !ARMS.iter().any(|arm| roles.contains(*arm)) => {
                Severity::Info
            }
            Noisy { noise_m } if noise_m < 0.01 => Severity::Info,
            Frozen { .. } | Tilted { .. } | JointsMissing { .. } | JointsFlicker { .. } => {
                Severity::Warning
            }
            Noisy { .. } | Spikes { .. } | SlowRate { .. } | FramesLost { .. } | MovingFloor => {
                Severity::Warning
            }
            HandLost { .. } | HandsSwap { .. } => Severity::Warning,
            UnevenArrival { .. } | UnknownUnit { .. } | FramesRepeated { .. } | HipsFixed => {
                Severity::Info
            }
        }
    }

    /// Severity and sentence of the finding in a file: which way is up was inferred and can be given, and nothing is sent.
    pub fn of_file(&self) -> (Severity, String) {
        let text = match self {
            Finding::UpIsNotY { .. } => {
                "the body lies for most of the clip; if it stands, say which way is up with --up AXIS"
            }
            Finding::UpsideDown { .. } => {
                "the head is below the feet for most of the clip; unless the performer stands on the hands, set the up axis with --up AXIS"
            }
            finding => return (finding.severity(), finding.to_string()),
        };
        (Severity::Warning, text.to_owned())
    }

    /// A few words for a status line.
    pub fn label(&self) -> &'static str {
        use Finding::*;
        match self {
            Nobody { .. } => "nobody there",
            TimeUnit { .. } => "time is not in seconds",
            TimeStands { .. } => "times do not increase",
            NoHeading => "no hip joints or shoulders",
            UpsideDown { .. } => "upside down",
            UpIsNotY { .. } => "Y is not up",
            Tilted { .. } => "tilted",
            SidesExchanged => "left and right exchanged",
            Frozen { .. } => "nothing moves",
            JointsMissing { .. } => "joints missing",
            JointsFlicker { .. } => "joints come and go",
            UnknownUnit { .. } => "odd size",
            Noisy { .. } => "noisy",
            Spikes { .. } => "spikes",
            SlowRate { .. } => "few frames",
            FramesLost { .. } => "frames lost",
            FramesRepeated { .. } => "frames repeated",
            UnevenArrival { .. } => "uneven arrival",
            MovingFloor => "moving floor",
            HipsFixed => "hips do not move",
            HandLost { .. } => "hand comes and goes",
            HandsSwap { .. } => "hands change places",
        }
    }

    /// One bit for each kind of finding, the same in every release.
    pub fn bit(&self) -> u32 {
        use Finding::*;
        1 << match self {
            Nobody { .. } => 0,
            TimeUnit { .. } => 1,
            TimeStands { .. } => 2,
            NoHeading => 3,
            UpsideDown { .. } => 4,
            UpIsNotY { .. } => 5,
            Tilted { .. } => 6,
            SidesExchanged => 7,
            Frozen { .. } => 8,
            JointsMissing { .. } => 9,
            JointsFlicker { .. } => 10,
            UnknownUnit { .. } => 11,
            Noisy { .. } => 12,
            Spikes { .. } => 13,
            SlowRate { .. } => 14,
            FramesLost { .. } => 15,
            FramesRepeated { .. } => 16,
            UnevenArrival { .. } => 17,
            MovingFloor => 18,
            HipsFixed => 19,
            HandLost { .. } => 20,
            HandsSwap { .. } => 21,
        }
    }
}
