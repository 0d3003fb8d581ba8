//! What recognition must find in the streams of `testdata/recognition/`, however it is run.
//!
//! A case is data: a script for a synthetic person, what befalls the stream on its way, and the detections
//! expected. Every engine of [`ENGINES`] goes through every case at every rate.

use std::fs;
use std::path::Path;

use morec::features::KeyPose;
use morec::live::Detection;
use morec::math::{Quat, Vec3};
use morec::roles::Role;
use morec::synth::{Kind, Person, Rng, Script, Side};

use crate::engines::ENGINES;
use crate::made::{self, Timed};

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// What it is about, for people.
    #[allow(dead_code)]
    about: String,
    /// Seed of how the motions vary, and the number of the person that the same seed draws.
    seed: u64,
    person: usize,
    /// Height instead of the person's own, metres.
    height_m: Option<f64>,
    /// Frames a second; each is a run.
    rates_hz: Vec<f64>,
    script: Vec<Line>,
    #[serde(default)]
    stream: Stream,
    expect: Vec<Expected>,
    /// By how much starts and stops may differ.
    tolerance_secs: f64,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Line {
    Rest(f64),
    RestUntil(f64),
    Play(String),
    PlayAtSpeed(String, f64),
}

/// What befalls the poses between the person and the recogniser.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct Stream {
    /// Turned about the vertical.
    turned_deg: f64,
    /// In another unit of length: multiplied by this.
    scaled: Option<f64>,
    /// Moved by this, after scaling.
    moved: [f64; 3],
    /// The clock's time of the first pose.
    clock_secs: f64,
    /// Nothing arrives between these times.
    gap_secs: Option<(f64, f64)>,
    /// This share of the poses is lost, one by one, at random.
    lost_share: f64,
    /// After every so-manieth pose it arrives once more, and an older one late; both of somebody lying down.
    echo_every: Option<usize>,
}

#[derive(serde::Deserialize, Debug)]
#[serde(deny_unknown_fields)]
struct Expected {
    class: String,
    start_secs: f64,
    stop_secs: f64,
}

impl Case {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    fn take(&self, rate_hz: f64) -> morec::synth::Take {
        let mut person = Person::draw(self.seed, self.person);
        // The people of the model are right-handed, as in every synthetic database unless told otherwise.
        person.hand = Side::Right;
        person.height_m = self.height_m.unwrap_or(person.height_m);
        let perform = |script: Script, line: &Line| match line {
            Line::Rest(secs) => script.rest(*secs),
            Line::RestUntil(secs) => script.rest_until(*secs),
            Line::Play(motion) => script.play(motion),
            Line::PlayAtSpeed(motion, speed) => script.play_at_speed(motion, *speed),
        };
        let script = self.script.iter().fold(Script::new(self.seed, person), perform);
        script.film("case", rate_hz).unwrap()
    }
}

impl Stream {
    /// The poses as they arrive.
    fn carry(&self, poses: &[Timed]) -> Vec<Timed> {
        let mut rng = Rng::new(5);
        let mut arrived: Vec<Timed> = Vec::new();
        for (nth, (time_secs, pose)) in poses.iter().enumerate() {
            let in_gap = self.gap_secs.is_some_and(|(from, to)| (from..to).contains(time_secs));
            if in_gap || rng.chance(self.lost_share) {
                continue;
            }
            arrived.push((time_secs + self.clock_secs, self.place(pose)));
            if self.echo_every.is_some_and(|every| nth % every == every - 1) {
                let old = &poses[nth.saturating_sub(3)];
                for (time_secs, pose) in [&poses[nth], old] {
                    arrived.push((time_secs + self.clock_secs, lying(&self.place(pose))));
                }
            }
        }
        arrived
    }

    fn place(&self, pose: &KeyPose) -> KeyPose {
        let turn = Quat::from_axis_angle(&Vec3::y_axis(), self.turned_deg.to_radians());
        map(pose, |p| turn * p * self.scaled.unwrap_or(1.0) + Vec3::from(self.moved))
    }
}

fn lying(pose: &KeyPose) -> KeyPose {
    map(pose, |p| Vec3::new(p.y, p.x, p.z))
}

fn map(pose: &KeyPose, new: impl Fn(Vec3) -> Vec3) -> KeyPose {
    let mut mapped = KeyPose::default();
    for role in Role::ALL {
        if let Some(position) = pose.get(role) {
            mapped.set(role, new(position));
        }
    }
    mapped
}

/// All cases with their names.
fn cases() -> Vec<(String, Case)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/recognition");
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths.retain(|p| p.extension().is_some_and(|e| e == "json"));
    paths.iter().map(|p| (p.file_stem().unwrap().to_string_lossy().into_owned(), Case::read(p))).collect()
}

#[test]
fn every_engine_finds_what_every_case_expects() {
    let cases = cases();
    assert!(cases.len() >= 6);
    let mut wrong = Vec::new();
    for (name, case) in &cases {
        for &rate_hz in &case.rates_hz {
            run(case, &format!("{name} at {rate_hz} Hz"), rate_hz, &mut wrong);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// For whoever writes a case: what its person performs, to be put under `expect`.
#[test]
#[ignore = "prints; run with --ignored --nocapture"]
fn print_what_is_performed() {
    for (name, case) in cases() {
        println!("{name}");
        for l in case.take(60.0).keep(Kind::Gesture).labels {
            println!(
                "    {{\"class\": \"{}\", \"start_secs\": {:.2}, \"stop_secs\": {:.2}}},",
                l.class, l.start_secs, l.stop_secs
            );
        }
    }
}

/// Runs every engine and adds what is wrong with what it found to `wrong`.
fn run(case: &Case, name: &str, rate_hz: f64, wrong: &mut Vec<String>) {
    let model = made::model();
    let (bones, poses) = made::poses(&case.take(rate_hz));
    let poses = case.stream.carry(&poses);
    let clock_secs = case.stream.clock_secs;
    for engine in ENGINES {
        let found = (engine.run)(&model, bones, &poses);
        let class = |d: &Detection| model.classes[d.class.index()].name.clone();
        let near = |found: f64, expected: f64| (found - clock_secs - expected).abs() <= case.tolerance_secs;
        let right = found.iter().zip(&case.expect).all(|(d, e)| {
            class(d) == e.class && near(d.start_secs, e.start_secs) && near(d.stop_secs, e.stop_secs)
        });
        if !right || found.len() != case.expect.len() {
            let tell =
                |d: &Detection| (class(d), d.start_secs - clock_secs, d.stop_secs - clock_secs, d.score);
            let found: Vec<_> = found.iter().map(tell).collect();
            wrong.push(format!("{name}, {}: found {found:.2?}, expected {:.2?}", engine.name, case.expect));
        }
        wrong.extend(report_faults(&found, &poses).map(|fault| format!("{name}, {}: {fault}", engine.name)));
    }
}

/// Reports come in order, at the time of a pose that has arrived, and within a fifth of a second and two frames.
fn report_faults<'a>(found: &'a [Detection], poses: &'a [Timed]) -> impl Iterator<Item = String> + 'a {
    let ordered = |w: &[Detection]| {
        w[0].reported_secs <= w[1].reported_secs && w[0].stop_secs <= w[1].start_secs + 1e-9
    };
    let disorder = (!found.windows(2).all(ordered)).then(|| "out of order".to_owned());
    let late = found.iter().filter_map(|d| {
        if !poses.iter().any(|(time_secs, _)| *time_secs == d.reported_secs) {
            return Some(format!("reported at {}, when no pose came", d.reported_secs));
        }
        let between = poses.iter().filter(|p| p.0 > d.stop_secs + 0.2 && p.0 < d.reported_secs).count();
        (between > 2).then(|| format!("said {:.3} s after its end", d.reported_secs - d.stop_secs))
    });
    disorder.into_iter().chain(late)
}
