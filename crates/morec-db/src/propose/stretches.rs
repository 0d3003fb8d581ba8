//! Activities: joins the pieces that were found to whole stretches.

use std::collections::BTreeMap;

use super::candidates::ProposalCandidate;

/// Pieces belong to a stretch if they are at least this likely, or half as likely as the likeliest in the clip.
const LIKELY: f64 = 0.5;

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
