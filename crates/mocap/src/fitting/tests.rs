use super::*;
use crate::clip::Points;
use crate::import::{ImportOptions, normalize};
use crate::testing::pushing;

/// Somebody who pushes, as it is and as points where roles are.
fn person() -> (Take, Take) {
    let ready =
        |clip| normalize(clip, &ImportOptions::default()).expect("no mapping that could be wrong");
    let skeleton = ready(pushing());
    let points = skeleton.clip.to_points(Some(1.0));
    (skeleton, ready(points))
}

#[test]
fn a_body_of_fixed_lengths_is_found_again() {
    let (skeleton, points) = person();
    let fit = fit_skeleton(&points).unwrap();
    assert!(
        fit.rms_metres < 0.004,
        "{} m, {:?}",
        fit.rms_metres,
        fit.worst
    );
    assert_eq!(fit.clip.frames, points.clip.frames);
    // Bones point where they did. The shoulders of the person are on collars, which the fitted body shares.
    let mut angles = Vec::new();
    for frame in (0..fit.clip.frames).step_by(7) {
        let (found, was) = (
            WorldPose::of(&fit.clip, frame),
            WorldPose::of(&skeleton.clip, frame),
        );
        for [from, to] in [
            [Role::LeftArm, Role::LeftForearm],
            [Role::RightForearm, Role::RightHand],
            [Role::LeftThigh, Role::LeftShin],
            [Role::RightShin, Role::RightFoot],
        ] {
            let bone = |pose: &WorldPose, roles: &RoleMap| {
                (pose.positions[roles.joint(to).unwrap()]
                    - pose.positions[roles.joint(from).unwrap()])
                .normalize()
            };
            let angle = bone(&found, &fit.roles)
                .angle(&bone(&was, &skeleton.roles))
                .to_degrees();
            assert!(angle < 5.0, "{frame} {from}: {angle}°");
            angles.push(angle);
        }
    }
    let mean = angles.iter().sum::<f64>() / angles.len() as f64;
    assert!(mean < 1.5, "{mean}°");
    // Lengths do not change, and no joint spins about itself between frames.
    assert_eq!(fit.clip.tracks.len(), 1);
    for frame in 1..fit.clip.frames {
        let (a, b) = (
            fit.clip.frame_rotations(frame - 1),
            fit.clip.frame_rotations(frame),
        );
        for (joint, (a, b)) in a.iter().zip(b).enumerate() {
            assert!(
                a.angle_to(b) < 1.0,
                "{frame} {}",
                fit.clip.skeleton.joints()[joint].name
            );
        }
    }
}

#[test]
fn residuals_say_how_far_the_points_are() {
    let (_, mut points) = person();
    let hand = points.roles.joint(Role::LeftHand).unwrap();
    // Every other frame the hand is 10 cm farther along the forearm.
    let elbow = points.roles.joint(Role::LeftForearm).unwrap();
    let elbows = points.clip.track(elbow).unwrap().positions.clone();
    let track = points
        .clip
        .tracks
        .iter_mut()
        .find(|t| t.joint == hand)
        .unwrap();
    for (frame, at) in track
        .positions
        .iter_mut()
        .enumerate()
        .filter(|(f, _)| f % 2 == 0)
    {
        *at += (*at - elbows[frame]).normalize() * 0.1;
    }
    let fit = fit_skeleton(&points).unwrap();
    assert_eq!(fit.worst.0, Role::LeftHand);
    assert!((0.01..0.1).contains(&fit.worst.1), "{:?}", fit.worst);
}

#[test]
fn gaps_are_bridged_and_what_is_not_there_is_said() {
    let (skeleton, mut points) = person();
    let knee = points.roles.joint(Role::LeftShin).unwrap();
    let gap = crate::clip::Gap {
        joint: knee,
        frames: 5..25,
    };
    let track = points
        .clip
        .tracks
        .iter_mut()
        .find(|t| t.joint == knee)
        .unwrap();
    track.positions[5..25].fill(Vec3::new(9.0, 9.0, 9.0));
    points.clip.points = Some(Points {
        gaps: vec![gap],
        ..Points::default()
    });
    let fit = fit_skeleton(&points).unwrap();
    assert!(fit.rms_metres < 0.004, "{} m", fit.rms_metres);
    let foot =
        |pose: &WorldPose, roles: &RoleMap| pose.positions[roles.joint(Role::LeftFoot).unwrap()];
    let (found, was) = (
        WorldPose::of(&fit.clip, 15),
        WorldPose::of(&skeleton.clip, 15),
    );
    assert!((foot(&found, &fit.roles) - foot(&was, &skeleton.roles)).norm() < 0.02);
    assert_eq!(fit_skeleton(&skeleton), Err(FitError::HasRotations));
    points.roles.set(Role::LeftThigh, None);
    assert_eq!(
        fit_skeleton(&points),
        Err(FitError::Missing(Role::LeftThigh))
    );
}
