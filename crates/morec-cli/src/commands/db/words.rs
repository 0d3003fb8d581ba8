//! `morec db search --words` and `--embeddings`: what do words describe, and which clips are like a vector?

use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result};
use morec::TimeSpan;
use morec_db::{ClipFilter, EmbeddingTable, MotionDb, WordHit, WordHits, WordIndex};
use morec_ops::captions_of;

use super::page::Page;
use crate::files;
use crate::print;
use crate::table::TextTable;

/// Searches and prints.
pub fn run(
    db: &MotionDb,
    words: &str,
    captions: &[PathBuf],
    limit: usize,
    out: (Option<&Path>, bool),
) -> Result<()> {
    let read = |path: &Path| files::read(path).map_err(|why| format!("{why:#}"));
    let captions = captions_of(captions, &read).map_err(Error::msg)?;
    let index = WordIndex::of(db, &captions)?;
    if index.absent() > 0 {
        let (absent, all) = (index.absent(), captions.len());
        eprintln!(
            "morec: {absent} of {all} captions are of clips that the database does not have; left out"
        );
    }
    let found = index.find(words, limit);
    let (report, json) = out;
    if let Some(path) = report {
        write_page(path, db, words, &found)?;
    }
    match json {
        true => print::print_json(&found),
        false => print_hits(words, &found),
    }
}

/// Ranks clips by their vectors of a table, and prints.
pub fn by_embeddings(
    db: &MotionDb,
    (table, queries, like): (&Path, Option<&Path>, &str),
    limit: usize,
    (report, json): (Option<&Path>, bool),
) -> Result<()> {
    let read = |path: &Path| {
        let table = EmbeddingTable::read(&files::read(path)?);
        table.with_context(|| path.display().to_string())
    };
    let queries = queries.map(read).transpose()?;
    let clips = db.clips(&ClipFilter::default())?;
    let found = read(table)?.nearest(&clips, like, queries.as_ref(), limit)?;
    if found.absent > 0 {
        let absent = found.absent;
        eprintln!("morec: {absent} vectors are of clips that the database does not have; left out");
    }
    if let Some(path) = report {
        let mut page = Page::default();
        page.heading("Found");
        for hit in &found.hits {
            let caption = format!("{}, score {:.3}", hit.clip_name, hit.score);
            page.figure(db, hit.clip, hit.span, &caption)?;
        }
        let head = format!("{} hits", found.hits.len());
        page.write(path, &format!("Like {like}"), &head)?;
    }
    if json {
        return print::print_json(&found);
    }
    let mut listed = TextTable::new(["clip", "start", "stop", "score"]);
    for hit in &found.hits {
        listed.row(cells(&hit.clip_name, hit.span, hit.score));
    }
    print::print_table(&listed, "")
}

/// What every hit is printed with: clip, start, stop, score.
fn cells(clip: &str, span: TimeSpan, score: f64) -> [String; 4] {
    let [start, stop] = [span.start_secs, span.stop_secs].map(|secs| format!("{secs:.2}"));
    [clip.to_owned(), start, stop, format!("{score:.3}")]
}

fn print_hits(words: &str, found: &WordHits) -> Result<()> {
    let mut table = TextTable::new(["clip", "start", "stop", "score", "text", "words in"]);
    for hit in &found.hits {
        let found = cells(&hit.clip_name, hit.span, hit.score);
        table.row(found.into_iter().chain([hit.text.clone(), places(hit)]));
    }
    let mut last = match found.hits.len() {
        0 => format!("nothing is described by {words:?}\n"),
        _ => String::new(),
    };
    if !found.unknown.is_empty() {
        last.push_str(&format!("not found: {}\n", found.unknown.join(", ")));
    }
    print::print_table(&table, &last)
}

fn places(hit: &WordHit) -> String {
    let names = hit.places.iter().map(|place| place.name());
    names.collect::<Vec<_>>().join(", ")
}

fn write_page(path: &Path, db: &MotionDb, words: &str, found: &WordHits) -> Result<()> {
    let mut page = Page::default();
    page.heading("Found");
    for hit in &found.hits {
        let (name, span, text) = (&hit.clip_name, hit.span, &hit.text);
        let caption = format!("{name} {span:.2}, score {:.3} {text}", hit.score);
        page.figure(db, hit.clip, span, &caption)?;
    }
    let head = format!("{} hits", found.hits.len());
    page.write(path, &format!("Described by {words}"), &head)
}
