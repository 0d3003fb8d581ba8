//! Pivots that describe a pose.

use mocap::roles::Role;

use super::MAX_PIVOTS;

/// One joint that counts, and how to find it on a skeleton.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Pivot {
    /// Name of the pivot.
    pub name: String,
    /// Name of its parent pivot, which comes before it; `None` for the root alone.
    pub parent: Option<String>,
    /// Names of joints that play it, the likeliest first; compared without namespace and case where nothing
    /// fits exactly.
    #[serde(default)]
    pub joints: Vec<String>,
    /// The part of the body that plays it where no joint has such a name.
    #[serde(default)]
    pub role: Option<Role>,
}

/// Pivots in an order in which parents come first. Stored in an index with the model that was trained on it.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Vec<Pivot>", into = "Vec<Pivot>")]
pub struct PivotSet {
    pivots: Vec<Pivot>,
    parents: Vec<usize>,
}

/// Why pivots make no set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // The messages say it all.
pub enum PivotSetError {
    #[error("a pivot set has 1 to {MAX_PIVOTS} pivots, found {found}")]
    Count { found: usize },
    #[error("two pivots are called {name}")]
    Twice { name: String },
    #[error("the first pivot is the root and has no parent, found {name} under {parent}")]
    FirstIsNoRoot { name: String, parent: String },
    #[error("only the first pivot may be without a parent, found {name}")]
    SecondRoot { name: String },
    #[error("pivot {name} names {parent} as its parent, expected a pivot that comes before it")]
    Parent { name: String, parent: String },
}

impl PivotSet {
    /// A set of one's own choice: the root first, parents before their children.
    ///
    /// # Errors
    /// No pivot or more than [`MAX_PIVOTS`], names that occur twice, parents that do not come before.
    pub fn new(pivots: Vec<Pivot>) -> Result<Self, PivotSetError> {
        if !(1..=MAX_PIVOTS).contains(&pivots.len()) {
            return Err(PivotSetError::Count {
                found: pivots.len(),
            });
        }
        let mut parents = Vec::with_capacity(pivots.len());
        for (index, pivot) in pivots.iter().enumerate() {
            let before = &pivots[..index];
            if before.iter().any(|p| p.name == pivot.name) {
                return Err(PivotSetError::Twice {
                    name: pivot.name.clone(),
                });
            }
            parents.push(parent_of(pivot, before)?);
        }
        Ok(Self { pivots, parents })
    }

    /// A set of which the tests say that it is one.
    pub(super) fn known_good(pivots: Vec<Pivot>) -> Self {
        let place = |name: &str| pivots.iter().position(|p| p.name == name).unwrap_or(0);
        let parents = pivots
            .iter()
            .map(|p| p.parent.as_deref().map_or(0, place))
            .collect();
        Self { pivots, parents }
    }

    /// The set of the root and the pivots that `keep` chooses; the parent of each is the nearest of its ancestors
    /// that is chosen.
    pub fn keeping(&self, keep: impl Fn(&Pivot) -> bool) -> Self {
        let kept: Vec<bool> = (0..self.len())
            .map(|i| i == 0 || keep(&self.pivots[i]))
            .collect();
        let pivots = (0..self.len()).filter(|&i| kept[i]).map(|i| {
            let mut parent = self.parents[i];
            while !kept[parent] {
                parent = self.parents[parent];
            }
            Pivot {
                parent: (i > 0).then(|| self.pivots[parent].name.clone()),
                ..self.pivots[i].clone()
            }
        });
        Self::known_good(pivots.collect())
    }

    /// Index of the pivot of a name.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.pivots.iter().position(|p| p.name == name)
    }

    /// The pivots, parents first.
    pub fn pivots(&self) -> &[Pivot] {
        &self.pivots
    }

    /// Number of pivots.
    #[inline]
    pub fn len(&self) -> usize {
        self.pivots.len()
    }

    /// True if there is no pivot; never so.
    pub fn is_empty(&self) -> bool {
        self.pivots.is_empty()
    }

    /// Index of the parent of pivot `index`; the root's is the root itself.
    #[inline]
    pub fn parent(&self, index: usize) -> usize {
        self.parents[index]
    }

    /// Values in a pose row: four for each pivot.
    #[inline]
    pub fn row_dim(&self) -> usize {
        4 * self.len()
    }
}

/// Index in `before` of the parent that `pivot` names.
fn parent_of(pivot: &Pivot, before: &[Pivot]) -> Result<usize, PivotSetError> {
    let name = pivot.name.clone();
    match (&pivot.parent, before) {
        (None, []) => Ok(0),
        (None, _) => Err(PivotSetError::SecondRoot { name }),
        (Some(parent), []) => Err(PivotSetError::FirstIsNoRoot {
            name,
            parent: parent.clone(),
        }),
        (Some(parent), _) => before
            .iter()
            .position(|p| p.name == *parent)
            .ok_or_else(|| PivotSetError::Parent {
                name,
                parent: parent.clone(),
            }),
    }
}

impl TryFrom<Vec<Pivot>> for PivotSet {
    type Error = PivotSetError;

    fn try_from(pivots: Vec<Pivot>) -> Result<Self, PivotSetError> {
        Self::new(pivots)
    }
}

impl From<PivotSet> for Vec<Pivot> {
    fn from(set: PivotSet) -> Self {
        set.pivots
    }
}
