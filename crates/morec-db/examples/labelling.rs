//! How many answers it takes to label everything: a simulated user starts from one label of each class and answers what
//! `propose` asks, round after round.
//!
//! ```text
//! cargo run --release -p morec-db --example labelling -- [signals|referee|gestures|everyday] [--ask N] [--seeds N] [--rounds N]
//! ```
//!
//! A proposal that lies at half overlap (intersection over union) with a sample of its class is accepted as it lies; on a
//! sample of another class it is accepted as that class; anywhere else it is rejected. A sample is right if it was
//! accepted so, or lies at half overlap with a sure proposal of its class.

#![allow(clippy::print_stdout, clippy::print_stderr)] // It is a program.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use mocap::testing::SIGNALS;
use morec_db::labels::{NewSample, SampleState};
use morec_db::{
    ClipFilter, ClipId, ClipUpdate, MotionDb, Proposal, ProposeOptions, most_informative,
};

/// The classes of the database figure beside the seven signals: walking and two dribbles.
const OTHERS: [&str; 3] = ["walk", "dribble_right", "dribble_left"];

type Failure = Box<dyn std::error::Error>;

/// A labelled stretch; without times the whole clip.
#[derive(Clone)]
struct Truth {
    clip: String,
    class: String,
    secs: Option<(f64, f64)>,
    person: Option<String>,
}

struct Material {
    folder: PathBuf,
    truth: Vec<Truth>,
}

fn table(path: &Path) -> Result<Vec<BTreeMap<String, String>>, Failure> {
    let text = std::fs::read_to_string(path)?;
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split('\t').collect();
    let row = |line: &str| {
        header
            .iter()
            .zip(line.split('\t'))
            .map(|(k, v)| ((*k).to_owned(), v.to_owned()))
            .collect()
    };
    Ok(lines.map(row).collect())
}

fn material(data: &Path, which: &str) -> Result<Material, Failure> {
    let set = if which == "signals" { "referee" } else { which };
    let folder = data.join(set);
    let of = |row: &BTreeMap<String, String>, column: &str| row.get(column).cloned();
    let people: BTreeMap<String, String> = match table(&folder.join("people.tsv")) {
        Ok(rows) => rows
            .iter()
            .filter_map(|r| Some((of(r, "clip")?, of(r, "person")?)))
            .collect(),
        Err(_) => BTreeMap::new(),
    };
    let rows = match set {
        "referee" => table(&folder.join("labels.tsv"))?,
        _ => table(&folder.join("clips.tsv"))?,
    };
    let mut truth = Vec::new();
    for row in rows {
        let (Some(clip), Some(class)) = (of(&row, "clip"), of(&row, "class")) else {
            continue;
        };
        // The referee clips have 120 frames a second.
        let secs = |column| {
            of(&row, column)
                .and_then(|frame| frame.parse::<f64>().ok())
                .map(|f| f / 120.0)
        };
        let mut figure = SIGNALS.iter().chain(&OTHERS);
        let wanted = which != "signals" || figure.any(|one| *one == class);
        if wanted && class != "dontcare" {
            let person = of(&row, "person").or_else(|| people.get(&clip).cloned());
            truth.push(Truth {
                secs: secs("start").zip(secs("stop")),
                clip,
                class,
                person,
            });
        }
    }
    Ok(Material {
        folder: folder.join("clips"),
        truth,
    })
}

fn imported(material: &Material, path: &Path) -> Result<MotionDb, Failure> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&material.folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    let mut db = MotionDb::create(path)?;
    db.import(
        &paths,
        &morec::files::FileReader::default(),
        &ClipUpdate::default(),
        &(),
    )?;
    let people: BTreeMap<&str, &str> = material
        .truth
        .iter()
        .filter_map(|t| Some((t.clip.as_str(), t.person.as_deref()?)))
        .collect();
    for (clip, person) in people {
        let id = db.find_clip(clip)?.id;
        db.update_clips(
            &[id],
            &ClipUpdate {
                subject: Some(person.to_owned()),
                ..ClipUpdate::default()
            },
        )?;
    }
    Ok(db)
}

/// The same numbers on every machine.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }
}

struct User<'a> {
    truth: &'a [Truth],
    ids: BTreeMap<String, ClipId>,
    secs: BTreeMap<String, f64>,
}

impl User<'_> {
    fn sample(&self, truth: &Truth, class: &str, state: SampleState) -> NewSample {
        let (start_secs, stop_secs) = truth.secs.unwrap_or((0.0, self.secs[&truth.clip]));
        NewSample {
            clip: self.ids[&truth.clip],
            class: class.to_owned(),
            start_secs,
            stop_secs,
            whole_clip: truth.secs.is_none(),
            state,
            score: None,
        }
    }

    /// The sample at half overlap with a stretch, if there is one.
    fn under(&self, clip: ClipId, start: f64, stop: f64) -> Option<usize> {
        let share = |t: &Truth| {
            let (from, to) = t.secs.unwrap_or((0.0, self.secs[&t.clip]));
            let shared = (to.min(stop) - from.max(start)).max(0.0);
            shared / (to.max(stop) - from.min(start))
        };
        let of_clip = self
            .truth
            .iter()
            .enumerate()
            .filter(|(_, t)| self.ids[&t.clip] == clip);
        let best = of_clip
            .map(|(i, t)| (share(t), i))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        (best.0 >= 0.5).then_some(best.1)
    }

    /// The judgement of this user on a proposal.
    fn answer(&self, p: &Proposal) -> NewSample {
        let mut answer = NewSample::from(p.clone());
        match self.under(p.clip, p.span.start_secs, p.span.stop_secs) {
            Some(t) => {
                (answer.state, answer.class) = (SampleState::Accepted, self.truth[t].class.clone())
            }
            None => answer.state = SampleState::Rejected,
        }
        answer
    }
}

struct Round {
    answers: usize,
    labelled: usize,
    right: usize,
    sure: usize,
    wrong: usize,
    /// Proposals of a score of at least 0.9, and the wrong ones among them.
    surest: [usize; 2],
    secs: f64,
}

fn play(
    db: &mut MotionDb,
    user: &User<'_>,
    seed: u64,
    ask: usize,
    rounds: usize,
) -> Result<Vec<Round>, Failure> {
    for class in db.classes()? {
        db.remove_class(&class.name)?;
    }
    let mut dice = Dice(seed.wrapping_mul(7919) + 1);
    let mut by_class: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, truth) in user.truth.iter().enumerate() {
        by_class.entry(&truth.class).or_default().push(i);
    }
    let mut labelled: BTreeSet<usize> = BTreeSet::new();
    for of in by_class.values() {
        labelled.insert(of[dice.below(of.len())]);
    }
    let first: Vec<NewSample> = labelled
        .iter()
        .map(|i| {
            user.sample(
                &user.truth[*i],
                &user.truth[*i].class,
                SampleState::Accepted,
            )
        })
        .collect();
    db.add_samples(&first, "user")?;
    let (mut done, mut answers) = (Vec::new(), 0);
    for _ in 0..rounds {
        let begun = Instant::now();
        let proposals = db.propose(&ProposeOptions::default(), &())?;
        let secs = begun.elapsed().as_secs_f64();
        let (mut right, mut sure, mut wrong, mut surest) = (labelled.clone(), 0, 0, [0; 2]);
        for p in proposals.iter().filter(|p| p.is_sure()) {
            sure += 1;
            surest[0] += usize::from(p.score >= 0.9);
            match user.under(p.clip, p.span.start_secs, p.span.stop_secs) {
                Some(t) if user.truth[t].class == p.class && right.insert(t) => {}
                _ => {
                    wrong += 1;
                    surest[1] += usize::from(p.score >= 0.9);
                }
            }
        }
        done.push(Round {
            answers,
            labelled: labelled.len(),
            right: right.len(),
            sure,
            wrong,
            surest,
            secs,
        });
        if right.len() == user.truth.len() && wrong == 0 {
            break;
        }
        let asked = most_informative(&proposals, ask);
        if asked.is_empty() {
            break;
        }
        answers += asked.len();
        let given: Vec<NewSample> = asked
            .into_iter()
            .map(|i| user.answer(&proposals[i]))
            .collect();
        for answer in given.iter().filter(|a| a.state == SampleState::Accepted) {
            labelled.extend(user.under(answer.clip, answer.start_secs, answer.stop_secs));
        }
        db.add_samples(&given, "user")?;
    }
    Ok(done)
}

fn number(args: &[String], name: &str, default: usize) -> usize {
    let at = args.iter().position(|a| a == name);
    at.and_then(|at| args.get(at + 1)?.parse().ok())
        .unwrap_or(default)
}

fn main() -> Result<ExitCode, Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let which = args
        .first()
        .filter(|a| !a.starts_with('-'))
        .map_or("signals", String::as_str);
    let data = std::env::var_os("MOREC_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    if !data.is_dir() {
        eprintln!(
            "skipped: no clips at {} (MOREC_DATA says where they are)",
            data.display()
        );
        return Ok(ExitCode::SUCCESS);
    }
    let (ask, seeds) = (number(&args, "--ask", 10), number(&args, "--seeds", 3));
    let rounds = number(&args, "--rounds", 40);
    let material = material(&data, which)?;
    let folder = tempfile::tempdir()?;
    let mut db = imported(&material, &folder.path().join("labelling.mdb"))?;
    let clips = db.clips(&ClipFilter::default())?;
    let user = User {
        truth: &material.truth,
        ids: clips.iter().map(|c| (c.name.clone(), c.id)).collect(),
        secs: clips
            .iter()
            .map(|c| (c.name.clone(), c.duration_secs()))
            .collect(),
    };
    let total = material.truth.len();
    let secs: f64 = clips.iter().map(|c| c.duration_secs()).sum();
    println!(
        "{which}: {} clips, {secs:.0} s, {total} samples",
        clips.len()
    );
    for seed in 0..seeds as u64 {
        let done = play(&mut db, &user, seed, ask, rounds)?;
        println!(
            "seed {seed}\n  answers  labelled   right  share    sure  wrong  of 0.9  wrong    secs"
        );
        for r in &done {
            let share = r.right as f64 / total as f64;
            println!(
                "  {:7}  {:8}  {:6}  {share:5.3}  {:6}  {:5}  {:6}  {:5}  {:6.2}",
                r.answers, r.labelled, r.right, r.sure, r.wrong, r.surest[0], r.surest[1], r.secs
            );
        }
        let reached = done.iter().find(|r| r.right as f64 >= 0.95 * total as f64);
        match reached {
            Some(r) => {
                println!(
                    "  95 % after {} answers, {} wrong among {} sure",
                    r.answers, r.wrong, r.sure
                )
            }
            None => println!("  95 % not reached"),
        }
    }
    Ok(ExitCode::SUCCESS)
}
