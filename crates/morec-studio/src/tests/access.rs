//! Keyboard and screen readers: what can be clicked has a name, and Tab reaches it.

use std::collections::BTreeSet;

use egui::{Color32, Key, Modifiers, Pos2, Rect, Shape, accesskit, vec2};
use egui_kittest::kittest::NodeT;

use super::{Person, made};
use crate::state::{Command, Panel};
use crate::theme::Colours;

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
        names.extend(person.focused());
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

/// The widget that has the keyboard: its name, its place, and its part that is outlined, which is what is seen of it.
fn outlined(person: &Person) -> Option<(String, Rect, Option<Rect>)> {
    let name = person.focused()?;
    let c = Colours::of(person.state().dark);
    // Two lines around each other, of which one is seen on any ground.
    let drawn = |colour: Color32| {
        let shapes = person.window.output().shapes.iter();
        let mut rects = shapes.filter_map(|s| match &s.shape {
            Shape::Rect(rect) if rect.stroke.color == colour && rect.stroke.width == 1.5 => {
                Some(rect.rect.intersect(s.clip_rect))
            }
            _ => None,
        });
        rects.next_back()
    };
    let outline = drawn(c.playhead).zip(drawn(c.ground));
    let ctx = &person.window.ctx;
    let id = ctx.memory(|memory| memory.focused())?;
    let place = ctx.read_response(id)?.rect;
    Some((name, place, outline.map(|(_, inner)| inner)))
}

#[test]
fn in_a_small_window_tab_shows_and_outlines_each_control() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 2);
    let mut person = Person::before(&[path]);
    let window = Rect::from_min_size(Pos2::ZERO, vec2(640.0, 400.0));
    person.window.set_size(window.size());
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.command(Command::Dark(panel != Panel::Label));
        person.frames(3);
        let (names, _) = clickable(&person);
        let mut reached = BTreeSet::new();
        for _ in 0..names.len() + 40 {
            person.key_with(Key::Tab, Modifiers::NONE);
            person.frames(4);
            let Some((name, place, outline)) = outlined(&person) else {
                continue;
            };
            let outline = outline.unwrap_or_else(|| panic!("{panel:?}: {name} is not outlined"));
            // What is larger than what shows it is seen as far as there is room.
            let seen = outline.size().min(window.size());
            let room = vec2(place.width().min(150.0), place.height().min(60.0));
            let enough = seen.x + 4.0 >= room.x && seen.y + 4.0 >= room.y;
            assert!(
                enough && window.expand(4.0).contains_rect(outline),
                "{panel:?}: {name} at {place}, seen {outline}"
            );
            reached.insert(name);
        }
        let is_number = |name: &&String| name.parse::<f64>().is_ok();
        let missing: Vec<_> = names
            .difference(&reached)
            .filter(|n| !is_number(n))
            .collect();
        assert!(missing.is_empty(), "{panel:?}: Tab misses {missing:?}");
    }
}

#[test]
fn the_keyboard_stays_in_an_open_menu_and_comes_back_when_it_closes() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    for _ in 0..100 {
        if person.focused().as_deref() == Some("File") {
            break;
        }
        person.key(Key::Tab);
    }
    person.key(Key::Enter);
    person.frames(3);
    let ctx = person.window.ctx.clone();
    for _ in 0..30 {
        person.key(Key::Tab);
        person.frames(2);
        let id = ctx.memory(|memory| memory.focused());
        let place = id.and_then(|id| ctx.read_response(id));
        let layer = place.expect("a line of the menu").layer_id;
        assert_eq!(
            layer.order,
            egui::Order::Foreground,
            "{:?}",
            person.focused()
        );
    }
    person.key(Key::Escape);
    person.frames(3);
    assert_eq!(person.focused().as_deref(), Some("File"));
}
