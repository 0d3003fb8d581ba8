//! Converts `Frame Time:` to frames a second.

use super::notes::Notes;
use crate::formats::Place;

/// Rates that devices and video have. Of the two that lie near a frame time the nearer is meant.
const NOMINAL_HZ: [f64; 30] = [
    10.0,
    12.0,
    12.5,
    15.0,
    20.0,
    24_000.0 / 1001.0,
    24.0,
    25.0,
    30_000.0 / 1001.0,
    30.0,
    40.0,
    48.0,
    50.0,
    60_000.0 / 1001.0,
    60.0,
    72.0,
    75.0,
    90.0,
    100.0,
    120_000.0 / 1001.0,
    120.0,
    125.0,
    144.0,
    150.0,
    180.0,
    200.0,
    240.0,
    250.0,
    480.0,
    500.0,
];

/// Files that give no usable frame time are read at the rate most files have (44 of 116 files of 63 producers).
pub(super) const ASSUMED_HZ: f64 = 30.0;

/// The rate that a frame time means. `None`: the file gives none.
pub(super) fn rate_hz(frame_time_secs: Option<f64>, at: Place, notes: &mut Notes) -> f64 {
    let Some(secs) = frame_time_secs else {
        notes.add(at, format!("no Frame Time, {ASSUMED_HZ} Hz assumed"));
        return ASSUMED_HZ;
    };
    // Also refuses NaN, and what has no finite reciprocal.
    if !(1e-9..=1e9).contains(&secs) {
        notes.add(
            at,
            format!("Frame Time {secs} is invalid, {ASSUMED_HZ} Hz assumed"),
        );
        return ASSUMED_HZ;
    }
    let stated = 1.0 / secs;
    let rate = snap(stated);
    if (rate / stated - 1.0).abs() > 2e-4 {
        notes.add(
            at,
            format!("Frame Time {secs} is {stated:.3} Hz, read as {rate:.3} Hz"),
        );
    }
    if !(5.0..=1000.0).contains(&rate) {
        notes.add(
            at,
            format!("Frame Time {secs} means {rate:.3} Hz, which is unlikely"),
        );
    }
    rate
}

/// The nominal rate within 0.5 % of `stated`, or the whole number that `stated` is but for printed digits.
fn snap(stated: f64) -> f64 {
    let distance = |rate: &f64| (rate / stated - 1.0).abs();
    let nearest = NOMINAL_HZ
        .iter()
        .copied()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    if let Some(rate) = nearest.filter(|r| distance(r) <= 0.005) {
        return rate;
    }
    Some(stated.round())
        .filter(|r| *r >= 1.0 && distance(r) <= 1e-4)
        .unwrap_or(stated)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(secs: f64) -> (f64, usize) {
        let mut notes = Notes::default();
        let rate = rate_hz(Some(secs), Place::File, &mut notes);
        (rate, notes.into_warnings().len())
    }

    #[test]
    fn printed_digits_do_not_change_the_rate() {
        for (secs, rate) in [
            (0.0083333, 120.0),
            (0.008333, 120.0),
            (0.0333333, 30.0),
            (0.033333, 30.0),
            (0.0416667, 24.0),
            (0.025, 40.0),
            (0.0384615, 26.0),
            (0.0333667, 30_000.0 / 1001.0),
        ] {
            assert_eq!(read(secs), (rate, 0), "{secs}");
        }
        assert_eq!(read(0.008342), (120_000.0 / 1001.0, 0));
        assert_eq!(read(0.0083), (120.0, 1));
    }

    #[test]
    fn odd_rates_stay_as_they_are() {
        assert_eq!(read(1.0 / 47.3), (1.0 / (1.0 / 47.3), 0));
        assert_eq!(read(1.0 / 7.5), (7.5, 0));
    }

    #[test]
    fn suspect_rates_are_kept_and_named() {
        assert_eq!(read(1.0), (1.0, 1));
        assert_eq!(read(0.3), (1.0 / 0.3, 1));
        assert_eq!(read(0.0001), (10_000.0, 1));
    }

    #[test]
    fn no_frame_time_is_assumed_to_be_the_commonest() {
        for secs in [0.0, -0.01, f64::NAN, f64::INFINITY, 1e-300] {
            assert_eq!(read(secs), (ASSUMED_HZ, 1), "{secs}");
        }
    }
}
