//! Evaluation: measures of detections, compared with labelled samples. Used by `evaluate`, `crossval`, the studio and tests;
//! reads no files.
//!
//! [`Evaluation::of`] computes every measure, [`timelines`] says of each sample and each detection what became of
//! it. Both are functions of their arguments alone and do not depend on the order of rows.
//!
//! Two kinds of streams are distinguished. In *known* streams samples are labelled, and what is not labelled is
//! known to be none of the classes. *Unknown* streams ([`StreamInfo::unknown`]) hold none of the classes at all:
//! they count towards [`UnknownFigures`] alone, so that adding hours of rest cannot raise an accuracy.
//!
//! Measures and their sources: thesis accuracy ([`ThesisAccuracy`], §5.4), F1 at overlap ([`OverlapScore`]),
//! false alarms ([`FalseAlarms`]), delay and boundary errors ([`Delay`], [`Boundaries`]), P_C, P_E and P_R
//! ([`Classification`], §5.3), time and order ([`FrameScore`]) and the confusion matrix ([`Confusion`]).
//!
//! ```
//! use morec::TimeSpan;
//! use morec::labels::{ClipDetection, GroundTruth, StreamInfo};
//! use morec_measure::eval::Evaluation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let stream = StreamInfo { clip: "a".to_owned(), duration_secs: 10.0, unknown: false };
//! let wave = |start_secs| GroundTruth {
//!     clip: "a".to_owned(),
//!     class: "wave".to_owned(),
//!     span: TimeSpan::new(start_secs, start_secs + 1.0),
//! };
//! let found = ClipDetection {
//!     clip: "a".to_owned(),
//!     class: "wave".to_owned(),
//!     span: TimeSpan::new(2.1, 3.0),
//!     score: Some(0.9),
//!     reported_secs: Some(3.2),
//!     repetitions: None,
//! };
//! let measured = Evaluation::of(&[stream], &[wave(2.0), wave(6.0)], &[found])?;
//! assert_eq!((measured.events.matched, measured.totals.samples), (1, 2));
//! # Ok(())
//! # }
//! ```

mod agreement;
mod alarms;
mod confusion;
mod decisions;
mod difference;
mod evaluation;
mod events;
mod figures;
mod frames;
mod pairs;
mod reliability;
mod spans;
mod timeline;
mod timing;

#[cfg(test)]
pub(crate) mod tests;

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth, StreamInfo};

pub use agreement::{ClassAgreement, EventAgreement, Kappa, LabelAgreement, UnitConfusion};
pub use alarms::{FalseAlarms, UnknownFigures};
pub use confusion::{Confusion, Mistake};
pub use decisions::{Classification, ThesisAccuracy};
pub use difference::{LabelDifference, label_differences};
pub use evaluation::{ClassFigures, Evaluation, Totals};
pub use events::{EVENT_TOLERANCE_SECS, EventScore, event_pairs};
pub use frames::FrameScore;
pub use pairs::OverlapScore;
pub use reliability::{Reliability, SCORE_BINS, ScoreBin};
pub use timeline::{DetectionVerdict, GroundTruthVerdict, Timeline, timelines};
pub use timing::{Boundaries, Delay};

/// Least overlaps, as intersection over union, at which F1 is given.
pub const OVERLAPS: [f64; 4] = [0.1, 0.25, 0.5, 0.75];

/// The least overlap of a detection whose delay and boundaries are measured, and that counts as right in
/// [`timelines`].
pub const MEASURED_OVERLAP: f64 = 0.5;

/// Unlabelled stretches shorter than this take part in no decision (`docs/guide/measure.md`).
pub const UNLABELLED_MIN_SECS: f64 = 0.4;

/// Input that cannot be evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EvalError {
    /// A stream is named twice.
    #[error("two streams are called {clip}; names must differ")]
    TwoStreams {
        /// Name of the stream.
        clip: String,
    },
    /// A stream without a length.
    #[error("the stream {clip} lasts {duration_secs} s; expected a positive length")]
    NoLength {
        /// Name of the stream.
        clip: String,
        /// The duration that was given.
        duration_secs: f64,
    },
    /// A sample or a detection in a stream that is not there.
    #[error("{what} of {class} lies in the stream {clip}, which is not among those evaluated")]
    NoStream {
        /// `"a sample"` or `"a detection"`.
        what: &'static str,
        /// Name of the class.
        class: String,
        /// The stream it names.
        clip: String,
    },
    /// A sample or a detection that is no stretch of time.
    #[error(
        "{what} of {class} in {clip} goes from {} s to {} s; expected a stop after the start",
        .span.start_secs, .span.stop_secs
    )]
    NoStretch {
        /// `"a sample"` or `"a detection"`.
        what: &'static str,
        /// Name of the class.
        class: String,
        /// Name of the clip.
        clip: String,
        /// Its start and stop.
        span: TimeSpan,
    },
    /// A labelled sample in a stream that is said to hold none.
    #[error("{clip} is given as unknown motion but contains a sample of {class}")]
    SampleInUnknown {
        /// Name of the stream.
        clip: String,
        /// The sample's class.
        class: String,
    },
}

/// One stream with what lies in it, each kind ordered by start, stop, class (and score).
#[derive(Debug)]
struct EvaluatedStream<'a> {
    info: &'a StreamInfo,
    truths: Vec<&'a GroundTruth>,
    founds: Vec<&'a ClipDetection>,
}

/// Sorts samples and detections into their streams, streams in order of name. O(n log n).
fn streams<'a>(
    infos: &'a [StreamInfo],
    truths: &'a [GroundTruth],
    founds: &'a [ClipDetection],
) -> Result<Vec<EvaluatedStream<'a>>, EvalError> {
    let mut by_clip: BTreeMap<&str, EvaluatedStream<'a>> = BTreeMap::new();
    for info in infos {
        let (clip, duration_secs) = (info.clip.clone(), info.duration_secs);
        if !(duration_secs > 0.0 && duration_secs.is_finite()) {
            return Err(EvalError::NoLength {
                clip,
                duration_secs,
            });
        }
        if by_clip
            .insert(
                &info.clip,
                EvaluatedStream {
                    info,
                    truths: Vec::new(),
                    founds: Vec::new(),
                },
            )
            .is_some()
        {
            return Err(EvalError::TwoStreams { clip });
        }
    }
    for truth in truths {
        let stream = stream_of(
            &mut by_clip,
            "a sample",
            &truth.clip,
            &truth.class,
            truth.span,
        )?;
        if stream.info.unknown {
            return Err(EvalError::SampleInUnknown {
                clip: truth.clip.clone(),
                class: truth.class.clone(),
            });
        }
        stream.truths.push(truth);
    }
    for found in founds {
        stream_of(
            &mut by_clip,
            "a detection",
            &found.clip,
            &found.class,
            found.span,
        )?
        .founds
        .push(found);
    }
    let mut streams: Vec<EvaluatedStream<'a>> = by_clip.into_values().collect();
    for stream in &mut streams {
        stream
            .truths
            .sort_by(|a, b| a.span.order(b.span).then_with(|| a.class.cmp(&b.class)));
        stream.founds.sort_by(|a, b| {
            let score = |f: &ClipDetection| f.score.unwrap_or(f64::NEG_INFINITY);
            let reported = |f: &ClipDetection| f.reported_secs.unwrap_or(f64::NEG_INFINITY);
            (a.span.order(b.span).then_with(|| a.class.cmp(&b.class)))
                .then_with(|| score(b).total_cmp(&score(a)))
                .then_with(|| reported(a).total_cmp(&reported(b)))
        });
    }
    Ok(streams)
}

fn stream_of<'s, 'a>(
    by_clip: &'s mut BTreeMap<&str, EvaluatedStream<'a>>,
    what: &'static str,
    clip: &str,
    class: &str,
    span: TimeSpan,
) -> Result<&'s mut EvaluatedStream<'a>, EvalError> {
    let (class, name) = (class.to_owned(), clip.to_owned());
    if !span.is_stretch() {
        return Err(EvalError::NoStretch {
            what,
            class,
            clip: name,
            span,
        });
    }
    by_clip.get_mut(clip).ok_or(EvalError::NoStream {
        what,
        class,
        clip: name,
    })
}

/// Every class that is labelled or found in any stream.
fn all_classes<'a>(streams: &[EvaluatedStream<'a>]) -> BTreeSet<&'a str> {
    let truths = streams
        .iter()
        .flat_map(|s| s.truths.iter().map(|t| t.class.as_str()));
    let founds = streams
        .iter()
        .flat_map(|s| s.founds.iter().map(|f| f.class.as_str()));
    truths.chain(founds).collect()
}
