//! What repeats is found without a label, put right on the shelf, and named.

use egui::pos2;
use morec_db::labels::SampleState as Judged;

use super::{Person, before};
use crate::state::shelf::ShelfCommand;
use crate::state::{Command, Panel};
use crate::stretch::Stretch;

/// The shelf of a database without a label.
fn shelved() -> (tempfile::TempDir, Person) {
    let (folder, mut person) = before(Panel::Classes, 0);
    person.click("Find what repeats");
    person.settle();
    assert!(person.sees("What repeats") && person.sees("Set 1"));
    (folder, person)
}

fn instances(person: &Person, set: usize) -> Vec<Stretch> {
    person.state().set_instances(set)
}

fn shelf(person: &mut Person, command: ShelfCommand) {
    person.command(Command::Shelf(command));
    person.frames(2);
}

#[test]
fn a_set_becomes_proposals_by_a_name_and_is_undone() {
    let (_folder, mut person) = shelved();
    let line = &person.state().command_line;
    assert!(line.starts_with("morec discover "), "{line}");
    let count = instances(&person, 0).len();
    assert!(count >= 2);
    person.click("Name of set 1");
    person.window.event(egui::Event::Text("wave".to_owned()));
    person.frames(3);
    person.click("Propose set 1");
    person.settle();
    let samples = &person.state().store.as_ref().unwrap().snapshot.samples;
    assert_eq!(samples.len(), count);
    let is_proposed = |s: &morec_db::labels::DbSample| {
        s.class == "wave" && s.state == Judged::Proposed && s.score == Some(0.85)
    };
    assert!(samples.iter().all(|s| is_proposed(s)));
    assert!(person.sees("proposed as wave") && !person.sees("Propose set 1"));
    person.click("Back to classes");
    person.frames(2);
    assert!(person.offers(&format!("Accept {count} above")));
    person.undo();
    assert!(
        person
            .state()
            .store
            .as_ref()
            .unwrap()
            .snapshot
            .samples
            .is_empty()
    );
    person.click("Back to the sets");
    person.frames(2);
    assert!(person.sees("Propose set 1"), "open to changes again");
}

#[test]
fn a_click_throws_out_marked_ones_are_split_off_and_all_is_taken_back() {
    let (_folder, mut person) = shelved();
    let all = instances(&person, 0);
    person.click("Throw out Instance 1 of set 1");
    person.frames(2);
    assert_eq!(
        instances(&person, 0),
        all[1..],
        "the outermost is the first"
    );
    let sets = person.state().shelf.sets.len();
    person.ctrl_click("Instance 1 of set 1");
    person.frames(2);
    person.click("Split off from set 1");
    person.frames(2);
    assert_eq!(
        person.state().shelf.sets.len(),
        sets + usize::from(all.len() > 2)
    );
    if all.len() > 2 {
        assert_eq!(instances(&person, 0), all[2..]);
        assert_eq!(instances(&person, 1), all[1..2]);
        shelf(&mut person, ShelfCommand::Join { set: 1, into: 0 });
        assert_eq!(instances(&person, 0).len(), all.len() - 1);
        person.click("Take back");
        person.frames(2);
    }
    person.click("Take back");
    person.frames(2);
    person.click("Take back");
    person.frames(2);
    assert_eq!(instances(&person, 0), all);
    assert!(!person.state().shelf.can_take_back());
    person.click("Not a motion: set 1");
    person.frames(2);
    assert!(!person.sees("Set 1"));
}

#[test]
fn a_handle_moves_that_end_of_every_instance() {
    let (_folder, mut person) = shelved();
    let before = instances(&person, 0);
    let handle = |person: &Person, name: &str| person.place(name).center();
    let start = handle(&person, "Start of set 1");
    let ruler = person.place("Both ends of set 1");
    person.drag(start, pos2(start.x + 0.2 * ruler.width(), start.y));
    let moved = instances(&person, 0);
    assert_eq!(moved.len(), before.len());
    let shares: Vec<f64> = before
        .iter()
        .zip(&moved)
        .map(|(b, m)| (m.span.start_secs - b.span.start_secs) / b.span.duration_secs())
        .collect();
    assert!(
        shares
            .iter()
            .all(|s| (s - shares[0]).abs() < 1e-9 && *s > 0.05),
        "{shares:?}"
    );
    assert!(
        before
            .iter()
            .zip(&moved)
            .all(|(b, m)| b.span.stop_secs == m.span.stop_secs)
    );
    let middle = handle(&person, "Both ends of set 1");
    person.drag(middle, pos2(middle.x - 30.0, middle.y));
    let both = instances(&person, 0);
    assert!(
        both.iter()
            .zip(&moved)
            .all(|(b, m)| b.span.stop_secs < m.span.stop_secs)
    );
    // Ends that would cross stop before, and what lies outside of a clip is cut off.
    shelf(
        &mut person,
        ShelfCommand::Ends {
            set: 0,
            ends: (0.9, -0.9),
        },
    );
    assert!(instances(&person, 0).iter().all(|s| s.span.is_stretch()));
    shelf(
        &mut person,
        ShelfCommand::Ends {
            set: 0,
            ends: (-9.0, 9.0),
        },
    );
    assert!(
        instances(&person, 0)
            .iter()
            .all(|s| s.span.start_secs >= 0.0)
    );
}

#[test]
fn repetitions_become_runs_and_strips_play() {
    let (_folder, mut person) = shelved();
    let count = instances(&person, 0).len();
    person.click("Whole runs of set 1");
    person.frames(2);
    assert!(person.state().shelf.sets[0].runs && instances(&person, 0).len() <= count);
    person.click("Play together");
    person.frames(4);
    assert!(person.state().shelf.playing && person.is_redrawn());
    person.click("Stop");
    person.frames(2);
    // Commands for sets that are not there change nothing.
    shelf(&mut person, ShelfCommand::NotAMotion(999));
    shelf(&mut person, ShelfCommand::Split(999));
    shelf(&mut person, ShelfCommand::Join { set: 0, into: 0 });
    person.command(Command::Shelf(ShelfCommand::Name {
        set: 999,
        name: "x".into(),
    }));
    assert!(instances(&person, 999).is_empty());
}
