//! The report of a cross-validation: one count of mistakes, and from each to its moment and its nearest label.

use std::ffi::OsString;
use std::sync::OnceLock;

use egui::Key;
use egui_kittest::kittest::Queryable;
use morec::TimeSpan;
use morec_db::labels::NewSample;

use super::{Person, made};
use crate::state::{Command, Panel, TrainCommand};
use crate::store::Edit;

/// Whose database was cross-validated before, with the report opened. It is made once and copied: judging takes longer than most tests.
fn judged() -> (tempfile::TempDir, Person) {
    static JUDGED: OnceLock<Vec<(OsString, Vec<u8>)>> = OnceLock::new();
    let files = JUDGED.get_or_init(|| {
        let (folder, person) = cross_validated();
        drop(person);
        let entries = std::fs::read_dir(folder.path())
            .unwrap()
            .map(Result::unwrap);
        let read = entries.map(|entry| (entry.file_name(), std::fs::read(entry.path()).unwrap()));
        read.collect()
    });
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let mut person = Person::before(&[folder.path().join("moves.mdb")]);
    person.goes_to(Panel::Train);
    let reports = &person.state().store.as_ref().unwrap().snapshot.reports;
    let id = reports[0].id;
    person.command(Command::Train(TrainCommand::OpenReport(id)));
    (folder, person)
}

/// Cross-validated, with a label that cannot be recognised and a motion without its label.
fn cross_validated() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    let clip = person.state().player.motion.as_ref().unwrap().id;
    // A wave of somebody is not labelled: where it is recognised, it matches no label.
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let forgotten = snapshot
        .samples
        .iter()
        .find(|s| s.class == "wave" && s.clip != clip);
    person.command(Command::Edit(Edit::Remove(vec![forgotten.unwrap().id])));
    // Nobody moves in the first second: what is labelled there cannot be recognised.
    person.command(Command::Edit(Edit::Label(vec![NewSample::accepted(
        clip,
        "wave",
        TimeSpan::new(0.1, 0.9),
    )])));
    person.goes_to(Panel::Train);
    person.click("Cross-validate");
    person.settle();
    (folder, person)
}

/// True if the command line that is shown searches for this.
fn shows_search(person: &Person, what: &str) -> bool {
    let line = &person.state().command_line;
    line.starts_with("morec db search ") && line.ends_with(what)
}

/// The top of the column name `missed`, if it is drawn in sight.
fn top_of_missed(person: &Person) -> Option<f32> {
    let shapes = person.window.output().shapes.iter();
    let mut tops = shapes.filter_map(|clipped| match &clipped.shape {
        egui::Shape::Text(text) if text.galley.text() == "missed" && text.angle != 0.0 => {
            let at = text.pos;
            clipped.clip_rect.expand(1.0).contains(at).then_some(at.y)
        }
        _ => None,
    });
    tops.next()
}

#[test]
fn names_of_columns_stay_in_sight_while_the_matrix_is_scrolled() {
    let (_folder, mut person) = judged();
    person.window.set_size(egui::vec2(900.0, 300.0));
    person.frames(3);
    let last_row = |person: &Person| {
        let name = person.named_part("no label recognised as wave");
        person.place(&name)
    };
    let at = egui::pos2(last_row(&person).center().x, 200.0);
    person.window.event(egui::Event::PointerMoved(at));
    for _ in 0..40 {
        if last_row(&person).top() < 150.0 {
            break;
        }
        person.window.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: egui::vec2(0.0, -30.0),
            modifiers: egui::Modifiers::NONE,
        });
        person.frames(10);
    }
    let top = last_row(&person).top();
    assert!(top < 150.0, "it is scrolled: {top}");
    let name = top_of_missed(&person).expect("in sight");
    assert!(name < top, "{name} {top}");
}

#[test]
fn matrix_list_and_figures_count_the_same() {
    let (_folder, mut person) = cross_validated();
    let judged = person.state().train.judged.as_ref().unwrap();
    let (rows, columns) = (judged.rows.len(), judged.columns.len());
    let sum = |row: usize| judged.counts[row].iter().sum::<usize>();
    // Each label is in its class's row, once.
    let labels = judged.evaluation.totals.samples;
    assert_eq!((0..rows).map(sum).sum::<usize>(), labels);
    let (missed, wrong) = (judged.missed(), judged.false_detections());
    assert!(missed >= 1 && wrong >= 1, "{missed} {wrong}");
    assert_eq!(
        (0..rows)
            .map(|row| judged.counts[row][columns])
            .sum::<usize>(),
        missed
    );
    assert_eq!(sum(rows), wrong, "the last row is the false detections");
    assert_eq!(
        judged.mistakes().len(),
        labels - judged.recognised() + wrong
    );
    // The corner is nothing that could be counted.
    assert!(!person.offers("no label recognised as nothing: 0"));
    let name = format!("no label recognised as wave: {}", judged.counts[rows][2]);
    let alarms = judged.of_cell(rows, 2).len();
    person.click(&name);
    person.settle();
    assert!(person.sees("IN THIS CELL"));
    let lines = person
        .window
        .query_all_by_label_contains("wave without a label");
    assert_eq!(lines.count(), alarms);
    person.click("All mistakes");
    assert!(person.sees("MISTAKES"));
    // The database has it, and shows it again.
    let judged = person.state().train.judged.as_ref().unwrap();
    let (moments, counts) = (judged.moments.clone(), judged.counts.clone());
    let unlearned = judged.unlearned.clone();
    let reports = &person.state().store.as_ref().unwrap().snapshot.reports;
    assert_eq!(reports[0].kind, morec_db::ReportKind::Crossval);
    let id = reports[0].id;
    person.window.state_mut().state.train.judged = None;
    person.command(Command::Train(TrainCommand::OpenReport(id)));
    let again = person.state().train.judged.as_ref().unwrap();
    assert_eq!((&again.moments, &again.counts), (&moments, &counts));
    assert_eq!(again.unlearned, unlearned);
}

#[test]
fn a_line_jumps_to_its_moment_and_offers_the_comparison_with_the_nearest_label() {
    let (_folder, mut person) = judged();
    let judged = person.state().train.judged.as_ref().unwrap();
    let missed = judged
        .moments
        .iter()
        .find(|m| m.found.is_none() && m.span.start_secs < 0.2);
    let missed = missed.unwrap().clone();
    let why = missed.why.clone().unwrap();
    assert!(why.len() > 10, "{why}");
    person.click(&format!("wave missed, ada_1 0.10 s: {why}"));
    person.settle();
    let player = &person.state().player;
    assert_eq!(player.motion.as_ref().unwrap().clip.name, "ada_1");
    assert!(player.playing && player.looped.unwrap().1 >= 0.9);
    person.click("Compare with the nearest wave");
    let line = "moves.mdb ada_1 --start 0.100 --stop 0.900";
    assert!(shows_search(&person, line));
    person.settle();
    let aligned = person.state().companions.all[0].clone();
    assert_eq!(
        (aligned.of.span.start_secs, aligned.of.span.stop_secs),
        (0.1, 0.9)
    );
    // What stands beside it is a label of the class, and another one.
    let store = person.state().store.as_ref().unwrap();
    let label = store.snapshot.accepted().find(|s| {
        s.clip == aligned.with.clip && (s.start_secs - aligned.with.span.start_secs).abs() < 1e-6
    });
    assert_eq!(label.unwrap().class, "wave");
    assert_ne!(aligned.of, aligned.with);
    // Labels of the part that was left out did not teach what missed it.
    let judged = person.state().train.judged.as_ref().unwrap();
    let unlearned = &judged.unlearned["ada_1"];
    assert!(unlearned.holds("ada_1", aligned.of.span));
    assert!(!unlearned.holds(&aligned.motion.clip.name, aligned.with.span));
    assert!(person.sees_part("Seen: ada_1"), "both are seen");
    assert_eq!(person.state().panel, Panel::Train);
    // A false detection is compared with a label of what it was taken for.
    let judged = person.state().train.judged.as_ref().unwrap();
    let false_one = judged
        .moments
        .iter()
        .find(|m| m.truth.is_none())
        .unwrap()
        .clone();
    let class = false_one.found.clone().unwrap();
    person.click(&format!(
        "{class} without a label, {} {}",
        false_one.clip,
        crate::format::secs(false_one.span.start_secs)
    ));
    person.settle();
    let shown = person.state().player.motion.as_ref().unwrap();
    assert_eq!(shown.clip.name, false_one.clip);
    // By the key, too.
    person.key(Key::C);
    let (start, stop) = (false_one.span.start_secs, false_one.span.stop_secs);
    let line = format!("{} --start {start:.3} --stop {stop:.3}", false_one.clip);
    assert!(shows_search(&person, &line));
    person.settle();
    let aligned = person.state().companions.all[0].clone();
    assert!((aligned.of.span.start_secs - false_one.span.start_secs).abs() < 1e-9);
    assert_ne!(aligned.with.clip, aligned.of.clip);
    let store = person.state().store.as_ref().unwrap();
    let mut labels = store.snapshot.accepted();
    assert!(labels.any(|s| s.class == class
        && s.clip == aligned.with.clip
        && (s.start_secs - aligned.with.span.start_secs).abs() < 1e-6));
}

#[test]
fn a_class_without_another_label_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let clip = person.state().player.motion.as_ref().unwrap().id;
    let of = crate::stretch::Stretch::new(clip, 1.0..2.0);
    let class = "jump".to_owned();
    person.command(Command::Compare(crate::state::CompareCommand::NearestOf {
        of,
        class,
    }));
    assert!(person.sees_part("No other label of jump to compare with"));
}

#[test]
fn a_class_of_one_person_is_named_as_not_tested_and_counts_for_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    let labels = person.labels().len();
    let clip = person.state().player.motion.as_ref().unwrap().id;
    let hop = |start_secs: f64| {
        NewSample::accepted(clip, "hop", TimeSpan::new(start_secs, start_secs + 0.4))
    };
    person.command(Command::Edit(Edit::Label(vec![hop(0.1), hop(0.5)])));
    person.goes_to(Panel::Train);
    person.click("Cross-validate");
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    assert_eq!(judged.untested, ["hop"]);
    assert_eq!(judged.evaluation.totals.samples, labels);
    assert!(!judged.rows.contains(&"hop".to_owned()));
    let of_hop = |m: &crate::jobs::judge::Moment| m.truth.as_deref() == Some("hop");
    assert!(!judged.moments.iter().any(of_hop));
    assert!(person.sees_part("Not tested: hop. All its labels are of one person"));
    assert!(person.sees("hop: labels of one person only, add labels of another person"));
}

#[test]
fn the_reason_of_a_miss_is_read_whole() {
    let (_folder, mut person) = judged();
    let judged = person.state().train.judged.as_ref().unwrap();
    let places = judged.mistakes();
    let moment = places.iter().find_map(|&at| {
        let moment = &judged.moments[at];
        moment.why.is_some().then(|| moment.clone())
    });
    let moment = moment.unwrap();
    let why = moment.why.clone().unwrap();
    assert!(!person.sees(&why));
    let line = format!(
        "{}, {} {}: {why}",
        moment.said(),
        moment.clip,
        crate::format::secs(moment.span.start_secs)
    );
    person.click(&line);
    person.settle();
    let text = person.place(&why);
    assert!(text.height() > 20.0, "it is wrapped: {text:?}");
}

#[test]
fn the_list_of_mistakes_is_gone_through_by_keys() {
    let (_folder, mut person) = judged();
    let listed = person.state().listed_moments();
    assert!(listed.len() > 1);
    person.key(Key::ArrowDown);
    assert_eq!(person.state().train.moment, Some(listed[0]));
    person.key(Key::ArrowDown);
    assert_eq!(person.state().train.moment, Some(listed[1]));
    person.key(Key::ArrowUp);
    assert_eq!(person.state().train.moment, Some(listed[0]));
}
