//! The people of the demo: recordings of real people that come with the command, or synthetic people.

use std::fmt::Write;

use anyhow::{Result, bail};
use morec::formats::bvh;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use rayon::prelude::*;

/// Seed of synthetic people, chosen for nothing but being the year of the thesis.
const SEED: u64 = 2009;

/// Clips, labels, and what to say of them.
pub struct Cast {
    /// Title of the first step.
    pub title: &'static str,
    /// Every file by its path in the demo's folder.
    pub files: Vec<(String, Vec<u8>)>,
    /// Contents of the folder, for people to read.
    pub contents: Vec<(&'static str, String)>,
    /// Name of the clip that is recognised.
    pub name: String,
    /// Its file, a path in the demo's folder.
    pub clip: String,
    /// Performer of the stream.
    pub whose: String,
    /// True if there are background clips.
    pub background: bool,
    /// Meaning of the figures.
    pub caveat: &'static str,
}

/// Two referees teach, a third clip is recognised. Terms of these files: `demo/CREDITS.md`.
#[cfg(feature = "demo-clips")]
pub fn real() -> Cast {
    macro_rules! files {
        ($($folder:literal $name:literal),* $(,)?) => {
            vec![$((
                concat!($folder, $name).to_owned(),
                include_bytes!(concat!("../../../demo/", $name)).to_vec(),
            )),*]
        };
    }
    let files = files![
        "clips/" "signals_1.mclip",
        "clips/" "signals_3.mclip",
        "new/" "signals_2.mclip",
        "background/" "basketball_1.mclip",
        "background/" "basketball_3.mclip",
        "background/" "walking_04.mclip",
        "background/" "jumping_1.mclip",
        "background/" "running_1.mclip",
        "" "labels.tsv",
        "" "people.tsv",
        "" "truth.tsv",
        "" "CREDITS.md",
    ];
    let line = |name, about: &str| (name, about.to_owned());
    Cast {
        title: "1. Unpacking clips of real people, from mocap.cs.cmu.edu",
        files,
        contents: vec![
            line(
                "clips/",
                "two referees showing seven signals, one clip each, 53 s",
            ),
            line("labels.tsv", "the labels of the signals: 32 samples"),
            line("people.tsv", "the person of each clip"),
            line(
                "background/",
                "other motion: basketball, walking, jumping, running, 17 s",
            ),
            line(
                "new/",
                "a clip of the first referee that is not used in training, 26 s",
            ),
            line("truth.tsv", "its labels, for measuring only"),
            line("CREDITS.md", "the source and licence of the clips"),
        ],
        name: "signals_2".to_owned(),
        clip: "new/signals_2.mclip".to_owned(),
        whose: "a referee in a new recording".to_owned(),
        background: true,
        caveat: "One clip of a person who also trained is a demonstration, not a measurement; for measurements see docs/figures.md.",
    }
}

/// Seven synthetic people, the last of whom is recognised; every class twice a stream.
///
/// # Errors
/// A clip that cannot be written, for lack of memory.
pub fn synthetic() -> Result<Cast> {
    let spec = DatabaseSpec {
        people: 7,
        repetitions: 2,
        ..DatabaseSpec::default()
    };
    let mut taught = database(SEED, &spec);
    let Some(unseen) = taught.pop() else {
        bail!("nobody to show")
    };
    let clips = taught.iter().map(|take| ("clips", take));
    let clips: Vec<_> = clips.chain([("new", &unseen)]).collect();
    let mut files = clips
        .par_iter()
        .map(|(folder, take)| {
            let mut bytes = Vec::new();
            bvh::write(&take.clip, &mut bytes)?;
            Ok((format!("{folder}/{}.bvh", take.clip.name), bytes))
        })
        .collect::<Result<Vec<_>>>()?;
    let people = taught
        .iter()
        .map(|t| format!("{}\t{}\n", t.clip.name, t.person));
    let people = people.fold("clip\tperson\n".to_owned(), |text, row| text + &row);
    for (name, text) in [
        ("labels.tsv", labels(&taught)),
        ("truth.tsv", labels(std::slice::from_ref(&unseen))),
        ("people.tsv", people),
    ] {
        files.push((name.to_owned(), text.into_bytes()));
    }
    let minutes: f64 = taught.iter().map(|t| t.clip.duration_secs()).sum::<f64>() / 60.0;
    let samples: usize = taught.iter().map(|t| t.labels.len()).sum();
    let (name, person) = (unseen.clip.name.clone(), unseen.person.clone());
    Ok(Cast {
        title: "1. Making synthetic people and filming them",
        files,
        contents: vec![
            (
                "clips/",
                format!("{} people, a BVH file each, {minutes:.1} min", taught.len()),
            ),
            (
                "labels.tsv",
                format!("the labels of the gestures: {samples} samples"),
            ),
            ("people.tsv", "the person of each clip".to_owned()),
            (
                "new/",
                format!(
                    "{person}, not used in training, {:.1} min",
                    unseen.clip.duration_secs() / 60.0
                ),
            ),
            (
                "truth.tsv",
                format!("the labels of {person}, for measuring only"),
            ),
        ],
        clip: format!("new/{name}.bvh"),
        name,
        whose: format!("{person}, who is not in the training data"),
        background: false,
        caveat: "These people are synthetic: the figures above say nothing about accuracy on real people.",
    })
}

/// A table of labels in frames.
fn labels(takes: &[SyntheticTake]) -> String {
    let mut text = "clip\tclass\tstart\tstop\n".to_owned();
    for take in takes {
        for label in &take.labels {
            let span = label.span.frames(take.clip.rate_hz);
            _ = writeln!(
                text,
                "{}\t{}\t{}\t{}",
                take.clip.name, label.class, span.start, span.end
            );
        }
    }
    text
}
