//! The map of confidences over starts and ends of segments (thesis, Fig. 4.3).

use crate::plot::HeatMap;
use morec::classes::ClassInfo;
use morec::svrdm::{ConfidenceMap, SvrdmParams};

/// The map as a picture: start across, length upwards (Fig. 4.3 has the end there; the map is a narrow band
/// along its diagonal), coloured by class.
pub fn confidence_picture(
    map: &ConfidenceMap,
    title: &str,
    classes: &[ClassInfo],
    params: &SvrdmParams,
    rate_hz: f64,
) -> HeatMap {
    let chunk_secs = params.chunk_frames as f64 / rate_hz;
    let starts = map
        .cells()
        .iter()
        .map(|(window, _)| window.start as usize + 1)
        .max()
        .unwrap_or(1);
    let lengths = params.lengths();
    let (mut values, mut kinds) = (vec![f64::NAN; starts * lengths], vec![0; starts * lengths]);
    for (window, cell) in map.cells() {
        // The longest on top.
        let at = (params.max_chunks - window.chunks()) * starts + window.start as usize;
        (values[at], kinds[at]) = (cell.confidence, cell.class.index());
    }
    let rows = (params.min_chunks..=params.max_chunks)
        .rev()
        .map(|k| format!("{:.2} s", k as f64 * chunk_secs));
    HeatMap::new(title, starts, values)
        .axes("start, s", "length")
        .names(rows.collect(), vec![])
        .kinds(
            kinds,
            classes.iter().map(|class| class.name.clone()).collect(),
        )
        .x_range(0.0, starts as f64 * chunk_secs)
}
