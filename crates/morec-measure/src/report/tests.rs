//! Properties that a reader of the report may rely on.

use super::*;
use crate::eval::tests::truth;
use crate::eval::{self, timelines};
use crate::explain::{BoneDeviation, MotionDeviation, Reason};
use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth, StreamInfo};

fn found(clip: &str, class: &str, start_secs: f64, stop_secs: f64) -> ClipDetection {
    ClipDetection {
        score: Some(0.5),
        ..eval::tests::found(clip, class, start_secs, stop_secs)
    }
}

fn stream(clip: &str, duration_secs: f64, unknown: bool) -> StreamInfo {
    StreamInfo {
        clip: clip.into(),
        duration_secs,
        unknown,
    }
}

fn report(
    infos: &[StreamInfo],
    truths: &[GroundTruth],
    founds: &[ClipDetection],
    training: &[TrainedClass],
) -> String {
    let evaluation = Evaluation::of(infos, truths, founds).unwrap();
    let timelines = timelines(infos, truths, founds).unwrap();
    let about = [("command".to_owned(), "<morec>".to_owned())];
    Report {
        title: "A & B",
        about: &about,
        evaluation: &evaluation,
        timelines: &timelines,
        training,
        misses: &[],
        performances: &[],
        sensitivities: &[],
        perturbed: &[],
        motion: None,
    }
    .html()
}

/// Of two seconds from 1.5 s on, and this far off on average.
fn performance(off_degrees: f64) -> Performance {
    let bone = |bone, off_degrees| BoneDeviation {
        bone,
        off_degrees,
        worst_degrees: 2.0 * off_degrees,
        worst_secs: 2.3,
    };
    Performance {
        clip: "c".to_owned(),
        class: "<y>".to_owned(),
        span: TimeSpan::new(1.5, 3.5),
        deviation: MotionDeviation {
            off_degrees,
            pace: 1.2,
            bones: vec![bone("right_forearm", off_degrees), bone("head", 1.0)],
            over_time_degrees: vec![0.5 * off_degrees, 1.5 * off_degrees, off_degrees],
        },
    }
}

/// Every element that is opened is closed, in order; returns how many there are.
fn check_nesting(html: &str) -> usize {
    let body =
        html.split_once("<style>").unwrap().0.to_owned() + html.split_once("</style>").unwrap().1;
    let mut open: Vec<&str> = Vec::new();
    let mut elements = 0;
    for tag in body.split('<').skip(1) {
        let tag = tag.split_once('>').expect("a tag that ends").0;
        let name = tag
            .trim_start_matches('/')
            .split([' ', '/'])
            .next()
            .unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') && !["meta", "!DOCTYPE"].contains(&name) {
            open.push(name);
            elements += 1;
        }
    }
    assert!(open.is_empty(), "{open:?}");
    elements
}

const HOSTILE: &str = "</title><script>alert('1')</script>\"&\u{1}";

#[test]
fn hostile_names_stay_text() {
    let calm = [stream("c", 40.0, false)];
    let plain = report(
        &calm,
        &[truth("c", "x", 1.0, 2.0)],
        &[found("c", "y", 1.0, 2.0)],
        &[],
    );
    let infos = [stream(HOSTILE, 40.0, false)];
    let (truths, founds) = (
        [truth(HOSTILE, HOSTILE, 1.0, 2.0)],
        [found(HOSTILE, "y", 1.0, 2.0)],
    );
    let html = report(&infos, &truths, &founds, &[]);
    assert!(!html.contains("<script") && !html.contains('\u{1}'));
    // Names are written where they fit, so a long one may be missing on its bar: never more elements.
    assert!(check_nesting(&html) <= check_nesting(&plain));
    let many: Vec<StreamInfo> = (0..30)
        .map(|i| stream(&format!("{i}{HOSTILE}"), 2.0, i % 2 == 0))
        .collect();
    let html = report(
        &many,
        &[truth(&many[1].clip, HOSTILE, 0.0, 2.0)],
        &[found(&many[0].clip, HOSTILE, 0.0, 1.0)],
        &[],
    );
    assert!(!html.contains("<script"));
    check_nesting(&html);
}

#[test]
fn nothing_from_outside() {
    let html = report(
        &[stream("c", 40.0, false)],
        &[truth("c", "x", 1.0, 2.0)],
        &[],
        &[],
    );
    for outside in [
        "http:", "https:", "src=", "href=\"h", "@import", "url(", "<script",
    ] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(html.contains("prefers-color-scheme: dark") && html.contains("@media print"));
}

#[test]
fn every_sample_and_detection_is_drawn_and_said() {
    let infos = [stream("long", 100.0, false), stream("rest", 20.0, true)];
    let truths = [
        truth("long", "x", 1.0, 2.0),
        truth("long", "x", 99.0, 100.0),
        truth("long", "z", 50.0, 51.0),
    ];
    let founds = [
        found("long", "x", 1.0, 2.0),
        found("long", "y", 50.0, 51.0),
        found("long", "y", 70.0, 71.0),
    ];
    let html = report(&infos, &truths, &founds, &[]);
    check_nesting(&html);
    for title in [
        "x 1.00–2.00 s: recognised",
        "x 99.00–100.00 s: missed",
        "z 50.00–51.00 s: taken for y",
        "x 1.00–2.00 s: right, score 0.500",
        "y 50.00–51.00 s: wrong class",
        "y 70.00–71.00 s: false alarm",
        "No labels and no detections in rest",
    ] {
        assert!(html.contains(title), "{title}");
    }
    // 100 s make four rows, of which the second, from 25 s to 50 s, is blank; one more is the reliability diagram.
    assert_eq!(html.matches("<svg").count(), 4);
    assert!(html.contains("; empty rows are left out: 1"));
}

#[test]
fn many_short_clips_become_squares() {
    let infos: Vec<StreamInfo> = (0..560)
        .map(|i| stream(&format!("clip {i:03}"), 2.0, i % 10 == 9))
        .collect();
    let known = infos.iter().filter(|s| !s.unknown);
    let truths: Vec<GroundTruth> = known
        .clone()
        .enumerate()
        .map(|(i, s)| truth(&s.clip, ["a", "b"][i % 2], 0.0, 2.0))
        .collect();
    let founds: Vec<ClipDetection> = infos
        .iter()
        .step_by(3)
        .map(|s| found(&s.clip, "a", 0.1, 1.9))
        .collect();
    let html = report(&infos, &truths, &founds, &[]);
    check_nesting(&html);
    assert_eq!(html.matches("<svg").count(), 4);
    assert_eq!(html.matches("class=\"square").count(), 560);
    assert!(html.len() < 300_000, "{} bytes", html.len());
}

#[test]
fn curves_and_reasons_are_shown_where_they_are_known() {
    let infos = [stream("c", 60.0, false)];
    let truths = [truth("c", "x", 1.0, 2.0), truth("c", "x", 9.0, 10.0)];
    let founds = [found("c", "x", 1.0, 2.0)];
    let evaluation = Evaluation::of(&infos, &truths, &founds).unwrap();
    let none = Evaluation::of(&infos, &truths, &[]).unwrap();
    let misses = [Miss {
        clip: "c".into(),
        class: "x".into(),
        span: TimeSpan::new(9.0, 10.0),
        reason: Reason::OtherClass {
            class: "<y>".into(),
            distance: 2.0,
            other: 1.0,
        },
        sensitivity: Some(0.5),
    }];
    let html = Report {
        title: "curves",
        about: &[],
        evaluation: &evaluation,
        timelines: &[],
        training: &[],
        misses: &misses,
        performances: &[performance(8.0), performance(30.0)],
        sensitivities: &[(0.1, none.clone()), (1.0, evaluation.clone())],
        perturbed: &[
            (Perturbation::White(0.01), evaluation.clone()),
            (Perturbation::White(0.02), none),
        ],
        motion: None,
    }
    .html();
    check_nesting(&html);
    assert!(html.contains("more similar to &lt;y&gt; than to the samples of its own class"));
    // Two performances, sensitivity, reliability, white noise.
    assert_eq!(html.matches("<svg").count(), 5);
    // The one that is farther off comes first, with its worst moment.
    let at = |text: &str| html.find(text).unwrap_or_else(|| panic!("no {text}"));
    assert!(at("30° off on average") < at("8° off on average"));
    assert!(at("row\">right forearm") < at("row\">head"));
    assert!(html.contains("<td>60°</td><td>2.30 s</td>"));
    assert!(html.contains("white:0.02"));
}

/// Every section is in the table of contents, and the player comes with the clips alone.
#[test]
fn sections_are_reached_from_the_top() {
    let (infos, truths) = ([stream("c", 40.0, false)], [truth("c", "x", 1.0, 2.0)]);
    let html = report(&infos, &truths, &[], &[]);
    let sections = html.matches("<h2 id=\"s").count();
    assert!(sections > 3 && html.matches("<a href=\"#s").count() == sections);
    assert_eq!(html.matches("<h2>").count(), 0);
    let evaluation = Evaluation::of(&infos, &truths, &[]).unwrap();
    let html = Report {
        title: "motion",
        about: &[],
        evaluation: &evaluation,
        timelines: &[],
        training: &[],
        misses: &[],
        performances: &[],
        sensitivities: &[],
        perturbed: &[],
        motion: Some(&Reel::default()),
    }
    .html();
    assert!(html.contains("<a href=\"#motion\">") && html.contains("<section id=\"player\">"));
}

#[test]
fn notes_name_what_to_teach() {
    let infos = [stream("c", 60.0, false), stream("u", 60.0, true)];
    let mut truths: Vec<GroundTruth> = (0..4)
        .map(|i| {
            truth(
                "c",
                "hands_up",
                f64::from(i) * 3.0,
                f64::from(i) * 3.0 + 1.0,
            )
        })
        .collect();
    truths.push(truth("c", "kick", 30.0, 31.0));
    let founds = [
        found("c", "wave", 0.0, 1.0),
        found("c", "kick", 30.0, 31.0),
        found("u", "kick", 1.0, 2.0),
    ];
    let evaluation = Evaluation::of(&infos, &truths, &founds).unwrap();
    let trained = |class: &str, samples, people| TrainedClass {
        class: class.into(),
        samples,
        people,
    };
    let training = [
        trained("hands_up", 2, Some(1)),
        trained("kick", 1, Some(1)),
        trained("bow", 9, None),
    ];
    let notes = learning_notes(&evaluation, &training);
    assert_eq!(
        notes,
        [
            "hands_up needs more people: 2 samples of 1 person.",
            "hands_up: 3 of 4 samples missed.",
            "hands_up is mistaken for wave once.",
            "kick is detected in unknown motion once.",
            "wave is detected but not labelled in these clips.",
            "bow is in the index but has no sample here, so it is not measured.",
        ]
    );
    let perfect = Evaluation::of(&infos, &truths[4..], &founds[1..2]).unwrap();
    assert_eq!(
        learning_notes(&perfect, &[]),
        ["Every sample was recognised, and nothing else was detected."]
    );
}
