//! Agreement of two annotators: Cohen's kappa, agreement of events beyond chance, and differences of starts and stops.

use std::collections::BTreeMap;

use serde::Serialize;

use super::figures::{quantile, share};
use super::pairs::{OverlapScore, pair};
use super::{
    Boundaries, ClipDetection, EvalError, EvaluatedStream, GroundTruth, MEASURED_OVERLAP,
    StreamInfo, all_classes, streams, timing,
};
use morec::TimeSpan;
use morec::rng::Rng;

/// Draws by which agreement by chance is estimated.
const CHANCE_DRAWS: usize = 200;

/// Agreement of two annotators, A and B, over streams that both have labelled.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LabelAgreement {
    /// Streams that were compared.
    pub clips: usize,
    /// Their length, seconds.
    pub secs: f64,
    /// Length of a unit of time, seconds: kappa depends on it.
    pub unit_secs: f64,
    /// Agreement by units of time, over all classes and "no label". Of labels that overlap, the one that started last counts.
    pub time: Kappa,
    /// Agreement by events, over all classes.
    pub events: EventAgreement,
    /// Each class of either annotator, by name.
    pub classes: Vec<ClassAgreement>,
    /// Units of time by the label of A (row) and of B (column).
    pub confusion: UnitConfusion,
}

/// Cohen's kappa (Cohen, *A coefficient of agreement for nominal scales*, 1960): the agreement in excess of chance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Kappa {
    /// Units of time.
    pub units: usize,
    /// Share of the units in which both say the same.
    pub observed: Option<f64>,
    /// The share that is expected of two annotators who use each label as often and do not look.
    pub chance: Option<f64>,
    /// `(observed − chance) / (1 − chance)`; `None` if chance alone agrees everywhere.
    pub kappa: Option<f64>,
}

/// Events of A paired with events of the same class of B that overlap them by half (intersection over union), each once.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventAgreement {
    /// Events of A.
    pub of_a: usize,
    /// Events of B.
    pub of_b: usize,
    /// Pairs.
    pub matched: usize,
    /// `2 matched / (of_a + of_b)`.
    pub f1: Option<f64>,
    /// Mean F1 if the events of B stood elsewhere: moved along each stream by a random time, those that leave its end entering at its start.
    pub chance: Option<f64>,
    /// `(f1 − chance) / (1 − chance)`.
    pub corrected: Option<f64>,
    /// B's starts and stops less A's, over the pairs.
    pub boundaries: Boundaries,
    /// Nine in ten starts of pairs are no further apart.
    pub start_p90_secs: Option<f64>,
    /// The same of stops.
    pub stop_p90_secs: Option<f64>,
}

/// Agreement about one class.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassAgreement {
    /// Name of the class.
    pub class: String,
    /// By units of time: this class or not.
    pub time: Kappa,
    /// By events of this class.
    pub events: EventAgreement,
}

/// Units of time by both labels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnitConfusion {
    /// Classes of rows and columns, by name; "no label" follows them.
    pub classes: Vec<String>,
    /// `units[row][column]`, one row and one column more than there are classes.
    pub units: Vec<Vec<usize>>,
}

impl LabelAgreement {
    /// Compares the labels `a` and `b` of `infos`, by units of `unit_secs`. Deterministic: the chance of events is drawn from a fixed
    /// seed. O(labels · log + units · classes), times 200 for the pairs by chance.
    ///
    /// # Errors
    /// As [`Evaluation::of`](super::Evaluation::of).
    ///
    /// # Panics
    /// If `unit_secs` is not above 0.
    pub fn of(
        infos: &[StreamInfo],
        a: &[GroundTruth],
        b: &[GroundTruth],
        unit_secs: f64,
    ) -> Result<Self, EvalError> {
        assert!(unit_secs > 0.0, "the unit of time must be above 0 s");
        let b: Vec<ClipDetection> = b.iter().map(ClipDetection::from).collect();
        let streams = streams(infos, a, &b)?;
        let classes: Vec<&str> = all_classes(&streams).into_iter().collect();
        let units = UnitLabels::of(&streams, &classes, unit_secs);
        let of_class = |(place, class): (usize, &&str)| {
            let of = only(&streams, class);
            ClassAgreement {
                class: (*class).to_owned(),
                time: units.kappa_of(place),
                events: EventAgreement::of(&of),
            }
        };
        Ok(Self {
            clips: streams.len(),
            secs: streams.iter().map(|s| s.info.duration_secs).sum(),
            unit_secs,
            time: units.kappa(),
            events: EventAgreement::of(&streams),
            classes: classes.iter().enumerate().map(of_class).collect(),
            confusion: UnitConfusion {
                units: units.counts.clone(),
                classes: classes.into_iter().map(str::to_owned).collect(),
            },
        })
    }
}

/// The labels of one class.
fn only<'a>(streams: &[EvaluatedStream<'a>], class: &str) -> Vec<EvaluatedStream<'a>> {
    let of = |stream: &EvaluatedStream<'a>| EvaluatedStream {
        info: stream.info,
        truths: (stream.truths.iter().copied())
            .filter(|t| t.class == class)
            .collect(),
        founds: (stream.founds.iter().copied())
            .filter(|f| f.class == class)
            .collect(),
    };
    streams.iter().map(of).collect()
}

impl EventAgreement {
    fn of(streams: &[EvaluatedStream<'_>]) -> Self {
        let pairs = timing::measured_pairs(streams);
        let apart = |of: fn(&GroundTruth, &ClipDetection) -> f64| {
            let mut apart: Vec<f64> = pairs.iter().map(|(a, b)| of(a, b).abs()).collect();
            quantile(&mut apart, 0.9)
        };
        let of_a: usize = streams.iter().map(|s| s.truths.len()).sum();
        let of_b: usize = streams.iter().map(|s| s.founds.len()).sum();
        let score = OverlapScore::new(MEASURED_OVERLAP, pairs.len(), of_a, of_b);
        let chance = score.f1.and_then(|_| {
            let mut rng = Rng::new(0);
            let draws = (0..CHANCE_DRAWS).map(|_| matched_by_chance(streams, &mut rng));
            share(2 * draws.sum::<usize>(), CHANCE_DRAWS * (of_a + of_b))
        });
        Self {
            of_a,
            of_b,
            matched: pairs.len(),
            f1: score.f1,
            chance,
            corrected: beyond_chance(score.f1, chance),
            boundaries: Boundaries::of(&pairs),
            start_p90_secs: apart(|a, b| b.span.start_secs - a.span.start_secs),
            stop_p90_secs: apart(|a, b| b.span.stop_secs - a.span.stop_secs),
        }
    }
}

/// Number of pairs after the events of B were moved, in each stream by one random time.
fn matched_by_chance(streams: &[EvaluatedStream<'_>], rng: &mut Rng) -> usize {
    let mut matched = 0;
    for stream in streams {
        let duration = stream.info.duration_secs;
        let by = rng.unit() * duration;
        let moved = |found: &&ClipDetection| {
            let mut found = (*found).clone();
            let start = (found.span.start_secs + by) % duration;
            found.span.stop_secs += start - found.span.start_secs;
            found.span.start_secs = start;
            found
        };
        let founds: Vec<ClipDetection> = stream.founds.iter().map(moved).collect();
        let elsewhere = EvaluatedStream {
            info: stream.info,
            truths: stream.truths.clone(),
            founds: founds.iter().collect(),
        };
        matched += pair(&elsewhere, MEASURED_OVERLAP).len();
    }
    matched
}

fn beyond_chance(observed: Option<f64>, chance: Option<f64>) -> Option<f64> {
    let (observed, chance) = (observed?, chance?);
    (chance < 1.0).then(|| (observed - chance) / (1.0 - chance))
}

/// Counts of units of time by both annotators' labels.
struct UnitLabels {
    /// By the label of A and of B; the last is no label.
    counts: Vec<Vec<usize>>,
    /// For each class: units that A gives it, that B gives it, and that both do. Labels that overlap all count.
    given: Vec<[usize; 3]>,
    units: usize,
}

impl UnitLabels {
    fn of(streams: &[EvaluatedStream<'_>], classes: &[&str], unit_secs: f64) -> Self {
        let place: BTreeMap<&str, usize> = classes
            .iter()
            .enumerate()
            .map(|(k, class)| (*class, k))
            .collect();
        let none = classes.len();
        let mut all = Self {
            counts: vec![vec![0; none + 1]; none + 1],
            given: vec![[0; 3]; none],
            units: 0,
        };
        for stream in streams {
            // Units whose middle lies within the stream.
            let count = (stream.info.duration_secs / unit_secs + 0.5) as usize;
            let of = |labels: &mut dyn Iterator<Item = (&str, TimeSpan)>| {
                let mut last = vec![none; count];
                let mut every = vec![vec![false; count]; none];
                for (class, span) in labels {
                    // The first unit whose middle is not before this time; 0 for less.
                    let unit = |secs: f64| {
                        ((secs - TimeSpan::SAME_SECS) / unit_secs - 0.5).ceil() as usize
                    };
                    let (from, to) = (
                        unit(span.start_secs).min(count),
                        unit(span.stop_secs).min(count),
                    );
                    last[from..to].fill(place[class]);
                    every[place[class]][from..to].fill(true);
                }
                (last, every)
            };
            let (a, every_a) = of(&mut stream.truths.iter().map(|t| (t.class.as_str(), t.span)));
            let (b, every_b) = of(&mut stream.founds.iter().map(|f| (f.class.as_str(), f.span)));
            for (a, b) in a.into_iter().zip(b) {
                all.counts[a][b] += 1;
            }
            for (given, (a, b)) in all.given.iter_mut().zip(every_a.iter().zip(&every_b)) {
                for (a, b) in a.iter().zip(b) {
                    given[0] += usize::from(*a);
                    given[1] += usize::from(*b);
                    given[2] += usize::from(*a && *b);
                }
            }
            all.units += count;
        }
        all
    }

    fn kappa(&self) -> Kappa {
        let of = 0..self.counts.len();
        let same = of.clone().map(|k| self.counts[k][k]).sum();
        let row = |k: usize| self.counts[k].iter().sum::<usize>() as f64;
        let column = |k: usize| self.counts.iter().map(|row| row[k]).sum::<usize>() as f64;
        Kappa::new(self.units, same, of.map(|k| row(k) * column(k)).sum())
    }

    fn kappa_of(&self, class: usize) -> Kappa {
        let [a, b, both] = self.given[class];
        let neither = self.units + both - a - b;
        let [not_a, not_b] = [self.units - a, self.units - b].map(|n| n as f64);
        Kappa::new(
            self.units,
            both + neither,
            a as f64 * b as f64 + not_a * not_b,
        )
    }
}

impl Kappa {
    /// `products`: the sum over labels of the units that A and that B give it, multiplied.
    fn new(units: usize, same: usize, products: f64) -> Self {
        let observed = share(same, units);
        let chance = (units > 0).then(|| products / (units as f64 * units as f64));
        Self {
            units,
            observed,
            chance,
            kappa: beyond_chance(observed, chance),
        }
    }
}
