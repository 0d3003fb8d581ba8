//! Clips of synthetic people, cut around one motion each.

use crate::clip::Clip;
use crate::import::Take;
use crate::synth::{DatabaseSpec, SyntheticTake, database};
use crate::train::{LabelSet, TrainClip, TrainOptions, train_clips};

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
fn trained(takes: &[SyntheticTake], judge_whole: bool) -> Model {
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
    options.params.judge_whole = judge_whole;
    let (model, _) = train_clips(&clips, &labelling, &options, &()).unwrap();
    assert_eq!(model.look.is_some(), judge_whole);
    model.into()
}

/// The frames of `span` of a clip.
fn cut(clip: &Clip, span: crate::TimeSpan) -> Take {
    let hz = clip.rate_hz;
    let frames = (span.start_secs * hz) as usize..((span.stop_secs * hz) as usize).min(clip.frames);
    Take::new(clip.part(frames)).unwrap()
}

fn classify(classifier: &Classifier, take: &Take) -> Classification {
    let classified = classifier.classify(&take.clip, &take.roles, take.rest());
    classified.unwrap()
}

#[test]
fn clips_around_one_motion_are_named_after_it_with_and_without_a_second_look() {
    let takes = takes();
    for judge_whole in [true, false] {
        let model = trained(&takes, judge_whole);
        let classifier = Classifier::new(&model).unwrap();
        for label in &takes[0].labels {
            let found = classify(&classifier, &cut(&takes[0].clip, label.span));
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
        let model = trained(&takes, judge_whole);
        let classifier = Classifier::new(&model).unwrap();
        let still = cut(&takes[0].clip, crate::TimeSpan::new(0.0, 0.8));
        let found = classify(&classifier, &still);
        assert_eq!(found.class, None, "{found:?}");
        let empty = Take {
            clip: takes[0].clip.part(0..0),
            ..still
        };
        let found = classify(&classifier, &empty);
        assert_eq!((found.class, found.nearest), (None, None));
        assert_eq!(found.probabilities, [0.0; 3]);
    }
}
