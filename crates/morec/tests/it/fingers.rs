//! Bodies with fingers: hands of a skeleton are taught and recognised by its joints' names.

use morec::clip::{Clip, Joint, Skeleton};
use morec::features::BoneSet;
use morec::kinematics::for_each_world_pose;
use morec::labels::Sample;
use morec::live::{EventOptions, Frame, Model, Performer, PerformerId, Phase, Rig, recognize_clip};
use morec::math::{Quat, Vec3};
use morec::roles::{Role, RoleMap};
use morec::synth::{Person, Script};
use morec::train::{LabelSet, StreamKind, TrainClip, TrainOptions, train_clips};
use std::sync::Arc;

use morec::TimeSpan;

const FINGERS: [&str; 5] = ["Thumb", "Index", "Middle", "Ring", "Pinky"];
/// When a fist is made, seconds.
const FISTS: [f64; 4] = [3.0, 6.5, 9.0, 12.5];
const FIST_SECS: f64 = 1.2;

/// Somebody who stands, and makes fists with the right hand. The skeleton names its fingers as Mixamo does.
fn fists(number: usize) -> TrainClip {
    let script = Script::new(60 + number as u64, Person::draw(61, number)).rest(16.0);
    let take = script.film(&format!("fists{number}"), 30.0).unwrap();
    let body = take.clip;
    let hands = [Role::LeftHand, Role::RightHand];
    let wrists = hands.map(|role| RoleMap::find(&body.skeleton).joint(role).unwrap());
    let mut joints = body.skeleton.joints().to_vec();
    // The axis that each new joint bends about; none of the left hand.
    let mut axes = Vec::new();
    for (side, wrist) in ["Left", "Right"].into_iter().zip(wrists) {
        let forward = joints[wrist].offset.normalize();
        let across = forward.cross(&Vec3::new(0.3, 0.5, 0.8)).normalize();
        for (finger, name) in FINGERS.iter().enumerate() {
            let mut parent = wrist;
            for point in 1..=4 {
                let offset = match point {
                    1 => forward * 0.09 + across * (0.02 * (finger as f64 - 2.0)),
                    _ => forward * 0.03,
                };
                joints.push(Joint {
                    name: format!("mixamorig:{side}Hand{name}{point}"),
                    parent: Some(parent),
                    offset,
                    tip: None,
                });
                axes.push((side == "Right").then_some(across));
                parent = joints.len() - 1;
            }
        }
    }
    let mut rotations = Vec::new();
    for frame in 0..body.frames {
        let own = frame * body.skeleton.len()..(frame + 1) * body.skeleton.len();
        rotations.extend_from_slice(&body.rotations[own]);
        let bend = bend(frame as f64 / 30.0);
        rotations.extend(axes.iter().map(|axis| {
            axis.map_or(Quat::identity(), |axis| {
                Quat::from_scaled_axis(axis * (0.1 + bend))
            })
        }));
    }
    let skeleton = Skeleton::new(joints).unwrap();
    TrainClip {
        name: body.name.clone(),
        roles: RoleMap::find(&skeleton),
        rest: 0..0,
        source: StreamKind::Labelled,
        person: None,
        clip: Clip {
            skeleton,
            rotations,
            ..body
        },
    }
}

/// Bend of each joint of a finger, radians: shut and open again in the time of a fist.
fn bend(secs: f64) -> f64 {
    let phases = FISTS.iter().map(|start| (secs - start) / FIST_SECS);
    let within = phases.filter(|phase| (0.0..1.0).contains(phase));
    within
        .map(|phase| 1.2 * (std::f64::consts::PI * phase).sin())
        .sum()
}

fn trained(bones: BoneSet) -> Model {
    let clips = [fists(1), fists(2)];
    let samples: Vec<Sample> = clips
        .iter()
        .flat_map(|clip| {
            FISTS.map(|start_secs| Sample {
                clip: clip.name.clone(),
                class: "fist".to_owned(),
                span: TimeSpan::new(start_secs, start_secs + FIST_SECS),
                whole_clip: false,
                person: None,
                line: 2,
            })
        })
        .collect();
    let labelling = LabelSet {
        samples: &samples,
        classes: &["fist".to_owned()],
        unlabelled_is_background: true,
        ..LabelSet::default()
    };
    let options = TrainOptions {
        bones,
        ..TrainOptions::default()
    };
    let (model, _) = train_clips(&clips, &labelling, &options, &()).unwrap();
    Model::from(model)
}

#[test]
fn fists_of_a_body_are_recognised_where_fingers_count() {
    let stranger = fists(3);
    assert!(!stranger.roles.played().any(|(role, _)| role.is_of_hand()));
    let model = trained(BoneSet::HANDS);
    let found = recognize_clip(&model, &stranger.clip, &stranger.roles, &stranger.rest).unwrap();
    let middles: Vec<f64> = (found.iter()).map(|d| d.span.middle_secs()).collect();
    assert_eq!(found.len(), FISTS.len(), "{middles:?}");
    for (middle, start) in middles.iter().zip(FISTS) {
        assert!(
            (middle - start - FIST_SECS / 2.0).abs() < 0.3,
            "{middles:?}"
        );
    }
    // The same live, from the skeleton that a source describes.
    let mut performer = Performer::new(&model, PerformerId(0), &EventOptions::default());
    let rig = Rig {
        skeleton: stranger.clip.skeleton.clone(),
        roles: stranger.roles.clone(),
    };
    let mut ends = Vec::new();
    let mut say = |events: &[morec::live::Event]| {
        let of_end = events.iter().filter(|event| event.phase == Phase::End);
        ends.extend(of_end.map(morec::live::Event::detection));
    };
    performer.set_rig(&Arc::new(rig));
    let mut frame = Frame::default();
    for_each_world_pose(&stranger.clip, &stranger.rest, |time_secs, world| {
        frame.time_secs = time_secs;
        frame.pose.clone_from(world);
        say(performer.push(&frame));
    });
    say(performer.finish());
    assert_eq!(ends, found);
}

#[test]
fn a_body_stays_a_body_unless_fingers_are_asked_for() {
    let Model::Templates(model) = trained(BoneSet::BODY) else {
        unreachable!()
    };
    assert!(model.bones.and(BoneSet::HANDS).is_empty());
}
