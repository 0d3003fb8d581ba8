//! Classes are named, renamed, removed; samples are dragged between them; groups follow a slider.

use egui::Key;
use morec::TimeSpan;
use morec::cluster::KwasParams;
use morec::features::Rows;
use morec_db::MotionDb;
use morec_db::labels::{NewSample, SampleState as Judged};
use morec_ops::{GroupMethod, GroupSettings, Shapes, largest_first};

use super::{Person, labelling, made};
use crate::jobs::group::{self, ClusteredItems, GroupDepth};
use crate::state::{ClassCommand, Command, Panel, PlayCommand};

#[test]
fn a_class_is_added_renamed_removed_and_what_is_in_the_database_is_undone() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    person.types("New class", "jump");
    assert!(person.sees("Class jump"));
    person.wait(0.5);
    person.right_click("Class jump");
    person.click("Remove the class and its labels");
    person.settle();
    assert!(!person.sees("Class jump"), "it had no label");
    person.wait(0.5);
    person.right_click("Class wave");
    person.click("Rename");
    person.frames(2);
    // What is typed replaces the name.
    person.inserts("greeting");
    person.key(Key::Enter);
    person.settle();
    assert!(person.sees("Class greeting") && !person.sees("Class wave"));
    assert!(person.labels().iter().any(|l| l.1 == "greeting"));
    person.undo();
    assert_eq!(person.labels(), before);
    person.wait(0.5);
    person.right_click("Class wave");
    person.click("Remove the class and its labels");
    person.settle();
    assert!(!person.labels().iter().any(|l| l.1 == "wave"));
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn a_selected_label_gets_another_class_by_its_key() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let wave = before.iter().find(|l| l.1 == "wave").unwrap().clone();
    let (start, stop) = (wave.2 as f64 / 100.0, wave.3 as f64 / 100.0);
    let shown = person.state().shown_samples().iter();
    let sample = shown
        .clone()
        .find(|s| s.class == "wave" && (s.start_secs - start).abs() < 0.02)
        .unwrap();
    let name = format!("wave {:.2}–{:.2} s", sample.start_secs, sample.stop_secs);
    assert!((sample.stop_secs - stop).abs() < 0.02);
    // Soon after another click it would be a double click.
    person.wait(1.0);
    person.click(&name);
    person.key(egui::Key::Num1);
    person.settle();
    assert_eq!(person.state().classes.order[0], "bow");
    assert!(!person.labels().contains(&wave));
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn groups_follow_the_slider_and_become_classes() {
    let (_folder, mut person) = labelling(2);
    person.goes_to(Panel::Classes);
    person.click("Group labels");
    person.settle();
    let groups = person.state().classes.groups.clone().unwrap();
    assert_eq!(groups.items.len(), 12);
    let depth = person.state().classes.depth.groups;
    assert!(person.sees(&format!("Group {depth}")));
    assert!(!person.sees(&format!("Group {}", depth + 1)));
    let slider = person.place("Number of groups");
    let at = |share: f32| {
        let x = slider.left() + share * slider.width();
        egui::pos2(x, slider.center().y)
    };
    person.drag(at(0.2), at(0.98));
    let many = person.state().classes.depth.groups;
    assert!(many > 8 && person.sees("Group 5"), "{many}");
    person.drag(at(0.5), at(0.0));
    assert_eq!(person.state().classes.depth.groups, 1);
    assert!(person.sees("Group 1") && !person.sees("Group 2"));
    person.click("Divide group 1");
    assert!(person.sees("Group 2") && !person.sees("Group 3"));
    person.click("Join group 2");
    assert!(person.sees("Group 1") && !person.sees("Group 2"));
    let before = person.labels();
    person.click("Name of group 1");
    person.window.event(egui::Event::Text("all".to_owned()));
    person.frames(3);
    person.click("Make it a class");
    person.settle();
    assert!(person.labels().iter().all(|l| l.1 == "all"));
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn kwas_and_the_tree_of_samples_group_as_the_command_does() {
    let (_folder, mut person) = labelling(2);
    person.goes_to(Panel::Classes);
    person.click("Group labels");
    person.settle();
    let path = person.state().store.as_ref().unwrap().path().to_owned();
    let sizes = |person: &Person| -> Vec<usize> {
        let classes = &person.state().classes;
        let groups = classes.groups.as_ref().unwrap().at(&classes.depth);
        groups.iter().map(|group| group.members.len()).collect()
    };
    let of_command = |settings: &GroupSettings| -> Vec<usize> {
        let db = MotionDb::open(&path).unwrap();
        let stretches = settings.stretches(&db, &()).unwrap();
        let clusters = settings.clusters(stretches.iter().map(|of| &of.rows));
        let groups = largest_first(&clusters.unwrap());
        groups.iter().map(Vec::len).collect()
    };
    person.click("kWAS");
    person.settle();
    let settings = group::settings(false, GroupMethod::Kwas);
    assert_eq!(sizes(&person), of_command(&settings));
    assert!(person.sees_part("Rand index"));
    let kwas = KwasParams {
        tau: 0.5,
        k: 2,
        ..KwasParams::default()
    };
    let command = Command::Classes(ClassCommand::Kwas(kwas));
    person.window.state_mut().state.apply(command);
    person.frames(3);
    let settings = GroupSettings {
        tau: 0.5,
        k: 2,
        ..settings
    };
    assert_eq!(sizes(&person), of_command(&settings));
    person.click("Tree of samples");
    person.settle();
    let groups = person.state().classes.depth.groups;
    let settings = GroupSettings {
        groups: Some(groups),
        ..group::settings(false, GroupMethod::Tree)
    };
    assert_eq!(sizes(&person), of_command(&settings));
}

#[test]
fn a_label_that_holds_no_tick_is_left_out_of_groups() {
    let (_folder, mut person) = labelling(2);
    let path = person.state().store.as_ref().unwrap().path().to_owned();
    let mut db = MotionDb::open(&path).unwrap();
    let shortest = NewSample::accepted(
        db.clips(&Default::default()).unwrap()[0].id,
        "wave",
        TimeSpan::new(0.001, 0.012),
    );
    db.add_samples(&[shortest], "test").unwrap();
    person.goes_to(Panel::Classes);
    person.click("Group labels");
    person.settle();
    let groups = person.state().classes.groups.clone().unwrap();
    let depth = GroupDepth {
        groups: 3,
        ..GroupDepth::default()
    };
    let members = groups.at(&depth).into_iter().map(|g| g.members.len());
    assert_eq!(members.sum::<usize>(), 12);
}

#[test]
fn cuts_are_grouped_and_a_group_becomes_labels() {
    let (_folder, mut person) = labelling(0);
    person.groups_cuts();
    let groups = person.state().classes.groups.clone().unwrap();
    assert!(groups.items.iter().all(|item| item.sample.is_none()));
    let depth = person.state().classes.depth.clone();
    let members = groups.at(&depth)[0].members.len();
    person.click("Name of group 1");
    person
        .window
        .event(egui::Event::Text("something".to_owned()));
    person.frames(3);
    person.click("Make it a class");
    person.settle();
    assert_eq!(person.labels().len(), members);
    person.undo();
    assert!(person.labels().is_empty());
}

#[test]
fn a_group_is_shown_from_its_outliers_to_what_is_usual() {
    let (_folder, mut person) = labelling(2);
    person.goes_to(Panel::Classes);
    person.click("Group labels");
    person.settle();
    let items = person.state().classes.groups.clone().unwrap().items;
    // Every shape is near 0, but that of the sixth stretch and, the other way, that of the third.
    let place = |at: usize| match at {
        5 => 9.0,
        2 => -6.0,
        _ => 0.01 * at as f32,
    };
    let rows = (0..items.len()).map(|at| Rows::from_values(1, vec![place(at); 16]));
    let shapes = Shapes::of(rows.collect::<Vec<_>>().iter());
    let classes = &mut person.window.state_mut().state.classes;
    classes.groups = Some(ClusteredItems::of(items.clone(), shapes, 0));
    classes.grouping += 1;
    classes.depth.groups = 1;
    person.frames(3);
    let left = |person: &Person, at: usize| {
        let name = format!("Stretch {at} of group 1");
        person.place(&name).left()
    };
    let mut shown: Vec<usize> = (0..items.len()).collect();
    shown.sort_by(|a, b| left(&person, *a).total_cmp(&left(&person, *b)));
    assert_eq!(shown[..2], [5, 2]);
    // The first that is seen is the one that a click plays.
    person.click("Stretch 5 of group 1");
    person.settle();
    let looped = person.state().player.looped.unwrap();
    assert_eq!(
        looped,
        (items[5].of.span.start_secs, items[5].of.span.stop_secs)
    );
}

/// A user of a database with proposals of one second each, given by start and score.
fn proposed(proposals: &[(f64, f64)]) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let mut db = MotionDb::open(&path).unwrap();
    let clip = db.find_clip("ben_1").unwrap().id;
    let proposal = |&(start_secs, score): &(f64, f64)| NewSample {
        state: Judged::Proposed,
        score: Some(score),
        ..NewSample::accepted(clip, "wave", TimeSpan::new(start_secs, start_secs + 1.0))
    };
    let proposals: Vec<NewSample> = proposals.iter().map(proposal).collect();
    db.add_samples(&proposals, "test").unwrap();
    drop(db);
    (folder, Person::before(&[path]))
}

#[test]
fn the_most_doubtful_proposal_is_shown_first_and_the_next_after_each_answer() {
    // The most informative proposal is neither the first in time nor the likeliest.
    let (_folder, mut person) = proposed(&[(1.0, 0.97), (3.0, 0.12), (5.0, 0.55), (7.0, 0.75)]);
    person.goes_to(Panel::Label);
    let selected = |person: &Person| {
        let selected = person.state().selected();
        let score = selected.first().and_then(|s| s.score);
        score.map(|s| (s * 100.0).round() as i64)
    };
    person.key(Key::N);
    person.settle();
    assert_eq!(selected(&person), Some(55));
    assert!(person.sees("Proposed, score 0.55"));
    assert_eq!(person.state().player.looped, Some((5.0, 6.0)));
    for (answer, next) in [(Key::R, Some(75)), (Key::A, Some(12)), (Key::R, Some(97))] {
        person.key(answer);
        person.settle();
        assert_eq!(selected(&person), next, "after {answer:?}");
    }
    person.key(Key::A);
    person.settle();
    person.key(Key::N);
    assert!(person.sees_part("no proposal is left to check"));
}

/// Twelve classes without labels, the last of them `throw` and `turn`.
fn many_classes() -> (tempfile::TempDir, Person) {
    let (folder, mut person) = labelling(0);
    let names = (1..=10).map(|n| format!("other {n}"));
    for name in names.chain(["throw".to_owned(), "turn".to_owned()]) {
        person.command(Command::Classes(ClassCommand::Add(name)));
    }
    (folder, person)
}

/// Types the first letters of a class, after a key has opened the chooser, and presses Enter.
fn choose(person: &mut Person, letters: &str) {
    person.window.event(egui::Event::Text(letters.to_owned()));
    person.frames(2);
    person.key(Key::Enter);
    person.frames(2);
}

#[test]
fn a_class_beyond_the_ninth_is_labelled_by_the_key_it_is_given() {
    let (_folder, mut person) = many_classes();
    // Q asks for its class as long as it has none.
    person.key(Key::Q);
    assert!(person.sees("Class of the key Q"));
    assert!(person.sees("Choose other 1") && person.sees_part("and 3 more"));
    choose(&mut person, "TH");
    assert!(!person.sees("Class of the key Q"));
    assert_eq!(person.state().classes.quick.as_deref(), Some("throw"));
    // Held while playing.
    person.command(Command::Play(PlayCommand::Seek(2.0)));
    person.key(Key::Space);
    person.hold(Key::Q, 0.8);
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 1);
    assert_eq!(labels[0].1, "throw");
    assert!(labels[0].3 - labels[0].2 > 40, "{labels:?}");
    // Tapped, for the next class.
    person.key(Key::W);
    choose(&mut person, "tu");
    for _ in 0..3 {
        person.hold(Key::Q, 0.05);
        person.wait(0.7);
    }
    person.key(Key::K);
    person.settle();
    let turns = person.labels().iter().filter(|l| l.1 == "turn").count();
    assert_eq!(turns, 2, "from tap to tap");
    // Stopped, it says what the selected label is.
    let sample = person.state().shown_samples().iter();
    let thrown = sample.clone().find(|s| s.class == "throw").unwrap();
    let name = format!("throw {:.2}–{:.2} s", thrown.start_secs, thrown.stop_secs);
    person.wait(1.0);
    person.click(&name);
    person.key(Key::Q);
    person.settle();
    assert_eq!(person.labels().iter().filter(|l| l.1 == "turn").count(), 3);
    person.undo();
    assert_eq!(person.labels().iter().filter(|l| l.1 == "turn").count(), 2);
}

#[test]
fn a_class_has_its_number_and_the_key_q_and_the_chooser_is_left_by_escape() {
    let (_folder, mut person) = many_classes();
    person.wait(0.5);
    person.right_click("Class other 2");
    person.click("Give it the key Q");
    person.command(Command::Play(PlayCommand::Seek(2.0)));
    person.key(Key::Space);
    for key in [Key::Num2, Key::Q] {
        person.hold(key, 0.6);
        person.wait(0.3);
    }
    person.key(Key::K);
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 2, "{labels:?}");
    assert!(labels.iter().all(|l| l.1 == "other 2"));
    person.key(Key::W);
    person.window.event(egui::Event::Text("nobody".to_owned()));
    person.frames(2);
    assert!(person.sees("No class has this name."));
    person.key(Key::Enter);
    assert!(person.sees("Class of the key Q"), "nothing is chosen");
    person.key(Key::Escape);
    person.frames(2);
    assert!(!person.sees("Class of the key Q"));
    assert_eq!(person.state().classes.quick.as_deref(), Some("other 2"));
}

#[test]
fn columns_scroll_while_a_sample_is_dragged_near_their_left_or_right_edge() {
    let (_folder, mut person) = labelling(1);
    for number in 1..=12 {
        let class = ClassCommand::Add(format!("other {number}"));
        person.command(Command::Classes(class));
    }
    person.goes_to(Panel::Classes);
    let before = person.labels();
    let wave = person.state().shown_samples().iter();
    let wave = wave.clone().find(|s| s.class == "wave").unwrap().clone();
    let card = |class: &str| format!("{class} in ada_1 at {:.2} s", wave.start_secs);
    let from = person.place(&card("wave")).center();
    let right = person.place("Performer").left() - 20.0;
    let last = |person: &Person| person.place("Column other 12").center();
    assert!(last(&person).x > 1400.0);
    let edge = egui::pos2(right, from.y);
    person.drag_over(from, edge, 4.0, last);
    person.settle();
    assert!(last(&person).x < right, "it has come into sight");
    let moved = person.labels();
    assert_eq!(moved.iter().filter(|l| l.1 == "other 12").count(), 1);
    // And back, over the left edge.
    let from = person.place(&card("other 12")).center();
    let first = |person: &Person| person.place("Column wave").center();
    assert!(first(&person).x < 0.0);
    person.drag_over(from, egui::pos2(12.0, from.y), 4.0, first);
    person.settle();
    assert_eq!(person.labels(), before);
    // Without anything that is dragged, the edge is a place as any other.
    person.window.event(egui::Event::PointerMoved(edge));
    person.wait(1.0);
    assert!(first(&person).x > 0.0);
}

#[test]
fn a_column_scrolls_while_a_sample_is_dragged_near_its_lower_or_upper_edge() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let mut db = MotionDb::open(&path).unwrap();
    let clip = db.find_clip("ben_1").unwrap().id;
    let step = |at: usize| {
        NewSample::accepted(
            clip,
            "step",
            TimeSpan::new(0.5 * at as f64, 0.5 * at as f64 + 0.4),
        )
    };
    let steps: Vec<NewSample> = (0..40).map(step).collect();
    db.add_samples(&steps, "test").unwrap();
    drop(db);
    let mut person = Person::before(&[path]);
    person.goes_to(Panel::Classes);
    let (first, last) = ("step in ben_1 at 0.00 s", "step in ben_1 at 19.50 s");
    assert!(person.sees(first) && !person.sees(last));
    let from = person.place(first).center();
    let column = person.place("Column step");
    let lower = egui::pos2(from.x, column.bottom() - 14.0);
    // Dropped on another column, though its own place is out of sight by then.
    person.drag_over(from, lower, 5.0, |person| {
        assert!(person.sees(last) && !person.sees(first));
        person.place("Column wave").center()
    });
    person.settle();
    let waves = |person: &Person| {
        let labels = person.labels();
        let waves = labels.iter().filter(|l| l.1 == "wave" && l.0 == clip.0);
        waves.count()
    };
    assert_eq!(waves(&person), 1);
    let from = person.place(last).center();
    let upper = egui::pos2(from.x, column.top() + 50.0);
    person.drag_over(from, upper, 5.0, |person| {
        assert!(person.sees("step in ben_1 at 0.50 s") && !person.sees(last));
        person.place("Column wave").center()
    });
    person.settle();
    assert_eq!(waves(&person), 2);
}

#[test]
fn proposals_are_answered_at_once_by_a_threshold_and_those_at_0_are_not_shown() {
    let (_folder, mut person) = proposed(&[
        (1.0, 0.97),
        (3.0, 0.12),
        (5.0, 0.004),
        (7.0, 0.85),
        (9.0, 0.5),
    ]);
    person.goes_to(Panel::Classes);
    let before = person.labels().len();
    assert_eq!(person.state().doubtful().len(), 4, "0 % is not shown");
    person.click("Accept 2 above");
    person.settle();
    assert_eq!(person.labels().len(), before + 2);
    person.undo();
    assert_eq!(person.labels().len(), before, "one step");
    let least = Command::Classes(ClassCommand::Likely(50));
    person.command(least);
    person.click("Reject 1 below");
    person.settle();
    assert_eq!(person.state().doubtful().len(), 3);
    person.click("Accept 3 above");
    person.settle();
    assert!(person.state().doubtful().is_empty());
    assert_eq!(person.labels().len(), before + 3);
    assert!(!person.sees("Threshold of proposals"));
}
