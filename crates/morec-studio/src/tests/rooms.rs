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

/// Height of the bar at the bottom.
const BAR: f32 = 28.0;

#[test]
fn in_the_smallest_window_the_bar_at_the_top_is_whole() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.frames(2);
        for name in TOP {
            let at = person.place(name);
            assert!(window.contains_rect(at), "{panel:?}: {name} at {at:?}");
        }
    }
}

#[test]
fn in_the_smallest_window_every_column_of_the_library_is_reached() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    person.goes_to(Panel::Library);
    for column in ["clip", "person", "length", "labels", "format"] {
        let name = format!("Sort by {column}");
        for _ in 0..200 {
            if person.focused().as_deref() == Some(&name) {
                break;
            }
            person.key(Key::Tab);
        }
        person.frames(4);
        let at = person.place(&name);
        assert!(
            at.width() > 30.0 && window.contains_rect(at),
            "{column} at {at}"
        );
    }
}

#[test]
fn nothing_of_a_scrolled_panel_lies_over_the_bars() {
    let (_folder, mut person, window) = sized(640.0, 400.0);
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.frames(2);
        let bar = window.bottom() - 0.5 * BAR;
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
