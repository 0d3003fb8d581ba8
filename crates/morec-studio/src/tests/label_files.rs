//! Labels of files come in, after a look at what they change.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use morec_db::exchange::{self, Annotation, LabelFormat, clip_lengths};
use morec_db::labels::SampleFilter;
use morec_db::{ClipFilter, MotionDb};

use super::{Person, clips_of, made, takes};

/// The labels of the takes as a table.
fn table(folder: &Path) -> PathBuf {
    let mut text = "clip\tclass\tstart_secs\tstop_secs\n".to_owned();
    for take in takes() {
        for l in &take.labels {
            let line = (
                &take.clip.name,
                l.class,
                l.span.start_secs,
                l.span.stop_secs,
            );
            text += &format!("{}\t{}\t{}\t{}\n", line.0, line.1, line.2, line.3);
        }
    }
    let path = folder.join("labels.tsv");
    std::fs::write(&path, text).unwrap();
    path
}

fn count() -> usize {
    takes().iter().map(|take| take.labels.len()).sum()
}

#[test]
fn a_table_is_looked_at_and_applied_as_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    let path = table(folder.path());
    person.will_choose(&[&path]);
    person.wait(0.5);
    person.click("File");
    person.click("Import labels …");
    person.settle();
    assert!(person.sees(&format!("labels: {} added", count())));
    assert!(person.sees_part("added ada_1"), "each with its clip");
    assert!(person.labels().is_empty(), "not yet");
    person.click("Cancel");
    person.settle();
    assert!(person.labels().is_empty());
    // A table that is dropped is no table of points.
    person.drops(&[&path]);
    assert!(person.state().import_report.is_none());
    person.click("Apply");
    person.settle();
    assert_eq!(person.labels().len(), count());
    assert!(person.state().command_line.ends_with("labels.tsv"));
    person.undo();
    assert!(person.labels().is_empty(), "one step");
}

#[test]
fn labels_in_place_of_others_say_what_moves_and_goes() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let label = &takes()[0].labels[0];
    let (start, stop) = (label.span.start_secs + 0.1, label.span.stop_secs);
    let path = folder.path().join("corrected.csv");
    let line = format!("ada_1,{},{start},{stop}", label.class);
    let absent = "nobody,wave,1,2";
    std::fs::write(
        &path,
        format!("file,label,start_s,end_s\n{line}\n{absent}\n"),
    )
    .unwrap();
    person.drops(&[&path]);
    assert!(person.sees_part("1 label of unknown clips left out: nobody"));
    person.click("Replace labels");
    person.frames(2);
    let gone = takes()[0].labels.len() - 1;
    assert!(person.sees(&format!("labels: 1 moved, {gone} gone")));
    assert!(person.sees_part("gone ada_1"));
    person.click("Apply");
    person.settle();
    assert_eq!(person.labels().len(), 1);
    assert!(
        person
            .state()
            .command_line
            .ends_with("corrected.csv --replace")
    );
    person.undo();
    assert_eq!(person.labels().len(), gone + 1);
}

#[test]
fn every_form_comes_in() {
    let folder = tempfile::tempdir().unwrap();
    let db = MotionDb::open_read_only(&made(folder.path(), 1)).unwrap();
    let samples = db.samples(&SampleFilter::default()).unwrap();
    let annotations: Vec<Annotation> = samples.into_iter().map(Annotation::from).collect();
    let lengths = clip_lengths(&db.clips(&ClipFilter::default()).unwrap());
    drop(db);
    let mut person = Person::before(&[made(&tempfile::tempdir().unwrap().keep(), 0)]);
    for form in LabelFormat::ALL {
        let name = format!("ada_1.{}", form.ending());
        let path = folder.path().join(name);
        let text = exchange::write(form, &annotations, &lengths).unwrap();
        std::fs::write(&path, text).unwrap();
        person.drops(&[&path]);
        // Enter applies what is shown.
        person.key(Key::Enter);
        person.settle();
        assert_eq!(person.labels().len(), annotations.len(), "{form:?}");
        person.undo();
        assert!(person.labels().is_empty(), "{form:?}");
    }
}

#[test]
fn labels_without_their_clips_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[table(folder.path())]);
    assert!(person.sees_part("These are labels: open or import their clips first"));
}

/// From clips and a table of labels to an index: no more clicks and keys than this.
const AT_MOST: usize = 5;

#[test]
fn clips_and_a_table_beside_them_become_an_index_after_few_clicks_and_keys() {
    let folder = tempfile::tempdir().unwrap();
    let clips = folder.path().join("clips");
    std::fs::create_dir(&clips).unwrap();
    clips_of(&clips);
    table(folder.path());
    std::fs::write(folder.path().join("notes.txt"), "walk, then wave").unwrap();
    let mut person = Person::before(&[]);
    person.will_choose(&[&clips]);
    person.click("Folder …");
    person.settle();
    assert!(person.sees("labels.tsv beside the clips contains labels"));
    person.click("Review the labels");
    person.settle();
    person.click("Apply");
    person.settle();
    assert_eq!(person.labels().len(), count());
    assert!(!person.sees_part("beside them"), "they are in");
    person.key_with(Key::T, Modifiers::COMMAND);
    person.settle();
    assert!(person.state().train.index.is_some());
    eprintln!("{} clicks and keys from clips and a table", person.actions);
    assert!(person.actions <= AT_MOST, "{}", person.actions);
}

#[test]
fn people_of_a_table_come_with_its_labels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("moves.mdb");
    let files = clips_of(folder.path());
    let mut db = MotionDb::create(&path).unwrap();
    let about = morec_db::ClipUpdate::default();
    db.import(&files, &morec::files::FileReader::default(), &about, &())
        .unwrap();
    drop(db);
    let text = std::fs::read_to_string(table(folder.path())).unwrap();
    let mut lines = text
        .lines()
        .map(|line| match line.split_once('\t').unwrap().0 {
            "clip" => format!("{line}\tperson\n"),
            clip => format!("{line}\t{}\n", clip.split_once('_').unwrap().0),
        });
    let labels = folder.path().join("by.tsv");
    std::fs::write(&labels, lines.by_ref().collect::<String>()).unwrap();
    let mut person = Person::before(&[path]);
    person.drops(&[&labels]);
    assert!(person.sees_part("3 people of clips"));
    person.click("Apply");
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    let people = store
        .snapshot
        .clips
        .iter()
        .map(|c| c.subject.clone().unwrap_or_default());
    assert_eq!(people.collect::<Vec<_>>(), ["ada", "ben", "cleo"]);
    // Whole seconds in columns of frames are refused.
    let whole = folder.path().join("whole.tsv");
    std::fs::write(
        &whole,
        "clip\tclass\tstart\tstop\nada_1\twave\t3\t5\nben_1\twave\t7\t9\n",
    )
    .unwrap();
    person.drops(&[&whole]);
    assert!(person.state().label_import.is_none());
    assert!(person.sees_part("probably in another unit"));
}
