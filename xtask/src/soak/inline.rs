//! One stream on this thread alone: how long a frame takes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use morec::live::{EventOptions, Frame, Model, Performer, PerformerId, Source, SourceEvent};

use morec_live::ClipSource;
use morec_live::PlayableClip;

/// Laps of which each frame's median is taken; more say the same.
const MOST_LAPS: usize = 25;

/// Plays `clips` round and round for about `most` and says how long recognition took for a frame: from the posed
/// skeleton to events.
///
/// A frame's first lap, and the first frame of a skeleton, at which recognisers are made, do not count. What else the
/// machine does interrupts now this frame, now that; the median over the laps of each frame is what the frame itself
/// costs.
pub fn tell(model: &Model, clips: &Arc<Vec<PlayableClip>>, most: Duration) {
    let mut laps = Vec::new();
    let mut player = InlinePlayer::new(model);
    let begun = Instant::now();
    player.lap(clips);
    // Three at least: a median of fewer is none.
    while laps.len() < MOST_LAPS && (laps.len() < 3 || begun.elapsed() < most) {
        laps.push(player.lap(clips));
    }
    let frames = laps[0].len();
    if frames == 0 {
        return;
    }
    println!(
        "processing of one frame, {frames} frames {} times over: {}",
        laps.len(),
        shares(laps.iter().flatten().copied().collect())
    );
    let median = |frame: usize| {
        let mut of: Vec<f64> = laps.iter().map(|lap| lap[frame]).collect();
        of.sort_by(f64::total_cmp);
        of[of.len() / 2]
    };
    println!(
        "the same, of each frame the median: {}",
        shares((0..frames).map(median).collect())
    );
}

/// Percentiles of `secs` in words.
fn shares(mut secs: Vec<f64>) -> String {
    secs.sort_by(f64::total_cmp);
    let at = |share: f64| 1e6 * secs[((secs.len() as f64 - 1.0) * share).round() as usize];
    let mean = 1e6 * secs.iter().sum::<f64>() / secs.len() as f64;
    format!(
        "mean {mean:.1}, p50 {:.1}, p99 {:.1}, p99.9 {:.1}, most {:.1} µs",
        at(0.5),
        at(0.99),
        at(0.999),
        at(1.0)
    )
}

struct InlinePlayer {
    performer: Performer,
}

impl InlinePlayer {
    fn new(model: &Model) -> Self {
        let options = EventOptions {
            tentative: true,
            ..EventOptions::default()
        };
        Self {
            performer: Performer::new(model, PerformerId(0), &options),
        }
    }

    /// Seconds of each frame of one lap.
    fn lap(&mut self, clips: &Arc<Vec<PlayableClip>>) -> Vec<f64> {
        let mut source = ClipSource::new(clips.clone());
        let (mut frame, mut secs, mut fresh) = (Frame::default(), Vec::new(), true);
        loop {
            match source.next(&mut frame) {
                SourceEvent::Frame => {
                    let begun = Instant::now();
                    self.performer.push(&frame);
                    if !std::mem::take(&mut fresh) {
                        secs.push(begun.elapsed().as_secs_f64());
                    }
                }
                SourceEvent::Rig(_, rig) => {
                    self.performer.set_rig(&rig);
                    fresh = true;
                }
                SourceEvent::Gone(_) => _ = self.performer.finish(),
                SourceEvent::Quiet => {}
                SourceEvent::Ended => break,
            }
        }
        self.performer.finish();
        secs
    }
}
