//! The thesis's method as a whole: clips to a model, to a file and back, to detections.

use morec::features::{BoneSet, for_each_pose};
use morec::index::MotionIndex;
use morec::labels::Sample;
use morec::live::{Model, Recognizer, recognize_clip};
use morec::roles::RoleMap;
use morec::train::thesis::{SvrdmOptions, SvrdmTrainParams, train_svrdm};
use morec::train::{LabelSet, TrainError};

use crate::thesis_people::{CLASSES, classes, clips, index_of, takes, trained};

#[test]
fn both_settings_come_back_from_their_file_and_recognise_what_they_learned() {
    for params in [SvrdmTrainParams::faithful(), SvrdmTrainParams::tuned()] {
        let (model, report) = trained(params);
        let svrdm = report.svrdm.expect("what this method reports");
        assert_eq!(svrdm.branches.len(), CLASSES.len() - 1);
        let bytes = index_of(model.clone()).to_bytes().unwrap();
        let read = MotionIndex::from_bytes(&bytes).unwrap();
        assert_eq!(read.model, model, "what was trained is what is read");
        assert_eq!(read.to_bytes().unwrap(), bytes);

        let (mut right, mut samples) = (0, 0);
        for take in takes() {
            let roles = RoleMap::find(&take.clip.skeleton);
            let found = recognize_clip(&read.model, &take.clip, &roles, &(0..0)).unwrap();
            samples += take.labels.len();
            right += take
                .labels
                .iter()
                .filter(|label| {
                    found.iter().any(|d| {
                        read.model.class_name(d.class) == label.class
                            && d.span.overlap_share(label.span) > 0.5
                    })
                })
                .count();
            assert!(
                found
                    .iter()
                    .all(|d| d.reported_secs >= d.span.stop_secs && d.span.is_stretch())
            );
        }
        assert!(
            2 * right >= samples,
            "{right} of {samples} samples that it was trained on"
        );
    }
}

#[test]
fn damaged_files_are_errors() {
    let bytes = index_of(trained(SvrdmTrainParams::tuned()).0)
        .to_bytes()
        .unwrap();
    for cut in (0..bytes.len()).step_by(bytes.len() / 97 + 1) {
        assert!(
            MotionIndex::from_bytes(&bytes[..cut]).is_err(),
            "cut at {cut}"
        );
    }
    for at in (8..bytes.len()).step_by(bytes.len() / 211 + 1) {
        let mut altered = bytes.clone();
        altered[at] ^= 0x10;
        assert!(
            MotionIndex::from_bytes(&altered).is_err(),
            "altered at {at}"
        );
    }
}

#[test]
fn places_of_joints_alone_say_nothing_to_it() {
    let (model, _) = trained(SvrdmTrainParams::tuned());
    assert!(model.needs_rotations());
    let take = &takes()[0];
    let roles = RoleMap::find(&take.clip.skeleton);
    let mut recognizer = Recognizer::new(&model, BoneSet::NONE).unwrap();
    for_each_pose(&take.clip, &roles, &(0..0), |secs, pose| {
        assert!(recognizer.push(secs, pose).is_empty())
    });
    assert!(recognizer.finish().is_empty());
}

#[test]
fn thresholds_come_from_left_out_samples_and_background() {
    let (model, report) = trained(SvrdmTrainParams::tuned());
    let estimated = report.svrdm.unwrap().estimated.expect("tuned estimates");
    let Model::Svrdm(model) = model else {
        panic!("another method")
    };
    assert_eq!(model.params.accept, estimated.accept);
    assert_eq!(model.params.min_confidence, estimated.min_confidence);
    assert_eq!(
        estimated.samples,
        takes().iter().map(|t| t.labels.len()).sum::<usize>()
    );
    assert!(estimated.background_minutes > 0.0);
    assert!((0.5..=0.92).contains(&estimated.accept), "{estimated:?}");
    assert!(estimated.wrong <= 0.1, "{estimated:?}");
}

#[test]
fn one_class_or_none_is_refused() {
    let (clips, samples) = clips(takes());
    let train = |classes: &[String], samples: &[Sample]| {
        let labelling = LabelSet {
            samples,
            classes,
            unlabelled_is_background: true,
            ..Default::default()
        };
        train_svrdm(&clips, &labelling, &SvrdmOptions::default(), &())
    };
    assert_eq!(train(&classes(), &[]).unwrap_err(), TrainError::NoSamples);
    let one = vec!["bow".to_owned()];
    let error = train(&one, &samples).unwrap_err();
    assert!(error.to_string().contains("at least 2 classes"), "{error}");
    let more = [classes(), vec!["fly".to_owned()]].concat();
    // A class that nothing shows stops nothing: it is named, and the tree is that of the others.
    let (model, report) = train(&more, &samples).unwrap();
    assert_eq!(model.classes.len(), classes().len());
    assert!(
        report
            .notes
            .iter()
            .any(|n| n.contains("fly: ") && n.contains("never be recognised")),
        "{:?}",
        report.notes
    );
    let first = [vec!["fly".to_owned()], classes()].concat();
    assert_eq!(train(&first, &samples).unwrap().0, model);
}
