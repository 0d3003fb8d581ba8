//! Every list by keys: Up and Down, Page Up and Page Down, Home and End, Enter.

use egui::Key;
use egui_kittest::kittest::{NodeT, Queryable};
use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth, StreamInfo};
use morec_db::MotionDb;
use morec_ops::{GroupMethod, KeptCrossval, LeftOut};

use super::{Person, made, takes};
use crate::jobs::judge::CrossvalResult;
use crate::state::shelf::ShelfCommand;
use crate::state::{ClassCommand, Command, LibraryCommand, Panel};

fn before(labelled: usize) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), labelled)]);
    (folder, person)
}

/// Names of what can be clicked whose names begin so, by lines and in lines.
fn named(person: &Person, part: &str) -> Vec<String> {
    let nodes = person.window.query_all_by_label_contains(part);
    let clicked = nodes.filter(|node| {
        let node = node.accesskit_node();
        let begins = node.label().is_some_and(|name| name.starts_with(part));
        begins && node.role() != egui::accesskit::Role::Label
    });
    let mut found: Vec<(i64, i64, String)> = clicked
        .map(|node| {
            let at = node.rect().min;
            let name = node.accesskit_node().label().unwrap();
            (at.y as i64, at.x as i64, name)
        })
        .collect();
    found.sort();
    found.into_iter().map(|(.., name)| name).collect()
}

/// Gives the keyboard to the widget of this name.
pub fn focus(person: &mut Person, name: &str) {
    let is_text = |node: &egui_kittest::Node<'_>| {
        node.accesskit_node().role() == egui::accesskit::Role::Label
    };
    let nodes = person.window.query_all_by_label(name);
    let node = nodes.min_by_key(is_text);
    node.unwrap_or_else(|| panic!("nothing is called {name}"))
        .focus();
    person.frames(2);
}

/// Name of the widget that has the keyboard.
pub fn focused(person: &Person) -> String {
    person.focused().unwrap_or_default()
}

/// Goes through a list of these rows by keys.
fn is_walked(person: &mut Person, rows: &[String]) {
    assert!(rows.len() > 1, "{rows:?}");
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    focus(person, first);
    for (key, row) in [
        (Key::ArrowDown, &rows[1]),
        (Key::End, last),
        (Key::ArrowDown, last),
        (Key::ArrowUp, &rows[rows.len() - 2]),
        (Key::Home, first),
        (Key::ArrowUp, first),
        (Key::PageDown, &rows[10.min(rows.len() - 1)]),
        (Key::PageUp, first),
    ] {
        person.key(key);
        person.settle();
        assert_eq!(focused(person), *row, "{key:?} in {rows:?}");
    }
}

fn shown(person: &Person) -> &str {
    &person.state().player.motion.as_ref().unwrap().clip.name
}

fn strings<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

#[test]
fn clips_are_gone_through_and_shown() {
    let (_folder, mut person) = before(1);
    let clips = strings(["ada_1", "ben_1", "cleo_1"]);
    // Without the keyboard in the list, too.
    for (key, clip) in [
        (Key::End, "cleo_1"),
        (Key::Home, "ada_1"),
        (Key::ArrowDown, "ben_1"),
    ] {
        person.key(key);
        person.settle();
        assert_eq!(shown(&person), clip);
    }
    is_walked(&mut person, &clips);
    assert_eq!(shown(&person), "ada_1");
    // Keys act on the row that has the keyboard, which is selected, and on no other.
    person.key(Key::B);
    person.settle();
    assert!(person.offers("ada_1, background"));
    person.undo();
    person.command(Command::Library(LibraryCommand::Strips(true)));
    is_walked(&mut person, &clips);
    person.goes_to(Panel::Label);
    is_walked(
        &mut person,
        &clips
            .iter()
            .map(|c| format!("Show {c}"))
            .collect::<Vec<_>>(),
    );
    is_walked(
        &mut person,
        &strings(["Class bow", "Class clap", "Class wave"]),
    );
}

#[test]
fn a_row_that_only_has_the_keyboard_is_labelled_by_no_key() {
    let (_folder, mut person) = before(0);
    person.click("ada_1");
    person.settle();
    let written = person.written();
    focus(&mut person, "cleo_1");
    person.presses(Key::B);
    person.presses(Key::Num1);
    person.settle();
    assert_eq!(
        person.written(),
        written,
        "cleo_1 has the keyboard, ada_1 is selected"
    );
}

#[test]
fn samples_and_groups_are_gone_through_and_shown() {
    let (_folder, mut person) = before(2);
    person.goes_to(Panel::Classes);
    let cards = named(&person, "bow in ");
    is_walked(&mut person, &cards);
    person.key(Key::End);
    person.settle();
    assert_eq!(shown(&person), "ben_1");
    assert_eq!(
        person.state().timeline.selected.len(),
        1,
        "selected by the key"
    );
    // Nothing has the keyboard: Down enters where the selection is.
    person.key(Key::Escape);
    person.command(Command::Library(LibraryCommand::Filter(String::new())));
    let labels = person.labels().len();
    focus(&mut person, cards.last().unwrap());
    person.key(Key::ArrowUp);
    person.settle();
    person.key(Key::Delete);
    person.settle();
    assert_eq!(person.labels().len(), labels - 1, "the selected row");
    person.undo();
    let group = ClassCommand::Group {
        cuts: false,
        method: GroupMethod::Hierarchy,
    };
    person.command(Command::Classes(group));
    person.frames(2);
    let all = named(&person, "Stretch ");
    let mut seen = std::collections::BTreeSet::new();
    let of_group = |name: &&String| seen.insert(name.split(" of ").nth(1).unwrap().to_owned());
    let firsts: Vec<String> = all.iter().filter(of_group).cloned().collect();
    is_walked(&mut person, &firsts);
}

#[test]
fn down_enters_the_list_of_the_panel() {
    let (_folder, mut person) = before(1);
    person.goes_to(Panel::Classes);
    person.key(Key::ArrowDown);
    person.settle();
    assert_eq!(focused(&person), named(&person, "bow in ")[0]);
}

#[test]
fn hits_are_gone_through_line_by_line_and_shown() {
    let (_folder, mut person) = before(2);
    person.goes_to(Panel::Classes);
    let card = named(&person, "wave in ")[0].clone();
    person.click(&card);
    person.settle();
    person.key(Key::F);
    person.settle();
    let hits = named(&person, "Like it: ");
    let lines: std::collections::BTreeSet<i64> = hits
        .iter()
        .map(|hit| person.place(hit).top() as i64)
        .collect();
    let columns = hits.len().div_ceil(lines.len());
    assert!(columns > 1 && hits.len() > columns, "{hits:?}");
    person.key(Key::Escape);
    person.key(Key::ArrowDown);
    person.settle();
    for (key, hit) in [
        (Key::Home, 0),
        (Key::ArrowRight, 1),
        (Key::ArrowDown, 1 + columns),
        (Key::ArrowLeft, columns),
        (Key::ArrowUp, 0),
    ] {
        person.key(key);
        person.settle();
        assert_eq!(focused(&person), hits[hit], "{key:?}");
    }
    let found = person.state().classes.similar.as_ref().unwrap().hits[0].clone();
    assert!(person.state().is_selected_stretch((&found).into()));
}

#[test]
fn sets_are_gone_through() {
    let (_folder, mut person) = before(0);
    person.goes_to(Panel::Classes);
    person.command(Command::Shelf(ShelfCommand::Discover));
    person.frames(2);
    let mut first = named(&person, "Instance 1 of set ");
    first.truncate(2);
    assert_eq!(first.len(), 2);
    focus(&mut person, &first[0]);
    person.key(Key::ArrowDown);
    person.settle();
    assert_eq!(focused(&person), first[1]);
    person.key(Key::Home);
    person.settle();
    assert_eq!(focused(&person), first[0]);
}

/// A cross-validation with a label that was missed, one that was taken for another class, and a false detection.
pub fn crossval() -> KeptCrossval {
    let clip = takes()[0].clip.name.clone();
    let truth = |class: &str, start: f64| GroundTruth {
        clip: clip.clone(),
        class: class.to_owned(),
        span: TimeSpan::new(start, start + 1.0),
    };
    let found = |class: &str, start: f64| ClipDetection {
        clip: clip.clone(),
        class: class.to_owned(),
        span: TimeSpan::new(start, start + 1.0),
        score: None,
        reported_secs: None,
        repetitions: None,
    };
    KeptCrossval {
        by: LeftOut::Clip,
        thesis: false,
        untested: Vec::new(),
        streams: vec![StreamInfo {
            clip: clip.clone(),
            duration_secs: 20.0,
            unknown: false,
        }],
        truths: vec![truth("wave", 1.0), truth("bow", 4.0), truth("clap", 7.0)],
        founds: vec![found("wave", 1.0), found("wave", 4.0), found("bow", 10.0)],
        missed: Vec::new(),
        folds: Vec::new(),
    }
}

/// Keeps reports in the database of a test.
pub fn keep_reports(path: &std::path::Path) {
    let mut db = MotionDb::open(path).unwrap();
    let kept = crossval();
    let evaluation = CrossvalResult::of(kept.clone()).unwrap().evaluation;
    for _ in 0..3 {
        kept.keep(&mut db, &evaluation).unwrap();
    }
}

#[test]
fn mistakes_cells_reports_indexes_and_ticks_are_gone_through() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    keep_reports(&path);
    let mut db = MotionDb::open(&path).unwrap();
    for name in ["first", "second", "third"] {
        db.store_index(name, b"no index").unwrap();
    }
    drop(db);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.goes_to(Panel::Train);
    let reports = named(&person, "Report ");
    assert_eq!(reports.len(), 3);
    is_walked(&mut person, &reports);
    assert!(person.sees_part("Report of "), "the row is opened");
    is_walked(
        &mut person,
        &strings(["Use first", "Use second", "Use third"]),
    );
    is_walked(&mut person, &strings(["bow", "clap", "wave"]));
    let unlabelled: Vec<String> = named(&person, "Background ");
    is_walked(&mut person, &unlabelled);
    person.key(Key::Escape);
    let moments = [
        "bow mistaken for wave",
        "clap missed",
        "bow without a label",
    ];
    let moments: Vec<String> = moments.iter().flat_map(|m| named(&person, m)).collect();
    let mut moments: Vec<String> = moments
        .into_iter()
        .filter(|m| m.contains("ada_1"))
        .collect();
    moments.sort_by_key(|name| person.place(name).top() as i64);
    assert_eq!(moments.len(), 3);
    is_walked(&mut person, &moments);
    assert_eq!(
        person.state().train.moment.map(|_| shown(&person)),
        Some("ada_1")
    );
    let cells: Vec<String> = named(&person, "bow recognised as ");
    let cells: Vec<&String> = cells.iter().filter(|c| !c.contains("ada_1")).collect();
    focus(&mut person, cells[0]);
    person.key(Key::ArrowRight);
    assert_eq!(focused(&person), *cells[1]);
    person.key(Key::ArrowDown);
    assert!(focused(&person).starts_with("clap recognised as "));
    person.key(Key::Enter);
    person.settle();
    assert!(person.state().train.cell.is_some(), "Enter chooses");
}

#[test]
fn a_step_of_the_history_is_gone_to_and_undone_by_enter() {
    let (_folder, mut person) = before(1);
    for class in ["one", "two"] {
        person.click("ada_1");
        person.settle();
        let clip = person.state().library.selected[0];
        let whole = morec_db::labels::WholeClip {
            clip,
            class: Some(class.to_owned()),
            subject: None,
        };
        person.command(Command::Edit(crate::store::Edit::WholeClips(vec![whole])));
    }
    person.click("History");
    person.frames(2);
    let steps = named(&person, "Undo step ");
    is_walked(&mut person, &steps);
    let labels = person.labels();
    person.key(Key::Enter);
    person.settle();
    assert_ne!(person.labels(), labels);
}

#[test]
fn a_report_is_opened_again_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    keep_reports(&path);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.goes_to(Panel::Train);
    assert!(person.state().train.judged.is_none());
    let report = named(&person, "Report ")[0].clone();
    person.click(&report);
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    assert_eq!((judged.recognised(), judged.missed()), (1, 1));
    assert_eq!(judged.false_detections(), 1);
    let file = folder.path().join("report.json");
    person.will_choose(&[&file]);
    person.click("Export the report …");
    person.settle();
    let text = std::fs::read_to_string(&file).unwrap();
    let written: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["about"]["kind"], "crossval");
    assert_eq!(written["report"]["evaluation"]["totals"]["samples"], 3);
    person.click("Close the report");
    person.settle();
    assert!(person.state().train.judged.is_none());
}
