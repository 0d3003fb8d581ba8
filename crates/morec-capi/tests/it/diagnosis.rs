//! Findings about a stream, reported to C.

use std::ffi::{CStr, c_char};
use std::mem::zeroed;

use morec_capi::*;

use crate::kit::{Index, Recognizer, frame, last_error, options, positions, small_index, take};
use crate::made;

fn diagnosis(recognizer: &Recognizer) -> MorecDiagnosis {
    let mut known: MorecDiagnosis = unsafe { zeroed() };
    known.struct_size = size_of::<MorecDiagnosis>();
    let status = unsafe { morec_recognizer_diagnosis(recognizer.0, &mut known) };
    assert_eq!(status, MorecStatus::Ok, "{}", last_error());
    known
}

/// Status, bytes needed, text.
fn text(recognizer: &Recognizer, room: usize) -> (MorecStatus, usize, String) {
    let (mut buffer, mut needed): (Vec<c_char>, usize) = (vec![1; room], 0);
    let status = unsafe {
        morec_recognizer_diagnosis_text(recognizer.0, buffer.as_mut_ptr(), room, &mut needed)
    };
    let text = unsafe { CStr::from_ptr(buffer.as_ptr()) };
    (status, needed, text.to_str().unwrap().to_owned())
}

#[test]
fn a_stream_upside_down_says_so_and_a_right_one_says_nothing() {
    let index = Index::new(&small_index());
    let (_, poses) = made::poses(&take(60.0));
    for turned in [false, true] {
        let recognizer = Recognizer::new(&index, &options()).unwrap();
        assert_eq!(
            (
                diagnosis(&recognizer).frames,
                diagnosis(&recognizer).findings
            ),
            (0, 0)
        );
        for (time_secs, pose) in &poses {
            let mut positions = positions(pose);
            if turned {
                positions
                    .chunks_exact_mut(3)
                    .for_each(|p| (p[1], p[2]) = (-p[1], -p[2]));
            }
            assert_eq!(
                recognizer.push(&frame(*time_secs, &positions)),
                MorecStatus::Ok
            );
            recognizer.poll(64);
        }
        let known = diagnosis(&recognizer);
        assert_eq!(known.frames, poses.len() as u64);
        assert!((0.6..1.1).contains(&known.leg_m), "{known:?}");
        let (status, needed, all) = text(&recognizer, 4096);
        assert_eq!((status, needed), (MorecStatus::Ok, all.len() + 1));
        if !turned {
            assert_eq!((known.findings, known.severity, all.as_str()), (0, 0, ""));
            continue;
        }
        assert_eq!(known.findings, MorecFinding::UpsideDown as u32);
        assert_eq!(known.severity, MorecSeverity::Error as i32);
        assert!(
            all.starts_with("error: the head is below the feet"),
            "{all}"
        );
        let (status, needed_again, cut) = text(&recognizer, 10);
        assert_eq!(
            (status, needed_again),
            (MorecStatus::BufferTooSmall, needed)
        );
        assert_eq!(cut, all[..9]);
    }
}

#[test]
fn a_diagnosis_of_no_size_is_refused() {
    let index = Index::new(&small_index());
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    let mut known: MorecDiagnosis = unsafe { zeroed() };
    let status = unsafe { morec_recognizer_diagnosis(recognizer.0, &mut known) };
    assert_eq!(status, MorecStatus::StructSize);
    let status = unsafe { morec_recognizer_diagnosis(std::ptr::null(), &mut known) };
    assert_ne!(status, MorecStatus::Ok);
}
