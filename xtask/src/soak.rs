//! `cargo xtask soak`: streams without end, to see whether anything gives way.

mod args;
mod endless;
mod inline;
mod layouts;
mod many;
mod memory;
mod wire;

use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use anyhow::Result;
use morec::MotionIndex;
use morec::files::FileReader;
use morec_live::load;

pub use args::Args;
use args::{Layouts, ThreadLayout};

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
