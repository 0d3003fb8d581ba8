//! Faults give a sentence in place, and nothing is lost.

use morec::TimeSpan;
use morec_db::labels::NewSample;

use super::{Person, made};
use crate::state::{Command, FileCommand, Panel};
use crate::store::Edit;

#[test]
fn a_file_that_is_no_database_gives_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("text.mdb");
    std::fs::write(
        &path,
        "this is no database, whatever its name says".repeat(40),
    )
    .unwrap();
    let person = Person::before(&[path]);
    assert!(person.state().store.is_none());
    assert!(person.sees_part("text.mdb: expected a motion database, found another kind of file"));
    assert!(person.sees("Open a database …"), "and what to do");
    let broken = folder.path().join("broken.mdb");
    let whole = std::fs::read(made(folder.path(), 1)).unwrap();
    std::fs::write(&broken, &whole[..whole.len() / 3]).unwrap();
    let person = Person::before(&[broken]);
    assert!(person.sees_part("broken.mdb: the database is damaged"));
    assert!(person.sees_part("import its clips again"), "and what to do");
    let person = Person::before(&[folder.path().join("nowhere.mdb")]);
    assert!(person.sees_part("nowhere.mdb: no such file"));
}

/// Overwrites the motion of one clip.
fn damage_one_clip(path: &std::path::Path) {
    let whole = std::fs::read(path).unwrap();
    let magic = morec::smooth::MAGIC;
    let places = whole.windows(magic.len()).enumerate();
    let damaged = places.filter(|(_, w)| *w == magic).any(|(at, _)| {
        let mut bytes = whole.clone();
        bytes[at..at + 64].fill(0xff);
        std::fs::write(path, bytes).unwrap();
        // Not every place is a clip's: rooms that are free again hold old copies.
        let db = morec_db::MotionDb::open_read_only(path).unwrap();
        let clips = db.clips(&morec_db::ClipFilter::default()).unwrap();
        clips.iter().filter(|c| db.clip(c.id).is_err()).count() == 1
    });
    assert!(damaged);
}

#[test]
fn a_database_that_is_damaged_keeps_what_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    damage_one_clip(&path);
    let mut person = Person::before(&[path]);
    let names = ["ada_1", "ben_1", "cleo_1"];
    for name in names {
        person.command(Command::Show(Panel::Library));
        person.click(name);
        person.settle();
    }
    assert!(
        !person.state().notices.is_empty(),
        "the damaged clip is named"
    );
    assert!(
        person.state().player.motion.is_some(),
        "the others are shown"
    );
    assert!(names.iter().all(|name| person.sees(name)));
}

#[test]
fn a_clip_without_roles_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("box.bvh");
    let frame = "0 0 0 0 0 0\n".repeat(60);
    std::fs::write(&file, format!("HIERARCHY\nROOT crate\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\nMOTION\nFrames: 60\nFrame Time: 0.0166667\n{frame}")).unwrap();
    let mut person = Person::before(&[file]);
    assert!(person.sees("box"));
    assert!(person.sees_part("nothing can be recognised in this clip"));
    person.goes_to(Panel::Label);
    person.settle();
    let note = person.state().curves.as_ref().unwrap().note.clone();
    assert!(note.is_some(), "and the timeline says why there is no cut");
}

#[test]
fn what_cannot_be_written_is_said_and_what_was_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let before = person.labels();
    let nowhere = folder.path().join("no such folder").join("copy.mdb");
    person.command(Command::File(FileCommand::Save(nowhere)));
    assert!(person.sees_part("not saved"));
    assert_eq!(person.labels(), before, "the old one is open again");
    person.command(Command::File(FileCommand::ExportIndex(
        folder.path().join("x.index"),
    )));
    assert!(person.sees_part("No index yet"));
}

#[test]
fn a_full_disk_is_said_and_what_was_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let before = person.labels();
    let store = person.window.state_mut().state.store.as_mut().unwrap();
    store.fill();
    let clip = store.snapshot.clips[0].id;
    let many = (0..20_000).map(|n| {
        NewSample::accepted(
            clip,
            "wave",
            TimeSpan::new(f64::from(n) * 1e-3, f64::from(n) * 1e-3 + 0.5),
        )
    });
    person.command(Command::Edit(Edit::Label(many.collect())));
    assert!(person.sees_part("The disk is full: the last change was rolled back"));
    assert_eq!(person.labels(), before);
    person.click("Dismiss");
    assert!(!person.sees_part("The disk is full"));
}

#[test]
fn a_notice_moves_no_control_and_goes_when_its_cause_has() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let before = person.place("ada_1");
    let index = folder.path().join("x.index");
    person.command(Command::File(FileCommand::ExportIndex(index)));
    assert!(person.sees_part("No index yet"));
    assert_eq!(person.place("ada_1"), before, "it lies over the room");
    // What has nothing to do with it leaves it there, what takes its cause away does not.
    person.goes_to(Panel::Train);
    assert!(person.sees_part("No index yet"));
    person.click("Start training");
    person.settle();
    assert!(!person.sees_part("No index yet"));
}

#[test]
fn a_failed_job_is_complained_of_until_one_of_its_kind_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let clip = person.state().player.motion.as_ref().unwrap().id;
    let of = crate::stretch::Stretch::new(clip, 1.0..2.0);
    let compare = |person: &mut Person, class: &str| {
        let class = class.to_owned();
        person.command(Command::Compare(crate::state::CompareCommand::NearestOf {
            of,
            class,
        }));
        person.settle();
    };
    compare(&mut person, "jump");
    assert!(person.sees_part("No other label of jump"));
    let update = morec_db::ClipUpdate {
        add_tags: vec!["seen".to_owned()],
        ..Default::default()
    };
    let clips = vec![clip];
    person.command(Command::Edit(Edit::Describe { clips, update }));
    person.settle();
    assert!(person.sees_part("No other label of jump"));
    compare(&mut person, "wave");
    assert!(!person.sees_part("No other label of jump"));
}
