//! The eight calls, in their order and out of it.

use std::ffi::{CStr, CString};
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};
use morec::import::{ImportOptions, normalize};
use morec::live::{Detection, recognize_clip};
use morec_capi::*;

use crate::kit::{self, last_error};

/// Files that the tests give to the library by path.
pub struct Files {
    /// Holds what the others name; where Cargo keeps such things, used again by every run.
    pub folder: PathBuf,
    /// An index of all gestures.
    pub index: CString,
    /// A clip of two gestures.
    pub clip: CString,
}

impl Files {
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

/// The process has one session: who tests it waits for its turn, and finds it terminated.
pub fn turn() -> (MutexGuard<'static, ()>, &'static Files) {
    static TURN: Mutex<()> = Mutex::new(());
    let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    mrTerminate();
    (turn, files())
}

pub fn files() -> &'static Files {
    static FILES: OnceLock<Files> = OnceLock::new();
    FILES.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("morec-capi");
        std::fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| CString::new(folder.join(name).to_str().unwrap()).unwrap();
        let (index, clip) = (path("gestures.index"), path("performance.bvh"));
        std::fs::write(folder.join("gestures.index"), kit::index_bytes()).unwrap();
        let mut bvh = Vec::new();
        bvh::write(&kit::take(60.0).clip, &mut bvh).unwrap();
        std::fs::write(folder.join("performance.bvh"), bvh).unwrap();
        Files {
            folder,
            index,
            clip,
        }
    })
}

/// Detections of the recogniser itself in the clip's file.
pub fn expected() -> Vec<Detection> {
    let bytes = std::fs::read(Path::new(files().clip.to_str().unwrap())).unwrap();
    let loaded = bvh::read(&bytes, "clip", &BvhOptions::default(), &Limits::default()).unwrap();
    let clip = loaded.clips.into_iter().next().unwrap();
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    let rest = &imported.report.rest_frames;
    recognize_clip(&kit::index().model, &imported.clip, &imported.roles, rest).unwrap()
}

fn query(most: usize) -> Vec<MotionSeg> {
    let mut segments: Vec<MotionSeg> = vec![unsafe { std::mem::zeroed() }; most];
    let mut count = most as i32;
    assert!(
        unsafe { mrQueryMotionSegments(segments.as_mut_ptr(), &mut count) },
        "{}",
        last_error()
    );
    segments.truncate(count as usize);
    segments
}

fn begin(files: &Files, speed: f64) {
    assert!(unsafe { mrInit(files.index.as_ptr()) }, "{}", last_error());
    assert!(mrSetDataSourceSpeed(speed));
    assert!(
        unsafe { mrSetDataSource(files.clip.as_ptr()) },
        "{}",
        last_error()
    );
    assert!(mrStart(), "{}", last_error());
}

#[test]
fn the_solution_is_what_the_recogniser_finds() {
    let (_turn, files) = turn();
    let expected = expected();
    assert_eq!(expected.len(), 2);
    begin(files, f64::INFINITY);
    while !mrIsDataSourceDepleted() {
        query(8);
    }
    assert!(mrStopDataSource() && mrStop(), "{}", last_error());
    let solution = query(8);
    assert_eq!(solution.len(), expected.len());
    for ((segment, expected), number) in solution.iter().zip(&expected).zip(1..) {
        assert_eq!(
            (segment.start_secs, segment.stop_secs),
            (expected.span.start_secs, expected.span.stop_secs)
        );
        assert_eq!(
            (segment.confidence, segment.number),
            (expected.score, number)
        );
        assert_eq!(
            segment.stop_frame,
            (expected.span.stop_secs * 60.0).round() as u32
        );
        let name = unsafe { CStr::from_ptr(segment.class_name.as_ptr()) }
            .to_str()
            .unwrap();
        assert_eq!(name, kit::index().model.class_name(expected.class));
        assert_eq!(name.len(), segment.class_name_bytes as usize);
    }
    // It stays; of a part of it, the last are given.
    assert_eq!(query(8), solution);
    assert_eq!(query(1), solution[1..]);
    assert_eq!(query(0), []);
    let mut count = -5;
    assert!(unsafe { mrQueryMotionSegments(null_mut(), &mut 0) });
    assert!(!unsafe { mrQueryMotionSegments(null_mut(), &mut count) });
    assert!(!unsafe { mrQueryMotionSegments(null_mut(), null_mut()) });
    mrTerminate();
    assert!(!unsafe { mrQueryMotionSegments(null_mut(), &mut 0) });
}

#[test]
fn a_wrong_order_is_refused_and_harms_nothing() {
    let (_turn, files) = turn();
    let (index, clip) = (files.index.as_ptr(), files.clip.as_ptr());
    assert!(!mrStart() && !mrStop() && !mrStopDataSource() && mrIsDataSourceDepleted());
    assert!(!unsafe { mrSetDataSource(clip) });
    assert!(last_error().contains("mrInit"), "{}", last_error());
    assert!(!unsafe { mrInit(clip) }, "a clip is no index");
    assert!(unsafe { mrInit(index) });
    assert!(!unsafe { mrInit(index) });
    assert!(!mrStart());
    assert!(last_error().contains("mrSetDataSource"), "{}", last_error());
    assert!(!unsafe { mrSetDataSource(index) }, "an index is no clip");
    assert!(!unsafe { mrSetDataSource(c"nowhere.bvh".as_ptr()) });
    assert!(mrSetDataSourceSpeed(f64::INFINITY));
    for wrong in [0.0, -1.0, f64::NAN] {
        assert!(!mrSetDataSourceSpeed(wrong));
    }
    assert!(unsafe { mrSetDataSource(clip) });
    assert!(!unsafe { mrSetDataSource(clip) });
    assert!(!mrIsDataSourceDepleted() && !mrStop());
    assert!(mrStart() && !mrStart());
    while !mrIsDataSourceDepleted() {}
    assert!(mrStopDataSource() && !mrStopDataSource());
    assert!(
        !unsafe { mrSetDataSource(clip) },
        "recognition of the other goes on"
    );
    assert!(mrStop() && !mrStop());
    assert_eq!(query(9).len(), 2);
    // And once more, with the same index.
    assert!(unsafe { mrSetDataSource(clip) } && mrStart());
    assert!(mrStop(), "also without stopping the source first");
    assert!(query(9).len() <= 2);
    assert!(mrStart(), "a source that was not stopped begins anew");
    while !mrIsDataSourceDepleted() {}
    assert!(mrStop());
    assert_eq!(query(9).len(), 2);
    mrTerminate();
    mrTerminate();
}

#[test]
fn a_slow_source_can_be_stopped_at_once_and_made_faster() {
    let (_turn, files) = turn();
    begin(files, 1e-300);
    assert!(!mrIsDataSourceDepleted());
    assert!(mrStopDataSource() && mrIsDataSourceDepleted() && mrStop());
    assert_eq!(query(9), []);
    mrTerminate();
    begin(files, 0.01);
    assert!(mrSetDataSourceSpeed(f64::INFINITY));
    while !mrIsDataSourceDepleted() {}
    assert!(mrStopDataSource() && mrStop());
    assert_eq!(query(9).len(), 2);
    mrTerminate();
    begin(files, 1e-3);
    // What goes on when the library is terminated, ends.
    mrTerminate();
}

#[test]
fn an_amc_finds_its_skeleton_and_a_source_without_a_body_is_refused() {
    let (_turn, files) = turn();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mocap/testdata/acclaim");
    let (with, without) = (files.path("with"), files.path("without"));
    for folder in [&with, &without] {
        std::fs::create_dir_all(folder).unwrap();
        std::fs::copy(data.join("wave.amc"), folder.join("wave.amc")).unwrap();
    }
    std::fs::copy(data.join("arm.asf"), with.join("wave.asf")).unwrap();
    std::fs::copy(data.join("arm.asf"), with.join("another.asf")).unwrap();
    let source = |folder: &Path, name: &str| {
        let path = CString::new(folder.join(name).to_str().unwrap()).unwrap();
        unsafe { mrSetDataSource(path.as_ptr()) }
    };
    assert!(unsafe { mrInit(files.index.as_ptr()) });
    assert!(!source(&without, "wave.amc"));
    assert!(last_error().contains("ASF skeleton"), "{}", last_error());
    assert!(!source(&with, "wave.asf"));
    assert!(last_error().contains("name the AMC"), "{}", last_error());
    assert!(source(&with, "wave.amc"), "{}", last_error());
    // One arm is nobody.
    assert!(!mrStart());
    assert!(
        last_error().contains("no bone that the index uses"),
        "{}",
        last_error()
    );
    mrTerminate();
}
