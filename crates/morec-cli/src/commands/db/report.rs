//! `morec db report`: a database as one page of HTML, with pictures of its motions.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec::TimeSpan;
use morec_db::labels::{DbSample, SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipInfo, MotionDb, SegmentKind};

use super::page::{self, Page};
use crate::database;
use crate::print::{self, megabytes};

/// Write a page of HTML with strips of poses of clips, cuts and samples
///
/// The page is one file; click a strip to play it. Clips and samples beyond --limit are listed by name. Groups and search hits
/// have pages of their own: `morec group --report`, `morec db search --report`.
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// File to write
    #[arg(short, long, value_name = "HTML")]
    output: PathBuf,
    /// Clips of this name; `*` any text, `?` one character
    #[arg(long, alias = "name", value_name = "CLIP")]
    clip: Option<String>,
    /// At most N clips, and N samples of a class
    #[arg(long, value_name = "N", default_value_t = 40)]
    limit: usize,
    /// Print one JSON object: what was drawn
    #[arg(long)]
    json: bool,
}

/// Draws and writes.
pub fn run(args: &Args) -> Result<ExitCode> {
    let db = database::open_read_only(&args.db)?;
    page::check(&args.output)?;
    let mut page = Page::default();
    classes(&mut page, &db, args.limit)?;
    clips(&mut page, &db, args)?;
    let title = args
        .db
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let s = db.summary()?;
    let head = format!(
        "{} clips, {:.1} min, {} skeletons; {} for {} of clip files; {} samples of {} classes, {} proposed",
        s.clips,
        s.secs / 60.0,
        s.skeletons,
        megabytes(s.file_bytes),
        megabytes(s.source_bytes),
        s.accepted,
        s.classes,
        s.proposed
    );
    page.write(&args.output, &title, &head)?;
    if args.json {
        print::print_json(&serde_json::json!({ "path": args.output, "strips": page.strips() }))?;
    } else {
        print::print(format_args!(
            "{}: {} strips of poses\n",
            args.output.display(),
            page.strips()
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Samples of every class, accepted ones first.
fn classes(page: &mut Page, db: &MotionDb, limit: usize) -> Result<()> {
    for class in db.classes()? {
        let (name, accepted, proposed) = (&class.name, class.accepted, class.proposed);
        page.heading(&format!("{name}: {accepted} samples, {proposed} proposed"));
        for state in [SampleState::Accepted, SampleState::Proposed] {
            let filter = SampleFilter {
                class: Some(class.name.clone()),
                state: Some(state),
                ..SampleFilter::default()
            };
            let samples = db.samples(&filter)?;
            let (shown, rest) = samples.split_at(samples.len().min(limit));
            for s in shown {
                let score = s
                    .score
                    .map_or_else(String::new, |score| format!(", score {score:.2}"));
                let state = if state == SampleState::Proposed {
                    format!(" proposed{score}")
                } else {
                    String::new()
                };
                let caption = format!("{} {:.2}{state}", s.clip_name, s.span());
                page.figure(db, s.clip, s.span(), &caption)?;
            }
            if !rest.is_empty() {
                let item =
                    |s: &DbSample| format!("{} {:.2}, number {}", s.clip_name, s.span(), s.id.0);
                let items: Vec<String> = rest.iter().map(item).collect();
                let summary = format!("{} more {} samples", rest.len(), state.name());
                page.folded(&summary, &items);
            }
        }
    }
    Ok(())
}

/// Clips as a whole, and their cuts.
fn clips(page: &mut Page, db: &MotionDb, args: &Args) -> Result<()> {
    let segments = db.segments()?;
    let clips = db.find_clips(&ClipFilter {
        name: args.clip.clone(),
        ..ClipFilter::default()
    })?;
    page.heading("Clips");
    for clip in clips.iter().take(args.limit) {
        let secs = clip.duration_secs();
        page.figure(
            db,
            clip.id,
            TimeSpan::new(0.0, secs),
            &format!("{} {secs:.1} s", clip.name),
        )?;
        let of_clip: Vec<_> = segments
            .iter()
            .filter(|s| s.clip == clip.id && s.kind == SegmentKind::Motion)
            .collect();
        if of_clip.len() > 1 {
            for (number, s) in of_clip.iter().enumerate() {
                let caption = format!("{} cut {}: {:.1}", clip.name, number + 1, s.span);
                page.figure(db, clip.id, s.span, &caption)?;
            }
            page.new_line();
        }
    }
    if clips.len() > args.limit {
        let item = |clip: &ClipInfo| format!("{} {:.1} s", clip.name, clip.duration_secs());
        let rest: Vec<String> = clips[args.limit..].iter().map(item).collect();
        page.folded(&format!("{} more clips", rest.len()), &rest);
    }
    Ok(())
}
