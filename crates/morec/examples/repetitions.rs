//! How well the repetitions of activities are counted: `cargo run --release -p morec --example repetitions`.
//!
//! Two sets of real clips (`MOREC_DATA`). Referee signals and walking: labels of one class that follow each other within 0.4 s are one
//! stretch of an activity, of as many repetitions. Exercises: a stretch's repetitions are its length over the period that
//! `segment::cycles` finds in all of it. Each clip is recognised by an index of the others; of each event on a stretch of its class, the
//! count is compared with the repetitions that lie within the event.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use std::path::Path;

use morec::TimeSpan;
use morec::features::{BoneSet, FeatureParams};
use morec::files::open_all;
use morec::labels::{ClipLength, Labels, Sample};
use morec::live::{Detection, Model, recognize_clip};
use morec::segment::{CycleParams, cycles};
use morec::train::{LabelSet, TrainClip, TrainOptions, build_train_set, train_clips};

/// Labels that follow each other within this are of one stretch, seconds.
const GAP_SECS: f64 = 0.4;

fn main() {
    let Some(data) = mocap::testing::data() else {
        return;
    };
    for (set, repetitions) in [("referee", true), ("exercises", false)] {
        let set = data.join(set);
        count(&set.join("clips"), &set.join("labels.tsv"), repetitions);
    }
}

/// A stretch of an activity, and when each of its repetitions is over.
struct Stretch {
    sample: Sample,
    bounds_secs: Vec<f64>,
}

impl Stretch {
    /// Repetitions in a span of time, with parts.
    fn repetitions(&self, mut within: TimeSpan) -> f64 {
        within.stop_secs = within.stop_secs.min(self.sample.span.stop_secs);
        let parts = self.bounds_secs.windows(2).map(|bounds| {
            let repetition = TimeSpan::new(bounds[0], bounds[1]);
            repetition.overlap_secs(within) / repetition.duration_secs()
        });
        parts.sum()
    }
}

fn count(clips: &Path, labels: &Path, is_repetition: bool) {
    let takes = open_all(clips).unwrap().takes;
    let clips: Vec<TrainClip> = takes.into_iter().map(TrainClip::from).collect();
    let lengths = clips.iter().map(|c| {
        let (frames, rate_hz) = (c.clip.frames, c.clip.rate_hz);
        (c.name.clone(), ClipLength { frames, rate_hz })
    });
    let labels = Labels::from_path(labels).unwrap();
    let samples = labels.resolve(&lengths.collect()).samples;
    let stretches = match is_repetition {
        true => joined(samples),
        false => divided(&samples, &clips),
    };
    let (mut events, mut right) = (0, 0);
    for clip in &clips {
        let (of_clip, others): (Vec<&Stretch>, Vec<&Stretch>) =
            stretches.iter().partition(|s| s.sample.clip == clip.name);
        let taught = |s: &&&Stretch| others.iter().any(|o| o.sample.class == s.sample.class);
        let of_clip: Vec<&Stretch> = of_clip.iter().filter(taught).copied().collect();
        if of_clip.is_empty() {
            continue;
        }
        for (found, class) in recognized(clip, &clips, &others) {
            let touches = |s: &&&Stretch| {
                s.sample.class == class && found.span.overlap_secs(s.sample.span) > 1.0
            };
            let truth: f64 = (of_clip.iter().filter(touches))
                .map(|s| s.repetitions(found.span))
                .sum();
            if truth < 1.5 {
                continue;
            }
            events += 1;
            let counted = found.repetitions.map_or(0, |r| r.count);
            let is_right = (f64::from(counted) - truth).abs() <= 1.0;
            right += usize::from(is_right);
            println!(
                "{} {found_}, counted {counted} of {truth:.1}",
                clip.name,
                found_ = named(&found, &class)
            );
        }
    }
    println!("{right} of {events} events within 1\n");
}

fn named(found: &Detection, class: &str) -> String {
    format!(
        "{class} {:.1}-{:.1} s",
        found.span.start_secs, found.span.stop_secs
    )
}

/// Runs of labels of one class.
fn joined(mut samples: Vec<Sample>) -> Vec<Stretch> {
    samples.sort_by(|a, b| {
        (&a.clip, a.span.start_secs)
            .partial_cmp(&(&b.clip, b.span.start_secs))
            .unwrap()
    });
    let mut stretches: Vec<Stretch> = Vec::new();
    for sample in samples {
        let follows = |last: &&mut Stretch| {
            let last = &last.sample;
            (&last.clip, &last.class) == (&sample.clip, &sample.class)
                && sample.span.start_secs - last.span.stop_secs < GAP_SECS
        };
        match stretches.last_mut().filter(follows) {
            Some(last) => {
                last.sample.span.stop_secs = sample.span.stop_secs;
                last.bounds_secs.push(sample.span.stop_secs);
            }
            None => stretches.push(Stretch {
                bounds_secs: vec![sample.span.start_secs, sample.span.stop_secs],
                sample,
            }),
        }
    }
    stretches.retain(|s| s.bounds_secs.len() > 2);
    stretches
}

/// Labelled stretches, divided by their period.
fn divided(samples: &[Sample], clips: &[TrainClip]) -> Vec<Stretch> {
    let params = FeatureParams::default();
    // Labels say which bones all clips must show.
    let labelling = LabelSet {
        samples,
        ..LabelSet::default()
    };
    let set = build_train_set(clips, &labelling, BoneSet::BODY, &params).set;
    let divided = |sample: &Sample| {
        let stream = set.streams.iter().find(|s| s.name == sample.clip)?;
        let tick = |secs: f64| ((secs * params.tick_hz()) as usize).min(stream.rows.len());
        let rows = stream
            .rows
            .slice(tick(sample.span.start_secs)..tick(sample.span.stop_secs));
        let cycles = cycles(&rows, params.tick_hz(), &CycleParams::default())?;
        let bounds = (0..).map(|n| sample.span.start_secs + f64::from(n) * cycles.period_secs);
        Some(Stretch {
            bounds_secs: bounds
                .take_while(|b| *b < sample.span.stop_secs + cycles.period_secs)
                .collect(),
            sample: sample.clone(),
        })
    };
    samples.iter().filter_map(divided).collect()
}

/// What an index of `others` finds in `clip`, with the names of classes.
fn recognized(
    clip: &TrainClip,
    clips: &[TrainClip],
    others: &[&Stretch],
) -> Vec<(Detection, String)> {
    let samples: Vec<Sample> = others.iter().map(|s| s.sample.clone()).collect();
    let mut classes: Vec<String> = samples.iter().map(|s| s.class.clone()).collect();
    classes.sort();
    classes.dedup();
    let labelling = LabelSet {
        samples: &samples,
        classes: &classes,
        unlabelled_is_background: true,
        ..LabelSet::default()
    };
    let mut options = TrainOptions::default();
    options.params.set_kinds(&classes, &[]);
    let clips: Vec<TrainClip> = clips
        .iter()
        .filter(|c| c.name != clip.name)
        .cloned()
        .collect();
    let (model, _) = train_clips(&clips, &labelling, &options, &()).unwrap();
    let found = recognize_clip(&Model::from(model), &clip.clip, &clip.roles, &clip.rest).unwrap();
    let name = |d: &Detection| classes[d.class.index()].clone();
    found.into_iter().map(|d| (d, name(&d))).collect()
}
