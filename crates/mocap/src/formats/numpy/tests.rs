use std::io::{Cursor, Write};

use super::*;

/// An array of doubles as NumPy writes it.
fn npy(shape: &[usize], value: impl Fn(usize) -> f64) -> Vec<u8> {
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    let bytes: Vec<u8> = (0..shape.iter().product())
        .flat_map(|i| value(i).to_le_bytes())
        .collect();
    with_header("<f8", &format!("({},)", sizes.join(", ")), &bytes)
}

fn with_header(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\0".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.bytes());
    bytes.extend(data);
    bytes
}

fn names(names: &[&str]) -> Vec<u8> {
    let width = names.iter().map(|n| n.chars().count()).max().unwrap();
    let mut data = Vec::new();
    for name in names {
        let letters: Vec<u32> = name.chars().map(u32::from).collect();
        data.extend(letters.iter().flat_map(|c| c.to_le_bytes()));
        data.resize(data.len() + 4 * (width - letters.len()), 0);
    }
    with_header(&format!("<U{width}"), &format!("({},)", names.len()), &data)
}

fn npz(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (key, bytes) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        out.start_file(format!("{key}.npy"), options).unwrap();
        out.write_all(bytes).unwrap();
    }
    out.finish().unwrap().into_inner()
}

fn open(bytes: &[u8]) -> Result<Loaded, ParseError> {
    read(bytes, "f", None, &Limits::default())
}

/// Place of number `i` of a whole array: frame, point, axis.
fn place(i: usize, points: usize, width: usize) -> f64 {
    let (axis, point, frame) = (i % width, i / width % points, i / width / points);
    if axis == 3 {
        0.9
    } else {
        1.0 + frame as f64 * 0.1 + point as f64 * 0.01 + axis as f64
    }
}

#[test]
fn arrays_of_every_shape_are_the_same_points() {
    for (shape, width) in [
        (vec![6, 17, 3], 3),
        (vec![6, 17, 4], 4),
        (vec![1, 6, 17, 3], 3),
        (vec![6, 1, 17, 3], 3),
        (vec![6, 51], 3),
    ] {
        let clip = open(&npy(&shape, |i| place(i, 17, width)))
            .unwrap()
            .clips
            .remove(0);
        assert_eq!((clip.frames, clip.skeleton.len()), (6, 17), "{shape:?}");
        let at = clip.tracks[3].positions[5];
        assert!(
            (at - Vec3::new(1.53, 2.53, 3.53)).norm() < 1e-9,
            "{shape:?}: {at}"
        );
    }
    let two = open(&npy(&[6, 2, 17, 3], |i| place(i, 34, 3))).unwrap();
    assert_eq!(
        two.clips
            .iter()
            .map(|clip| clip.skeleton.len())
            .sum::<usize>(),
        34
    );
}

#[test]
fn archives_say_names_and_rate() {
    let labels = ["Hips", "Kopf", "Füße", "Hand", "Arm"];
    let bytes = npz(&[
        ("keypoints_3d", npy(&[8, 5, 3], |i| place(i, 5, 3))),
        ("names", names(&labels)),
        ("fps", npy(&[1], |_| 50.0)),
    ]);
    let clip = open(&bytes).unwrap().clips.remove(0);
    let found: Vec<&str> = clip.skeleton.names().collect();
    assert_eq!((found.as_slice(), clip.rate_hz), (&labels[..], 50.0));
}

#[test]
fn hands_and_face_behind_the_body_are_left_out() {
    let loaded = open(&npy(&[4, 553, 3], |i| place(i, 553, 3))).unwrap();
    assert_eq!(loaded.clips[0].skeleton.len(), 33);
    assert!(
        loaded.warnings[0].text.contains("553 points"),
        "{:?}",
        loaded.warnings
    );
}

#[test]
fn what_cannot_be_read_is_said_plainly() {
    let found = |bytes: Vec<u8>| open(&bytes).unwrap_err().found;
    assert!(found(npy(&[6, 17, 2], |_| 1.0)).contains("two dimensions"));
    assert!(found(npy(&[6, 263], |_| 1.0)).contains("no known set"));
    assert!(found(npy(&[6], |_| 1.0)).contains("another shape"));
    assert!(found(npy(&[0, 17, 3], |_| 1.0)).contains("nothing"));
    assert!(found(with_header("|O", "(1,)", b"\x80\x04K\x01.")).contains("Python objects"));
    let whole = npz(&[
        ("positions", npy(&[3, 5, 3], |i| place(i, 5, 3))),
        ("names", names(&["a"; 5])),
    ]);
    crate::formats::mangle::each(&whole, 300, |bytes| _ = open(bytes));
}
