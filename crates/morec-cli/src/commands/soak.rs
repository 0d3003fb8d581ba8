//! `morec soak`: streams without end, to see whether anything gives way.

mod endless;
mod inline;
mod layouts;
mod many;
mod wire;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use anyhow::Result;
use morec::import::ImportOptions;
use morec::live::vmc::Bundling;

use super::recognize::open_index;
use super::send::bundling;
use crate::files::{ReadArgs, mapping, rate};
use crate::live::layout::LayoutArg;
use crate::live::loaded::load;
use crate::live::network::Conditions;

/// Recognise clips round and round and see whether memory stays flat, every lap finds the same, and everything is on time.
///
/// By default one stream, as fast as it goes, and first how long one frame takes. With --streams many at once, each at its own pace in real time, on
/// --threads. With --wire over VMC and the loopback network in real time: how long after a motion's last packet its
/// event leaves.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 nothing gave way; 1 a lap differed, memory grew, or something cannot be read; 2 wrong \
    command line.\n\n\
    Examples: morec soak signs.index clips/ --hours 24\n          \
    morec soak signs.index clips/ --streams 500 --threads 2 --for 30\n          \
    morec soak signs.index clips/ --wire --labels labels.tsv\n          \
    morec soak thesis.index clips/ --layout both --for 20"
)]
pub struct Args {
    /// The index, as `morec train` writes it
    index: PathBuf,
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// End after so many hours of stream
    #[arg(long, value_name = "HOURS", default_value = "24")]
    hours: f64,
    /// End after so many seconds of real time
    #[arg(long = "for", value_name = "SECS")]
    secs: Option<f64>,
    /// So many streams at once, in real time
    #[arg(long, value_name = "N", conflicts_with = "wire")]
    streams: Option<usize>,
    /// Threads for --streams
    #[arg(long, value_name = "N", default_value = "2")]
    threads: usize,
    /// Over VMC and the loopback network, in real time, every clip once
    #[arg(long, conflicts_with = "secs")]
    wire: bool,
    /// Labels of the clips: with --wire, delays are counted from where these say that a motion ends
    #[arg(long, value_name = "TSV", requires = "wire")]
    labels: Option<PathBuf>,
    /// How recognition is laid out on threads, for one stream; both takes turns with all of them and compares
    #[arg(long, value_enum, default_value = "inline", conflicts_with_all = ["streams", "wire"])]
    layout: Layouts,
    /// Frames a second [default: the clips' own; 120 with --streams, 60 with --wire]
    #[arg(long, value_name = "HZ", value_parser = rate)]
    rate: Option<f64>,
    /// How messages are put into datagrams, for --wire: whole, single or a number of bytes
    #[arg(long, value_name = "whole|single|BYTES", default_value = "1500", value_parser = bundling)]
    bundle: Bundling,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint name`
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    conditions: Conditions,
    #[command(flatten)]
    read: ReadArgs,
}

/// `--layout` of this command.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Layouts {
    /// All of recognition on one thread
    Inline,
    /// A thread for each stage (indexes of svrdm only)
    Stages,
    /// The same, every thread tied to a core
    Pinned,
    /// One after the other, in turns of --for seconds: throughput, and how long frames wait in real time
    Both,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let index = open_index(&args.index)?;
    let options = ImportOptions {
        mapping: mapping(args.roles.as_deref())?,
        ..ImportOptions::default()
    };
    let usual_hz = if args.wire {
        Some(60.0)
    } else {
        args.streams.map(|_| 120.0)
    };
    let clips = load(
        &args.clips,
        &args.read,
        &options,
        Some(&index),
        args.rate.or(usual_hz),
    )?;
    let clips = Arc::new(clips);
    match args.streams {
        Some(streams) => many::run(&index.model, &clips, streams, args),
        None if args.wire => wire::run(&index.model, &clips, args),
        None => match args.layout {
            Layouts::Inline => {
                let most_secs = args.secs.map_or(10.0, |secs| secs / 4.0).min(10.0);
                inline::tell(
                    &index.model,
                    &clips,
                    Duration::from_secs_f64(most_secs.max(0.0)),
                );
                endless::run(&index.model, &clips, LayoutArg::Inline, args)
            }
            Layouts::Stages => endless::run(&index.model, &clips, LayoutArg::Stages, args),
            Layouts::Pinned => endless::run(&index.model, &clips, LayoutArg::Pinned, args),
            Layouts::Both => layouts::run(&index.model, &clips, args),
        },
    }
}
