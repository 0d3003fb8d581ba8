//! Whatever is called in whatever order with whatever handles: a status, never a crash.

use std::ffi::c_char;
use std::ptr::{null, null_mut, without_provenance_mut};

use morec_capi::*;
use proptest::prelude::*;

use crate::calls::{Bones, Call, Eight, Shown, Which, call};
use crate::eight::{self, Files};
use crate::kit;

/// Every handle that was given, and which of them are alive.
#[derive(Default)]
struct Given {
    handles: Vec<usize>,
    indexes: Vec<usize>,
    recognizers: Vec<usize>,
}

impl Given {
    fn number(&self, which: &Which, something: &[u64; 8]) -> usize {
        match which {
            Which::Given(_) if self.handles.is_empty() => 0,
            Which::Given(nth) => self.handles[nth % self.handles.len()],
            Which::Null => 0,
            Which::OfSomethingElse => something.as_ptr().addr(),
            // Another test's handles are none of ours.
            Which::Number(number) if number % 2 == 1 && *number < 1 << 40 => number + 1,
            Which::Number(number) => *number,
        }
    }

    /// A call with a handle that is none never succeeds.
    fn judge(alive: &[usize], number: usize, status: MorecStatus) -> Result<(), TestCaseError> {
        let is_alive = alive.contains(&number);
        let blamed = matches!(status, MorecStatus::BadHandle)
            || (number == 0 && status == MorecStatus::NullPointer);
        if is_alive {
            prop_assert_ne!(status, MorecStatus::BadHandle);
        } else {
            // Other faults may be found first, but nothing may be done.
            prop_assert!(
                blamed || status != MorecStatus::Ok,
                "{:?} with {:#x}",
                status,
                number
            );
        }
        prop_assert_ne!(status, MorecStatus::Internal);
        Ok(())
    }
}

/// Room for structs of up to this size; sizes beyond it are none that the library believes.
#[repr(C, align(8))]
struct Room([u8; 5 * 1024]);

impl Room {
    /// With the size that its caller says it has.
    fn of_struct(size: usize) -> Box<Self> {
        let mut room = Box::new(Room([0; 5 * 1024]));
        room.0[..8].copy_from_slice(&size.to_ne_bytes());
        room
    }
}

fn run(calls: &[Call], files: &Files) -> Result<(), TestCaseError> {
    let bytes = kit::small_index();
    let something = [7u64; 8];
    let mut given = Given::default();
    // So that there is something to be in the way of.
    let none = Which::Null;
    let create = Call::Create {
        index: Which::Given(0),
        options: true,
        size: size_of::<MorecOptions>(),
        words: [1, 0, 0, 1],
        capacity: 0,
        secs: 0.0,
        skeleton: Bones::None,
    };
    for call in [
        Call::Load {
            bytes: usize::MAX,
            out: true,
        },
        create,
        Call::Finish(none),
    ]
    .iter()
    .chain(calls)
    {
        one(call, &bytes, &something, &mut given, files)?;
    }
    mrTerminate();
    for number in given.recognizers {
        prop_assert_eq!(
            morec_recognizer_destroy(without_provenance_mut(number)),
            MorecStatus::Ok
        );
    }
    for number in given.indexes {
        prop_assert_eq!(
            morec_index_destroy(without_provenance_mut(number)),
            MorecStatus::Ok
        );
    }
    Ok(())
}

fn one(
    call: &Call,
    bytes: &[u8],
    something: &[u64; 8],
    given: &mut Given,
    files: &Files,
) -> Result<(), TestCaseError> {
    let number = |which: &Which| given.number(which, something);
    match call {
        Call::Load { bytes: len, out } => {
            let (len, mut handle) = ((*len).min(bytes.len()), null_mut());
            let place = if *out { &raw mut handle } else { null_mut() };
            let status = unsafe { morec_index_from_memory(bytes.as_ptr(), len, place) };
            prop_assert_eq!(status == MorecStatus::Ok, *out && len == bytes.len());
            if status == MorecStatus::Ok {
                given.handles.push(handle.addr());
                given.indexes.push(handle.addr());
            }
        }
        Call::DestroyIndex(which) => {
            let number = number(which);
            let status = morec_index_destroy(without_provenance_mut(number));
            Given::judge(&given.indexes, number, status)?;
            given.indexes.retain(|alive| *alive != number);
        }
        Call::Facts(which, size, is_null) => {
            let number = number(which);
            let mut room = Room::of_struct(*size);
            let facts = if *is_null {
                null_mut()
            } else {
                room.0.as_mut_ptr().cast()
            };
            let status = unsafe { morec_index_facts(without_provenance_mut(number), facts) };
            Given::judge(&given.indexes, number, status)?;
        }
        Call::Name(which, class, size) => {
            let (number, mut buffer, mut needed) = (number(which), [1 as c_char; 48], 0);
            let buffer_at = buffer.as_mut_ptr();
            let status = unsafe {
                morec_index_class_name(
                    without_provenance_mut(number),
                    *class,
                    buffer_at,
                    *size,
                    &mut needed,
                )
            };
            Given::judge(&given.indexes, number, status)?;
            prop_assert!(buffer[*size..].iter().all(|c| *c == 1));
        }
        Call::Create {
            index,
            options,
            size,
            words,
            capacity,
            secs,
            skeleton,
        } => {
            let number = number(index);
            let c = MorecOptions {
                struct_size: *size,
                handedness: words[0],
                up_axis: words[1],
                skeleton: null(),
                roles: words[2] as u32,
                flags: words[3] as u32,
                event_capacity: *capacity,
                refractory_secs: *secs,
                sensitivity: *secs,
            };
            let status = with_skeleton(skeleton, |skeleton| {
                let mut room = Room::of_struct(*size);
                unsafe {
                    room.0
                        .as_mut_ptr()
                        .cast::<MorecOptions>()
                        .write(MorecOptions { skeleton, ..c })
                };
                let mut handle = null_mut();
                let options = if *options {
                    room.0.as_ptr().cast()
                } else {
                    null()
                };
                let status = unsafe {
                    morec_recognizer_create(without_provenance_mut(number), options, &mut handle)
                };
                (status, handle.addr())
            });
            Given::judge(&given.indexes, number, status.0)?;
            prop_assert_eq!(status.0 == MorecStatus::Ok, status.1 != 0);
            if status.0 == MorecStatus::Ok {
                given.handles.push(status.1);
                given.recognizers.push(status.1);
            }
        }
        Call::DestroyRecognizer(which) => {
            let number = number(which);
            let status = morec_recognizer_destroy(without_provenance_mut(number));
            Given::judge(&given.recognizers, number, status)?;
            given.recognizers.retain(|alive| *alive != number);
        }
        Call::Push { on, frame } => {
            let number = number(on);
            let status = push(number, frame);
            Given::judge(&given.recognizers, number, status)?;
        }
        Call::Poll {
            on,
            capacity,
            size,
            count,
        } => {
            let number = number(on);
            let mut room = Box::new(Room([0xEE; 5 * 1024]));
            let (mut taken, places) = (usize::MAX, room.0.as_mut_ptr().cast());
            let count = if *count { &raw mut taken } else { null_mut() };
            let handle = without_provenance_mut(number);
            let status = unsafe { morec_recognizer_poll(handle, places, *size, *capacity, count) };
            Given::judge(&given.recognizers, number, status)?;
            prop_assert!(count.is_null() || taken <= *capacity);
            let written = size.saturating_mul(*capacity).min(room.0.len());
            prop_assert!(room.0[written..].iter().all(|byte| *byte == 0xEE));
        }
        Call::Finish(which) => {
            let number = number(which);
            Given::judge(
                &given.recognizers,
                number,
                morec_recognizer_finish(without_provenance_mut(number)),
            )?;
        }
        Call::Reset(which) => {
            let number = number(which);
            Given::judge(
                &given.recognizers,
                number,
                morec_recognizer_reset(without_provenance_mut(number)),
            )?;
        }
        Call::Stats(which, size) => {
            let number = number(which);
            let mut room = Room::of_struct(*size);
            let stats = room.0.as_mut_ptr().cast();
            let status = unsafe { morec_recognizer_stats(without_provenance_mut(number), stats) };
            Given::judge(&given.recognizers, number, status)?;
        }
        Call::JointOfRole(which, role) => {
            let (number, mut joint) = (number(which), 0);
            let handle = without_provenance_mut(number);
            let status = unsafe { morec_recognizer_joint_of_role(handle, *role, &mut joint) };
            Given::judge(&given.recognizers, number, status)?;
        }
        Call::Eight(call) => eight_call(*call, files)?,
    }
    Ok(())
}

fn with_skeleton<T>(bones: &Bones, then: impl FnOnce(*const MorecSkeleton) -> T) -> T {
    let Bones::Chain {
        joints,
        parent_step,
        names,
        offsets,
        roles,
    } = bones
    else {
        return then(null());
    };
    let count = *joints;
    let parents: Vec<i32> = (0..count as i32)
        .map(|j| j - 1 + parent_step * i32::from(j == 9))
        .collect();
    let name = c"Left Arm".as_ptr();
    let (names_given, offsets_given) = (vec![name; count], vec![offsets.unwrap_or(0.0); 3 * count]);
    let roles_given: Vec<i32> = (0..count as i32)
        .map(|j| if j < 18 { j } else { -1 })
        .collect();
    let skeleton = MorecSkeleton {
        struct_size: size_of::<MorecSkeleton>(),
        joint_count: count,
        parents: parents.as_ptr(),
        names: if *names { names_given.as_ptr() } else { null() },
        offsets: if offsets.is_some() {
            offsets_given.as_ptr()
        } else {
            null()
        },
        roles: if *roles { roles_given.as_ptr() } else { null() },
    };
    then(&skeleton)
}

fn push(handle: usize, shown: &Shown) -> MorecStatus {
    let spread = |value: f64| move |i: usize| value * (1.0 + i as f64 * 0.37 % 1.0);
    let values = |value: Option<f64>, each: usize| -> Option<Vec<f64>> {
        value.map(|value| (0..each * shown.joints).map(spread(value)).collect())
    };
    let (positions, rotations) = (values(shown.value, 3), values(shown.turned, 4));
    let frame = MorecFrame {
        struct_size: shown.size,
        time_secs: shown.time_secs,
        joint_count: shown.joints,
        positions: positions.as_ref().map_or(null(), |v| v.as_ptr()),
        rotations: rotations.as_ref().map_or(null(), |v| v.as_ptr()),
        space: shown.space,
        reserved: 0,
    };
    let mut room = Room::of_struct(shown.size);
    unsafe { room.0.as_mut_ptr().cast::<MorecFrame>().write(frame) };
    let frame = if shown.is_null {
        null()
    } else {
        room.0.as_ptr().cast()
    };
    unsafe { morec_recognizer_push(without_provenance_mut(handle), frame) }
}

fn eight_call(call: Eight, files: &Files) -> Result<(), TestCaseError> {
    match call {
        Eight::Init(which) => {
            let path = [
                files.index.as_ptr(),
                files.index.as_ptr(),
                files.clip.as_ptr(),
                null(),
            ][which as usize];
            unsafe { mrInit(path) };
        }
        Eight::SetDataSource(which) => {
            let clip = files.clip.as_ptr();
            let path = [clip, clip, clip, files.index.as_ptr(), null()][which as usize];
            unsafe { mrSetDataSource(path) };
        }
        Eight::Speed(speed) => prop_assert_eq!(mrSetDataSourceSpeed(speed), speed > 0.0),
        Eight::StopDataSource => _ = mrStopDataSource(),
        Eight::IsDepleted => _ = mrIsDataSourceDepleted(),
        Eight::Start => _ = mrStart(),
        Eight::Stop => _ = mrStop(),
        Eight::Query(n, segments, count) => {
            let mut places: [MotionSeg; 4] = unsafe { std::mem::zeroed() };
            // More than there is room for is the caller's lie, and not to be seen through.
            let mut n = if segments { n.min(4) } else { n };
            let segments = if segments {
                places.as_mut_ptr()
            } else {
                null_mut()
            };
            let done =
                unsafe { mrQueryMotionSegments(segments, if count { &mut n } else { null_mut() }) };
            prop_assert!(!done || n >= 0);
        }
        Eight::Terminate => mrTerminate(),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, ..ProptestConfig::default() })]

    #[test]
    fn any_calls_in_any_order_do_no_harm(calls in prop::collection::vec(call(), 1..60)) {
        let (_turn, files) = eight::turn();
        run(&calls, files)?;
    }
}
