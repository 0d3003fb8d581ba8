//! Steps of every kind, back and forth.

use morec::TimeSpan;
use rusqlite::Connection;

use crate::labels::{NewSample, SampleFilter};
use crate::testing::{database_of_waves, waves, write_bvh};
use crate::{
    APPLICATION_ID, ClipFilter, ClipId, ClipUpdate, DbError, MotionDb, SCHEMA, Segment, SegmentKind,
};

/// Everything in the tables whose changes are steps, as text.
fn dump(db: &MotionDb) -> Vec<String> {
    let mut lines = Vec::new();
    for table in &crate::tracked::TRACKED {
        let columns: Vec<String> = table
            .columns
            .iter()
            .map(|c| format!("quote({c})"))
            .collect();
        let sql = format!(
            "SELECT '{}: ' || {} FROM {} ORDER BY 1",
            table.name,
            columns.join(" || ', ' || "),
            table.name
        );
        let mut statement = db.conn.prepare(&sql).unwrap();
        let rows = statement
            .query_map([], |row| row.get::<_, String>(0))
            .unwrap();
        lines.extend(rows.map(Result::unwrap));
    }
    lines
}

fn sample(clip: i64, class: &str, start: f64) -> NewSample {
    NewSample::accepted(ClipId(clip), class, TimeSpan::new(start, start + 0.5))
}

/// A change of each kind, one after the other.
fn changes() -> Vec<fn(&mut MotionDb)> {
    fn describe(db: &mut MotionDb) {
        let update = ClipUpdate {
            subject: Some("anna".into()),
            add_tags: vec!["a".into(), "b".into()],
            ..ClipUpdate::default()
        };
        db.update_clips(&[ClipId(1), ClipId(2)], &update).unwrap();
    }
    fn cut(db: &mut MotionDb) {
        let segment = |start_secs| Segment {
            clip: ClipId(1),
            kind: SegmentKind::Motion,
            span: TimeSpan::new(start_secs, start_secs + 1.0),
        };
        let segments = [segment(0.0), segment(1.0)];
        db.set_segments("kernel", &[ClipId(1)], &segments).unwrap();
    }
    fn retag(db: &mut MotionDb) {
        let update = ClipUpdate {
            remove_tags: vec!["b".into()],
            add_tags: vec!["c".into()],
            ..ClipUpdate::default()
        };
        db.update_clips(&[ClipId(1)], &update).unwrap();
    }
    vec![
        describe,
        |db| {
            _ = db
                .add_samples(&[sample(1, "wave", 0.0), sample(2, "bow", 1.0)], "me")
                .unwrap()
        },
        cut,
        |db| db.store_index("i", b"first").unwrap(),
        retag,
        |db| db.rename_class("bow", "nod").unwrap(),
        |db| db.store_index("i", b"second").unwrap(),
    ]
}

#[test]
fn every_kind_of_change_goes_back_and_forth() {
    let (folder, mut db) = database_of_waves(2);
    let mut states = vec![dump(&db)];
    for change in changes() {
        change(&mut db);
        states.push(dump(&db));
    }
    assert_eq!(
        db.history().unwrap().len(),
        states.len(),
        "a step each, and the import"
    );
    for round in 0..2 {
        for at in (0..states.len() - 1).rev() {
            let would = db.preview_undo(None).unwrap().unwrap();
            assert_eq!(dump(&db), states[at + 1], "a preview changes nothing");
            let done = db.undo(None).unwrap().unwrap();
            assert_eq!((&would, dump(&db)), (&done, states[at].clone()), "{round}");
            assert!(!done.effects.is_empty());
        }
        for state in &states[1..] {
            db.redo(None).unwrap().unwrap();
            assert_eq!(&dump(&db), state);
        }
        assert!(crate::digest::faults(&db.conn).unwrap().is_empty());
    }
    while db.undo(None).unwrap().is_some() {}
    assert!(
        dump(&db).is_empty(),
        "the import is a step, too: {:?}",
        dump(&db)
    );
    while db.redo(None).unwrap().is_some() {}
    assert_eq!(&dump(&db), states.last().unwrap());
    drop(db);
    let db = MotionDb::open(&folder.path().join("test.mdb")).unwrap();
    let broken = db.check().unwrap().faults;
    assert_eq!(broken.len(), 1, "the index is none: {broken:?}");
}

#[test]
fn a_named_step_is_taken_back_by_itself_unless_others_need_it() {
    let (_folder, mut db) = database_of_waves(2);
    db.add_samples(&[sample(1, "wave", 0.0)], "me").unwrap();
    db.add_samples(&[sample(2, "bow", 0.0)], "me").unwrap();
    db.rename_class("wave", "greet").unwrap();
    db.add_samples(&[sample(2, "greet", 1.0)], "me").unwrap();
    let ids: Vec<i64> = db.history().unwrap().iter().rev().map(|s| s.id).collect();
    let [import, wave, bow, rename, more] = ids[..] else {
        panic!("{ids:?}")
    };
    let before = dump(&db);
    // The renaming lies over the class; the last sample needs it; all need the clips.
    for (step, needed_by) in [(wave, rename), (import, wave)] {
        let refused = db.undo(Some(step)).unwrap_err().to_string();
        assert!(refused.contains(&format!("{needed_by} (")), "{refused}");
        assert_eq!(dump(&db), before);
    }
    db.undo(Some(bow)).unwrap();
    let classes = |db: &MotionDb| -> Vec<String> {
        db.classes().unwrap().into_iter().map(|c| c.name).collect()
    };
    assert_eq!(classes(&db), ["greet"]);
    assert!(matches!(db.undo(Some(bow)), Err(DbError::Invalid(_))));
    assert!(matches!(db.redo(Some(more)), Err(DbError::Invalid(_))));
    assert!(matches!(db.undo(Some(99)), Err(DbError::Unknown { .. })));
    db.redo(Some(bow)).unwrap();
    assert_eq!(dump(&db), before);
    // What comes after a step that was taken back forgets it.
    db.undo(Some(more)).unwrap();
    db.add_samples(&[sample(1, "jump", 2.0)], "me").unwrap();
    assert!(db.redo(None).unwrap().is_none());
}

/// A clip that is removed with its labels comes back with them, motion and all.
#[test]
fn an_import_can_be_taken_back_and_its_motion_is_kept_once() {
    let (folder, mut db) = database_of_waves(1);
    let before = dump(&db);
    let path = write_bvh(folder.path(), "other", &waves(3)[2].clip);
    db.import(
        &[path],
        &morec::files::FileReader::default(),
        &ClipUpdate::default(),
        &(),
    )
    .unwrap();
    let with = dump(&db);
    let id = db.find_clip("other").unwrap().id;
    let motion = db.clip(id).unwrap();
    let kept = |db: &MotionDb| -> i64 {
        let sql = "SELECT sum(bytes) FROM edits";
        db.conn.query_row(sql, [], |row| row.get(0)).unwrap()
    };
    assert_eq!(kept(&db), 0);
    db.undo(None).unwrap();
    assert_eq!(dump(&db), before);
    assert!(kept(&db) > 0 && db.find_clip("other").is_err());
    db.redo(None).unwrap();
    assert_eq!((dump(&db), kept(&db)), (with, 0));
    assert_eq!(db.clip(id).unwrap(), motion);
    assert_eq!(db.rows(&Default::default(), &()).unwrap().len(), 2);
}

#[test]
fn changes_by_others_and_damage_are_found_in_every_table() {
    let (_folder, mut db) = database_of_waves(2);
    changes()
        .into_iter()
        .take(3)
        .for_each(|change| change(&mut db));
    for (table, change) in [
        (
            "samples",
            "UPDATE samples SET start_secs = start_secs + 1e-9 WHERE id = 1",
        ),
        (
            "classes",
            "UPDATE classes SET name = 'weve' WHERE name = 'wave'",
        ),
        ("clips", "UPDATE clips SET subject = 'bob' WHERE id = 2"),
        ("tags", "DELETE FROM tags WHERE clip = 1 AND tag = 'a'"),
        (
            "segments",
            "UPDATE segments SET kind = 'still' WHERE id = 1",
        ),
        ("files", "UPDATE files SET path = path || 'x' WHERE id = 1"),
    ] {
        assert!(db.check().unwrap().faults.is_empty());
        db.conn.execute(change, []).unwrap();
        let faults = db.check().unwrap().faults;
        assert!(
            faults.len() == 1 && faults[0].contains(table),
            "{table}: {faults:?}"
        );
        db.repair(&()).unwrap();
    }
}

#[test]
fn flipped_bits_of_feature_rows_are_found_and_made_again() {
    let (_folder, mut db) = database_of_waves(1);
    let params = Default::default();
    let good = db.rows(&params, &()).unwrap();
    let bytes: Vec<u8> = db
        .conn
        .query_row("SELECT bytes FROM feature_rows", [], |row| row.get(0))
        .unwrap();
    for at in (0..bytes.len()).step_by(bytes.len() / 39) {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1 << (at % 8);
        let sql = "UPDATE feature_rows SET bytes = ?1";
        db.conn.execute(sql, [&bytes]).unwrap();
        let faults = db.check().unwrap().faults;
        assert!(
            faults.len() == 1 && faults[0].contains("feature rows"),
            "{at}: {faults:?}"
        );
        db.conn.pragma_update(None, "query_only", true).unwrap();
        assert_eq!(db.rows(&params, &()).unwrap(), good, "beside the file");
        db.conn.pragma_update(None, "query_only", false).unwrap();
        assert_eq!(db.rows(&params, &()).unwrap(), good);
        assert!(db.check().unwrap().faults.is_empty(), "and kept");
    }
}

/// A database as version 1 of the schema left it, with a step to take back.
#[test]
fn databases_of_the_first_schema_open_with_their_history() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("old.mdb");
    let old = Connection::open(&path).unwrap();
    old.execute_batch(include_str!("../migrations/0001.sql"))
        .unwrap();
    old.execute_batch(
        "INSERT INTO files VALUES (1, x'00', 'a.bvh', NULL, 'bvh', 9, 0, '[]');
         INSERT INTO skeletons VALUES (1, x'00', 1);
         INSERT INTO clips VALUES (1, 'a', 1, 0, 1, 100, 30.0, 0, 0, '[]', '{}', 0.0, 0.0, x'00', NULL, NULL, NULL);
         INSERT INTO edits (what, set_secs) VALUES ('add 1 samples', 5);
         INSERT INTO classes VALUES (1, 'wave');
         INSERT INTO samples VALUES (1, 1, 1, 0.0, 1.0, 0, 'accepted', NULL, 'me', 5);
         UPDATE edits SET open = 0;
         INSERT INTO edits (what, set_secs) VALUES ('rename wave to greet', 6);
         UPDATE classes SET name = 'greet';
         UPDATE edits SET open = 0;
         INSERT INTO feature_rows VALUES (1, 'old', 1, x'00');",
    )
    .unwrap();
    old.pragma_update(None, "application_id", APPLICATION_ID)
        .unwrap();
    old.pragma_update(None, "user_version", 1).unwrap();
    drop(old);
    assert!(matches!(
        MotionDb::open_read_only(&path),
        Err(DbError::Older {
            found: 1,
            known: SCHEMA,
            ..
        })
    ));
    let mut db = MotionDb::open(&path).unwrap();
    assert_eq!(db.clips(&ClipFilter::default()).unwrap().len(), 1);
    let name = |db: &MotionDb| db.classes().unwrap().first().map(|c| c.name.clone());
    assert_eq!(name(&db).as_deref(), Some("greet"));
    assert_eq!(
        db.undo(None).unwrap().unwrap().step.what,
        "rename wave to greet"
    );
    assert_eq!(name(&db).as_deref(), Some("wave"));
    db.undo(None).unwrap();
    assert!(name(&db).is_none() && db.samples(&SampleFilter::default()).unwrap().is_empty());
    db.redo(None).unwrap();
    db.redo(None).unwrap();
    assert_eq!(name(&db).as_deref(), Some("greet"));
    assert!(crate::digest::faults(&db.conn).unwrap().is_empty());
    // What later schemas added is there.
    assert!(db.reports().unwrap().is_empty());
    let report = serde_json::json!({"classes": 1});
    let kept = db.keep_report(crate::ReportKind::Training, "1 class", &report);
    assert_eq!(db.report(kept.unwrap()).unwrap(), report);
}
