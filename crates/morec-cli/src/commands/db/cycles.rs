//! `morec db cycles`: counts repetitions and measures their length.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec::TimeSpan;
use morec::features::FeatureParams;
use morec::segment::{CycleParams, Cycles, cycles};
use morec_db::labels::{NewSample, SampleFilter, SampleId, SampleState};
use morec_db::{ClipFilter, ClipId, MotionDb};
use serde::Serialize;

use crate::database;
use crate::print;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Count repetitions within cuts, clips or labelled stretches
///
/// With --of labels, stretches of a class without a gap between them are joined; their number is the expected count.
/// --split divides labelled stretches evenly into repetitions (undo: morec db label DB --undo).
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Stretches to examine
    #[arg(long, value_enum, default_value = "cuts")]
    of: CycledSpans,
    /// Labelled stretches of this class only
    #[arg(long, value_name = "CLASS")]
    class: Option<String>,
    /// Clips of this name; `*` any text, `?` one character
    #[arg(long, alias = "name", value_name = "CLIP")]
    clip: Option<String>,
    /// Replace each repeating labelled stretch by its repetitions
    #[arg(long)]
    split: bool,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Stretches to look at.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum CycledSpans {
    /// Segments that morec cut found
    Cuts,
    /// Whole clips
    Clips,
    /// Labelled stretches
    Labels,
}

#[derive(Serialize)]
struct Counted {
    clip: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    class: Option<String>,
    #[serde(flatten)]
    span: TimeSpan,
    /// Number of labels that the stretch was put together from.
    labels: usize,
    cycles: Option<Cycles>,
    #[serde(skip)]
    samples: Vec<SampleId>,
    #[serde(skip)]
    id: ClipId,
}

/// Counts and prints; splits if asked to.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut db = if args.split {
        database::open(&args.db)?
    } else {
        database::open_read_only(&args.db)?
    };
    let params = FeatureParams::default();
    let rows: BTreeMap<ClipId, _> = db
        .rows_kept_if_writable(&params, &StageBar::stoppable()?)?
        .into_iter()
        .map(|r| (r.clip, r.rows))
        .collect();
    let mut found = stretches(&db, args)?;
    for stretch in &mut found {
        let Some(rows) = rows.get(&stretch.id) else {
            continue;
        };
        let ticks = (stretch.span).frames_among(rows.len(), params.tick_hz());
        if !ticks.is_empty() {
            stretch.cycles = cycles(
                &rows.slice(ticks),
                params.tick_hz(),
                &CycleParams::default(),
            );
        }
    }
    if args.split {
        split(&mut db, &found)?;
    }
    if args.json {
        print::print_json(&found)?;
    } else {
        print(&found)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn stretches(db: &MotionDb, args: &Args) -> Result<Vec<Counted>> {
    let clips = db.find_clips(&ClipFilter {
        name: args.clip.clone(),
        ..ClipFilter::default()
    })?;
    let names: BTreeMap<ClipId, &str> = clips.iter().map(|c| (c.id, c.name.as_str())).collect();
    let stretch = |id: ClipId, span| {
        Some(Counted {
            clip: (*names.get(&id)?).to_owned(),
            class: None,
            span,
            labels: 0,
            cycles: None,
            samples: Vec::new(),
            id,
        })
    };
    Ok(match args.of {
        CycledSpans::Clips => clips
            .iter()
            .filter_map(|c| stretch(c.id, TimeSpan::new(0.0, c.duration_secs())))
            .collect(),
        CycledSpans::Cuts => {
            let segments = db.segments()?;
            let moving = segments
                .iter()
                .filter(|s| s.kind == morec_db::SegmentKind::Motion);
            moving.filter_map(|s| stretch(s.clip, s.span)).collect()
        }
        CycledSpans::Labels => {
            let filter = SampleFilter {
                class: args.class.clone(),
                state: Some(SampleState::Accepted),
                ..Default::default()
            };
            let mut found: Vec<Counted> = Vec::new();
            for sample in db.samples(&filter)? {
                let follows = |c: &&mut Counted| {
                    c.id == sample.clip
                        && c.class.as_deref() == Some(&sample.class)
                        && (c.span.stop_secs - sample.start_secs).abs() < 1.5 / sample.rate_hz
                        && !args.split
                };
                if let Some(last) = found.iter_mut().rev().find(follows) {
                    last.span.stop_secs = sample.stop_secs;
                    last.labels += 1;
                    last.samples.push(sample.id);
                } else if let Some(mut new) = stretch(sample.clip, sample.span()) {
                    (new.class, new.labels, new.samples) = (Some(sample.class), 1, vec![sample.id]);
                    found.push(new);
                }
            }
            found
        }
    })
}

/// Repetitions in place of stretches; the new ones are added before the old ones go, so that nothing can be lost.
fn split(db: &mut MotionDb, found: &[Counted]) -> Result<()> {
    let (mut new, mut old) = (Vec::new(), Vec::new());
    for stretch in found {
        let (Some(cycles), Some(class)) = (&stretch.cycles, &stretch.class) else {
            continue;
        };
        if cycles.whole() < 2 {
            continue;
        }
        old.extend(&stretch.samples);
        for pair in cycles.bounds(stretch.span.duration_secs()).windows(2) {
            new.push(NewSample::accepted(
                stretch.id,
                class,
                TimeSpan::new(
                    stretch.span.start_secs + pair[0],
                    stretch.span.start_secs + pair[1],
                ),
            ));
        }
    }
    db.add_samples(&new, "cycles")?;
    db.remove_samples(&old)?;
    Ok(())
}

fn print(found: &[Counted]) -> Result<()> {
    let mut table = TextTable::new([
        "clip", "class", "start", "stop", "labels", "cycles", "period", "alike",
    ])
    .least(["alike", "labels", "class"]);
    for c in found {
        let figure = |value: Option<f64>, decimals| {
            value.map_or_else(String::new, |v| format!("{v:.decimals$}"))
        };
        table.row([
            c.clip.clone(),
            c.class.clone().unwrap_or_default(),
            format!("{:.2}", c.span.start_secs),
            format!("{:.2}", c.span.stop_secs),
            if c.labels > 0 {
                c.labels.to_string()
            } else {
                String::new()
            },
            figure(c.cycles.map(|c| c.count), 1),
            figure(c.cycles.map(|c| c.period_secs), 2),
            figure(c.cycles.map(|c| c.correlation), 2),
        ]);
    }
    let repeated: Vec<&Counted> = found.iter().filter(|c| c.labels > 1).collect();
    let right = repeated
        .iter()
        .filter(|c| c.cycles.is_some_and(|k| k.whole() == c.labels))
        .count();
    let last = match repeated.len() {
        0 => String::new(),
        all => format!("{right} of {all} stretches of several labels counted right\n"),
    };
    print::print_table(&table, &last)
}
