//! Resamples frames at arbitrary times to a constant rate, and makes clips of points from them.

mod ordered;
mod schedule;

use self::ordered::{OrderedFrames, rounded};
pub(super) use self::schedule::{BetweenFrames, Schedule};
use super::points::{Point, PointTable, UNSEEN};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::clip::Span;
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

impl Clock {
    /// A rate that is known by now: frames are where their numbers are.
    pub(super) fn settled(rate_hz: f64) -> Self {
        Self {
            given_hz: Some(rate_hz),
            stated_hz: None,
            assumed_hz: rate_hz,
        }
    }
}

/// When frames are, as far as a file says it.
#[derive(Debug, Clone, Default)]
pub(super) struct Stamps {
    /// Time of each frame in seconds, where the file has one.
    pub(super) secs: Vec<Option<f64>>,
    /// Number of each frame, where the file has one; empty if it has none.
    pub(super) numbers: Vec<Option<f64>>,
}

impl Stamps {
    /// Frames that are nothing but in order.
    pub(super) fn none(frames: usize) -> Self {
        Self {
            secs: vec![None; frames],
            numbers: Vec::new(),
        }
    }

    /// The same with the numbers of frames, if any has one.
    pub(super) fn numbered(mut self, numbers: Vec<Option<f64>>) -> Self {
        if numbers.iter().any(Option::is_some) {
            self.numbers = numbers;
        }
        self
    }

    /// Values in a unit of `secs` seconds. Of an unknown one the usual step tells: whole numbers that rise by one to three are numbers of
    /// frames, others milliseconds, micro-, nanoseconds, ticks of 100 ns or seconds.
    pub(super) fn of_values(mut values: Vec<Option<f64>>, secs: Option<f64>) -> Self {
        let known: Vec<f64> = values.iter().copied().flatten().collect();
        let steps = known.windows(2).map(|w| w[1] - w[0]);
        let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
        // Milliseconds rise by more than this at the rates of cameras.
        let counts = (1.0..=3.0).contains(&usual) && known.iter().all(|v| v.fract() == 0.0);
        if secs.is_none() && counts {
            return Self {
                secs: Vec::new(),
                numbers: values,
            };
        }
        let secs = secs.unwrap_or(match usual {
            step if step >= 1e6 => 1e-9,
            // Ticks of 100 ns, as Windows and Kinect count.
            step if step >= 1e5 => 1e-7,
            step if step >= 1e3 => 1e-6,
            step if step >= 2.0 => 1e-3,
            _ => 1.0,
        });
        let first = known.first().copied().unwrap_or(0.0);
        for value in values.iter_mut().flatten() {
            // Times since 1970 leave few digits for the fraction.
            *value = (*value - first) * secs;
        }
        Self {
            secs: values,
            numbers: Vec::new(),
        }
    }
}

/// Points of a file in which each frame may have a time or a number.
#[derive(Debug, Clone)]
pub(super) struct TimedPoints {
    pub(super) points: Vec<Point>,
    pub(super) stamps: Stamps,
    pub(super) clock: Clock,
    pub(super) metres_per_unit: Option<f64>,
}

impl TimedPoints {
    /// Points whose unit of length the file does not say.
    pub(super) fn of_any_unit(points: Vec<Point>, stamps: Stamps, clock: Clock) -> Self {
        Self {
            points,
            stamps,
            clock,
            metres_per_unit: None,
        }
    }

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
        let schedule = Schedule::of(&self.stamps, &self.clock, &mut warnings);
        schedule.apply(&mut self.points);
        let table = PointTable {
            points: self.points,
            rate_hz: schedule.rate_hz,
            metres_per_unit: self.metres_per_unit,
            zero_is_missing: true,
        };
        table.into_loaded(name, warnings, limits)
    }
}

impl Schedule {
    /// The one rule for the times of frames. A rate that the user gives has priority, then the file's times, then its frame numbers. Times
    /// and numbers are sorted and repeated ones dropped; missing frames become gaps, irregular times are interpolated. Without times
    /// and numbers the frames follow each other at the stated or assumed rate. Each repair is one warning. O(n log n).
    pub(super) fn of(stamps: &Stamps, clock: &Clock, warnings: &mut Vec<Warning>) -> Self {
        let usable = |rate: &f64| (1e-3..=1e5).contains(rate);
        let stated = clock.stated_hz.filter(usable);
        let said = clock.given_hz.or(stated);
        let mut warn = |text: String| warnings.push(Warning::new(Place::File, text));
        if clock.given_hz.is_none() && stamps.secs.iter().any(Option::is_some) {
            match OrderedFrames::of(&stamps.secs, true) {
                Ok(ordered) => {
                    ordered.said("times").into_iter().for_each(&mut warn);
                    return ordered.by_times(stated, &mut warn);
                }
                Err(why) if stamps.numbers.is_empty() || why.is_some() => {
                    why.into_iter().for_each(&mut warn);
                }
                Err(_) => {}
            }
        }
        let mut rate_hz = said.unwrap_or_else(|| {
            let stepped = stepped(&stamps.secs);
            warn(match stepped {
                Some(rate) => format!("the most frequent time step gives {rate:.4} Hz"),
                None => {
                    let assumed = clock.assumed_hz;
                    format!("no rate and no usable times; {assumed} Hz is assumed")
                }
            });
            stepped.unwrap_or(clock.assumed_hz)
        });
        let places = match OrderedFrames::of(&stamps.numbers, false) {
            Ok(ordered) if ordered.values.iter().all(|number| number.fract() == 0.0) => {
                let said = ordered.said("numbers of frames");
                said.into_iter().for_each(&mut warn);
                // Where every tenth frame was written, none is left out.
                let each = ordered.even_step();
                if each > 1.0 {
                    warn(format!("frames are numbered in steps of {each}"));
                    rate_hz = clock.given_hz.unwrap_or(rate_hz / each);
                }
                if ordered.is_too_long(each) {
                    warn("frame numbers have too many gaps; frames are read as consecutive".into());
                }
                let places = ordered.by_steps(each);
                let all = places.as_ref().map_or(0, Vec::len);
                if all > ordered.frames.len() {
                    let left_out = all - ordered.frames.len();
                    warn(format!(
                        "{left_out} frames are missing according to the frame numbers"
                    ));
                }
                places
            }
            Ok(_) | Err(None) => None,
            Err(Some(why)) => {
                warn(why);
                None
            }
        };
        Self { rate_hz, places }
    }

    /// Interpolates `points`; what lies in a long step, or next to a position that was not seen, was not seen.
    pub(super) fn apply(&self, points: &mut [Point]) {
        let Some(places) = &self.places else { return };
        for point in points {
            let old = std::mem::take(&mut point.positions);
            let at = |place: &BetweenFrames| -> Vec3 {
                match (place.t, place.known) {
                    (_, false) => UNSEEN,
                    (0.0, _) => old[place.before],
                    (1.0, _) => old[place.after],
                    (t, _) => old[place.before].lerp(&old[place.after], t),
                }
            };
            point.positions = places.iter().map(at).collect();
        }
    }

    /// For each frame the one of the file's `all` that it is; `None` in a gap.
    pub(super) fn frames(&self, all: usize) -> Vec<Option<usize>> {
        match &self.places {
            Some(places) => {
                let frame = |at: &BetweenFrames| at.known.then_some(at.before);
                places.iter().map(frame).collect()
            }
            None => (0..all).map(Some).collect(),
        }
    }

    /// Frames that the file does not have and that cannot be interpolated.
    pub(super) fn gaps(&self) -> Vec<Span> {
        let places = self.places.iter().flatten().enumerate();
        let mut gaps: Vec<Span> = Vec::new();
        for (frame, _) in places.filter(|(_, place)| !place.known) {
            match gaps.last_mut().filter(|gap| gap.end == frame) {
                Some(gap) => gap.end += 1,
                None => gaps.push(frame..frame + 1),
            }
        }
        gaps
    }
}

/// The rate of the usual step between times that run back too often to be an order, as those of takes one behind the other.
fn stepped(secs: &[Option<f64>]) -> Option<f64> {
    let known: Vec<f64> = secs.iter().copied().flatten().collect();
    let steps = known.windows(2).map(|w| w[1] - w[0]);
    let steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    let rate = rounded(1.0 / usual_step(&steps)?);
    (2 * steps.len() > secs.len() && (1.0..=1000.0).contains(&rate)).then_some(rate)
}

#[cfg(test)]
mod tests;
