//! From the times of frames to a fixed rate, and points at these times to clips.

use super::points::{Point, PointTable, SHORT_GAP_SECS, UNSEEN};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::Vec3;
use crate::resample::usual_step;

/// Facts about a file's rate besides the times of its frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    /// Said by the user, in place of everything else.
    pub(super) given_hz: Option<f64>,
    /// Said by the file.
    pub(super) stated_hz: Option<f64>,
    /// Taken if nothing says.
    pub(super) assumed_hz: f64,
}

/// Points of a file in which each frame may have a time.
#[derive(Debug, Clone)]
pub(super) struct TimedPoints {
    pub(super) points: Vec<Point>,
    /// Time of each frame in seconds, where the file has one.
    pub(super) times_secs: Vec<Option<f64>>,
    pub(super) clock: Clock,
    pub(super) metres_per_unit: Option<f64>,
}

impl TimedPoints {
    /// Clips of the points at the rate that times and clock say; a point at the origin was not seen. As
    /// [`PointTable::into_loaded`].
    ///
    /// # Errors
    /// No point was ever seen, or there are more points than `limits` allow.
    pub(super) fn into_loaded(
        mut self,
        name: &str,
        mut warnings: Vec<Warning>,
        limits: &Limits,
    ) -> Result<Loaded, ParseError> {
        let (times, points) = (&self.times_secs, &mut self.points);
        let rate_hz = regular(times, &self.clock, points, &mut warnings);
        let table = PointTable {
            points: self.points,
            rate_hz,
            metres_per_unit: self.metres_per_unit,
            zero_is_missing: true,
        };
        table.into_loaded(name, warnings, limits)
    }
}

/// Warning about a rate given for a file whose keys stand at times.
pub(super) fn rate_not_used() -> Warning {
    let text = "its keys stand at times, not frames; the rate given is not used";
    Warning::new(Place::File, text)
}

/// A step between frames that differs by more than this from the usual one is irregular, in steps.
const IRREGULAR: f64 = 0.25;
/// Share of irregular steps from which on frames are resampled.
const MANY: f64 = 0.02;
/// Rates that differ by no more than this share are one rate, measured twice.
const SAME_RATE: f64 = 0.02;

/// A fixed rate, and where its frames lie among those of the file.
pub(super) struct Schedule {
    pub(super) rate_hz: f64,
    /// For each frame the one of the file before it, how far it lies towards the next, and whether the two are near
    /// enough to know what is between them; `None` if frames stay as they are.
    pub(super) places: Option<Vec<(usize, f64, bool)>>,
}

impl Schedule {
    /// The rate of frames at `times_secs`, or regular frames among them if they are irregular.
    pub(super) fn of(
        times_secs: &[Option<f64>],
        clock: &Clock,
        warnings: &mut Vec<Warning>,
    ) -> Self {
        let as_it_is = |rate_hz| Self {
            rate_hz,
            places: None,
        };
        if let Some(given) = clock.given_hz {
            return as_it_is(given);
        }
        let usable = |rate: &f64| (1e-3..=1e5).contains(rate);
        let stated = clock.stated_hz.filter(usable);
        let mut warn = |text: String| warnings.push(Warning::new(Place::File, text));
        let Some(times) = increasing(times_secs) else {
            let assumed = clock.assumed_hz;
            if stated.is_none() {
                warn(format!(
                    "no rate and no usable times; {assumed} Hz is assumed"
                ));
            }
            return as_it_is(stated.unwrap_or(assumed));
        };
        let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        let mean_secs = (times[times.len() - 1] - times[0]) / steps.len() as f64;
        let usual_secs = usual_step(&steps).unwrap_or(mean_secs).max(1e-5);
        // Printed times have few digits: a step may be off by one of the last.
        let allowed = IRREGULAR * usual_secs + 0.0011;
        let odd = steps.iter().filter(|s| (*s - usual_secs).abs() > allowed);
        // A few long pauses are not odd steps, and make another mean.
        let paused = (mean_secs / usual_secs - 1.0).abs() > SAME_RATE;
        if paused || odd.count() as f64 > MANY * steps.len() as f64 {
            let rate_hz = stated.unwrap_or(rounded(1.0 / usual_secs)).clamp(1e-3, 1e5);
            warn(format!(
                "frames are at irregular times; they are interpolated at {rate_hz:.4} Hz"
            ));
            let places = Some(places(&times, rate_hz));
            return Self { rate_hz, places };
        }
        let mean = rounded((1.0 / mean_secs).clamp(1e-3, 1e5));
        match stated {
            Some(stated) if (stated / mean - 1.0).abs() > SAME_RATE => {
                warn(format!(
                    "{stated} Hz is said, but the times of the frames make {mean:.4} Hz, which is taken"
                ));
                as_it_is(mean)
            }
            stated => as_it_is(stated.unwrap_or(mean)),
        }
    }

    /// Interpolates `points`; what lies in a long step, or next to a position that was not seen, was not seen.
    pub(super) fn apply(&self, points: &mut [Point]) {
        let Some(places) = &self.places else { return };
        for point in points {
            let old = std::mem::take(&mut point.positions);
            let at = |&(before, t, known): &(usize, f64, bool)| -> Vec3 {
                match (t, known) {
                    (_, false) => UNSEEN,
                    (0.0, _) => old[before],
                    (1.0, _) => old[before + 1],
                    (t, _) => old[before].lerp(&old[before + 1], t),
                }
            };
            point.positions = places.iter().map(at).collect();
        }
    }
}

/// The rate of frames at `times_secs`. Where the times are irregular, `points` are interpolated at regular ones.
/// O(points × frames).
fn regular(
    times_secs: &[Option<f64>],
    clock: &Clock,
    points: &mut [Point],
    warnings: &mut Vec<Warning>,
) -> f64 {
    let schedule = Schedule::of(times_secs, clock, warnings);
    schedule.apply(points);
    schedule.rate_hz
}

/// All times, if they are there and increase from each frame to the next.
fn increasing(times: &[Option<f64>]) -> Option<Vec<f64>> {
    let times: Option<Vec<f64>> = times.iter().copied().collect();
    let times = times.filter(|t| t.len() > 1)?;
    let (first, last) = (times[0], times[times.len() - 1]);
    let increase = times.windows(2).filter(|w| w[1] <= w[0]).count();
    // Times with few digits may repeat.
    (last > first && increase * 10 <= times.len() && times.windows(2).all(|w| w[1] >= w[0]))
        .then_some(times)
}

/// A rate near a round one is that: times are printed with few digits.
fn rounded(rate: f64) -> f64 {
    let near = |unit: f64| (rate / unit).round() * unit;
    [1.0, 0.5, 0.1, 0.01]
        .into_iter()
        .map(near)
        .find(|&round| round > 0.0 && (rate / round - 1.0).abs() < 2e-3)
        .unwrap_or(rate)
}

/// Frames at `frame / rate_hz` after the first time.
fn places(times: &[f64], rate_hz: f64) -> Vec<(usize, f64, bool)> {
    let duration = times[times.len() - 1] - times[0];
    // Times with a hole of days must not make endless frames.
    let most = times.len().saturating_mul(20);
    let frames = ((duration * rate_hz + 1e-6).floor() as usize)
        .saturating_add(1)
        .min(most);
    let mut before = 0;
    let mut place = |frame: usize| {
        let at = times[0] + frame as f64 / rate_hz;
        while before + 2 < times.len() && times[before + 1] <= at {
            before += 1;
        }
        let step = times[before + 1] - times[before];
        let t = match step > 0.0 {
            true => ((at - times[before]) / step).clamp(0.0, 1.0),
            false => 0.0,
        };
        let known = step <= SHORT_GAP_SECS || t == 0.0 || t == 1.0;
        (before, t, known)
    };
    (0..frames).map(&mut place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNKNOWN: Clock = Clock {
        given_hz: None,
        stated_hz: None,
        assumed_hz: 30.0,
    };

    fn run(times: &[f64], clock: &Clock) -> (f64, Vec<Vec3>, usize) {
        let positions = times.iter().map(|&t| Vec3::repeat(t)).collect();
        let mut points = [Point {
            name: "A".into(),
            positions,
        }];
        let mut warnings = Vec::new();
        let times: Vec<Option<f64>> = times.iter().copied().map(Some).collect();
        let rate = regular(&times, clock, &mut points, &mut warnings);
        (rate, points[0].positions.clone(), warnings.len())
    }

    #[test]
    fn printed_times_give_a_round_rate() {
        let times: Vec<f64> = (0..151)
            .map(|f| (f as f64 / 60.0 * 1e3).round() / 1e3)
            .collect();
        let (rate, positions, said) = run(&times, &UNKNOWN);
        assert_eq!((rate, positions.len(), said), (60.0, 151, 0));
    }

    #[test]
    fn irregular_times_are_made_regular() {
        let times: Vec<f64> = (0..100)
            .map(|f| 0.05 * f as f64 + 0.02 * (f % 3) as f64)
            .collect();
        let (rate, positions, said) = run(&times, &UNKNOWN);
        assert_eq!(said, 1);
        for (frame, p) in positions.iter().enumerate() {
            assert!((p.x - frame as f64 / rate).abs() < 1e-9, "{frame}");
        }
    }

    #[test]
    fn frames_that_are_missing_do_not_slow_a_clip_down() {
        // Two in five frames are missing: two of three steps are of two frames.
        let seen = (0..200).filter(|f| [0, 1, 3].contains(&(f % 5)));
        let times: Vec<f64> = seen.map(|f| f as f64 / 15.0).collect();
        let (rate, positions, said) = run(&times, &UNKNOWN);
        assert_eq!((rate, said), (15.0, 1));
        for (frame, p) in positions.iter().enumerate() {
            assert!((p.x - frame as f64 / 15.0).abs() < 1e-9, "{frame}");
        }
        // One pause of two seconds in a minute.
        let times: Vec<f64> = (0..900)
            .map(|f| (f + if f > 400 { 30 } else { 0 }) as f64 / 15.0)
            .collect();
        let (rate, positions, _) = run(&times, &UNKNOWN);
        assert_eq!((rate, positions.len()), (15.0, 930));
    }

    #[test]
    fn what_is_not_known_is_assumed_and_what_is_given_holds() {
        assert_eq!(run(&[1.0, 1.0, 1.0], &UNKNOWN).0, 30.0);
        let given = Clock {
            given_hz: Some(50.0),
            ..UNKNOWN
        };
        assert_eq!(run(&[0.0, 1.0, 1.1], &given).0, 50.0);
        let wrong = Clock {
            stated_hz: Some(100.0),
            ..UNKNOWN
        };
        let times: Vec<f64> = (0..50).map(|f| f as f64 / 25.0).collect();
        let (rate, _, said) = run(&times, &wrong);
        assert_eq!((rate, said), (25.0, 1));
    }
}
