//! `morec db search --words`: what do words describe?

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec_db::exchange::{Caption, add_sources, read_captions};
use morec_db::{MotionDb, WordHit, WordHits, WordIndex};

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
    let captions = read(captions)?;
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

/// Captions of files, and of folders of HumanML3D: texts, also below `texts`, and `index.csv`.
fn read(paths: &[PathBuf]) -> Result<Vec<Caption>> {
    let mut captions = Vec::new();
    for path in paths {
        if !path.is_dir() {
            captions.extend(read_file(path)?);
            continue;
        }
        let texts = Some(path.join("texts")).filter(|texts| texts.is_dir());
        let folder = texts.as_deref().unwrap_or(path);
        let entries = folder
            .read_dir()
            .with_context(|| folder.display().to_string())?;
        let mut files = entries
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<Vec<_>, _>>()
            .with_context(|| folder.display().to_string())?;
        files.retain(|file| file.extension().is_some_and(|ending| ending == "txt"));
        files.sort();
        if files.is_empty() {
            bail!("{}: expected texts (*.txt), found none", folder.display());
        }
        let mut of_folder = Vec::new();
        for file in &files {
            of_folder.extend(read_file(file)?);
        }
        let table = path.join("index.csv");
        if table.is_file() {
            let added = add_sources(&mut of_folder, &files::read(&table)?);
            added.with_context(|| table.display().to_string())?;
        }
        captions.append(&mut of_folder);
    }
    Ok(captions)
}

fn read_file(path: &Path) -> Result<Vec<Caption>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let captions = read_captions(&name, &files::read(path)?);
    captions.with_context(|| path.display().to_string())
}

fn print_hits(words: &str, found: &WordHits) -> Result<()> {
    let mut table = TextTable::new(["clip", "start", "stop", "score", "text", "words in"]);
    for hit in &found.hits {
        table.row([
            hit.clip_name.clone(),
            format!("{:.2}", hit.span.start_secs),
            format!("{:.2}", hit.span.stop_secs),
            format!("{:.3}", hit.score),
            hit.text.clone(),
            places(hit),
        ]);
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
