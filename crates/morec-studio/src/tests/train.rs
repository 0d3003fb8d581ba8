//! Training and judging through the window.

use super::{Person, made};
use crate::state::Panel;

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
