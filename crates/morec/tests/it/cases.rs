//! The cases of `testdata/recognition/`: a script for a synthetic person, what befalls the stream on its way, and the
//! detections expected. The tests of other crates read them from here, too.

use std::fs;
use std::path::Path;

use morec::features::KeyPose;
use morec::math::{Quat, Vec3};
use morec::roles::Role;
use morec::synth::{LimbSide, Person, Rng, Script, SyntheticTake};

use crate::made::Timed;

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Description for people.
    #[allow(dead_code)]
    about: String,
    /// Seed of how the motions vary, and the number of the person that the same seed draws.
    seed: u64,
    person: usize,
    /// Height instead of the person's own, metres.
    height_m: Option<f64>,
    /// Frames a second; each is a run.
    pub rates_hz: Vec<f64>,
    script: Vec<Line>,
    #[serde(default)]
    pub stream: Stream,
    pub expect: Vec<Expected>,
    /// By how much starts and stops may differ.
    pub tolerance_secs: f64,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Line {
    Rest(f64),
    RestUntil(f64),
    Play(String),
    PlayAtSpeed(String, f64),
}

/// Changes of the poses between the person and the recogniser.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
pub struct Stream {
    /// Turned about the vertical.
    turned_deg: f64,
    /// In another unit of length: multiplied by this.
    scaled: Option<f64>,
    /// Moved by this, after scaling.
    moved: [f64; 3],
    /// The clock's time of the first pose.
    pub clock_secs: f64,
    /// Nothing arrives between these times.
    gap_secs: Option<(f64, f64)>,
    /// This share of the poses is lost, one by one, at random.
    lost_share: f64,
    /// After every n-th pose it arrives once more, and an older one late; both of somebody lying down.
    echo_every: Option<usize>,
}

#[derive(serde::Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    pub class: String,
    pub start_secs: f64,
    pub stop_secs: f64,
}

impl Case {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// The motion of its person at `rate_hz` frames a second.
    pub fn take(&self, rate_hz: f64) -> SyntheticTake {
        let mut person = Person::draw(self.seed, self.person);
        // The people of the model are right-handed, as in every synthetic database unless stated otherwise.
        person.hand = LimbSide::Right;
        person.height_m = self.height_m.unwrap_or(person.height_m);
        let perform = |script: Script, line: &Line| match line {
            Line::Rest(secs) => script.rest(*secs),
            Line::RestUntil(secs) => script.rest_until(*secs),
            Line::Play(motion) => script.play(motion),
            Line::PlayAtSpeed(motion, speed) => script.play_at_speed(motion, *speed),
        };
        let script = self
            .script
            .iter()
            .fold(Script::new(self.seed, person), perform);
        script.film("case", rate_hz).unwrap()
    }
}

impl Stream {
    /// The poses as they arrive.
    pub fn carry(&self, poses: &[Timed]) -> Vec<Timed> {
        let mut rng = Rng::new(5);
        let mut arrived: Vec<Timed> = Vec::new();
        for (nth, (time_secs, pose)) in poses.iter().enumerate() {
            let in_gap = self
                .gap_secs
                .is_some_and(|(from, to)| (from..to).contains(time_secs));
            if in_gap || rng.chance(self.lost_share) {
                continue;
            }
            arrived.push((time_secs + self.clock_secs, self.place(pose)));
            if self
                .echo_every
                .is_some_and(|every| nth % every == every - 1)
            {
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
        map(pose, |p| {
            turn * p * self.scaled.unwrap_or(1.0) + Vec3::from(self.moved)
        })
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
pub fn cases() -> Vec<(String, Case)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../morec/testdata/recognition");
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    paths.retain(|p| p.extension().is_some_and(|e| e == "json"));
    paths
        .iter()
        .map(|p| {
            (
                p.file_stem().unwrap().to_string_lossy().into_owned(),
                Case::read(p),
            )
        })
        .collect()
}
