//! The misfit over time, with the cuts that follow from it.

use crate::plot::Chart;
use morec::segment::{MisfitSample, Segmentation};

/// `H` over time with the cuts marked, and beside them the `known` ones (seconds) where there are any. `H` spans
/// powers of ten, so its logarithm is drawn.
pub fn misfit_chart(segmentation: &Segmentation, title: &str, known: &[f64]) -> Chart {
    let line = |points: &[MisfitSample]| -> Vec<(f64, f64)> {
        points
            .iter()
            .map(|p| (p.secs, p.value.max(1e-3).log10()))
            .collect()
    };
    let mut chart = Chart::new(title).axes("time, s", "log10 H");
    for (name, points) in [
        ("forward", &segmentation.forward),
        ("backward", &segmentation.backward),
    ] {
        if !points.is_empty() {
            chart = chart.line(name, line(points));
        }
    }
    chart = chart.marks("cuts", segmentation.cuts.iter().map(|c| c.secs));
    if known.is_empty() {
        chart
    } else {
        chart.marks("known", known.iter().copied())
    }
}
