//! Synthetic people as tests use them: poses of a take, and a model trained on some of them.

use std::sync::{Arc, OnceLock};

use morec::clip::Clip;
use morec::features::{BoneSet, KeyPose, bones_of_clip, for_each_pose};
use morec::labels::Sample;
use morec::roles::RoleMap;
use morec::synth::{DatabaseSpec, SyntheticTake, database, everyday};
use morec::templates::TemplateModel;
use morec::train::{
    EVERYDAY_SEED, LabelSet, StreamKind, TrainClip, TrainOptions, TrainParams, train_clips,
};

/// A pose and its time on the stream's clock.
pub type Timed = (f64, KeyPose);

/// Every frame of a take as a live source would send it, and the bones it shows.
pub fn poses(take: &SyntheticTake) -> (BoneSet, Vec<Timed>) {
    let roles = RoleMap::find(&take.clip.skeleton);
    let mut poses = Vec::with_capacity(take.clip.frames);
    for_each_pose(&take.clip, &roles, &(0..0), |time_secs, pose| {
        poses.push((time_secs, *pose))
    });
    (bones_of_clip(&take.clip, &roles, &(0..0)), poses)
}

/// Trained on all gestures by six people, once for all tests.
pub fn model() -> Arc<TemplateModel> {
    static MODEL: OnceLock<Arc<TemplateModel>> = OnceLock::new();
    MODEL
        .get_or_init(|| {
            let spec = DatabaseSpec {
                people: 6,
                repetitions: 1,
                rate_hz: 30.0,
                ..Default::default()
            };
            Arc::new(train(&spec, TrainParams::default()))
        })
        .clone()
}

/// Trained on what `spec` makes, with some everyday motion as background.
pub fn train(spec: &DatabaseSpec, params: TrainParams) -> TemplateModel {
    let takes = database(71, spec);
    let samples: Vec<Sample> = takes.iter().flat_map(SyntheticTake::samples).collect();
    let mut clips: Vec<TrainClip> = takes
        .into_iter()
        .map(|t| train_clip(t.clip, Some(t.person), StreamKind::Labelled))
        .collect();
    // Talking hands come nearest to gestures; with all of it, training would take several times as long.
    let talking = everyday(EVERYDAY_SEED)
        .into_iter()
        .filter(|c| c.name.contains("talk"));
    clips.extend(talking.map(|c| train_clip(c, None, StreamKind::Background)));
    let classes: Vec<String> = spec.classes.iter().map(|c| (*c).to_owned()).collect();
    let labelling = LabelSet {
        samples: &samples,
        held_back: &[],
        classes: &classes,
        unlabelled_is_background: true,
    };
    let options = TrainOptions {
        params,
        everyday: morec::train::Everyday::Never,
        ..TrainOptions::default()
    };
    train_clips(&clips, &labelling, &options, &()).unwrap().0
}

fn train_clip(clip: Clip, person: Option<String>, source: StreamKind) -> TrainClip {
    let (name, roles) = (clip.name.clone(), RoleMap::find(&clip.skeleton));
    TrainClip {
        name,
        roles,
        rest: 0..0,
        source,
        person,
        clip,
    }
}
