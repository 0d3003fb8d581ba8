//! Every fault a caller can make is answered with a status, and changes nothing.

use std::ffi::{CStr, CString, c_char};
use std::ptr::{null, null_mut, without_provenance_mut};

use morec_capi::*;

use crate::kit::{self, Index, Recognizer, frame, last_error, options, positions};
use crate::made;

fn name_of(index: &Index, class: u32, size: usize) -> (MorecStatus, String, usize) {
    let mut buffer = [0x55 as c_char; 80];
    let mut needed = 0;
    let status =
        unsafe { morec_index_class_name(index.0, class, buffer.as_mut_ptr(), size, &mut needed) };
    assert!(
        buffer[size..].iter().all(|c| *c == 0x55),
        "written beyond the buffer"
    );
    let written = size > 0 && status != MorecStatus::InvalidValue;
    let text = if written {
        unsafe { CStr::from_ptr(buffer.as_ptr()) }.to_str().unwrap()
    } else {
        ""
    };
    (status, text.to_owned(), needed)
}

#[test]
fn facts_name_the_method_to_those_who_have_room_for_it() {
    let index = Index::new(&kit::svrdm_index());
    let mut facts: MorecIndexFacts = unsafe { std::mem::zeroed() };
    facts.struct_size = size_of::<MorecIndexFacts>();
    assert_eq!(
        unsafe { morec_index_facts(index.0, &mut facts) },
        MorecStatus::Ok
    );
    assert_eq!(
        (facts.method, facts.needs_rotations),
        (MorecMethod::Svrdm as i32, 1)
    );
    // Of the first version, which ended before it.
    (facts.method, facts.needs_rotations, facts.class_count) = (77, 78, 0);
    facts.struct_size = std::mem::offset_of!(MorecIndexFacts, method);
    assert_eq!(
        unsafe { morec_index_facts(index.0, &mut facts) },
        MorecStatus::Ok
    );
    assert_eq!((facts.method, facts.needs_rotations), (77, 78));
    assert!(facts.class_count > 0);
    facts.struct_size -= 1;
    assert_eq!(
        unsafe { morec_index_facts(index.0, &mut facts) },
        MorecStatus::StructSize
    );
}

#[test]
fn facts_and_names_are_those_of_the_index() {
    let index = Index::new(kit::index_bytes());
    let mut facts: MorecIndexFacts = unsafe { std::mem::zeroed() };
    facts.struct_size = size_of::<MorecIndexFacts>();
    assert_eq!(
        unsafe { morec_index_facts(index.0, &mut facts) },
        MorecStatus::Ok
    );
    let model = &kit::index().model;
    assert_eq!(facts.class_count as usize, model.classes().len());
    assert_eq!(
        facts.sample_count as usize,
        model.classes().iter().map(|c| c.samples).sum::<usize>()
    );
    assert_eq!(facts.struct_size, size_of::<MorecIndexFacts>());
    assert_eq!(
        (facts.method, facts.needs_rotations),
        (MorecMethod::Templates as i32, 0)
    );
    for (number, class) in model.classes().iter().enumerate() {
        let (status, name, needed) = name_of(&index, number as u32, 80);
        assert_eq!((status, needed), (MorecStatus::Ok, class.name.len() + 1));
        assert_eq!(name, class.name);
        let (status, name, needed) = name_of(&index, number as u32, 3);
        assert_eq!(
            (status, needed),
            (MorecStatus::BufferTooSmall, class.name.len() + 1)
        );
        assert_eq!(name, class.name[..2]);
        assert_eq!(
            name_of(&index, number as u32, 0).0,
            MorecStatus::BufferTooSmall
        );
    }
    assert_eq!(
        name_of(&index, facts.class_count, 80).0,
        MorecStatus::InvalidValue
    );
    assert!(last_error().contains("numbered from 0"), "{}", last_error());
}

#[test]
fn bytes_that_are_no_index_are_refused() {
    let good = kit::small_index();
    let load = |bytes: &[u8]| {
        let mut handle = without_provenance_mut(77);
        let status = unsafe { morec_index_from_memory(bytes.as_ptr(), bytes.len(), &mut handle) };
        assert!(handle.is_null() != (status == MorecStatus::Ok));
        (status, handle)
    };
    let mut bent = good.clone();
    *bent.last_mut().unwrap() ^= 1;
    for bad in [
        &good[..0],
        &good[..8],
        &good[..good.len() - 1],
        b"HIERARCHY",
        &bent,
    ] {
        assert_eq!(load(bad).0, MorecStatus::BadIndex);
        assert!(!last_error().is_empty());
    }
    let (status, handle) = load(&good);
    assert_eq!(status, MorecStatus::Ok);
    assert_eq!(morec_index_destroy(handle), MorecStatus::Ok);
    assert_eq!(
        unsafe { morec_index_from_memory(null(), 10, &mut null_mut()) },
        MorecStatus::NullPointer
    );
    assert_eq!(
        unsafe { morec_index_from_memory(good.as_ptr(), good.len(), null_mut()) },
        MorecStatus::NullPointer
    );
    assert_eq!(
        unsafe { morec_index_load(c"no such file".as_ptr(), &mut null_mut()) },
        MorecStatus::File
    );
    assert!(
        last_error().starts_with("no such file: "),
        "{}",
        last_error()
    );
    assert_eq!(
        unsafe { morec_index_load(c"\xff".as_ptr(), &mut null_mut()) },
        MorecStatus::InvalidValue
    );
}

#[test]
fn foreign_destroyed_and_exchanged_handles_are_refused() {
    let index = Index::new(&kit::small_index());
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    let gone = Recognizer::new(&index, &options()).unwrap();
    let gone_handle = gone.0;
    drop(gone);
    let mut not_a_handle = [0u64; 4];
    let foreign = [
        (null_mut(), MorecStatus::NullPointer),
        (gone_handle, MorecStatus::BadHandle),
        (index.0.cast(), MorecStatus::BadHandle),
        (not_a_handle.as_mut_ptr().cast(), MorecStatus::BadHandle),
        (without_provenance_mut(1), MorecStatus::BadHandle),
        (without_provenance_mut(usize::MAX), MorecStatus::BadHandle),
    ];
    let pose = [0.5; 54];
    for (handle, expected) in foreign {
        assert_eq!(
            unsafe { morec_recognizer_push(handle, &frame(0.0, &pose)) },
            expected
        );
        assert_eq!(
            unsafe { morec_recognizer_poll(handle, null_mut(), 72, 0, &mut 0) },
            expected
        );
        assert_eq!(morec_recognizer_finish(handle), expected);
        assert_eq!(morec_recognizer_reset(handle), expected);
        assert_eq!(morec_recognizer_destroy(handle), expected);
        assert_eq!(
            unsafe { morec_recognizer_joint_of_role(handle, 0, &mut 0) },
            expected
        );
    }
    assert_eq!(
        morec_index_destroy(recognizer.0.cast()),
        MorecStatus::BadHandle
    );
    assert!(
        last_error().contains("not belong to an index"),
        "{}",
        last_error()
    );
    assert_eq!(recognizer.push(&frame(0.0, &pose)), MorecStatus::Ok);
    // An index may go before the recognisers that were made of it.
    drop(index);
    assert_eq!(recognizer.push(&frame(0.1, &pose)), MorecStatus::Ok);
}

#[test]
fn frames_that_cannot_be_are_refused_and_change_nothing() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let expected = Recognizer::new(&index, &options()).unwrap().run(&poses);
    assert_eq!(expected.len(), 2);
    let disturbed = Recognizer::new(&index, &options()).unwrap();
    let mut events = Vec::new();
    for (time_secs, pose) in &poses {
        let good = positions(pose);
        let with = |change: &dyn Fn(&mut MorecFrame)| {
            let mut bad = frame(*time_secs, &good);
            change(&mut bad);
            disturbed.push(&bad)
        };
        assert_eq!(with(&|f| f.time_secs = f64::NAN), MorecStatus::InvalidValue);
        assert_eq!(
            with(&|f| f.time_secs = f64::INFINITY),
            MorecStatus::InvalidValue
        );
        assert_eq!(with(&|f| f.struct_size = 0), MorecStatus::StructSize);
        assert_eq!(
            with(&|f| f.struct_size = usize::MAX),
            MorecStatus::StructSize
        );
        assert_eq!(with(&|f| f.joint_count = 17), MorecStatus::InvalidValue);
        assert_eq!(
            with(&|f| f.joint_count = usize::MAX),
            MorecStatus::InvalidValue
        );
        assert_eq!(with(&|f| f.positions = null()), MorecStatus::InvalidValue);
        assert_eq!(
            with(&|f| f.positions = f.positions.wrapping_byte_add(1)),
            MorecStatus::InvalidValue
        );
        assert_eq!(with(&|f| f.space = 0), MorecStatus::InvalidValue);
        assert_eq!(with(&|f| f.space = 9), MorecStatus::InvalidValue);
        assert_eq!(
            with(&|f| f.space = MorecSpace::Local as i32),
            MorecStatus::InvalidValue
        );
        assert_eq!(with(&|f| f.reserved = 1), MorecStatus::InvalidValue);
        assert_eq!(
            unsafe { morec_recognizer_push(disturbed.0, null()) },
            MorecStatus::NullPointer
        );
        for bad in [f64::INFINITY, 1e300] {
            let mut nowhere = good.clone();
            nowhere[7] = bad;
            assert_eq!(
                disturbed.push(&frame(*time_secs, &nowhere)),
                MorecStatus::InvalidValue
            );
        }
        assert_eq!(
            disturbed.push(&frame(*time_secs, &[f64::NAN; 54])),
            MorecStatus::InvalidValue
        );
        assert_eq!(with(&|_| {}), MorecStatus::Ok);
        events.extend(disturbed.poll(8));
    }
    assert_eq!(morec_recognizer_finish(disturbed.0), MorecStatus::Ok);
    events.extend(disturbed.poll(8));
    assert_eq!(
        events.iter().map(kit::detection).collect::<Vec<_>>(),
        expected
    );
    assert_eq!(disturbed.stats().frames, poses.len() as u64);
}

#[test]
fn a_joint_that_is_not_seen_at_first_counts_from_when_it_is() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    let expected = recognizer.run(&poses);
    let mut hidden = poses.clone();
    for (_, pose) in &mut hidden[..3] {
        pose.set(
            morec::roles::Role::RightHand,
            morec::math::Vec3::repeat(f64::NAN),
        );
    }
    assert_eq!(morec_recognizer_reset(recognizer.0), MorecStatus::Ok);
    let found = recognizer.run(&hidden);
    assert_eq!(found.len(), expected.len());
    // The second motion is seen as if nothing had been: the hand is compared again.
    assert_eq!(found[1], expected[1]);
}

#[test]
fn options_that_cannot_be_are_refused() {
    let index = Index::new(&kit::small_index());
    let status = |change: &dyn Fn(&mut MorecOptions)| {
        let mut options = options();
        change(&mut options);
        Recognizer::new(&index, &options)
            .map(|_| ())
            .err()
            .unwrap_or(MorecStatus::Ok)
    };
    assert_eq!(status(&|_| {}), MorecStatus::Ok);
    assert_eq!(status(&|o| o.handedness = 0), MorecStatus::InvalidValue);
    assert_eq!(status(&|o| o.up_axis = 2), MorecStatus::InvalidValue);
    assert_eq!(status(&|o| o.flags = 64), MorecStatus::InvalidValue);
    assert_eq!(
        status(&|o| o.flags = MOREC_PERFORMER_ANYONE | MOREC_PERFORMER_TEACHER),
        MorecStatus::InvalidValue
    );
    assert_eq!(
        status(&|o| o.flags = MOREC_PERFORMER_TEACHER),
        MorecStatus::Ok
    );
    assert_eq!(status(&|o| o.roles = 1 << 18), MorecStatus::InvalidValue);
    assert_eq!(status(&|o| o.roles = 1), MorecStatus::NothingInCommon);
    assert_eq!(status(&|o| o.event_capacity = 5), MorecStatus::InvalidValue);
    assert_eq!(
        status(&|o| o.event_capacity = usize::MAX),
        MorecStatus::InvalidValue
    );
    assert_eq!(
        status(&|o| o.refractory_secs = f64::NAN),
        MorecStatus::InvalidValue
    );
    // Smaller than the first version of the struct, which ended before `sensitivity`; that one is still taken.
    assert_eq!(status(&|o| o.struct_size = 47), MorecStatus::StructSize);
    assert_eq!(status(&|o| o.struct_size = 48), MorecStatus::Ok);
    assert_eq!(status(&|o| o.sensitivity = -1.0), MorecStatus::InvalidValue);
    let skeleton = |joint_count, parents: &[i32]| {
        let skeleton = MorecSkeleton {
            struct_size: size_of::<MorecSkeleton>(),
            joint_count,
            parents: parents.as_ptr(),
            names: null(),
            offsets: null(),
            roles: null(),
        };
        status(&|o| o.skeleton = &skeleton)
    };
    assert_eq!(skeleton(0, &[]), MorecStatus::InvalidValue);
    assert_eq!(skeleton(5000, &[]), MorecStatus::InvalidValue);
    assert_eq!(skeleton(2, &[-1, 1]), MorecStatus::InvalidValue);
    assert_eq!(skeleton(2, &[-1, 0]), MorecStatus::NothingInCommon);
    // Points of a hand, by their names and by their numbers, are of another kind of performer.
    let (parents, points) = ([-1; 21], &morec::roles::Role::ALL[39..60]);
    let names = points.iter().map(|role| CString::new(role.name()).unwrap());
    let names: Vec<CString> = names.collect();
    let texts: Vec<_> = names.iter().map(|name| name.as_ptr()).collect();
    let roles: Vec<i32> = (39..60).collect();
    for (names, roles) in [(texts.as_ptr(), null()), (null(), roles.as_ptr())] {
        let skeleton = MorecSkeleton {
            struct_size: size_of::<MorecSkeleton>(),
            joint_count: 21,
            parents: parents.as_ptr(),
            names,
            offsets: null(),
            roles,
        };
        assert_eq!(
            status(&|o| o.skeleton = &skeleton),
            MorecStatus::NothingInCommon
        );
        let said = last_error();
        assert!(
            said.contains("this index recognises a body, but the input shows a hand"),
            "{said}"
        );
    }
}

#[test]
fn a_newer_callers_struct_is_taken_as_long_as_it_asks_nothing_new() {
    #[repr(C)]
    struct Newer {
        known: MorecOptions,
        new: [u64; 2],
    }
    let index = Index::new(&kit::small_index());
    let mut newer = Newer {
        known: options(),
        new: [0, 0],
    };
    newer.known.struct_size = size_of::<Newer>();
    let create = |newer: &Newer| {
        let mut handle = null_mut();
        let status =
            unsafe { morec_recognizer_create(index.0, (&raw const *newer).cast(), &mut handle) };
        if status == MorecStatus::Ok {
            assert_eq!(morec_recognizer_destroy(handle), MorecStatus::Ok);
        }
        status
    };
    assert_eq!(create(&newer), MorecStatus::Ok);
    newer.new[1] = 1;
    assert_eq!(create(&newer), MorecStatus::StructSize);
}

#[test]
fn no_event_is_lost_if_nobody_polls() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let mut options = options();
    (options.event_capacity, options.flags) = (128, MOREC_TENTATIVE);
    let recognizer = Recognizer::new(&index, &options).unwrap();
    let (mut events, mut refused) = (Vec::new(), 0);
    for lap in 0..20 {
        for (time_secs, pose) in &poses {
            let positions = positions(pose);
            let frame = frame(time_secs + 20.0 * f64::from(lap), &positions);
            let mut status = recognizer.push(&frame);
            if status == MorecStatus::QueueFull {
                refused += 1;
                assert!(last_error().contains("poll events"), "{}", last_error());
                events.extend(recognizer.poll(1000));
                status = recognizer.push(&frame);
            }
            assert_eq!(status, MorecStatus::Ok);
        }
    }
    while morec_recognizer_finish(recognizer.0) == MorecStatus::QueueFull {
        refused += 1;
        events.extend(recognizer.poll(1000));
    }
    events.extend(recognizer.poll(1000));
    let stats = recognizer.stats();
    assert!(refused > 0 && stats.refused_frames == refused, "{stats:?}");
    assert_eq!((stats.lost_events, stats.events), (0, events.len() as u64));
    let numbers: Vec<u64> = events.iter().map(|e| e.sequence).collect();
    assert_eq!(numbers, (1..=events.len() as u64).collect::<Vec<_>>());
    assert_eq!(
        events
            .iter()
            .filter(|e| e.phase == MorecPhase::End as i32)
            .count(),
        40
    );
}

#[test]
fn polling_takes_what_fits_and_writes_no_farther() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    for (time_secs, pose) in &poses {
        assert_eq!(
            recognizer.push(&frame(*time_secs, &positions(pose))),
            MorecStatus::Ok
        );
    }
    assert_eq!(morec_recognizer_finish(recognizer.0), MorecStatus::Ok);
    let poll = |events: *mut MorecEvent, size, capacity| {
        let mut count = usize::MAX;
        let status =
            unsafe { morec_recognizer_poll(recognizer.0, events, size, capacity, &mut count) };
        (status, count)
    };
    let of = size_of::<MorecEvent>();
    assert_eq!(poll(null_mut(), of, 0), (MorecStatus::BufferTooSmall, 0));
    assert_eq!(poll(null_mut(), of, 1), (MorecStatus::NullPointer, 0));
    // As an older and as a newer release would have it; the newer's further fields are 0.
    let mut places = [0xEEu8; 300];
    let first = places.as_mut_ptr().cast::<MorecEvent>();
    let first = first.wrapping_byte_add(first.align_offset(8));
    let first_of = std::mem::offset_of!(MorecEvent, repetitions);
    assert_eq!(poll(first, first_of - 8, 1), (MorecStatus::StructSize, 0));
    assert_eq!(poll(first, of + 4, 1), (MorecStatus::StructSize, 0));
    assert_eq!(
        poll(first.wrapping_byte_add(1), of, 1),
        (MorecStatus::InvalidValue, 0)
    );
    assert_eq!(
        poll(first, of, usize::MAX / 8),
        (MorecStatus::InvalidValue, 0)
    );
    assert_eq!(poll(first, of + 16, 1), (MorecStatus::Ok, 1));
    let start = first.addr() - places.as_ptr().addr();
    assert_eq!(places[start + of..start + of + 16], [0; 16]);
    assert!(
        places[start + of + 16..].iter().all(|byte| *byte == 0xEE),
        "written beyond the buffer"
    );
    assert_eq!(poll(first, of, 1).1, 1);
    assert_eq!(poll(first, of, 1), (MorecStatus::Ok, 0));
    assert_eq!(poll(null_mut(), of, 0), (MorecStatus::Ok, 0));
}

#[test]
fn reset_makes_it_new() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    let expected = recognizer.run(&poses);
    for half in [0, poses.len() / 3, poses.len() / 2] {
        for (time_secs, pose) in &poses[..half] {
            assert_eq!(
                recognizer.push(&frame(500.0 - time_secs, &positions(pose))),
                MorecStatus::Ok
            );
        }
        assert_eq!(morec_recognizer_reset(recognizer.0), MorecStatus::Ok);
        assert_eq!(recognizer.stats().frames, 0);
        assert_eq!(recognizer.run(&poses), expected);
    }
}

#[test]
fn one_thread_pushes_while_another_polls_and_a_third_is_told_to_wait() {
    let index = Index::new(kit::index_bytes());
    let (_, poses) = made::poses(&kit::take(60.0));
    let expected = Recognizer::new(&index, &options()).unwrap().run(&poses);
    let recognizer = Recognizer::new(&index, &options()).unwrap();
    let handle = recognizer.0.addr();
    let finished = std::sync::atomic::AtomicBool::new(false);
    let events = std::thread::scope(|scope| {
        let polling = scope.spawn(|| {
            let recognizer =
                std::mem::ManuallyDrop::new(Recognizer(without_provenance_mut(handle)));
            let mut events = Vec::new();
            loop {
                let last = finished.load(std::sync::atomic::Ordering::Acquire);
                events.extend(recognizer.poll(2));
                if last && recognizer.stats().events == events.len() as u64 {
                    return events;
                }
            }
        });
        scope.spawn(|| {
            // Frames of nobody: refused for one reason or the other, and nobody is disturbed.
            while !finished.load(std::sync::atomic::Ordering::Acquire) {
                let nobody = frame(0.0, &[f64::NAN; 54]);
                let status =
                    unsafe { morec_recognizer_push(without_provenance_mut(handle), &nobody) };
                assert!(
                    matches!(status, MorecStatus::InvalidValue | MorecStatus::Busy),
                    "{status:?}"
                );
                std::thread::yield_now();
            }
        });
        for (time_secs, pose) in &poses {
            let positions = positions(pose);
            while recognizer.push(&frame(*time_secs, &positions)) == MorecStatus::Busy {}
        }
        while morec_recognizer_finish(recognizer.0) == MorecStatus::Busy {}
        finished.store(true, std::sync::atomic::Ordering::Release);
        polling.join().unwrap()
    });
    assert_eq!(
        events.iter().map(kit::detection).collect::<Vec<_>>(),
        expected
    );
}
