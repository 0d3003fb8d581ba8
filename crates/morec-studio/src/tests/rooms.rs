//! Small windows, and names in other scripts.

use std::path::PathBuf;

use egui::{Key, Modifiers, Rect, vec2};

use super::{Person, made};
use crate::fonts::Fonts;
use crate::state::Panel;
use crate::store::Edit;

/// A control at the edge of each panel.
const EDGES: [(Panel, &str); 5] = [
    (Panel::Library, "Position"),
    (Panel::Label, "Propose"),
    (Panel::Classes, "Group cuts"),
    (Panel::Train, "Start training"),
    (Panel::Live, "Mark as background"),
];
const TOP: [&str; 9] = [
    "File", "Library", "Label", "Classes", "Train", "Live", "Undo", "Redo", "Keys",
];

fn sized(width: f32, height: f32) -> (tempfile::TempDir, Person, Rect) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    person.window.set_size(vec2(width, height));
    person.frames(3);
    let window = Rect::from_min_size(egui::Pos2::ZERO, vec2(width, height));
    (folder, person, window)
}

#[test]
fn half_of_a_full_screen_shows_each_panel_whole() {
    let (_folder, mut person, window) = sized(960.0, 540.0);
    for (panel, edge) in EDGES {
        person.goes_to(panel);
        person.frames(2);
        for name in TOP.into_iter().chain([edge]) {
            let at = person.place(name);
            assert!(window.contains_rect(at), "{panel:?}: {name} at {at:?}");
        }
    }
}

/// Heights of the bars at the top and at the bottom.
const BARS: (f32, f32) = (42.0, 28.0);

/// Where buttons, fields and rows of the panel are seen: each is wholly in the window, or a scroll area leads to it.
fn controls(person: &Person) -> Vec<(String, Rect)> {
    use egui::accesskit::Role;
    use egui_kittest::kittest::NodeT;
    let mut found = Vec::new();
    for node in person.window.root().children_recursive() {
        if node.accesskit_node().bounding_box().is_none() {
            continue;
        }
        let place = node.rect();
        let node = node.accesskit_node();
        let kinds = [
            Role::Button,
            Role::TextInput,
            Role::CheckBox,
            Role::ComboBox,
        ];
        if kinds.contains(&node.role()) && !node.is_hidden() {
            found.push((node.label().unwrap_or_default(), place));
        }
    }
    found
}

#[test]
fn in_the_smallest_window_no_control_lies_on_another_and_the_bar_is_whole() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.frames(2);
        for name in TOP {
            let at = person.place(name);
            assert!(window.contains_rect(at), "{panel:?}: {name} at {at:?}");
        }
        // What lies outside is brought in by scrolling.
        let room = window.y_range();
        let room = room.min + BARS.0..room.max - BARS.1;
        let all = controls(&person);
        let inside = all.iter().filter(|(_, at)| room.contains(&at.center().y));
        for (at, (name, place)) in inside.clone().enumerate() {
            for (other, there) in inside.clone().skip(at + 1) {
                let common = place.intersect(*there);
                let within = place.contains_rect(*there) || there.contains_rect(*place);
                let touching = common.width() > 1.0 && common.height() > 1.0;
                assert!(
                    within || !touching,
                    "{panel:?}: {name} at {place} lies on {other} at {there}"
                );
            }
        }
    }
}

#[test]
fn nothing_of_a_scrolled_panel_lies_over_the_bars() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.frames(2);
        let bar = window.bottom() - 0.5 * BARS.1;
        let seen = |person: &Person| {
            let state = person.state();
            let focused = person.window.ctx.memory(|memory| memory.focused());
            let (at, range) = (state.player.at_secs, state.timeline.range);
            (
                at,
                range,
                state.library.selected.clone(),
                focused,
                person.written(),
            )
        };
        let before = seen(&person);
        // Nothing but the bar's own button, which copies, lies there.
        for x in (10..640).step_by(45) {
            person.click_at(egui::pos2(x as f32, bar));
            assert_eq!(
                seen(&person),
                before,
                "{panel:?}: a click on the bar at {x}"
            );
        }
    }
}

#[test]
fn windows_and_menus_fit_into_the_smallest_window() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    person.click("File");
    person.frames(3);
    let area = person.window.ctx.memory(|memory| {
        let layers = memory.areas().visible_layer_ids();
        let menus = layers
            .into_iter()
            .filter(|l| l.order == egui::Order::Foreground);
        let mut rects = menus.filter_map(|layer| memory.area_rect(layer.id));
        rects.next()
    });
    let area = area.expect("the menu is open");
    assert!(window.contains_rect(area), "{area}");
    person.key(Key::Escape);
    person.click("Keys");
    person.frames(3);
    let close = person.place("Close window");
    assert!(window.contains_rect(close), "{close}");
}

/// Renames a class, with these files as fonts of the system.
fn renamed(name: &str, files: Vec<PathBuf>) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    person.window.state_mut().fonts = Fonts::of(files);
    let (from, to) = ("wave".to_owned(), name.to_owned());
    person.command(crate::state::Command::Edit(Edit::RenameClass { from, to }));
    person.frames(3);
    (folder, person)
}

#[test]
fn a_name_that_no_font_can_draw_is_said_and_a_font_of_the_system_draws_what_it_has() {
    let (_folder, mut person) = renamed("波", vec![PathBuf::from("no/such.ttf")]);
    assert!(person.sees_part("No installed font has all letters of 波 (U+6CE2)"));
    // It goes with the name.
    person.key_with(Key::Z, Modifiers::COMMAND);
    person.settle();
    person.frames(3);
    assert!(!person.sees_part("No installed font"));

    let arabic = PathBuf::from("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");
    let is_there = arabic.exists();
    let (_folder, person) = renamed("موجة", vec![arabic]);
    assert_eq!(person.can_draw("موجة"), is_there);
    assert_eq!(person.sees_part("No installed font"), !is_there);
}
