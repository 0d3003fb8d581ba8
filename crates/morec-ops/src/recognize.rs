//! Recognition: how readily motions are reported, and for whom.

use morec::live::Model;
use morec::templates::PerformerKind;
use serde::{Deserialize, Serialize};

use crate::OperationError;
use crate::words::choices;

/// Readiness to report motions.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct RecognizeSettings {
    /// False alarms a minute that background motion may raise, as in training: 0.1 is strict, 1 is generous [default:
    /// as trained, usually 0.3]
    #[arg(long, value_name = "ALARMS")]
    pub sensitivity: Option<f64>,
    /// Who performs: auto raises the bound of the score to half of the performer's recent scores, from the fourth report
    /// on; teacher raises it from the first frame by the scores of the teacher's samples, anyone never raises it [default: auto]
    #[arg(long, value_parser = choices::<PerformerKind>([
        ("auto", "Whoever it is"),
        ("teacher", "The person who taught"),
        ("anyone", "Somebody else"),
    ]))]
    pub performer: Option<PerformerKind>,
}

impl RecognizeSettings {
    /// The model at this sensitivity, for this performer.
    ///
    /// # Errors
    /// The model notes no rates of false alarms, has no gate for others than the teacher, or the sensitivity makes no sense.
    pub fn tuned(&self, mut model: Model) -> Result<Model, OperationError> {
        if let Some(alarms_per_minute) = self.sensitivity {
            let changed = model.with_sensitivity(alarms_per_minute);
            model = changed.map_err(|e| OperationError::Settings(format!("sensitivity: {e}")))?;
        }
        if let Some(performer) = self.performer {
            let changed = model.with_performer(performer);
            model = changed.map_err(|e| OperationError::Settings(format!("performer: {e}")))?;
        }
        Ok(model)
    }
}
