//! A trained recogniser of the thesis's kind: what an index file holds for this method.

use crate::pca::Pca;
use crate::pivots::{PivotSet, PoseParams};
use morec_features::{ClassId, ClassInfo};

use super::MAX_DIM;
use super::{MAX_PROFILE_FRAMES, Node, SvrdmParams, Tree};

/// Everything this recogniser needs, immutable (thesis, §4.7.2, lists the same).
///
/// Notation: `D` values in a pose row, `r` after projection, `k` directions, `n = k · r` values in a feature vector.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SvrdmModel {
    /// The classes; a [`ClassId`] is an index into this.
    pub classes: Vec<ClassInfo>,
    /// Joints of a pose row.
    pub pivots: PivotSet,
    /// Parameters of pose rows; their rate is the model's.
    pub pose: PoseParams,
    /// From `D` values to `r`.
    pub pca: Pca,
    /// Parameters of the stages.
    pub params: SvrdmParams,
    /// Sign vectors (thesis, Alg. 5): `k × r`, one after the other.
    pub signs: Vec<f64>,
    /// Feature vectors to classes.
    pub tree: Tree,
    /// The training samples' profiles.
    pub profiles: Profiles,
    /// For each class, its samples' mean length.
    pub mean_secs: Vec<f64>,
    /// Profile values match if they differ by at most this.
    pub epsilon: f32,
}

/// Profiles of training samples: what segments are compared with ([`SegmentDistance`](super::SegmentDistance)). In the thesis
/// ("motion vectors") each sample's rows projected on its own first direction.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Profiles {
    /// Values in a row; 1 in the thesis.
    #[serde(default = "one")]
    pub width: usize,
    /// All values end to end.
    pub values: Vec<f32>,
    /// Step of each column, if values were rounded to multiples of it, as in a file of whole rows.
    #[serde(default)]
    pub step: Option<Vec<f32>>,
    /// For each profile, its length in rows.
    pub lengths: Vec<usize>,
    /// For each profile, the class of its sample.
    pub classes: Vec<ClassId>,
}

fn one() -> usize {
    1
}

impl Profiles {
    /// None so far, of rows of `width` values.
    pub fn new(width: usize) -> Self {
        Self {
            width: width.max(1),
            values: vec![],
            step: None,
            lengths: vec![],
            classes: vec![],
        }
    }

    /// Adds a sample's.
    pub fn push(&mut self, class: ClassId, profile: &[f32]) {
        self.values.extend_from_slice(profile);
        self.lengths.push(profile.len() / self.width);
        self.classes.push(class);
    }

    /// The same profiles with every value at a multiple of its column's step, 127 of which make its largest value: a
    /// byte a value. Rows are many, and an edit distance does not see the difference.
    #[must_use]
    pub fn in_steps(&self) -> Self {
        let mut most = vec![0.0f32; self.width];
        for row in self.values.chunks_exact(self.width) {
            most.iter_mut()
                .zip(row)
                .for_each(|(most, v)| *most = most.max(v.abs()));
        }
        let step: Vec<f32> = most.into_iter().map(|most| most / 127.0).collect();
        let round = |(v, step): (&f32, &f32)| {
            if *step > 0.0 {
                (v / step).round() * step
            } else {
                0.0
            }
        };
        let values = self
            .values
            .chunks_exact(self.width)
            .flat_map(|row| row.iter().zip(&step).map(round));
        Self {
            values: values.collect(),
            step: Some(step),
            ..self.clone()
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.lengths.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.lengths.is_empty()
    }

    /// Each with its class, in order.
    pub fn iter(&self) -> impl Iterator<Item = (ClassId, &[f32])> {
        let mut rest = &self.values[..];
        self.lengths
            .iter()
            .zip(&self.classes)
            .map(move |(length, class)| {
                let (profile, after) = rest.split_at((length * self.width).min(rest.len()));
                rest = after;
                (*class, profile)
            })
    }

    /// ε: `tolerance` times the root mean square distance of all rows from their mean; the standard deviation where
    /// rows are single values (thesis, §3.8).
    pub fn epsilon(&self, tolerance: f64) -> f32 {
        let rows = (self.values.len() / self.width).max(1) as f64;
        let mut mean = vec![0.0; self.width];
        for row in self.values.chunks_exact(self.width) {
            mean.iter_mut()
                .zip(row)
                .for_each(|(mean, v)| *mean += f64::from(*v) / rows);
        }
        let deviation = |row: &[f32]| -> f64 {
            row.iter()
                .zip(&mean)
                .map(|(v, mean)| (f64::from(*v) - mean).powi(2))
                .sum()
        };
        let squares: f64 = self.values.chunks_exact(self.width).map(deviation).sum();
        (tolerance * (squares / rows).sqrt()) as f32
    }
}

/// Parts that do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// A table has another size than others ask for.
    #[error("{what}: expected {expected}, found {found}")]
    Size {
        /// Name of the table.
        what: &'static str,
        /// Number that the other tables ask for.
        expected: usize,
        /// Number found.
        found: usize,
    },
    /// A number that must be sensible is not.
    #[error("{0}")]
    Value(String),
}

impl SvrdmModel {
    /// Frames a second of rows and everything after them.
    pub fn rate_hz(&self) -> f64 {
        self.pose.rate_hz
    }

    /// Checks that all parts fit together. O(size).
    ///
    /// # Errors
    /// The first part that does not fit the others.
    pub fn check(&self) -> Result<(), ModelError> {
        self.pose.check().map_err(ModelError::Value)?;
        self.params.check().map_err(ModelError::Value)?;
        let (dim, reduced) = (self.pivots.row_dim(), self.pca.dims());
        if reduced < self.params.eigenvectors || reduced > MAX_DIM {
            let (low, high) = (self.params.eigenvectors, MAX_DIM);
            return Err(value(format!(
                "reduced rows must have {low} to {high} values, found {reduced}"
            )));
        }
        // First of all the lengths, which are summed up below.
        if let Some(length) = self
            .profiles
            .lengths
            .iter()
            .find(|l| !(1..=MAX_PROFILE_FRAMES).contains(*l))
        {
            return Err(value(format!(
                "a profile must have 1 to {MAX_PROFILE_FRAMES} frames, found {length}"
            )));
        }
        let feature_dim = self.params.feature_dim(reduced);
        let profiles = &self.profiles;
        let sizes = [
            ("values in a row that is projected", dim, self.pca.dim()),
            ("values in the sign vectors", feature_dim, self.signs.len()),
            (
                "values in a feature vector of the tree",
                feature_dim,
                self.tree.dim(),
            ),
            (
                "mean lengths of classes",
                self.classes.len(),
                self.mean_secs.len(),
            ),
            (
                "steps of profiles",
                profiles.width,
                profiles.step.as_ref().map_or(profiles.width, Vec::len),
            ),
            (
                "classes of profiles",
                profiles.len(),
                profiles.classes.len(),
            ),
            (
                "values in a profile's row",
                self.params.comparison.width(reduced),
                profiles.width,
            ),
            (
                "values of profiles",
                profiles.lengths.iter().sum::<usize>() * profiles.width,
                profiles.values.len(),
            ),
        ];
        if let Some((what, expected, found)) = sizes.into_iter().find(|(_, e, f)| e != f) {
            return Err(ModelError::Size {
                what,
                expected,
                found,
            });
        }
        self.check_values()?;
        self.check_classes()
    }

    fn check_values(&self) -> Result<(), ModelError> {
        if self.signs.iter().any(|v| !v.is_finite())
            || self.profiles.values.iter().any(|v| !v.is_finite())
        {
            return Err(value(
                "a sign vector or profile contains a value that is not finite".to_owned(),
            ));
        }
        if !(self.epsilon.is_finite() && self.epsilon >= 0.0) {
            return Err(value(format!(
                "epsilon must be 0 or more, found {}",
                self.epsilon
            )));
        }
        match self
            .mean_secs
            .iter()
            .find(|mean| !(mean.is_finite() && **mean > 0.0))
        {
            Some(mean) => Err(value(format!(
                "a class's mean length must be above 0 s, found {mean}"
            ))),
            None => Ok(()),
        }
    }

    fn check_classes(&self) -> Result<(), ModelError> {
        let count = self.classes.len();
        let leaves = self.tree.nodes().iter().filter_map(|node| match node {
            Node::Leaf(class) => Some(*class),
            Node::Branch(_) => None,
        });
        let named = leaves.chain(self.profiles.classes.iter().copied());
        if let Some(class) = named.into_iter().find(|class| class.index() >= count) {
            return Err(value(format!(
                "the tree or a profile is of class {}, of {count}",
                class.0
            )));
        }
        match (0..count).find(|index| {
            !self
                .profiles
                .classes
                .iter()
                .any(|class| class.index() == *index)
        }) {
            Some(index) => Err(value(format!(
                "class {} has no profile",
                self.classes[index].name
            ))),
            None => Ok(()),
        }
    }
}

fn value(message: String) -> ModelError {
    ModelError::Value(message)
}
