//! Folders with something in them that cannot be read.

use std::fs;
use std::path::PathBuf;

use crate::kit::{ARM_ASF, Folder, WAVE_AMC, WAVE_BVH};

/// A folder of clips with one below whose path is longer than the system takes: nobody can list it, the
/// administrator neither, for whom permissions mean nothing.
fn with_an_unreadable_folder() -> (Folder, PathBuf) {
    const LONGEST: usize = 200;
    let folder = Folder::with(&[
        ("clips/wave.bvh", WAVE_BVH),
        ("clips/below/arm.asf", ARM_ASF),
        ("clips/below/swing.amc", WAVE_AMC),
    ]);
    let chain = |parts: usize| -> PathBuf { (0..parts).map(|_| "d".repeat(LONGEST)).collect() };
    // Two chains that may be made, one put into the other.
    let (outer, inner) = (folder.path().join("clips/deep"), folder.path().join("x"));
    let outer_end = outer.join(chain(3900 / LONGEST - 1));
    let inner_end = inner.join(chain(3900 / LONGEST - 1));
    fs::create_dir_all(&outer_end).unwrap();
    fs::create_dir_all(&inner_end).unwrap();
    fs::write(inner_end.join("lost.bvh"), WAVE_BVH).unwrap();
    fs::rename(inner, outer_end.join("x")).unwrap();
    (folder, outer)
}

#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_read_is_left_out_alone_and_said() {
    let (folder, deep) = with_an_unreadable_folder();
    let imported = folder.morec(&["db", "import", "x.mdb", "clips"]);
    assert_eq!(imported.code, Some(1), "{imported:?}");
    assert!(imported.out.contains("2 files imported"), "{imported:?}");
    let shown = deep.file_name().unwrap().to_string_lossy().into_owned();
    let is_said = |err: &str| {
        err.lines()
            .any(|line| line.contains(&shown) && line.contains("left out: File name too long"))
    };
    assert!(is_said(&imported.err), "{imported:?}");
    let inspected = folder.morec(&["inspect", "clips"]);
    assert_eq!(inspected.code, Some(1), "{inspected:?}");
    assert!(is_said(&inspected.err), "{inspected:?}");
    // Commands that go on with what there is say it, too.
    let page = folder.morec(&["play", "clips", "-o", "page.html"]);
    assert_eq!(page.code, Some(0), "{page:?}");
    assert!(is_said(&page.err), "{page:?}");
}
