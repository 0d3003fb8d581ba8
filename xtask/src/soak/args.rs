//! The command line of `cargo xtask soak`, and what its parts share.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use morec::live::{SessionOptions, Threading};
use morec_live::vmc::Bundling;
use morec_live::{Accidents, pin_thread};

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
    pub(super) index: PathBuf,
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    pub(super) clips: Vec<PathBuf>,
    /// End after N hours of stream
    #[arg(long, value_name = "HOURS", default_value = "24")]
    pub(super) hours: f64,
    /// End after N seconds of real time
    #[arg(long = "for", value_name = "SECS")]
    pub(super) secs: Option<f64>,
    /// N streams at once, in real time
    #[arg(long, value_name = "N", conflicts_with = "wire")]
    pub(super) streams: Option<usize>,
    /// Threads for --streams
    #[arg(long, value_name = "N", default_value = "2")]
    pub(super) threads: usize,
    /// Over VMC and the loopback network, in real time, every clip once
    #[arg(long, conflicts_with = "secs")]
    pub(super) wire: bool,
    /// Labels of the clips: with --wire, delays are counted from where these say that a motion ends
    #[arg(long, value_name = "TSV", requires = "wire")]
    pub(super) labels: Option<PathBuf>,
    /// How recognition is laid out on threads, for one stream; both takes turns with all of them and compares
    #[arg(long, value_enum, default_value = "inline", conflicts_with_all = ["streams", "wire"])]
    pub(super) layout: Layouts,
    /// Frames a second [default: the clips' own; 120 with --streams, 60 with --wire]
    #[arg(long, value_name = "HZ", value_parser = rate)]
    pub(super) rate: Option<f64>,
    /// How messages are put into datagrams, for --wire: whole, single or a number of bytes
    #[arg(long, value_name = "whole|single|BYTES", default_value = "1500", value_parser = bundling)]
    pub(super) bundle: Bundling,
    /// Lose this share of the packets of --wire, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0")]
    pub(super) loss: f64,
    /// Delay packets of --wire by up to this, milliseconds, each by another time
    #[arg(long, value_name = "MS", default_value = "0")]
    pub(super) jitter: f64,
}

impl Args {
    pub(super) fn accidents(&self) -> Accidents {
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
pub(super) enum ThreadLayout {
    Inline,
    Stages,
    Pinned,
}

impl ThreadLayout {
    /// The usual options with this layout.
    pub(super) fn options(self) -> SessionOptions {
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
pub(super) fn stop_on_ctrl_c() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = stop.clone();
    ctrlc::set_handler(move || set.store(true, Ordering::Relaxed)).context("cannot take Ctrl-C")?;
    Ok(stop)
}

/// `--layout` of this command.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layouts {
    /// All of recognition on one thread
    Inline,
    /// A thread for each stage (indexes of svrdm only)
    Stages,
    /// The same, every thread tied to a core
    Pinned,
    /// One after the other, in turns of --for seconds: throughput, and how long frames wait in real time
    Both,
}
