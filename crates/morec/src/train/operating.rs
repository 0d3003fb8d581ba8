//! The operating point: how near is near enough, from a wanted rate of false alarms.

use crate::decode::FAR;
use crate::templates::Match;

use super::mining::Distances;
use super::set::{Source, TrainSet, overlap_share};

/// How often motion that is none of the classes comes how near: the nearest events in background motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AlarmCurve {
    /// Minutes of background motion.
    pub minutes: f64,
    /// Distances of the nearest events, ascending, with the stream of each.
    pub events: Vec<(f32, usize)>,
}

impl AlarmCurve {
    /// Events of all background and everyday streams of `set`: local minima of the nearest template's distance, none
    /// overlapping a nearer one by more than half. Unlabelled parts of labelled clips do not count: what comes near
    /// there may be a sample that nobody labelled. O(ticks · templates + events²).
    pub fn of(set: &TrainSet, distances: &[Distances], tick_hz: f64) -> Self {
        let mut curve = Self::default();
        for (index, stream) in set.streams.iter().enumerate() {
            if stream.source == Source::Labelled {
                continue;
            }
            curve.minutes += stream.rows.len() as f64 / tick_hz / 60.0;
            curve.events.extend(events(&distances[index]).map(|d| (d, index)));
        }
        curve.events.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve
    }

    /// The distance below which background motion comes `per_minute` times a minute, and the stream that sets it;
    /// `None` if there is no background, or not so many events.
    pub fn distance_at(&self, per_minute: f64) -> Option<(f32, usize)> {
        self.events.get((per_minute * self.minutes) as usize).copied()
    }
}

/// Distances of the separate approaches in one stream.
fn events(distances: &Distances) -> impl Iterator<Item = f32> {
    let nearest: Vec<Match> = (0..distances.len())
        .map(|t| distances.nearest(t, |_| true))
        .collect();
    let mut dips: Vec<(f32, std::ops::Range<usize>)> = Vec::new();
    for t in 0..nearest.len() {
        let Match { distance, age } = nearest[t];
        let beaten = (t > 0 && nearest[t - 1].distance < distance)
            || nearest.get(t + 1).is_some_and(|n| n.distance <= distance);
        if distance < FAR && !beaten {
            dips.push((distance, t - age.min(t)..t + 1));
        }
    }
    dips.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(f32, std::ops::Range<usize>)> = Vec::new();
    for dip in dips {
        if kept.iter().all(|k| overlap_share(&k.1, &dip.1) <= 0.5) {
            kept.push(dip);
        }
    }
    kept.into_iter().map(|(distance, _)| distance)
}
