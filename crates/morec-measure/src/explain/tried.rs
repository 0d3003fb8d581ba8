//! Finds the rate of false alarms at which a missed sample is reported. Each rate is tried with a real recogniser, because scores
//! alone would promise too much.

use crate::eval::EVENT_TOLERANCE_SECS;
use morec::clip::{Clip, Span};
use morec::labels::Mark;
use morec::live::{Detection, Model, RecognizerCache};
use morec::roles::RoleMap;
use morec::templates::{OperatingPoint, TemplateModel};

/// For each of `sought` in a clip the smallest noted rate, no smaller than the wanted one, at which it is reported; none where no rate
/// is wanted or helps. O(rates) recognitions of the clip, none if nothing is wanted.
pub(super) fn least_that_help(
    model: &TemplateModel,
    clip: (&Clip, &RoleMap, &Span),
    sought: &[Mark<&str>],
    mut wanted: Vec<Option<f64>>,
) -> Vec<Option<f64>> {
    let mut help = vec![None; sought.len()];
    for rate in rates_of(model) {
        let waits = |least: &Option<f64>| least.is_some_and(|least| least <= rate);
        if !wanted.iter().any(waits) {
            continue;
        }
        let Some(found) = found_at(model, rate, clip) else {
            break;
        };
        for ((sought, least), helps) in sought.iter().zip(&mut wanted).zip(&mut help) {
            if waits(least) && found.iter().any(|d| is_of(model, d, sought)) {
                (*least, *helps) = (None, Some(rate));
            }
        }
    }
    help
}

/// True if a detection is an event of the sample, as [`EVENT_TOLERANCE_SECS`] says.
fn is_of(model: &TemplateModel, found: &Detection, sought: &Mark<&str>) -> bool {
    let middle = found.span.middle_secs();
    model.classes[found.class.index()].name == sought.class
        && middle >= sought.span.start_secs - EVENT_TOLERANCE_SECS
        && middle <= sought.span.stop_secs + EVENT_TOLERANCE_SECS
}

/// The noted rates that a sensitivity chooses among, rising.
fn rates_of(model: &TemplateModel) -> Vec<f64> {
    let points: &[OperatingPoint] = match &model.look {
        Some(look) => &look.operating,
        None => &model.operating,
    };
    let mut rates: Vec<f64> = points.iter().map(|p| p.alarms_per_minute).collect();
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    rates
}

/// What is reported of a clip at a rate.
fn found_at(
    model: &TemplateModel,
    rate: f64,
    (clip, roles, rest): (&Clip, &RoleMap, &Span),
) -> Option<Vec<Detection>> {
    let model: Model = model.with_sensitivity(rate)?.into();
    RecognizerCache::new(&model)
        .recognize_clip(clip, roles, rest)
        .ok()
}
