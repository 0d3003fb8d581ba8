//! Each reason brought about on purpose, on synthetic people.

use crate::perturb::{Perturbation, perturb};
use morec::clip::{Clip, Span};
use morec::features::{FeatureParams, FeatureStream, Rows, bones_of_clip, for_each_pose};
use morec::import::Take;
use morec::live::{Model, recognize_clip};
use morec::math::Axis;
use morec::roles::{Role, RoleMap};
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use morec::train::{LabelSet, StreamKind, TrainClip, TrainOptions, train_clips};

use super::*;

const CLASSES: [&str; 2] = ["wave", "bow"];

fn takes() -> Vec<SyntheticTake> {
    let spec = DatabaseSpec {
        people: 3,
        repetitions: 2,
        classes: CLASSES.to_vec(),
        ..Default::default()
    };
    database(5, &spec)
}

struct Played {
    clip: Clip,
    roles: RoleMap,
    rest: Span,
}

fn played(clip: Clip) -> Played {
    let take = Take::new(clip).unwrap();
    Played {
        rest: take.rest().clone(),
        clip: take.clip,
        roles: take.roles,
    }
}

/// An index of all takes but the last.
fn trained(takes: &[SyntheticTake], change: impl Fn(&mut TrainOptions)) -> Model {
    let (mut clips, mut samples) = (Vec::new(), Vec::new());
    for take in takes {
        let Played { clip, roles, rest } = played(take.clip.clone());
        clips.push(TrainClip {
            name: take.clip.name.clone(),
            clip,
            roles,
            rest,
            source: StreamKind::Labelled,
            person: Some(take.person.clone()),
        });
        samples.extend(take.samples());
    }
    let labelling = LabelSet {
        samples: &samples,
        classes: &CLASSES.map(str::to_owned),
        unlabelled_is_background: true,
        ..Default::default()
    };
    let mut options = TrainOptions::default();
    change(&mut options);
    train_clips(&clips, &labelling, &options, &())
        .unwrap()
        .0
        .into()
}

/// The reason given for the first label of `take`.
fn reason(model: &Model, take: &SyntheticTake, class: Option<&str>) -> Miss {
    let played = played(take.clip.clone());
    let found = recognize_clip(model, &played.clip, &played.roles, &played.rest).unwrap();
    let label = &take.labels[0];
    let sought = Mark {
        class: class.unwrap_or(label.class),
        span: label.span,
    };
    let parts = (&played.clip, &played.roles, &played.rest);
    explain(model, parts, &[sought], &found).remove(0)
}

#[test]
fn a_class_the_index_does_not_know_is_named_as_such() {
    let takes = takes();
    let model = trained(&takes[1..], |_| {});
    let miss = reason(&model, &takes[0], Some("kick"));
    assert_eq!(miss.reason, Reason::NoSuchClass);
}

#[test]
fn far_is_said_with_the_distance_and_the_bones() {
    let takes = takes();
    let model = changed(&takes[1..], |model| {
        model.look = None;
        model.threshold = 1e-3;
    });
    let miss = reason(&model, &takes[0], None);
    let Reason::Far {
        distance,
        threshold,
        ..
    } = miss.reason
    else {
        panic!("{:?}", miss.reason)
    };
    assert!(distance > threshold && threshold < 0.01);
}

#[test]
fn another_class_is_far_in_the_bones_that_move() {
    let takes = takes();
    let model = changed(&takes[1..], |model| model.look = None);
    // A wave looked for where somebody bows, or the other way round.
    let other = if takes[0].labels[0].class == "wave" {
        "bow"
    } else {
        "wave"
    };
    let miss = reason(&model, &takes[0], Some(other));
    match &miss.reason {
        Reason::Far { bones, .. } => assert!(!bones.is_empty(), "{miss:?}"),
        Reason::NoMatch | Reason::OtherClass { .. } | Reason::Still { .. } => {}
        found => panic!("{found:?}"),
    }
}

/// The templates of an index that `change` was done to.
fn changed(takes: &[SyntheticTake], change: impl FnOnce(&mut TemplateModel)) -> Model {
    let Model::Templates(model) = trained(takes, |_| {}) else {
        unreachable!("templates were trained")
    };
    let mut model = (*model).clone();
    change(&mut model);
    model.into()
}

#[test]
fn a_motion_that_hardly_moves_is_gated() {
    let takes = takes();
    let model = changed(&takes[1..], |model| model.decode.rest_gate = 1e-4);
    let miss = reason(&model, &takes[0], None);
    assert!(matches!(miss.reason, Reason::Still { .. }), "{miss:?}");
}

#[test]
fn a_motion_that_is_not_like_the_samples_as_a_whole_is_named_as_such() {
    let takes = takes();
    let strict = |model: &mut TemplateModel| {
        let look = model.look.as_mut().unwrap();
        look.bound = 99.0;
        let point = |alarms_per_minute, threshold| OperatingPoint {
            alarms_per_minute,
            threshold,
        };
        look.operating = vec![point(0.1, 99.0), point(1.0, 0.1)];
    };
    let miss = reason(&changed(&takes[1..], strict), &takes[0], None);
    let Reason::Whole {
        score,
        bound,
        other,
    } = &miss.reason
    else {
        panic!("{miss:?}")
    };
    assert!(
        score < bound && *bound == 99.0 && other.is_none(),
        "{miss:?}"
    );
    // At the rate of the second point it would have been reported.
    assert_eq!(miss.sensitivity, Some(1.0));
}

#[test]
fn a_sensitivity_that_changes_nothing_is_not_named() {
    let takes = takes();
    let strict = |model: &mut TemplateModel| {
        let look = model.look.as_mut().unwrap();
        look.bound = 99.0;
        look.operating = vec![OperatingPoint {
            alarms_per_minute: 1.0,
            threshold: 0.1,
        }];
        // Whatever the bound: too little movement.
        model.decode.rest_gate = 1e-4;
    };
    let miss = reason(&changed(&takes[1..], strict), &takes[0], None);
    assert!(matches!(miss.reason, Reason::Whole { .. }), "{miss:?}");
    assert_eq!(miss.sensitivity, None);
}

#[test]
fn a_detection_that_took_the_place_is_named() {
    let takes = takes();
    let model = trained(&takes[1..], |_| {});
    let played = played(takes[0].clip.clone());
    let label = &takes[0].labels[0];
    let found = recognize_clip(&model, &played.clip, &played.roles, &played.rest).unwrap();
    let sought = Mark {
        class: label.class,
        span: label.span,
    };
    let parts = (&played.clip, &played.roles, &played.rest);
    let miss = explain(&model, parts, &[sought], &found).remove(0);
    assert!(
        matches!(&miss.reason, Reason::Neighbour { same: true, class, .. } if class == label.class),
        "what was reported is its own neighbour: {miss:?}"
    );
}

#[test]
fn a_larger_sensitivity_is_named_where_it_would_help() {
    let takes = takes();
    let Model::Templates(model) = trained(&takes[1..], |_| {}) else {
        unreachable!("templates were trained")
    };
    let mut strict = (*model).clone();
    strict.threshold = 1e-3;
    strict.look = None;
    strict.operating = vec![
        OperatingPoint {
            alarms_per_minute: 0.1,
            threshold: 1e-3,
        },
        OperatingPoint {
            alarms_per_minute: 0.5,
            threshold: 90.0,
        },
        OperatingPoint {
            alarms_per_minute: 1.0,
            threshold: 99.0,
        },
    ];
    let miss = reason(&strict.into(), &takes[0], None);
    assert_eq!(miss.sensitivity, Some(0.5));
}

/// The deviations of the first label of `take`, with the right forearm turned by `degrees`.
fn turned(model: &Model, take: &SyntheticTake, degrees: f64) -> MotionDeviation {
    let mut played = played(take.clip.clone());
    let elbow = played.roles.joint(Role::RightForearm).unwrap();
    let joints = played.clip.skeleton.len();
    let turn = Axis::Y.rotation(degrees.to_radians());
    for frame in 0..played.clip.frames {
        let rotation = &mut played.clip.rotations[frame * joints + elbow];
        *rotation = turn * *rotation;
    }
    let label = &take.labels[0];
    let class = model.classes().iter().position(|c| c.name == label.class);
    let motion = Detection {
        class: ClassId(class.unwrap() as u16),
        span: label.span,
        score: 1.0,
        reported_secs: label.span.stop_secs,
        repetitions: None,
    };
    let parts = (&played.clip, &played.roles, &played.rest);
    deviation(model, parts, &[motion]).remove(0).unwrap()
}

#[test]
fn worse_performances_are_farther_off_and_the_limb_is_named() {
    let takes = takes();
    let model = trained(&takes[1..], |_| {});
    // The teacher's own performance is the nearest sample, but for where its ticks lie.
    let own = turned(&model, &takes[1], 0.0);
    assert!(
        own.off_degrees < 3.0 && (own.pace - 1.0).abs() < 0.1,
        "{own:?}"
    );
    let stranger = [0.0, 15.0, 30.0, 60.0].map(|degrees| turned(&model, &takes[0], degrees));
    assert!(own.off_degrees < stranger[0].off_degrees);
    for pair in stranger.windows(2) {
        assert!(pair[0].off_degrees < pair[1].off_degrees, "{pair:?}");
    }
    let [.., worst] = &stranger;
    let bone = &worst.bones[0];
    assert_eq!(bone.bone, "right_forearm");
    let label = &takes[0].labels[0];
    assert!((label.span.start_secs - 0.1..label.span.stop_secs + 0.1).contains(&bone.worst_secs));
    let mean = worst.over_time_degrees.iter().sum::<f64>() / worst.over_time_degrees.len() as f64;
    assert!(
        (mean / worst.off_degrees - 1.0).abs() < 0.3,
        "{mean} {}",
        worst.off_degrees
    );
}

#[test]
fn worse_captures_rank_below_better_ones_whatever_makes_them_worse() {
    let takes = takes();
    let Played { clip, roles, rest } = played(takes[1].clip.clone());
    let (label, params) = (&takes[1].labels[0], FeatureParams::default());
    let bones = bones_of_clip(&clip, &roles, &rest);
    let rows = |list: &[Perturbation]| {
        let mut poses = Vec::new();
        for_each_pose(&clip, &roles, &rest, |secs, pose| poses.push((secs, *pose)));
        let mut stream = FeatureStream::new(bones, &params);
        let mut rows = Rows::new(stream.dim());
        for (secs, pose) in perturb(poses, list, 3).poses {
            stream.push(secs, &pose, &mut |row| rows.push(row));
        }
        stream.finish(&mut |row| rows.push(row));
        let tick = |secs: f64| (secs * params.tick_hz()).round() as usize;
        rows.slice(tick(label.span.start_secs)..tick(label.span.stop_secs))
    };
    let sample = rows(&[]);
    let off = |worse: Perturbation| {
        let found = deviation_from(&sample, &rows(&[worse]), bones, 0.0, params.tick_hz());
        found.unwrap().off_degrees
    };
    let metres = |kind: fn(f64) -> Perturbation| [0.005, 0.01, 0.02, 0.04, 0.08].map(kind);
    let strengths = [
        metres(Perturbation::White),
        metres(Perturbation::Slow),
        metres(Perturbation::Constant),
        metres(|size| Perturbation::Tilt(250.0 * size)),
        metres(|size| Perturbation::Camera(50.0 * size)),
    ];
    for of_kind in strengths {
        let degrees = of_kind.map(off);
        assert!(degrees[0] > 0.0, "{of_kind:?}: {degrees:?}");
        let ranked = degrees.windows(2).all(|pair| pair[0] < pair[1]);
        assert!(ranked, "{of_kind:?}: {degrees:?}");
    }
}

#[test]
fn a_distance_that_nothing_has_is_no_number() {
    let refused = |other| Reason::Refused {
        score: -0.1,
        other,
        background: 1.25,
    };
    assert!(
        refused(3e29)
            .to_string()
            .contains("as similar to background motion as")
    );
    assert!(
        refused(1.2)
            .to_string()
            .contains("as similar to another class as")
    );
    let far = Reason::Far {
        distance: 1e30,
        threshold: 1.8,
        bones: Vec::new(),
    };
    assert_eq!(
        far.to_string(),
        "too different from the samples, far over the limit"
    );
}

/// Reasons are read by people who know motions and not the method: what is compared, and no distances.
#[test]
fn reasons_are_in_the_words_of_whoever_labels() {
    let reasons = [
        Reason::Still {
            share: 0.7,
            most: 0.6,
        },
        Reason::Background {
            distance: 2.0,
            negative: 1.5,
        },
        Reason::OtherClass {
            class: "clap".to_owned(),
            distance: 2.0,
            other: 1.0,
        },
        Reason::GoesOnUnlike {
            share: 1.2,
            nearer: Some(("walk".to_owned(), 0.5)),
        },
        Reason::Refused {
            score: -0.5,
            other: 1.1,
            background: 3.0,
        },
        Reason::Far {
            distance: 2.04,
            threshold: 1.82,
            bones: vec![BoneOff {
                bone: "right_forearm",
                degrees: 42.3,
            }],
        },
    ];
    let said = reasons.map(|reason| reason.to_string());
    assert_eq!(
        said,
        [
            "too little movement to distinguish from standing still",
            "more similar to background motion than to the samples",
            "more similar to clap than to the samples of its own class",
            "continues more like walk than like the samples of its own class",
            "not clear enough: nearly as similar to another class as to the samples of its own class",
            "too different from the samples, 12 % over the limit; most in right forearm (42°)",
        ]
    );
}
