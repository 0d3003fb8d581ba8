//! Training from clips and labels in one call.

use std::sync::{Mutex, PoisonError};

use crate::features::{BoneSet, FeatureParams};
use crate::progress::Progress;
use crate::templates::TemplateModel;

use super::error::TrainError;
use super::everyday::{everyday_clips, second_look_clips};
use super::from_clips::{LabelSet, TrainClip, background_streams, build_train_set};
use super::mirror::add_mirrored;
use super::options::{ENOUGH_BACKGROUND_SECS, Everyday, TrainOptions};
use super::report::TrainingReport;
use super::set::{StreamKind, TrainStream};
use super::templates::train;

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
    options
        .check_names(labelling.classes)
        .map_err(TrainError::Params)?;
    let mut prepared = build_train_set(clips, labelling, options.bones, &options.params.features);
    if prepared.bones == BoneSet::NONE {
        return Err(prepared.no_bone(options.bones));
    }
    if adds_everyday(clips, options.everyday) {
        // Behind the clips; stretches of them that became background by themselves come last.
        let at = clips.len() - prepared.lacking.len();
        let EverydayStreams { usual, second_look } =
            everyday_streams(prepared.bones, &prepared.features, progress);
        prepared.set.streams.splice(at..at, usual);
        prepared.set.everyday = second_look;
    }
    let (mirror, bones) = (options.mirror, prepared.bones);
    add_mirrored(&mut prepared.set, bones, mirror, &options.one_sided);
    let params = prepared.params(&options.params);
    let trained = train(&prepared.set, prepared.bones, &params, progress)?;
    let report = TrainingReport::of(&prepared, &trained, &params);
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

/// Rows of the everyday motion: of the usual clips, and of those for the second look.
#[derive(Clone)]
struct EverydayStreams {
    usual: Vec<TrainStream>,
    second_look: Vec<TrainStream>,
}

/// Rows of the everyday motion. Those made last are kept: they are the same for every index of the same bones and parameters, and
/// making them takes as long as a small training does.
fn everyday_streams(
    bones: BoneSet,
    params: &FeatureParams,
    progress: &dyn Progress,
) -> EverydayStreams {
    static MADE: Mutex<Option<(BoneSet, FeatureParams, EverydayStreams)>> = Mutex::new(None);
    let kept = || MADE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((of, with, streams)) = &*kept()
        && (*of, with) == (bones, params)
    {
        return streams.clone();
    }
    progress.report("everyday motion", 0, 0);
    let streams_of = |clips: &[TrainClip]| background_streams(clips, bones, params);
    let streams = EverydayStreams {
        usual: streams_of(&everyday_clips()),
        second_look: streams_of(&second_look_clips()),
    };
    *kept() = Some((bones, params.clone(), streams.clone()));
    streams
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{Clip, Points};
    use crate::diagnosis::RoleSet;
    use crate::features::HeadingLine;
    use crate::index::{MotionIndex, Provenance};
    use crate::labels::Sample;
    use crate::live::{Model, recognize_clip};
    use crate::math::Vec3;
    use crate::roles::{LEGS, Role, RoleMap};
    use crate::synth::{Person, Script};

    /// Somebody who waves; without hips and legs if `half`.
    fn performance(number: usize, half: bool) -> (TrainClip, Vec<Sample>) {
        let script = Script::new(70 + number as u64, Person::draw(5, number));
        let script = (0..3).fold(script, |s, _| s.rest(1.0).play("wave"));
        let name = format!("clip{number}");
        let take = script.rest(1.0).film(&name, 30.0).unwrap();
        let mut roles = RoleMap::find(&take.clip.skeleton);
        for role in Role::ALL {
            if half && (LEGS.as_flattened().contains(&role) || role == Role::Hips) {
                roles.set(role, None);
            }
        }
        let samples = take.samples().collect();
        let clip = TrainClip {
            name,
            roles,
            rest: 0..0,
            source: StreamKind::Labelled,
            person: None,
            clip: take.clip,
        };
        (clip, samples)
    }

    fn trained(halves: [bool; 2]) -> (MotionIndex, TrainingReport) {
        let both = [0, 1].map(|number| performance(number, halves[number]));
        let clips = both.each_ref().map(|(clip, _)| clip.clone());
        let samples: Vec<Sample> = both.into_iter().flat_map(|(_, samples)| samples).collect();
        let labelling = LabelSet {
            samples: &samples,
            classes: &["wave".to_owned()],
            ..LabelSet::default()
        };
        let options = TrainOptions {
            everyday: Everyday::Never,
            ..TrainOptions::default()
        };
        let (model, report) = train_clips(&clips, &labelling, &options, &()).unwrap();
        let index = MotionIndex {
            roles: clips[0].role_names(),
            provenance: Provenance::default(),
            model: model.into(),
        };
        (index, report)
    }

    fn heading(index: &MotionIndex) -> HeadingLine {
        match &index.model {
            Model::Templates(model) => model.features.heading,
            Model::Svrdm(_) => unreachable!(),
        }
    }

    #[test]
    fn an_index_learned_without_hips_keeps_to_the_shoulders() {
        let (whole, half) = (performance(2, false).0, performance(2, true).0);
        let shown: RoleSet = half.roles.played().map(|(role, _)| role).collect();
        let found = |index: &MotionIndex, clip: &TrainClip| {
            recognize_clip(&index.model, &clip.clip, &clip.roles, &clip.rest).unwrap()
        };
        for (halves, of) in [([true, true], "2 of 2"), ([false, true], "1 of 2")] {
            let (index, report) = trained(halves);
            let bytes = index.to_bytes().unwrap();
            let index = MotionIndex::from_bytes(&bytes).unwrap();
            assert_eq!(heading(&index), HeadingLine::Shoulders);
            let said = format!("{of} training clips have no hips");
            let note = report.notes.iter().find(|note| note.starts_with(&said));
            assert!(note.unwrap().ends_with("right_forearm, head"), "{note:?}");
            assert_eq!(index.heading_doubt(shown), None);
            // The same is found whether or not hips are seen.
            assert!(!found(&index, &half).is_empty());
            assert_eq!(found(&index, &whole), found(&index, &half));
        }
        let (index, report) = trained([false, false]);
        assert_eq!(heading(&index), HeadingLine::Hips);
        assert!(!report.notes.iter().any(|note| note.contains("no hips")));
        assert!(index.heading_doubt(shown).is_some());
        assert_eq!(index.heading_doubt(Role::BODY.into_iter().collect()), None);
    }

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
            span: crate::TimeSpan::new(0.5, 1.5),
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
            error.starts_with("no body to train on in hand: "),
            "{error}"
        );
    }
}
