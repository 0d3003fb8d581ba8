//! Training from clips, all in one.

use crate::features::BoneSet;
use crate::progress::Progress;
use crate::roles::RoleMap;
use crate::synth;
use crate::templates::TemplateModel;

use super::from_clips::{Labelling, TrainClip, prepare};
use super::options::TrainOptions;
use super::report::TrainingReport;
use super::set::Source;
use super::templates::{TrainError, train};

/// Trains on labelled and background clips, and on everyday motion if the options say so.
pub fn train_clips(
    clips: &[TrainClip],
    labelling: &Labelling<'_>,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<(TemplateModel, TrainingReport), TrainError> {
    let mut all = clips.to_vec();
    all.extend(options.everyday.into_iter().flat_map(everyday_clips));
    let prepared = prepare(&all, labelling, &options.params.features);
    if prepared.bones == BoneSet::NONE {
        return Err(TrainError::NoSamples);
    }
    let trained = train(&prepared.set, prepared.bones, &options.params, progress)?;
    let report = TrainingReport::of(&prepared, &trained, options.params.features.tick_hz());
    Ok((trained.model, report))
}

fn everyday_clips(seed: u64) -> Vec<TrainClip> {
    let made = synth::everyday(seed).into_iter();
    made.map(|clip| TrainClip {
        name: clip.name.clone(),
        roles: RoleMap::find(&clip.skeleton),
        rest: 0..0,
        source: Source::Everyday,
        person: None,
        clip,
    })
    .collect()
}
