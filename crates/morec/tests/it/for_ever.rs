//! Files of old releases, kept under `testdata/`: they open for ever, and mean what they meant.

use std::path::PathBuf;

use morec::index::{INDEX_VERSION, MotionIndex};
use morec::live::recognize_clip;
use morec::roles::RoleMap;
use morec::synth::SyntheticTake;
use morec::train::thesis::SvrdmTrainParams;

use crate::made;
use crate::thesis_people::{index_of, trained};

fn committed(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("testdata")
        .join(name)
}

fn read(name: &str) -> Vec<u8> {
    std::fs::read(committed(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Somebody never seen, who performs two of the classes and something else.
fn stream() -> SyntheticTake {
    let script = made::right_handed(90, 3)
        .rest(1.0)
        .play("wave")
        .rest(0.8)
        .play("phone")
        .rest(0.5)
        .play("bow");
    script
        .rest(1.0)
        .play("push")
        .rest(1.5)
        .film("compatibility", 60.0)
        .unwrap()
}

/// Class, start, stop, score.
type Found = Vec<(String, f64, f64, f64)>;

fn recognised(index: &MotionIndex) -> Found {
    let clip = stream().clip;
    let roles = RoleMap::find(&clip.skeleton);
    let found = recognize_clip(&index.model, &clip, &roles, &(0..0)).unwrap();
    let name = |class| index.model.class_name(class).to_owned();
    found
        .iter()
        .map(|d| (name(d.class), d.span.start_secs, d.span.stop_secs, d.score))
        .collect()
}

#[test]
fn an_svrdm_index_of_version_1_opens_for_ever_and_recognises_what_it_did() {
    let index = MotionIndex::from_bytes(&read("index/svrdm_v1.index")).unwrap();
    assert_eq!(index.model.method(), "svrdm");
    let expected: Found = serde_json::from_slice(&read("index/svrdm_v1.json")).unwrap();
    let found = recognised(&index);
    assert!(
        found.len() == expected.len() && found.len() >= 2,
        "{found:?}"
    );
    for (f, e) in found.iter().zip(&expected) {
        assert_eq!((&f.0, f.1, f.2), (&e.0, e.1, e.2));
        assert!((f.3 - e.3).abs() < 1e-6, "{f:?}, {e:?}");
    }
}

/// Writes the files of these tests; only ever for a new version, under a new name.
#[test]
#[ignore = "writes testdata"]
fn write_files_of_this_version() {
    let write = |name: String, bytes: &[u8]| std::fs::write(committed(&name), bytes).unwrap();
    let index = index_of(trained(SvrdmTrainParams::tuned()).0);
    write(
        format!("index/svrdm_v{INDEX_VERSION}.index"),
        &index.to_bytes().unwrap(),
    );
    let found = serde_json::to_string_pretty(&recognised(&index)).unwrap() + "\n";
    write(
        format!("index/svrdm_v{INDEX_VERSION}.json"),
        found.as_bytes(),
    );
}
