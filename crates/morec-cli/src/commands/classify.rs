//! `morec classify`: the class of whole clips.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use morec::classify::{ClassifiedClip, Classifier};
use morec::import::ImportOptions;
use morec::index::MotionIndex;
use morec::labels::some_of;
use morec::live::Model;

use super::recognize::{OutputFormat, adapt, open_index, write_rows};
use crate::files::{ReadArgs, expand_as, mapping, takes_as};
use crate::progress::SlowProgress;

/// Name the class of whole clips, each cut around one motion.
///
/// The motion of each clip is compared with the samples of all classes. The result is the nearest class if it is more probable
/// than all alternatives together, otherwise none. To find motions in longer clips, use `morec recognize`.
///
/// Writes one line for each clip: clip, class (empty: none), its probability, the nearest class, and the probability of
/// each class.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 all clips done; 1 a file cannot be read (the others are done); 2 wrong command line.\n\n\
    Example: morec classify signs.index cut/ -o classes.tsv"
)]
pub struct Args {
    /// Index file of `morec train`
    index: PathBuf,
    /// Clips, or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Format of the output
    #[arg(long, value_enum, default_value = "tsv")]
    form: OutputFormat,
    /// File to write to [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let index = open_index(&args.index)?;
    let shown = || args.index.display().to_string();
    let classifier = Classifier::new(&index.model).with_context(shown)?;
    let paths = expand_as(&args.clips, index.has_custom_roles())?;
    let form = (args.form, "a table of classes (--form)");
    let failed = write_rows(args.output.as_deref(), form, |out| {
        classify_all(out, &paths, &index, &classifier, args)
    })?;
    Ok(ExitCode::from(u8::from(failed)))
}

/// Writes the class of every clip; gives whether one of them could not be read.
fn classify_all(
    out: &mut dyn Write,
    paths: &[PathBuf],
    index: &MotionIndex,
    classifier: &Classifier,
    args: &Args,
) -> Result<bool> {
    let options = ImportOptions {
        mapping: mapping(args.roles.as_deref())?,
        ..ImportOptions::default()
    };
    if args.form == OutputFormat::Tsv {
        let names: Vec<&str> = (index.model.classes().iter())
            .map(|class| class.name.as_str())
            .collect();
        writeln!(out, "{HEADER}\t{}", names.join("\t"))?;
    }
    let mut progress = SlowProgress::new(paths.len(), "classifying");
    let (mut failed, mut none) = (false, Vec::new());
    for path in paths {
        let found = classify_file(path, index, classifier, &options, args);
        let clips = progress.step_of(found);
        failed |= clips.is_none();
        for (clip, found) in clips.into_iter().flatten() {
            write_line(out, args.form, &clip, &index.model, &found)?;
            none.extend(found.class.is_none().then_some(clip));
        }
    }
    out.flush()?;
    drop(progress);
    if !none.is_empty() {
        let names = some_of(&none);
        eprintln!("morec: {} clips have no class: {names}", none.len());
    }
    Ok(failed)
}

const HEADER: &str = "clip\tclass\tprobability\tnearest";

fn classify_file(
    path: &Path,
    index: &MotionIndex,
    classifier: &Classifier,
    options: &ImportOptions,
    args: &Args,
) -> Result<Vec<(String, ClassifiedClip)>> {
    let classify = |mut take: morec::Take| {
        adapt(&mut take, index, path, options.mapping.is_none());
        let found = classifier.classify(&take.clip, &take.roles, take.rest());
        let shown = || format!("{} ({})", path.display(), take.clip.name);
        Ok((take.clip.name.clone(), found.with_context(shown)?))
    };
    let takes = takes_as(path, &args.read, options, index.has_custom_roles())?;
    takes.into_iter().map(classify).collect()
}

fn write_line(
    out: &mut dyn Write,
    form: OutputFormat,
    clip: &str,
    model: &Model,
    found: &ClassifiedClip,
) -> std::io::Result<()> {
    let named = found.named(model);
    if form == OutputFormat::Jsonl {
        let mut object = serde_json::to_value(named)?;
        object["clip"] = clip.into();
        return writeln!(out, "{object}");
    }
    let probability = (named.probability).map_or_else(String::new, |p| format!("{p:.3}"));
    let (class, nearest) = (named.class.unwrap_or(""), named.nearest.unwrap_or(""));
    write!(out, "{clip}\t{class}\t{probability}\t{nearest}")?;
    for probability in &found.probabilities {
        write!(out, "\t{probability:.3}")?;
    }
    writeln!(out)
}
