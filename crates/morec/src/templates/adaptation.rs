//! Which rules of matching hold for the performer at present.

use crate::decode::TickDetection;

use super::matcher::MatchGate;
use super::{Calibration, PerformerLevel, StrangerGate, TemplateModel};

/// The wider gate and what is known of the performer.
#[derive(Debug, Clone)]
pub(super) struct PerformerAdaptation {
    gate: StrangerGate,
    level: PerformerLevel,
    /// What holds while it is closed: the gate of matches, the share of rivals, the thresholds of classes.
    closed: (MatchGate, f32, Vec<f32>),
    /// The thresholds of classes while it is open.
    open: Vec<f32>,
}

impl PerformerAdaptation {
    pub(super) fn new(gate: &StrangerGate, model: &TemplateModel) -> Self {
        let classes = model.classes.len();
        let mut thresholds = vec![model.threshold; classes];
        let own = model.class_thresholds.iter();
        thresholds
            .iter_mut()
            .zip(own)
            .for_each(|(t, own)| *t = *own);
        let rest_share = model.decode.rest_share(model.rule());
        let plain = MatchGate::plain(rest_share);
        Self {
            level: PerformerLevel::new(gate),
            closed: (plain, model.decode.rival_share, thresholds),
            open: vec![gate.threshold; classes],
            gate: gate.clone(),
        }
    }

    pub(super) fn is_open(&self) -> bool {
        self.level.is_open()
    }

    /// Forgets how the performer moves.
    pub(super) fn forget(&mut self) {
        self.level = PerformerLevel::new(&self.gate);
    }

    /// Meaning of scores while the gate is open, if it has one of its own.
    pub(super) fn calibration(&self) -> Option<Calibration> {
        self.gate.calibration.filter(|_| self.is_open())
    }

    /// The gate of matches, the share of rivals and the thresholds of classes that hold now.
    pub(super) fn rules(&self) -> (MatchGate, f32, &[f32]) {
        let (gate, rival_share, thresholds) = &self.closed;
        match self.is_open() {
            true => (self.gate.match_gate(), self.gate.rival_share, &self.open),
            false => (*gate, *rival_share, thresholds),
        }
    }

    /// Takes a detection whose score is its margin below the threshold.
    pub(super) fn note(&mut self, found: &TickDetection) {
        let threshold = self.rules().2[found.class.index()];
        let distance = (1.0 - found.score) as f32 * threshold;
        self.level.note(distance, &self.gate);
    }
}
