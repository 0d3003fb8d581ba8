//! Sorts frames by their times or numbers.

use super::schedule::{BetweenFrames, Schedule};
use crate::formats::points::SHORT_GAP_SECS;
use crate::resample::usual_step;

/// A step between frames that differs by more than this from the usual one is irregular, in steps.
const IRREGULAR: f64 = 0.25;
/// A step that differs by no more than this from a whole number of usual ones has frames left out in it, in steps.
const EVEN: f64 = 0.05;
/// Share of irregular steps from which on frames are resampled.
const MANY: f64 = 0.02;
/// Rates that differ by no more than this share are one rate, measured twice.
const SAME_RATE: f64 = 0.02;
/// Largest step between frame numbers that is taken for a recording of every n-th frame.
const MOST_STEP: f64 = 30.0;
/// Frames for each of a file's, at most: a hole of days must not make endless ones.
const MOST_FRAMES: usize = 20;

/// Frames of a file in the order of their times or numbers, each of which stands there once.
pub(super) struct OrderedFrames {
    /// Frames as the file has them.
    pub(super) frames: Vec<usize>,
    /// Their times or numbers.
    pub(super) values: Vec<f64>,
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
    pub(super) fn of(values: &[Option<f64>], may_be_coarse: bool) -> Result<Self, Option<String>> {
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
            let text = "times or frame numbers decrease or are missing too often to order the frames by them";
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
    pub(super) fn said(&self, what: &str) -> Option<String> {
        let counts = [
            (self.moved, "out of order, sorted"),
            (self.repeated, "repeated, the first kept"),
            (self.without, "missing or far out of range, left out"),
        ];
        let done = counts.iter().filter(|(count, _)| *count > 0);
        let done: Vec<String> = done.map(|(n, done)| format!("{n} {done}")).collect();
        (!done.is_empty()).then(|| {
            let all = self.all;
            format!("{what} of {all} frames: {}", done.join("; "))
        })
    }

    /// Frames by their times in seconds.
    pub(super) fn by_times(&self, stated: Option<f64>, warn: &mut dyn FnMut(String)) -> Schedule {
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
                let rate_hz = agreed(stated, self.by_digits(secs), warn);
                let places = self.by_steps(secs);
                if places.is_some() {
                    let left_out = count - steps.len() as f64;
                    warn(format!(
                        "{left_out} frames are missing according to the times"
                    ));
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
        let rate_hz = agreed(stated, self.by_digits(mean_secs), warn);
        let is_whole = self.frames.iter().copied().eq(0..self.all);
        let places = || self.frames.iter().copied().map(BetweenFrames::at).collect();
        Schedule {
            rate_hz,
            places: (!is_whole).then(places),
        }
    }

    /// A mean step that is that of a whole rate as far as the digits of the times tell.
    fn by_digits(&self, mean_secs: f64) -> f64 {
        /// Shorter digits tell as much as rates do.
        const MOST: f64 = 0.025;
        let way = self.values[self.values.len() - 1] - self.values[0];
        let whole = (1.0 / mean_secs).round();
        let off = digit(&self.values).map_or(0.0, |digit| (digit / way).min(MOST));
        match whole >= 1.0 && (whole * mean_secs - 1.0).abs() <= off {
            true => 1.0 / whole,
            false => mean_secs,
        }
    }

    /// Frames at whole multiples of `step` after the first, and gaps between them; `None` if all are there, or far too few.
    pub(super) fn by_steps(&self, step: f64) -> Option<Vec<BetweenFrames>> {
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

    /// The step from number to number where all are the same, as of a file with every tenth frame; else 1.
    pub(super) fn even_step(&self) -> f64 {
        let mut steps = self.values.windows(2).map(|w| w[1] - w[0]);
        let first = steps.next().filter(|step| (1.0..=MOST_STEP).contains(step));
        let is_even = |step: &f64| self.values.len() > 3 && steps.all(|other| other == *step);
        first.filter(is_even).unwrap_or(1.0)
    }

    /// True if the way from the first to the last is that of far more frames than there are.
    pub(super) fn is_too_long(&self, step: f64) -> bool {
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
                "{stated} Hz is stated, but the frames' times give {mean:.4} Hz, which is used"
            ));
            mean
        }
        stated => stated.unwrap_or(mean),
    }
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
    let values: Vec<f64> = stamped.iter().map(|&(_, value)| value).collect();
    let digit = digit(&values);
    let step = (last - first) / (stamped.len() - 1) as f64;
    let is_near = |(number, &(_, value)): (usize, &(usize, f64))| {
        let even = first + number as f64 * step;
        digit.is_some_and(|digit| (value - even).abs() <= digit)
    };
    stamped.iter().enumerate().all(is_near)
}

/// The last digit that times are printed with; `None` if they have more than four behind the point.
fn digit(values: &[f64]) -> Option<f64> {
    let is_of = |digit: &f64| {
        values.iter().all(|value| {
            let digits = (value - values[0]) / digit;
            (digits - digits.round()).abs() < 1e-3
        })
    };
    [1.0, 0.1, 0.01, 1e-3, 1e-4].into_iter().find(is_of)
}

/// A rate near a round one is that: times are printed with few digits.
pub(super) fn rounded(rate: f64) -> f64 {
    let near = |unit: f64| (rate / unit).round() * unit;
    [1.0, 0.5, 0.1, 0.01]
        .into_iter()
        .map(near)
        .find(|&round| round > 0.0 && (rate / round - 1.0).abs() < 2e-3)
        .unwrap_or(rate)
}
