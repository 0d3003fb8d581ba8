//! Keyboard and screen readers: what can be clicked has a name, and Tab reaches it.

use std::collections::BTreeSet;

use egui::{Key, Modifiers, accesskit};
use egui_kittest::kittest::NodeT;

use super::{Person, made};
use crate::state::Panel;

/// Names of what can be clicked, and how many things without a name there are.
fn clickable(person: &Person) -> (BTreeSet<String>, Vec<String>) {
    let (mut names, mut nameless) = (BTreeSet::new(), Vec::new());
    for node in person.window.root().children_recursive() {
        let node = node.accesskit_node();
        let data = node.data();
        let acts = data.supports_action(accesskit::Action::Click);
        // The handle of a scroll bar, which a wheel and the keys of what it scrolls stand for.
        let thin = |b: accesskit::Rect| b.width().min(b.height()) <= 12.0;
        let is_bar =
            node.role() == accesskit::Role::Unknown && node.bounding_box().is_some_and(thin);
        // Text that can be selected with the mouse takes clicks, but does nothing.
        let is_text = node.role() == accesskit::Role::Label;
        if !acts || node.is_disabled() || is_bar || is_text {
            continue;
        }
        match node.label().or_else(|| node.value()) {
            Some(name) if !name.trim().is_empty() => {
                names.insert(name);
            }
            _ => nameless.push(format!("{:?} at {:?}", node.role(), node.bounding_box())),
        }
    }
    (names, nameless)
}

/// Names of what Tab reaches until it comes round.
fn reached(person: &mut Person, most: usize) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for _ in 0..most {
        person.key_with(Key::Tab, Modifiers::NONE);
        let focused = person.window.root().children_recursive();
        let focused = focused
            .map(|node| node.accesskit_node())
            .find(|n| n.is_focused());
        if let Some(name) = focused.and_then(|n| n.label().or_else(|| n.value())) {
            names.insert(name);
        }
    }
    names
}

#[test]
fn everything_that_can_be_clicked_has_a_name_and_is_reached_by_tab() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    for panel in Panel::ALL {
        person.goes_to(panel);
        if panel == Panel::Train {
            person.click("Start training");
            person.settle();
        }
        person.frames(3);
        let (names, nameless) = clickable(&person);
        assert!(nameless.is_empty(), "{panel:?}: {nameless:?}");
        assert!(names.len() > 10, "{panel:?}: {names:?}");
        let reached = reached(&mut person, names.len() + 40);
        // A number becomes an editor, with a name of its own, when Tab reaches it.
        let is_number = |name: &&String| name.parse::<f64>().is_ok();
        let missing: Vec<_> = names
            .difference(&reached)
            .filter(|name| !is_number(name))
            .collect();
        assert!(
            missing.is_empty(),
            "{panel:?}: Tab does not reach {missing:?}"
        );
    }
}
