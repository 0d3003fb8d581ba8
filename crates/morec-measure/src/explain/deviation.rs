//! Compares the recognised motions of a clip with their nearest samples, bone by bone.

use morec::TimeSpan;
use morec::clip::{Clip, Span};
use morec::features::{Rows, all_bones_of_clip, rows_of_clip};
use morec::live::{Detection, Model};
use morec::roles::RoleMap;
use morec::templates::{DeviationMeter, MotionDeviation, TemplateModel, TemplateSample};

/// A motion of a clip and how well it was performed.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Performance {
    /// Name of its clip.
    pub clip: String,
    /// Name of its class.
    pub class: String,
    /// When it happened, on the clip's clock.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// It against the nearest sample.
    pub deviation: MotionDeviation,
}

/// Compares each of the motions `found` in `clip` with the sample of its class that it is nearest to, bone by bone; `None` where no samples
/// are kept: for activities, held poses and the method of 2009. `rest` are the frames that a conversion left at the start.
/// O(motions · samples · rows²).
pub fn deviation(
    model: &Model,
    (clip, roles, rest): (&Clip, &RoleMap, &Span),
    found: &[Detection],
) -> Vec<Option<MotionDeviation>> {
    let nothing = || vec![None; found.len()];
    let Model::Templates(model) = model else {
        return nothing();
    };
    let roles = &roles.for_bones(&clip.skeleton, model.bones);
    let Ok(model) = model.restricted(all_bones_of_clip(clip, roles, rest)) else {
        return nothing();
    };
    let rows = rows_of_clip(clip, roles, rest, model.bones, &model.features);
    let mut meter = DeviationMeter::new(model.bones, model.features.tick_hz());
    let each = found
        .iter()
        .map(|d| of_motion(&model, &mut meter, &rows, d));
    each.collect()
}

fn of_motion(
    model: &TemplateModel,
    meter: &mut DeviationMeter,
    rows: &Rows,
    found: &Detection,
) -> Option<MotionDeviation> {
    let hz = model.features.tick_hz();
    let ticks = found.span.frames_among(rows.len(), hz);
    let stretch = rows.slice(ticks.clone());
    let start_secs = ticks.start as f64 / hz;
    let samples = TemplateSample::rows_of(&model.samples, found.class);
    meter.compare(samples, &stretch, false)?;
    Some(meter.motion(start_secs))
}
