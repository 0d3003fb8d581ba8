//! `morec db search`: finds motions like an example, by words, or by vectors.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use morec::TimeSpan;
use morec::import::ImportOptions;
use morec_db::search::{Example, Hit, SearchIndex};
use morec_db::{ClipFilter, ClipId, ClipInfo, MotionDb, StoredClip};
use morec_ops::{SearchSettings, example_of_clip, example_of_database};
use serde::Serialize;

use super::page::{self, Page};
use super::words;
use crate::database;
use crate::files::{self, ReadArgs};
use crate::print;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Find stretches like an example, by words, or clips by your own vectors
///
/// The example is a stretch of a clip in the database or of a file, with any skeleton and frame rate. With --learned, differences
/// that also occur within labelled classes count less. To find similar whole clips, give a whole clip and --one-a-clip.
///
/// With --words, clips and stretches are found by the names of classes, captions, tags, file names, sources and people.
///
/// With --embeddings, clips are ranked by vectors that you have computed, such as those of a model of motion and text.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db search moves.mdb walk_01 --start 1.2 --stop 2.5
  morec db search moves.mdb recorded.bvh --mirror --report hits.html
  morec db search moves.mdb walk_01 --one-a-clip --limit 50 --json
  morec db search moves.mdb walk_01 --one-a-clip --learned
  morec db search moves.mdb --words \"wave left hand\" --captions babel.json
  morec db search moves.mdb --embeddings clips.tsv --like walk_01
  morec db search moves.mdb --embeddings v.tsv --queries q.tsv --like \"slow bow\"")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// The example: a clip of the database by name, or a file
    #[arg(value_name = "CLIP|FILE", required_unless_present_any = ["words", "embeddings"])]
    example: Option<String>,
    /// Find what these words describe, in place of an example
    ///
    /// Words are found in their other forms (waving), in synonyms (run, jog), and where they begin another. Hits are
    /// ranked by the share of the words that they have; rare words count more.
    #[arg(
        long,
        value_name = "WORDS",
        conflicts_with_all = ["example", "start", "stop", "mirror", "learned", "one_a_clip"]
    )]
    words: Option<String>,
    /// Descriptions of clips that --words searches too
    ///
    /// A table with columns clip and caption, BABEL, a folder of HumanML3D, or lines of a name and a description (the
    /// index of CMU).
    #[arg(long, value_name = "FILE|DIR", num_args = 1.., requires = "words")]
    captions: Vec<PathBuf>,
    /// Rank clips by a table of vectors: a name and numbers in each line
    ///
    /// Clips are ranked by the cosine similarity of their vectors to the vector named by --like.
    #[arg(
        long,
        value_name = "TABLE",
        requires = "like",
        conflicts_with_all = ["example", "words", "start", "stop", "mirror", "learned", "one_a_clip"]
    )]
    embeddings: Option<PathBuf>,
    /// Name of the vector that clips of --embeddings are compared with
    #[arg(long, value_name = "NAME", requires = "embeddings")]
    like: Option<String>,
    /// Table that has the vector of --like [default: that of --embeddings]
    #[arg(long, value_name = "TABLE", requires = "embeddings")]
    queries: Option<PathBuf>,
    /// Start of the example, seconds
    #[arg(long, value_name = "SECS", default_value_t = 0.0)]
    start: f64,
    /// Stop of the example, seconds [default: the clip's end]
    #[arg(long, value_name = "SECS")]
    stop: Option<f64>,
    #[command(flatten)]
    settings: SearchSettings,
    /// Write a page with strips of poses of the example and all hits
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

#[derive(Serialize)]
struct SearchResult {
    ticks: usize,
    load_secs: f64,
    search_secs: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    learned: Option<Learned>,
    hits: Vec<NamedHit>,
}

/// Training data of the metric.
#[derive(Serialize)]
struct Learned {
    classes: usize,
    samples: usize,
}

#[derive(Serialize)]
struct NamedHit {
    #[serde(rename = "clip")]
    name: String,
    #[serde(flatten)]
    hit: Hit,
}

/// Searches and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let begun = Instant::now();
    let db = database::open_read_only(&args.db)?;
    if let Some(path) = &args.report {
        page::check(path)?;
    }
    if let Some(words) = &args.words {
        let out = (args.report.as_deref(), args.json);
        words::run(&db, words, &args.captions, args.settings.limit, out)?;
        return Ok(ExitCode::SUCCESS);
    }
    if let (Some(table), Some(like)) = (&args.embeddings, &args.like) {
        let of = (table.as_path(), args.queries.as_deref(), like.as_str());
        let out = (args.report.as_deref(), args.json);
        words::by_embeddings(&db, of, args.settings.limit, out)?;
        return Ok(ExitCode::SUCCESS);
    }
    let index = SearchIndex::of_reader(&db, &StageBar::stoppable()?)?;
    let (example, shown) = example(&db, &index, args)?;
    let metric = args.settings.metric(&db, &index)?;
    let names: BTreeMap<ClipId, String> = db
        .clips(&ClipFilter::default())?
        .into_iter()
        .map(|c| (c.id, c.name))
        .collect();
    let load_secs = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    let hits = index.search_by(&example, &args.settings.options(), metric.as_ref());
    let search_secs = begun.elapsed().as_secs_f64();
    let named = |hit: Hit| NamedHit {
        name: names.get(&hit.clip).cloned().unwrap_or_default(),
        hit,
    };
    let hits: Vec<NamedHit> = hits.into_iter().map(named).collect();
    let learned = metric.map(|m| Learned {
        classes: m.classes().len(),
        samples: m.samples(),
    });
    let found = SearchResult {
        ticks: index.ticks(),
        load_secs,
        search_secs,
        learned,
        hits,
    };
    if let Some(path) = &args.report {
        report(path, &db, &shown, args, &found)?;
    }
    if args.json {
        print::print_json(&found)?;
    } else {
        print(&found, index.tick_hz())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Motion that the example is a stretch of.
enum Shown {
    Kept(Box<ClipInfo>),
    File(Box<StoredClip>),
}

/// The example's rows, and the clip they are of.
fn example(db: &MotionDb, index: &SearchIndex, args: &Args) -> Result<(Example, Shown)> {
    let (name, start, stop) = (
        args.example.as_deref().unwrap_or_default(),
        args.start,
        args.stop,
    );
    if let Ok(clip) = db.find_clip(name) {
        let example = example_of_database(db, index, name, start, stop)?;
        return Ok((example, Shown::Kept(Box::new(clip))));
    }
    let path = Path::new(name);
    if !path.exists() && path != Path::new("-") {
        let hint = db.hint_of_clip(name);
        bail!("{name}: neither a clip of the database nor a file{hint}");
    }
    let takes = files::takes(path, &args.read, &ImportOptions::default())?;
    let take = takes.into_iter().next();
    let take = take.with_context(|| format!("{name}: contains no clip"))?;
    let stored = StoredClip {
        clip: take.clip,
        roles: take.roles,
        rest: take.report.rest_frames,
    };
    let of = (&stored.clip, &stored.roles, &stored.rest);
    Ok((
        example_of_clip(of, start, stop)?,
        Shown::File(Box::new(stored)),
    ))
}

fn report(
    path: &Path,
    db: &MotionDb,
    example: &Shown,
    args: &Args,
    found: &SearchResult,
) -> Result<()> {
    let mut page = Page::default();
    page.heading("Looked for");
    let end = match example {
        Shown::Kept(clip) => clip.duration_secs(),
        Shown::File(stored) => stored.clip.duration_secs(),
    };
    let span = TimeSpan::new(args.start, args.stop.unwrap_or(end));
    let name = args.example.as_deref().unwrap_or_default();
    let caption = format!("{name} {span:.2}");
    match example {
        Shown::Kept(clip) => page.figure(db, clip.id, span, &caption)?,
        Shown::File(stored) => page.figure_of(stored, span, &caption),
    }
    page.heading("Found");
    for NamedHit { name: clip, hit } in &found.hits {
        let mirrored = if hit.mirrored { ", mirrored" } else { "" };
        let caption = format!("{clip} {:.2}, score {:.3}{mirrored}", hit.span, hit.score);
        page.figure(db, hit.clip, hit.span, &caption)?;
    }
    let head = format!("{} hits in {}", found.hits.len(), args.db.display());
    page.write(path, &format!("Like {name}"), &head)
}

fn print(found: &SearchResult, tick_hz: f64) -> Result<()> {
    let mut table =
        TextTable::new(["clip", "start", "stop", "score", "path", "seen"]).least(["path"]);
    for named in &found.hits {
        let hit = &named.hit;
        table.row([
            named.name.clone(),
            format!("{:.2}", hit.span.start_secs),
            format!("{:.2}", hit.span.stop_secs),
            format!("{:.3}", hit.score),
            format!("{:.2}", hit.warp_distance),
            if hit.mirrored {
                "mirrored".to_owned()
            } else {
                String::new()
            },
        ]);
    }
    let minutes = found.ticks as f64 / tick_hz / 60.0;
    let mut text = format!(
        "{minutes:.1} min searched in {:.1} ms\n",
        1e3 * found.search_secs
    );
    if let Some(learned) = &found.learned {
        text.push_str(&format!(
            "by a metric learned from {} samples of {} classes\n",
            learned.samples, learned.classes
        ));
    }
    print::print_table(&table, &text)
}
