//! Every panel as a picture, dark and light, from 1280 × 720 up.

use morec_db::MotionDb;

use super::made;
use crate::screenshot::{Shot, draw};
use crate::state::Panel;

/// Number of different colours of a picture.
fn colours(image: &egui::ColorImage) -> usize {
    let all: std::collections::BTreeSet<[u8; 4]> =
        image.pixels.iter().map(|p| p.to_array()).collect();
    all.len()
}

#[test]
fn panels_are_drawn_without_a_display() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    for (panel, dark) in [
        (Panel::Library, true),
        (Panel::Label, false),
        (Panel::Live, true),
    ] {
        let shot = Shot {
            panel,
            clip: Some("ben_1".to_owned()),
            at_secs: 2.0,
            dark,
            ..Shot::default()
        };
        let image = draw(std::slice::from_ref(&path), &shot).unwrap();
        assert_eq!(image.size, [1280, 720]);
        // Text, limbs and tracks: a panel that is empty has a handful of colours.
        assert!(colours(&image) > 1000, "{panel:?} {}", colours(&image));
        let corner = image.pixels[0];
        assert_eq!(corner.r() < 100, dark, "the theme that was asked for");
    }
}

#[test]
fn a_picture_leaves_the_database_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 2);
    let steps = || MotionDb::open(&path).unwrap().history().unwrap().len();
    let before = steps();
    for panel in [Panel::Classes, Panel::Label] {
        let shot = Shot {
            panel,
            ..Shot::default()
        };
        draw(std::slice::from_ref(&path), &shot).unwrap();
        assert_eq!(steps(), before, "{panel:?}");
    }
}

#[test]
fn a_clip_that_is_not_there_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let shot = Shot {
        clip: Some("nobody".to_owned()),
        ..Shot::default()
    };
    let path = made(folder.path(), 0);
    assert_eq!(
        draw(&[path], &shot).unwrap_err(),
        "no clip is called nobody"
    );
}

#[test]
fn a_screen_of_high_density_has_the_same_panel_in_more_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let shot = Shot {
        size: [2560, 1440],
        scale: 2.0,
        ..Shot::default()
    };
    let image = draw(std::slice::from_ref(&path), &shot).unwrap();
    assert_eq!(image.size, [2560, 1440]);
    // The bar at the top is 42 points high, with a line below it.
    let row = |y: usize| image.pixels[y * image.size[0] + 1200];
    assert_eq!(row(60), row(4));
    assert_ne!(row(90), row(60));
}

#[test]
fn the_tree_of_the_method_of_2009_is_drawn_with_its_boundaries() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 2);
    let shot = |tree| Shot {
        panel: Panel::Train,
        tree,
        ..Shot::default()
    };
    let image = draw(std::slice::from_ref(&path), &shot(true)).unwrap();
    // Where a side accepts, the plane is tinted: a few hundred pixels at least are neither ground nor text.
    let c = crate::theme::Colours::of(true);
    let tint = c.tint(c.accent, 0.30);
    let tinted = image.pixels.iter().filter(|p| **p == tint).count();
    assert!(tinted > 1000, "{tinted}");
}
