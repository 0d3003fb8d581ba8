//! How well motions are known at half of their length: `cargo run --release -p morec --example early`.
//!
//! Two sets of real clips (`MOREC_DATA`): the three referee clips with signals, each by an index of the others and background; and
//! sessions before a Kinect, each by an index of two samples of each gesture by the same person. At the middle of every sample:
//! is its class being reported? And of all that is reported as half done or more: how much is right? Arguments `name=value` set a
//! parameter of `EarlyDetectionParams`.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use std::path::Path;

use morec::features::{bones_of_clip, for_each_pose};
use morec::files::{open, open_all};
use morec::labels::{ClipLength, Labels, Sample};
use morec::live::{EarlyDetection, Recognizer};
use morec::templates::EarlyDetectionParams;
use morec::{MotionIndex, Take, Trainer};

fn main() {
    let Some(data) = mocap::testing::data() else {
        return;
    };
    let mut params = EarlyDetectionParams::default();
    std::env::args()
        .skip(1)
        .for_each(|arg| set(&mut params, &arg));
    println!("{params:?}");
    println!("referee, by clip: {}", referee(&data, params));
    println!("sessions, the same person: {}", sessions(&data, params));
}

fn set(params: &mut EarlyDetectionParams, arg: &str) {
    let (name, value) = arg.split_once('=').expect("name=value");
    let value: f32 = value.parse().expect("a number");
    match name {
        "least_progress" => params.least_progress = value,
        "least_ticks" => params.least_ticks = value as usize,
        "reach" => params.reach = value,
        "gate" => params.gate = value,
        "rival" => params.rival = value,
        "streak" => params.streak = value as usize,
        _ => panic!("no parameter is called {name}"),
    }
}

fn referee(data: &Path, params: EarlyDetectionParams) -> Counts {
    let labels = Labels::from_path(data.join("referee/labels.tsv")).unwrap();
    let takes = open_all(data.join("referee/clips")).unwrap().takes;
    let of = |prefixes: &[&str]| -> Vec<Take> {
        let is = |take: &&Take| prefixes.iter().any(|p| take.name().starts_with(p));
        takes.iter().filter(is).cloned().collect()
    };
    let background = of(&["jumping_", "soccer_", "running_"]);
    let unknown = of(&["walking_", "basketball_", "traffic_4"]);
    let signals = of(&["signals_"]);
    let mut counts = Counts::default();
    for (number, test) in signals.iter().enumerate() {
        let others = signals.iter().filter(|take| take.name() != test.name());
        let others: Vec<Take> = others.cloned().collect();
        let trainer = Trainer::new().labels(&labels).background(&background);
        let index = trainer
            .classes(mocap::testing::SIGNALS)
            .train(&others)
            .unwrap();
        counts.clip(&index, test, &labels, params);
        for take in unknown.iter().filter(|_| number == 0) {
            counts.clip(&index, take, &Labels::default(), params);
        }
    }
    counts
}

fn sessions(data: &Path, params: EarlyDetectionParams) -> Counts {
    let taught = Labels::from_path(data.join("sessions/teach.tsv")).unwrap();
    let labels = Labels::from_path(data.join("sessions/labels.tsv")).unwrap();
    let mut counts = Counts::default();
    for test in open_all(data.join("sessions/clips")).unwrap().takes {
        let person = test.name().trim_start_matches("session_");
        let mut of_person = taught.clone();
        of_person
            .rows
            .retain(|row| row.person.as_deref() == Some(person));
        let clips = of_person
            .rows
            .iter()
            .flat_map(|row| open(data.join(format!("gestures/clips/{}.bvh", row.clip))).unwrap());
        let clips: Vec<Take> = clips.collect();
        let index = Trainer::new().labels(&of_person).train(&clips).unwrap();
        counts.clip(&index, &test, &labels, params);
    }
    counts
}

/// Sums over clips.
#[derive(Default)]
struct Counts {
    samples: usize,
    /// Samples whose class is reported at their middle.
    known: usize,
    /// Motions reported as half done, and those of them that are.
    told: usize,
    right: usize,
    /// Those reported in clips that hold none of the classes, and the length of these.
    told_elsewhere: usize,
    elsewhere_secs: f64,
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        write!(
            f,
            "{} of {} samples known at the middle (recall {:.2}); {} of {} reported as half done are right (precision {:.2})",
            self.known,
            self.samples,
            share(self.known, self.samples),
            self.right,
            self.told,
            share(self.right, self.told)
        )?;
        if self.elsewhere_secs > 0.0 {
            let minutes = self.elsewhere_secs / 60.0;
            write!(
                f,
                "; {} reported in {minutes:.1} min without any",
                self.told_elsewhere
            )?;
        }
        Ok(())
    }
}

impl Counts {
    fn clip(
        &mut self,
        index: &MotionIndex,
        take: &Take,
        labels: &Labels,
        params: EarlyDetectionParams,
    ) {
        let (clip, name) = (&take.clip, take.name().to_owned());
        let (frames, rate_hz) = (clip.frames, clip.rate_hz);
        let lengths = [(name, ClipLength { frames, rate_hz })];
        let classes = index.model.classes();
        let mut samples = labels.resolve(&lengths.into()).samples;
        samples.retain(|sample| classes.iter().any(|class| class.name == sample.class));
        let early = play(index, take, params);
        let is = |told: &EarlyDetection, sample: &Sample| {
            classes[told.class.index()].name == sample.class
        };
        let half = half_done(&early);
        if samples.is_empty() {
            self.told_elsewhere += half.len();
            self.elsewhere_secs += clip.duration_secs();
            return;
        }
        for sample in &samples {
            let middle_secs = sample.span.middle_secs();
            let at = early.iter().rev().find(|(t, _)| *t <= middle_secs);
            // One that began well before the sample is another motion's, perhaps of the same class.
            let slack_secs = 0.25 * sample.span.duration_secs();
            let known = at.and_then(|(_, told)| *told).is_some_and(|told| {
                is(&told, sample) && told.start_secs > sample.span.start_secs - slack_secs
            });
            self.known += usize::from(known);
        }
        self.samples += samples.len();
        let right = half.iter().filter(|told| {
            samples.iter().any(|sample| {
                is(told, sample)
                    && sample.span.start_secs < told.seen_secs
                    && told.start_secs < sample.span.stop_secs
            })
        });
        self.right += right.count();
        self.told += half.len();
    }
}

/// The early detection after every pose, with the pose's time in seconds.
fn play(
    index: &MotionIndex,
    take: &Take,
    params: EarlyDetectionParams,
) -> Vec<(f64, Option<EarlyDetection>)> {
    let Take {
        clip,
        roles,
        report,
        ..
    } = take;
    let bones = bones_of_clip(clip, roles, &report.rest_frames);
    let mut recognizer = Recognizer::new(&index.model, bones).unwrap();
    recognizer.set_early(params);
    let mut told = Vec::new();
    for_each_pose(clip, roles, &report.rest_frames, |time_secs, pose| {
        recognizer.push(time_secs, pose);
        told.push((time_secs, recognizer.early_detection()));
    });
    told
}

/// One early detection for every run of them of a class, at the moment it is half done.
fn half_done(early: &[(f64, Option<EarlyDetection>)]) -> Vec<EarlyDetection> {
    let mut found: Vec<EarlyDetection> = Vec::new();
    let told = early.iter().filter_map(|(_, told)| *told);
    for told in told.filter(|told| told.progress >= 0.5) {
        let same = |last: &EarlyDetection| {
            last.class == told.class && told.seen_secs - last.seen_secs < 0.3
        };
        match found.last_mut() {
            Some(last) if same(last) => {
                *last = EarlyDetection {
                    start_secs: last.start_secs,
                    ..told
                }
            }
            _ => found.push(told),
        }
    }
    found
}
