//! `morec record`: records takes from a tracker as clips.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec::diagnosis::{Diagnoser, Severity};
use morec::live::Recording;

use crate::interrupt::stop_on_ctrl_c;
use crate::live::keep::TakeStore;
use crate::live::open::TrackerArgs;
use crate::live::takes::{Ended, TakeArgs, TakeRecorder, secs};
use morec_live::Address;

/// Record takes from a tracker as clips.
///
/// Each take begins after a countdown and a bell. It ends, with a bell, after --secs of stream, on Enter, when the performer
/// leaves or the source ends, or on Ctrl-C. The part recorded until then is kept.
///
/// Sources (--listen) are those of `morec live`.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 every recorded take is kept; 1 nothing was recorded, or opening or writing failed; 2 wrong \
        command line.\n\n\
    Examples:\n  \
    morec record --listen vmc://127.0.0.1:39539 -o take.bvh\n  \
    morec record --listen vmc://127.0.0.1:39539 -o wave.bvh --takes 3 --secs 4\n  \
    morec record --listen vmc://127.0.0.1:39539 -o moves.mdb --tag background\n  \
    morec record --listen json:- -o take.jsonl --count-down 0 < poses.jsonl"
)]
pub struct Args {
    /// Source of poses, as in `morec live`
    #[arg(long, value_name = "SOURCE")]
    listen: Address,
    /// Output: .bvh, .jsonl (lines of JSON) or .mdb (a database)
    ///
    /// Several takes are numbered. With a database, each take is also written to a file beside it.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Tag of the takes in a database; can be repeated
    ///
    /// `background`: `morec train --db` uses them as background.
    #[arg(long = "tag", value_name = "WORD")]
    tags: Vec<String>,
    /// Number of takes
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=9999))]
    takes: u32,
    /// Length of a take, seconds of stream
    #[arg(long, value_name = "SECS", value_parser = secs)]
    secs: Option<f64>,
    /// Overwrite existing files
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    take: TakeArgs,
    #[command(flatten)]
    tracker: TrackerArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let store = TakeStore::of(&args.output)?;
    if !args.tags.is_empty() && !matches!(store, TakeStore::Database(_)) {
        bail!(
            "--tag: tags need a database, but {} is not a database",
            args.output.display()
        );
    }
    let files: Vec<PathBuf> = (1..=args.takes)
        .map(|n| store.file(n, args.takes))
        .collect();
    if let Some(there) = files.iter().find(|file| file.exists() && !args.overwrite) {
        bail!(
            "{}: the file exists already (--overwrite replaces it)",
            there.display()
        );
    }
    let opened = args.tracker.open(&args.listen, None)?;
    let mut stage = TakeRecorder::new(opened, &args.take, stop_on_ctrl_c()?);
    stage.check_end(args.secs)?;
    let mut kept = 0;
    for number in 1..=args.takes {
        let what = format!("take {number} of {}", args.takes);
        let (recording, ended) = stage.take(&what, args.secs);
        match recording {
            Some(recording) => {
                // By now others may have been kept.
                let file = store.file(number, args.takes);
                store.keep(&recording, &file, &args.tags)?;
                kept += 1;
                eprintln!(
                    "morec: {}: {:.1} s, {} frames",
                    file.display(),
                    recording.secs(),
                    recording.frames().len()
                );
                warn(&recording);
            }
            None => eprintln!("morec: {what}: nothing was recorded"),
        }
        if matches!(ended, Ended::Source | Ended::Stopped) {
            break;
        }
    }
    Ok(if kept > 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Says what is wrong with a take.
pub fn warn(recording: &Recording) {
    let mut diagnoser = Diagnoser::whole();
    for frame in recording.frames() {
        diagnoser.push(
            frame.time_secs,
            frame.wall_secs,
            &frame.key_pose(recording.rig()),
        );
    }
    let findings = diagnoser.diagnosis().findings();
    findings
        .iter()
        .filter(|finding| finding.severity() >= Severity::Warning)
        .for_each(|finding| eprintln!("morec:   {}: {finding}", finding.severity()));
}
