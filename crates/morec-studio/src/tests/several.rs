//! What is done to many labels at once: classes merged, classes that are background, hits of a search, lists gone through by keys.

use egui::{Key, Modifiers};
use morec_db::labels::SampleState as Judged;

use super::{Person, before, labelling, made};
use crate::state::{Command, LiveCommand, Panel, SimilarCommand, TimelineCommand};

fn of_class(person: &Person, class: &str) -> usize {
    let labels = person.labels();
    labels.iter().filter(|label| label.1 == class).count()
}

#[test]
fn a_class_is_merged_into_another_and_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let (waves, claps) = (of_class(&person, "wave"), of_class(&person, "clap"));
    assert!(waves > 0 && claps > 0);
    person.goes_to(Panel::Label);
    person.right_click("Class wave");
    person.click("Merge into … ⏵");
    person.frames(3);
    person.click("clap");
    person.settle();
    assert_eq!(of_class(&person, "clap"), waves + claps);
    assert_eq!(of_class(&person, "wave"), 0);
    let line = person.state().command_line.clone();
    assert!(line.ends_with("--merge wave --into clap"), "{line}");
    person.undo();
    assert_eq!(of_class(&person, "wave"), waves);
}

#[test]
fn a_class_that_is_background_loses_its_labels_and_marks_clips_of_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let clips = |person: &Person| {
        let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
        let marked = snapshot.clips.iter().filter(|c| c.is_background());
        marked.map(|c| c.name.clone()).collect::<Vec<_>>()
    };
    // Of ben's clip the whole is of no interest, and a part of ada's.
    person.click("ben_1");
    person.settle();
    person.key(Key::Num4);
    person.settle();
    assert_eq!(of_class(&person, "gesture 1"), 1);
    person.goes_to(Panel::Label);
    person.click("Show ada_1");
    person.settle();
    let range = Some((0.1, 0.8));
    person.command(Command::Timeline(TimelineCommand::Range(range)));
    let class = "gesture 1".to_owned();
    person.command(Command::Timeline(TimelineCommand::LabelRange(class)));
    let others = person.labels().len() - of_class(&person, "gesture 1");
    person.right_click("Class gesture 1");
    person.click("Mark as background");
    person.settle();
    assert_eq!(clips(&person), ["ben_1"], "ada's has other labels");
    assert_eq!(person.labels().len(), others);
    person.undo();
    assert!(clips(&person).is_empty());
    assert_eq!(of_class(&person, "gesture 1"), 2);
}

#[test]
fn all_hits_of_a_likeness_become_labels_by_four_clicks_and_keys() {
    let (_folder, mut person) = labelling(1);
    let begun = person.actions;
    let labelled = person.state().shown_samples().iter();
    let label = labelled.clone().find(|s| s.state == Judged::Accepted);
    let label = label.unwrap();
    let (class, start, stop) = (&label.class, label.start_secs, label.stop_secs);
    let name = format!("{class} {start:.2}–{stop:.2} s");
    // Soon after another click it would be a double click.
    person.wait(1.0);
    person.click(&name);
    person.key(Key::F);
    person.settle();
    let labels = person.labels().len();
    let similar = person.state().classes.similar.as_ref().unwrap();
    let class = similar.class.clone().unwrap();
    let all = similar.hits.len();
    let scores: Vec<f32> = similar.hits.iter().map(|hit| hit.score).collect();
    // Below the third nearest.
    let percent = (100.0 * scores[2]).floor() as u8;
    let slider = person.place("Similarity of hits");
    let share = (f32::from(percent) - 1.0) / 99.0;
    person.click_at(egui::pos2(
        slider.left() + share * slider.width(),
        slider.center().y,
    ));
    let meant = person.state().alike_at_once().len();
    assert!((3..=all).contains(&meant));
    person.click(&format!("All {meant} above are {class}"));
    person.settle();
    assert_eq!(person.labels().len(), labels + meant);
    assert_eq!(person.actions - begun, 4);
    let left = person.state().classes.similar.as_ref().unwrap();
    assert_eq!(left.hits.len(), all - meant);
    // What is labelled now is not found again: a second label would be double.
    person.command(Command::Similar(SimilarCommand::Mirror(false)));
    person.settle();
    let again = person.state().classes.similar.as_ref().unwrap();
    assert_eq!(again.hits.len(), all - meant);
    let found = again.hits.iter().map(|hit| (hit.clip, hit.span));
    for (clip, span) in found {
        let snapshot = &person.state().store.as_ref().unwrap().snapshot;
        let of_class = snapshot
            .samples_of(clip)
            .iter()
            .filter(|s| s.class == class);
        let doubled = of_class.filter(|s| s.span().matches(span)).count();
        assert_eq!(doubled, 0, "{span:?}");
    }
    person.undo();
    assert_eq!(person.labels().len(), labels);
}

#[test]
fn among_hits_keys_leave_the_label_alone_whose_like_was_searched() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    person.goes_to(Panel::Label);
    let labelled = person.state().shown_samples().iter();
    let mut accepted = labelled.filter(|s| s.state == Judged::Accepted);
    let label = accepted.next().unwrap().clone();
    let name = format!(
        "{} {:.2}–{:.2} s",
        label.class, label.start_secs, label.stop_secs
    );
    // Soon after another click it would be a double click.
    person.wait(1.0);
    person.click(&name);
    person.key(Key::F);
    person.settle();
    assert!(person.state().classes.similar.is_some());
    let labels = person.labels();
    for key in [Key::Num1, Key::Num2, Key::Delete] {
        person.key(key);
        person.settle();
    }
    assert_eq!(person.labels(), labels);
    // A hit that was gone to is what keys act on.
    person.key(Key::ArrowDown);
    person.settle();
    person.key(Key::Num1);
    person.settle();
    assert_eq!(person.labels().len(), labels.len() + 1);
}

#[test]
fn several_samples_are_chosen_with_ctrl_and_moved_by_one_key() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    person.goes_to(Panel::Classes);
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let waves = snapshot.samples.iter().filter(|s| s.class == "wave");
    let cards = waves.map(|s| format!("wave in {} at {:.2} s", s.clip_name, s.start_secs));
    let cards: Vec<String> = cards.collect();
    let people = snapshot.samples.iter().filter(|s| s.class == "wave");
    assert!(
        people
            .map(|s| s.clip)
            .collect::<std::collections::BTreeSet<_>>()
            .len()
            > 1
    );
    let other = (1..=9).find(|n| person.state().classes.at(n - 1) == Some("clap"));
    person.click(&cards[0]);
    for card in &cards[1..] {
        person.ctrl_click(card);
    }
    person.settle();
    assert_eq!(person.state().selected().len(), cards.len());
    let claps = of_class(&person, "clap");
    person.key(crate::keys::CLASS_KEYS[other.unwrap() - 1]);
    person.settle();
    assert_eq!(of_class(&person, "clap"), claps + cards.len());
    assert_eq!(of_class(&person, "wave"), 0);
    person.undo();
    assert_eq!(of_class(&person, "wave"), cards.len());
}

#[test]
fn the_search_is_where_the_list_of_labelling_is() {
    let (_folder, mut person) = labelling(1);
    person.key_with(Key::F, Modifiers::COMMAND);
    person.frames(3);
    person.window.event(egui::Event::Text("ben".to_owned()));
    person.frames(3);
    assert_eq!(person.state().panel, Panel::Label);
    assert!(person.offers("Show ben_1") && !person.offers("Show ada_1"));
}

#[test]
fn a_class_that_a_key_made_asks_for_its_name_live() {
    let (_folder, mut person) = before(Panel::Live, 0);
    person.click("Start");
    person.settle();
    while person.state().live.now_secs() < 3.0 {
        person.frames(1);
    }
    person.command(Command::Live(LiveCommand::Range(Some((1.0, 2.0)))));
    assert!(!person.sees_part("gesture 1 has no name yet"));
    person.key(Key::Num1);
    person.settle();
    assert!(person.sees("gesture 1 has no name yet"));
    person.click("Name gesture 1 …");
    assert!(person.sees("What is gesture 1 called?"));
    person.window.event(egui::Event::Text("nod".to_owned()));
    person.frames(2);
    person.key(Key::Enter);
    person.settle();
    assert_eq!(of_class(&person, "nod"), 1);
    assert!(!person.sees_part("What is gesture") && !person.sees_part("no name yet"));
}

#[test]
fn a_class_that_a_key_made_asks_for_its_name_beside_the_table_and_in_the_list() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    for (panel, name) in [(Panel::Library, "nod"), (Panel::Label, "bow")] {
        person.goes_to(Panel::Library);
        person.click("ben_1");
        person.settle();
        let key = if name == "nod" { Key::Num1 } else { Key::Num2 };
        person.key(key);
        person.settle();
        person.goes_to(panel);
        let class = person.state().classes.order.last().unwrap().clone();
        person.click(&format!("Name {class} …"));
        person.window.event(egui::Event::Text(name.to_owned()));
        person.frames(2);
        person.key(Key::Enter);
        person.settle();
        assert!(
            person.state().classes.order.iter().any(|c| c == name),
            "{panel:?}"
        );
        assert!(!person.sees_part("has no name yet"));
    }
}
