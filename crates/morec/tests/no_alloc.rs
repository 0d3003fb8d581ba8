//! Real-time contract: once a recogniser stands, pushing poses takes no memory from the system.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

#[path = "it/made.rs"]
mod made;
#[path = "it/thesis.rs"]
mod thesis;

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use morec::features::MAX_GAP_SECS;
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotMap, PivotSet, PoseParams, PoseStream, for_each_pivot_pose};
use morec::roles::RoleMap;
use morec::svrdm::SvrdmEngine;
use std::sync::{Arc, Mutex, PoisonError};

use morec::live::{EventOptions, Frame, Performer, PerformerId, Recognizer, Rig};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Number of times that `job` asks for memory or gives it back. Counts are of the whole process: one at a time.
fn allocations(job: impl FnOnce()) -> u32 {
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    reset_violation_count();
    assert_no_alloc(job);
    violation_count()
}

#[test]
fn pushing_takes_no_memory() {
    assert!(
        allocations(|| drop(std::hint::black_box(vec![1]))) > 0,
        "the counter must count"
    );

    let script = made::right_handed(89, 1)
        .rest(0.5)
        .play("push")
        .rest(1.5)
        .play("bow")
        .rest(0.3)
        .play("walk");
    let (bones, mut poses) = made::poses(&script.film("quiet", 60.0).unwrap());
    poses.retain(|p| !(3.0..3.2 + MAX_GAP_SECS).contains(&p.0));
    // A late pose, one from nowhere, and a clock that is set back.
    poses.insert(40, poses[30]);
    poses.insert(50, (f64::NAN, poses[50].1));
    poses.extend_from_within(..60);

    let model = made::model();
    let mut recognizer = Recognizer::new(&model, bones).unwrap().clone();
    let mut found = 0;
    let allocations = allocations(|| {
        for (time_secs, pose) in &poses {
            found += recognizer.push(*time_secs, pose).len();
            std::hint::black_box(recognizer.early_detection());
        }
        found += recognizer.finish().len();
        for (time_secs, pose) in &poses {
            found += recognizer.push(*time_secs, pose).len();
        }
    });
    assert_eq!(allocations, 0);
    assert!(
        found >= 4,
        "too little happened to prove anything: {found} detections"
    );
    events_take_no_memory(&model, &poses);
}

#[test]
fn activities_and_their_counts_take_no_memory() {
    let model = Arc::new(made::activity_model());
    let (bones, poses) = made::poses(&made::waving(3));
    let mut recognizer = Recognizer::new(&model, bones).unwrap();
    let (mut found, mut counted) = (Vec::with_capacity(8), 0);
    let allocations = allocations(|| {
        for (time_secs, pose) in &poses {
            found.extend_from_slice(recognizer.push(*time_secs, pose));
            let early = recognizer.early_detection();
            let repeated = early.and_then(|early| early.repetitions);
            counted = repeated.map_or(counted, |r| r.count);
        }
        found.extend_from_slice(recognizer.finish());
    });
    assert_eq!(allocations, 0);
    assert_eq!(found.len(), 1, "{found:?}");
    let repeated = found[0].repetitions.unwrap();
    assert!((7..=9).contains(&repeated.count), "{repeated:?}");
    assert!((7..=12).contains(&counted), "while it went on: {counted}");
}

/// From frames to events, tentative ones included.
fn events_take_no_memory(model: &Arc<morec::templates::TemplateModel>, poses: &[made::Timed]) {
    let options = EventOptions {
        tentative: true,
        each_repetition: true,
        deviation: true,
        progress: true,
        ..EventOptions::default()
    };
    let mut performer = Performer::new(model, PerformerId(0), &options);
    let (mut frame, mut events) = (Frame::default(), 0);
    let mut play = |performer: &mut Performer| {
        for (time_secs, pose) in poses {
            frame.time_secs = *time_secs;
            frame.set_key_pose(pose);
            events += performer.push(&frame).len();
            std::hint::black_box(performer.diagnosis().map(|known| known.findings()));
        }
        events += performer.finish().len();
    };
    performer.set_rig(&Arc::new(Rig::of_roles()));
    // A new skeleton's first frame makes the recogniser.
    play(&mut performer);
    assert_eq!(allocations(|| play(&mut performer)), 0);
    assert!(
        events >= 8,
        "too little was said to prove anything: {events} events"
    );
}

#[test]
fn pose_rows_and_their_reduction_take_no_memory() {
    let clip = made::right_handed(89, 1)
        .rest(0.5)
        .play("bow")
        .film("quiet", 60.0)
        .unwrap()
        .clip;
    let set = PivotSet::roles();
    let map = PivotMap::resolve(&set, &clip.skeleton, &RoleMap::find(&clip.skeleton)).unwrap();
    let mut poses = vec![];
    for_each_pivot_pose(&clip, &map, &(0..0), |time_secs, pose| {
        poses.push((time_secs, *pose))
    });
    poses.push((99.0, poses[0].1));
    let mut stream = PoseStream::new(&set, &PoseParams::default());
    let mut moments = Moments::new(stream.dim());
    for (time_secs, pose) in &poses {
        stream.push(*time_secs, pose, &mut |row| moments.push_values(row));
    }
    stream.finish(&mut |_| ());
    let pca = Pca::fit(&moments, ComponentCount::Dims(8)).unwrap();
    let (mut reduced, mut rows) = ([0f32; 8], 0);
    let allocations = allocations(|| {
        for (time_secs, pose) in &poses {
            stream.push(*time_secs, pose, &mut |row| {
                pca.project_into(row, &mut reduced);
                rows += 1;
            });
        }
        stream.finish(&mut |_| rows += 1);
    });
    assert_eq!(allocations, 0);
    assert!(
        rows > 2 * clip.frames - 4,
        "{rows} rows of {} frames at half the rate",
        clip.frames
    );
}

#[test]
fn the_thesiss_stages_take_no_memory() {
    let reference = thesis::reference();
    let (rows, model) = (reference.rows(), reference.model(&reference.models[0]));
    let mut engine = SvrdmEngine::new(&model).unwrap().clone();
    let spoilt = vec![f32::NAN; rows[0].len()];
    let mut found = 0;
    let allocations = allocations(|| {
        for row in rows.iter().chain([&spoilt]).chain(&rows) {
            engine.push(row, &mut |_| found += 1);
        }
        engine.finish(&mut |_| found += 1);
        for row in &rows {
            engine.push(row, &mut |_| found += 1);
        }
    });
    assert_eq!(allocations, 0);
    assert!(
        found >= 20,
        "too little happened to prove anything: {found} detections"
    );
}

/// From frames to events by the method of 2009, by an index as it comes out of its file.
#[test]
fn the_thesiss_method_from_frames_to_events_takes_no_memory() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/index/svrdm_v1.index");
    let model = morec::index::MotionIndex::from_bytes(&std::fs::read(file).unwrap())
        .unwrap()
        .model;
    let script = made::right_handed(90, 3)
        .rest(1.0)
        .play("wave")
        .rest(0.8)
        .play("bow")
        .rest(1.0);
    let clip = script
        .play("push")
        .rest(1.5)
        .film("quiet", 60.0)
        .unwrap()
        .clip;
    let poses: Vec<_> = (0..clip.frames)
        .map(|frame| morec::kinematics::WorldPose::of(&clip, frame))
        .collect();
    let roles = RoleMap::find(&clip.skeleton);
    let rig = Arc::new(Rig {
        skeleton: clip.skeleton.clone(),
        roles,
    });
    let mut performer = Performer::new(&model, PerformerId(0), &EventOptions::default());
    let (mut frame, mut events) = (Frame::default(), 0);
    let mut play = |performer: &mut Performer, lap: f64| {
        for (number, pose) in poses.iter().enumerate() {
            // A late frame and a gap in each lap.
            let late = if number == 40 { -0.2 } else { 0.0 };
            let gap = if number > 200 { 1.0 } else { 0.0 };
            frame.time_secs = 100.0 * lap + number as f64 / 60.0 + late + gap;
            frame.pose.positions.clone_from(&pose.positions);
            frame.pose.rotations.clone_from(&pose.rotations);
            events += performer.push(&frame).len();
        }
        events += performer.finish().len();
    };
    performer.set_rig(&rig);
    // A new skeleton's first frame makes the recogniser.
    play(&mut performer, 0.0);
    let allocations = allocations(|| (1..5).for_each(|lap| play(&mut performer, f64::from(lap))));
    assert_eq!(allocations, 0);
    assert!(
        events >= 5,
        "too little was said to prove anything: {events} events"
    );
}
