//! Confidence that a segment is a class (thesis, §4.6.5, Eq. 4.5).

use mocap::math::portable;
use morec_features::ClassId;

use super::edr::{Edr, least_ratio};
use super::rows_edr::{KnownRows, RowsEdr};
use super::{
    ClassCandidates, MAX_PROFILE_FRAMES, ModelError, Normalisation, SegmentDistance, SvrdmModel,
};

/// Class and confidence of one segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Its class; of no meaning where the confidence is 0.
    pub class: ClassId,
    /// 0 (rejected) … 1.
    pub confidence: f64,
}

impl Cell {
    /// A segment that is no class, or that is not there.
    pub const NOTHING: Cell = Cell {
        class: ClassId(0),
        confidence: 0.0,
    };
}

/// Eq. 4.5: `(1 − 0.9 / (1 + e^(−30 EDR + 15))) · e^(−(len − mean)² / (2 (spread · mean)²))`, lengths in seconds.
pub fn confidence(edr: f64, length_secs: f64, mean_secs: f64, spread: f64) -> f64 {
    sigmoid(edr) * length_prior(length_secs, mean_secs, spread)
}

/// The first factor of Eq. 4.5.
fn sigmoid(edr: f64) -> f64 {
    1.0 - 0.9 / (1.0 + portable::exp(-30.0 * edr + 15.0))
}

/// The second factor of Eq. 4.5.
fn length_prior(length_secs: f64, mean_secs: f64, spread: f64) -> f64 {
    let deviation = (length_secs - mean_secs) / (spread * mean_secs);
    portable::exp(-0.5 * deviation * deviation)
}

/// One class's profiles, among those of all.
#[derive(Debug, Clone)]
struct OfClass {
    /// For each profile, where it lies in [`SegmentScoring::values`].
    profiles: Vec<std::ops::Range<usize>>,
    mean_secs: f64,
    /// The profile that came nearest last time: it goes first, because it most likely does so again, and the others
    /// then have little room to be nearer.
    nearest: usize,
}

/// Measure of distances.
#[derive(Debug, Clone)]
enum Measure {
    Values(Edr, Normalisation),
    /// With the rows of each class's profiles.
    Rows(RowsEdr, Vec<Vec<KnownRows>>),
}

/// Segment scoring: a class and a segment's profile in, a confidence out.
#[derive(Debug, Clone)]
pub struct SegmentScoring {
    values: Vec<f32>,
    classes: Vec<OfClass>,
    width: usize,
    comparison: SegmentDistance,
    edr: Measure,
    spread: f64,
    min_confidence: f64,
    rate_hz: f64,
}

impl SegmentScoring {
    /// For the profiles of a model whose parts fit together.
    ///
    /// # Errors
    /// As [`SvrdmModel::check`].
    pub fn new(model: &SvrdmModel) -> Result<Self, ModelError> {
        model.check()?;
        let mut classes: Vec<OfClass> = model
            .mean_secs
            .iter()
            .map(|mean| OfClass {
                profiles: vec![],
                mean_secs: *mean,
                nearest: 0,
            })
            .collect();
        let mut at = 0;
        for (length, class) in model.profiles.lengths.iter().zip(&model.profiles.classes) {
            let values = length * model.profiles.width;
            classes[class.index()].profiles.push(at..at + values);
            at += values;
        }
        let known = |of: &OfClass| {
            let rows = |at: &std::ops::Range<usize>| {
                KnownRows::new(&model.profiles.values[at.clone()], model.profiles.width)
            };
            of.profiles.iter().map(rows).collect()
        };
        let of_rows = || {
            let (width, epsilon) = (model.profiles.width, model.epsilon);
            let edr = RowsEdr::new(width, epsilon, MAX_PROFILE_FRAMES);
            Measure::Rows(edr, classes.iter().map(known).collect())
        };
        Ok(Self {
            edr: match model.params.comparison {
                SegmentDistance::Profiles => Measure::Values(
                    Edr::new(model.epsilon, MAX_PROFILE_FRAMES),
                    model.params.normalisation,
                ),
                SegmentDistance::Rows { .. } => of_rows(),
            },
            values: model.profiles.values.clone(),
            classes,
            width: model.profiles.width,
            comparison: model.params.comparison,
            spread: model.params.prior_spread,
            min_confidence: model.params.min_confidence,
            rate_hz: model.rate_hz(),
        })
    }

    /// Bytes of its memory: the profiles and the table.
    pub fn bytes(&self) -> usize {
        let table = match &self.edr {
            Measure::Values(edr, _) => edr.bytes(),
            Measure::Rows(edr, known) => {
                edr.bytes() + known.iter().flatten().map(KnownRows::bytes).sum::<usize>()
            }
        };
        4 * self.values.len() + table
    }

    /// Confidence that a segment of `frames` frames with this profile is `class`; 0 if less than the least
    /// confidence that counts. O(rows of the profile · rows of the class's profiles), no allocation.
    pub fn score(&mut self, class: ClassId, profile: &[f32], frames: usize) -> f64 {
        if self.most(class, frames) < self.min_confidence {
            return 0.0;
        }
        let edr = self.nearest(class, profile, self.bound(class, frames));
        let found = self.confidence(class, edr, frames);
        if found < self.min_confidence {
            0.0
        } else {
            found
        }
    }

    /// The most certain of `candidates` for a segment of `frames` frames with this profile; of equals the first.
    pub fn best(&mut self, candidates: &ClassCandidates, profile: &[f32], frames: usize) -> Cell {
        let mut best = Cell::NOTHING;
        for candidate in candidates.iter() {
            let confidence = self.score(candidate.class, profile, frames);
            if confidence > best.confidence {
                best = Cell {
                    class: candidate.class,
                    confidence,
                };
            }
        }
        best
    }

    /// Likeness at distance `edr` from a class's samples, whatever the length: the first factor of
    /// Eq. 4.5, or what stands for it.
    pub fn likeness(&self, edr: f64) -> f64 {
        match self.comparison {
            SegmentDistance::Profiles => sigmoid(edr),
            SegmentDistance::Rows { .. } => 1.0 - edr,
        }
    }

    /// The most that [`score`](Self::score) can give a segment of this many frames, whatever its profile.
    pub fn most(&self, class: ClassId, frames: usize) -> f64 {
        let rows = self.comparison.rows(frames);
        let lengths = self.classes[class.index()].profiles.iter();
        let edr = lengths
            .map(|p| least_ratio(p.len() / self.width, rows))
            .fold(1.0, f64::min);
        self.confidence(class, edr, frames)
    }

    /// Eq. 4.5 for a segment of `frames` frames at distance `edr` from the class's samples.
    pub fn confidence(&self, class: ClassId, edr: f64, frames: usize) -> f64 {
        let (secs, mean_secs) = (
            frames as f64 / self.rate_hz,
            self.classes[class.index()].mean_secs,
        );
        self.likeness(edr) * length_prior(secs, mean_secs, self.spread)
    }

    /// The distance from which on a segment of `frames` frames is less certain than what counts.
    fn bound(&self, class: ClassId, frames: usize) -> f64 {
        match self.comparison {
            SegmentDistance::Rows { .. } if self.min_confidence > 0.0 => {
                // With the confidence of an exact match; a hair more, for the rounding of either side.
                1.0 - self.min_confidence / self.confidence(class, 0.0, frames) + 1e-9
            }
            _ => f64::INFINITY,
        }
    }

    /// Least normalised edit distance to any profile of `class`, 0 … 1.
    pub fn distance(&mut self, class: ClassId, profile: &[f32]) -> f64 {
        self.nearest(class, profile, f64::INFINITY)
    }

    /// The same if it is below `bound`; 1 otherwise.
    fn nearest(&mut self, class: ClassId, profile: &[f32], bound: f64) -> f64 {
        let of = &mut self.classes[class.index()];
        let (mut least, mut nearest) = (bound, of.nearest);
        let mut is_near = false;
        if let Measure::Rows(edr, _) = &mut self.edr {
            edr.set(profile);
        }
        for turn in 0..of.profiles.len() {
            // The nearest of last time, then the others in order.
            let index = match turn {
                0 => of.nearest,
                _ if turn <= of.nearest => turn - 1,
                _ => turn,
            };
            let edr = match &mut self.edr {
                Measure::Values(edr, normalisation) => {
                    let known = &self.values[of.profiles[index].clone()];
                    edr.normalised(profile, known, *normalisation, least)
                }
                Measure::Rows(edr, known) => edr.normalised(&known[class.index()][index], least),
            };
            if let Some(edr) = edr {
                (least, nearest, is_near) = (edr, index, true);
            }
        }
        of.nearest = nearest;
        if is_near { least.min(1.0) } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confidence_is_the_equation() {
        // A perfect match of mean length; the middle of the sigmoid; one deviation too long.
        assert!((confidence(0.0, 1.5, 1.5, 0.25) - 1.0).abs() < 1e-6);
        assert!((confidence(0.5, 1.5, 1.5, 0.25) - 0.55).abs() < 1e-12);
        assert!((confidence(0.5, 1.875, 1.5, 0.25) - 0.55 * (-0.5f64).exp()).abs() < 1e-12);
        assert!((confidence(1.0, 1.5, 1.5, 0.25) - 0.1).abs() < 1e-6);
    }
}
