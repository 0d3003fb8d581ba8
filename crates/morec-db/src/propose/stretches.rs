//! Activities: long labels are looked for by pieces of a repetition or a few, and what is found becomes whole stretches again.
//!
//! A label of twenty seconds is like no other as a whole: another person repeats the motion at another pace, and more or less often.

use std::collections::BTreeMap;
use std::ops::Range;

use morec::features::Rows;
use morec::segment::{CycleParams, cycles};

use super::candidates::ProposalCandidate;

/// A piece lasts at least this: shorter ones are found by chance. Seconds.
const LEAST_SECS: f64 = 1.0;
/// Pieces of what has no period, seconds: as long as the windows by which activities are recognised.
const USUAL_SECS: f64 = 2.5;
/// Pieces belong to a stretch if they are at least this likely, or half as likely as the likeliest in the clip.
const LIKELY: f64 = 0.5;

/// Even pieces of a stretch of rows, each of as many whole repetitions as last a second; `ticks` is where the rows lie.
pub fn pieces(rows: &Rows, ticks: &Range<usize>, tick_hz: f64) -> Vec<Range<usize>> {
    let period_secs = cycles(rows, tick_hz, &CycleParams::default())
        .map_or(USUAL_SECS, |cycles| cycles.period_secs);
    let piece_secs = period_secs * (LEAST_SECS / period_secs).ceil();
    let count = ((ticks.len() as f64 / tick_hz / piece_secs) as usize).max(1);
    let bound = |piece: usize| ticks.start + ticks.len() * piece / count;
    (0..count).map(|i| bound(i)..bound(i + 1)).collect()
}

/// Candidates of the classes that are activities, joined to stretches where they follow each other within the length of one; a stretch is
/// as likely as its pieces are on average. Others stay.
pub fn joined(
    candidates: Vec<(f64, ProposalCandidate)>,
    is_activity: impl Fn(usize) -> bool,
) -> Vec<(f64, ProposalCandidate)> {
    let (pieces, mut found): (Vec<_>, Vec<_>) = candidates
        .into_iter()
        .partition(|(_, c)| is_activity(c.class));
    let mut of_class: BTreeMap<usize, Vec<(f64, ProposalCandidate)>> = BTreeMap::new();
    for piece in pieces {
        of_class.entry(piece.1.class).or_default().push(piece);
    }
    for mut pieces in of_class.into_values() {
        let best = pieces.iter().map(|(score, _)| *score).fold(0.0, f64::max);
        pieces.retain(|(score, _)| *score >= LIKELY.min(0.5 * best));
        pieces.sort_by_key(|(_, c)| c.ticks.start);
        let mut counts: Vec<usize> = Vec::new();
        let first = found.len();
        for (score, piece) in pieces {
            let follows = |last: &(f64, ProposalCandidate)| {
                piece.ticks.start <= last.1.ticks.end + piece.ticks.len()
            };
            match (found[first..].last_mut(), counts.last_mut()) {
                (Some(last), Some(count)) if follows(last) => {
                    last.1.ticks.end = last.1.ticks.end.max(piece.ticks.end);
                    last.0 += (score - last.0) / (*count + 1) as f64;
                    *count += 1;
                }
                _ => {
                    found.push((score, piece));
                    counts.push(1);
                }
            }
        }
    }
    found
}
