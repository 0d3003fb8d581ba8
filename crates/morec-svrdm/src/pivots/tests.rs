use proptest::prelude::*;

use super::*;
use mocap::clip::{Clip, Joint, Skeleton};
use mocap::math::{Axis, Quat, Vec3};
use mocap::roles::{Role, RoleMap};
use morec_features::{MAX_GAP_SECS, Pushed, Rows};

fn joint(name: &str, parent: Option<usize>) -> Joint {
    Joint {
        name: name.into(),
        parent,
        offset: Vec3::y(),
        tip: None,
    }
}

fn pivot(name: &str, parent: Option<&str>, role: Option<Role>) -> Pivot {
    Pivot {
        name: name.into(),
        parent: parent.map(Into::into),
        joints: vec![name.into()],
        role,
    }
}

/// Hips and, two joints on, an arm.
fn two() -> PivotSet {
    PivotSet::new(vec![
        pivot("Hips", None, None),
        pivot("Arm", Some("Hips"), None),
    ])
    .unwrap()
}

/// Three joints in a row, turned by functions of the frame.
fn clip(rate_hz: f64, frames: usize, turns: [impl Fn(f64) -> Quat; 3]) -> Clip {
    let joints = vec![
        joint("Hips", None),
        joint("Chest", Some(0)),
        joint("Arm", Some(1)),
    ];
    let rotations = (0..frames).flat_map(|f| {
        let secs = f as f64 / rate_hz;
        turns.iter().map(move |turn| turn(secs)).collect::<Vec<_>>()
    });
    Clip {
        name: "c".into(),
        skeleton: Skeleton::new(joints).unwrap(),
        rate_hz,
        rotations: rotations.collect(),
        tracks: Vec::new(),
        frames,
        repaired: Vec::new(),
        points: None,
    }
}

fn rows(clip: &Clip, set: &PivotSet, params: &PoseParams) -> Rows {
    let map = PivotMap::resolve(set, &clip.skeleton, &RoleMap::default()).unwrap();
    pose_rows_of_clip(clip, set, &map, &(0..0), params)
}

fn near(values: &[f32], q: Quat) -> bool {
    let expected = [q.w, q.i, q.j, q.k];
    values
        .iter()
        .zip(expected)
        .all(|(v, e)| (f64::from(*v) - e).abs() < 1e-6)
}

#[test]
fn sets_of_the_library_are_sets() {
    for (set, pivots) in [(PivotSet::thesis(), 16), (PivotSet::roles(), 12)] {
        assert_eq!(PivotSet::new(set.pivots().to_vec()).unwrap(), set);
        assert_eq!((set.len(), set.row_dim()), (pivots, 4 * pivots));
        let text = serde_json::to_string(&set).unwrap();
        assert_eq!(serde_json::from_str::<PivotSet>(&text).unwrap(), set);
    }
}

#[test]
fn pivots_that_are_left_out_are_skipped_on_the_way_to_the_root() {
    let some = PivotSet::thesis()
        .keeping(|p| ["LeftArm", "LeftForeArm", "Spine"].contains(&p.name.as_str()));
    let parents: Vec<_> = some
        .pivots()
        .iter()
        .map(|p| (p.name.as_str(), p.parent.as_deref()))
        .collect();
    assert_eq!(
        parents,
        [
            ("Hips", None),
            ("Spine", Some("Hips")),
            ("LeftArm", Some("Spine")),
            ("LeftForeArm", Some("LeftArm"))
        ]
    );
    assert_eq!(PivotSet::new(some.pivots().to_vec()), Ok(some));
    assert_eq!(PivotSet::roles().keeping(|_| true), PivotSet::roles());
}

#[test]
fn lists_that_are_no_set_are_refused() {
    let (hips, arm) = (pivot("Hips", None, None), pivot("Arm", Some("Hips"), None));
    let refused = |pivots: Vec<Pivot>| PivotSet::new(pivots).unwrap_err();
    assert_eq!(refused(vec![]), PivotSetError::Count { found: 0 });
    assert!(matches!(
        refused(vec![arm.clone()]),
        PivotSetError::FirstIsNoRoot { .. }
    ));
    assert!(matches!(
        refused(vec![hips.clone(), hips.clone()]),
        PivotSetError::Twice { .. }
    ));
    assert!(matches!(
        refused(vec![hips.clone(), pivot("Two", None, None)]),
        PivotSetError::SecondRoot { .. }
    ));
    let orphan = pivot("Hand", Some("Arm"), None);
    assert!(matches!(
        refused(vec![hips.clone(), orphan, arm]),
        PivotSetError::Parent { .. }
    ));
    let many = (0..40)
        .map(|i| pivot(&i.to_string(), (i > 0).then_some("0"), None))
        .collect();
    assert_eq!(refused(many), PivotSetError::Count { found: 40 });
    let error = serde_json::from_str::<PivotSet>("[]")
        .unwrap_err()
        .to_string();
    assert!(error.contains("1 to 32 pivots"), "{error}");
}

#[test]
fn rotations_of_joints_in_between_are_composed_and_the_root_turns_to_the_next_frame() {
    let turns = [
        |s: f64| Axis::Y.rotation(s) * Axis::X.rotation(0.4),
        |s: f64| Axis::X.rotation(0.5 * s),
        |s: f64| Axis::Z.rotation(0.3 + s),
    ];
    let clip = clip(120.0, 30, turns);
    let world = rows(&clip, &two(), &PoseParams::default());
    let body = rows(
        &clip,
        &two(),
        &PoseParams {
            root: RootForm::Body,
            ..PoseParams::default()
        },
    );
    assert_eq!((world.len(), world.dim()), (30, 8));
    for f in 0..30 {
        let secs = f as f64 / 120.0;
        assert!(near(
            &world.row(f)[4..],
            Axis::X.rotation(0.5 * secs) * Axis::Z.rotation(0.3 + secs)
        ));
        assert!(near(&world.row(f)[..4], Axis::Y.rotation(1.0 / 120.0)));
        let turned = turns[0](secs).conjugate() * Axis::Y.rotation(1.0 / 120.0) * turns[0](secs);
        assert!(near(&body.row(f)[..4], turned));
    }
}

#[test]
fn the_body_form_does_not_know_the_heading() {
    let form = PoseParams {
        root: RootForm::Body,
        ..PoseParams::default()
    };
    let made = |heading: f64| {
        let hips = move |s: f64| Axis::Y.rotation(heading + s) * Axis::X.rotation((7.0 * s).sin());
        let still: fn(f64) -> Quat = |_| Quat::identity();
        let turns: [Box<dyn Fn(f64) -> Quat>; 3] =
            [Box::new(hips), Box::new(still), Box::new(still)];
        clip(120.0, 40, turns)
    };
    let differ = |params: &PoseParams| {
        let (a, b) = (
            rows(&made(0.0), &two(), params),
            rows(&made(2.0), &two(), params),
        );
        a.values()
            .iter()
            .zip(b.values())
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max)
    };
    assert!(differ(&form) < 1e-6);
    assert!(
        differ(&PoseParams::default()) > 1e-3,
        "the printed form does"
    );
}

#[test]
fn signs_follow_the_frame_before_or_the_hemisphere() {
    // An arm that turns once round from its parent: half way, w passes 0.
    let still: fn(f64) -> Quat = |_| Quat::identity();
    let round: fn(f64) -> Quat = |s| Axis::X.rotation(std::f64::consts::TAU * s);
    let clip = clip(120.0, 120, [still, still, round]);
    let continuous = rows(&clip, &two(), &PoseParams::default());
    let jumps = |rows: &Rows| {
        let pairs = rows.iter().zip(rows.iter().skip(1));
        pairs
            .filter(|(a, b)| a[4..].iter().zip(&b[4..]).map(|(a, b)| a * b).sum::<f32>() < 0.0)
            .count()
    };
    assert_eq!(jumps(&continuous), 0);
    assert!(continuous.row(0)[4] > 0.0 && continuous.row(119)[4] < -0.9);
    let hemisphere = PoseParams {
        signs: QuaternionSign::Hemisphere,
        ..PoseParams::default()
    };
    let hemisphere = rows(&clip, &two(), &hemisphere);
    assert_eq!(jumps(&hemisphere), 1);
    assert!(hemisphere.iter().all(|row| row[4] >= 0.0));
}

#[test]
fn names_count_before_roles_unless_they_mean_another_part() {
    let skeleton = Skeleton::new(vec![
        joint("rig:HIPS", None),
        joint("LeftShoulder", Some(0)), // here an upper arm
        joint("collar", Some(0)),
        joint("Thing", Some(0)),
    ]);
    let skeleton = skeleton.unwrap();
    let mut roles = RoleMap::default();
    roles.set(Role::LeftArm, Some(1));
    roles.set(Role::LeftShoulder, Some(2));
    roles.set(Role::LeftShin, Some(3));
    let map = PivotMap::resolve(&PivotSet::thesis(), &skeleton, &roles).unwrap();
    let set = PivotSet::thesis();
    let joint = |name: &str| map.joint(set.pivots().iter().position(|p| p.name == name).unwrap());
    assert_eq!(joint("Hips"), Some(0));
    assert_eq!(joint("LeftShoulder"), Some(2));
    assert_eq!(joint("LeftArm"), Some(1));
    assert_eq!(joint("LeftLeg"), Some(3));
    assert_eq!(map.missing().len(), 12);
    assert!(map.missing().contains(&"LHipJoint".to_owned()));
}

#[test]
fn a_skeleton_without_the_root_is_refused_by_name() {
    let skeleton = Skeleton::new(vec![joint("Box", None)]).unwrap();
    let error = PivotMap::resolve(&PivotSet::thesis(), &skeleton, &RoleMap::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no joint for the root pivot Hips: expected one of the joints [Hips, root] or the role hips"
    );
}

#[test]
fn a_missing_pivot_turns_with_its_parent() {
    let mut set = two().pivots().to_vec();
    set[1].parent = Some("Gone".into());
    set.insert(1, pivot("Gone", Some("Hips"), None));
    let set = PivotSet::new(set).unwrap();
    let clip = clip(
        120.0,
        5,
        [
            |s: f64| Axis::Y.rotation(s),
            |_: f64| Axis::X.rotation(0.5),
            |s: f64| Axis::Z.rotation(s),
        ],
    );
    let with = rows(&clip, &set, &PoseParams::default());
    let without = rows(&clip, &two(), &PoseParams::default());
    for f in 0..5 {
        assert!(near(&with.row(f)[4..8], Quat::identity()));
        assert_eq!(with.row(f)[8..], without.row(f)[4..]);
    }
}

#[test]
fn rest_frames_show_the_first_pose_after_them() {
    let still: fn(f64) -> Quat = |_| Quat::identity();
    let jump: fn(f64) -> Quat = |s| {
        if s > 0.0 {
            Axis::Y.rotation(1.0)
        } else {
            Quat::identity()
        }
    };
    let clip = clip(120.0, 10, [jump, still, jump]);
    let map = PivotMap::resolve(&two(), &clip.skeleton, &RoleMap::default()).unwrap();
    let rows = pose_rows_of_clip(&clip, &two(), &map, &(0..1), &PoseParams::default());
    assert!(rows.iter().all(|row| row == rows.row(0)));
    assert_eq!(rows.len(), 10);
}

/// Frames of three pivots that turn for 1.8 s, 50 a second, with their times.
fn stream() -> (PivotSet, Vec<(f64, PivotPose)>) {
    let set = PivotSet::new(vec![
        pivot("Hips", None, None),
        pivot("Chest", Some("Hips"), None),
        pivot("Arm", Some("Chest"), None),
    ])
    .unwrap();
    let turns = [
        |s: f64| Axis::Y.rotation(s) * Axis::X.rotation((3.0 * s).sin()),
        |s: f64| Axis::X.rotation(0.6 * (4.0 * s).sin()),
        |s: f64| Axis::Z.rotation(0.3 + 2.0 * s) * Axis::X.rotation((9.0 * s).cos()),
    ];
    let clip = clip(50.0, 90, turns);
    let map = PivotMap::resolve(&set, &clip.skeleton, &RoleMap::default()).unwrap();
    let mut poses = Vec::new();
    for_each_pivot_pose(&clip, &map, &(0..0), |secs, pose| poses.push((secs, *pose)));
    (set, poses)
}

fn pushed(set: &PivotSet, poses: &[(f64, PivotPose)]) -> Rows {
    let mut stream = PoseStream::new(set, &PoseParams::default());
    let mut rows = Rows::new(stream.dim());
    for (secs, pose) in poses {
        stream.push(*secs, pose, &mut |row| rows.push(row));
    }
    stream.finish(&mut |row| rows.push(row));
    rows
}

#[test]
fn any_rate_gives_rows_at_the_models() {
    let (set, poses) = stream();
    let rows = pushed(&set, &poses);
    let last_secs = poses[poses.len() - 1].0;
    assert_eq!(rows.len(), (last_secs * 120.0 + 1e-6) as usize + 1);
    // Every sixth row falls on a fourth pose of 50 a second, in time: 12 rows, 5 poses.
    for (k, (_, pose)) in poses.iter().step_by(5).enumerate().take(20) {
        let local = pose.get(0).unwrap().conjugate() * pose.get(1).unwrap();
        let local = mocap::math::same_hemisphere(&Quat::identity(), local);
        assert!(near(&rows.row(12 * k)[4..8], local), "row {}", 12 * k);
    }
}

#[test]
fn gaps_begin_anew_and_late_poses_are_ignored() {
    let (set, poses) = stream();
    let mut stream = PoseStream::new(&set, &PoseParams::default());
    let (mut rows, mut said) = (0, vec![]);
    let gap_secs = poses[30].0 + MAX_GAP_SECS + 0.1;
    let times = [
        poses[30].0,
        poses[29].0,
        f64::NAN,
        poses[30].0,
        gap_secs,
        gap_secs + 0.01,
        0.0,
    ];
    for secs in times {
        said.push(stream.push(secs, &poses[30].1, &mut |_| rows += 1));
    }
    use Pushed::{Ignored, Restarted, Taken};
    assert_eq!(
        said,
        [
            Taken, Ignored, Ignored, Ignored, Restarted, Taken, Restarted
        ]
    );
    assert_eq!(rows, 3, "one row of the first stretch, two of the second");
    assert_eq!(stream.origin_secs(), 0.0);
    let mut new = PoseStream::new(&set, &PoseParams::default());
    assert_eq!(
        new.push(0.0, &PivotPose::default(), &mut |_| {}),
        Pushed::NoHips
    );
}

#[test]
fn a_lost_pivot_keeps_its_last_rotation() {
    let (set, mut poses) = stream();
    poses.truncate(12);
    let held = poses[5].1;
    for (_, pose) in &mut poses[6..] {
        let turned = *held.get(0).unwrap();
        *pose = held;
        pose.set(0, Axis::Y.rotation(0.3) * turned);
        pose.set(
            1,
            Quat::new_unchecked(nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 0.0)),
        );
    }
    let rows = pushed(&set, &poses);
    let last = rows.len() - 1;
    assert_eq!(rows.row(last)[4..8], rows.row(last - 8)[4..8]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..Default::default() })]

    /// A stretch depends on nothing before it: rows after a gap are those of a new stream.
    #[test]
    fn rows_do_not_depend_on_what_came_before(at in 1usize..60) {
        let (set, poses) = stream();
        let (before, after) = poses.split_at(at);
        let late: Vec<_> = after.iter().map(|(secs, pose)| (secs + 1.0, *pose)).collect();
        let together = pushed(&set, &[before, &late].concat());
        let apart = [pushed(&set, before), pushed(&set, &late)];
        let values: Vec<f32> = apart.iter().flat_map(|rows| rows.values().to_vec()).collect();
        prop_assert_eq!(together.values(), &values[..]);
    }

    /// No looking ahead: a row is the same whatever follows the pose after it.
    #[test]
    fn rows_do_not_depend_on_what_comes_after(at in 2usize..60) {
        let (set, poses) = stream();
        let (whole, part) = (pushed(&set, &poses), pushed(&set, &poses[..at]));
        let sure = part.len() - 1;
        prop_assert!(sure > 0);
        for row in 0..sure {
            prop_assert_eq!(part.row(row), whole.row(row));
        }
    }
}

#[test]
fn a_clip_posed_by_its_own_rows_is_the_clip() {
    let turn =
        |axis: Vec3, rate: f64| move |secs: f64| Quat::from_scaled_axis(axis * (rate * secs).sin());
    let clip = clip(
        120.0,
        200,
        [
            turn(Vec3::y(), 1.0),
            turn(Vec3::x(), 2.0),
            turn(Vec3::z(), 3.0),
        ],
    );
    let set = two();
    let map = PivotMap::resolve(&set, &clip.skeleton, &RoleMap::default()).unwrap();
    let params = PoseParams::default();
    let own = rows(&clip, &set, &params);
    let same = clip_of_pose_rows(&clip, &set, &map, &own, &params);
    for (a, b) in clip.rotations.iter().zip(&same.rotations) {
        assert!(a.angle_to(b) < 1e-3, "{a} {b}");
    }
    // The arm as it hangs from the hips, whatever the chest between them does.
    let mut hanging = own.values().to_vec();
    for row in hanging.chunks_exact_mut(8) {
        row[4..].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
    }
    let own = Rows::from_values(8, hanging);
    let still = clip_of_pose_rows(&clip, &set, &map, &own, &params);
    for frame in 0..clip.frames {
        let [_, chest, arm] = still.frame_rotations(frame) else {
            panic!()
        };
        assert_eq!(chest, &clip.frame_rotations(frame)[1]);
        assert!((chest * arm).angle() < 1e-6);
    }
}
