//! Every panel as a picture, dark and light, from 1280 × 720 up.

use super::made;
use crate::screenshot::{Shot, draw};
use crate::state::Panel;

/// How many different colours a picture has.
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
            like: None,
            size: [1280, 720],
            dark,
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
fn a_clip_that_is_not_there_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let shot = Shot {
        panel: Panel::Library,
        clip: Some("nobody".to_owned()),
        at_secs: 0.0,
        like: None,
        size: [1280, 720],
        dark: true,
    };
    let path = made(folder.path(), 0);
    assert_eq!(
        draw(&[path], &shot).unwrap_err(),
        "no clip is called nobody"
    );
}
