//! Settings of recognition: sensitivity, expected performer, and the events of a stream.

use morec::live::{Model, StreamOptions};
use morec::templates::PerformerKind;
use serde::{Deserialize, Serialize};

use crate::OperationError;
#[cfg(feature = "clap")]
use crate::words::choices;

/// Readiness to report motions.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct RecognizeSettings {
    /// False alarms a minute to accept: 0.1 is strict, 1 generous
    ///
    /// [default: as trained, usually 0.3]
    #[cfg_attr(feature = "clap", arg(long, value_name = "ALARMS"))]
    pub sensitivity: Option<f64>,
    /// Expected performer, for indexes of one or two training subjects
    ///
    /// auto: from the fourth report on, the score threshold rises to half of the performer's recent scores; teacher: it is raised from
    /// the first frame, by the scores of the training samples; anyone: it is never raised. For hands, tracked points and older
    /// indexes, auto relaxes matching after four motions by a performer unlike the training subject, anyone relaxes it from the
    /// start, teacher never [default: auto].
    #[cfg_attr(feature = "clap", arg(long, value_parser = choices::<PerformerKind>([
        ("auto", "Decided by the motions recognised so far"),
        ("teacher", "The training subject"),
        ("anyone", "Other people"),
    ])))]
    pub performer: Option<PerformerKind>,
}

impl RecognizeSettings {
    /// The model at this sensitivity, for this performer.
    ///
    /// # Errors
    /// The model notes no rates of false alarms, has no gate for others than the teacher, or the sensitivity makes no sense.
    pub fn tuned(&self, model: Model) -> Result<Model, OperationError> {
        Ok(self.options().tuned(model)?)
    }

    /// These settings as options of a stream; others have their defaults.
    pub fn options(&self) -> StreamOptions {
        StreamOptions {
            sensitivity: self.sensitivity,
            performer: self.performer.unwrap_or_default(),
            ..StreamOptions::default()
        }
    }
}

/// Options of a live stream: those of [`StreamOptions`], as a command line says them.
#[cfg(feature = "clap")]
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct StreamSettings {
    /// Readiness to report motions.
    #[command(flatten)]
    pub recognition: RecognizeSettings,
    /// Also report motions before they end, tentatively
    ///
    /// Adds events of the phases start, update and cancel.
    #[arg(long)]
    pub tentative: bool,
    /// Make each repetition of an activity an event of its own
    #[arg(long)]
    pub each_repetition: bool,
    /// Report how each motion differs from the nearest sample
    ///
    /// Mean angle, pace, and the bone that differs most, for gestures and, with --each-repetition, for each repetition of an
    /// activity. Not available for held signs and the method svrdm.
    #[arg(long)]
    pub deviation: bool,
    /// Say with each frame how far every class has come
    ///
    /// How far (0 to 1), how like to a sample (0 to 1) and at what pace, to be mapped to sound or light: lines of the
    /// phase progress, and OSC messages /morec/progress/CLASS. Not of the method of 2009.
    #[arg(long)]
    pub progress: bool,
    /// Minimum seconds between two events of a class
    #[arg(long = "refractory", value_name = "SECS", default_value = "0")]
    pub refractory_secs: f64,
}

#[cfg(feature = "clap")]
impl StreamSettings {
    /// These settings as options of a stream; others have their defaults.
    pub fn options(&self) -> StreamOptions {
        StreamOptions {
            tentative: self.tentative,
            each_repetition: self.each_repetition,
            deviation: self.deviation,
            progress: self.progress,
            refractory_secs: self.refractory_secs,
            ..self.recognition.options()
        }
    }
}
