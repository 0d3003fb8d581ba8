//! Training and judging through the window.

use morec_db::labels::{NewSample, SampleState as Judged};

use super::{Person, made};
use crate::jobs::thesis::{GRID, Shown};
use crate::state::{Command, Panel};
use crate::store::Edit;

#[test]
fn an_index_is_trained_kept_and_its_mistakes_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    person.goes_to(Panel::Train);
    person.click("Start training");
    person.settle();
    let index = person.state().train.index.clone().unwrap();
    assert_eq!(index.model.classes().len(), 3);
    assert!(!person.state().train.is_stale());
    person.click("Keep");
    person.settle();
    assert!(person.sees("up to date"), "the database has it");
    person.undo();
    assert!(person.sees_part("None is kept yet"));
    person.click("Cross-validate");
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    let waves: usize = judged
        .moments
        .iter()
        .filter(|m| m.truth.as_deref() == Some("wave") && m.is_right())
        .count();
    assert!(waves > 0, "made people wave alike");
    let first = judged
        .moments
        .iter()
        .find(|m| m.truth.as_deref() == Some("wave") && m.is_right())
        .unwrap()
        .clone();
    person.click(&format!("wave taken for wave: {waves}"));
    person.settle();
    let player = &person.state().player;
    assert_eq!(
        player.motion.as_ref().unwrap().clip.name,
        first.clip,
        "the cell plays its first instance"
    );
    let (start, stop) = player.looped.unwrap();
    assert!(start <= first.start_secs && first.stop_secs <= stop + 1e-9);
    assert!(player.playing);
}

#[test]
fn a_missed_label_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 3)]);
    // Nobody moves in the first second: what is labelled there cannot be recognised.
    let clip = person.state().player.motion.as_ref().unwrap().id;
    person.command(Command::Edit(Edit::Label(vec![NewSample {
        clip,
        class: "wave".to_owned(),
        start_secs: 0.1,
        stop_secs: 0.9,
        whole_clip: false,
        state: Judged::Accepted,
        score: None,
    }])));
    person.goes_to(Panel::Train);
    person.click("Cross-validate");
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    let missed = judged
        .moments
        .iter()
        .find(|m| m.truth.as_deref() == Some("wave") && m.found.is_none() && m.start_secs < 0.2);
    let why = missed.unwrap().why.clone().unwrap();
    assert!(why.len() > 10, "{why}");
    assert!(person.sees_part(&format!("wave missed, ada_1 0.10 s: {why}")));
}

#[test]
fn the_method_of_2009_shows_its_branches_and_its_map() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    person.goes_to(Panel::Train);
    person.click("Train it on these labels");
    person.settle();
    let thesis = person.state().train.thesis.clone().unwrap();
    assert_eq!(thesis.samples.len(), 12);
    assert!(person.offers("Branch 0"));
    let Shown::Branch(root) = &thesis.nodes[0] else {
        panic!("three classes make a tree with branches");
    };
    // Samples lie on their own side of the boundary, most of them.
    let inside = root.points.iter().filter(|(_, [x, y], side)| {
        let [left, lower, right, upper] = root.edges;
        let column = ((x - left) / (right - left) * GRID as f64) as usize;
        let row = ((y - lower) / (upper - lower) * GRID as f64) as usize;
        root.regions[row * GRID + column] & (1 << side) != 0
    });
    assert!(2 * inside.count() > root.points.len());
    let sample = &thesis.samples[root.points[3].0];
    let name = format!(
        "Point: {} in {} at {:.2} s",
        sample.class, sample.clip, sample.start_secs
    );
    person.click(&name);
    person.settle();
    let player = &person.state().player;
    assert!(player.playing, "a point plays a sample");
    // Points may lie over one another: it is one of the same place.
    assert!(player.looped.is_some());
    person.goes_to(Panel::Label);
    person.settle();
    assert!(person.sees("Map of confidences"));
    let map = person.state().train.map.as_ref().unwrap();
    assert!(map.cells.iter().any(|cell| cell.0 > 0));
}
