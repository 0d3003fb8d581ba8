//! The file, and what comes into it.

use std::path::PathBuf;

use morec::TimeSpan;
use morec::progress::Progress;
use tempfile::TempDir;

use morec::files::FileReader;
use morec::formats::Limits;

use crate::testing::{database_of_waves, waves, write_bvh};
use crate::{ClipFilter, ClipInfo, ClipUpdate, DbError, ImportOutcome, MotionDb};

fn names_in(db: &MotionDb) -> Vec<String> {
    let clips = db.clips(&ClipFilter::default()).unwrap();
    clips.into_iter().map(|c| c.name).collect()
}

#[test]
fn other_files_are_plain_errors() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(matches!(
        MotionDb::open(&path("none")),
        Err(DbError::Missing(_))
    ));
    assert!(matches!(
        MotionDb::open(folder.path()),
        Err(DbError::NotADatabase(_))
    ));
    std::fs::write(path("text"), "HIERARCHY\n".repeat(500)).unwrap();
    assert!(matches!(
        MotionDb::open(&path("text")),
        Err(DbError::NotADatabase(_))
    ));
    let other = rusqlite::Connection::open(path("other")).unwrap();
    other
        .execute_batch("CREATE TABLE t (a); PRAGMA application_id = 7;")
        .unwrap();
    for open in [MotionDb::open, MotionDb::open_read_only] {
        assert!(matches!(
            open(&path("other")),
            Err(DbError::Foreign { found: 7, .. })
        ));
    }
    // What a program that was killed while it made a database left behind.
    std::fs::write(path("begun"), "").unwrap();
    assert!(
        MotionDb::open(&path("begun"))
            .unwrap()
            .summary()
            .unwrap()
            .clips
            == 0
    );
    MotionDb::create(&path("newer")).unwrap();
    rusqlite::Connection::open(path("newer"))
        .unwrap()
        .pragma_update(None, "user_version", 99)
        .unwrap();
    assert!(matches!(
        MotionDb::open(&path("newer")),
        Err(DbError::Newer { found: 99, .. })
    ));
    assert!(matches!(
        MotionDb::create(&path("newer")),
        Err(DbError::Exists(_))
    ));
}

/// What a file brings along may run whenever a clip is added, or hide what is there.
#[test]
fn a_schema_of_another_hand_is_refused_by_name() {
    let delete = "AFTER UPDATE ON clips BEGIN DELETE FROM samples; END";
    for (sql, named) in [
        (format!("CREATE TRIGGER gone {delete}"), r#"trigger "gone""#),
        (
            "CREATE VIEW people AS SELECT subject FROM clips".into(),
            r#"view "people""#,
        ),
        (
            "DROP TRIGGER clips_moved".into(),
            r#"no trigger "clips_moved""#,
        ),
        (
            format!("DROP TRIGGER clips_moved; CREATE TRIGGER clips_moved {delete}"),
            r#"another trigger "clips_moved""#,
        ),
        (
            "ALTER TABLE clips ADD COLUMN secret TEXT GENERATED ALWAYS AS (name) VIRTUAL".into(),
            r#"another table "clips""#,
        ),
    ] {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("a.mdb");
        MotionDb::create(&path).unwrap();
        assert!(MotionDb::open(&path).is_ok());
        let conn = rusqlite::Connection::open(&path).unwrap();
        conn.execute_batch(&sql).unwrap();
        for opened in [MotionDb::open(&path), MotionDb::open_read_only(&path)] {
            let error = opened.map(drop).unwrap_err().to_string();
            assert!(error.contains("a.mdb") && error.contains(named), "{error}");
        }
    }
}

#[test]
fn names_of_clips_are_as_long_as_those_of_classes() {
    let folder = TempDir::new().unwrap();
    let take = waves(1).remove(0);
    let long = "é".repeat(120);
    let paths = [
        write_bvh(folder.path(), &long, &take.clip),
        write_bvh(folder.path(), &format!("{long}x"), &waves(2)[1].clip),
    ];
    let mut db = MotionDb::create(&folder.path().join("a.mdb")).unwrap();
    let report = db
        .import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    let clips = db.clips(&ClipFilter::default()).unwrap();
    let names: Vec<&str> = clips.iter().map(|clip| clip.name.as_str()).collect();
    let (whole, numbered) = ("é".repeat(100), format!("{}~2", "é".repeat(99)));
    assert_eq!(names, [numbered.as_str(), whole.as_str()]);
    let ImportOutcome::Imported { warnings, .. } = &report.files[0].1 else {
        panic!("{report:?}");
    };
    assert!(
        warnings.iter().any(|text| text.contains("240 bytes")),
        "{warnings:?}"
    );
    let first = names[0].to_owned();
    assert!(db.rename_clip(&first, &"a".repeat(200)).is_ok());
    let error = db.rename_clip(&"a".repeat(200), &"a".repeat(201));
    assert!(error.unwrap_err().to_string().contains("1 to 200 bytes"));
}

/// One file that needs too much does not cost the others; one that needs more than its share is read by itself.
#[test]
fn memory_is_shared_among_files_that_are_read_side_by_side() {
    let folder = TempDir::new().unwrap();
    let takes = waves(2);
    let large = write_bvh(folder.path(), "large", &takes[0].clip);
    let small = folder.path().join("small.bvh");
    let text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n\
                MOTION\nFrames: 3\nFrame Time: 0.02\n1 2 3\n4 5 6\n7 8 9\n";
    std::fs::write(&small, text).unwrap();
    let paths = [large, small];
    let mut db = MotionDb::create(&folder.path().join("a.mdb")).unwrap();
    let little = FileReader {
        limits: Limits {
            memory: 10_000,
            ..Limits::default()
        },
        ..FileReader::default()
    };
    let about = ClipUpdate::default();
    let report = db.import(&paths, &little, &about, &()).unwrap();
    let counts = report.counts();
    assert_eq!((counts.imported, counts.refused), (1, 1), "{report:?}");
    let ImportOutcome::Refused(refused) = &report.files[0].1 else {
        panic!("{report:?}");
    };
    assert!(refused.reason.contains("memory"), "{}", refused.reason);
    let report = db
        .import_sharing(&paths, &FileReader::default(), &about, &(), 10_000)
        .unwrap();
    let counts = report.counts();
    assert_eq!((counts.imported, counts.known), (1, 1), "{report:?}");
}

#[test]
fn what_was_imported_is_there_within_its_error() {
    let takes = waves(2);
    let (_folder, db) = database_of_waves(2);
    let clips = db.clips(&ClipFilter::default()).unwrap();
    assert_eq!(clips.len(), 2);
    for take in &takes {
        let info = db.find_clip(&take.clip.name).unwrap();
        let stored = db.clip(info.id).unwrap();
        assert_eq!(
            (stored.clip.frames, stored.clip.name.as_str()),
            (take.clip.frames, take.clip.name.as_str())
        );
        assert!((stored.clip.rate_hz - take.clip.rate_hz).abs() < 1e-3);
        let summary = db.summary().unwrap();
        assert!(
            summary.max_angle_rad <= 0.5f64.to_radians() + 1e-9,
            "{summary:?}"
        );
        assert!(summary.max_position_metres <= 0.005 + 1e-9, "{summary:?}");
        for (a, b) in stored.clip.rotations.iter().zip(&take.clip.rotations) {
            // Half a degree, and what six decimals of BVH lose.
            assert!(a.angle_to(b) < 0.51f64.to_radians());
        }
    }
    assert!(db.check().unwrap().faults.is_empty());
}

#[test]
fn the_same_content_is_one_clip() {
    let folder = TempDir::new().unwrap();
    let take = waves(1).remove(0);
    let first = write_bvh(folder.path(), "first", &take.clip);
    let copy = folder.path().join("copy.bvh");
    std::fs::copy(&first, &copy).unwrap();
    let broken = folder.path().join("broken.bvh");
    std::fs::write(&broken, "HIERARCHY\nROOT").unwrap();
    let paths = [first.clone(), copy.clone(), broken.clone()];
    let mut db = MotionDb::create(&folder.path().join("a.mdb")).unwrap();
    let report = db
        .import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    assert!(
        matches!(&report.files[0].1, ImportOutcome::Imported { clips, .. } if clips == &["first"])
    );
    assert_eq!(report.files[1].1, ImportOutcome::Copy { of: first });
    assert!(matches!(&report.files[2].1, ImportOutcome::Refused(_)));
    let again = db
        .import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    assert_eq!(again.files[0].1, ImportOutcome::Known);
    let counts = again.counts();
    assert_eq!(
        (counts.imported, counts.known, counts.copies, counts.refused),
        (0, 1, 1, 1)
    );
    let summary = db.summary().unwrap();
    assert_eq!((summary.clips, summary.files, summary.refused), (1, 1, 1));
    // Once it can be read it is refused no more.
    write_bvh(folder.path(), "broken", &waves(2)[1].clip);
    db.import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    let summary = db.summary().unwrap();
    assert_eq!((summary.clips, summary.refused), (2, 0));
}

#[test]
fn clips_of_one_name_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let mut paths = Vec::new();
    for (take, sub) in waves(3).iter().zip(["a", "b", "b/b"]) {
        std::fs::create_dir_all(folder.path().join(sub)).unwrap();
        paths.push(write_bvh(&folder.path().join(sub), "walk", &take.clip));
    }
    let mut db = MotionDb::create(&folder.path().join("a.mdb")).unwrap();
    db.import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    assert_eq!(names_in(&db), ["b/walk", "walk", "walk~2"]);
}

/// Cancels once this many files were reported.
struct CancelAfter(usize, std::sync::atomic::AtomicUsize);

impl Progress for CancelAfter {
    fn report(&self, _: &str, _: usize, _: usize) {
        self.1.fetch_add(1, std::sync::atomic::Ordering::SeqCst);
    }

    fn cancelled(&self) -> bool {
        self.1.load(std::sync::atomic::Ordering::SeqCst) >= self.0
    }
}

#[test]
fn a_cancelled_import_goes_on_where_it_stopped() {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = waves(3)
        .iter()
        .map(|take| write_bvh(folder.path(), &take.clip.name, &take.clip))
        .collect();
    let mut db = MotionDb::create(&folder.path().join("a.mdb")).unwrap();
    let stop = CancelAfter(1, Default::default());
    let report = db
        .import(
            &paths,
            &FileReader::default(),
            &ClipUpdate::default(),
            &stop,
        )
        .unwrap();
    assert!(report.cancelled);
    assert_eq!(db.summary().unwrap().clips, report.files.len() as u64);
    let report = db
        .import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    assert!(!report.cancelled);
    assert_eq!(db.summary().unwrap().clips, 3);
}

#[test]
fn readers_see_what_was_committed_while_one_writes() {
    let (folder, mut db) = database_of_waves(1);
    let path = folder.path().join("test.mdb");
    let reader = MotionDb::open_read_only(&path).unwrap();
    let writing = db.write().unwrap();
    writing
        .execute("UPDATE clips SET subject = 'x'", [])
        .unwrap();
    assert_eq!(
        reader.clips(&ClipFilter::default()).unwrap()[0].subject,
        None
    );
    writing.commit().unwrap();
    assert_eq!(
        reader.clips(&ClipFilter::default()).unwrap()[0]
            .subject
            .as_deref(),
        Some("x")
    );
    let mut reader = reader;
    let ids = [reader.clips(&ClipFilter::default()).unwrap()[0].id];
    let error = reader
        .update_clips(&ids, &ClipUpdate::default())
        .unwrap_err();
    assert!(matches!(error, DbError::ReadOnly), "{error}");
}

#[test]
fn two_writers_wait_and_then_say_so() {
    let (folder, mut db) = database_of_waves(1);
    let mut other = MotionDb::open(&folder.path().join("test.mdb")).unwrap();
    other
        .conn
        .busy_timeout(std::time::Duration::from_millis(1))
        .unwrap();
    let writing = db.write().unwrap();
    assert!(matches!(
        other.update_clips(&[], &ClipUpdate::default()),
        Err(DbError::Busy)
    ));
    drop(writing);
    other.update_clips(&[], &ClipUpdate::default()).unwrap();
}

/// A file system that is full looks like this to SQLite.
#[test]
fn a_full_disk_keeps_what_was_there() {
    let (folder, mut db) = database_of_waves(1);
    db.limit_bytes(0).unwrap();
    let paths: Vec<PathBuf> = waves(3)[1..]
        .iter()
        .map(|take| write_bvh(folder.path(), &take.clip.name, &take.clip))
        .collect();
    let error = db
        .import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap_err();
    assert!(matches!(error, DbError::Full), "{error}");
    assert_eq!(db.summary().unwrap().clips, 1);
    assert!(db.check().unwrap().faults.is_empty());
}

#[test]
fn rows_are_made_again_when_the_recipe_changes() {
    use morec::features::FeatureParams;
    let (_folder, mut db) = database_of_waves(2);
    let usual = FeatureParams::default();
    assert_eq!(
        db.refresh_rows(&usual, &()).unwrap(),
        0,
        "import keeps them ready"
    );
    let before = db.rows(&usual, &()).unwrap();
    let other = FeatureParams {
        velocity_weight: 0.7,
        ..usual.clone()
    };
    assert_eq!(db.refresh_rows(&other, &()).unwrap(), 2);
    assert_eq!(db.refresh_rows(&usual, &()).unwrap(), 2);
    assert_eq!(
        db.rows(&usual, &()).unwrap(),
        before,
        "rows depend on the stored motion alone"
    );
    db.vacuum(true).unwrap();
    assert_eq!(db.rows(&usual, &()).unwrap(), before);
}

#[test]
fn damage_is_found() {
    let (_folder, db) = database_of_waves(1);
    let id = db.find_clip(&waves(1)[0].clip.name).unwrap().id;
    let mut bytes = db.motion_bytes(id).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    db.conn
        .execute("UPDATE clips SET motion = ?1", [bytes])
        .unwrap();
    let health = db.check().unwrap();
    assert_eq!(health.faults.len(), 1, "{health:?}");
}

#[test]
fn clips_are_renamed_and_removed_with_what_belongs_to_them() {
    use crate::labels::{NewSample, SampleFilter};
    let (_folder, mut db) = database_of_waves(2);
    let names = names_in(&db);
    let sample = NewSample::accepted(
        db.find_clip(&names[0]).unwrap().id,
        "wave",
        TimeSpan::new(0.0, 1.0),
    );
    db.add_samples(&[sample], "me").unwrap();
    assert!(db.rename_clip(&names[0], &names[1]).is_err());
    assert!(db.rename_clip(&names[0], "a\tb").is_err());
    db.rename_clip(&names[0], "first").unwrap();
    assert_eq!(
        db.samples(&SampleFilter::default()).unwrap()[0].clip_name,
        "first"
    );
    let id = db.find_clip("first").unwrap().id;
    assert_eq!(db.remove_clips(&[id]).unwrap(), 1);
    let summary = db.summary().unwrap();
    assert_eq!((summary.clips, summary.files, summary.accepted), (1, 1, 0));
    db.undo(None).unwrap();
    assert_eq!(db.samples(&SampleFilter::default()).unwrap().len(), 1);
    assert!(db.clip(id).is_ok() && db.check().unwrap().faults.is_empty());
}

#[test]
fn names_that_are_not_there_are_errors_with_the_nearest_ones() {
    let (_folder, db) = database_of_waves(1);
    let name = db.clips(&ClipFilter::default()).unwrap()[0].name.clone();
    let typo = format!("{name}x");
    for found in [
        db.find_clip(&typo).map(drop),
        db.find_clips(&ClipFilter {
            name: Some(typo.clone()),
            ..Default::default()
        })
        .map(drop),
    ] {
        let error = found.unwrap_err().to_string();
        assert!(error.contains(&format!("did you mean `{name}`")), "{error}");
    }
    let nobody = ClipFilter {
        subject: Some("anna".into()),
        ..Default::default()
    };
    assert!(
        db.find_clips(&nobody)
            .unwrap_err()
            .to_string()
            .contains("no person")
    );
    assert!(db.need_class("walk").is_err() && db.index("i").is_err());
}

#[test]
fn clips_are_background_by_their_tag_unless_they_hold_samples_of_the_classes() {
    use crate::BACKGROUND;
    use crate::labels::{NewSample, SampleState};
    let (_folder, mut db) = database_of_waves(3);
    let clips = db.clips(&ClipFilter::default()).unwrap();
    let ids: Vec<_> = clips.iter().map(|clip| clip.id).collect();
    let sample = |state| NewSample {
        clip: ids[0],
        class: "wave".into(),
        start_secs: 0.0,
        stop_secs: 1.0,
        whole_clip: false,
        state,
        score: None,
    };
    db.add_samples(&[sample(SampleState::Proposed)], "me")
        .unwrap();
    db.store_index("i", b"bytes").unwrap();
    let last = |db: &MotionDb| db.last_step().unwrap().unwrap().what;
    let tag = ClipUpdate {
        add_tags: vec![BACKGROUND.to_owned()],
        ..ClipUpdate::default()
    };
    let untag = ClipUpdate {
        remove_tags: vec![BACKGROUND.to_owned()],
        ..ClipUpdate::default()
    };
    db.update_clips(&ids[..2], &tag).unwrap();
    assert_eq!(last(&db), "tag 2 clips background");
    let names = |clips: Vec<ClipInfo>| clips.into_iter().map(|c| c.name).collect::<Vec<_>>();
    let parts = |db: &MotionDb, classes: &[&str]| {
        let classes: Vec<String> = classes.iter().map(|c| c.to_string()).collect();
        let found = db.background(&classes).unwrap();
        (names(found.clips).len(), names(found.labelled))
    };
    // A proposal is no sample.
    assert_eq!(parts(&db, &[]), (2, vec![]));
    let index = |db: &MotionDb| db.indexes().unwrap()[0].clone();
    assert!(index(&db).stale && index(&db).samples == 0);
    db.add_samples(&[sample(SampleState::Accepted)], "me")
        .unwrap();
    assert_eq!(last(&db), "add 1 sample of wave");
    assert_eq!(parts(&db, &[]), (1, vec![clips[0].name.clone()]));
    assert_eq!(parts(&db, &["wave"]), (1, vec![clips[0].name.clone()]));
    assert_eq!(parts(&db, &["bow"]), (2, vec![]));
    db.store_index("i", b"bytes").unwrap();
    assert!(!index(&db).stale && index(&db).samples == 1);
    db.update_clips(&ids[1..2], &untag).unwrap();
    assert_eq!(last(&db), "take the tag background off 1 clip");
    assert!(index(&db).stale);
    db.undo(None).unwrap();
    assert!(!index(&db).stale);
}
