//! Snapshots that follow edits are those that are read anew; what another program changed stays.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use morec::TimeSpan;
use morec::rng::Rng;
use morec_db::labels::{NewSample, SampleState};
use morec_db::{ClipFilter, ClipUpdate, DbError, MotionDb};

use super::{DbPlace, Edit, Snapshot, Store, UNLIKELY, background};

/// A database with ten labels of `wave` and ten of `bow`.
fn labelled(folder: &Path) -> MotionDb {
    let mut db = MotionDb::open(&crate::tests::made(folder, 0)).unwrap();
    let clips = db.clips(&ClipFilter::default()).unwrap();
    let sample = |n: usize| {
        NewSample::accepted(
            clips[n % clips.len()].id,
            ["wave", "bow"][n % 2],
            TimeSpan::new(0.1 * n as f64, 0.1 * n as f64 + 0.5),
        )
    };
    let samples: Vec<NewSample> = (0..20).map(sample).collect();
    db.add_samples(&samples, "test").unwrap();
    db
}

/// One of some, if there are any.
fn one_of<'a, T>(rng: &mut Rng, all: &'a [T]) -> Option<&'a T> {
    (!all.is_empty()).then(|| &all[rng.below(all.len())])
}

/// Any edit of what a snapshot shows; those that make no sense fail and change nothing.
fn any_edit(rng: &mut Rng, seen: &Snapshot) -> Option<Edit> {
    let sample = one_of(rng, &seen.samples)?;
    let clip = one_of(rng, &seen.clips)?;
    let ids = vec![sample.id, one_of(rng, &seen.samples)?.id];
    let class = ["wave", "bow", "nod", "clap"][rng.below(4)].to_owned();
    let state = SampleState::ALL[rng.below(3)];
    let (start_secs, clips) = (rng.range(0.0, 2.0), vec![clip.id]);
    let new = NewSample {
        clip: clip.id,
        class: class.clone(),
        start_secs,
        stop_secs: start_secs + 0.25,
        state,
        score: Some(rng.range(0.0, 3.0 * UNLIKELY)),
        ..NewSample::from(&**sample)
    };
    Some(match rng.below(22) {
        0..3 => Edit::Label(vec![new]),
        3..6 => Edit::Move {
            id: sample.id,
            start_secs,
            stop_secs: start_secs + 0.5,
        },
        6 => Edit::Replace {
            what: "split".to_owned(),
            old: vec![(**sample).clone()],
            new: vec![(new, vec!["ann".to_owned()])],
        },
        7 => Edit::Reclass { ids, class },
        8 => Edit::Remove(ids),
        9 => Edit::Judge { ids, state },
        10 => Edit::RenameClass {
            from: sample.class.clone(),
            to: class,
        },
        11 => Edit::RemoveClass(class),
        12 => Edit::Describe {
            clips,
            update: ClipUpdate {
                subject: Some(class),
                ..background(rng.chance(0.5))
            },
        },
        13 => Edit::Background {
            clips,
            on: rng.chance(0.7),
        },
        14 => Edit::RenameClip {
            from: clip.name.clone(),
            to: format!("{class} {}", rng.below(9)),
        },
        15 if rng.chance(0.3) => Edit::RemoveClips(clips),
        15 => Edit::Cuts {
            what: "cut".to_owned(),
            clip: Box::new(clip.clone()),
            cuts: vec![start_secs + 0.1],
        },
        16 => Edit::ForgetCuts(clip.id),
        17 => Edit::KeepIndex {
            name: class,
            bytes: vec![0; rng.below(50)],
        },
        18 => Edit::Roles(vec![(clip.id, seen.roles.values().next()?.clone())]),
        19..21 => Edit::Undo(None),
        _ => Edit::Redo,
    })
}

/// Everything that a snapshot says, with what is made when it is asked for.
fn contents(snapshot: &Snapshot) -> String {
    let stale = snapshot
        .indexes
        .iter()
        .map(|index| snapshot.is_stale(index));
    let stale: Vec<bool> = stale.collect();
    let indexes = snapshot.indexes.iter();
    let indexes: Vec<_> = indexes.map(|i| (&i.name, i.bytes, i.samples)).collect();
    let by_clip = snapshot.clips.iter().map(|clip| {
        let of_clip = (snapshot.samples_of(clip.id), snapshot.segments_of(clip.id));
        (clip, snapshot.clip(clip.id), of_clip)
    });
    let by_clip: Vec<_> = by_clip.collect();
    let by_number = snapshot.samples.iter().map(|s| snapshot.sample(s.id));
    let by_number: Vec<_> = by_number.collect();
    let others = (&snapshot.roles, &snapshot.cut_methods, &snapshot.places);
    format!(
        "{by_clip:#?} {by_number:#?} {:#?} {:#?} {:#?} {others:?} {indexes:?} {stale:?} {}",
        snapshot.classes,
        snapshot.history,
        snapshot.labels(),
        snapshot.program,
    )
}

#[test]
fn a_snapshot_that_follows_any_edits_is_the_one_that_is_read() {
    for seed in 0..8 {
        let folder = tempfile::tempdir().unwrap();
        let mut db = labelled(folder.path());
        let mut other = MotionDb::open(db.path()).unwrap();
        other.set_program("another");
        let mut rng = Rng::new(seed);
        let mut seen = Snapshot::read(&db).unwrap();
        for turn in 0..40 {
            let Some(edit) = any_edit(&mut rng, &seen) else {
                break;
            };
            if rng.chance(0.1) {
                // Where both change the same, the later finds what the earlier left.
                _ = any_edit(&mut rng, &seen).map(|edit| edit.apply(&mut other, Some("ben")));
            }
            let done = edit.apply(&mut db, Some("ann"));
            if rng.chance(0.1) {
                let places = BTreeMap::from([("wave".to_owned(), turn)]);
                db.place_classes(&places).unwrap();
            }
            seen = seen.follow(&db).unwrap();
            let read = Snapshot::read(&db).unwrap();
            let (now, wanted) = (contents(&seen), contents(&read));
            assert!(
                now == wanted,
                "seed {seed}, turn {turn}: {edit:?}: {done:?}"
            );
            for index in read.indexes.iter() {
                assert_eq!(index.stale, read.is_stale(index));
            }
        }
    }
}

#[test]
fn a_move_reads_no_table_anew() {
    let folder = tempfile::tempdir().unwrap();
    let mut db = labelled(folder.path());
    let before = Snapshot::read(&db).unwrap();
    let edit = Edit::Move {
        id: before.samples[0].id,
        start_secs: 0.75,
        stop_secs: 1.25,
    };
    edit.apply(&mut db, None).unwrap();
    let after = before.follow(&db).unwrap();

    assert!(Arc::ptr_eq(&before.clips, &after.clips));
    assert!(Arc::ptr_eq(&before.segments, &after.segments));
    assert!(Arc::ptr_eq(&before.cut_methods, &after.cut_methods));
    assert!(Arc::ptr_eq(&before.roles, &after.roles));
    assert!(Arc::ptr_eq(&before.indexes, &after.indexes));
    let known = |s: &&Arc<_>| before.samples.iter().any(|b| Arc::ptr_eq(b, s));
    let shared = after.samples.iter().filter(known).count();
    assert_eq!(shared, before.samples.len() - 1);
}

/// A label as this program sees it, and another program that gives it the class `nod` or removes it meanwhile.
fn changed_meanwhile(
    gone: bool,
    edit: impl Fn(&Snapshot) -> Edit,
) -> (Result<String, DbError>, Option<String>) {
    let folder = tempfile::tempdir().unwrap();
    let mut db = labelled(folder.path());
    let seen = Snapshot::read(&db).unwrap();
    let id = seen.samples[0].id;
    let mut other = MotionDb::open(db.path()).unwrap();
    match gone {
        true => other.remove_samples(&[id]).unwrap(),
        false => other.split_class(&[id], "nod").unwrap(),
    };
    let done = edit(&seen).apply(&mut db, None);
    let now = seen.follow(&db).unwrap();
    (done, now.sample(id).map(|s| s.class.clone()))
}

#[test]
fn edits_of_the_last_moment_are_written_before_the_database_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = crate::tests::made(folder.path(), 0);
    let place = DbPlace {
        path: path.clone(),
        signature: "test".to_owned(),
    };
    let mut store = Store::open(place, false, Arc::new(|| ())).unwrap();
    let clip = store.snapshot.clips[0].id;
    let edits = 20;
    for n in 0..edits {
        let span = TimeSpan::new(0.01 * f64::from(n), 0.01 * f64::from(n) + 0.5);
        let label = NewSample::accepted(clip, "wave", span);
        store.edit(Edit::Label(vec![label]), None);
    }
    drop(store);
    // Closed: what SQLite keeps beside an open database is gone.
    let beside = std::fs::read_dir(folder.path()).unwrap();
    let names = beside.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(
        names.filter(|name| name.starts_with("moves.mdb")).count(),
        1
    );
    let written = Snapshot::read(&MotionDb::open(&path).unwrap()).unwrap();
    assert_eq!(written.samples.len(), edits as usize);
}

#[test]
fn an_edit_leaves_what_another_program_made_of_a_label() {
    let shift = |seen: &Snapshot| Edit::Move {
        id: seen.samples[0].id,
        start_secs: 0.75,
        stop_secs: 1.25,
    };
    let split = |seen: &Snapshot| {
        let old = (*seen.samples[0]).clone();
        let part = |start_secs, stop_secs| {
            let part = NewSample {
                start_secs,
                stop_secs,
                ..NewSample::from(&old)
            };
            (part, Vec::new())
        };
        Edit::Replace {
            what: "split".to_owned(),
            new: vec![part(0.0, 0.2), part(0.2, 0.4)],
            old: vec![old.clone()],
        }
    };
    let (moved, class) = changed_meanwhile(false, shift);
    moved.unwrap();
    assert_eq!(class.as_deref(), Some("nod"));
    let (done, class) = changed_meanwhile(false, split);
    let why = done.unwrap_err().to_string();
    assert!(
        why.starts_with("another program has changed sample"),
        "{why}"
    );
    assert_eq!(class.as_deref(), Some("nod"));
    for edit in [shift, split] as [fn(&Snapshot) -> Edit; 2] {
        let (done, class) = changed_meanwhile(true, edit);
        assert!(matches!(done, Err(DbError::Unknown { kind: "sample", .. })));
        assert_eq!(class, None);
    }
}
