//! Over VMC and the loopback network.

use std::net::{SocketAddr, UdpSocket};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, anyhow};
use morec::kinematics::WorldPose;
use morec::labels::{ClipLength, Labels, Sample};
use morec::live::Model;
use morec::live::{OverflowPolicy, Phase, Session, SessionOptions, wall_now_secs};
use morec_live::vmc::{VmcOptions, VmcSender};

use super::args::{Args, stop_on_ctrl_c};
use morec_live::NamedEvent;
use morec_live::Network;
use morec_live::OscSink;
use morec_live::PAUSE_SECS;
use morec_live::PlayableClip;
use morec_live::Sink;
use morec_live::VmcSource;
use morec_live::summary;

/// Somebody stands still before the performance, until the receiver knows the skeleton.
const BEFORE_SECS: f64 = 1.0;
/// A motion that was reported so far from a label's end is not that label's.
const NEAR_SECS: f64 = 1.0;

/// A motion that was reported: its class, the wall clock when it ended and when the event left.
struct ReceivedEvent {
    class: String,
    ended_wall_secs: f64,
    left_wall_secs: f64,
}

pub fn run(model: &Model, clips: &Arc<Vec<PlayableClip>>, args: &Args) -> Result<ExitCode> {
    let here: SocketAddr = ([127, 0, 0, 1], 0).into();
    let source = VmcSource::bind(here, &VmcOptions::default())?;
    let to = source.address()?;
    let options = SessionOptions {
        overload: OverflowPolicy::Drop,
        ..SessionOptions::default()
    };
    let (session, readers) = Session::start(model, Box::new(source), &options)?;
    let mut reader = readers
        .into_iter()
        .next()
        .context("a session has a reader")?;
    // Events leave as OSC for somebody who does not listen: what counts is that they have left.
    let ears = UdpSocket::bind(here)?;
    let mut sink = OscSink::open(
        &format!("osc://{}", ears.local_addr()?)
            .parse()
            .map_err(anyhow::Error::msg)?,
    )?;
    let stop = stop_on_ctrl_c()?;
    let sender = {
        let (clips, stop) = (clips.clone(), stop.clone());
        let args = (args.bundle, args.accidents());
        let job = move || perform(&clips, to, args, &stop);
        thread::Builder::new()
            .name("sender".to_owned())
            .spawn(job)
            .context("no thread for the sender")?
    };
    let secs: f64 = clips
        .iter()
        .map(|c| c.clip.duration_secs() + PAUSE_SECS + BEFORE_SECS)
        .sum();
    println!(
        "playing {secs:.0} s at {} Hz to vmc://{to}",
        clips[0].clip.rate_hz
    );
    let mut told = Vec::new();
    while !sender.is_finished() {
        let Some(event) = reader.wait(Duration::from_millis(50)) else {
            continue;
        };
        let class = model.class_name(event.class);
        sink.emit(&NamedEvent {
            event: &event,
            class,
            source: "wire",
        })?;
        let left_wall_secs = wall_now_secs();
        if event.phase == Phase::End {
            let ended_wall_secs = event.wall_at_secs(event.span.stop_secs);
            told.push(ReceivedEvent {
                class: class.to_owned(),
                ended_wall_secs,
                left_wall_secs,
            });
        }
    }
    let begins = sender
        .join()
        .map_err(|_| anyhow!("the sender's thread panicked"))??;
    println!("{}", summary("wire", &session.stop()));
    let delays = told.iter().map(|t| t.left_wall_secs - t.ended_wall_secs);
    show(
        "from the last packet of the motion as recognised to the event",
        delays.collect(),
        told.len(),
    );
    if let Some(path) = &args.labels {
        let samples = samples(path, clips, model)?;
        let wanted = samples.len();
        let delays = samples.iter().filter_map(|sample| {
            let at = clips.iter().position(|c| c.clip.name == sample.clip)?;
            let end_secs = begins.get(at)? + sample.span.stop_secs;
            let near = |t: &&ReceivedEvent| {
                t.class == sample.class && (t.ended_wall_secs - end_secs).abs() < NEAR_SECS
            };
            let off = |t: &&ReceivedEvent| (t.ended_wall_secs - end_secs).abs();
            let told = told
                .iter()
                .filter(near)
                .min_by(|a, b| off(a).total_cmp(&off(b)))?;
            Some(told.left_wall_secs - end_secs)
        });
        show(
            "from the last packet of the motion as labelled to the event",
            delays.collect(),
            wanted,
        );
    }
    Ok(ExitCode::SUCCESS)
}

fn show(what: &str, mut delays: Vec<f64>, of: usize) {
    delays.sort_by(f64::total_cmp);
    let at = |share: f64| {
        delays
            .get(((delays.len() as f64 - 1.0) * share).round() as usize)
            .map_or(f64::NAN, |d| 1e3 * d)
    };
    println!(
        "{what}: p50 {:.0} ms, p90 {:.0} ms, p99 {:.0} ms, most {:.0} ms ({} of {of} motions)",
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0),
        delays.len()
    );
}

fn samples(path: &std::path::Path, clips: &[PlayableClip], model: &Model) -> Result<Vec<Sample>> {
    let labels = Labels::from_path(path)?;
    let length = |c: &PlayableClip| ClipLength {
        frames: c.clip.frames,
        rate_hz: c.clip.rate_hz,
    };
    // Labels may count in frames of the file, which these are no longer: seconds are what they have in common.
    let lengths = clips.iter().map(|c| {
        (
            c.clip.name.clone(),
            ClipLength {
                rate_hz: c.file_hz,
                ..length(c)
            },
        )
    });
    let mut samples = labels
        .resolve(
            &lengths
                .map(|(n, l)| {
                    (
                        n,
                        ClipLength {
                            frames: usize::MAX,
                            ..l
                        },
                    )
                })
                .collect(),
        )
        .samples;
    samples.retain(|s| model.classes().iter().any(|c| c.name == s.class));
    Ok(samples)
}

/// Plays every clip once; returns the wall clock at which each clip's time was 0.
fn perform(
    clips: &[PlayableClip],
    to: SocketAddr,
    (bundle, accidents): (morec_live::vmc::Bundling, morec_live::Accidents),
    stop: &AtomicBool,
) -> Result<Vec<f64>> {
    let socket = UdpSocket::bind(SocketAddr::from(([127, 0, 0, 1], 0)))?;
    let (mut sender, mut network) = (VmcSender::new(bundle, false), Network::new(&accidents));
    let (mut pose, mut begins) = (WorldPose::default(), Vec::new());
    for loaded in clips {
        let rate_hz = loaded.clip.rate_hz;
        let before = (BEFORE_SECS * rate_hz) as usize;
        let begun_secs = wall_now_secs() + BEFORE_SECS;
        // Frames before the first motion are held where it begins.
        begins.push(begun_secs - loaded.first as f64 / rate_hz);
        for step in 0..before + loaded.clip.frames - loaded.first {
            if stop.load(Ordering::Relaxed) {
                return Ok(begins);
            }
            let time_secs =
                begun_secs + (step as f64 - before as f64) / rate_hz + network.delay_secs();
            let early_secs = time_secs - wall_now_secs();
            thread::sleep(Duration::from_secs_f64(early_secs.max(0.0)));
            pose.set(&loaded.clip, loaded.first + step.saturating_sub(before));
            for packet in sender.frame(step as f64 / rate_hz, &pose, &loaded.roles) {
                network.carry(packet, &mut |bytes| socket.send_to(bytes, to).map(drop))?;
            }
        }
        thread::sleep(Duration::from_secs_f64(PAUSE_SECS));
    }
    Ok(begins)
}
