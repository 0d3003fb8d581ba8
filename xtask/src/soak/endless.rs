//! One stream as fast as it goes.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use morec::live::Model;
use morec::live::{Event, EventOptions, OverflowPolicy, Phase, Session, SessionOptions};

use super::args::{Args, ThreadLayout, stop_on_ctrl_c};
use super::memory::resident_bytes;
use morec_live::PlayableClip;
use morec_live::{ClipSource, PAUSE_SECS};

/// How often it is said how things stand.
const EVERY: Duration = Duration::from_secs(10);
/// Memory may grow by this share after the first laps: the system's own bookkeeping.
const GROWTH: f64 = 0.05;

/// Motions that ended in a lap: class, start and stop from the lap's beginning and score, rounded to steps of a
/// thousandth.
type Lap = Vec<(u16, i64, i64, i64)>;

pub fn run(
    model: &Model,
    clips: &Arc<Vec<PlayableClip>>,
    layout: ThreadLayout,
    args: &Args,
) -> Result<ExitCode> {
    let lap_secs: f64 = clips
        .iter()
        .map(|c| c.clip.duration_secs() + PAUSE_SECS)
        .sum();
    let laps = ((args.hours * 3600.0 / lap_secs).ceil() as u64).max(2);
    let source = ClipSource::new(clips.clone()).laps(laps);
    let options = SessionOptions {
        overload: OverflowPolicy::Wait,
        events: EventOptions {
            tentative: true,
            ..EventOptions::default()
        },
        ..layout.options()
    };
    println!(
        "{laps} laps of {lap_secs:.1} s: {:.1} hours of stream",
        laps as f64 * lap_secs / 3600.0
    );
    let stop = stop_on_ctrl_c()?;
    let begun = Instant::now();
    let (session, readers) = Session::start(model, Box::new(source), &options)?;
    let mut reader = readers
        .into_iter()
        .next()
        .context("a session has a reader")?;
    let mut laps = Laps {
        lap_secs,
        first: None,
        now: Lap::new(),
        number: 0,
        different: 0,
    };
    let (mut said, mut settled, mut most) = (Instant::now(), None, 0);
    while !reader.is_ended() && !stop.load(Ordering::Relaxed) {
        if args
            .secs
            .is_some_and(|secs| begun.elapsed().as_secs_f64() >= secs)
        {
            break;
        }
        if let Some(event) = reader.wait(Duration::from_millis(200)) {
            laps.take(&event);
        }
        if laps.number >= 2 && settled.is_none() {
            settled = resident_bytes();
        }
        most = most.max(
            resident_bytes()
                .filter(|_| said.elapsed() >= EVERY)
                .unwrap_or(0),
        );
        if said.elapsed() >= EVERY {
            said = Instant::now();
            let frames = session.status().frames;
            println!("{}", laps.tell(frames, begun.elapsed(), settled));
        }
    }
    let ended = reader.is_ended();
    let status = session.stop();
    if ended {
        laps.close();
    }
    println!("{}", laps.tell(status.frames, begun.elapsed(), settled));
    most = most.max(resident_bytes().unwrap_or(0));
    let grown = settled.is_some_and(|settled| most as f64 > settled as f64 * (1.0 + GROWTH));
    let lost = status.dropped_frames + status.dropped_events;
    if grown {
        println!("memory grew from {} to {}", mib(settled), mib(Some(most)));
    }
    let sound = laps.different == 0 && !grown && lost == 0;
    println!(
        "{}",
        if sound {
            "every lap found the same; memory stayed flat"
        } else {
            "something gave way"
        }
    );
    Ok(if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Detections of the present lap, compared with those of the first.
struct Laps {
    lap_secs: f64,
    first: Option<Lap>,
    now: Lap,
    number: u64,
    different: u64,
}

impl Laps {
    fn take(&mut self, event: &Event) {
        if event.phase != Phase::End {
            return;
        }
        let lap = (event.span.start_secs / self.lap_secs).floor().max(0.0) as u64;
        while lap > self.number {
            self.close();
        }
        let from = lap as f64 * self.lap_secs;
        let step = |value: f64| (value * 1000.0).round() as i64;
        let found = (
            event.class.0,
            step(event.span.start_secs - from),
            step(event.span.stop_secs - from),
            step(event.score),
        );
        self.now.push(found);
    }

    /// A lap is over.
    fn close(&mut self) {
        let found = std::mem::take(&mut self.now);
        self.number += 1;
        match &self.first {
            None => self.first = Some(found),
            Some(first) => {
                let near = |a: i64, b: i64| (a - b).abs() <= 1;
                let same = first.len() == found.len()
                    && first.iter().zip(&found).all(|(a, b)| {
                        a.0 == b.0 && near(a.1, b.1) && near(a.2, b.2) && near(a.3, b.3)
                    });
                self.different += u64::from(!same);
            }
        }
    }

    fn tell(&self, frames: u64, passed: Duration, settled: Option<u64>) -> String {
        format!(
            "{:7.0} s  lap {}  {:.1} h of stream  {:.0} frames/s  {} motions a lap, {} laps differed  memory {} (after the first laps {})",
            passed.as_secs_f64(),
            self.number,
            self.number as f64 * self.lap_secs / 3600.0,
            frames as f64 / passed.as_secs_f64().max(1e-9),
            self.first.as_ref().map_or(0, Vec::len),
            self.different,
            mib(resident_bytes()),
            mib(settled),
        )
    }
}

fn mib(bytes: Option<u64>) -> String {
    bytes.map_or_else(
        || "unknown".to_owned(),
        |bytes| format!("{:.1} MiB", bytes as f64 / 1048576.0),
    )
}
