//! Matches of the templates in a clip. Each stretch is compared without the templates that were cut from it.

use std::ops::Range;

use morec::templates::{Evidence, Match};
use morec::train::overlap_share;

use super::material::{ProposalData, overlap};
use super::views::BoneView;

/// Distance of what was not found.
pub const FAR: f32 = 1e30;
/// A match that shares more of the shorter with a template's own stretch is that stretch found again.
const SELF: f64 = 0.3;
/// Matches that share so much of both are of one stretch.
const SAME: f64 = 0.5;
/// Ticks each side that a candidate is the nearest of.
const PEAK_TICKS: usize = 3;

/// Cost of a match at another pace than its template: at half or double pace the distance counts one and a half times.
const PACE: f32 = 1.0;

const NOTHING: Match = Match {
    distance: FAR,
    age: 0,
};

/// The nearest template of each class, and behind them the nearest rejected stretch, at each tick of a clip.
pub struct ClassDistances {
    columns: usize,
    near: Vec<Match>,
}

/// A stretch that may show a class.
pub struct ProposalCandidate {
    pub class: usize,
    pub ticks: Range<usize>,
    pub evidence: Evidence,
}

impl ClassDistances {
    /// Runs the bank over a clip. `templates` are the bank's, as places in [`ProposalData::judged`].
    pub fn of(material: &ProposalData, clip: usize, templates: &[usize], view: &BoneView) -> Self {
        let rows = view.map(&material.clips[clip].laid.rows);
        let columns = material.classes.len() + 1;
        let mut bank = view.bank.clone();
        let mut near = vec![NOTHING; rows.len() * columns];
        for (tick, row) in rows.iter().enumerate() {
            bank.step(row);
            for (index, template) in templates.iter().enumerate() {
                let judged = &material.judged[*template];
                let column = if judged.accepted {
                    judged.class
                } else {
                    Some(columns - 1)
                };
                let Some(best) = column.map(|column| &mut near[tick * columns + column]) else {
                    continue;
                };
                let found = bank.matched(index);
                let pace = ((found.age + 1) as f32 / bank.template_len(index).max(1) as f32).ln();
                let found = Match {
                    distance: found.distance * view.factor * (1.0 + PACE * pace * pace),
                    ..found
                };
                let own = || {
                    judged.clip == clip
                        && (judged.whole || overlap_share(&span(tick, found), &judged.label) > SELF)
                };
                if found.distance < best.distance && !own() {
                    *best = found;
                }
            }
        }
        Self { columns, near }
    }

    fn ticks(&self) -> usize {
        self.near.len() / self.columns
    }

    fn at(&self, tick: usize, column: usize) -> Match {
        self.near[tick * self.columns + column]
    }

    /// The nearest match of a column that is of the stretch; anywhere if it is the whole clip.
    fn nearest(&self, column: usize, ticks: &Range<usize>, whole: bool) -> f32 {
        let slack = ticks.len() / 2 + 1;
        let around = match whole {
            true => 0..self.ticks(),
            false => ticks.end.saturating_sub(slack)..(ticks.end + slack).min(self.ticks()),
        };
        around
            .map(|tick| (tick, self.at(tick, column)))
            .filter(|(tick, found)| {
                found.distance < FAR && (whole || overlap(&span(*tick, *found), ticks) > SAME)
            })
            .fold(FAR, |best, (_, found)| best.min(found.distance))
    }

    /// Distances of a stretch to a class, to the others and to the rejected stretches.
    pub fn evidence(&self, class: usize, ticks: &Range<usize>, whole: bool) -> Evidence {
        let others = (0..self.columns - 1).filter(|c| *c != class);
        let other = others
            .map(|c| self.nearest(c, ticks, whole))
            .fold(FAR, f32::min);
        Evidence {
            distance: self.nearest(class, ticks, whole).into(),
            other: other.into(),
            negative: self.nearest(self.columns - 1, ticks, whole).into(),
        }
    }

    /// The best of the whole clip.
    pub fn whole(&self, class: usize) -> Option<ProposalCandidate> {
        let nearest = (0..self.ticks()).min_by(|a, b| {
            self.at(*a, class)
                .distance
                .total_cmp(&self.at(*b, class).distance)
        })?;
        let found = self.at(nearest, class);
        let ticks = span(nearest, found);
        (found.distance < FAR).then(|| ProposalCandidate {
            class,
            evidence: self.evidence(class, &ticks, true),
            ticks,
        })
    }

    /// Local minima of the distance to the class.
    pub fn peaks(&self, class: usize) -> Vec<ProposalCandidate> {
        let peak = |tick: &usize| {
            let here = self.at(*tick, class).distance;
            let around = tick.saturating_sub(PEAK_TICKS)..(tick + PEAK_TICKS + 1).min(self.ticks());
            here < FAR
                && around
                    .into_iter()
                    .all(|t| t == *tick || here < self.at(t, class).distance)
        };
        let candidate = |tick: usize| {
            let ticks = span(tick, self.at(tick, class));
            let mut evidence = self.evidence(class, &ticks, false);
            evidence.distance = self.at(tick, class).distance.into();
            ProposalCandidate {
                class,
                ticks,
                evidence,
            }
        };
        (0..self.ticks()).filter(peak).map(candidate).collect()
    }
}

fn span(tick: usize, found: Match) -> Range<usize> {
    tick - found.age.min(tick)..tick + 1
}
