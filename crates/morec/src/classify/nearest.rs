//! Distances to each class by the nearest match of its templates.

use crate::classes::ClassId;
use crate::decode::FAR;
use crate::features::Rows;
use crate::templates::{TemplateModel, TemplateModelError, Trace};

use super::distances::ClipDistances;

/// For each class, the distance of its nearest template anywhere in the clip, among matches that move more than a body at rest.
///
/// # Errors
/// The rows have another width than the model's templates.
pub fn distances(model: &TemplateModel, rows: &Rows) -> Result<ClipDistances, TemplateModelError> {
    let mut trace = Trace::of(model, rows)?;
    let of_class = |class: usize| {
        let class = ClassId(class as u16);
        let near = |tick: &usize| trace.moving(*tick, class).comparison.distance;
        let tick = (0..trace.ticks()).min_by(|a, b| near(a).total_cmp(&near(b)))?;
        (near(&tick) < FAR).then(|| (tick, near(&tick)))
    };
    let best: Vec<Option<(usize, f32)>> = (0..model.classes.len()).map(of_class).collect();
    let share = |class: usize| {
        let own = model.class_thresholds.get(class);
        let threshold = own.copied().unwrap_or(model.threshold);
        best[class].map_or(f32::INFINITY, |(_, distance)| distance / threshold)
    };
    let classes: Vec<f32> = (0..best.len()).map(share).collect();
    let nearest = (0..best.len()).min_by(|a, b| classes[*a].total_cmp(&classes[*b]));
    let verified = nearest.and_then(|class| {
        let (tick, _) = best[class]?;
        Some(trace.verify(tick, ClassId(class as u16))?.0)
    });
    Ok(ClipDistances { classes, verified })
}
