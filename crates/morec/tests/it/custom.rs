//! Skeletons that are no person's: points that a mapping names are taught and recognised.

use morec::diagnosis::Diagnoser;
use morec::features::{BoneSet, HeadingLine, Profile, all_bones_of_clip};
use morec::index::{MotionIndex, Provenance};
use morec::labels::Sample;
use morec::live::{Model, StartError, recognize_clip};
use morec::roles::mapping::Mapping;
use morec::roles::{Role, RoleMap};
use morec::synth::{Person, Script};
use morec::train::{LabelSet, StreamKind, TrainClip, TrainOptions, train_clips};
use morec::{ImportOptions, Take};

/// A puppet of seven points, whose joints have names that people's have.
const PUPPET: &str = "point_1\tHips\npoint_2\tHead\nleft_point_1\tLeftUpLeg\nright_point_1\tRightUpLeg\n\
    left_point_2\tLeftHand\nright_point_2\tRightHand\nleft_point_3\tLeftForeArm\n";

fn script(number: usize) -> Script {
    let script = Script::new(70 + number as u64, Person::draw(5, number)).rest(2.0);
    (0..4).fold(script, |s, _| {
        s.play("wave").rest(2.0).play("circle").rest(1.5)
    })
}

/// A performance, its samples, and its roles by the mapping.
fn performance(number: usize, mapping: &str) -> (TrainClip, Vec<Sample>) {
    let name = format!("clip{number}");
    let filmed = script(number).film(&name, 60.0).unwrap();
    let options = ImportOptions {
        mapping: Some(Mapping::read(mapping.as_bytes()).unwrap()),
        ..ImportOptions::default()
    };
    let samples = filmed.samples().collect();
    let take: Take = morec::import::normalize(filmed.clip, &options).unwrap();
    let clip = TrainClip {
        name,
        rest: take.rest().clone(),
        roles: take.roles,
        source: StreamKind::Labelled,
        person: None,
        clip: take.clip,
    };
    (clip, samples)
}

fn trained(mapping: &str) -> MotionIndex {
    let both = [0, 1].map(|number| performance(number, mapping));
    let clips = both.each_ref().map(|(clip, _)| clip.clone());
    let samples: Vec<Sample> = both.into_iter().flat_map(|(_, samples)| samples).collect();
    let labelling = LabelSet {
        samples: &samples,
        classes: &["circle".to_owned(), "wave".to_owned()],
        unlabelled_is_background: true,
        ..LabelSet::default()
    };
    let (model, _) = train_clips(&clips, &labelling, &TrainOptions::default(), &()).unwrap();
    let index = MotionIndex {
        roles: clips[0].role_names(),
        provenance: Provenance::default(),
        model: model.into(),
    };
    MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap()
}

#[test]
fn a_custom_skeleton_is_taught_and_recognised() {
    let index = trained(PUPPET);
    let Model::Templates(model) = &index.model else {
        unreachable!()
    };
    assert_eq!(Profile::of(model.bones), Profile::Custom);
    assert_eq!(
        model.bones.len(),
        6,
        "the root is where the others are from"
    );
    assert_eq!(model.features.heading, HeadingLine::Points);
    // Nobody says here what its points are: the index knows.
    let (mut stranger, labels) = performance(2, "hips\tHips\n");
    assert_eq!(stranger.roles.profile(), Profile::Body);
    index.complete_roles(&mut stranger.roles, &stranger.clip.skeleton);
    assert_eq!(stranger.roles.profile(), Profile::Custom);
    let found = recognize_clip(
        &index.model,
        &stranger.clip,
        &stranger.roles,
        &stranger.rest,
    );
    let found = found.unwrap();
    let right = |label: &&Sample| {
        let middle = label.span.middle_secs();
        let class = |d: &morec::live::Detection| &model.classes[d.class.index()].name;
        let mut there = found
            .iter()
            .filter(|d| d.span.start_secs < middle && middle < d.span.stop_secs);
        there.next().is_some_and(|d| *class(d) == label.class) && there.next().is_none()
    };
    let count = labels.iter().filter(right).count();
    assert_eq!(
        (count, found.len()),
        (labels.len(), labels.len()),
        "{found:?}"
    );
}

#[test]
fn another_kind_of_performer_is_refused_in_words() {
    let index = trained(PUPPET);
    let person = script(3).film("person", 60.0).unwrap().clip;
    let roles = RoleMap::find(&person.skeleton);
    let bones = all_bones_of_clip(&person, &roles, &(0..0));
    let error = index.recognizer(bones).unwrap_err();
    assert!(matches!(error, StartError::OtherProfile { .. }));
    let said = "this index recognises a custom skeleton, but the input shows a body";
    assert_eq!(error.to_string(), said);
    // In a stream, once enough was seen of it.
    let take = morec::Take::new(person).unwrap();
    let mut diagnoser = Diagnoser::live();
    let mut first = None;
    for (secs, pose) in take.poses() {
        diagnoser.push(secs, secs, &pose);
        if index.misfit(&diagnoser.diagnosis()).is_some() && first.is_none() {
            first = Some(secs);
        }
    }
    assert!(
        first.is_some_and(|secs| (0.5..2.0).contains(&secs)),
        "{first:?}"
    );
    let findings = index.findings(&diagnoser.diagnosis());
    assert_eq!(findings[0], format!("error: {said}"));
}

#[test]
fn a_mirror_exchanges_the_points_of_both_sides() {
    let whole = format!("{PUPPET}right_point_3\tRightForeArm\n");
    let bones = |mapping: &str| {
        let clip = performance(0, mapping).0;
        all_bones_of_clip(&clip.clip, &clip.roles, &clip.rest).and(BoneSet::CUSTOM)
    };
    let mirrored = |bones: BoneSet| {
        let rows = morec::features::Rows::new(morec::features::RowLayout::of(bones).dim());
        morec::features::mirrored_rows(&rows, bones)
    };
    assert!(mirrored(bones(&whole)).is_some());
    assert!(
        mirrored(bones(PUPPET)).is_none(),
        "a point without its opposite"
    );
    assert_eq!(Role::LeftPoint3.opposite(), Role::RightPoint3);
    assert_eq!(Role::Point3.opposite(), Role::Point3);
}
