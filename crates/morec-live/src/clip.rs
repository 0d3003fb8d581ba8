//! A source that plays a clip at its own pace, as if somebody performed it.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use morec::files::FileReader;
use morec::index::MotionIndex;
use morec::live::{Frame, PerformerId, Rig, Source, SourceCounts, SourceEvent, wall_now_secs};
use morec::rng::Rng;

use crate::{Address, LiveError, PlayableClip, load};

/// Between one clip and the next, or one lap and the next: long enough to end a stretch of stream.
pub const PAUSE_SECS: f64 = 1.0;
/// A source must not sleep longer than this.
const NAP: Duration = Duration::from_millis(20);

/// Plays clips, one after the other.
pub struct ClipSource {
    clips: Arc<Vec<PlayableClip>>,
    /// This many times as fast as it was performed; infinite is as fast as it goes.
    speed: f64,
    laps: u64,
    loss: f64,
    jitter_secs: f64,
    rng: Rng,
    begun: Instant,
    /// Time of the stream at which the present clip began.
    origin_secs: f64,
    clip: usize,
    frame: usize,
    announced: bool,
    lap: u64,
    counts: SourceCounts,
}

impl ClipSource {
    /// Plays `clips` once, as fast as it goes.
    pub fn new(clips: Arc<Vec<PlayableClip>>) -> Self {
        let frame = clips.first().map_or(0, |loaded| loaded.first);
        Self {
            clips,
            speed: f64::INFINITY,
            laps: 1,
            loss: 0.0,
            jitter_secs: 0.0,
            rng: Rng::new(1),
            begun: Instant::now(),
            origin_secs: 0.0,
            clip: 0,
            frame,
            announced: false,
            lap: 0,
            counts: SourceCounts::default(),
        }
    }

    /// This many laps; 0 is without end.
    #[must_use]
    pub fn laps(mut self, laps: u64) -> Self {
        self.laps = laps;
        self
    }

    /// This many times as fast as it was performed.
    #[must_use]
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// Opens `clip://FILE` with the options speed (0: as fast as it goes), loop (this many laps), loss (a share),
    /// jitter (milliseconds), rate (frames a second, of a file that does not say it).
    ///
    /// # Errors
    /// An option that it does not have, a clip that cannot be read.
    pub fn open(
        address: &Address,
        index: Option<&MotionIndex>,
        reader: &FileReader,
    ) -> Result<Self, LiveError> {
        address.allow(&["speed", "loop", "loss", "jitter", "rate"])?;
        let path = PathBuf::from(&address.place);
        let rate_hz = address.number("rate", 0.0)?.filter(|rate| *rate > 0.0);
        let reader = FileReader {
            rate_hz: rate_hz.or(reader.rate_hz),
            ..reader.clone()
        };
        let clips = load(&[path], &reader, index, None)?;
        let speed = address.number("speed", 1.0)?.unwrap_or(1.0);
        let mut source = Self::new(Arc::new(clips));
        source.speed = if speed > 0.0 { speed } else { f64::INFINITY };
        source.laps = address.number("loop", 0.0)?.map_or(1, |laps| laps as u64);
        source.loss = address.number("loss", 0.0)?.unwrap_or(0.0).min(1.0);
        source.jitter_secs = address.number("jitter", 0.0)?.unwrap_or(0.0) / 1000.0;
        Ok(source)
    }

    /// True if time passes for it as for those who watch.
    pub fn is_paced(&self) -> bool {
        self.speed.is_finite()
    }

    /// On to the next clip, or lap; says whether there is one.
    fn advance(&mut self) -> bool {
        let clip = &self.clips[self.clip].clip;
        self.origin_secs += clip.duration_secs() + PAUSE_SECS;
        self.announced = false;
        self.clip += 1;
        if self.clip == self.clips.len() {
            self.clip = 0;
            self.lap += 1;
        }
        self.frame = self.clips[self.clip].first;
        self.laps == 0 || self.lap < self.laps
    }
}

impl Source for ClipSource {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        if self.laps != 0 && self.lap >= self.laps {
            return SourceEvent::Ended;
        }
        let PlayableClip { clip, roles, .. } = &self.clips[self.clip];
        if !self.announced {
            self.announced = true;
            let rig = Rig {
                skeleton: clip.skeleton.clone(),
                roles: roles.clone(),
            };
            return SourceEvent::Rig(PerformerId(0), Arc::new(rig));
        }
        if self.frame >= clip.frames {
            return if self.advance() {
                SourceEvent::Gone(PerformerId(0))
            } else {
                SourceEvent::Ended
            };
        }
        let time_secs = self.origin_secs + self.frame as f64 / clip.rate_hz;
        if self.is_paced() {
            let due = Duration::from_secs_f64(time_secs / self.speed);
            let early = due.saturating_sub(self.begun.elapsed());
            if early > NAP {
                std::thread::sleep(NAP);
                return SourceEvent::Quiet;
            }
            std::thread::sleep(early);
        }
        self.frame += 1;
        self.counts.packets += 1;
        if self.rng.chance(self.loss) {
            self.counts.incomplete += 1;
            return SourceEvent::Quiet;
        }
        frame.pose.set(clip, self.frame - 1);
        frame.actor = PerformerId(0);
        frame.wall_secs = wall_now_secs();
        let jitter_secs = if self.jitter_secs > 0.0 {
            self.rng.range(0.0, self.jitter_secs)
        } else {
            0.0
        };
        frame.time_secs = time_secs + jitter_secs;
        SourceEvent::Frame
    }

    fn counts(&self) -> SourceCounts {
        self.counts
    }
}
