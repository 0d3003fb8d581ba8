//! Training from clips, all in one.

use crate::features::BoneSet;
use crate::progress::Progress;
use crate::roles::RoleMap;
use crate::synth;
use crate::templates::TemplateModel;

use super::from_clips::{LabelSet, TrainClip, build_train_set};
use super::mirror::add_mirrored;
use super::options::{ENOUGH_BACKGROUND_SECS, EVERYDAY_SEED, Everyday, TrainOptions};
use super::report::TrainingReport;
use super::set::StreamKind;
use super::templates::{TrainError, train};

/// Trains on labelled and background clips, and on everyday motion as the options say.
///
/// # Errors
/// No sample, options that make no sense, or `progress` cancels.
pub fn train_clips(
    clips: &[TrainClip],
    labelling: &LabelSet<'_>,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<(TemplateModel, TrainingReport), TrainError> {
    let mut all = clips.to_vec();
    if adds_everyday(clips, options.everyday) {
        all.extend(everyday_clips(EVERYDAY_SEED));
    }
    let mut prepared = build_train_set(&all, labelling, options.bones, &options.params.features);
    if prepared.bones == BoneSet::NONE {
        return Err(if options.bones == BoneSet::ALL {
            prepared.no_bone()
        } else {
            let wanted: Vec<String> = options.bones.into();
            TrainError::Params(format!(
                "no bone to learn from: not every labelled clip shows one of {}",
                wanted.join(", ")
            ))
        });
    }
    let (mirror, bones) = (options.mirror, prepared.bones);
    add_mirrored(&mut prepared.set, bones, mirror, &options.one_sided);
    let trained = train(&prepared.set, prepared.bones, &options.params, progress)?;
    let report = TrainingReport::of(&prepared, &trained, options.params.features.tick_hz());
    Ok((trained.model, report))
}

fn adds_everyday(clips: &[TrainClip], everyday: Everyday) -> bool {
    let background = clips.iter().filter(|c| c.source == StreamKind::Background);
    match everyday {
        Everyday::Auto => {
            background.map(|c| c.clip.duration_secs()).sum::<f64>() < ENOUGH_BACKGROUND_SECS
        }
        Everyday::Always => true,
        Everyday::Never => false,
    }
}

/// The clips of [`synth::everyday`] to train from.
pub fn everyday_clips(seed: u64) -> Vec<TrainClip> {
    let made = synth::everyday(seed).into_iter();
    made.map(|clip| TrainClip {
        name: clip.name.clone(),
        roles: RoleMap::find(&clip.skeleton),
        rest: 0..0,
        source: StreamKind::Everyday,
        person: None,
        clip,
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{Clip, Points};
    use crate::labels::Sample;
    use crate::math::Vec3;

    /// A hand by its joints, as trackers of hands give it.
    #[test]
    fn a_recording_without_a_body_is_named() {
        let place = |joint: usize, frame: usize| {
            let along = 0.02 * joint as f64;
            Vec3::new(along, 1.0 + 0.001 * frame as f64, 0.0)
        };
        let joint = |joint: usize| {
            let positions = (0..90).map(|frame| place(joint, frame)).collect();
            (format!("Finger{joint}"), positions)
        };
        let clip = Clip::of_points("hand".into(), 30.0, (0..21).map(joint), Points::default());
        let clip = TrainClip {
            name: "hand".into(),
            roles: RoleMap::find(&clip.skeleton),
            rest: 0..0,
            source: StreamKind::Labelled,
            person: None,
            clip,
        };
        let sample = Sample {
            clip: "hand".into(),
            class: "fist".into(),
            start_secs: 0.5,
            stop_secs: 1.5,
            whole_clip: false,
            person: None,
            line: 2,
        };
        let labelling = LabelSet {
            samples: &[sample],
            classes: &["fist".to_owned()],
            ..LabelSet::default()
        };
        let options = TrainOptions {
            everyday: Everyday::Never,
            ..TrainOptions::default()
        };
        let trained = train_clips(&[clip], &labelling, &options, &());
        let error = trained.map(drop).unwrap_err().to_string();
        assert!(
            error.starts_with("no body to learn from in hand: "),
            "{error}"
        );
    }
}
