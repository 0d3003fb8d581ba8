//! From the times of frames to a fixed rate, and points at these times to clips.

use super::points::{Point, PointTable, SHORT_GAP_SECS, UNSEEN};
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

/// Warning about a rate given for a file whose keys stand at times.
pub(super) fn rate_not_used() -> Warning {
    let text = "its keys stand at times, not frames; the rate given is not used";
    Warning::new(Place::File, text)
}

/// A step between frames that differs by more than this from the usual one is irregular, in steps.
const IRREGULAR: f64 = 0.25;
/// A step that differs by no more than this from a whole number of usual ones has frames left out in it, in steps.
const EVEN: f64 = 0.05;
/// Share of irregular steps from which on frames are resampled.
const MANY: f64 = 0.02;
/// Rates that differ by no more than this share are one rate, measured twice.
const SAME_RATE: f64 = 0.02;
/// Frames for each of a file's, at most: a hole of days must not make endless ones.
const MOST_FRAMES: usize = 20;

/// A fixed rate, and where its frames lie among those of the file.
pub(super) struct Schedule {
    pub(super) rate_hz: f64,
    /// For each frame what it is made of; `None` if frames stay as they are.
    pub(super) places: Option<Vec<BetweenFrames>>,
}

/// A frame between two of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BetweenFrames {
    pub(super) before: usize,
    pub(super) after: usize,
    /// How far it lies from the one before to the one after, 0 to 1.
    pub(super) t: f64,
    /// False if the two are too far apart to know what is between them.
    pub(super) known: bool,
}

impl BetweenFrames {
    fn at(frame: usize) -> Self {
        Self {
            before: frame,
            after: frame,
            t: 0.0,
            known: true,
        }
    }
}

impl Schedule {
    /// The one rule for when frames are. A rate that the user gives holds. Else times are taken, else numbers of frames: put in order,
    /// without those that repeat; frames that are left out are gaps, and irregular ones are interpolated. Without either, frames
    /// follow each other at the rate that the file says or that is assumed. What was done is said once. O(n log n).
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
        let rate_hz = said.unwrap_or_else(|| {
            let stepped = stepped(&stamps.secs);
            warn(match stepped {
                Some(rate) => format!("the usual step of the times makes {rate:.4} Hz"),
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
                if ordered.is_too_long(1.0) {
                    warn("numbers of frames leave out too many; frames follow each other".into());
                }
                let places = ordered.by_steps(1.0);
                let all = places.as_ref().map_or(0, Vec::len);
                if all > ordered.frames.len() {
                    let left_out = all - ordered.frames.len();
                    warn(format!("{left_out} frames are left out by their numbers"));
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

    /// Frames that the file does not have, nor frames near enough to know them.
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

/// Frames of a file in the order of their times or numbers, each of which stands there once.
struct OrderedFrames {
    /// Frames as the file has them.
    frames: Vec<usize>,
    /// Their times or numbers.
    values: Vec<f64>,
    /// Frames in the file.
    all: usize,
    moved: usize,
    repeated: usize,
    without: usize,
    /// Times have so few digits that they repeat, and are even but for that.
    is_coarse: bool,
}

impl OrderedFrames {
    /// `Err` if values are of no use, with the reason if there are any that differ. `may_be_coarse` of times with few digits.
    fn of(values: &[Option<f64>], may_be_coarse: bool) -> Result<Self, Option<String>> {
        let finite = |(frame, value): (usize, &Option<f64>)| Some((frame, (*value)?));
        let stamped: Vec<(usize, f64)> = values.iter().enumerate().filter_map(finite).collect();
        let rising = rising(&stamped);
        let (Some(&first), Some(&last)) = (rising.first(), rising.last()) else {
            return Err(None);
        };
        let (lowest, highest) = (stamped[first].1, stamped[last].1);
        if highest <= lowest {
            return Err(None);
        }
        let moved = stamped.len() - rising.len();
        if 4 * moved > stamped.len().max(4) || 2 * stamped.len() < values.len() {
            let text = "times or numbers of frames run back, or are not there, too often to put frames in order by them";
            return Err(Some(text.to_owned()));
        }
        // One far ahead of its place, or behind it, would move all others.
        let mut kept = stamped.clone();
        kept.retain(|&(_, value)| (lowest..=highest).contains(&value));
        kept.sort_by(|a, b| a.1.total_cmp(&b.1));
        let in_range = kept.len();
        let repeats = kept.windows(2).any(|pair| pair[0].1 == pair[1].1);
        let is_coarse = may_be_coarse && repeats && moved == 0 && is_even_but_for_digits(&kept);
        if !is_coarse {
            kept.dedup_by(|later, earlier| later.1 == earlier.1);
        }
        Ok(Self {
            frames: kept.iter().map(|&(frame, _)| frame).collect(),
            values: kept.iter().map(|&(_, value)| value).collect(),
            all: values.len(),
            moved,
            repeated: in_range - kept.len(),
            without: values.len() - in_range,
            is_coarse,
        })
    }

    /// What was done to frames, if anything was.
    fn said(&self, what: &str) -> Option<String> {
        let counts = [
            (self.moved, "out of order, put in order"),
            (self.repeated, "repeated, of which the first is kept"),
            (self.without, "missing or far off, left out"),
        ];
        let done = counts.iter().filter(|(count, _)| *count > 0);
        let done: Vec<String> = done.map(|(n, done)| format!("{n} {done}")).collect();
        (!done.is_empty()).then(|| {
            let all = self.all;
            format!("{what} of {all} frames: {}", done.join("; "))
        })
    }

    /// Frames by their times in seconds.
    fn by_times(&self, stated: Option<f64>, warn: &mut dyn FnMut(String)) -> Schedule {
        let times = &self.values;
        let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        let mean_secs = (times[times.len() - 1] - times[0]) / steps.len() as f64;
        let usual_secs = usual_step(&steps).unwrap_or(mean_secs).max(1e-5);
        // Printed times have few digits: a step may be off by one of the last.
        let allowed = IRREGULAR * usual_secs + 0.0011;
        let odd = steps.iter().filter(|s| (*s - usual_secs).abs() > allowed);
        // A few long pauses are not odd steps, and make another mean.
        let paused = (mean_secs / usual_secs - 1.0).abs() > SAME_RATE;
        if !self.is_coarse && (paused || odd.count() as f64 > MANY * steps.len() as f64) {
            let number = |step: &f64| (step / usual_secs).round().max(1.0);
            let near = EVEN * usual_secs + 0.0011;
            let is_whole = |step: &f64| (step - number(step) * usual_secs).abs() <= near;
            if steps.iter().all(is_whole) {
                // Frames that are left out, and no other fault.
                let count: f64 = steps.iter().map(number).sum();
                let secs = mean_secs * steps.len() as f64 / count;
                let rate_hz = agreed(stated, secs, warn);
                let places = self.by_steps(secs);
                if places.is_some() {
                    let left_out = count - steps.len() as f64;
                    warn(format!("{left_out} frames are left out by their times"));
                    return Schedule { rate_hz, places };
                }
            }
            let rate_hz = stated.unwrap_or(rounded(1.0 / usual_secs)).clamp(1e-3, 1e5);
            warn(format!(
                "frames are at irregular times; they are interpolated at {rate_hz:.4} Hz"
            ));
            let places = Some(self.interpolated(rate_hz));
            return Schedule { rate_hz, places };
        }
        let rate_hz = agreed(stated, mean_secs, warn);
        let is_whole = self.frames.iter().copied().eq(0..self.all);
        let places = || self.frames.iter().copied().map(BetweenFrames::at).collect();
        Schedule {
            rate_hz,
            places: (!is_whole).then(places),
        }
    }

    /// Frames at whole multiples of `step` after the first, and gaps between them; `None` if all are there, or far too few.
    fn by_steps(&self, step: f64) -> Option<Vec<BetweenFrames>> {
        let first = self.values[0];
        let number = |value: f64| ((value - first) / step).round();
        let count = number(self.values[self.values.len() - 1]) + 1.0;
        let is_whole = count == self.all as f64 && self.frames.iter().copied().eq(0..self.all);
        if is_whole || self.is_too_long(step) {
            return None;
        }
        let gap = BetweenFrames {
            known: false,
            ..BetweenFrames::at(0)
        };
        let mut places = vec![gap; count as usize];
        for (&frame, &value) in self.frames.iter().zip(&self.values) {
            places[number(value) as usize] = BetweenFrames::at(frame);
        }
        // Those of a gap lie between its ends.
        let mut before = 0;
        for number in 0..places.len() {
            if places[number].known {
                before = number;
                continue;
            }
            let ahead = places[number..].iter().position(|place| place.known);
            let after = number + ahead.unwrap_or(0);
            places[number] = BetweenFrames {
                before: places[before].before,
                after: places[after].before,
                t: (number - before) as f64 / (after - before).max(1) as f64,
                known: false,
            };
        }
        Some(places)
    }

    /// True if the way from the first to the last is that of far more frames than there are.
    fn is_too_long(&self, step: f64) -> bool {
        let way = self.values[self.values.len() - 1] - self.values[0];
        way / step > (MOST_FRAMES * self.frames.len()) as f64
    }

    /// Frames at `frame / rate_hz` after the first time.
    fn interpolated(&self, rate_hz: f64) -> Vec<BetweenFrames> {
        let times = &self.values;
        let duration = times[times.len() - 1] - times[0];
        let most = times.len().saturating_mul(MOST_FRAMES);
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
            BetweenFrames {
                before: self.frames[before],
                after: self.frames[before + 1],
                t,
                known: step <= SHORT_GAP_SECS || t == 0.0 || t == 1.0,
            }
        };
        (0..frames).map(&mut place).collect()
    }
}

/// The rate that a file states, unless the usual step of its times is clearly another.
fn agreed(stated: Option<f64>, step_secs: f64, warn: &mut dyn FnMut(String)) -> f64 {
    let mean = rounded((1.0 / step_secs).clamp(1e-3, 1e5));
    match stated {
        Some(stated) if (stated / mean - 1.0).abs() > SAME_RATE => {
            warn(format!(
                "{stated} Hz is said, but the times of the frames make {mean:.4} Hz, which is taken"
            ));
            mean
        }
        stated => stated.unwrap_or(mean),
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

/// The longest part of frames whose values never fall: those that are left are out of order. O(n log n).
fn rising(stamped: &[(usize, f64)]) -> Vec<usize> {
    // For each length the frame with the least value at which a part of that length ends, and for each frame the one before.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = Vec::with_capacity(stamped.len());
    for (at, &(_, value)) in stamped.iter().enumerate() {
        let length = ends.partition_point(|&end| stamped[end].1 <= value);
        before.push(length.checked_sub(1).map(|shorter| ends[shorter]));
        match ends.get_mut(length) {
            Some(end) => *end = at,
            None => ends.push(at),
        }
    }
    let last = ends.last().copied();
    let mut rising: Vec<usize> = std::iter::successors(last, |&at| before[at]).collect();
    rising.reverse();
    rising
}

/// True if times repeat, but are those of an even clock to the last digit that they have: then no frame is there twice.
fn is_even_but_for_digits(stamped: &[(usize, f64)]) -> bool {
    let (first, last) = (stamped[0].1, stamped[stamped.len() - 1].1);
    let is_of = |digit: &f64| {
        stamped.iter().all(|&(_, value)| {
            let digits = (value - first) / digit;
            (digits - digits.round()).abs() < 1e-3
        })
    };
    let digit = [1.0, 0.1, 0.01, 1e-3, 1e-4].into_iter().find(is_of);
    let step = (last - first) / (stamped.len() - 1) as f64;
    let is_near = |(number, &(_, value)): (usize, &(usize, f64))| {
        let even = first + number as f64 * step;
        digit.is_some_and(|digit| (value - even).abs() <= digit)
    };
    stamped.iter().enumerate().all(is_near)
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
        let stamps = Stamps {
            secs: times.iter().copied().map(Some).collect(),
            numbers: Vec::new(),
        };
        let schedule = Schedule::of(&stamps, clock, &mut warnings);
        schedule.apply(&mut points);
        let mut positions = points[0].positions.clone();
        for gap in schedule.gaps() {
            let (from, to) = (positions[gap.start - 1], positions[gap.end]);
            for frame in gap.clone() {
                let t = (frame + 1 - gap.start) as f64 / (gap.len() + 1) as f64;
                positions[frame] = from.lerp(&to, t);
            }
        }
        (schedule.rate_hz, positions, warnings.len())
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
