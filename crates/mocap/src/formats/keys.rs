//! Chooses a frame rate for keyframes at arbitrary times.

use super::{Place, Warning};

/// Rates that producers write, the usual first.
const USUAL_HZ: [f64; 22] = [
    30.0,
    60.0,
    24.0,
    25.0,
    50.0,
    48.0,
    100.0,
    120.0,
    30_000.0 / 1001.0,
    60_000.0 / 1001.0,
    24_000.0 / 1001.0,
    15.0,
    10.0,
    12.0,
    20.0,
    72.0,
    75.0,
    90.0,
    150.0,
    200.0,
    240.0,
    480.0,
];
/// For keys that lie on no grid.
const ANY_HZ: f64 = 60.0;
/// Keys farther apart than this were set by hand; motion between them is sampled more finely.
const SPARSE_SECS: f64 = 0.11;

/// Reduced keys fit a fine grid by chance: a grid with more than this many times the stated frame rate is not accepted.
const MOST_OF_STATED: f64 = 2.0;

/// Sampling times of keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct KeyGrid {
    /// Time of the first frame.
    pub(super) start_secs: f64,
    /// Frames a second.
    pub(super) rate_hz: f64,
    /// Number of frames; the last one lies at the last key or just behind it.
    pub(super) frames: usize,
    /// True if the keys lie on the grid.
    pub(super) exact: bool,
}

impl KeyGrid {
    /// Warns if the keys of clip `name` lie on no grid.
    pub(super) fn warn_if_uneven(&self, name: &str, warnings: &mut Vec<Warning>) {
        if !self.exact {
            let text = format!(
                "{name}: keyframes are irregular in time; sampled at {} Hz",
                self.rate_hz
            );
            warnings.push(Warning::new(Place::File, text));
        }
    }
}

/// The grid on which `times` (seconds, in any order) lie: `preferred_hz` if they do, the rate at which they follow each
/// other, the first usual rate of which they are a part, else what is preferred, else 60 Hz. None without a key. O(n log n).
pub(super) fn grid(mut times: Vec<f64>, preferred_hz: Option<f64>) -> Option<KeyGrid> {
    times.retain(|time| time.is_finite());
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| (*b - *a).abs() < 1e-5);
    let (first, last) = (*times.first()?, *times.last()?);
    for time in &mut times {
        *time -= first;
    }
    let fits = |hz: f64| lies_on(&times, hz);
    let found = preferred_hz
        .filter(|&hz| hz > 0.0 && fits(hz))
        .or_else(|| even_rate(&times))
        .or_else(|| {
            let stated = preferred_hz.map_or(f64::INFINITY, |hz| MOST_OF_STATED * hz);
            let usual = USUAL_HZ.into_iter().filter(|&hz| hz <= stated);
            usual.into_iter().find(|&hz| fits(hz))
        });
    let plausible = preferred_hz.filter(|hz| (1.0..=1000.0).contains(hz));
    let rate_hz = found.or(plausible).unwrap_or(ANY_HZ);
    Some(at_rate(first, last, rate_hz, found.is_some()))
}

/// The grid of a given rate from the first of `times` to the last, else [`grid`].
pub(super) fn grid_at(times: Vec<f64>, given_hz: Option<f64>) -> Option<KeyGrid> {
    let Some(rate_hz) = given_hz else {
        return grid(times, None);
    };
    let finite = || times.iter().copied().filter(|time| time.is_finite());
    let (first, last) = (finite().reduce(f64::min)?, finite().reduce(f64::max)?);
    Some(at_rate(first, last, rate_hz, true))
}

/// The grid of `rate_hz` from one time to another.
pub(super) fn at_rate(first: f64, last: f64, rate_hz: f64, exact: bool) -> KeyGrid {
    let steps = (last - first) * rate_hz;
    let last_step = if (steps - steps.round()).abs() < 0.05 {
        steps.round()
    } else {
        steps.ceil()
    };
    KeyGrid {
        start_secs: first,
        rate_hz,
        // As floats saturate, a year of nanoseconds is a number, too; limits are the reader's business.
        frames: (last_step as usize).saturating_add(1),
        exact,
    }
}

/// A usual rate within two hundredths of `hz`.
pub(super) fn usual_near(hz: f64) -> Option<f64> {
    let off = |usual: &f64| (usual / hz - 1.0).abs();
    USUAL_HZ
        .into_iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .filter(|usual| off(usual) < 0.02)
}

/// The rate of keys that follow each other evenly but for a few.
fn even_rate(times: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let median = *steps.get(steps.len() / 2)?;
    if median > SPARSE_SECS {
        return None;
    }
    let even = steps
        .iter()
        .filter(|&&step| (step / median - 1.0).abs() < 0.05)
        .count();
    if even * 10 < steps.len() * 9 {
        return None;
    }
    // Single times are rounded; the whole is not.
    let counted: f64 = steps.iter().map(|step| (step / median).round()).sum();
    let hz = counted / times.last()?;
    let usual = USUAL_HZ
        .into_iter()
        .map(|usual| (usual, (usual / hz - 1.0).abs()))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|&(usual, _)| lies_on(times, usual));
    Some(usual.map_or(hz, |(usual, _)| usual))
}

/// True if all but a few of the times are multiples of the period, within a twentieth of it or the rounding of 32-bit
/// floats.
fn lies_on(times: &[f64], hz: f64) -> bool {
    let off = times
        .iter()
        .filter(|&&time| {
            let step = time * hz;
            (step - step.round()).abs() > 0.05f64.max(1e-6 * step)
        })
        .count();
    off * 100 <= times.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(times: Vec<f64>) -> (f64, usize, bool) {
        let grid = grid(times, None).unwrap();
        (grid.rate_hz, grid.frames, grid.exact)
    }

    #[test]
    fn keys_say_their_rate() {
        let every = |hz: f64, n: usize| (0..n).map(|k| f64::from(k as f32 / hz as f32)).collect();
        for hz in [24.0, 25.0, 30.0, 60.0, 72.0, 100.0, 120.0, 240.0] {
            assert_eq!(rate(every(hz, 500)), (hz, 500, true));
        }
        let (hz, frames, _) = rate(every(37.5, 100));
        assert!((hz - 37.5).abs() < 1e-4 && frames == 100, "{hz}");
        // Reduced keys, keys set by hand, one key.
        let reduced = every(60.0, 300).into_iter().enumerate();
        let reduced = reduced.filter(|(k, _)| k % 7 == 0 || k % 5 == 0 || *k == 299);
        assert_eq!(rate(reduced.map(|(_, t)| t).collect()), (60.0, 300, true));
        assert_eq!(rate(vec![0.0, 1.0, 3.0]), (30.0, 91, true));
        assert_eq!(rate(vec![2.5]), (30.0, 1, true));
        assert!(grid(vec![f64::NAN], None).is_none());
    }

    #[test]
    fn keys_that_start_late_or_lie_anywhere() {
        let late = grid(vec![1.0, 1.5, 2.0], Some(24.0)).unwrap();
        assert_eq!(
            (late.start_secs, late.rate_hz, late.frames),
            (1.0, 24.0, 25)
        );
        let odd = vec![0.0, 0.0171, 0.0533, 0.1378, 0.1517, 0.2];
        assert_eq!(rate(odd.clone()), (60.0, 13, false));
        // The scene's rate, not one on which they lie by chance.
        let stated = grid(odd, Some(30.0)).unwrap();
        assert_eq!((stated.rate_hz, stated.frames), (30.0, 7));
    }
}
