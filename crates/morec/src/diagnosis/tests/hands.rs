//! Hands: their size, what of them is missing, losses and exchanged sides.

use crate::diagnosis::{Diagnoser, Diagnosis, Finding, Severity, diagnose_clip};
use crate::features::{Hand, KeyPose, Profile};
use crate::import::Take;
use crate::math::Vec3;
use crate::roles::Role;
use mocap::testing::{at_a_desk, clip_of_hands, flat_hand};

/// A hand that opens and closes and goes round.
fn moving(hand: Hand, secs: f64, scale: f64) -> KeyPose {
    let mut pose = flat_hand(hand, 0.4 + 0.3 * (3.0 * secs).sin(), scale);
    let way = Vec3::new((2.0 * secs).cos(), 1.0, (2.0 * secs).sin()) * 0.1 * scale;
    for role in Role::ALL {
        if let Some(place) = pose.get(role) {
            pose.set(role, place + way);
        }
    }
    pose
}

/// Half a minute, 50 frames a second.
fn diagnosis(of: impl Fn(f64) -> KeyPose) -> Diagnosis {
    let mut diagnoser = Diagnoser::whole();
    for frame in 0..1500 {
        let secs = f64::from(frame) / 50.0;
        diagnoser.push(secs, secs, &of(secs));
    }
    diagnoser.diagnosis()
}

#[test]
fn a_hand_is_no_body_without_hips() {
    for (hand, scale, unit) in [(Hand::Right, 1.0, 1.0), (Hand::Left, 1000.0, 0.001)] {
        let found = diagnosis(|secs| moving(hand, secs, scale));
        assert_eq!(found.findings().iter().count(), 0, "{:?}", found.findings());
        assert_eq!(
            (found.profile, found.metres_per_unit),
            (Profile::Hand, unit)
        );
        assert!((found.hand_m.unwrap() - 0.187).abs() < 1e-3);
        assert!(
            found.to_string().starts_with("a hand, 19 cm long"),
            "{found}"
        );
    }
}

#[test]
fn points_of_a_hand_are_missing_where_the_hand_is_seen() {
    // Away half of the time, without a ring finger's tip, with a little finger's tip now and then.
    let found = diagnosis(|secs| {
        let mut pose = moving(Hand::Right, secs, 1.0);
        let tips = (Role::RightRingTip, Role::RightLittleTip);
        let kept = |role: Role| role != tips.0 && (role != tips.1 || secs % 1.0 < 0.4);
        let shown = pose.roles().filter(|role| secs % 10.0 < 5.0 && kept(*role));
        let shown: Vec<Role> = shown.collect();
        pose = shown
            .into_iter()
            .fold(KeyPose::default(), |mut part, role| {
                part.set(role, pose.get(role).unwrap_or_default());
                part
            });
        pose
    });
    let findings = found.findings();
    let kinds: Vec<&Finding> = findings.iter().collect();
    let missing = |f: &&Finding| matches!(f, Finding::JointsMissing { roles } if roles.iter().eq([Role::RightRingTip]));
    let flickers = |f: &&Finding| matches!(f, Finding::JointsFlicker { roles } if roles.iter().eq([Role::RightLittleTip]));
    let lost = |f: &&Finding| matches!(f, Finding::HandLost { per_minute } if (per_minute - 4.0).abs() < 0.5);
    assert!(kinds.iter().any(missing), "{kinds:?}");
    assert!(kinds.iter().any(flickers), "{kinds:?}");
    assert!(kinds.iter().any(lost), "{kinds:?}");
    assert_eq!(kinds.len(), 3, "{kinds:?}");
}

#[test]
fn hands_that_change_places_are_told() {
    let other = |hand: Hand| match hand {
        Hand::Left => Hand::Right,
        Hand::Right => Hand::Left,
    };
    // One hand, whose side changes every three seconds; two hands apart, that do so.
    let side = |secs: f64| match secs % 6.0 < 3.0 {
        true => Hand::Left,
        false => Hand::Right,
    };
    let one = diagnosis(|secs| moving(side(secs), secs, 1.0));
    let two = diagnosis(|secs| {
        let mut pose = moving(side(secs), secs, 1.0);
        let beside = moving(other(side(secs)), secs, 1.0);
        for role in beside.roles() {
            pose.set(role, beside.get(role).unwrap_or_default() + Vec3::x() * 0.5);
        }
        pose
    });
    let calm = diagnosis(|secs| moving(Hand::Left, secs, 1.0));
    for (found, swaps) in [(one, 18.0), (two, 18.0), (calm, 0.0)] {
        assert!((found.swaps_per_minute - swaps).abs() < 1.0, "{found:?}");
        assert!(found.losses_per_minute < 0.1);
    }
    assert!(two.findings().iter().any(|f| {
        f.to_string()
            .starts_with("left and right hand are exchanged 18 times a minute")
    }));
}

#[test]
fn clips_of_half_a_body_and_of_hands_are_in_order() {
    let found = |clip| {
        let take = Take::new(clip).unwrap();
        diagnose_clip(&take.clip, &take.roles, take.rest())
    };
    let half = found(at_a_desk("Neck"));
    let worst = half.findings().worst().map(|finding| finding.severity());
    assert_eq!(worst, Some(Severity::Info));
    for hands in [&[Hand::Left][..], &[Hand::Right], &Hand::BOTH] {
        let found = found(clip_of_hands(hands, |hand, at| format!("{hand:?}_{at}")));
        assert_eq!(found.findings().len(), 0, "{:?}", found.findings());
    }
}
