//! The camera stands before a clip that is opened so that its whole motion is in the picture.

use super::bodies::{dots, trc, with};
use super::{Person, made};
use crate::state::{Command, FileCommand, LibraryCommand, Panel, PlayCommand, ViewCommand};

/// Times of a clip, as shares of its length.
const TIMES: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 0.99];

fn goes_to_share(person: &mut Person, share: f64) {
    let at = share * person.state().player.secs();
    person.command(Command::Play(PlayCommand::Seek(at)));
}

/// Panics unless all markers are in the picture at all times.
fn markers_are_seen(person: &mut Person, what: &str) {
    for panel in [Panel::Library, Panel::Label, Panel::Classes] {
        person.goes_to(panel);
        for share in TIMES {
            goes_to_share(person, share);
            let seen = dots(person).len();
            assert_eq!(seen, 5, "{what}, {panel:?}, at {share} of the clip");
        }
    }
}

/// Markers that lie close together at first and eight metres apart at the end.
fn spreading() -> String {
    trc(|frame, marker| {
        [
            0.1 * marker + 2.0 * marker * frame / 119.0,
            1.0,
            0.1 * marker,
        ]
    })
}

#[test]
fn what_spreads_out_is_framed_as_far_as_it_goes() {
    let (_folder, _, mut person) = with("spreading.trc", spreading().as_bytes());
    markers_are_seen(&mut person, "spreading");
}

#[test]
fn a_camera_that_does_not_follow_sees_the_whole_way_of_each_clip_that_is_opened() {
    let (folder, _, mut person) = with("spreading.trc", spreading().as_bytes());
    let travelling = trc(|frame, marker| [100.0 + 0.25 * frame, 0.2 * marker, -40.0]);
    let path = folder.path().join("travelling.trc");
    std::fs::write(&path, travelling).unwrap();
    person.command(Command::File(FileCommand::Import(vec![path])));
    person.command(Command::Look(ViewCommand::Follow(false)));
    for name in ["travelling", "spreading"] {
        person.goes_to(Panel::Library);
        person.click(name);
        person.settle();
        markers_are_seen(&mut person, name);
    }
}

#[test]
fn a_person_is_seen_whole_after_another_clip_was_looked_at_closely() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    let near = crate::body::Camera {
        distance: 0.8,
        follow: false,
        target: morec::math::Vec3::new(30.0, 1.0, 0.0),
        ..person.state().camera
    };
    person.command(Command::Look(ViewCommand::Camera(near)));
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let other = snapshot.clips.iter().find(|c| c.name == "ben_1").unwrap();
    person.command(Command::Library(LibraryCommand::Open(other.id)));
    for share in TIMES {
        goes_to_share(&mut person, share);
        let picture = person.place("Performer");
        let (state, view) = (person.state(), person.state().camera.view(picture));
        let motion = state.player.motion.as_ref().unwrap();
        assert_eq!(motion.clip.name, "ben_1");
        for at in &motion.pose(state.player.at_secs).positions {
            let (place, _) = view.project(at).unwrap();
            assert!(picture.contains(place), "{place:?} at {share} of the clip");
        }
    }
}
