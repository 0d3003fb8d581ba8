//! Training in one call: takes and labels in, an index out.

use std::collections::BTreeSet;

use crate::Error;
use crate::import::Take;
use crate::index::{MotionIndex, Provenance};
use crate::labels::{Labels, People};
use crate::progress::Progress;

use super::{
    LabelSet, Recipe, StreamKind, TrainClip, TrainOptions, TrainingData, TrainingMaterial,
    TrainingReport, train_model,
};

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

    /// Another method, or other options: [`TrainOptions`] or [`SvrdmOptions`](super::thesis::SvrdmOptions).
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
    /// Takes and labels that do not fit together ([`DataError`](super::DataError)); too little to learn from, or options
    /// out of bounds ([`TrainError`](super::TrainError)).
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

/// Trains on `data` as `recipe` says.
///
/// # Errors
/// Too little to learn from, options out of bounds, or the listener of `progress` cancelled.
pub fn train_index(
    data: &TrainingData,
    recipe: &Recipe,
    progress: &dyn Progress,
) -> Result<(MotionIndex, TrainingReport), super::TrainError> {
    let labelling = LabelSet {
        samples: &data.samples,
        held_back: &[],
        classes: &data.classes,
        unlabelled_is_background: recipe.unlabelled_is_background(),
    };
    let (model, report) = train_model(&data.clips, &labelling, recipe, progress)?;
    let index = MotionIndex {
        model,
        roles: data.role_names(),
        provenance: Provenance {
            created: now(),
            morec_version: env!("CARGO_PKG_VERSION").to_owned(),
            clips: data.labelled().map(|c| c.name.clone()).collect(),
            samples: data.samples.len(),
            background_secs: report.background_secs.clone(),
        },
    };
    Ok((index, report))
}

/// The present time in UTC to the second, `2026-11-21T04:46:50Z`; the one that `SOURCE_DATE_EPOCH` sets (seconds since
/// 1970), so that training again gives the same bytes.
fn now() -> String {
    let fixed = std::env::var("SOURCE_DATE_EPOCH").ok();
    let fixed = fixed.and_then(|secs| jiff::Timestamp::from_second(secs.parse().ok()?).ok());
    let now = fixed.unwrap_or_else(jiff::Timestamp::now);
    now.strftime("%FT%TZ").to_string()
}
