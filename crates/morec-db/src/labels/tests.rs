//! Edits against a plain list, and the way back.

use proptest::prelude::*;

use super::*;
use crate::testing::database_of_waves;
use crate::{ClipId, MotionDb};

/// Labels as a user sees them: the classes; clip, class, start and state of each sample.
type Seen = (Vec<String>, Vec<(i64, String, String, SampleState)>);

fn seen(db: &MotionDb) -> Seen {
    let samples = db.samples(&SampleFilter::default()).unwrap();
    let classes = db.classes().unwrap().into_iter().map(|c| c.name).collect();
    let mut rows: Vec<_> = samples
        .into_iter()
        .map(|s| (s.clip.0, s.class, format!("{}", s.start_secs), s.state))
        .collect();
    rows.sort();
    (classes, rows)
}

fn sample(class: &str, start: u8, state: SampleState) -> NewSample {
    NewSample {
        clip: ClipId(1),
        class: class.to_owned(),
        start_secs: f64::from(start) / 10.0,
        stop_secs: f64::from(start) / 10.0 + 0.5,
        whole_clip: false,
        state,
        score: None,
    }
}

#[derive(Debug, Clone)]
enum Step {
    Add(usize, u8, SampleState),
    Judge(u8, SampleState),
    Rename(usize, usize),
    Merge(usize, usize),
    Split(u8, usize),
    Remove(usize),
    RemoveSample(u8),
}

const NAMES: [&str; 4] = ["walk", "run", "it's; DROP", "größer"];

fn step() -> impl Strategy<Value = Step> {
    let state = prop_oneof![
        Just(SampleState::Accepted),
        Just(SampleState::Proposed),
        Just(SampleState::Rejected)
    ];
    prop_oneof![
        4 => (0..4usize, 0..6u8, state.clone()).prop_map(|(c, s, state)| Step::Add(c, s, state)),
        1 => (0..6u8, state).prop_map(|(s, state)| Step::Judge(s, state)),
        1 => (0..4usize, 0..4usize).prop_map(|(a, b)| Step::Rename(a, b)),
        1 => (0..4usize, 0..4usize).prop_map(|(a, b)| Step::Merge(a, b)),
        1 => (0..6u8, 0..4usize).prop_map(|(s, c)| Step::Split(s, c)),
        1 => (0..4usize).prop_map(Step::Remove),
        1 => (0..6u8).prop_map(Step::RemoveSample),
    ]
}

/// Does a step; steps that make no sense fail and must change nothing.
fn take(db: &mut MotionDb, step: &Step) {
    let ids: Vec<SampleId> = db
        .samples(&SampleFilter::default())
        .unwrap()
        .iter()
        .map(|s| s.id)
        .collect();
    let some = |n: u8| {
        ids.iter()
            .copied()
            .skip(usize::from(n) / 2)
            .take(2)
            .collect::<Vec<_>>()
    };
    match step {
        Step::Add(class, start, state) => {
            db.add_samples(&[sample(NAMES[*class], *start, *state)], "test")
                .unwrap();
        }
        Step::Judge(n, state) => _ = db.judge(&some(*n), *state, "test").unwrap(),
        Step::Rename(a, b) => _ = db.rename_class(NAMES[*a], NAMES[*b]),
        Step::Merge(a, b) => _ = db.merge_classes(&[NAMES[*a].to_owned()], NAMES[*b]),
        Step::Split(n, class) => _ = db.split_class(&some(*n), NAMES[*class]).unwrap(),
        Step::Remove(class) => _ = db.remove_class(NAMES[*class]),
        Step::RemoveSample(n) => _ = db.remove_samples(&some(*n)).unwrap(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn undo_goes_back_through_every_state(steps in prop::collection::vec(step(), 1..25)) {
        let (_folder, mut db) = database_of_waves(1);
        let mut history = vec![(db.history().unwrap().len(), seen(&db))];
        for step in &steps {
            take(&mut db, step);
            let edits = db.history().unwrap().len();
            if edits > history.last().unwrap().0 {
                history.push((edits, seen(&db)));
            } else {
                prop_assert_eq!(&seen(&db), &history.last().unwrap().1, "changed without an edit: {:?}", step);
            }
        }
        for at in (0..history.len() - 1).rev() {
            prop_assert!(db.undo(None).unwrap().is_some());
            prop_assert_eq!(&seen(&db), &history[at].1);
            prop_assert!(db.check().unwrap().faults.is_empty());
        }
        prop_assert_eq!(db.undo(None).unwrap().map(|t| t.step.id), Some(1), "the import is left");
        prop_assert_eq!(db.redo(None).unwrap().map(|t| t.step.id), Some(1));
        for (_, state) in &history[1..] {
            prop_assert!(db.redo(None).unwrap().is_some());
            prop_assert_eq!(&seen(&db), state);
        }
        prop_assert!(db.redo(None).unwrap().is_none());
        prop_assert!(db.check().unwrap().faults.is_empty());
    }
}

#[test]
fn a_proposal_does_not_change_what_was_judged() {
    let (_folder, mut db) = database_of_waves(1);
    db.add_samples(&[sample("walk", 0, SampleState::Rejected)], "me")
        .unwrap();
    let added = db
        .add_samples(&[sample("walk", 0, SampleState::Proposed)], "morec")
        .unwrap();
    assert_eq!((added.added, added.unchanged), (0, 1));
    assert_eq!(
        db.samples(&SampleFilter::default()).unwrap()[0].state,
        SampleState::Rejected
    );
}

#[test]
fn samples_outside_their_clip_and_wild_names_are_refused_whole() {
    let (_folder, mut db) = database_of_waves(1);
    let good = sample("walk", 0, SampleState::Accepted);
    for bad in [
        NewSample {
            stop_secs: 1e6,
            ..good.clone()
        },
        NewSample {
            start_secs: -1.0,
            ..good.clone()
        },
        NewSample {
            start_secs: f64::NAN,
            ..good.clone()
        },
        NewSample {
            stop_secs: 0.0,
            ..good.clone()
        },
        NewSample {
            class: "a\tb".into(),
            ..good.clone()
        },
        NewSample {
            class: "  ".into(),
            ..good.clone()
        },
        NewSample {
            clip: ClipId(99),
            ..good.clone()
        },
    ] {
        assert!(
            db.add_samples(&[good.clone(), bad.clone()], "me").is_err(),
            "{bad:?}"
        );
        assert!(db.samples(&SampleFilter::default()).unwrap().is_empty());
    }
}

/// An answer that gives a stretch's class says what it is not.
#[test]
fn another_class_for_a_proposed_stretch_rejects_the_proposal() {
    let (_folder, mut db) = database_of_waves(1);
    db.add_samples(
        &[
            sample("walk", 3, SampleState::Proposed),
            sample("walk", 9, SampleState::Proposed),
        ],
        "propose",
    )
    .unwrap();
    db.add_samples(&[sample("run", 3, SampleState::Accepted)], "user")
        .unwrap();
    let states: Vec<_> = seen(&db)
        .1
        .into_iter()
        .map(|(_, class, start, state)| (class, start, state))
        .collect();
    let row = |class: &str, start: &str, state| (class.to_owned(), start.to_owned(), state);
    assert_eq!(
        states,
        [
            row("run", "0.3", SampleState::Accepted),
            row("walk", "0.3", SampleState::Rejected),
            row("walk", "0.9", SampleState::Proposed),
        ]
    );
    let before = seen(&db);
    assert!(db.split_class(&[SampleId(99_999)], "new").is_err());
    assert_eq!(seen(&db), before, "what fails changes nothing");
}

fn replace(dry_run: bool) -> LabelOptions {
    LabelOptions {
        by: "me".into(),
        replace: true,
        dry_run,
        ..LabelOptions::default()
    }
}

/// A corrected table takes the place of what was there for the clips it names, and numbers stay where it can be said
/// which sample is meant.
#[test]
fn labels_take_the_place_of_what_was_there() {
    let (_folder, mut db) = database_of_waves(2);
    let other_clip = NewSample {
        clip: ClipId(2),
        ..sample("walk", 9, SampleState::Accepted)
    };
    let old = [
        sample("walk", 0, SampleState::Accepted),
        sample("walk", 10, SampleState::Accepted),
        sample("run", 20, SampleState::Accepted),
        sample("hop", 30, SampleState::Accepted),
        sample("hop", 40, SampleState::Proposed),
        other_clip,
    ];
    db.add_samples(&old, "me").unwrap();
    let number = |db: &MotionDb, class: &str, start: f64| {
        let all = db.samples(&SampleFilter::default()).unwrap();
        all.iter()
            .find(|s| s.class == class && s.start_secs == start)
            .map(|s| s.id)
    };
    let (moved, renamed) = (number(&db, "walk", 1.0), number(&db, "run", 2.0));
    let before = seen(&db);
    let new = [
        sample("walk", 0, SampleState::Accepted),
        sample("walk", 12, SampleState::Accepted),
        sample("jog", 20, SampleState::Accepted),
        sample("jog", 25, SampleState::Accepted),
    ];
    let plan = db.label(&new, &replace(true)).unwrap();
    assert_eq!(seen(&db), before, "a dry run changes nothing");
    let done = db.label(&new, &replace(false)).unwrap();
    assert_eq!(plan, done);
    let counts = done.counts;
    assert_eq!(
        (
            counts.unchanged,
            counts.moved,
            counts.renamed,
            counts.added,
            counts.gone
        ),
        (1, 1, 1, 1, 1)
    );
    assert_eq!(number(&db, "walk", 1.2), moved);
    assert_eq!(number(&db, "jog", 2.0), renamed);
    let row =
        |clip, class: &str, start: &str, state| (clip, class.to_owned(), start.to_owned(), state);
    assert_eq!(
        seen(&db).1,
        [
            row(1, "hop", "4", SampleState::Proposed),
            row(1, "jog", "2", SampleState::Accepted),
            row(1, "jog", "2.5", SampleState::Accepted),
            row(1, "walk", "0", SampleState::Accepted),
            row(1, "walk", "1.2", SampleState::Accepted),
            row(2, "walk", "0.9", SampleState::Accepted),
        ]
    );
    let again = db.label(&new, &replace(false)).unwrap();
    assert!(again.changes.is_empty() && again.counts.unchanged == new.len());
    db.undo(None).unwrap();
    assert_eq!(seen(&db), before);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Whatever was there, afterwards a clip's accepted samples are those of the table.
    #[test]
    fn after_replacing_the_table_is_what_is_there(
        old in prop::collection::vec((0..4usize, 0..12u8), 0..8),
        new in prop::collection::btree_set((0..4usize, 0..12u8), 1..8),
    ) {
        let (_folder, mut db) = database_of_waves(1);
        let of = |(class, start): (usize, u8)| sample(NAMES[class], start, SampleState::Accepted);
        let old: Vec<NewSample> = old.into_iter().map(of).collect();
        db.add_samples(&old, "me").unwrap();
        let before = seen(&db);
        let new: Vec<NewSample> = new.into_iter().map(of).collect();
        db.label(&new, &replace(false)).unwrap();
        let mut wanted: Vec<_> = new
            .iter()
            .map(|s| (1, s.class.clone(), format!("{}", s.start_secs), SampleState::Accepted))
            .collect();
        wanted.sort();
        prop_assert_eq!(seen(&db).1, wanted.clone());
        db.undo(None).unwrap();
        let after_undo = seen(&db);
        prop_assert!(after_undo == before || before.1 == wanted);
        prop_assert!(db.check().unwrap().faults.is_empty());
    }
}

/// A group says that stretches are alike, not what they are.
#[test]
fn a_label_withdraws_the_groups_proposal_and_its_empty_class() {
    let (_folder, mut db) = database_of_waves(1);
    let grouped = [
        sample("group_1", 0, SampleState::Proposed),
        sample("group_2", 10, SampleState::Proposed),
        sample("group_2", 20, SampleState::Proposed),
    ];
    db.add_samples(&grouped, GROUPED_BY).unwrap();
    let labels = [
        sample("walk", 0, SampleState::Accepted),
        sample("walk", 10, SampleState::Accepted),
    ];
    let added = db.add_samples(&labels, "me").unwrap();
    assert_eq!((added.added, added.rejected, added.withdrawn), (2, 0, 2));
    assert_eq!(seen(&db).0, ["group_2", "walk"]);
    assert_eq!(db.remove_classes("group_*").unwrap(), (1, 1));
    assert_eq!(seen(&db).0, ["walk"]);
    assert!(db.remove_classes("group_*").is_err());
}

#[test]
fn samples_are_moved_by_number() {
    let (_folder, mut db) = database_of_waves(1);
    let two = [
        sample("walk", 0, SampleState::Accepted),
        sample("walk", 10, SampleState::Accepted),
    ];
    db.add_samples(&two, "me").unwrap();
    db.move_sample(SampleId(2), 1.5, 1.75, "me").unwrap();
    assert!(
        db.move_sample(SampleId(2), 0.0, 0.5, "me").is_err(),
        "there is one"
    );
    assert!(db.move_sample(SampleId(2), 5.0, 1.0, "me").is_err());
    assert!(db.move_sample(SampleId(9), 0.0, 1.0, "me").is_err());
    let starts: Vec<String> = seen(&db).1.into_iter().map(|row| row.2).collect();
    assert_eq!(starts, ["0", "1.5"]);
}

/// Another program gives the sample other classes while it is moved: each stays until that program gives the next.
#[test]
fn a_move_leaves_another_programs_class() {
    let (folder, mut db) = database_of_waves(1);
    db.add_samples(&[sample("walk", 0, SampleState::Accepted)], "me")
        .unwrap();
    let mut other = MotionDb::open(&folder.path().join("test.mdb")).unwrap();
    std::thread::scope(|scope| {
        let moving = scope.spawn(|| {
            for start in 0..40 {
                let start = f64::from(start % 7) / 10.0 + 1.0;
                let moved = db.move_sample(SampleId(1), start, start + 0.5, "me");
                moved.unwrap();
            }
        });
        for turn in 0.. {
            let class = ["run", "walk"][turn % 2];
            other.split_class(&[SampleId(1)], class).unwrap();
            // Time for a move.
            std::thread::sleep(std::time::Duration::from_millis(2));
            let now = other.sample(SampleId(1)).unwrap().class;
            assert_eq!(now, class, "in turn {turn}");
            if moving.is_finished() {
                break;
            }
        }
    });
}

#[test]
fn annotators_who_say_the_same_share_a_sample_and_undo_takes_them_back() {
    let (_folder, mut db) = database_of_waves(1);
    let label = |db: &mut MotionDb, samples: &[NewSample], who: &str| {
        let options = LabelOptions {
            annotators: vec![Some(who.to_owned()); samples.len()],
            ..LabelOptions::default()
        };
        db.label(samples, &options).unwrap().counts
    };
    let [one, two] = [1, 9].map(|start| sample("walk", start, SampleState::Accepted));
    let ann = label(&mut db, &[one.clone(), two.clone()], "ann");
    assert_eq!((ann.added, ann.annotated), (2, 2));
    let ben = label(&mut db, std::slice::from_ref(&one), " ben ");
    assert_eq!((ben.added, ben.unchanged, ben.annotated), (0, 1, 1));
    let said = |db: &MotionDb| -> Vec<String> {
        let samples = db.samples(&SampleFilter::default()).unwrap();
        samples.iter().map(|s| s.annotators.join(" ")).collect()
    };
    let by = |db: &MotionDb, who: &str| {
        let filter = SampleFilter {
            annotator: Some(who.to_owned()),
            ..SampleFilter::default()
        };
        db.samples(&filter).unwrap().len()
    };
    assert_eq!(said(&db), ["ann ben", "ann"]);
    assert_eq!((by(&db, "ann"), by(&db, "ben"), by(&db, "cid")), (2, 1, 0));
    // A sample that goes comes back with its annotators.
    let first = db.samples(&SampleFilter::default()).unwrap()[0].id;
    db.remove_samples(&[first]).unwrap();
    assert_eq!(said(&db), ["ann"]);
    db.undo(None).unwrap();
    assert_eq!(said(&db), ["ann ben", "ann"]);
    db.undo(None).unwrap();
    assert_eq!(said(&db), ["ann", "ann"]);
    db.redo(None).unwrap();
    assert_eq!(said(&db), ["ann ben", "ann"]);
    let options = LabelOptions {
        annotators: vec![Some("a\tb".to_owned())],
        ..LabelOptions::default()
    };
    let error = db.label(&[two], &options).unwrap_err().to_string();
    assert!(error.contains("control characters"), "{error}");
}

#[test]
fn samples_in_place_of_others_have_their_annotators_and_accepting_names_one() {
    let (_folder, mut db) = database_of_waves(1);
    let long = sample("walk", 1, SampleState::Accepted);
    let options = LabelOptions {
        annotators: vec![Some("ann".to_owned())],
        ..LabelOptions::default()
    };
    db.label(std::slice::from_ref(&long), &options).unwrap();
    let old = db.samples(&SampleFilter::default()).unwrap();
    let middle = 0.5 * (long.start_secs + long.stop_secs);
    let part = |start_secs, stop_secs| {
        let part = NewSample {
            start_secs,
            stop_secs,
            ..long.clone()
        };
        (part, old[0].annotators.clone())
    };
    let new = [part(long.start_secs, middle), part(middle, long.stop_secs)];
    db.change_samples("split", &old, &new, "test").unwrap();
    let said = |db: &MotionDb| -> Vec<Vec<String>> {
        let samples = db.samples(&SampleFilter::default()).unwrap();
        samples.into_iter().map(|s| s.annotators).collect()
    };
    assert_eq!(said(&db), [["ann"], ["ann"]]);
    db.undo(None).unwrap();
    assert_eq!(said(&db), [["ann"]]);
    let proposal = sample("wave", 9, SampleState::Proposed);
    db.add_samples(&[proposal], "test").unwrap();
    let last = db.samples(&SampleFilter::default()).unwrap()[1].id;
    assert_eq!(db.accept_as(&[last], "ben", "test").unwrap(), 1);
    assert_eq!(said(&db), [["ann"], ["ben"]]);
    let step = db.history_since(&[]).unwrap()[0].id;
    assert_eq!(db.samples_of_step(step).unwrap(), [last]);
    db.undo(None).unwrap();
    assert_eq!(said(&db)[1], [""; 0]);
    assert!(db.accept_as(&[last], " ", "test").is_err());
}
