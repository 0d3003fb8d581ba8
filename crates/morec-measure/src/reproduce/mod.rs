//! The thesis's evaluation (Bucur 2009, ch. 5) on clips and labels of today: segmentation (§5.1), clusters (§5.2),
//! classification of cut-out samples (§5.3) and of streams (§5.4), once with the thesis's own parameters and once tuned;
//! its figures beside ours.

mod classification;
mod clustering;
mod page;
mod performance;
mod segmentation;
mod streams;
mod study;
mod thesis;
mod unlabelled;

use serde::Serialize;

use morec::labels::{ClassLengths, Sample, class_lengths};
use morec::progress::Progress;

pub use classification::SplitResult;
pub use clustering::Clustering;
pub use page::page;
pub use performance::{StageClock, StageCost, StagePerformance};
pub use segmentation::Segmented;
pub use streams::Streamed;
pub use study::{Picture, ReproduceError, Study};

pub use morec::train::thesis::Setting;
pub use unlabelled::UnlabelledChain;

/// Everything that came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reproduction {
    /// §5.1, clip by clip.
    pub segmentation: Vec<Segmented>,
    /// §5.2, τ by τ, centred and not.
    pub clustering: Vec<Clustering>,
    /// §5.3, for each setting and seed.
    pub classification: Vec<SplitResult>,
    /// §5.4, for each setting and seed.
    pub streams: Vec<Streamed>,
    /// Table 5.1.
    pub classes: Vec<ClassLengths>,
    /// §5.5, for each setting.
    pub performance: Vec<StagePerformance>,
    /// Cuts and clusters as one chain, beside sets without labels.
    pub unlabelled: Vec<UnlabelledChain>,
    /// SVG and TSV of all figures.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
}

/// Runs the whole evaluation. Trains three times for each setting and seed, and measures how long each stage takes.
///
/// # Errors
/// Training fails, an evaluation is impossible, or `progress` cancels.
pub fn reproduce(
    study: &Study<'_>,
    progress: &dyn Progress,
) -> Result<Reproduction, ReproduceError> {
    let steps = 2 + study.settings.len() * study.seeds.len();
    let at = |step: usize| {
        progress.report("evaluation", step, steps);
        if progress.cancelled() {
            Err(ReproduceError::Cancelled)
        } else {
            Ok(())
        }
    };
    let mut pictures = vec![];
    at(0)?;
    let segmentation = segmentation::run(study, &mut pictures)?;
    at(1)?;
    let clustering = clustering::run(study)?;
    let (mut classification, mut streams, mut performance) = (vec![], vec![], vec![]);
    for setting in study.settings {
        for (turn, seed) in study.seeds.iter().enumerate() {
            at(2 + streams.len())?;
            // Pictures of the first seed; the others look alike.
            let mut shown = vec![];
            for complement in [false, true] {
                let split = classification::run(study, setting, *seed, complement, &mut shown)?;
                classification.push(split);
            }
            streams.push(streams::run(study, setting, *seed, &mut shown)?);
            if turn == 0 {
                pictures.append(&mut shown);
            }
        }
        performance.push(performance::run(study, setting)?);
    }
    at(steps)?;
    let unlabelled = unlabelled::run(study, &segmentation)?;
    Ok(Reproduction {
        segmentation,
        clustering,
        classification,
        streams,
        classes: class_lengths(study.samples.iter().map(Sample::length)),
        performance,
        unlabelled,
        pictures,
    })
}
