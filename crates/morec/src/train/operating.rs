//! The operating point: the threshold for a rate of false alarms.

use std::ops::Range;

use crate::decode::FAR;
use crate::templates::Match;

use super::params::TrainParams;
use super::set::{StreamKind, TrainSet, overlap_share};

/// Exponent by which the bound of the threshold follows the rate of false alarms: 2.4 at a third of the usual rate and
/// 3.3 at three times, for 2.8.
pub const CAP_EXPONENT: f64 = 0.15;

/// Rate of background motion by distance: the nearest events in background motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AlarmCurve {
    /// Minutes of background motion.
    pub minutes: f64,
    /// Distances of the nearest events, ascending, with the stream of each.
    pub events: Vec<(f32, usize)>,
}

impl AlarmCurve {
    /// Events of all background and everyday streams: local minima of the nearest template's distance, none
    /// overlapping a nearer one by more than half, where no negative of another person or clip is nearer. Unlabelled
    /// parts of labelled clips do not count: what comes near there may be an unlabelled sample.
    ///
    /// `nearest` is each stream's nearest template at every tick, `negatives` its nearest negative of another group.
    /// O(ticks + events²).
    pub fn of(
        set: &TrainSet,
        nearest: &[&[Match]],
        negatives: Option<&[&[Match]]>,
        params: &TrainParams,
    ) -> Self {
        let mut curve = Self::default();
        let minute_ticks = 60.0 * params.features.tick_hz();
        for (stream, of) in set.streams.iter().enumerate() {
            if of.source == StreamKind::Labelled {
                continue;
            }
            curve.minutes += of.rows.len() as f64 / minute_ticks;
            let gate = |tick: usize| {
                negatives.map_or(FAR, |near| params.decode.gate * near[stream][tick].distance)
            };
            let found = events(nearest[stream], gate);
            curve.events.extend(found.map(|d| (d, stream)));
        }
        curve.events.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve
    }

    /// The distance below which background motion comes `per_minute` times a minute, and the stream that sets it;
    /// `None` if there is no background, or not that many events.
    pub fn distance_at(&self, per_minute: f64) -> Option<(f32, usize)> {
        let allowed = (per_minute * self.minutes) as usize;
        self.events.get(allowed).copied()
    }
}

/// Distances of the separate approaches in one stream that are nearer than `gate` says at their tick.
fn events(nearest: &[Match], gate: impl Fn(usize) -> f32) -> impl Iterator<Item = f32> {
    let counted = |(tick, found): (usize, &Match)| {
        let admitted = found.distance < FAR && found.distance < gate(tick);
        let distance = if admitted { found.distance } else { FAR };
        Match { distance, ..*found }
    };
    let nearest: Vec<Match> = nearest.iter().enumerate().map(counted).collect();
    let mut dips: Vec<(f32, Range<usize>)> = Vec::new();
    for (t, Match { distance, age }) in nearest.iter().copied().enumerate() {
        let beaten = (t > 0 && nearest[t - 1].distance < distance)
            || nearest.get(t + 1).is_some_and(|n| n.distance <= distance);
        if distance < FAR && !beaten {
            dips.push((distance, t - age.min(t)..t + 1));
        }
    }
    dips.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(f32, Range<usize>)> = Vec::new();
    for dip in dips {
        if kept.iter().all(|k| overlap_share(&k.1, &dip.1) <= 0.5) {
            kept.push(dip);
        }
    }
    kept.into_iter().map(|(distance, _)| distance)
}
