//! `morec db report`: a database as one page of HTML, with pictures of its motions.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use morec_db::labels::{SampleFilter, State};
use morec_db::{ClipFilter, ClipId, MotionDb, StoredClip};

use super::megabytes;
use super::strip::strip;
use crate::files;

/// Write a page of HTML with a strip of poses for clips, cuts and samples
///
/// One file, nothing loaded from elsewhere.
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// The file to write
    #[arg(short, long, value_name = "HTML")]
    output: PathBuf,
    /// Clips whose name matches
    #[arg(long, value_name = "PATTERN")]
    name: Option<String>,
    /// At most so many clips, and so many samples of a class
    #[arg(long, value_name = "N", default_value_t = 40)]
    limit: usize,
    /// Print one JSON object: what was drawn
    #[arg(long)]
    json: bool,
}

/// Poses in a strip.
const POSES: usize = 8;

/// Draws and writes.
pub fn run(args: &Args) -> Result<ExitCode> {
    let db = MotionDb::open_read_only(&args.db)?;
    let mut page = Page::default();
    page.classes(&db, args.limit)?;
    page.clips(&db, args)?;
    let title = args.db.file_name().unwrap_or_default().to_string_lossy().into_owned();
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
    let html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>{STYLE}</style></head>\
         <body>\n<h1>{0}</h1>\n<p>{head}</p>\n{1}</body></html>\n",
        escaped(&title),
        page.html
    );
    files::write_whole(&args.output, |out| out.write_all(html.as_bytes()))
        .with_context(|| args.output.display().to_string())?;
    if args.json {
        super::print_json(&serde_json::json!({ "path": args.output, "strips": page.strips }))?;
    } else {
        super::print(format_args!("{}: {} strips of poses\n", args.output.display(), page.strips))?;
    }
    Ok(ExitCode::SUCCESS)
}

const STYLE: &str = "body{font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;\
color:#222;background:#fff}h2{margin-top:1.6em}figure{display:inline-block;margin:.3em 1em .6em 0}\
figcaption{font-size:13px}svg{background:#f4f4f4;border-radius:4px}path{fill:none;stroke-width:1.3;stroke-linecap:round}\
@media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}svg{background:#262626}}";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[derive(Default)]
struct Page {
    html: String,
    strips: usize,
    /// The clip decoded last: samples come clip by clip.
    last: Option<(ClipId, StoredClip)>,
}

impl Page {
    fn figure(&mut self, db: &MotionDb, clip: ClipId, start: f64, stop: f64, caption: &str) -> Result<()> {
        if self.last.as_ref().is_none_or(|(id, _)| *id != clip) {
            self.last = Some((clip, db.clip(clip)?));
        }
        if let Some((_, stored)) = &self.last {
            let svg = strip(stored, start, stop, POSES);
            self.html
                .push_str(&format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escaped(caption)));
            self.strips += 1;
        }
        Ok(())
    }

    fn classes(&mut self, db: &MotionDb, limit: usize) -> Result<()> {
        for class in db.classes()? {
            let (name, accepted, proposed) = (escaped(&class.name), class.accepted, class.proposed);
            self.html.push_str(&format!("<h2>{name}: {accepted} samples, {proposed} proposed</h2>\n"));
            for state in [State::Accepted, State::Proposed] {
                let filter = SampleFilter { class: Some(class.name.clone()), state: Some(state), clip: None };
                for s in db.samples(&filter)?.into_iter().take(limit) {
                    let score = s.score.map_or_else(String::new, |score| format!(", score {score:.2}"));
                    let state =
                        if state == State::Proposed { format!(" proposed{score}") } else { String::new() };
                    let caption = format!("{} {:.2}–{:.2} s{state}", s.clip_name, s.start_secs, s.stop_secs);
                    self.figure(db, s.clip, s.start_secs, s.stop_secs, &caption)?;
                }
            }
        }
        Ok(())
    }

    fn clips(&mut self, db: &MotionDb, args: &Args) -> Result<()> {
        let segments = db.segments()?;
        let clips = db.clips(&ClipFilter { name: args.name.clone(), ..ClipFilter::default() })?;
        self.html.push_str("<h2>Clips</h2>\n");
        for clip in clips.iter().take(args.limit) {
            let secs = clip.duration_secs();
            self.figure(db, clip.id, 0.0, secs, &format!("{} {secs:.1} s", clip.name))?;
            let of_clip: Vec<_> = segments
                .iter()
                .filter(|s| s.clip == clip.id && s.kind == morec_db::SegmentKind::Motion)
                .collect();
            if of_clip.len() > 1 {
                for (number, s) in of_clip.iter().enumerate() {
                    let caption = format!("segment {}: {:.1}–{:.1} s", number + 1, s.start_secs, s.stop_secs);
                    self.figure(db, clip.id, s.start_secs, s.stop_secs, &caption)?;
                }
                self.html.push_str("<br>\n");
            }
        }
        if clips.len() > args.limit {
            self.html.push_str(&format!("<p>and {} more clips</p>\n", clips.len() - args.limit));
        }
        Ok(())
    }
}
