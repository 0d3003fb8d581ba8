//! The operating point of a trained model: how often it may raise a false alarm, and what a score means.

use crate::math::portable;

/// Threshold for a rate of false alarms.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct OperatingPoint {
    /// False alarms a minute of background motion in training.
    pub alarms_per_minute: f64,
    /// The distance below which background motion came that often, within the bounds of training; of a verifier, the score
    /// above which it came.
    pub threshold: f32,
}

/// The rates at which training notes thresholds, false alarms a minute.
pub const ALARM_RATES: [f64; 7] = [0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0];

/// The threshold at `alarms_per_minute`, between the noted points linearly in the logarithm of the rate; beyond them that
/// of the last. `None` if nothing is noted.
pub fn threshold_at(points: &[OperatingPoint], alarms_per_minute: f64) -> Option<f32> {
    let (first, last) = (points.first()?, points.last()?);
    let after = points.partition_point(|p| p.alarms_per_minute < alarms_per_minute);
    if after == 0 {
        return Some(first.threshold);
    }
    let Some(b) = points.get(after) else {
        return Some(last.threshold);
    };
    let a = points[after - 1];
    let share = portable::ln(alarms_per_minute / a.alarms_per_minute)
        / portable::ln(b.alarms_per_minute / a.alarms_per_minute);
    Some(a.threshold + (b.threshold - a.threshold) * share as f32)
}

/// Turns the margin of a detection and its [separation](crate::decode::TickDetection::separation) from other classes into
/// the probability that it is right: `σ(slope · logit(margin) + separation_weight · separation − rest_weight · rest_share +
/// offset)` (Platt 1999, on the logit of the margin and two more covariates).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Calibration {
    /// Weight of the margin's logit.
    pub slope: f64,
    /// Logit of the probability at a margin of one half and a separation of 0.
    pub offset: f64,
    /// Weight of the separation; 0 in indexes that were written before it was measured.
    #[serde(default)]
    pub separation_weight: f64,
    /// Weight of the [share of a body at rest](crate::decode::TickDetection::rest_share), which lowers the probability; 0 but for
    /// strangers.
    #[serde(default)]
    pub rest_weight: f64,
}

impl Calibration {
    /// For models in which distances alone decide. Fitted on detections of referee signals by clip and by person and of Kinect sessions by the same person and by
    /// others, each set with the same weight; `docs/figures.md` says how well it holds on each.
    pub const MEASURED: Self = Self {
        slope: 0.15,
        offset: 0.8,
        separation_weight: 1.5,
        rest_weight: 0.0,
    };

    /// While the wider gate is open, where margins and separations no longer tell right from wrong. Fitted on one teacher's reports
    /// on others, of referee signals and of actions before a Kinect.
    pub const OF_STRANGERS: Self = Self {
        slope: 0.0,
        offset: 14.9,
        separation_weight: 0.0,
        rest_weight: 23.6,
    };

    /// Of the second look's margins, `1 − exp(−(score − bound))`. The best of four pairs on detections of referee signals, sessions and
    /// actions before a Kinect: no row of them is off by more than 0.15.
    pub const OF_LOOKS: Self = Self {
        slope: 0.8,
        offset: 2.5,
        separation_weight: 0.0,
        rest_weight: 0.0,
    };

    /// The map of distances alone that indexes hold which were trained before separations were measured.
    pub(crate) const OF_MARGINS: Self = Self {
        slope: 0.33,
        offset: 1.9,
        separation_weight: 0.0,
        rest_weight: 0.0,
    };

    /// The same where candidates are verified, on the verifier's scores: gestures by person, and Kinect sessions by others
    /// with background, with the same weight.
    pub const VERIFIED: Self = Self {
        slope: 0.6,
        offset: 1.5,
        separation_weight: 0.0,
        rest_weight: 0.0,
    };

    /// The probability for a margin from 0 (just accepted) to 1 (identical), a separation from 0 to 1, and a share of a body
    /// at rest.
    pub fn probability(&self, margin: f64, separation: f32, rest_share: f32) -> f64 {
        let margin = margin.clamp(1e-3, 1.0 - 1e-3);
        let logit = portable::ln(margin / (1.0 - margin));
        let clear = self.separation_weight * f64::from(separation);
        let at_rest = self.rest_weight * f64::from(rest_share);
        1.0 / (1.0 + portable::exp(-(self.slope * logit + clear - at_rest + self.offset)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_lie_between_their_points() {
        let point = |alarms_per_minute, threshold| OperatingPoint {
            alarms_per_minute,
            threshold,
        };
        let points = [point(0.1, 1.0), point(0.4, 2.0)];
        assert_eq!(threshold_at(&points, 0.1), Some(1.0));
        assert_eq!(threshold_at(&points, 0.2), Some(1.5));
        assert_eq!(threshold_at(&points, 0.01), Some(1.0));
        assert_eq!(threshold_at(&points, 9.0), Some(2.0));
        assert_eq!(threshold_at(&[], 1.0), None);
    }

    #[test]
    fn probability_grows_with_margin_and_separation_and_stays_inside_0_and_1() {
        let p = |margin, separation| Calibration::MEASURED.probability(margin, separation, 0.3);
        assert!(0.0 < p(0.0, 0.0) && p(0.0, 0.0) < p(0.5, 0.0) && p(0.5, 0.0) < p(1.0, 0.0));
        assert!(p(0.5, 0.0) < p(0.5, 1.0) && p(1.0, 1.0) < 1.0);
    }

    #[test]
    fn of_strangers_only_the_share_of_a_body_at_rest_counts() {
        let p = |margin, separation, rest_share| {
            Calibration::OF_STRANGERS.probability(margin, separation, rest_share)
        };
        assert_eq!(p(0.1, 0.0, 0.5), p(0.9, 1.0, 0.5));
        assert!(p(0.5, 0.5, 0.4) > 0.99 && p(0.5, 0.5, 0.7) < 0.2);
        let written = r#"{"slope":0.33,"offset":1.9,"separation_weight":0.5}"#;
        let older: Calibration = serde_json::from_str(written).unwrap();
        assert_eq!(older.rest_weight, 0.0);
    }
}
