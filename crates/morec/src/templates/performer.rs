//! Relaxed matching for performers other than the training subject, and the decision when it applies.

use serde::{Deserialize, Serialize};

use super::matcher::MatchGate;
use super::{Calibration, OperatingPoint, threshold_at};

/// Who is expected before a recogniser.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PerformerKind {
    /// Whoever it is: the gate opens for a performer whose first recognised motions are unlike the teacher's.
    #[default]
    Auto,
    /// The person who taught.
    Teacher,
    /// Anyone: the gate is open from the first frame.
    Anyone,
}

/// The wider gate of an index that one or two people taught, for performers unlike them. While it is open, matches are discounted:
/// see [`Matcher`](super::Matcher).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StrangerGate {
    /// The performer that is expected.
    #[serde(default)]
    pub performer: PerformerKind,
    /// Share of the squared difference of mean poses that is taken as the performer's stance, not the motion.
    pub discount: f32,
    /// Discounted matches count below this share of a body's distance at rest, discounted alike.
    pub rest_gate: f32,
    /// In place of [`DecodeParams::rival_share`](crate::decode::DecodeParams::rival_share).
    pub rival_share: f32,
    /// Discounted distances at or above this are never reported.
    pub threshold: f32,
    /// Thresholds for other rates of false alarms, ascending.
    #[serde(default)]
    pub operating: Vec<OperatingPoint>,
    /// The gate opens where the performer's level (see [`PerformerLevel`]) is at least this.
    pub open_at: f32,
    /// It closes where the level is below this.
    pub close_at: f32,
    /// Meaning of scores while it is open; older indexes have none, and the [model's](super::TemplateModel::calibration) holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
}

impl StrangerGate {
    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        let values = [
            ("discount", self.discount, 0.0, 0.99),
            ("rest_gate", self.rest_gate, 0.0, 2.0),
            ("rival_share", self.rival_share, 0.0, 2.0),
            ("threshold", self.threshold, f32::MIN_POSITIVE, f32::MAX),
            ("open_at", self.open_at, 0.0, f32::MAX),
            ("close_at", self.close_at, 0.0, f32::MAX),
        ];
        let mut wrong = values
            .iter()
            .filter(|(_, value, least, most)| !(least..=most).contains(&value));
        match wrong.next() {
            Some((name, found, least, _)) => Err(format!(
                "{name} of the wider gate must be {least} or more and sensible, found {found}"
            )),
            None => Ok(()),
        }
    }

    /// The gate that matches have to pass while it is open.
    pub fn match_gate(&self) -> MatchGate {
        MatchGate {
            discount: self.discount,
            rest_share: self.rest_gate,
        }
    }

    /// With the threshold for this rate of false alarms a minute, if rates are noted.
    pub(super) fn with_sensitivity(&self, alarms_per_minute: f64) -> Self {
        let threshold = threshold_at(&self.operating, alarms_per_minute);
        Self {
            threshold: threshold.unwrap_or(self.threshold),
            ..self.clone()
        }
    }

    /// With distances scaled by `share`.
    pub(super) fn scaled(&self, share: f32) -> Self {
        let scaled = |p: &OperatingPoint| OperatingPoint {
            threshold: p.threshold * share,
            ..*p
        };
        Self {
            threshold: self.threshold * share,
            operating: self.operating.iter().map(scaled).collect(),
            open_at: self.open_at * share,
            close_at: self.close_at * share,
            ..self.clone()
        }
    }
}

/// Recognised motions that are remembered of a performer.
const REMEMBERED: usize = 20;
/// Fewer say nothing.
const LEAST: usize = 4;
/// The level of a performer is this quantile of the distances.
const QUANTILE: f32 = 0.4;

/// How near a performer's own recognised motions have been: a quantile of the distances of the last 20, from the fourth on. Those of
/// the person who taught are half of those of others. Memory is fixed.
#[derive(Debug, Clone, Default)]
pub struct PerformerLevel {
    recent: [f32; REMEMBERED],
    count: usize,
    is_open: bool,
}

impl PerformerLevel {
    /// Nothing known; with a gate that stays as `gate` says if a kind of performer is expected.
    pub fn new(gate: &StrangerGate) -> Self {
        Self {
            is_open: gate.performer == PerformerKind::Anyone,
            ..Self::default()
        }
    }

    /// True while the wider gate is open.
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Takes the normalised distance of a recognised motion.
    pub fn note(&mut self, distance: f32, gate: &StrangerGate) {
        self.recent[self.count % REMEMBERED] = distance;
        self.count += 1;
        if gate.performer != PerformerKind::Auto || self.count < LEAST {
            return;
        }
        let mut sorted = self.recent;
        let sorted = &mut sorted[..self.count.min(REMEMBERED)];
        sorted.sort_unstable_by(f32::total_cmp);
        let level = sorted[(QUANTILE * sorted.len() as f32) as usize];
        self.is_open = level
            >= if self.is_open {
                gate.close_at
            } else {
                gate.open_at
            };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate(performer: PerformerKind) -> StrangerGate {
        StrangerGate {
            performer,
            discount: 0.5,
            rest_gate: 0.7,
            rival_share: 1.15,
            threshold: 2.0,
            operating: Vec::new(),
            open_at: 1.1,
            close_at: 1.0,
            calibration: None,
        }
    }

    /// Whether the gate is open after each of these distances.
    fn opened(distances: &[f32], performer: PerformerKind) -> Vec<bool> {
        let gate = gate(performer);
        let mut level = PerformerLevel::new(&gate);
        let note = |d: &f32| {
            level.note(*d, &gate);
            level.is_open()
        };
        distances.iter().map(note).collect()
    }

    #[test]
    fn four_far_motions_open_the_gate_and_near_ones_close_it() {
        let mut distances = vec![1.3; 5];
        assert_eq!(
            opened(&distances, PerformerKind::Auto),
            [false, false, false, true, true]
        );
        distances.extend([0.5; 20]);
        let after = opened(&distances, PerformerKind::Auto);
        assert_eq!(after.last(), Some(&false));
        // Between the two bars it stays as it is.
        assert!(!opened(&[1.05; 8], PerformerKind::Auto)[7]);
        assert!(opened(&[1.2, 1.2, 1.2, 1.2, 1.05, 1.05], PerformerKind::Auto)[5]);
    }

    #[test]
    fn a_performer_that_is_named_is_taken_at_its_word() {
        assert_eq!(opened(&[2.0; 6], PerformerKind::Teacher), [false; 6]);
        assert_eq!(opened(&[0.2; 6], PerformerKind::Anyone), [true; 6]);
    }
}
