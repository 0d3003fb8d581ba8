//! Synthetic people who teach the method of 2009.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use morec::index::{MotionIndex, Provenance};
use morec::labels::Sample;
use morec::live::Model;
use morec::roles::RoleMap;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use morec::train::thesis::{SvrdmOptions, SvrdmTrainParams, train_svrdm};
use morec::train::{LabelSet, StreamKind, TrainClip, TrainingReport};

pub const CLASSES: [&str; 3] = ["wave", "bow", "push"];

pub fn takes() -> &'static Vec<SyntheticTake> {
    static TAKES: OnceLock<Vec<SyntheticTake>> = OnceLock::new();
    TAKES.get_or_init(|| {
        let classes = CLASSES.to_vec();
        database(
            5,
            &DatabaseSpec {
                people: 3,
                repetitions: 2,
                rate_hz: 60.0,
                classes,
                ..Default::default()
            },
        )
    })
}

pub fn clips(takes: &[SyntheticTake]) -> (Vec<TrainClip>, Vec<Sample>) {
    let clip = |take: &SyntheticTake| TrainClip {
        name: take.clip.name.clone(),
        roles: RoleMap::find(&take.clip.skeleton),
        clip: take.clip.clone(),
        rest: 0..0,
        source: StreamKind::Labelled,
        person: Some(take.person.clone()),
    };
    let samples = takes.iter().flat_map(SyntheticTake::samples);
    (takes.iter().map(clip).collect(), samples.collect())
}

pub fn classes() -> Vec<String> {
    CLASSES.map(str::to_owned).to_vec()
}

pub fn trained(params: SvrdmTrainParams) -> (Model, TrainingReport) {
    let (clips, samples) = clips(takes());
    let classes = classes();
    let labelling = LabelSet {
        samples: &samples,
        classes: &classes,
        unlabelled_is_background: true,
        ..Default::default()
    };
    let options = SvrdmOptions {
        params,
        unlabelled_is_background: true,
    };
    let (model, report) = train_svrdm(&clips, &labelling, &options, &()).unwrap();
    (model.into(), report)
}

pub fn index_of(model: Model) -> MotionIndex {
    MotionIndex {
        model,
        roles: BTreeMap::new(),
        provenance: Provenance::default(),
    }
}
