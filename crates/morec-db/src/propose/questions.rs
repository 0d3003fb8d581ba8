//! Selects the most informative proposals to show first (`db propose --doubtful`).

use std::collections::BTreeMap;

use super::Proposal;

/// The places of `most` most informative proposals, the best first: the least certain ones, classes in
/// turn, as several answers about one class at once tell less each.
pub fn most_informative(proposals: &[Proposal], most: usize) -> Vec<usize> {
    let doubt = |p: &Proposal| f64::from(p.score * (1.0 - p.score)).max(1e-6);
    let mut left: Vec<usize> = (0..proposals.len()).collect();
    let mut asked: BTreeMap<&str, usize> = BTreeMap::new();
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let worth = |at: usize| {
            let p = &proposals[at];
            doubt(p) / (1.0 + *asked.get(p.class.as_str()).unwrap_or(&0) as f64)
        };
        let best = (0..left.len())
            .max_by(|a, b| worth(left[*a]).total_cmp(&worth(left[*b])).then(b.cmp(a)));
        let Some(best) = best else { break };
        let at = left.remove(best);
        *asked.entry(&proposals[at].class).or_default() += 1;
        chosen.push(at);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ClipId;
    use morec::TimeSpan;

    fn proposals(scores: &[(&str, f32)]) -> Vec<Proposal> {
        let proposal = |(class, score): &(&str, f32)| Proposal {
            clip: ClipId(1),
            class: (*class).to_owned(),
            span: TimeSpan::new(0.0, 1.0),
            whole_clip: false,
            score: *score,
        };
        scores.iter().map(proposal).collect()
    }

    #[test]
    fn the_least_certain_come_first_and_classes_take_turns() {
        let all = proposals(&[("a", 0.99), ("a", 0.52), ("a", 0.5), ("b", 0.7), ("a", 0.1)]);
        assert_eq!(most_informative(&all, 3), [2, 3, 1]);
        assert_eq!(
            most_informative(&all, 99).len(),
            5,
            "all of them, if that many are asked for"
        );
        assert!(most_informative(&[], 3).is_empty());
    }

    #[test]
    fn what_is_hardly_likely_is_asked_about_when_nothing_else_is_left() {
        let all = proposals(&[("a", 0.0), ("b", 1.0)]);
        assert_eq!(most_informative(&all, 2).len(), 2);
    }
}
