//! [`Trainer`](crate::Trainer): clips and labels in, an index out, in one call.

use std::collections::BTreeSet;

use crate::import::Take;
use crate::index::MotionIndex;
use crate::labels::{Labels, People};
use crate::progress::Progress;
use crate::train::{
    Recipe, StreamKind, TrainClip, TrainOptions, TrainingMaterial, TrainingReport, train_index,
};

use super::Error;

/// Data and options of training. Only the labels must be given.
///
/// ```no_run
/// # fn main() -> Result<(), morec::Error> {
/// let takes = morec::files::open_all("clips/")?;
/// let idle = morec::files::open_all("background/")?;
/// let labels = morec::Labels::from_path("labels.tsv")?;
/// let trainer = morec::Trainer::new().labels(&labels).background(&idle);
/// let (index, report) = trainer.train_with_report(&takes)?;
/// for note in &report.notes {
///     eprintln!("{note}");
/// }
/// index.save("signs.index")?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Trainer<'a> {
    labels: Option<&'a Labels>,
    people: Option<&'a People>,
    background: &'a [Take],
    classes: Vec<String>,
    method: Recipe,
    progress: &'a dyn Progress,
}

impl Default for Trainer<'_> {
    fn default() -> Self {
        Self {
            labels: None,
            people: None,
            background: &[],
            classes: Vec::new(),
            method: TrainOptions::default().into(),
            progress: &(),
        }
    }
}

impl<'a> Trainer<'a> {
    /// A trainer of templates, with every class of the labels.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the labelled samples.
    #[must_use]
    pub fn labels(mut self, labels: &'a Labels) -> Self {
        self.labels = Some(labels);
        self
    }

    /// Sets the person of each take, where the labels do not say.
    #[must_use]
    pub fn people(mut self, people: &'a People) -> Self {
        self.people = Some(people);
        self
    }

    /// Takes that hold none of the classes: what comes near the classes in them sets the thresholds.
    #[must_use]
    pub fn background(mut self, takes: &'a [Take]) -> Self {
        self.background = takes;
        self
    }

    /// Only these classes, in this order.
    #[must_use]
    pub fn classes(mut self, classes: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.classes = classes.into_iter().map(Into::into).collect();
        self
    }

    /// Another method, or other options: [`TrainOptions`] or [`SvrdmOptions`](crate::train::thesis::SvrdmOptions).
    #[must_use]
    pub fn method(mut self, method: impl Into<Recipe>) -> Self {
        self.method = method.into();
        self
    }

    /// Sets the receiver of progress, which may cancel.
    #[must_use]
    pub fn progress(mut self, progress: &'a dyn Progress) -> Self {
        self.progress = progress;
        self
    }

    /// Trains on `takes`.
    ///
    /// # Errors
    /// Takes and labels that do not fit together ([`DataError`](crate::train::DataError)); too little to learn from, or options
    /// out of bounds ([`TrainError`](crate::train::TrainError)).
    pub fn train(&self, takes: &[Take]) -> Result<MotionIndex, Error> {
        Ok(self.train_with_report(takes)?.0)
    }

    /// Trains on `takes` and says how it went; its notes also name labels and takes that were not used.
    ///
    /// # Errors
    /// As [`train`](Self::train).
    pub fn train_with_report(
        &self,
        takes: &[Take],
    ) -> Result<(MotionIndex, TrainingReport), Error> {
        let clip = |take: &Take, source| TrainClip {
            source,
            ..take.clone().into()
        };
        let taught = takes.iter().map(|take| clip(take, StreamKind::Labelled));
        let background = self.background.iter();
        let background = background.map(|take| clip(take, StreamKind::Background));
        let none = Labels::default();
        let material = TrainingMaterial {
            labels: self.labels.unwrap_or(&none),
            people: self.people,
            classes: &self.classes,
            unknown: &BTreeSet::new(),
        };
        let data = material.sort_out(taught.chain(background).collect())?;
        let (index, mut report) = train_index(&data, &self.method, self.progress)?;
        report.notes.extend(data.notes);
        Ok((index, report))
    }
}
