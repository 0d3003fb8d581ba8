//! Activities: continuous motions such as walking or an exercise, recognised by windows of a few seconds instead of by a
//! beginning and an end.
//!
//! A template says in which order a motion's poses come; an activity can be met anywhere in its cycle, and each repetition at its own
//! pace. What keeps are the statistics of a window of a few seconds: which poses, how far about them, how fast. Ten times a second a
//! window is compared with the mean window of each class (linear discriminants: a within-class metric and distances from means; Hastie,
//! Tibshirani and Friedman, *The Elements of Statistical Learning*, §4.3) and with the nearest window of anything else, and the best path
//! through classes and *none of them* is decoded with a cost for every change and a fixed lag (Viterbi 1967).

mod detector;
mod repetitions;
mod windows;

use crate::classes::ClassId;
use crate::features::RowLayout;
use crate::math::portable;

use super::{ReferenceRows, TemplateSample};

pub(super) use detector::ActivityDetector;
pub(crate) use windows::STEP_TICKS;
#[cfg(feature = "train")]
pub(crate) use windows::windows_of;

/// Shorter activities are not reported, in windows.
const LEAST_WINDOWS: usize = 8;
/// Shares of others' distance for other rates of false alarms follow the rate with this exponent: on motion of other clips, 1.2 times as
/// wide in squared distance raised five times as many reports.
const SHARE_EXPONENT: f64 = 0.05;
/// The rate, a minute, that a share of 1 stands for.
const USUAL_RATE: f64 = 0.3;

/// What windows of activities are compared with, before the metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Activities {
    /// Mean windows of the classes, `9 b + 8` statistics each (a class has one, and another of mirrored copies), and windows of anything
    /// else.
    pub windows: ReferenceRows,
    /// Ticks of a window, odd.
    pub window_ticks: usize,
    /// A window is of a class while it is nearer to it than this share of its distance from anything else.
    pub share: f32,
    /// Rows of single repetitions of the samples, with which those of a stream are compared; none in older indexes. Nothing is recognised by
    /// them.
    pub repetitions: Vec<TemplateSample>,
    /// Their values are whole multiples of this, column by column: files hold bytes.
    pub step: Vec<f32>,
}

impl Activities {
    /// Shorter activities are not reported, in ticks.
    pub const LEAST_TICKS: usize = LEAST_WINDOWS * STEP_TICKS;

    /// Longest window, in ticks.
    const MOST_TICKS: usize = 1 << 12;

    /// Checks that all parts fit together, for rows of `layout` and `classes` classes.
    ///
    /// # Errors
    /// A sentence about the first part that does not fit.
    pub fn check(&self, layout: RowLayout, classes: usize) -> Result<(), String> {
        let what = "windows of activities";
        self.windows
            .check(what, Self::statistics(layout), classes)?;
        if self.windows.rows.is_empty() || self.windows.others.is_empty() {
            return Err(
                "activities without windows, or without windows of other motion".to_owned(),
            );
        }
        if !(1..=Self::MOST_TICKS).contains(&self.window_ticks) {
            return Err(format!(
                "a window of activities must be 1 to {} ticks long, found {}",
                Self::MOST_TICKS,
                self.window_ticks
            ));
        }
        if !(self.share.is_finite() && self.share > 0.0) {
            return Err(format!(
                "the share of activities must be above 0, found {}",
                self.share
            ));
        }
        let fits = |sample: &TemplateSample| {
            sample.rows.dim() == layout.dim() && sample.class.index() < classes
        };
        match self.repetitions.iter().all(fits) {
            true => Ok(()),
            false => Err("a repetition of an activity of another width or class".to_owned()),
        }
    }

    /// Statistics of a window over rows of `layout`.
    pub fn statistics(layout: RowLayout) -> usize {
        windows::statistics(layout)
    }

    /// True if `class` is an activity.
    pub fn holds(&self, class: ClassId) -> bool {
        self.windows.classes.contains(&class)
    }

    /// For a rate of false alarms a minute.
    pub(super) fn with_sensitivity(&self, alarms_per_minute: f64) -> Self {
        let share = portable::powf(alarms_per_minute / USUAL_RATE, SHARE_EXPONENT) as f32;
        Self {
            share,
            ..self.clone()
        }
    }

    /// The part for rows that keep the columns `keep` of rows of `layout`.
    pub(super) fn restricted(&self, layout: RowLayout, keep: &[usize]) -> Self {
        let kept = windows::kept_statistics(layout, keep);
        let narrowed = |sample: &TemplateSample| TemplateSample {
            class: sample.class,
            rows: sample.rows.columns(keep),
        };
        Self {
            windows: self.windows.restricted(&kept),
            repetitions: self.repetitions.iter().map(narrowed).collect(),
            step: keep
                .iter()
                .filter_map(|&k| self.step.get(k).copied())
                .collect(),
            ..self.clone()
        }
    }
}
