//! What one person taught, performed by others.

use morec::index::{Model, MotionIndex, PerformerError};
use morec::live::{Detection, Recognizer, recognize_poses};
use morec::synth::{DatabaseSpec, database};
use morec::templates::{Calibration, PerformerKind, TemplateModel};
use morec::train::{StrangerParams, TrainParams};

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

#[test]
fn only_few_teachers_get_a_wider_gate_and_files_keep_it() {
    let model = taught_by_one();
    let gate = model.stranger.clone().expect("one person taught");
    assert!(
        gate.threshold > 0.0
            && gate
                .operating
                .is_sorted_by(|a, b| a.threshold <= b.threshold)
    );
    assert_eq!(gate.calibration, Some(Calibration::OF_STRANGERS));
    let index = MotionIndex {
        model: model.into(),
        roles: Default::default(),
        provenance: Default::default(),
    };
    let opened = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert!(matches!(&opened.model, Model::Templates(m) if m.stranger == Some(gate)));

    let many = Model::from(made::train(&spec(3), TrainParams::default()));
    assert!(matches!(&many, Model::Templates(m) if m.stranger.is_none()));
    let anyone = many.with_performer(PerformerKind::Anyone);
    assert_eq!(anyone.err(), Some(PerformerError));
    assert_eq!(many.with_performer(PerformerKind::Teacher), Ok(many));
}

#[test]
fn for_the_teacher_the_wider_gate_changes_nothing() {
    let with = Model::from(taught_by_one());
    let teacher = with.with_performer(PerformerKind::Teacher).unwrap();
    let without = TrainParams {
        stranger: StrangerParams::NONE,
        ..TrainParams::default()
    };
    let without = made::train(&spec(1), without);
    for take in database(71, &spec(2)) {
        let (_, poses) = made::poses(&take);
        let found = recognize_poses(&teacher, &poses).unwrap();
        assert_eq!(found, recognize_poses(&without, &poses).unwrap());
        assert!(!found.is_empty());
    }
}

#[test]
fn for_anyone_no_fewer_motions_are_found_and_the_recogniser_says_so() {
    let model = Model::from(taught_by_one());
    let count = |performer: PerformerKind| {
        let model = model.with_performer(performer).unwrap();
        let takes = database(72, &spec(3));
        let found = takes.iter().map(|take| {
            let (bones, poses) = made::poses(take);
            let recognizer = Recognizer::new(&model, bones).unwrap();
            let open = performer == PerformerKind::Anyone;
            assert_eq!(recognizer.admits_strangers(), open);
            recognize_poses(&model, &poses).unwrap().len()
        });
        found.sum::<usize>()
    };
    assert!(count(PerformerKind::Anyone) >= count(PerformerKind::Teacher));
}

#[test]
fn scores_of_strangers_have_a_meaning_of_their_own_and_older_indexes_keep_theirs() {
    let model = taught_by_one();
    let mut older = model.clone();
    older.stranger.as_mut().unwrap().calibration = None;
    let (_, poses) = made::poses(&database(72, &spec(3))[1]);
    let found = |model: &TemplateModel, performer: PerformerKind| {
        let model = Model::from(model.with_performer(performer).unwrap());
        recognize_poses(&model, &poses).unwrap()
    };
    let teacher = PerformerKind::Teacher;
    assert_eq!(found(&model, teacher), found(&older, teacher));
    let [new, old] = [&model, &older].map(|model| found(model, PerformerKind::Anyone));
    let when = |d: &Detection| (d.class, d.span.start_secs, d.span.stop_secs);
    assert!(new.iter().map(when).eq(old.iter().map(when)));
    assert!(
        new.iter()
            .zip(&old)
            .any(|(new, old)| new.score != old.score)
    );
}

#[test]
fn the_end_of_a_stream_forgets_the_performer_and_a_pause_does_not() {
    let mut model = taught_by_one();
    let gate = model.stranger.as_mut().expect("one person taught");
    // Whoever performs is far.
    (gate.open_at, gate.close_at) = (0.0, 0.0);
    let take = &database(71, &spec(1))[0];
    let (bones, poses) = made::poses(take);
    let mut recognizer = Recognizer::new(&model, bones).unwrap();
    recognizer.push_all(&poses, &mut Vec::new());
    assert!(recognizer.admits_strangers());
    let (last_secs, pose) = poses[poses.len() - 1];
    recognizer.push(last_secs + 60.0, &pose);
    assert!(recognizer.admits_strangers(), "the same after a pause");
    recognizer.finish();
    assert!(!recognizer.admits_strangers());

    let mut again = Vec::new();
    recognizer.push_all(&poses, &mut again);
    again.extend_from_slice(recognizer.finish());
    assert_eq!(again, recognize_poses(&model, &poses).unwrap());
}
