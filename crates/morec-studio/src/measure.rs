//! Measures of speed: processor time of a frame (example `frame_time`), time to the first frame (example `start_time`),
//! time from a mark on the live stream to the index trained with it (example `teach_time`), and from the drop of a label to
//! the frame that shows it from the disk (example `edit_time`).

mod editing;
mod teaching;

pub use editing::drops;
pub use teaching::{TeachingTimes, teaching};

use std::sync::Arc;
use std::time::Instant;

use morec::clip::{Clip, JointTrack};
use morec::import::{ImportOptions, normalize};
use morec::synth::{Person, Script};
use morec_db::labels::{ClassCount, DbSample, SampleId, SampleState as Judged};
use morec_db::{ClipId, ClipInfo, StoredClip};

use crate::body::ClipMotion;
use crate::screenshot::Headless;
use crate::state::{Command, Panel, PlayCommand, TimelineCommand};
use crate::store::{Snapshot, Store};

/// Contents of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// Clips in the database.
    pub clips: usize,
    /// Labels in the clip that is shown.
    pub labels: usize,
    /// Its length, seconds.
    pub secs: f64,
    /// Frames that are drawn of each scene.
    pub frames: usize,
}

/// Processor time of the frames of a scene, without putting triangles onto a screen, milliseconds.
#[derive(Debug, Clone)]
pub struct FrameTimes {
    /// Name of the scene.
    pub scene: &'static str,
    /// The median.
    pub p50: f64,
    /// The 99th percentile.
    pub p99: f64,
}

/// Draws scenes of a large database and says how long frames took.
///
/// # Errors
/// The made motion cannot be imported: a fault of the program.
pub fn frame_times(load: &Load) -> Result<Vec<FrameTimes>, String> {
    let motion = Arc::new(long_motion(load.secs)?);
    let store = Store::of(snapshot(load, &motion));
    let mut window = Headless::of(store, motion, [1400, 860]);
    let mut scenes = Vec::new();
    let whole = TimelineCommand::Whole;
    let near = TimelineCommand::Zoom {
        factor: load.secs / 20.0,
        about_secs: 0.5 * load.secs,
    };
    for (scene, panel, timeline) in [
        ("library", Panel::Library, None),
        ("timeline, the whole clip", Panel::Label, Some(whole)),
        ("timeline, twenty seconds", Panel::Label, Some(near)),
        ("classes", Panel::Classes, None),
    ] {
        window.command(Command::Show(panel));
        if let Some(timeline) = timeline {
            window.command(Command::Play(PlayCommand::Seek(0.5 * load.secs)));
            window.command(Command::Timeline(timeline));
        }
        window.command(Command::Play(PlayCommand::Toggle));
        window.play(0.5);
        scenes.push(measured(&mut window, scene, load.frames));
        window.command(Command::Play(PlayCommand::Pause));
    }
    Ok(scenes)
}

/// Time from the start to the first frame with a database, wall-clock seconds.
pub fn first_frame_secs(database: &std::path::Path) -> f64 {
    let begun = Instant::now();
    let mut window = Headless::new(&[database.to_owned()], [1400, 860], 1.0, true);
    window.tessellated();
    begun.elapsed().as_secs_f64()
}

fn measured(window: &mut Headless, scene: &'static str, frames: usize) -> FrameTimes {
    let mut took: Vec<f64> = (0..frames.max(1))
        .map(|_| {
            let before = processor_secs();
            window.tessellated();
            1000.0 * (processor_secs() - before)
        })
        .collect();
    took.sort_by(f64::total_cmp);
    let at = |share: f64| took[((took.len() - 1) as f64 * share).round() as usize];
    FrameTimes {
        scene,
        p50: at(0.5),
        p99: at(0.99),
    }
}

/// Seconds for which this thread has had a processor, if the system measures it; otherwise wall time.
fn processor_secs() -> f64 {
    use std::sync::OnceLock;
    static BEGUN: OnceLock<Instant> = OnceLock::new();
    // The count is brought up to date when the thread gives the processor away; else it is as old as the last tick.
    std::thread::yield_now();
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanos = stat.and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    nanos.map_or_else(
        || BEGUN.get_or_init(Instant::now).elapsed().as_secs_f64(),
        |nanos| nanos * 1e-9,
    )
}

/// A take of some gestures, over and over.
fn long_motion(secs: f64) -> Result<ClipMotion, String> {
    let mut script = Script::new(1, Person::draw(1, 0)).rest(1.0);
    for gesture in ["wave", "clap", "bow"] {
        script = script.play(gesture).rest(1.0);
    }
    let take = script.film("hour", 60.0).map_err(|e| e.to_string())?;
    let take = normalize(take.clip, &ImportOptions::default()).map_err(|e| e.to_string())?;
    let (clip, roles) = (take.clip, take.roles);
    let times = (secs / clip.duration_secs()).ceil().max(1.0) as usize;
    let repeat = |track: &JointTrack| JointTrack {
        joint: track.joint,
        positions: track.positions.repeat(times),
    };
    let long = Clip {
        rotations: clip.rotations.repeat(times),
        tracks: clip.tracks.iter().map(repeat).collect(),
        frames: clip.frames * times,
        ..clip
    };
    let stored = StoredClip {
        clip: long,
        roles,
        rest: 0..0,
    };
    Ok(ClipMotion::of(ClipId(1), stored))
}

fn snapshot(load: &Load, motion: &ClipMotion) -> Snapshot {
    const CLASSES: usize = 8;
    let clip = |n: usize| ClipInfo {
        id: ClipId(n as i64 + 1),
        name: format!("clip_{n:05}"),
        frames: motion.clip.frames,
        rate_hz: motion.clip.rate_hz,
        rest_frames: 0,
        repaired_frames: 0,
        joints: motion.clip.skeleton.len(),
        skeleton: 1,
        path: format!("clips/clip_{n:05}.bvh"),
        format: "bvh".to_owned(),
        motion_bytes: 5000,
        source: None,
        licence: None,
        subject: Some(format!("person {}", n % 40)),
        tags: Vec::new(),
        samples: n % 12,
    };
    let class = |n: usize| ClassCount {
        name: format!("gesture {}", n + 1),
        accepted: load.labels / CLASSES,
        proposed: 0,
        rejected: 0,
        secs: 0.0,
    };
    let every = load.secs / load.labels.max(1) as f64;
    let sample = |n: usize| DbSample {
        id: SampleId(n as i64 + 1),
        clip: ClipId(1),
        clip_name: "clip_00000".to_owned(),
        subject: None,
        class: format!("gesture {}", n % CLASSES + 1),
        start_secs: n as f64 * every,
        stop_secs: (n as f64 + 0.8) * every,
        whole_clip: false,
        state: if n % 5 == 4 {
            Judged::Proposed
        } else {
            Judged::Accepted
        },
        score: Some(0.6),
        annotators: Vec::new(),
        set_by: "measure".to_owned(),
        set_secs: 0,
        rate_hz: motion.clip.rate_hz,
    };
    Snapshot::of(
        (0..load.clips).map(clip).collect(),
        (0..CLASSES).map(class).collect(),
        (0..load.labels).map(sample).collect(),
    )
}
