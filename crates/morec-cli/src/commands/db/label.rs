//! `morec db label`: reads labels from files, sets labels, and accepts or rejects samples.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::labels::some_of;
use morec_db::exchange::{self, Annotation, ClipLengths, LabelContext, LabelFormat};
use morec_db::labels::{
    Added, ChangedLabel, LabelChange, LabelOptions, Labelled, NewSample, SampleState,
};
use morec_db::{ClipFilter, MotionDb};
use serde::Serialize;

use super::history;
use crate::database;
use crate::files;
use crate::labels::{self, LabelArgs};
use crate::named::by_name;
use crate::print;
use crate::table::TextTable;

/// Read labels from files, set one, or accept and reject samples
///
/// Clips are named by file stem; times are seconds or frames. Labels that exist already are kept once.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db label moves.mdb labels.tsv
  morec db label moves.mdb take_1.eaf --clip take_1
  morec db label moves.mdb --clip take_1 --class wave --start 1.2 --stop 2.4
  morec db label moves.mdb reviewed.tsv --state rejected
  morec db label moves.mdb ann.tsv --annotator ann
  morec db label moves.mdb corrected.tsv --replace --dry-run
  morec db label moves.mdb --undo

Proposals can be judged in a file: write it with morec db export --state proposed --form csv, set `accepted` or `rejected`
in its column `state`, correct the class in `label`, and read the file back.")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Label files, or folders of them
    ///
    /// TSV, CSV, JSON (morec's, BABEL's, Label Studio's), ELAN (.eaf), Audacity (.txt), BORIS (TSV, CSV), BIDS
    /// (_events.tsv), Praat (.TextGrid), subtitles (.srt, .vtt), events of C3D.
    #[arg(value_name = "FILE|DIR")]
    labels: Vec<PathBuf>,
    /// Form of the files [default: by extension and content]
    #[arg(long, value_parser = by_name(&LabelFormat::ALL, LabelFormat::name))]
    form: Option<LabelFormat>,
    /// The clip that --class, or a file of one clip, refers to
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
    /// Start, seconds [default: the clip's beginning]
    #[arg(long, value_name = "SECS", requires = "class")]
    start: Option<f64>,
    /// Stop, seconds [default: the clip's end]
    #[arg(long, value_name = "SECS", requires = "class")]
    stop: Option<f64>,
    /// State of the samples [default: as in the file, else accepted]
    #[arg(long, value_parser = by_name(&SampleState::ALL, SampleState::name))]
    state: Option<SampleState>,
    /// Author of the change
    #[arg(
        hide_short_help = true,
        long,
        value_name = "NAME",
        default_value = "user"
    )]
    by: String,
    /// Annotator of labels whose file names none
    #[arg(long, value_name = "NAME", conflicts_with = "undo")]
    annotator: Option<String>,
    /// Replace all accepted labels of the named clips with those in the files
    ///
    /// Samples that the files lack are renamed, moved or removed.
    #[arg(long, conflicts_with_all = ["class", "undo"])]
    replace: bool,
    /// Only print what would change, sample by sample
    #[arg(long, conflicts_with = "undo")]
    dry_run: bool,
    /// Undo the last change of labels or classes
    #[arg(long, conflicts_with_all = ["labels", "class"])]
    undo: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: LabelArgs,
}

/// Reads, sets or takes back.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    if args.undo {
        return undo(&mut db, args.json);
    }
    if let Some(clip) = &args.clip {
        db.find_clip(clip)?;
    }
    let lengths = database::lengths(&db)?;
    let mut absent = BTreeMap::new();
    let annotations = match &args.class {
        Some(class) => vec![by_hand(args, class, &lengths)?],
        None if args.labels.is_empty() => {
            bail!("nothing to label: give a file, or --clip and --class")
        }
        None => {
            let clips = db.clips(&ClipFilter::default())?;
            let files = clips.iter().map(|clip| PathBuf::from(&clip.path));
            let c3d = files.filter(|file| {
                file.extension()
                    .is_some_and(|end| end.eq_ignore_ascii_case("c3d"))
            });
            read(args, &lengths, &c3d.collect::<Vec<_>>(), &mut absent)?
        }
    };
    let classes = annotations.iter().map(|a| a.class.as_str());
    if let Some(doubt) = labels::doubt_of_none(classes) {
        eprintln!("morec: {doubt}");
    }
    let mut annotations = annotations;
    if let Some(annotator) = &args.annotator {
        let unsaid = annotations.iter_mut().filter(|a| a.annotator.is_none());
        unsaid.for_each(|a| a.annotator = Some(annotator.clone()));
    }
    let mut resolved = exchange::resolve(annotations, &db.clips(&ClipFilter::default())?);
    for note in &resolved.notes {
        eprintln!("morec: {note}");
    }
    if let Some(why) = resolved.doubtful_unit().filter(|_| args.class.is_none()) {
        bail!("nothing was changed: {why}");
    }
    for asked in db.misspelled(&resolved.samples)? {
        eprintln!("morec: {asked}");
    }
    for (clip, count) in resolved.absent {
        *absent.entry(clip).or_default() += count;
    }
    if let Some(state) = args.state {
        resolved.samples.iter_mut().for_each(|s| s.state = state);
    }
    let samples = resolved.samples;
    let options = LabelOptions {
        by: args.by.clone(),
        replace: args.replace,
        dry_run: args.dry_run,
        people: resolved.people,
        annotators: resolved.annotators,
    };
    let done = db.label(&samples, &options)?;
    if args.json {
        let changes = match args.dry_run {
            true => Some(named_changes(&db, &done)?),
            false => None,
        };
        print::print_json(&serde_json::json!({
            "samples": done.counts, "absent_clips": absent, "changes": changes,
        }))?;
        return Ok(code(&samples, &absent));
    }
    say_absent(&db, &absent);
    if args.dry_run {
        print::print_table(&changes(&db, &done)?, "")?;
    }
    print::print(said(&done.counts, args))?;
    Ok(code(&samples, &absent))
}

/// Labels of which none found its clip are a mistake, not a part of a larger file.
fn code(samples: &[NewSample], absent: &Absent) -> ExitCode {
    match samples.is_empty() && !absent.is_empty() {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    }
}

fn say_absent(db: &MotionDb, absent: &Absent) {
    /// For this many, near names are listed.
    const HINTED: usize = 5;
    if absent.is_empty() {
        return;
    }
    eprintln!(
        "morec: {} labels of {} unknown clips left out: {}",
        absent.values().sum::<usize>(),
        absent.len(),
        some_of(absent.keys())
    );
    // That there are other names is no help; that one is near is.
    let near = absent.keys().map(|clip| (clip, db.hint_of_clip(clip)));
    for (clip, hint) in near.filter(|(_, hint)| hint.contains('?')).take(HINTED) {
        eprintln!("morec: no clip is called {clip:?}{hint}");
    }
}

fn said(counts: &Added, args: &Args) -> String {
    let mut parts = vec![
        format!("{} samples added", counts.added),
        format!("{} judged anew", counts.changed),
    ];
    if args.replace {
        parts.push(format!("{} moved", counts.moved));
        parts.push(format!("{} renamed", counts.renamed));
        parts.push(format!("{} gone", counts.gone));
    }
    parts.push(format!("{} as before", counts.unchanged));
    if counts.rejected > 0 {
        parts.push(format!(
            "{} proposals rejected by these labels",
            counts.rejected
        ));
    }
    if counts.withdrawn > 0 {
        parts.push(format!("{} proposals of groups removed", counts.withdrawn));
    }
    if counts.people > 0 {
        parts.push(format!("{} clips assigned to persons", counts.people));
    }
    if counts.annotated > 0 {
        parts.push(format!("{} given an annotator", counts.annotated));
    }
    let would = if args.dry_run {
        "nothing was changed; with this command: "
    } else {
        ""
    };
    format!("{would}{}\n", parts.join(", "))
}

/// A change with the name of its clip.
#[derive(Serialize)]
struct NamedChange<'a> {
    clip: String,
    #[serde(flatten)]
    change: &'a ChangedLabel,
}

fn named_changes<'a>(db: &MotionDb, done: &'a Labelled) -> Result<Vec<NamedChange<'a>>> {
    let clips = db.clips(&ClipFilter::default())?;
    let names: BTreeMap<_, _> = clips.into_iter().map(|c| (c.id, c.name)).collect();
    let named = |change: &'a ChangedLabel| NamedChange {
        clip: names.get(&change.clip).cloned().unwrap_or_default(),
        change,
    };
    Ok(done.changes.iter().map(named).collect())
}

fn changes(db: &MotionDb, done: &Labelled) -> Result<TextTable> {
    let clips = db.clips(&ClipFilter::default())?;
    let names: BTreeMap<_, _> = clips.into_iter().map(|c| (c.id, c.name)).collect();
    let mut table = TextTable::new(["clip", "change", "class", "start", "stop", "was"]);
    for changed in &done.changes {
        let change = match changed.change {
            LabelChange::Added => "added",
            LabelChange::Judged => "judged",
            LabelChange::Moved => "moved",
            LabelChange::Renamed => "renamed",
            LabelChange::Gone => "gone",
        };
        let was = changed
            .was
            .as_ref()
            .map_or_else(String::new, |(class, start, stop)| {
                format!("{class} {start:.2} to {stop:.2} s")
            });
        table.row([
            names.get(&changed.clip).cloned().unwrap_or_default(),
            change.to_owned(),
            changed.class.clone(),
            format!("{:.2}", changed.start_secs),
            format!("{:.2}", changed.stop_secs),
            was,
        ]);
    }
    Ok(table)
}

fn undo(db: &mut MotionDb, json: bool) -> Result<ExitCode> {
    // The history holds changes of every kind; this command undoes changes of labels only.
    if let Some(last) = db.history()?.into_iter().find(|step| !step.undone) {
        let kinds = ["samples", "classes", "annotators"];
        if last
            .rows
            .keys()
            .any(|table| !kinds.contains(&table.as_str()))
        {
            bail!(
                "the last change is not a change of labels: step {}, {}; undo it with morec db undo",
                last.id,
                last.what
            );
        }
    }
    let undone = db.undo(None)?;
    if json {
        print::print_json(&undone)?;
    } else {
        print::print(match &undone {
            Some(turned) => history::text(turned, "undone"),
            None => "nothing to undo\n".to_owned(),
        })?;
    }
    Ok(ExitCode::SUCCESS)
}

fn by_hand(args: &Args, class: &str, lengths: &ClipLengths) -> Result<Annotation> {
    let clip = args
        .clip
        .clone()
        .context("--clip: give the name of the clip")?;
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
        state: SampleState::Accepted,
        annotator: None,
    })
}

fn read(
    args: &Args,
    lengths: &ClipLengths,
    files: &[PathBuf],
    absent: &mut Absent,
) -> Result<Vec<Annotation>> {
    let first_frames = args.reading.first_frames(files)?;
    let mut all = Vec::new();
    for path in &labels::files_of_labels(&args.labels)? {
        let shown = path.display().to_string();
        let bytes = files::read(path)?;
        let form = match args.form {
            Some(form) => form,
            None => LabelFormat::of_file(&shown, &bytes).with_context(|| {
                format!("{shown}: cannot infer the label format from the extension; pass --form")
            })?,
        };
        // A label track does not name its clip; its file does, if morec wrote it.
        let named = match (&args.clip, form) {
            (Some(clip), _) => Some(clip.clone()),
            (None, LabelFormat::Audacity | LabelFormat::Bids) => {
                exchange::clip_of_file(path, lengths)
            }
            (None, _) => None,
        };
        let context = LabelContext {
            clip: named.as_deref(),
            lengths: Some(lengths),
            label_rate_hz: args.reading.label_rate,
            tiers: &args.reading.tier,
            first_frames: Some(&first_frames),
        };
        let mut read =
            exchange::read_with(form, &bytes, &context).with_context(|| shown.clone())?;
        read.annotations.retain_mut(|a| match &mut a.extent {
            None => true,
            Some(extent) => {
                let moved = args.reading.moved(&shown, &a.class, *extent);
                *extent = moved.unwrap_or(*extent);
                moved.is_some()
            }
        });
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

/// Clips that are not there, and how many labels each has.
type Absent = BTreeMap<String, usize>;
