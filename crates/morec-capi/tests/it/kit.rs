//! The C library's handles in Rust's clothes, and what the tests feed it with.

use std::collections::BTreeMap;
use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::path::PathBuf;
use std::ptr::{null, null_mut};
use std::sync::OnceLock;

use morec::TimeSpan;
use morec::features::KeyPose;
use morec::index::{MotionIndex, Provenance};
use morec::live::Detection;
use morec::roles::Role;
use morec_capi::*;

pub use crate::made::performance as take;
use crate::made::{self, Timed};

/// An index file's bytes, of the model of all gestures.
pub fn index_bytes() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let provenance = Provenance::default();
        let index = MotionIndex {
            model: made::model().into(),
            roles: BTreeMap::new(),
            provenance,
        };
        index.to_bytes().unwrap()
    })
}

/// The same, as the library reads it.
pub fn index() -> &'static MotionIndex {
    static INDEX: OnceLock<MotionIndex> = OnceLock::new();
    INDEX.get_or_init(|| MotionIndex::from_bytes(index_bytes()).unwrap())
}

/// A small index that loads at once.
pub fn small_index() -> Vec<u8> {
    committed("v1.index")
}

/// One of the method of 2009.
pub fn svrdm_index() -> Vec<u8> {
    committed("svrdm_v1.index")
}

fn committed(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../morec/testdata/index");
    std::fs::read(PathBuf::from(folder).join(name)).unwrap()
}

/// The text of the last failure on this thread.
pub fn last_error() -> String {
    unsafe { CStr::from_ptr(morec_last_error()) }
        .to_str()
        .unwrap()
        .to_owned()
}

/// An index handle that is given back when it goes out of sight.
pub struct Index(pub *mut MorecIndex);

impl Index {
    pub fn new(bytes: &[u8]) -> Self {
        let mut handle = null_mut();
        let status = unsafe { morec_index_from_memory(bytes.as_ptr(), bytes.len(), &mut handle) };
        assert_eq!(status, MorecStatus::Ok, "{}", last_error());
        Self(handle)
    }
}

impl Drop for Index {
    fn drop(&mut self) {
        assert_eq!(morec_index_destroy(self.0), MorecStatus::Ok);
    }
}

/// A recogniser handle, likewise.
pub struct Recognizer(pub *mut MorecRecognizer);

impl Drop for Recognizer {
    fn drop(&mut self) {
        assert_eq!(morec_recognizer_destroy(self.0), MorecStatus::Ok);
    }
}

pub fn options() -> MorecOptions {
    let mut options: MorecOptions = unsafe { zeroed() };
    options.struct_size = size_of::<MorecOptions>();
    options.handedness = MorecHandedness::Right as i32;
    options
}

pub fn frame(time_secs: f64, positions: &[f64]) -> MorecFrame {
    MorecFrame {
        struct_size: size_of::<MorecFrame>(),
        time_secs,
        joint_count: positions.len() / 3,
        positions: positions.as_ptr(),
        rotations: null(),
        space: MorecSpace::World as i32,
        reserved: 0,
    }
}

/// A pose as a stream of roles has it.
pub fn positions(pose: &KeyPose) -> Vec<f64> {
    let of = |role| pose.get(role).map_or([f64::NAN; 3], |p| [p.x, p.y, p.z]);
    Role::BODY.into_iter().flat_map(of).collect()
}

impl Recognizer {
    pub fn new(index: &Index, options: &MorecOptions) -> Result<Self, MorecStatus> {
        let mut handle = null_mut();
        match unsafe { morec_recognizer_create(index.0, options, &mut handle) } {
            MorecStatus::Ok => Ok(Self(handle)),
            status => Err(status),
        }
    }

    pub fn push(&self, frame: &MorecFrame) -> MorecStatus {
        unsafe { morec_recognizer_push(self.0, frame) }
    }

    pub fn poll(&self, most: usize) -> Vec<MorecEvent> {
        let mut events: Vec<MorecEvent> = vec![unsafe { zeroed() }; most];
        let (size, mut count) = (size_of::<MorecEvent>(), usize::MAX);
        let status =
            unsafe { morec_recognizer_poll(self.0, events.as_mut_ptr(), size, most, &mut count) };
        assert_eq!(status, MorecStatus::Ok, "{}", last_error());
        events.truncate(count);
        events
    }

    /// Pushes everything, polls after every frame, finishes.
    pub fn run(&self, poses: &[Timed]) -> Vec<Detection> {
        let mut events = Vec::new();
        for (time_secs, pose) in poses {
            let positions = positions(pose);
            assert_eq!(
                self.push(&frame(*time_secs, &positions)),
                MorecStatus::Ok,
                "{}",
                last_error()
            );
            events.extend(self.poll(4));
        }
        assert_eq!(morec_recognizer_finish(self.0), MorecStatus::Ok);
        events.extend(self.poll(64));
        events
            .iter()
            .filter(|e| e.phase == MorecPhase::End as i32)
            .map(detection)
            .collect()
    }

    pub fn stats(&self) -> MorecStats {
        let mut stats: MorecStats = unsafe { zeroed() };
        stats.struct_size = size_of::<MorecStats>();
        assert_eq!(
            unsafe { morec_recognizer_stats(self.0, &mut stats) },
            MorecStatus::Ok
        );
        stats
    }
}

pub fn detection(event: &MorecEvent) -> Detection {
    Detection {
        class: morec::classes::ClassId(event.class_id as u16),
        span: TimeSpan::new(event.start_secs, event.stop_secs),
        score: event.score,
        reported_secs: event.reported_secs,
        repetitions: (event.repetitions > 0).then_some(morec::decode::Repetitions {
            count: event.repetitions,
            period_secs: event.period_secs,
        }),
    }
}
