//! Synthetic people as tests use them: poses of a take, and a model trained on some of them.

use std::sync::{Arc, OnceLock};

use morec::clip::Clip;
use morec::features::{BoneSet, KeyPose, bones_of_clip, for_each_pose};
use morec::labels::Sample;
use morec::roles::RoleMap;
use morec::synth::{DatabaseSpec, LimbSide, Person, Script, SyntheticTake, database, everyday};
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

/// What a right-handed person, the `number`-th that `seed` gives, is to perform: nothing yet.
pub fn right_handed(seed: u64, number: usize) -> Script {
    let person = Person {
        hand: LimbSide::Right,
        ..Person::draw(seed, number)
    };
    Script::new(seed, person)
}

/// A performer who is not in the training data, who pushes and bows.
#[allow(
    dead_code,
    reason = "not every program that includes this module plays it"
)]
pub fn performance(rate_hz: f64) -> SyntheticTake {
    right_handed(90, 1)
        .rest(0.5)
        .play("push")
        .rest(1.5)
        .play("bow")
        .rest(0.8)
        .film("session", rate_hz)
        .unwrap()
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

/// A take in which somebody rests, waves eight times without a pause, and rests.
#[allow(
    dead_code,
    reason = "not every program that includes this module is about activities"
)]
pub fn waving(number: usize) -> SyntheticTake {
    let script = Script::new(90 + number as u64, Person::draw(91, number)).rest(2.0);
    let script = (0..8).fold(script, |script, _| script.play("wave"));
    script
        .rest(3.0)
        .film(&format!("waving{number}"), 30.0)
        .unwrap()
}

/// Trained on two such takes, with waving as an activity.
#[allow(
    dead_code,
    reason = "not every program that includes this module is about activities"
)]
pub fn activity_model() -> TemplateModel {
    let takes = [waving(1), waving(2)];
    let goes_on = |take: &SyntheticTake| {
        let waves: Vec<Sample> = take.samples().collect();
        let mut all = waves[0].clone();
        all.span.stop_secs = waves.last().unwrap().span.stop_secs;
        all
    };
    let samples = takes.each_ref().map(goes_on);
    let clips = takes.map(|t| train_clip(t.clip, Some(t.person), StreamKind::Labelled));
    let classes = ["wave".to_owned()];
    let labelling = LabelSet {
        samples: &samples,
        classes: &classes,
        unlabelled_is_background: true,
        ..LabelSet::default()
    };
    let mut options = TrainOptions::default();
    options.params.set_kinds(&classes, &[]);
    train_clips(&clips, &labelling, &options, &()).unwrap().0
}
