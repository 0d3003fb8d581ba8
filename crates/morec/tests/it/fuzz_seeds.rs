//! The small files that fuzzing starts from, `fuzz/seeds/TARGET/`: a fuzzer tries thousands of changes a second in an index of a
//! few kilobytes, and four in one of a person's size.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use morec::features::BoneSet;
use morec::formats::{Limits, bvh, c3d, gltf, jsonl, trc};
use morec::import::{ImportOptions, Take, normalize};
use morec::index::{MotionIndex, Provenance};
use morec::live::Model;
use morec::smooth::{SmoothParams, compress};
use morec::synth::DatabaseSpec;
use morec::tables::{Content, write_csv, write_npz};
use morec::train::TrainParams;

use crate::made;

fn seeds(target: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fuzz/seeds")
        .join(target)
}

fn seed(target: &str, name: &str, bytes: &[u8]) {
    std::fs::create_dir_all(seeds(target)).unwrap();
    std::fs::write(seeds(target).join(name), bytes).unwrap();
}

/// Two forearms and nothing else, a class performed twice, with a verifier or without.
fn small_templates(verify: bool) -> MotionIndex {
    let spec = DatabaseSpec {
        people: 2,
        repetitions: 1,
        rate_hz: 30.0,
        classes: vec!["push"],
        ..DatabaseSpec::default()
    };
    let params = TrainParams {
        max_negatives: 1,
        verify,
        ..TrainParams::default()
    };
    let mut model = made::train_on(&spec, params, BoneSet::NONE.with(7).with(9));
    // Rows that do not differ in kind from those before them.
    for sample in &mut model.samples {
        sample.rows = sample.rows.slice(0..sample.rows.len().min(6));
    }
    MotionIndex {
        model: model.into(),
        roles: Default::default(),
        provenance: Provenance::default(),
    }
}

/// The index of the method of 2009 that is kept, with two short profiles.
fn small_svrdm() -> MotionIndex {
    let bytes = include_bytes!("../../testdata/index/svrdm_v1.index");
    let mut index = MotionIndex::from_bytes(bytes).unwrap();
    let Model::Svrdm(model) = &mut index.model else {
        panic!("another method")
    };
    let profiles = &mut Arc::make_mut(model).profiles;
    profiles.lengths = vec![2, 2];
    profiles.classes.truncate(2);
    profiles.values.truncate(4 * profiles.width);
    index
}

/// A clip of two joints and three frames.
fn take() -> Take {
    let bytes = include_bytes!("../../testdata/acclaim/wave.bvh");
    let clip = bvh::read(
        bytes,
        "wave",
        &bvh::BvhOptions::default(),
        &Limits::default(),
    )
    .unwrap();
    normalize(
        clip.clips.into_iter().next().unwrap(),
        &ImportOptions::default(),
    )
    .unwrap()
}

#[test]
fn indexes_to_start_from_open_and_are_small() {
    let mut methods = Vec::new();
    for entry in std::fs::read_dir(seeds("read_index")).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        assert!(bytes.len() < 16_384, "{} bytes", bytes.len());
        methods.push(MotionIndex::from_bytes(&bytes).unwrap().model.method());
    }
    methods.sort_unstable();
    assert_eq!(methods, ["svrdm", "templates", "templates"]);
}

#[test]
#[ignore = "writes fuzz/seeds"]
fn write_seeds_of_fuzzing() {
    let verified = small_templates(true);
    let Model::Templates(model) = &verified.model else {
        panic!("another method")
    };
    assert!(model.verifier.is_some());
    for (name, index) in [
        ("templates", small_templates(false)),
        ("verified", verified),
        ("svrdm", small_svrdm()),
    ] {
        seed("read_index", name, &index.to_bytes().unwrap());
    }
    let take = take();
    let clip = &take.clip;
    let mut written: Vec<(&str, Vec<u8>)> = Vec::new();
    let mut write = |target, by: &dyn Fn(&mut Vec<u8>) -> std::io::Result<()>| {
        let mut bytes = Vec::new();
        by(&mut bytes).unwrap();
        written.push((target, bytes));
    };
    write("read_c3d", &|out| c3d::write(clip, out));
    write("read_trc", &|out| trc::write(clip, out));
    write("read_jsonl", &|out| jsonl::write(clip, out));
    write("read_gltf", &|out| gltf::write(clip, out));
    write("read_numpy", &|out| write_npz(&take, out));
    write("read_table", &|out| {
        write_csv(&take, Content::Positions, out)
    });
    for (target, bytes) in written {
        seed(target, "wave", &bytes);
    }
    let stored = compress(clip, &SmoothParams::default(), &()).unwrap();
    seed("read_mclip", "wave", &stored.to_bytes());
}
