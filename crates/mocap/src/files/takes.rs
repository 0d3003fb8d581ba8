//! Reads the takes of many files in parallel.

use std::ops::Deref;

use crate::import::Take;

use super::FileError;

/// The takes of many files, and the files that could not be used. A slice of [`Take`]s.
#[derive(Debug, Default)]
pub struct Takes {
    /// In the order of the files, those of a file in its order.
    pub takes: Vec<Take>,
    /// Motion files that could not be used, with the reason.
    pub refused: Vec<FileError>,
    /// Number of files in folders that are no motion at all.
    pub others: usize,
}

impl Deref for Takes {
    type Target = [Take];

    fn deref(&self) -> &[Take] {
        &self.takes
    }
}

impl IntoIterator for Takes {
    type Item = Take;
    type IntoIter = std::vec::IntoIter<Take>;

    fn into_iter(self) -> Self::IntoIter {
        self.takes.into_iter()
    }
}

impl<'a> IntoIterator for &'a Takes {
    type Item = &'a Take;
    type IntoIter = std::slice::Iter<'a, Take>;

    fn into_iter(self) -> Self::IntoIter {
        self.takes.iter()
    }
}
