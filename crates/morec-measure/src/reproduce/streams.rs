//! §5.4: whole clips as streams.

use std::sync::Arc;

use serde::Serialize;

use crate::crossval::{CrossvalData, FoldBy, crossval};
use crate::eval::{Evaluation, Timeline, timelines};
use crate::plot::{Bar, LaneChart};
use crate::report::pictures::confidence_picture;
use morec::live::Model;
use morec::svrdm::{ConfidenceMap, SvrdmEngine, SvrdmModel};
use morec::train::StreamKind;

use morec::train::thesis::SvrdmOptions;

use super::study::{Picture, ReproduceError, Study, rows_of};
use morec::train::thesis::Setting;

/// One half split.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Streamed {
    /// Setting of the recogniser's training.
    pub setting: Setting,
    /// Seed of the split.
    pub seed: u64,
    /// Every measure.
    pub evaluation: Evaluation,
}

/// Clips that are drawn: those with most samples.
const DRAWN: usize = 4;

pub(super) fn run(
    study: &Study<'_>,
    (setting, options): &(Setting, SvrdmOptions),
    seed: u64,
    pictures: &mut Vec<Picture>,
) -> Result<Streamed, ReproduceError> {
    let material = CrossvalData {
        clips: study.clips,
        samples: study.samples,
        classes: study.classes,
        unknown: study.unknown,
        tests: None,
    };
    let outcome = crossval(
        &material,
        &FoldBy::Half { seed }.into(),
        &options.clone().into(),
        &(),
    )?;
    let tested = &outcome.tested;
    let evaluation = Evaluation::of(&tested.streams, &tested.truths, &tested.founds)?;
    let mut lines = timelines(&tested.streams, &tested.truths, &tested.founds)?;
    // Clips with many samples show most; the others would be one bar each.
    lines.sort_by_key(|line| std::cmp::Reverse(line.truths.len()));
    for line in lines.iter().take(DRAWN) {
        pictures.push(timeline_picture(study, *setting, line));
    }
    let longest = lines.first().map(|line| line.stream.clip.clone());
    if let (Some(Model::Svrdm(model)), Some(clip)) = (outcome.models.first(), longest) {
        pictures.extend(map_picture(study, *setting, model, &clip)?);
    }
    Ok(Streamed {
        setting: *setting,
        seed,
        evaluation,
    })
}

fn timeline_picture(study: &Study<'_>, setting: Setting, line: &Timeline) -> Picture {
    let kind = |class: &str| {
        study
            .classes
            .iter()
            .position(|c| c == class)
            .unwrap_or(study.classes.len())
    };
    let bar = |class: &str, span| Bar {
        span,
        kind: kind(class),
    };
    let (name, clip) = (setting.name(), &line.stream.clip);
    let title = format!("{clip}, {name}: labels and detections");
    let svg = LaneChart::new(title, study.classes.to_vec(), line.stream.duration_secs)
        .lane(
            "labelled",
            line.truths.iter().map(|(t, _)| bar(&t.class, t.span)),
        )
        .lane(
            "recognised",
            line.founds.iter().map(|(f, _)| bar(&f.class, f.span)),
        )
        .svg();
    let caption = format!("{name}: {clip} as a stream (Figs. 5.13 and 5.14)");
    Picture {
        name: format!("{name}_timeline_{clip}"),
        caption,
        svg,
        table: None,
    }
}

/// The map of confidences of one clip (Fig. 4.3).
fn map_picture(
    study: &Study<'_>,
    setting: Setting,
    model: &Arc<SvrdmModel>,
    name: &str,
) -> Result<Option<Picture>, ReproduceError> {
    let Some(clip) = study
        .clips
        .iter()
        .find(|c| c.name == name && c.source == StreamKind::Labelled)
    else {
        return Ok(None);
    };
    let rows = rows_of(clip, &model.pivots, &model.pose)?;
    let mut engine = SvrdmEngine::new(model).map_err(|e| ReproduceError::Other(e.to_string()))?;
    let mut cells = ConfidenceMap::new();
    rows.iter().for_each(|row| {
        engine.push_with_observer(
            row,
            &mut |window, cell| cells.record(window, cell),
            &mut |_| (),
        );
    });
    let setting = setting.name();
    let title = format!("{name}, {setting}: confidence of every segment");
    Ok(Some(Picture {
        name: format!("{setting}_map_{name}"),
        caption: format!("{setting}: confidences of {name}'s segments (Fig. 4.3)"),
        svg: confidence_picture(
            &cells,
            &title,
            &model.classes,
            &model.params,
            model.rate_hz(),
        )
        .svg(),
        table: Some(map_table(&cells, model)),
    }))
}

/// The map as text: a line for each segment that is some class.
fn map_table(map: &ConfidenceMap, model: &SvrdmModel) -> String {
    let chunk_secs = model.params.chunk_frames as f64 / model.rate_hz();
    let mut out = "start_secs\tstop_secs\tclass\tconfidence\n".to_owned();
    for (window, cell) in map.cells() {
        let (start, stop) = (
            window.start as f64 * chunk_secs,
            window.stop as f64 * chunk_secs,
        );
        let class = &model.classes[cell.class.index()].name;
        out.push_str(&format!(
            "{start:.4}\t{stop:.4}\t{class}\t{:.6}\n",
            cell.confidence
        ));
    }
    out
}
