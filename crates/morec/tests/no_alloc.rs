//! Real-time contract: once a recogniser stands, pushing poses takes no memory from the system.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

#[path = "it/made.rs"]
mod made;

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use morec::features::MAX_GAP_SECS;
use morec::live::Recognizer;
use morec::pca::{Keep, Moments, Pca};
use morec::pivots::{PivotMap, PivotSet, PoseParams, PoseStream, for_each_pivot_pose};
use morec::roles::RoleMap;
use morec::synth::{Person, Script, Side};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// How often `job` asks for memory or gives it back.
fn allocations(job: impl FnOnce()) -> u32 {
    reset_violation_count();
    assert_no_alloc(job);
    violation_count()
}

#[test]
fn pushing_takes_no_memory() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1]))) > 0, "the counter must count");

    let person = Person { hand: Side::Right, ..Person::draw(89, 1) };
    let script = Script::new(89, person).rest(0.5).play("push").rest(1.5).play("bow").rest(0.3).play("walk");
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
        }
        found += recognizer.finish().len();
        for (time_secs, pose) in &poses {
            found += recognizer.push(*time_secs, pose).len();
        }
    });
    assert_eq!(allocations, 0);
    assert!(found >= 4, "too little happened to prove anything: {found} detections");
}

#[test]
fn pose_rows_and_their_reduction_take_no_memory() {
    let person = Person { hand: Side::Right, ..Person::draw(89, 1) };
    let clip = Script::new(89, person).rest(0.5).play("bow").film("quiet", 60.0).unwrap().clip;
    let set = PivotSet::roles();
    let map = PivotMap::resolve(&set, &clip.skeleton, &RoleMap::find(&clip.skeleton)).unwrap();
    let mut poses = vec![];
    for_each_pivot_pose(&clip, &map, &(0..0), |time_secs, pose| poses.push((time_secs, *pose)));
    poses.push((99.0, poses[0].1));
    let mut stream = PoseStream::new(&set, &PoseParams::default());
    let mut moments = Moments::new(stream.dim());
    for (time_secs, pose) in &poses {
        stream.push(*time_secs, pose, &mut |row| moments.push_values(row));
    }
    stream.finish(&mut |_| ());
    let pca = Pca::fit(&moments, Keep::Dims(8)).unwrap();
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
    assert!(rows > 2 * clip.frames - 4, "{rows} rows of {} frames at half the rate", clip.frames);
}
