//! `morec db label`: labels in, and judging them.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use morec_db::exchange::{self, Annotation, Form, Lengths};
use morec_db::labels::{NewSample, State};
use morec_db::{ClipFilter, MotionDb};

use super::history;
use crate::database;
use crate::files::{self, some_of};

/// Read labels from a file, set one by hand, or accept and reject what is there
///
/// Clips are named by file stem; times may be seconds or frames. What a file says twice, or the database knows already,
/// is kept once.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db label moves.mdb labels.tsv
  morec db label moves.mdb take_1.eaf --clip take_1
  morec db label moves.mdb --clip take_1 --class wave --start 1.2 --stop 2.4
  morec db label moves.mdb reviewed.tsv --state rejected
  morec db label moves.mdb --undo

A file of proposals that was looked at (morec db export --state proposed --form csv) is read back as it is: `accepted`,
`rejected` or `proposed` in its column `state`, and in `label` another class where it is one.")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Files of labels: TSV, CSV, JSON (morec's, BABEL's, Label Studio's), ELAN (.eaf), Audacity (.txt)
    #[arg(value_name = "FILE")]
    labels: Vec<PathBuf>,
    /// What form the files are in [default: by their endings and content]
    #[arg(long, value_enum)]
    form: Option<FormArg>,
    /// The clip that a file of one clip, or --class, speaks of
    #[arg(long, value_name = "CLIP")]
    clip: Option<String>,
    /// Set one sample of this class
    #[arg(
        long,
        value_name = "CLASS",
        requires = "clip",
        conflicts_with = "labels"
    )]
    class: Option<String>,
    /// Where it starts, seconds [default: the clip's beginning]
    #[arg(long, value_name = "SECS", requires = "class")]
    start: Option<f64>,
    /// Where it stops, seconds [default: the clip's end]
    #[arg(long, value_name = "SECS", requires = "class")]
    stop: Option<f64>,
    /// What is thought of the samples [default: what the file says, else accepted]
    #[arg(long, value_enum)]
    state: Option<StateArg>,
    /// Who says so
    #[arg(long, value_name = "NAME", default_value = "user")]
    by: String,
    /// Take the last change of labels or classes back
    #[arg(long, conflicts_with_all = ["labels", "class"])]
    undo: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A form of labels.
#[derive(ValueEnum, Clone, Copy, Debug)]
#[allow(missing_docs)]
pub enum FormArg {
    Tsv,
    Csv,
    Json,
    Eaf,
    Audacity,
    Babel,
    LabelStudio,
}

impl From<FormArg> for Form {
    fn from(form: FormArg) -> Self {
        match form {
            FormArg::Tsv => Form::Tsv,
            FormArg::Csv => Form::Csv,
            FormArg::Json => Form::Json,
            FormArg::Eaf => Form::Eaf,
            FormArg::Audacity => Form::Audacity,
            FormArg::Babel => Form::Babel,
            FormArg::LabelStudio => Form::LabelStudio,
        }
    }
}

/// What is thought of a sample.
#[derive(ValueEnum, Clone, Copy, Debug)]
#[allow(missing_docs)]
pub enum StateArg {
    Accepted,
    Proposed,
    Rejected,
}

impl From<StateArg> for State {
    fn from(state: StateArg) -> Self {
        match state {
            StateArg::Accepted => State::Accepted,
            StateArg::Proposed => State::Proposed,
            StateArg::Rejected => State::Rejected,
        }
    }
}

/// Reads, sets or takes back.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    if args.undo {
        return undo(&mut db, args.json);
    }
    let lengths = super::lengths(&db)?;
    let mut absent = BTreeMap::new();
    let annotations = match &args.class {
        Some(class) => vec![by_hand(args, class, &lengths)?],
        None if args.labels.is_empty() => {
            bail!("nothing to label: give a file, or --clip and --class")
        }
        None => read(args, &lengths, &mut absent)?,
    };
    let samples = resolve(&db, args, annotations, &lengths, &mut absent)?;
    let added = db.add_samples(&samples, &args.by)?;
    if args.json {
        super::print_json(&serde_json::json!({ "samples": added, "absent_clips": absent }))?;
        return Ok(ExitCode::SUCCESS);
    }
    if !absent.is_empty() {
        eprintln!(
            "morec: {} labels of {} clips that are not there were left out: {}",
            absent.values().sum::<usize>(),
            absent.len(),
            some_of(absent.keys())
        );
    }
    super::print(format_args!(
        "{} samples added, {} judged anew, {} as before\n",
        added.added, added.changed, added.unchanged
    ))?;
    Ok(ExitCode::SUCCESS)
}

fn undo(db: &mut MotionDb, json: bool) -> Result<ExitCode> {
    // The history holds changes of every kind: whoever asks here means labels.
    if let Some(last) = db.history()?.into_iter().find(|step| !step.undone) {
        let kinds = ["samples", "classes"];
        if last
            .rows
            .keys()
            .any(|table| !kinds.contains(&table.as_str()))
        {
            bail!(
                "the last change is no change of labels: step {}, {}; morec db undo takes it back",
                last.id,
                last.what
            );
        }
    }
    let undone = db.undo(None)?;
    if json {
        super::print_json(&undone)?;
    } else {
        super::print(match &undone {
            Some(turned) => history::text(turned, "taken back"),
            None => "there is nothing to take back\n".to_owned(),
        })?;
    }
    Ok(ExitCode::SUCCESS)
}

fn by_hand(args: &Args, class: &str, lengths: &Lengths) -> Result<Annotation> {
    let clip = args.clip.clone().context("--clip: which clip?")?;
    let secs = lengths.get(&clip).map(|length| length.duration_secs());
    let extent = match (args.start, args.stop) {
        (None, None) => None,
        (start, stop) => {
            let end = stop
                .or(secs)
                .with_context(|| format!("no clip is called {clip:?}"))?;
            Some((start.unwrap_or(0.0), end))
        }
    };
    Ok(Annotation {
        clip,
        class: class.to_owned(),
        extent,
        person: None,
        score: None,
        state: State::Accepted,
    })
}

fn read(args: &Args, lengths: &Lengths, absent: &mut Absent) -> Result<Vec<Annotation>> {
    let mut all = Vec::new();
    for path in &args.labels {
        let shown = path.display().to_string();
        let bytes = files::read(path)?;
        let form = match args.form {
            Some(form) => form.into(),
            None => Form::of_file(&shown, &bytes).with_context(|| {
                format!("{shown}: its ending says no form of labels; give --form")
            })?,
        };
        let read = exchange::read(form, &bytes, args.clip.as_deref(), lengths)
            .with_context(|| shown.clone())?;
        for warning in &read.warnings {
            eprintln!("morec: {shown}: {warning}");
        }
        all.extend(read.annotations);
        for (clip, count) in read.absent {
            *absent.entry(clip).or_default() += count;
        }
    }
    Ok(all)
}

/// Labels drawn by hand run over a clip's end by so much without a word.
const OVER_SECS: f64 = 0.1;

/// Clips that are not there, and how many labels each has.
type Absent = BTreeMap<String, usize>;

/// Annotations as samples of clips that are there.
fn resolve(
    db: &MotionDb,
    args: &Args,
    annotations: Vec<Annotation>,
    lengths: &Lengths,
    absent: &mut Absent,
) -> Result<Vec<NewSample>> {
    let ids: BTreeMap<String, _> = db
        .clips(&ClipFilter::default())?
        .into_iter()
        .map(|c| (c.name, c.id))
        .collect();
    let mut samples = Vec::new();
    for a in annotations {
        let stem = a
            .clip
            .rsplit_once('.')
            .map_or(a.clip.as_str(), |(stem, _)| stem);
        let Some(name) = [a.clip.as_str(), stem]
            .into_iter()
            .find(|name| ids.contains_key(*name))
        else {
            *absent.entry(a.clip).or_default() += 1;
            continue;
        };
        let length = lengths[name];
        let snap = |secs: f64| exchange::snap(secs, length.rate_hz);
        let end = length.duration_secs();
        let (start_secs, stop_secs) = match a.extent {
            None => (0.0, end),
            Some((start, stop)) if snap(start) >= end => {
                eprintln!(
                    "morec: {name} ends at {end:.2} s: {} from {start:.2} to {stop:.2} s left out",
                    a.class
                );
                continue;
            }
            // A label that runs over the end is cut there.
            Some((start, stop)) => {
                if stop > end + OVER_SECS {
                    eprintln!(
                        "morec: {name} ends at {end:.2} s: {} from {start:.2} to {stop:.2} s cut there",
                        a.class
                    );
                }
                (snap(start), snap(stop).min(end))
            }
        };
        samples.push(NewSample {
            clip: ids[name],
            class: a.class,
            start_secs,
            stop_secs,
            whole_clip: a.extent.is_none(),
            state: args.state.map_or(a.state, State::from),
            score: a.score,
        });
    }
    Ok(samples)
}
