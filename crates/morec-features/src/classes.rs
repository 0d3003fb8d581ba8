//! The classes of an index.

use std::fmt;

/// Number of a class in one index.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(transparent)]
pub struct ClassId(pub u16);

impl ClassId {
    /// Its place in a list of classes.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

impl fmt::Display for ClassId {
    /// `class 3`; its name is the index's.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "class {}", self.0)
    }
}

/// A class and what it was learned from.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ClassInfo {
    /// Its name in the labels.
    pub name: String,
    /// Number of samples it was learned from.
    pub samples: usize,
    /// Number of people in these, as far as they were named; 0 if nobody was.
    pub people: usize,
}
