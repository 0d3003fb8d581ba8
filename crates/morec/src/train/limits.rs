//! Limits of matches: thresholds from a rate of false alarms, and negatives from background that comes near.

use crate::features::{BoneSet, Rows};
use crate::math::portable;
use crate::templates::{
    ALARM_RATES, Calibration, Match, MatchGate, OperatingPoint, PerformerKind, StrangerGate,
};

use super::comparison::{StreamMatches, TrainingContext};
use super::error::TrainError;
use super::mining::{NearMiss, NearestByGate, TrainGates, hard_negatives, smallest};
use super::operating::{AlarmCurve, CAP_EXPONENT};
use super::params::TrainParams;
use super::plan::DecisionPlan;
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream};
use super::thresholds;
use super::trim::motion_span;

/// What keeps background motion from being reported.
pub struct MatchLimits {
    /// The threshold of matches that pass the plain gate.
    pub operating: Operating,
    /// The wider gate, where so few teach.
    pub stranger: Option<StrangerGate>,
    /// The stretches that became negatives.
    pub negatives: Vec<NearMiss>,
    /// Their rows.
    pub rows: Vec<Rows>,
    /// The nearest negatives at every tick of each stream.
    pub near_negatives: Vec<NearestByGate>,
}

/// The threshold and its origin.
pub struct Operating {
    pub threshold: f32,
    pub from: String,
    /// For other rates of false alarms.
    pub points: Vec<OperatingPoint>,
}

impl TrainingContext<'_> {
    /// Thresholds and negatives from the `matches` of `samples`. The second look refuses background that comes near, so no negatives are
    /// needed where there is one.
    ///
    /// # Errors
    /// `progress` cancels.
    pub fn limits(
        &self,
        plan: &DecisionPlan,
        bones: BoneSet,
        (samples, matches): (&[TrainSample], &[StreamMatches]),
        has_look: bool,
    ) -> Result<MatchLimits, TrainError> {
        let (set, params) = (self.set, self.params);
        let near: Vec<&NearestByGate> = matches.iter().map(|m| &m.all).collect();
        let negatives = match has_look {
            true => Vec::new(),
            false => {
                let near_enough = self.operating(&near, None, |near| &near.plain);
                let threshold = near_enough.threshold;
                negatives_of(set, bones, (samples, matches), threshold, params)
            }
        };
        let rows: Vec<Rows> = negatives.iter().map(|n| negative_rows(set, n)).collect();
        let all = TrainGates {
            plain: MatchGate::plain(0.0),
            wide: plan.gates.wide.map(|gate| MatchGate {
                rest_share: 0.0,
                ..gate
            }),
        };
        let rule = (plan.verifies, self.largest_threshold());
        let near_negatives = self.negatives((&negatives, &rows), matches, all, rule)?;
        let seen: Vec<&NearestByGate> = near_negatives.iter().collect();
        let stranger = plan.gates.wide.map(|gate| {
            let operating = self.operating(&near, Some(&seen), |near| &near.wide);
            self.stranger_gate(gate, operating)
        });
        let operating = self.operating(&near, Some(&seen), |near| &near.plain);
        Ok(MatchLimits {
            operating,
            stranger,
            negatives,
            rows,
            near_negatives,
        })
    }

    /// Bound of the threshold at a rate of false alarms. It moves with the rate, or it would be all there is where no
    /// background comes near.
    fn most_at(&self, rate: f64) -> f64 {
        let params = self.params;
        params.max_threshold * portable::powf(rate / params.alarms_per_minute, CAP_EXPONENT)
    }

    /// Bound of all thresholds; 0 where none comes from a rate of false alarms.
    pub fn largest_threshold(&self) -> f64 {
        let usual = self.params.alarms_per_minute;
        if usual <= 0.0 {
            return 0.0;
        }
        let rates = ALARM_RATES.into_iter().chain([usual]);
        rates.map(|rate| self.most_at(rate)).fold(0.0, f64::max)
    }

    /// The threshold under the gate that `of` chooses; `negatives` add what near misses of other people and clips keep out.
    fn operating(
        &self,
        near: &[&NearestByGate],
        negatives: Option<&[&NearestByGate]>,
        of: impl Fn(&NearestByGate) -> &[Match],
    ) -> Operating {
        let params = self.params;
        let near: Vec<&[Match]> = near.iter().map(|near| of(near)).collect();
        if params.alarms_per_minute <= 0.0 {
            let (threshold, from) = thresholds::global_threshold(self.set, &near, params);
            let points = Vec::new();
            return Operating {
                threshold,
                from,
                points,
            };
        }
        let negatives = negatives.map(|near| near.iter().map(|near| of(near)).collect::<Vec<_>>());
        let curve = AlarmCurve::of(self.set, &near, negatives.as_deref(), params);
        let at = |rate: f64| {
            let most = self.most_at(rate);
            let set_by = curve.distance_at(rate);
            set_by
                .filter(|(distance, _)| f64::from(*distance) < most)
                .map_or((most as f32, None), |(distance, stream)| {
                    (distance, Some(stream))
                })
        };
        let (threshold, stream) = at(params.alarms_per_minute);
        let point = |alarms_per_minute: f64| OperatingPoint {
            alarms_per_minute,
            threshold: at(alarms_per_minute).0,
        };
        Operating {
            threshold,
            from: stream.map_or_else(
                || "its upper bound, because no background comes near".to_owned(),
                |stream| format!("background clip {}", self.set.streams[stream].name),
            ),
            points: ALARM_RATES.map(point).to_vec(),
        }
    }

    /// The wider gate, with the thresholds that background motion sets when it is matched as under that gate.
    fn stranger_gate(&self, gate: MatchGate, operating: Operating) -> StrangerGate {
        let params = &self.params.stranger;
        StrangerGate {
            performer: PerformerKind::Auto,
            discount: gate.discount,
            rest_gate: gate.rest_share,
            rival_share: params.rival_share,
            threshold: operating.threshold,
            operating: operating.points,
            open_at: params.open_at,
            close_at: params.close_at,
            calibration: self.params.calibrate.then_some(Calibration::OF_STRANGERS),
        }
    }
}

/// Short background clips as a whole, and the nearest misses in everything else that is background.
fn negatives_of(
    set: &TrainSet,
    bones: BoneSet,
    (samples, matches): (&[TrainSample], &[StreamMatches]),
    threshold: f32,
    params: &TrainParams,
) -> Vec<NearMiss> {
    if !params.mine_negatives {
        return Vec::new();
    }
    let longest = samples.iter().map(|s| s.rows.len()).max().unwrap_or(0) as f64;
    let short = |s: &TrainStream| {
        s.source == StreamKind::Background
            && s.rows.len() as f64 <= params.whole_background * longest
    };
    let (whole, long): (Vec<_>, Vec<_>) = set
        .streams
        .iter()
        .enumerate()
        .filter(|(_, s)| s.rest_is_background)
        .partition(|(_, s)| short(s));
    let mut found: Vec<NearMiss> = long
        .into_iter()
        .flat_map(|(i, s)| {
            let near = [&matches[i].all.plain, &matches[i].others].map(Vec::as_slice);
            hard_negatives(near, (i, s), threshold, params)
        })
        .collect();
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found.truncate(params.max_negatives);
    found.extend(whole.into_iter().map(|(stream, s)| NearMiss {
        distance: smallest(&matches[stream].all.plain),
        stream,
        ticks: motion_span(&s.rows, bones),
    }));
    found
}

/// The rows of a near miss, and at least the eight before its end: a shorter template would match anything.
fn negative_rows(set: &TrainSet, miss: &NearMiss) -> Rows {
    let start = miss.ticks.start.min(miss.ticks.end.saturating_sub(8));
    set.streams[miss.stream].rows.slice(start..miss.ticks.end)
}
