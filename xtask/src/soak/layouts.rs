//! The layouts of the method of 2009 against each other.

use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use morec::live::{EventOptions, LatencyHistogram, Model, OverflowPolicy, Session, SessionOptions};

use super::args::{Args, ThreadLayout};
use morec_live::ClipSource;
use morec_live::PlayableClip;

const LAYOUTS: [(&str, ThreadLayout); 3] = [
    ("inline", ThreadLayout::Inline),
    ("stages", ThreadLayout::Stages),
    ("pinned", ThreadLayout::Pinned),
];
/// Turns of each; whatever else the machine does should meet both alike.
const TURNS: usize = 3;
/// The beginning of a turn does not count: buffers go round for the first time.
const WARM_UP: Duration = Duration::from_millis(500);

/// Measures of a layout over all its turns.
#[derive(Default)]
struct Measured {
    frames: u64,
    secs: f64,
    /// Of each turn in real time.
    waits: Vec<LatencyHistogram>,
}

pub fn run(model: &Model, clips: &Arc<Vec<PlayableClip>>, args: &Args) -> Result<ExitCode> {
    let turn = Duration::from_secs_f64(args.secs.unwrap_or(20.0) / TURNS as f64);
    let mut measured: [Measured; LAYOUTS.len()] = Default::default();
    for _ in 0..TURNS {
        for ((_, layout), of) in LAYOUTS.iter().zip(&mut measured) {
            let (frames, secs, _) = play(model, clips, *layout, f64::INFINITY, turn)?;
            (of.frames, of.secs) = (of.frames + frames, of.secs + secs);
        }
        for ((_, layout), of) in LAYOUTS.iter().zip(&mut measured) {
            of.waits.push(play(model, clips, *layout, 1.0, turn)?.2);
        }
    }
    println!(
        "layout   frames/s   wait of a frame in real time, ms: p50   p95   p99  p99.9  (one in {} completes a chunk)",
        chunk_frames(model)
    );
    for ((name, _), of) in LAYOUTS.iter().zip(&measured) {
        println!(
            "{name:6} {:10.0} {:41.3} {:5.2} {:5.2} {:6.2}",
            of.rate(),
            of.wait_ms(0.5),
            of.wait_ms(0.95),
            of.wait_ms(0.99),
            of.wait_ms(0.999)
        );
    }
    let inline = &measured[0];
    for ((name, _), of) in LAYOUTS.iter().zip(&measured).skip(1) {
        println!(
            "{name} to inline: {:.2} times the frames a second, {:.2} times the wait at p99",
            of.rate() / inline.rate(),
            of.wait_ms(0.99) / inline.wait_ms(0.99)
        );
    }
    Ok(ExitCode::SUCCESS)
}

fn chunk_frames(model: &Model) -> usize {
    match model {
        Model::Svrdm(model) => model.params.chunk_frames,
        Model::Templates(_) => 1,
    }
}

impl Measured {
    fn rate(&self) -> f64 {
        self.frames as f64 / self.secs
    }

    /// Mean over the turns.
    fn wait_ms(&self, share: f64) -> f64 {
        let waits = self
            .waits
            .iter()
            .filter_map(|waits| waits.quantile_secs(share));
        1e3 * waits.sum::<f64>() / self.waits.len() as f64
    }
}

/// Plays the clips for `turn`; returns frames and seconds after warming up, and waits.
fn play(
    model: &Model,
    clips: &Arc<Vec<PlayableClip>>,
    layout: ThreadLayout,
    speed: f64,
    turn: Duration,
) -> Result<(u64, f64, LatencyHistogram)> {
    let source = ClipSource::new(clips.clone()).laps(0).speed(speed);
    let overload = if speed.is_finite() {
        OverflowPolicy::Drop
    } else {
        OverflowPolicy::Wait
    };
    let events = EventOptions::default();
    let options = SessionOptions {
        overload,
        events,
        ..layout.options()
    };
    let (session, readers) = Session::start(model, Box::new(source), &options)?;
    let mut reader = readers
        .into_iter()
        .next()
        .context("a session has a reader")?;
    std::thread::sleep(WARM_UP);
    let (before, begun) = (session.status(), Instant::now());
    while begun.elapsed() < turn {
        reader.wait(Duration::from_millis(100));
    }
    let (after, secs) = (session.status(), begun.elapsed().as_secs_f64());
    session.stop();
    Ok((
        after.frames - before.frames,
        secs,
        after.waits.since(&before.waits),
    ))
}
