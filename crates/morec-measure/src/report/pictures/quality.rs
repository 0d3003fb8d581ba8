//! Share of the variance by number of principal components.

use crate::plot::Chart;
use morec::pca::QualityRow;

/// The quality table as a curve, with the dimensions kept (`dims`) marked.
pub fn quality_chart(table: &[QualityRow], dims: usize, title: &str) -> Chart {
    let curve = table.iter().map(|row| (row.dims as f64, row.quality));
    Chart::new(title)
        .axes("dimensions", "share of the variance")
        .line("kept", std::iter::once((0.0, 0.0)).chain(curve))
        .marks("chosen", [dims as f64])
}
