//! Clips of synthetic people, cut around one motion each.

use crate::TimeSpan;
use crate::import::Take;
use crate::live::recognize_clip;
use crate::synth::{DatabaseSpec, SyntheticTake, database};
use crate::train::{LabelSet, TrainClip, TrainOptions, TrainParams, train_clips};

use super::*;

const CLASSES: [&str; 3] = ["wave", "bow", "clap"];

fn takes() -> Vec<SyntheticTake> {
    let spec = DatabaseSpec {
        people: 3,
        repetitions: 2,
        classes: CLASSES.to_vec(),
        ..Default::default()
    };
    database(5, &spec)
}

/// An index of all takes but the first.
fn trained(takes: &[SyntheticTake], change: impl FnOnce(&mut TrainParams)) -> Model {
    let clips: Vec<TrainClip> = takes[1..]
        .iter()
        .map(|take| TrainClip {
            person: Some(take.person.clone()),
            ..Take::new(take.clip.clone()).unwrap().into()
        })
        .collect();
    let samples: Vec<_> = takes[1..].iter().flat_map(SyntheticTake::samples).collect();
    let labelling = LabelSet {
        samples: &samples,
        classes: &CLASSES.map(str::to_owned),
        unlabelled_is_background: true,
        ..Default::default()
    };
    let mut options = TrainOptions::default();
    change(&mut options.params);
    let (model, _) = train_clips(&clips, &labelling, &options, &()).unwrap();
    model.into()
}

/// The frames of a span of a take.
fn cut(take: &SyntheticTake, span: TimeSpan) -> Take {
    let clip = &take.clip;
    let joints = clip.skeleton.len();
    let frames = span.frames(clip.rate_hz);
    let (first, last) = (frames.start.min(clip.frames), frames.end.min(clip.frames));
    let mut part = clip.clone();
    part.rotations = clip.rotations[first * joints..last * joints].to_vec();
    for track in &mut part.tracks {
        track.positions = track.positions[first..last].to_vec();
    }
    part.frames = last - first;
    Take::new(part).unwrap()
}

fn classify(classifier: &Classifier, take: &Take) -> ClassifiedClip {
    let classified = classifier.classify(&take.clip, &take.roles, take.rest());
    classified.unwrap()
}

#[test]
fn clips_around_one_motion_are_named_after_it_with_and_without_a_second_look() {
    let takes = takes();
    for judge_whole in [true, false] {
        let model = trained(&takes, |params| params.judge_whole = judge_whole);
        let classifier = Classifier::new(&model).unwrap();
        for label in &takes[0].labels {
            let found = classify(&classifier, &cut(&takes[0], label.span));
            let names = |class: Option<ClassId>| class.map(|c| CLASSES[c.index()]);
            assert_eq!(names(found.class), Some(label.class), "{found:?}");
            assert_eq!(found.nearest, found.class);
            let sum: f64 = found.probabilities.iter().sum();
            assert!(0.5 < sum && sum < 1.0, "{found:?}");
            let own = found.probabilities[found.class.unwrap().index()];
            assert!(found.probabilities.iter().all(|p| *p <= own));
        }
    }
}

#[test]
fn what_hardly_moves_is_none_of_the_classes() {
    let takes = takes();
    for judge_whole in [true, false] {
        let model = trained(&takes, |params| params.judge_whole = judge_whole);
        let classifier = Classifier::new(&model).unwrap();
        let still = cut(&takes[0], TimeSpan::new(0.0, 0.8));
        let found = classify(&classifier, &still);
        assert_eq!(found.class, None, "{found:?}");
        let empty = cut(&takes[0], TimeSpan::new(1.0, 1.0));
        let found = classify(&classifier, &empty);
        assert_eq!((found.class, found.nearest), (None, None));
        assert_eq!(found.probabilities, [0.0; 3]);
    }
}

#[test]
fn activities_are_compared_as_wholes_and_reported_by_their_windows() {
    let takes = takes();
    let waves = ["wave".to_owned()];
    let model = trained(&takes, |params| params.set_kinds(&waves, &[]));
    let Model::Templates(templates) = &model else {
        unreachable!("templates were trained")
    };
    let look = templates.look.as_ref().unwrap();
    let wave = ClassId(0);
    assert!(templates.activities.as_ref().unwrap().holds(wave) && look.classes.contains(&wave));
    let classifier = Classifier::new(&model).unwrap();
    for label in takes[0].labels.iter().filter(|label| label.class == "wave") {
        let found = classify(&classifier, &cut(&takes[0], label.span));
        assert_eq!(found.class, Some(wave), "{found:?}");
    }
    let take = Take::new(takes[0].clip.clone()).unwrap();
    let found = recognize_clip(&model, &take.clip, &take.roles, take.rest()).unwrap();
    for label in &takes[0].labels {
        let here = found.iter().filter(|d| d.span.overlaps(label.span));
        assert!(here.count() <= 1, "{found:?} in {label:?}");
    }
}
