//! Clips marked as background in the library, for training and live.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use egui::Key;
use morec::synth::{DatabaseSpec, database};
use morec::train::Everyday;
use morec_db::{BACKGROUND, ClipUpdate, MotionDb};

use super::{Person, files_of, made, takes, written};
use crate::state::{Command, FileCommand, LiveCommand, Panel};
use crate::store::Edit;

/// Two clips `other_…` of other gestures, as files.
fn other_motion() -> &'static [(String, Vec<u8>)] {
    static FILES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    FILES.get_or_init(|| {
        let spec = DatabaseSpec {
            people: 2,
            repetitions: 2,
            classes: vec!["raise_hands", "circle", "push"],
            unknown_share: 1.0,
            ..DatabaseSpec::default()
        };
        let files = files_of(&database(11, &spec)).into_iter().zip(1..);
        files
            .map(|((_, bytes), number)| (format!("other_{number}.bvh"), bytes))
            .collect()
    })
}

/// The database of [`made`], and in it the clips of other motion.
fn with_other_motion(folder: &Path, labelled: usize) -> PathBuf {
    static MADE: [OnceLock<Vec<u8>>; 4] = [const { OnceLock::new() }; 4];
    let path = made(folder, labelled);
    let files = written(folder, other_motion());
    let bytes = MADE[labelled].get_or_init(|| {
        let (reader, about) = (morec::files::FileReader::default(), ClipUpdate::default());
        let mut db = MotionDb::open(&path).unwrap();
        db.import(&files, &reader, &about, &()).unwrap();
        drop(db);
        std::fs::read(&path).unwrap()
    });
    std::fs::write(&path, bytes).unwrap();
    path
}

/// Names of the clips that are marked.
fn marked(person: &Person) -> Vec<String> {
    let store = person.state().store.as_ref().unwrap();
    let clips = store.snapshot.clips.iter().filter(|c| c.is_background());
    clips.map(|c| c.name.clone()).collect()
}

#[test]
fn clips_are_marked_by_key_tick_and_menu_and_each_is_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[with_other_motion(folder.path(), 1)]);
    person.click("other_1");
    person.settle();
    person.key(Key::B);
    person.settle();
    assert_eq!(marked(&person), ["other_1"]);
    assert!(person.offers("other_1, background") && !person.offers("other_1"));
    assert!(person.sees("1 clip marked as background"));
    let line = person.state().command_line.clone();
    assert!(
        line.ends_with("--clip other_1 --add-tag background"),
        "{line}"
    );
    let store = person.state().store.as_ref().unwrap();
    assert_eq!(
        store.snapshot.undo_step().map(|s| s.what.as_str()),
        Some("tag 1 clip background")
    );
    // The key again, a click on the details, and undo take the mark away.
    person.key(Key::B);
    person.settle();
    assert!(marked(&person).is_empty());
    assert!(
        person
            .state()
            .command_line
            .ends_with("--remove-tag background")
    );
    person.undo();
    assert_eq!(marked(&person), ["other_1"]);
    person.click("Background");
    person.settle();
    assert!(marked(&person).is_empty());
    // Several at once: they are marked until all are.
    person.ctrl_click("other_2");
    person.click("Background");
    person.settle();
    assert_eq!(marked(&person), ["other_1", "other_2"]);
    person.undo();
    assert!(marked(&person).is_empty());
    person.redo();
    assert_eq!(marked(&person).len(), 2);
    person.right_click("ben_1");
    person.click("Use as background");
    person.settle();
    assert_eq!(marked(&person), ["ben_1", "other_1", "other_2"]);
    person.right_click("ben_1, background");
    person.click("No longer background");
    person.settle();
    assert_eq!(marked(&person).len(), 2);
}

#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "trains for most of a minute: .ci/nightly runs it, in release"
)]
fn background_teaches_a_verifier_which_recognises_live() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_other_motion(folder.path(), 3);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.everyday = Everyday::Always;
    person.goes_to(Panel::Train);
    person.click("Start training");
    person.settle();
    assert!(person.sees_part("Candidates are not verified"));
    person.click("Background other_1");
    person.settle();
    person.click("Background other_2");
    person.settle();
    assert!(person.sees("Labels or background have changed since training."));
    person.click("Train again");
    person.settle();
    let report = person.state().train.report.clone().unwrap();
    assert!(person.sees("Candidates are verified."), "{report:?}");
    assert!(person.sees_part("Background: clips "));
    let trained = person.state().train.index.clone().unwrap();
    assert!(trained.provenance.background_secs["clips"] > 10.0);
    assert_eq!(trained.provenance.clips.len(), 3, "labelled ones");
    // What is kept follows the marks as it follows the labels.
    person.click("Keep");
    person.settle();
    assert!(person.sees("up to date"));
    person.click("Background other_2");
    person.settle();
    assert!(person.sees("labels or background have changed since"));
    person.undo();
    assert!(person.sees("up to date"));
    // A cross-validation learns from the same background.
    let material = crate::jobs::train::material(&path, &[]).unwrap();
    assert_eq!(material.clips.len() - material.labelled().count(), 2);
    person.click("Cross-validate");
    person.settle();
    assert!(person.state().train.judged.is_some());
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    let live = person.state().live.index().unwrap();
    assert!(std::sync::Arc::ptr_eq(live, &trained));
    let secs = takes()[0].clip.duration_secs();
    while person.state().live.counts.is_empty() {
        let now = person.state().live.run.as_ref().unwrap().now_secs;
        assert!(now < secs, "nothing is recognised");
        person.frames(1);
    }
}

#[test]
fn a_clip_with_labels_stays_labelled_whatever_its_mark() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_other_motion(folder.path(), 1);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.click("ada_1");
    person.settle();
    person.key(Key::B);
    person.settle();
    assert!(person.sees("It has labels and is used as labelled, not as background."));
    let material = crate::jobs::train::material(&path, &[]).unwrap();
    assert_eq!(material.labelled().count(), 1);
    assert_eq!(material.clips.len(), 1);
    person.goes_to(Panel::Train);
    assert!(person.sees("6 labels: used as labelled"));
    person.click("Start training");
    person.settle();
    let index = person.state().train.index.clone().unwrap();
    assert_eq!(index.provenance.clips, ["ada_1"]);
    assert!(!index.provenance.background_secs.contains_key("clips"));
}

#[test]
fn two_sides_of_one_motion_teach_each_other_as_in_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    let renames = [("wave", "wave_left"), ("clap", "wave_right")];
    for (from, to) in renames.map(|(from, to)| (from.to_owned(), to.to_owned())) {
        person.command(Command::Edit(Edit::RenameClass { from, to }));
    }
    person.goes_to(Panel::Train);
    person.click("Start training");
    person.settle();
    assert!(person.sees_part("mirrored copies of 12 samples are used too"));
}

/// Plays the first clip live until a moment.
fn live_until(person: &mut Person, secs: f64) {
    person.goes_to(Panel::Live);
    person.click("Start");
    person.settle();
    while person.state().live.run.as_ref().unwrap().now_secs < secs {
        person.frames(1);
    }
}

fn select(person: &mut Person, stretch: (f64, f64)) {
    person.command(Command::Live(LiveCommand::Range(Some(stretch))));
}

#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "trains for most of a minute: .ci/nightly runs it, in release"
)]
fn what_was_nothing_is_marked_live_learned_and_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[with_other_motion(folder.path(), 3)]);
    person.everyday = Everyday::Always;
    // A clip without labels plays, in which somebody moves.
    person.click("other_1");
    person.settle();
    live_until(&mut person, 6.0);
    select(&mut person, (3.0, 5.0));
    person.key(Key::Num0);
    let line = person.state().command_line.clone();
    assert!(line.starts_with("morec record --listen clip://"), "{line}");
    assert!(line.ends_with("--tag background"), "{line}");
    assert!(person.state().live.range.is_none());
    person.settle();
    assert_eq!(marked(&person), ["background_001"]);
    let store = person.state().store.as_ref().unwrap();
    let kept = store.snapshot.clips.iter().find(|c| c.is_background());
    // What lies around it may be a class: only the stretch itself is kept.
    // With what is around it, as far as that is nothing of a class.
    let secs = kept.unwrap().duration_secs();
    assert!((2.1..5.1).contains(&secs), "{secs}");
    let index = person.state().live.index().unwrap().clone();
    assert!(index.provenance.background_secs.contains_key("clips"));
    // The same motion cannot be a class too.
    select(&mut person, (3.2, 4.6));
    person.key(Key::Num1);
    assert!(person.sees_part("this motion is marked as background already; undo that mark first"));
    assert_eq!(person.state().live.marks.len(), 1);
    // One undo takes it back, and then it can.
    person.undo();
    assert!(marked(&person).is_empty() && person.state().live.marks.is_empty());
    person.click("Train again");
    person.settle();
    assert!(!person.offers("Train again"));
    let index = person.state().live.index().unwrap();
    assert!(!index.provenance.background_secs.contains_key("clips"));
    let labels = person.labels().len();
    person.key(Key::Num1);
    person.settle();
    assert_eq!(person.labels().len(), labels + 1);
    select(&mut person, (3.2, 4.6));
    person.click("Mark as background");
    person.settle();
    assert!(marked(&person).is_empty());
    assert_eq!(person.state().live.marks.len(), 1);
}

#[test]
fn a_label_of_the_played_clip_is_not_marked_as_background() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[with_other_motion(folder.path(), 3)]);
    let take = &takes()[0];
    let label = take.labels[0];
    let secs = take.clip.duration_secs();
    live_until(&mut person, secs + 1.0 + label.span.stop_secs + 1.0);
    // In the second lap too.
    for lap in [0.0, secs + 1.0] {
        let at = |s: f64| s + lap;
        select(
            &mut person,
            (at(label.span.start_secs), at(label.span.stop_secs)),
        );
        person.click("Mark as background");
        person.settle();
        assert!(marked(&person).is_empty());
        let why = format!(
            "Not marked: ada_1 has a label of {} at this time",
            label.class
        );
        assert!(person.sees_part(&why), "{:?}", person.state().notices);
        person.command(Command::Dismiss(0));
    }
    assert!(person.state().notices.is_empty());
}

#[test]
fn a_class_is_not_taught_live_by_a_clip_that_is_background() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[with_other_motion(folder.path(), 3)]);
    person.click("other_1");
    person.settle();
    person.key(Key::B);
    person.settle();
    live_until(&mut person, 6.0);
    let labels = person.labels();
    person.key(Key::Num1);
    person.settle();
    assert!(person.sees_part("Not marked: other_1 is background"));
    assert_eq!(person.labels(), labels);
    assert_eq!(marked(&person), ["other_1"]);
}

#[test]
fn the_tag_of_the_command_is_the_mark_of_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_other_motion(folder.path(), 1);
    let mut db = MotionDb::open(&path).unwrap();
    let clip = db.find_clip("other_2").unwrap().id;
    let about = ClipUpdate {
        add_tags: vec![BACKGROUND.to_owned()],
        ..ClipUpdate::default()
    };
    db.update_clips(&[clip], &about).unwrap();
    drop(db);
    let person = Person::before(&[path]);
    assert!(person.offers("other_2, background"));
}

#[test]
fn what_was_imported_is_marked_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let more = tempfile::tempdir().unwrap();
    with_other_motion(more.path(), 0);
    let files = [1, 2].map(|n| more.path().join(format!("other_{n}.bvh")));
    person.command(Command::File(FileCommand::Import(files.to_vec())));
    person.click("Use them as background");
    person.settle();
    assert_eq!(marked(&person), ["other_1", "other_2"]);
    assert!(!person.offers("Use them as background"));
    person.undo();
    assert!(marked(&person).is_empty() && person.offers("other_1"));
    assert!(person.offers("Use them as background"));
}

#[test]
fn none_of_these_takes_the_false_alarm_that_was_just_reported_and_says_whether_it_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    person.everyday = Everyday::Always;
    // A clip without labels: what is recognised in it may be a false alarm.
    person.click("ada_1");
    person.settle();
    let own = person.state().shown_samples().iter().map(|s| s.id);
    let own = own.collect();
    person.command(Command::Edit(Edit::Remove(own)));
    person.key_with(Key::T, egui::Modifiers::COMMAND);
    person.settle();
    person.goes_to(Panel::Live);
    person.click("Start");
    person.settle();
    let run = |person: &Person| person.state().live.run.as_ref().unwrap().now_secs;
    let seen = |person: &Person| person.state().live.run.as_ref().unwrap().seen.clone();
    while seen(&person).is_empty() && run(&person) < 60.0 {
        person.frames(1);
    }
    let alarm = seen(&person)[0].span;
    let clips = person.state().store.as_ref().unwrap().snapshot.clips.len();
    // One key is enough.
    person.key(Key::Num0);
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    assert_eq!(store.snapshot.clips.len(), clips + 1);
    let mut marked = store.snapshot.clips.iter().filter(|c| c.is_background());
    let new = marked.next().unwrap();
    let length = new.duration_secs();
    assert!(
        length > alarm.duration_secs() + 0.5,
        "{length} with what is around {alarm:?}"
    );
    let marked = person.state().live.marks[0].span;
    assert!(marked.overlap_secs(alarm) > 0.99 * alarm.duration_secs());
    assert_eq!(
        person.state().said,
        "the new index reports nothing there",
        "{:?}",
        person.state().notices
    );
}
