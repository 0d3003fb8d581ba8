use std::io::Read;

use super::*;
use morec::formats::{Limits, numpy, table};
use morec::kinematics::WorldPose;

use morec::synth;

fn waving() -> Take {
    let script = synth::Script::new(3, synth::Person::draw(31, 2))
        .rest(0.5)
        .play("wave");
    Take::new(script.film("wave", 60.0).unwrap().clip).unwrap()
}

fn members(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    (0..archive.len())
        .map(|i| {
            let mut file = archive.by_index(i).unwrap();
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).unwrap();
            (file.name().unwrap().into_owned(), bytes)
        })
        .collect()
}

#[test]
fn archives_hold_what_the_clip_holds() {
    let take = waving();
    let mut bytes = Vec::new();
    write_npz(&take, &mut bytes).unwrap();
    let members = members(&bytes);
    let find = |name: &str| {
        &members
            .iter()
            .find(|(n, _)| n == &format!("{name}.npy"))
            .unwrap()
            .1
    };
    let (frames, joints) = (take.clip.frames, take.clip.skeleton.len());
    let positions = find("positions");
    let length = usize::from(positions[8]) + 256 * usize::from(positions[9]) + 10;
    assert_eq!(length % 64, 0);
    let header = String::from_utf8_lossy(&positions[10..length]).into_owned();
    assert!(
        header.contains(&format!("'shape': ({frames}, {joints}, 3)")),
        "{header}"
    );
    assert_eq!(positions.len() - length, frames * joints * 12);
    let last = WorldPose::of(&take.clip, frames - 1).positions[joints - 1];
    let z = f32::from_le_bytes(positions[positions.len() - 4..].try_into().unwrap());
    assert!((f64::from(z) - last.z).abs() < 1e-5);
    for name in [
        "rotations",
        "parents",
        "joint_names",
        "rate_hz",
        "units",
        "role_joints",
    ] {
        assert!(!find(name).is_empty(), "{name}");
    }
}

#[test]
fn tables_of_positions_are_read_back() {
    let take = waving();
    let mut text = Vec::new();
    write_csv(&take, Content::Positions, &mut text).unwrap();
    let again = table::read(&text, "again", None, &Limits::default()).unwrap();
    let clip = &again.clips[0];
    assert_eq!(clip.frames, take.clip.frames);
    assert!((clip.rate_hz - take.clip.rate_hz).abs() < 0.01);
    for frame in [0, clip.frames / 2, clip.frames - 1] {
        let pose = WorldPose::of(&take.clip, frame).positions;
        for (joint, track) in take.clip.skeleton.joints().iter().zip(&pose) {
            let read = clip.skeleton.find(&joint.name).unwrap();
            assert!(
                (clip.tracks[read].positions[frame] - track).norm() < 1e-5,
                "{}",
                joint.name
            );
        }
    }
}

#[test]
fn every_table_has_as_many_cells_as_names() {
    for content in [Content::Positions, Content::Rotations, Content::Features] {
        let mut text = Vec::new();
        write_csv(&waving(), content, &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let cells: Vec<usize> = text.lines().map(|line| line.split(',').count()).collect();
        assert!(cells.iter().all(|&count| count == cells[0]), "{content:?}");
    }
}

#[test]
fn features_are_named_one_by_one() {
    let names = morec::features::RowLayout::column_names(morec::features::BoneSet::of_roles(
        &waving().roles,
    ));
    let dim =
        morec::features::RowLayout::of(morec::features::BoneSet::of_roles(&waving().roles)).dim();
    assert_eq!(names.len(), dim);
}

#[test]
fn archives_are_read_back() {
    let take = waving();
    let mut bytes = Vec::new();
    write_npz(&take, &mut bytes).unwrap();
    let clip = numpy::read(&bytes, "again", None, &Limits::default())
        .unwrap()
        .clips
        .remove(0);
    assert_eq!(
        (clip.frames, clip.rate_hz),
        (take.clip.frames, take.clip.rate_hz)
    );
    assert!(clip.has_rotations());
    for frame in [0, clip.frames / 2, clip.frames - 1] {
        let (a, b) = (
            WorldPose::of(&clip, frame),
            WorldPose::of(&take.clip, frame),
        );
        for (a, b) in a.positions.iter().zip(&b.positions) {
            assert!((a - b).norm() < 1e-5, "{a} {b}");
        }
    }
}
