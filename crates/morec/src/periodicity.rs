//! Periods of what repeats, from its autocorrelation.

/// When a peak of an autocorrelation is a period.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct CycleParams {
    /// No repetition is shorter.
    pub least_secs: f64,
    /// The first peak of the autocorrelation that reaches this share of the highest is the period: later ones are two
    /// periods, three.
    pub share: f64,
    /// Below this correlation nothing repeats.
    pub least_correlation: f64,
}

impl Default for CycleParams {
    fn default() -> Self {
        Self {
            least_secs: 0.25,
            share: 0.7,
            least_correlation: 0.15,
        }
    }
}

/// The period in rows of which `rate_hz` make a second, placed between rows by a parabola, and the correlation there; `None`
/// where nothing repeats. `correlation` is that of rows so far apart, from a lag of none on. O(lags), no allocation.
pub(crate) fn period(
    correlation: &[f64],
    rate_hz: f64,
    params: &CycleParams,
) -> Option<(f64, f64)> {
    // Before it has crossed zero, the correlation falls from that of rows with themselves, and its peaks are noise (McLeod and
    // Wyvill, *A smarter way to find pitch*, 2005, §5).
    let crossing = correlation.iter().position(|c| *c <= 0.0)?;
    let first = ((params.least_secs * rate_hz).ceil() as usize).max(crossing.max(1));
    let is_peak = |&lag: &usize| {
        correlation[lag] >= correlation[lag - 1] && correlation[lag] > correlation[lag + 1]
    };
    let peaks = || (first..correlation.len().saturating_sub(1)).filter(is_peak);
    let highest = peaks().map(|lag| correlation[lag]).fold(f64::MIN, f64::max);
    if highest < params.least_correlation {
        return None;
    }
    let peak = peaks().find(|&lag| correlation[lag] >= params.share * highest)?;
    let [before, at, after] = [peak - 1, peak, peak + 1].map(|lag| correlation[lag]);
    let bend = before - 2.0 * at + after;
    let shift = if bend < 0.0 {
        0.5 * (before - after) / bend
    } else {
        0.0
    };
    Some((peak as f64 + shift.clamp(-0.5, 0.5), at))
}
