//! Index files: what comes back is what was written, and anything else is an error that says so.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use morec::features::Rows;
use morec::index::{INDEX_VERSION, IndexError, MotionIndex, Provenance};
use morec::live::Model;
use morec::roles::Role;
use morec::synth::{DatabaseSpec, SyntheticTake};
use morec::train::TrainParams;

use crate::engines::inline;
use crate::made;

/// A small index, as one is committed: two classes by two people, few negatives.
fn index() -> &'static MotionIndex {
    static INDEX: OnceLock<MotionIndex> = OnceLock::new();
    INDEX.get_or_init(|| {
        let classes = vec!["push", "bow"];
        let spec = DatabaseSpec {
            people: 2,
            repetitions: 1,
            rate_hz: 30.0,
            classes,
            ..DatabaseSpec::default()
        };
        let model = made::train(
            &spec,
            TrainParams {
                max_negatives: 6,
                ..TrainParams::default()
            },
        );
        MotionIndex {
            model: model.into(),
            roles: BTreeMap::from([
                (Role::Hips, "Hips".to_owned()),
                (Role::LeftHand, "ma\"in\tgauche".to_owned()),
            ]),
            provenance: Provenance {
                created: "2026-11-21T10:00:00Z".to_owned(),
                morec_version: "0.1.0".to_owned(),
                clips: vec!["ada_1".to_owned(), "ben_1".to_owned()],
                samples: 4,
                background_secs: BTreeMap::from([("everyday".to_owned(), 12.5)]),
            },
        }
    })
}

fn bytes() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| index().to_bytes().unwrap())
}

#[test]
fn what_was_written_comes_back_and_is_written_the_same_again() {
    let read = MotionIndex::from_bytes(bytes()).unwrap();
    assert_eq!(read, *index());
    assert_eq!(read.to_bytes().unwrap(), bytes());
}

#[test]
fn a_file_cut_short_anywhere_is_an_error() {
    let bytes = bytes();
    let header = 8 + u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
    for length in (0..header + 64)
        .chain((header..bytes.len()).step_by(97))
        .chain([bytes.len() - 1])
    {
        let error = MotionIndex::from_bytes(&bytes[..length])
            .map(|_| ())
            .expect_err("cut short");
        assert!(!error.to_string().is_empty());
    }
    let longer: Vec<u8> = bytes.iter().copied().chain([0]).collect();
    assert!(MotionIndex::from_bytes(&longer).is_err());
}

#[test]
fn an_altered_byte_is_an_error_or_changes_nothing() {
    let header = 8 + u64::from_le_bytes(bytes()[..8].try_into().unwrap()) as usize;
    let mut altered = bytes().to_vec();
    let mut refused = 0;
    for at in (0..header)
        .step_by(3)
        .chain((header..altered.len()).step_by(1009))
    {
        for flip in [0x01, 0x10, 0x80] {
            altered[at] ^= flip;
            match MotionIndex::from_bytes(&altered) {
                // A blank of the padding may become another blank.
                Ok(read) => assert_eq!(read, *index(), "byte {at} ^ {flip:#x} went unnoticed"),
                Err(_) => refused += 1,
            }
            altered[at] ^= flip;
        }
    }
    assert!(refused > 1000, "{refused}");
}

#[test]
fn a_changed_number_is_a_checksum_error() {
    let mut altered = bytes().to_vec();
    *altered.last_mut().unwrap() ^= 1;
    let error = MotionIndex::from_bytes(&altered).unwrap_err();
    assert!(matches!(error, IndexError::Checksum { .. }), "{error}");
}

#[test]
fn foreign_files_are_called_foreign() {
    let mut plain = br#"{"__metadata__":{"format":"pt"}}"#.to_vec();
    plain.splice(0..0, (plain.len() as u64).to_le_bytes());
    let bvh = include_bytes!("../../../mocap/testdata/bvh/plain.bvh");
    for foreign in [&[][..], b"PK\x03\x04", &[0xff; 64], bvh, &plain] {
        let error = MotionIndex::from_bytes(foreign).unwrap_err();
        assert!(matches!(error, IndexError::Foreign(_)), "{error}");
        assert!(
            error.to_string().starts_with("not a morec index"),
            "{error}"
        );
    }
}

#[test]
fn a_newer_version_asks_for_a_newer_morec() {
    let replaced = |from: String, to: String| {
        let at = bytes()
            .windows(from.len())
            .position(|w| w == from.as_bytes())
            .expect("the manifest's text");
        let mut changed = bytes().to_vec();
        changed[at..at + from.len()].copy_from_slice(to.as_bytes());
        MotionIndex::from_bytes(&changed).unwrap_err()
    };
    let version = |v: u32| format!("\\\"version\\\":{v}");
    let error = replaced(version(INDEX_VERSION), version(INDEX_VERSION + 1));
    assert_eq!(
        error,
        IndexError::Newer {
            found: INDEX_VERSION + 1
        }
    );
    assert!(error.to_string().contains("use a newer morec"));
    let error = replaced("templates\\\"".to_owned(), "telepathy\\\"".to_owned());
    assert_eq!(error, IndexError::Method("telepathy".to_owned()));
}

/// The stream of the compatibility test: both classes and something else, by somebody never seen.
fn stream() -> SyntheticTake {
    let script = made::right_handed(90, 3)
        .rest(1.0)
        .play("push")
        .rest(0.8)
        .play("phone")
        .rest(0.5)
        .play("bow")
        .rest(1.0);
    script.film("compatibility", 60.0).unwrap()
}

/// Detections of `index` in it: class, start, stop, score; times in hundredths of a second.
fn recognised(index: &MotionIndex) -> Vec<(String, f64, f64, f64)> {
    let (bones, poses) = made::poses(&stream());
    let Model::Templates(model) = &index.model else {
        panic!("another method")
    };
    let found = inline(model, bones, &poses);
    let name = |d: &morec::live::Detection| index.model.class_name(d.class).to_owned();
    found
        .iter()
        .map(|d| (name(d), d.span.start_secs, d.span.stop_secs, d.score))
        .collect()
}

fn committed(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("testdata/index")
        .join(name)
}

#[test]
fn an_index_of_version_1_opens_for_ever_and_recognises_what_it_did() {
    let index = MotionIndex::from_bytes(&std::fs::read(committed("v1.index")).unwrap()).unwrap();
    let expected = std::fs::read_to_string(committed("v1.json")).unwrap();
    let expected: Vec<(String, f64, f64, f64)> = serde_json::from_str(&expected).unwrap();
    let found = recognised(&index);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    assert!(!found.is_empty());
    for (f, e) in found.iter().zip(&expected) {
        assert_eq!(f.0, e.0);
        // A tick's room for another order of adding up.
        assert!(
            (f.1 - e.1).abs() < 0.035 && (f.2 - e.2).abs() < 0.035 && (f.3 - e.3).abs() < 1e-3,
            "{f:?}, {e:?}"
        );
    }
}

/// Writes the files of the compatibility test; only ever for a new version, under a new name.
#[test]
#[ignore = "writes testdata/index"]
fn write_index_of_this_version() {
    let name = format!("v{INDEX_VERSION}");
    std::fs::write(committed(&format!("{name}.index")), bytes()).unwrap();
    let found = serde_json::to_string_pretty(&recognised(index())).unwrap();
    std::fs::write(committed(&format!("{name}.json")), found + "\n").unwrap();
}

#[test]
fn figures_no_training_gives_are_refused() {
    let refused = |change: &dyn Fn(&mut morec::templates::TemplateModel)| {
        let mut index = index().clone();
        let Model::Templates(model) = &mut index.model else {
            panic!("another method")
        };
        change(Arc::make_mut(model));
        match MotionIndex::from_bytes(&index.to_bytes().unwrap()) {
            Err(IndexError::Content(message)) => assert!(!message.is_empty()),
            other => panic!("opened: {:?}", other.map(|_| ())),
        }
    };
    refused(&|m| m.threshold = -1.0);
    refused(&|m| m.features.frames_per_tick = 0);
    refused(&|m| m.features.smooth_cut_frames = usize::MAX);
    refused(&|m| m.features.rate_hz = 1e12);
    refused(&|m| m.features.rate_hz = 2.0);
    refused(&|m| m.features.velocity_weight = 65_536.0);
    refused(&|m| m.features.root_weight = 65_536.0);
    for value in [3e20, f32::NAN] {
        refused(&|m| {
            let rows = &mut m.samples[0].rows;
            let mut values = rows.values().to_vec();
            values[3] = value;
            *rows = Rows::from_values(rows.dim(), values);
            m.step = None;
        });
    }
    refused(&|m| m.classes.clear());
    refused(&|m| m.decode.gate_ticks = 1 << 60);
    refused(&|m| m.decode.gate = -1.0);
}
