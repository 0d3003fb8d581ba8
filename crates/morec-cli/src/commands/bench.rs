//! `morec bench`: the speed of recognition on this machine.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::import::{ImportOptions, Take};
use morec::index::MotionIndex;
use morec::live::RecognizerCache;

use super::recognize::{adapt, open_index};
use crate::files::{ReadArgs, expand, mapping, open, say_doubts};
use crate::progress::SlowProgress;
use crate::stats::Stats;

/// Measure the speed of recognition, stage by stage.
///
/// Recognises all clips repeatedly on one core and prints, for the pass with the median time, each stage's microseconds per
/// frame, share of the total and frames per second. Each stage is also measured alone, so the stages do not add up to the total.
/// Other running programs affect the figures.
#[derive(clap::Args)]
#[command(after_help = "Example: morec bench signs.index new/")]
pub struct Args {
    /// Index file of `morec train`
    index: PathBuf,
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Number of passes over all clips
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u16).range(1..))]
    passes: u16,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let index = open_index(&args.index)?;
    let mut read = Stats::default();
    let takes = takes(args, &index, &mut read)?;
    if takes.iter().all(|take| take.clip.frames == 0) {
        bail!("the clips contain no motion");
    }
    let recognizers = RecognizerCache::new(&index.model);
    let mut passes = Vec::new();
    let mut progress = SlowProgress::new(usize::from(args.passes), "measuring");
    for _ in 0..args.passes {
        let mut stats = read.clone();
        for take in &takes {
            let (clip, rest) = (&take.clip, take.rest());
            let found = stats.recognising(clip.frames, || {
                recognizers.recognize_clip(clip, &take.roles, rest)
            });
            found.with_context(|| clip.name.clone())?;
            stats.stages(&index.model, take)?;
        }
        passes.push(stats);
        progress.step();
    }
    drop(progress);
    passes.sort_by_key(Stats::whole);
    let micros = |stats: &Stats| stats.whole().as_secs_f64() * 1e6 / stats.frames() as f64;
    let (least, most) = (&passes[0], &passes[passes.len() - 1]);
    print!("{}", passes[passes.len() / 2]);
    println!(
        "\nmedian of {} passes; the whole path took {:.2} to {:.2} µs a frame",
        passes.len(),
        micros(least),
        micros(most)
    );
    Ok(ExitCode::SUCCESS)
}

/// Everything in the clips, with the time that reading took.
fn takes(args: &Args, index: &MotionIndex, stats: &mut Stats) -> Result<Vec<Take>> {
    let options = ImportOptions {
        mapping: mapping(args.roles.as_deref())?,
        ..ImportOptions::default()
    };
    let mut all = Vec::new();
    for path in expand(&args.clips)? {
        let opened = stats.reading(|| open(&path, &args.read))?;
        let takes = opened.into_takes(&options);
        let mut takes = takes.with_context(|| path.display().to_string())?;
        say_doubts(&path, &takes);
        let complete = options.mapping.is_none();
        takes
            .iter_mut()
            .for_each(|take| adapt(take, index, &path, complete));
        all.extend(takes);
    }
    Ok(all)
}
