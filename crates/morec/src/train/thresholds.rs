//! The distance threshold, common to all classes.

use crate::decode::FAR;
use crate::templates::Match;

use super::mining::smallest;
use super::params::TrainParams;
use super::set::{StreamKind, TrainSet};

/// A share of the smallest distance that background motion has to any template, and what set it.
///
/// Clips that the user calls background count in full. Of made everyday motion a tenth may come nearer: some of it
/// may happen to be one of the classes, and what comes that near becomes a hard negative. `nearest` is each stream's nearest template at
/// every tick.
pub fn global_threshold(
    set: &TrainSet,
    nearest: &[&[Match]],
    params: &TrainParams,
) -> (f32, String) {
    let of = |source: StreamKind, share: f64| {
        let streams = set
            .streams
            .iter()
            .zip(nearest)
            .filter(|(s, _)| s.source == source);
        let mut smallest: Vec<(f32, &str)> = streams
            .map(|(s, near)| (smallest(near), s.name.as_str()))
            .collect();
        smallest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let place = (share * smallest.len() as f64) as usize;
        smallest.get(place).copied()
    };
    let clips = of(StreamKind::Background, 0.0);
    let everyday = of(StreamKind::Everyday, params.everyday_may_pass);
    let nearest = clips
        .into_iter()
        .chain(everyday)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((distance, name)) if distance < FAR / 2.0 => (
            params.background_share as f32 * distance,
            format!("background clip {name}"),
        ),
        _ => (
            params.fallback_threshold as f32,
            "no background: a general value".to_owned(),
        ),
    }
}
