//! `cargo xtask soak`: streams without end, to see whether anything gives way.

mod endless;
mod inline;
mod layouts;
mod many;
mod memory;
mod wire;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, Result};
use morec::MotionIndex;
use morec::files::FileReader;
use morec::live::vmc::Bundling;
use morec::live::{SessionOptions, Threading};
use morec_live::{Accidents, load, pin_thread};

/// Recognise clips round and round and see whether memory stays flat, every lap finds the same, and everything is on time.
///
/// By default one stream, as fast as it goes, and first how long one frame takes. With --streams many at once, each at its own pace in real time, on
/// --threads. With --wire over VMC and the loopback network in real time: how long after a motion's last packet its
/// event leaves.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 nothing gave way; 1 a lap differed, memory grew, or something cannot be read; 2 wrong \
    command line.\n\n\
    Examples: cargo xtask soak signs.index clips/ --hours 24\n          \
    cargo xtask soak signs.index clips/ --streams 500 --threads 2 --for 30\n          \
    cargo xtask soak signs.index clips/ --wire --labels labels.tsv\n          \
    cargo xtask soak thesis.index clips/ --layout both --for 20"
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
    /// Lose this share of the packets of --wire, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0")]
    loss: f64,
    /// Delay packets of --wire by up to this, milliseconds, each by another time
    #[arg(long, value_name = "MS", default_value = "0")]
    jitter: f64,
}

impl Args {
    fn accidents(&self) -> Accidents {
        Accidents {
            loss: self.loss,
            jitter_secs: self.jitter / 1000.0,
            ..Accidents::default()
        }
    }
}

/// A rate that can be: more than nothing, and finite.
fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 && rate <= 100_000.0 => Ok(rate),
        _ => Err("expected a rate in Hz, above 0 and at most 100000".to_owned()),
    }
}

/// A way of bundling, as it is typed.
fn bundling(text: &str) -> Result<Bundling, String> {
    match (text, text.parse::<usize>()) {
        ("whole", _) => Ok(Bundling::Whole),
        ("single", _) => Ok(Bundling::Single),
        (_, Ok(bytes)) if (200..=60_000).contains(&bytes) => Ok(Bundling::Bytes(bytes)),
        _ => Err("expected whole, single or a number of bytes from 200 to 60000".to_owned()),
    }
}

/// How one session is laid out.
#[derive(Clone, Copy)]
enum ThreadLayout {
    Inline,
    Stages,
    Pinned,
}

impl ThreadLayout {
    /// The usual options with this layout.
    fn options(self) -> SessionOptions {
        let (layout, on_thread): (_, Option<fn(&'static str)>) = match self {
            ThreadLayout::Inline => (Threading::Inline, None),
            ThreadLayout::Stages => (Threading::Stages, None),
            ThreadLayout::Pinned => (Threading::Stages, Some(pin_thread)),
        };
        SessionOptions {
            layout,
            on_thread,
            ..SessionOptions::default()
        }
    }
}

/// Set when somebody presses Ctrl-C.
fn stop_on_ctrl_c() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = stop.clone();
    ctrlc::set_handler(move || set.store(true, Ordering::Relaxed)).context("cannot take Ctrl-C")?;
    Ok(stop)
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
    let index = MotionIndex::load(&args.index)?;
    let usual_hz = if args.wire {
        Some(60.0)
    } else {
        args.streams.map(|_| 120.0)
    };
    let rate_hz = args.rate.or(usual_hz);
    let clips = load(&args.clips, &FileReader::default(), Some(&index), rate_hz)?;
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
                endless::run(&index.model, &clips, ThreadLayout::Inline, args)
            }
            Layouts::Stages => endless::run(&index.model, &clips, ThreadLayout::Stages, args),
            Layouts::Pinned => endless::run(&index.model, &clips, ThreadLayout::Pinned, args),
            Layouts::Both => layouts::run(&index.model, &clips, args),
        },
    }
}
