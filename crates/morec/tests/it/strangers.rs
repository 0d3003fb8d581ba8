//! What one person taught, performed by others: the second look.

use morec::index::{Model, MotionIndex};
use morec::live::{Detection, Recognizer, recognize_poses};
use morec::synth::{DatabaseSpec, database};
use morec::templates::{PerformerKind, TemplateModel};
use morec::train::TrainParams;

use crate::made;

/// One of the synthetic people teaches each class twice.
fn spec(people: usize) -> DatabaseSpec {
    DatabaseSpec {
        people,
        repetitions: 2,
        rate_hz: 30.0,
        ..Default::default()
    }
}

fn taught_by_one() -> TemplateModel {
    made::train(&spec(1), TrainParams::default())
}

fn found(model: &Model, performer: PerformerKind) -> Vec<Vec<Detection>> {
    let model = model.with_performer(performer).unwrap();
    let takes = database(72, &spec(3));
    let found = takes
        .iter()
        .map(|take| recognize_poses(&model, &made::poses(take).1).unwrap());
    found.collect()
}

#[test]
fn few_teachers_get_a_second_look_and_files_keep_it() {
    let model = taught_by_one();
    let look = model.look.clone().expect("one person taught a body");
    let stricter_first = look
        .operating
        .is_sorted_by(|a, b| a.threshold >= b.threshold);
    assert!(stricter_first && look.bound > 0.0, "{:?}", look.operating);
    assert!(model.stranger.is_none() && model.verifier.is_none());
    let index = MotionIndex {
        model: model.clone().into(),
        roles: Default::default(),
        provenance: Default::default(),
    };
    let opened = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert_eq!(opened.model, Model::from(model.clone()));

    let mut damaged = model;
    damaged.look.as_mut().unwrap().classes.pop();
    assert!(damaged.check().is_err());
}

#[test]
fn others_are_recognised_and_their_other_motions_are_not() {
    let model = Model::from(taught_by_one());
    let (mut right, mut wrong, mut all) = (0, 0, 0);
    for (take, found) in database(72, &spec(3))
        .iter()
        .zip(found(&model, PerformerKind::Auto))
    {
        all += take.labels.len();
        for detection in found {
            let named = detection.named(&model);
            let middle = (detection.span.start_secs + detection.span.stop_secs) / 2.0;
            let is_right = take.labels.iter().any(|label| {
                label.class == named.class
                    && label.span.start_secs < middle
                    && middle < label.span.stop_secs
            });
            right += usize::from(is_right);
            wrong += usize::from(!is_right);
        }
    }
    assert!(
        10 * right >= 9 * all && 10 * wrong <= all,
        "{right} right, {wrong} wrong of {all}"
    );
}

#[test]
fn what_is_named_as_background_is_not_reported_again_where_few_classes_are_taught() {
    let spec = DatabaseSpec {
        classes: vec!["wave", "clap", "bow"],
        ..spec(2)
    };
    let takes = database(7, &spec);
    let taken = takes.iter().map(|take| {
        let options = morec::ImportOptions::default();
        morec::import::normalize(take.clip.clone(), &options).unwrap()
    });
    let taken: Vec<_> = taken.collect();
    let (taught, other) = taken.split_at(1);
    let mut labels = morec::Labels::default();
    for label in &takes[0].labels {
        labels.add(&takes[0].clip.name, label.class, label.span);
    }
    let trainer = morec::Trainer::new().labels(&labels);
    let found = |index: &MotionIndex, of: usize| {
        recognize_poses(&index.model, &made::poses(&takes[of]).1).unwrap()
    };
    // What the teacher taught and is found.
    let right = |index: &MotionIndex| {
        let found = found(index, 0);
        let labels = takes[0].labels.iter().filter(|label| {
            let mut named = found.iter().map(|d| d.named(&index.model));
            named.any(|d| d.class == label.class && d.span.overlap_secs(label.span) > 0.5)
        });
        labels.count()
    };
    let without = trainer.clone().train(taught).unwrap();
    assert!(!found(&without, 1).is_empty());
    let all = takes[0].labels.len();
    assert_eq!(right(&without), all);
    let with = trainer.background(other).train(taught).unwrap();
    assert_eq!(found(&with, 1), []);
    assert_eq!(right(&with), all);
}

#[test]
fn for_anyone_no_fewer_motions_are_found_than_for_the_teacher() {
    let model = Model::from(taught_by_one());
    let count = |performer| found(&model, performer).iter().map(Vec::len).sum::<usize>();
    let anyone = count(PerformerKind::Anyone);
    assert!(anyone >= count(PerformerKind::Auto) && anyone >= count(PerformerKind::Teacher));
}

#[test]
fn a_sensitivity_moves_the_bound_and_with_it_what_is_found() {
    let model = Model::from(taught_by_one());
    let bounds = [0.03, 0.3, 2.0].map(|rate| {
        let Model::Templates(model) = model.with_sensitivity(rate).unwrap() else {
            unreachable!("templates were trained")
        };
        model.look.as_ref().unwrap().bound
    });
    assert!(bounds.is_sorted_by(|a, b| a >= b), "{bounds:?}");
}

#[test]
fn the_end_of_a_stream_forgets_the_stream_and_the_performer() {
    let model = taught_by_one();
    let take = &database(71, &spec(1))[0];
    let (bones, poses) = made::poses(take);
    let mut recognizer = Recognizer::new(&model, bones).unwrap();
    let expected = recognize_poses(&model, &poses).unwrap();
    assert!(!expected.is_empty());
    // Pose by pose, twice over: as all at once.
    for _ in 0..2 {
        let mut again = Vec::new();
        for (secs, pose) in &poses {
            again.extend_from_slice(recognizer.push(*secs, pose));
        }
        again.extend_from_slice(recognizer.finish());
        assert_eq!(again, expected);
    }
}

#[test]
fn a_stream_with_fewer_bones_is_judged_by_those() {
    let model = taught_by_one();
    let (bones, poses) = made::poses(&database(71, &spec(1))[0]);
    let arms = bones.indices().filter(|bone| *bone > 3);
    let arms = arms.fold(
        morec::features::BoneSet::NONE,
        morec::features::BoneSet::with,
    );
    let restricted = model.restricted(arms).unwrap();
    restricted.check().unwrap();
    let look = restricted.look.as_ref().unwrap();
    assert!(look.scale > 0.0 && look.segments.dim() < model.look.unwrap().segments.dim());
    assert!(!recognize_poses(&restricted, &poses).unwrap().is_empty());
}
