//! How far performances are from samples, said when they end.

use std::collections::BTreeMap;
use std::sync::Arc;

use morec::features::KeyPose;
use morec::index::{MotionIndex, Provenance};
use morec::live::{
    Detection, Event, EventOptions, Frame, Model, Performer, PerformerId, Phase, Rig,
};
use morec::math::{Quat, Vec3};
use morec::roles::{Role, RoleMap};
use morec::templates::TemplateModel;
use morec_measure::explain::deviation;

use crate::made::{self, Timed};

fn played(model: &TemplateModel, poses: &[Timed], options: EventOptions) -> Vec<Event> {
    let mut performer = Performer::new(&Arc::new(model.clone()), PerformerId(0), &options);
    performer.set_rig(&Arc::new(Rig::of_roles()));
    let (mut frame, mut events) = (Frame::default(), Vec::new());
    for (time_secs, pose) in poses {
        frame.time_secs = *time_secs;
        frame.set_key_pose(pose);
        events.extend_from_slice(performer.push(&frame));
    }
    events.extend_from_slice(performer.finish());
    events
}

fn asked(each_repetition: bool) -> EventOptions {
    EventOptions {
        each_repetition,
        deviation: true,
        ..EventOptions::default()
    }
}

/// Forearms turned about the elbow by so many degrees.
fn worse(poses: &[Timed], degrees: f64) -> Vec<Timed> {
    let turn = Quat::from_axis_angle(&Vec3::x_axis(), degrees.to_radians());
    let turned = |pose: &KeyPose| {
        let mut pose = *pose;
        for (elbow, hand) in [
            (Role::LeftForearm, Role::LeftHand),
            (Role::RightForearm, Role::RightHand),
        ] {
            let (elbow, at) = (pose.get(elbow).unwrap(), pose.get(hand).unwrap());
            pose.set(hand, elbow + turn * (at - elbow));
        }
        pose
    };
    poses.iter().map(|(t, pose)| (*t, turned(pose))).collect()
}

#[test]
fn a_gesture_that_ends_is_as_far_off_as_the_clip_says_later() {
    let model = made::model();
    let take = made::performance(60.0);
    let (_, poses) = made::poses(&take);
    assert!(
        played(&model, &poses, EventOptions::default())
            .iter()
            .all(|e| e.deviation.is_none())
    );
    let events = played(&model, &poses, asked(false));
    assert!(events.len() >= 2);
    let found: Vec<Detection> = events.iter().map(Event::detection).collect();
    let parts = (&take.clip, &RoleMap::find(&take.clip.skeleton), &(0..0));
    let later = deviation(&Model::Templates(model.clone()), parts, &found);
    for (event, later) in events.iter().zip(later) {
        let (now, later) = (event.deviation.unwrap(), later.unwrap());
        assert_eq!(now.off_degrees, later.off_degrees);
        assert_eq!(now.pace, later.pace);
        let [worst, ..] = &later.bones[..] else {
            panic!()
        };
        assert_eq!(
            (now.worst_bone, now.worst_degrees),
            (worst.bone, worst.worst_degrees)
        );
    }
}

#[test]
fn each_repetition_of_an_activity_is_compared_and_a_worse_one_is_farther_off() {
    let model = made::activity_model();
    let (_, poses) = made::poses(&made::waving(3));
    let told = |degrees: f64| -> Vec<Event> {
        let events = played(&model, &worse(&poses, degrees), asked(true));
        let (ends, each): (Vec<Event>, Vec<Event>) =
            events.into_iter().partition(|e| e.phase == Phase::End);
        assert!(ends.iter().all(|e| e.deviation.is_none()), "{ends:?}");
        each
    };
    let mean = |events: &[Event]| {
        assert!(events.len() > 4, "{events:?}");
        let off = events.iter().map(|e| e.deviation.unwrap().off_degrees);
        off.sum::<f64>() / events.len() as f64
    };
    let (as_it_is, turned) = (told(0.0), told(20.0));
    assert!(mean(&as_it_is) < 25.0, "{}", mean(&as_it_is));
    assert!(
        mean(&turned) > mean(&as_it_is) + 0.5,
        "{} {}",
        mean(&turned),
        mean(&as_it_is)
    );
    for event in &as_it_is {
        let pace = event.deviation.unwrap().pace;
        assert!((0.5..2.0).contains(&pace), "{event:?}");
    }
}

#[test]
fn an_index_without_repetitions_compares_none_and_recognises_the_same() {
    let mut model = made::activity_model();
    let (_, poses) = made::poses(&made::waving(3));
    let index = MotionIndex {
        model: Arc::new(model.clone()).into(),
        roles: BTreeMap::new(),
        provenance: Provenance::default(),
    };
    let read = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert_eq!(read, index);
    let with = played(&model, &poses, asked(true));
    if let Some(activities) = &mut model.activities {
        assert!(!activities.repetitions.is_empty());
        activities.repetitions.clear();
        activities.step.clear();
    }
    let without = played(&model, &poses, asked(true));
    assert!(without.iter().all(|e| e.deviation.is_none()));
    let plain = |e: &Event| Event {
        deviation: None,
        pace: None,
        ..*e
    };
    assert_eq!(with.iter().map(plain).collect::<Vec<_>>(), without);
}
