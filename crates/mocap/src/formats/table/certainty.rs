//! Gaps for points to which a pose estimator gave a low likelihood.

use super::layout::{ColumnLayout, IN_PLANE, TableLine};
use crate::formats::cells::{Decimal, number};

/// The least likelihood of a point that counts as seen: the usual bound of DeepLabCut's own evaluations.
const LEAST: f64 = 0.6;

/// Empties the cells of points whose likelihood, in the column after their axes, is low. Returns a warning with their number.
pub(super) fn without_doubtful(rows: &mut [TableLine], layout: &ColumnLayout) -> Option<String> {
    let last_row = layout.header_rows.checked_sub(1);
    let header: Vec<&str> = last_row
        .and_then(|row| rows.get(row))
        .map_or_else(Vec::new, |(_, cells)| cells.clone());
    let is_likelihood = |column: usize| {
        let label = header.get(column).map(|label| label.to_ascii_lowercase());
        label.is_some_and(|label| label.ends_with("likelihood"))
    };
    let with_likelihood = layout.points.iter().filter_map(|(_, axes)| {
        let last = axes.iter().filter(|axis| **axis != IN_PLANE).max()?;
        is_likelihood(last + 1).then_some((*axes, last + 1))
    });
    let doubted: Vec<([usize; 3], usize)> = with_likelihood.collect();
    let (mut emptied, mut all) = (0usize, 0usize);
    for (_, cells) in rows.iter_mut().skip(layout.header_rows) {
        for (axes, likelihood) in &doubted {
            let found = cells.get(*likelihood);
            let Some(found) = found.and_then(|cell| number(cell, Decimal::Either)) else {
                continue;
            };
            all += 1;
            if found >= LEAST {
                continue;
            }
            emptied += 1;
            for axis in axes {
                if let Some(cell) = cells.get_mut(*axis) {
                    *cell = "";
                }
            }
        }
    }
    (emptied > 0).then(|| {
        format!(
            "{emptied} of {all} places of points have a likelihood below {LEAST}; taken as gaps"
        )
    })
}
