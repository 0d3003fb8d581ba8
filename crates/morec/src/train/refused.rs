//! Background motion that the trained index would still report becomes other motion of the second look.

use rayon::prelude::*;

use crate::features::Rows;
use crate::templates::second_look::{
    BodyTrack, NEAREST_OF_ATLAS, SecondLook, grown_of, segment_of,
};
use crate::templates::{PerformerKind, TemplateEngine, TemplateModel, TemplateModelError};

use super::params::TrainParams;
use super::set::{StreamKind, TrainSet};

/// What takes the place of a refused motion may be reported in turn; so often it is looked for at most.
const ROUNDS: usize = 6;
/// Most segments that are refused: each comparison looks at all of them.
const MOST: usize = 60;

/// Adds what `model` reports in background clips to the atlas of its second look, so that a motion nearer to it than to the samples is
/// refused. A model without an atlas stays as it is: there the bound alone follows the background. O(rounds · background).
///
/// # Errors
/// As [`TemplateModel::check`].
pub fn refuse(
    model: &mut TemplateModel,
    set: &TrainSet,
    params: &TrainParams,
) -> Result<(), TemplateModelError> {
    let mut refused = 0;
    for _ in 0..ROUNDS {
        let Some(look) = model.look.clone().filter(|look| !look.atlas.is_empty()) else {
            return Ok(());
        };
        let segments = reported(model, set, params)?;
        let left = segments.iter().take(MOST - refused);
        if left.len() == 0 {
            return Ok(());
        }
        refused += left.len();
        // The distance that counts is that of the third nearest: each is there as often.
        let rows = left.flat_map(|rows| [rows; NEAREST_OF_ATLAS]);
        let mut values = look.atlas.clone().into_values();
        rows.for_each(|rows| values.extend_from_slice(rows.values()));
        let look = SecondLook {
            atlas: Rows::from_values(look.atlas.dim(), values),
            ..look
        };
        model.look = Some(match params.compact {
            true => look.compacted(),
            false => look,
        });
    }
    Ok(())
}

/// Segments that are reported in background clips, the likeliest first.
fn reported(
    model: &TemplateModel,
    set: &TrainSet,
    params: &TrainParams,
) -> Result<Vec<Rows>, TemplateModelError> {
    let look = model.look.clone().map(|look| SecondLook {
        performer: PerformerKind::Anyone,
        ..look
    });
    let judged = TemplateModel {
        look,
        held: None,
        activities: None,
        ..model.clone()
    };
    let engine = TemplateEngine::new(&judged)?;
    let columns = BodyTrack::columns(model.bones);
    let of_rows = |rows: &Rows| {
        let mut found = Vec::new();
        engine
            .clone()
            .detect(rows, |detection| found.push(*detection));
        let mut track = BodyTrack::new(model.bones, &params.features, rows.len());
        rows.iter().for_each(|row| track.push(row));
        // What is judged the next time may be another growth of the same motion.
        let segments = found.into_iter().flat_map(|d| {
            let ticks = d.start.max(0) as usize..d.stop.max(0) as usize;
            let [short, long] = grown_of(&track, &ticks);
            let mut spans = vec![ticks, short, long];
            spans.dedup();
            let of_span = |ticks| (d.score, segment_of(&track, ticks, &columns));
            spans.into_iter().map(of_span).collect::<Vec<_>>()
        });
        segments.collect::<Vec<_>>()
    };
    let background = set.streams.par_iter();
    let background = background.filter(|stream| stream.source == StreamKind::Background);
    let mut segments: Vec<(f64, Rows)> = background.flat_map_iter(|s| of_rows(&s.rows)).collect();
    segments.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(segments.into_iter().map(|(_, rows)| rows).collect())
}
