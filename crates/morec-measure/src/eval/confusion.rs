//! Confusion matrix.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::decisions::Decision;

/// The decisions of [`ThesisAccuracy`](super::ThesisAccuracy), laid out: a row for each labelled class and a last
/// one for unlabelled stretches; a column for each class and a last one for no detection.
///
/// The last row holds unlabelled stretches with a detection, and in its last cell those rightly left alone. All
/// cells together are all decisions; those where row and column agree are the right ones.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Confusion {
    /// Classes of the rows, in order; the row for unlabelled stretches follows them.
    pub rows: Vec<String>,
    /// Classes of the columns, in order; the column for no detection follows them.
    pub columns: Vec<String>,
    /// Counts, `counts[row][column]`; one row and one column more than there are names.
    pub counts: Vec<Vec<usize>>,
}

/// Samples of one class that were taken for another.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Mistake {
    /// The class it was taken for.
    pub class: String,
    /// Number of times.
    pub count: usize,
}

impl Confusion {
    pub(super) fn new(decisions: &[Decision<'_>], classes: &BTreeSet<&str>) -> Self {
        let labelled: BTreeSet<&str> = decisions.iter().filter_map(|d| d.truth).collect();
        let index = |names: &BTreeSet<&str>| -> BTreeMap<String, usize> {
            names
                .iter()
                .enumerate()
                .map(|(i, name)| ((*name).to_owned(), i))
                .collect()
        };
        let (rows, columns) = (index(&labelled), index(classes));
        let mut counts = vec![vec![0; columns.len() + 1]; rows.len() + 1];
        for decision in decisions {
            let row = decision.truth.map_or(rows.len(), |class| rows[class]);
            let column = decision.found.map_or(columns.len(), |class| columns[class]);
            counts[row][column] += 1;
        }
        Self {
            rows: rows.into_keys().collect(),
            columns: columns.into_keys().collect(),
            counts,
        }
    }

    /// Classes that samples of `class` were taken for, most frequent first.
    pub fn mistakes(&self, class: &str) -> Vec<Mistake> {
        let Some(row) = self.rows.iter().position(|c| c == class) else {
            return Vec::new();
        };
        let mut mistakes: Vec<Mistake> = (self.columns.iter().zip(&self.counts[row]))
            .filter(|(name, count)| *name != class && **count > 0)
            .map(|(name, count)| Mistake {
                class: name.clone(),
                count: *count,
            })
            .collect();
        mistakes.sort_by(|a, b| b.count.cmp(&a.count).then_with(|| a.class.cmp(&b.class)));
        mistakes
    }

    /// Number of samples of `class` that no detection matched.
    pub fn missed(&self, class: &str) -> usize {
        let row = self.rows.iter().position(|c| c == class);
        row.and_then(|row| self.counts[row].last())
            .copied()
            .unwrap_or(0)
    }
}
