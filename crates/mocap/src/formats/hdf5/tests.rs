use super::*;
use crate::formats::mangle;

/// Files of `testdata/hdf5/make.py`: two seconds of eight points, whose head is not seen for two frames.
const FILES: [(&[u8], f64); 4] = [
    (include_bytes!("../../../testdata/hdf5/table.h5"), 30.0),
    (include_bytes!("../../../testdata/hdf5/fixed.h5"), 30.0),
    (include_bytes!("../../../testdata/hdf5/tracks.h5"), 30.0),
    (include_bytes!("../../../testdata/hdf5/pose.nwb"), 60.0),
];
const PICTURE: &[u8] = include_bytes!("../../../testdata/hdf5/picture.h5");

#[test]
fn poses_of_every_writer_are_the_same() {
    for (at, (bytes, rate_hz)) in FILES.into_iter().enumerate() {
        let loaded = read(bytes, "clip", None, &Limits::default());
        let loaded = loaded.unwrap_or_else(|error| panic!("file {at}: {error}"));
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (6, rate_hz), "file {at}");
        let names: Vec<&str> = clip.skeleton.names().collect();
        assert_eq!(names.len(), 8, "file {at}: {names:?}");
        let metres = if at == 3 { 0.01 } else { 1.0 };
        for (name, [x, y, z]) in [("left_ankle", [0.15, 0.1, 0.0]), ("head", [0.05, 1.6, 0.0])] {
            let joint = clip
                .skeleton
                .find(name)
                .unwrap_or_else(|| panic!("{at}: {names:?}"));
            let track = clip
                .tracks
                .iter()
                .find(|track| track.joint == joint)
                .unwrap();
            let last = track.positions[5] * metres;
            let expected = crate::math::Vec3::new(x, y, z);
            assert!((last - expected).norm() < 1e-9, "file {at}: {name} {last}");
        }
        let given = read(bytes, "clip", Some(100.0), &Limits::default()).unwrap();
        assert_eq!(given.clips[0].rate_hz, 100.0);
    }
}

#[test]
fn places_in_a_picture_are_refused_but_for_a_custom_skeleton() {
    let error = read(PICTURE, "clip", None, &Limits::default()).unwrap_err();
    assert!(error.found.contains("two dimensions"), "{error}");
    let limits = Limits::default();
    let loaded = read_as(&FormatInput {
        planar: true,
        ..FormatInput::alone(PICTURE, "clip", None, &limits)
    })
    .unwrap();
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (6, 8));
    assert!(
        clip.tracks
            .iter()
            .all(|track| track.positions.iter().all(|p| p.z == 0.0))
    );
}

#[test]
fn limits_hold_and_no_bytes_panic() {
    for (bytes, _) in FILES.into_iter().chain([(PICTURE, 0.0)]) {
        let small = Limits {
            memory: bytes.len() + 64,
            ..Limits::default()
        };
        assert!(
            read(bytes, "clip", None, &small)
                .unwrap_err()
                .is_of_memory()
        );
        mangle::each(bytes, 60, |bytes| {
            if let Ok(loaded) = read(bytes, "clip", None, &Limits::default()) {
                mangle::check(&loaded);
            }
        });
    }
}
