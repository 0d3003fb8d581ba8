//! Many streams at once, each at its own pace.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::Result;
use morec::features::KeyPose;
use morec::kinematics::WorldPose;
use morec::live::Model;
use morec::live::{
    Frame, OverflowPolicy, PerformerId, Pool, PoolStream, Rig, SessionOptions, wall_now_secs,
};
use morec::math::Vec3;

use super::args::{Args, stop_on_ctrl_c};
use super::memory::resident_bytes;
use morec_live::PlayableClip;

/// A frame that waited longer than this was not on time.
const ON_TIME_SECS: f64 = 0.050;
/// Waits are counted from here on: recognisers are made at the beginning.
const WARM_UP_SECS: f64 = 2.0;
/// Every second each stream is looked at once, a part of them at a time.
const LOOKS: usize = 10;
/// Within this many frames every stream has begun.
const BEGIN_FRAMES: usize = 64;

pub fn run(
    model: &Model,
    clips: &Arc<Vec<PlayableClip>>,
    streams: usize,
    args: &Args,
) -> Result<ExitCode> {
    let rate_hz = clips[0].clip.rate_hz;
    // Poses are made beforehand: what is to be measured is recognition.
    let poses: Vec<Vec<Vec3>> = clips.iter().flat_map(poses_of).collect();
    let pool = Pool::new(model, args.threads)?;
    let options = SessionOptions {
        overload: OverflowPolicy::Drop,
        frame_capacity: 24,
        ..SessionOptions::default()
    };
    let rig = Arc::new(Rig::of_roles());
    let mut open: Vec<SoakStream> = (0..streams)
        .map(|number| {
            let mut stream = SoakStream {
                of_pool: pool.open(&options),
                frame: Box::default(),
                number,
            };
            stream.of_pool.feed.set_rig(PerformerId(0), &rig);
            stream
        })
        .collect();
    let stop = stop_on_ctrl_c()?;
    let secs = args.secs.unwrap_or(20.0);
    let mut waits = Vec::with_capacity((secs + 2.0) as usize * (streams + LOOKS));
    let (begun, mut looks) = (Instant::now(), 0);
    let (mut sent, mut behind_secs) = (0u64, 0.0f64);
    for tick in 0.. {
        let due = Duration::from_secs_f64(f64::from(tick) / rate_hz);
        if due.as_secs_f64() > secs || stop.load(Ordering::Relaxed) {
            break;
        }
        std::thread::sleep(due.saturating_sub(begun.elapsed()));
        behind_secs = behind_secs.max(begun.elapsed().saturating_sub(due).as_secs_f64());
        for stream in &mut open {
            sent += u64::from(stream.send(&poses, tick as usize, rate_hz));
        }
        if begun.elapsed().as_secs_f64() * LOOKS as f64 > looks as f64 {
            looks += 1;
            let warm = begun.elapsed().as_secs_f64() > WARM_UP_SECS;
            for stream in open.iter_mut().skip(looks % LOOKS).step_by(LOOKS) {
                while stream.of_pool.readers.iter_mut().any(|r| r.pop().is_some()) {}
                let status = stream.of_pool.status.get();
                waits.extend(status.actors.first().filter(|_| warm).map(|a| a.wait_secs));
            }
        }
    }
    let passed_secs = begun.elapsed().as_secs_f64();
    let dropped: u64 = open
        .iter()
        .map(|s| s.of_pool.status.get().dropped_frames)
        .sum();
    let memory = resident_bytes().map_or(0.0, |b| b as f64 / 1048576.0);
    drop(open);
    drop(pool);
    waits.sort_by(f64::total_cmp);
    let at = |share: f64| {
        waits
            .get(((waits.len() as f64 - 1.0) * share) as usize)
            .copied()
            .unwrap_or(f64::NAN)
    };
    println!(
        "{streams} streams at {rate_hz} Hz on {} threads for {passed_secs:.1} s: {sent} frames, {dropped} dropped, memory {memory:.0} MiB",
        args.threads
    );
    println!(
        "wait from arrival to recognised, {} samples: p50 {:.1} ms, p99 {:.1} ms, p99.9 {:.1} ms, most {:.1} ms; the sender itself was behind by at most {:.1} ms",
        waits.len(),
        1e3 * at(0.5),
        1e3 * at(0.99),
        1e3 * at(0.999),
        1e3 * at(1.0),
        1e3 * behind_secs,
    );
    let sound = dropped == 0 && at(0.999) <= ON_TIME_SECS && behind_secs <= 0.25;
    println!(
        "{}",
        if sound {
            "every stream was on time"
        } else {
            "not every stream was on time"
        }
    );
    Ok(if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Positions of the roles, frame by frame.
fn poses_of(loaded: &PlayableClip) -> Vec<Vec<Vec3>> {
    let (mut world, mut frame) = (WorldPose::default(), Frame::default());
    let mut positions = |at| {
        world.set(&loaded.clip, at);
        frame.set_key_pose(&KeyPose::of(&world, &loaded.roles));
        frame.pose.positions.clone()
    };
    (loaded.first..loaded.clip.frames)
        .map(&mut positions)
        .collect()
}

struct SoakStream {
    of_pool: PoolStream,
    frame: Box<Frame>,
    number: usize,
}

impl SoakStream {
    /// Sends the next pose, if the stream has begun; says whether it has. Every stream is at another place of the
    /// clips, and they begin one after the other: nobody's performers move in step.
    fn send(&mut self, poses: &[Vec<Vec3>], tick: usize, rate_hz: f64) -> bool {
        if tick < self.number % BEGIN_FRAMES {
            return false;
        }
        let at = (tick + 97 * self.number) % poses.len();
        self.frame.time_secs = tick as f64 / rate_hz;
        self.frame.wall_secs = wall_now_secs();
        self.frame.pose.positions.clone_from(&poses[at]);
        // What is dropped is counted.
        self.of_pool.feed.send(&mut self.frame);
        true
    }
}
