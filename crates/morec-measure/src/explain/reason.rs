//! Reasons for missed samples, with their sentences for tables and reports.

use std::fmt;

use morec::TimeSpan;

/// Reason why a sample was not reported.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Reason {
    /// The index does not know the class.
    NoSuchClass,
    /// The clip shows none of the index's bones.
    Unseen,
    /// No template matches any stretch of it: it is performed at less than half or more than twice the speed of every
    /// sample.
    NoMatch,
    /// The nearest template is too far.
    Far {
        /// Normalised distance of the nearest template.
        distance: f32,
        /// Distances at or above this are not reported.
        threshold: f32,
        /// The bones that differ most from the nearest template.
        bones: Vec<BoneOff>,
    },
    /// It moves too little, or too differently, to be distinguished from a body that stands still.
    Still {
        /// Its distance as a share of that of a motionless body, or of one in other motion.
        share: f32,
        /// Shares at or above this are not reported.
        most: f32,
    },
    /// It would pass the gate for a performer unlike the training subjects, but earlier reports of this performer had small distances.
    Unlike {
        /// Distance of the nearest template, without the difference of stance.
        distance: f32,
        /// Distances below this are reported of such a performer.
        threshold: f32,
    },
    /// The whole motion is not similar enough to the samples, or more similar to another class.
    Whole {
        /// Its score, by the better of its extents.
        score: f32,
        /// Scores above this are reported.
        bound: f32,
        /// The class that it is nearest to, if that is another one.
        other: Option<String>,
    },
    /// Background motion is nearer.
    Background {
        /// Distance of the class.
        distance: f32,
        /// Distance of the nearest negative template.
        negative: f32,
    },
    /// Another class is nearer than [`DecodeParams::rival_share`](morec::decode::DecodeParams::rival_share) times the distance.
    OtherClass {
        /// Name of the class.
        class: String,
        /// Distance of the sample's class.
        distance: f32,
        /// Distance of the other class.
        other: f32,
    },
    /// An activity that continues unlike the samples of its class: the mean of its windows' distances, as shares of their
    /// distances from what is no activity.
    GoesOnUnlike {
        /// Its share; below 1 counts.
        share: f64,
        /// The nearest other activity and its share, if that is nearer.
        nearer: Option<(String, f64)>,
    },
    /// An activity that does not go on for long enough.
    Short {
        /// Its length in seconds.
        secs: f64,
        /// An activity is recognised from this length on.
        least_secs: f64,
    },
    /// The verifier refused it.
    Refused {
        /// Its score; above 0 is accepted.
        score: f64,
        /// Distance of the nearest other class, as a multiple of the class's.
        other: f64,
        /// Distance of the nearest negative template, likewise.
        background: f64,
    },
    /// A detection took its place.
    Neighbour {
        /// True if the detection is of the same class.
        same: bool,
        /// Class of the detection.
        class: String,
        /// Start and stop, seconds.
        #[serde(flatten)]
        span: TimeSpan,
    },
    /// It passed the threshold; its best match ends outside the sample.
    Elsewhere,
}

/// A bone that points elsewhere than that of the nearest template.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct BoneOff {
    /// Name of the bone.
    pub bone: &'static str,
    /// Mean angle between the two along the warping path, in degrees.
    pub degrees: f64,
}

impl Reason {
    /// A few words that count reasons of one kind together.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoSuchClass => "class not in the index",
            Self::Unseen => "no bone in common",
            Self::NoMatch => "too slow or too fast",
            Self::Far { .. } => "too different from the samples",
            Self::Still { .. } => "too little movement",
            Self::Unlike { .. } => "performed unlike the samples",
            Self::Whole { other: Some(_), .. }
            | Self::OtherClass { .. }
            | Self::GoesOnUnlike {
                nearer: Some(_), ..
            } => "similar to another class",
            Self::Whole { other: None, .. } => "too different as a whole motion",
            Self::Background { .. } => "similar to background motion",
            Self::GoesOnUnlike { .. } => "continues unlike the samples",
            Self::Short { .. } => "too short",
            Self::Refused { .. } => "not clear enough",
            Self::Neighbour { .. } => "part of another motion",
            Self::Elsewhere => "ends outside the label",
        }
    }
}

/// By how much a limit was missed, in words; what is out of reach of every template has a distance that stands for none.
fn over(distance: f32, threshold: f32) -> String {
    let percent = 100.0 * (distance / threshold - 1.0);
    match percent < 1000.0 {
        true => format!("{percent:.0} % over the limit"),
        false => "far over the limit".to_owned(),
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchClass => f.write_str("the index does not have this class"),
            Self::Unseen => f.write_str("the clip has none of the bones that the index uses"),
            Self::NoMatch => f.write_str(
                "less than half as fast as every sample, or more than twice: add samples at that speed",
            ),
            Self::Far {
                distance,
                threshold,
                bones,
            } => {
                let over = over(*distance, *threshold);
                write!(f, "too different from the samples, {over}")?;
                for (i, off) in bones.iter().enumerate() {
                    let before = if i == 0 { "; most in" } else { "," };
                    let bone = off.bone.replace('_', " ");
                    write!(f, "{before} {bone} ({:.0}°)", off.degrees)?;
                }
                Ok(())
            }
            Self::Still { .. } => f.write_str("too little movement to distinguish from standing still"),
            Self::Unlike { .. } => f.write_str(
                "performed unlike the samples: accepted after four motions by a performer unlike the training subject, or with --performer anyone",
            ),
            Self::Whole { score, bound, other } => {
                if let Some(other) = other {
                    write!(f, "as a whole motion more similar to {other}")?;
                } else {
                    f.write_str("as a whole motion not similar enough to the samples")?;
                }
                write!(f, " (score {score:.2}, reported above {bound:.2})")
            }
            Self::Background { .. } => {
                f.write_str("more similar to background motion than to the samples")
            }
            Self::OtherClass {
                class,
                distance,
                other,
            } => {
                let how = if other < distance { "more" } else { "about as" };
                let than = if other < distance { "than" } else { "as" };
                write!(f, "{how} similar to {class} {than} to the samples of its own class")
            }
            Self::GoesOnUnlike { nearer, .. } => match nearer {
                Some((class, _)) => write!(f, "continues more like {class} than like the samples of its own class"),
                None => f.write_str("continues unlike the samples of its class"),
            },
            Self::Short { secs, least_secs } => write!(
                f,
                "lasts {secs:.1} s, but an activity is recognised only from {least_secs:.1} s"
            ),
            Self::Refused {
                other, background, ..
            } => {
                let what = if other < background { "another class" } else { "background motion" };
                write!(f, "not clear enough: nearly as similar to {what} as to the samples of its own class")
            }
            Self::Neighbour {
                same,
                class,
                span,
            } => {
                let what = if *same { "part of the same motion" } else { class };
                let (from, to) = (span.start_secs, span.stop_secs);
                write!(f, "taken as {what}, reported from {from:.2} s to {to:.2} s")
            }
            Self::Elsewhere => f.write_str("similar enough, but the motion that matches ends outside the label"),
        }
    }
}
