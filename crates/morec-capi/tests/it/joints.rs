//! Skeletons of named joints: however they are given, the same motions are recognised.

use std::ffi::CString;
use std::ptr::null;

use morec::clip::Clip;
use morec::kinematics::WorldPose;
use morec::live::{Detection, recognize_clip};
use morec::math::{Axis, Quat, Vec3};
use morec::roles::{Role, RoleMap};
use morec_capi::*;

use crate::kit::{self, Index, Recognizer, last_error};

/// A clip's skeleton and frames as a caller with other axes has them.
struct Caller {
    clip: Clip,
    handedness: MorecHandedness,
    up_axis: MorecUpAxis,
}

impl Caller {
    fn mirror(&self) -> Option<usize> {
        let z_up = self.up_axis == MorecUpAxis::Z;
        (self.handedness == MorecHandedness::Left).then_some(if z_up { 1 } else { 2 })
    }

    /// From our axes to the caller's: the world is turned first, then everything mirrored.
    fn turn(&self, in_world: bool) -> Quat {
        let turned = in_world && self.up_axis == MorecUpAxis::Z;
        if turned {
            Axis::X.rotation(std::f64::consts::FRAC_PI_2)
        } else {
            Quat::identity()
        }
    }

    fn position(&self, p: Vec3, in_world: bool) -> [f64; 3] {
        let mut p = self.turn(in_world) * p;
        if let Some(axis) = self.mirror() {
            p[axis] = -p[axis];
        }
        p.into()
    }

    fn rotation(&self, q: Quat, in_world: bool) -> [f64; 4] {
        let mut matrix = (self.turn(in_world) * q).to_rotation_matrix().into_inner();
        if let Some(axis) = self.mirror() {
            // Both sides of the matrix are seen in the mirror.
            for other in (0..3).filter(|other| *other != axis) {
                matrix[(axis, other)] = -matrix[(axis, other)];
                matrix[(other, axis)] = -matrix[(other, axis)];
            }
        }
        let q = Quat::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix));
        [q.i, q.j, q.k, q.w]
    }

    fn is_root(&self, joint: usize) -> bool {
        self.clip.skeleton.joints()[joint].parent.is_none()
    }

    fn offsets(&self) -> Vec<f64> {
        let joints = self.clip.skeleton.joints().iter();
        joints
            .flat_map(|joint| self.position(joint.offset, joint.parent.is_none()))
            .collect()
    }
}

/// Form in which the caller tells its frames.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Telling {
    /// Local rotations, local positions of the roots; the rest is in the skeleton.
    Roots,
    /// Local rotations and positions of every joint; the skeleton has no offsets.
    Locals,
    /// World positions and rotations.
    World,
}

fn run(
    index: &Index,
    caller: &Caller,
    telling: Telling,
    roles: Option<&RoleMap>,
) -> Vec<Detection> {
    let clip = &caller.clip;
    let count = clip.skeleton.len();
    let joints = clip.skeleton.joints();
    let names: Vec<CString> = joints
        .iter()
        .map(|j| CString::new(j.name.as_str()).unwrap())
        .collect();
    let names: Vec<_> = names.iter().map(|name| name.as_ptr()).collect();
    let parents: Vec<i32> = joints
        .iter()
        .map(|j| j.parent.map_or(-1, |p| p as i32))
        .collect();
    let offsets = caller.offsets();
    let role = |j| {
        Role::BODY
            .into_iter()
            .find(|r| roles.is_some_and(|roles| roles.joint(*r) == Some(j)))
    };
    let roles_given: Vec<i32> = (0..count)
        .map(|j| role(j).map_or(-1, |r| r.index() as i32))
        .collect();
    let skeleton = MorecSkeleton {
        struct_size: size_of::<MorecSkeleton>(),
        joint_count: count,
        parents: parents.as_ptr(),
        names: names.as_ptr(),
        offsets: if telling == Telling::Locals {
            null()
        } else {
            offsets.as_ptr()
        },
        roles: if roles.is_some() {
            roles_given.as_ptr()
        } else {
            null()
        },
    };
    let mut options = kit::options();
    options.skeleton = &skeleton;
    (options.handedness, options.up_axis) = (caller.handedness as i32, caller.up_axis as i32);
    let recognizer =
        Recognizer::new(index, &options).unwrap_or_else(|s| panic!("{s:?}: {}", last_error()));
    let mut events = Vec::new();
    for f in 0..clip.frames {
        let (positions, rotations) = told(caller, telling, f);
        let frame = MorecFrame {
            struct_size: size_of::<MorecFrame>(),
            time_secs: f as f64 / clip.rate_hz,
            joint_count: count,
            positions: positions.as_ptr(),
            rotations: rotations.as_ptr(),
            space: if telling == Telling::World {
                MorecSpace::World
            } else {
                MorecSpace::Local
            } as i32,
            reserved: 0,
        };
        assert_eq!(recognizer.push(&frame), MorecStatus::Ok, "{}", last_error());
        events.extend(recognizer.poll(64));
    }
    assert_eq!(morec_recognizer_finish(recognizer.0), MorecStatus::Ok);
    events.extend(recognizer.poll(64));
    events.iter().map(kit::detection).collect()
}

fn told(caller: &Caller, telling: Telling, f: usize) -> (Vec<f64>, Vec<f64>) {
    let clip = &caller.clip;
    let (mut positions, mut rotations) = (Vec::new(), Vec::new());
    let world = WorldPose::of(clip, f);
    for j in 0..clip.skeleton.len() {
        let in_world = caller.is_root(j) || telling == Telling::World;
        let (p, q) = match telling {
            Telling::World => (world.positions[j], world.rotations[j]),
            _ => (clip.local_position(f, j), clip.frame_rotations(f)[j]),
        };
        let p = caller.position(p, in_world);
        let is_told = telling != Telling::Roots || caller.is_root(j);
        positions.extend(if is_told { p } else { [f64::NAN; 3] });
        // Length and sign of a quaternion say nothing.
        let odd = if j % 2 == 0 { -2.5 } else { 1.0 };
        rotations.extend(caller.rotation(q, in_world).map(|c| odd * c));
    }
    (positions, rotations)
}

#[test]
fn every_way_to_tell_a_skeleton_gives_the_motions_of_the_clip() {
    let clip = kit::take(60.0).clip;
    let roles = RoleMap::find(&clip.skeleton);
    let expected = recognize_clip(&kit::index().model, &clip, &roles, &(0..0)).unwrap();
    assert_eq!(expected.len(), 2);
    let index = Index::new(kit::index_bytes());
    for handedness in [MorecHandedness::Right, MorecHandedness::Left] {
        for up_axis in [MorecUpAxis::Y, MorecUpAxis::Z] {
            let caller = Caller {
                clip: clip.clone(),
                handedness,
                up_axis,
            };
            for telling in [Telling::Roots, Telling::Locals, Telling::World] {
                // Without offsets, names have to say what the tree cannot; here roles are given.
                let found = run(&index, &caller, telling, Some(&roles));
                let about = format!("{handedness:?}, {up_axis:?}, {telling:?}: {found:?}");
                assert_same(&found, &expected, &about);
                if telling != Telling::Locals {
                    assert_same(&run(&index, &caller, telling, None), &expected, &about);
                }
            }
        }
    }
}

fn assert_same(found: &[Detection], expected: &[Detection], about: &str) {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    let same = |(a, b): (&Detection, &Detection)| {
        let times =
            near(a.span.start_secs, b.span.start_secs) && near(a.span.stop_secs, b.span.stop_secs);
        a.class == b.class
            && times
            && near(a.reported_secs, b.reported_secs)
            && (a.score - b.score).abs() < 1e-4
    };
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(same),
        "{about}, not {expected:?}"
    );
}
