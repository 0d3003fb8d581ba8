//! The stream of all doors: by points or by a skeleton, in any axes, with its options.

use std::sync::Arc;

use morec::features::{BoneSet, KeyPose};
use morec::index::{MotionIndex, Provenance};
use morec::live::{
    Event, EventOptions, Frame, Performer, PerformerId, PerformerStream, Phase, Rig, StartError,
    StreamOptions,
};
use morec::math::{Quat, Vec3};
use morec::roles::Role;
use morec::roles::mapping::Mapping;

use crate::made::{self, Timed};
use crate::session::stream;

fn index() -> Arc<MotionIndex> {
    Arc::new(MotionIndex {
        roles: Default::default(),
        provenance: Provenance::default(),
        model: made::model().into(),
    })
}

/// The poses as points of these names, in the order of the roles, turned.
fn by_points(names: &[&str], turn: Quat, options: &StreamOptions) -> Vec<Event> {
    let mut live = PerformerStream::of_points(&index(), names, options).unwrap();
    let mut events = Vec::new();
    for (secs, pose) in stream() {
        for (value, role) in live.values().chunks_exact_mut(3).zip(Role::ALL) {
            let at = pose
                .get(role)
                .map_or(Vec3::repeat(f64::NAN), |at| turn * at);
            value.copy_from_slice(at.as_slice());
        }
        events.extend_from_slice(live.push_values(secs, secs));
    }
    events.extend_from_slice(live.finish());
    events
}

fn by_rig(turn: Quat, announced: Option<BoneSet>, options: &StreamOptions) -> Vec<Event> {
    let mut live = PerformerStream::of_rig(&index(), Rig::of_roles(), announced, options).unwrap();
    let (mut frame, mut events) = (Frame::default(), Vec::new());
    for (secs, pose) in stream() {
        let mut turned = KeyPose::default();
        (pose.roles()).for_each(|role| turned.set(role, turn * pose.get(role).unwrap()));
        (frame.time_secs, frame.wall_secs) = (secs, secs);
        frame.set_key_pose(&turned);
        events.extend_from_slice(live.push(&frame));
    }
    events.extend_from_slice(live.finish());
    events
}

#[test]
fn points_and_skeletons_in_any_axes_give_the_same_events() {
    let options = StreamOptions {
        tentative: true,
        ..StreamOptions::default()
    };
    let names = Role::ALL.map(Role::name);
    let upright = by_points(&names, Quat::identity(), &options);
    assert!(upright.iter().filter(|e| e.phase == Phase::End).count() >= 2);
    assert!(upright.iter().any(|e| e.phase == Phase::Start));
    assert!(
        upright
            .iter()
            .map(|e| e.sequence)
            .eq(1..=upright.len() as u64)
    );
    assert_eq!(by_rig(Quat::identity(), None, &options), upright);
    let up = "-z".parse::<morec::SignedAxis>().unwrap();
    let turned = StreamOptions {
        up,
        ..options.clone()
    };
    let bare = |events: Vec<Event>| -> Vec<(Phase, u16, u64)> {
        events
            .iter()
            .map(|e| (e.phase, e.class.0, e.motion))
            .collect()
    };
    let turn = up.to_y().inverse();
    assert_eq!(
        bare(by_points(&names, turn, &turned)),
        bare(upright.clone())
    );
    assert_eq!(
        bare(by_rig(turn, Some(BoneSet::BODY), &turned)),
        bare(upright.clone())
    );
    // Names that tell nothing, and roles that do.
    let strange: Vec<String> = (0..Role::ALL.len()).map(|at| format!("J{at}")).collect();
    let strange: Vec<&str> = strange.iter().map(String::as_str).collect();
    let roles = |role: Role| format!("{role}\tJ{}\n", role.index());
    let roles: String = Role::BODY.map(roles).concat();
    let named = StreamOptions {
        roles: Mapping::read(roles.as_bytes()).unwrap(),
        ..options.clone()
    };
    assert_eq!(
        bare(by_points(&strange, Quat::identity(), &named)),
        bare(upright.clone())
    );
    let error = PerformerStream::of_points(&index(), &strange, &options).unwrap_err();
    assert!(
        error.to_string().starts_with("points: neither a known set"),
        "{error}"
    );
    let ends = by_points(&names, Quat::identity(), &StreamOptions::default());
    assert!(ends.iter().all(|e| e.phase == Phase::End));
}

#[test]
fn a_stream_that_is_made_anew_begins_anew() {
    let mut live =
        PerformerStream::of_rig(&index(), Rig::of_roles(), None, &StreamOptions::default())
            .unwrap();
    let play = |live: &mut PerformerStream| -> Vec<Event> {
        let (mut frame, mut events) = (Frame::default(), Vec::new());
        for (secs, pose) in stream() {
            (frame.time_secs, frame.wall_secs) = (secs, secs);
            frame.set_key_pose(&pose);
            events.extend_from_slice(live.push(&frame));
        }
        events.extend_from_slice(live.finish());
        events
    };
    let first = play(&mut live);
    live.reset().unwrap();
    assert_eq!(play(&mut live), first);
}

#[test]
fn frames_before_a_skeleton_are_counted_and_the_reason_is_known() {
    let model = made::model();
    let mut performer = Performer::new(&model, PerformerId(0), &EventOptions::default());
    let stream: Vec<Timed> = stream();
    let mut frame = Frame::default();
    frame.set_key_pose(&stream[0].1);
    assert!(performer.push(&frame).is_empty());
    assert_eq!(performer.unusable(), 1);
    assert_eq!(performer.problem(), Some(&StartError::NoSkeleton));
    performer.set_rig(&Arc::new(Rig::of_roles()));
    performer.push(&frame);
    assert_eq!((performer.unusable(), performer.problem()), (1, None));
}
