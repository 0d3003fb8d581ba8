//! Training of an index from data that has been sorted out.

use crate::index::{MotionIndex, Provenance};
use crate::progress::Progress;

use super::{LabelSet, Recipe, TrainError, TrainingData, TrainingReport, train_model};

/// Trains on `data` as `recipe` says.
///
/// # Errors
/// Too little to learn from, options out of bounds, or the listener of `progress` cancelled.
pub fn train_index(
    data: &TrainingData,
    recipe: &Recipe,
    progress: &dyn Progress,
) -> Result<(MotionIndex, TrainingReport), TrainError> {
    let labelling = LabelSet {
        samples: &data.samples,
        held_back: &[],
        classes: &data.classes,
        unlabelled_is_background: recipe.unlabelled_is_background(),
    };
    let (model, report) = train_model(&data.clips, &labelling, recipe, progress)?;
    let index = MotionIndex {
        model,
        roles: data.role_names(),
        provenance: Provenance {
            created: now(),
            morec_version: env!("CARGO_PKG_VERSION").to_owned(),
            clips: data.labelled().map(|c| c.name.clone()).collect(),
            samples: data.samples.len(),
            background_secs: report.background_secs.clone(),
        },
    };
    Ok((index, report))
}

/// The present time in UTC to the second, `2026-11-21T04:46:50Z`; the one that `SOURCE_DATE_EPOCH` sets (seconds since
/// 1970), so that training again gives the same bytes.
fn now() -> String {
    let fixed = std::env::var("SOURCE_DATE_EPOCH").ok();
    let fixed = fixed.and_then(|secs| jiff::Timestamp::from_second(secs.parse().ok()?).ok());
    let now = fixed.unwrap_or_else(jiff::Timestamp::now);
    now.strftime("%FT%TZ").to_string()
}
