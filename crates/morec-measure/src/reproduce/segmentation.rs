//! §5.1: cutting clips without labels.

use morec::TimeSpan;
use rayon::prelude::*;
use serde::Serialize;

use crate::plot::{Bar, LaneChart};
use morec::pivots::{PivotSet, PoseParams};
use morec::segment::{PpcaParams, segment};
use morec::train::{StreamKind, TrainClip};

use super::study::{Picture, ReproduceError, Study, rows_of};

/// A clip and where it was cut.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Segmented {
    /// Name of the clip.
    pub clip: String,
    /// Length, seconds.
    pub secs: f64,
    /// Labelled samples in it.
    pub samples: usize,
    /// Positions of the cuts.
    pub cuts_secs: Vec<f64>,
    /// Labelled samples that have a segment for themselves: the two share more than half of the longer one.
    pub alone: usize,
}

pub(super) fn run(
    study: &Study<'_>,
    pictures: &mut Vec<Picture>,
) -> Result<Vec<Segmented>, ReproduceError> {
    let labelled = || {
        study
            .clips
            .iter()
            .filter(|c| c.source == StreamKind::Labelled)
    };
    let results: Result<Vec<(Segmented, Picture)>, ReproduceError> = labelled()
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|clip| one(study, clip))
        .collect();
    let (segmented, drawn): (Vec<_>, Vec<_>) = results?.into_iter().unzip();
    pictures.extend(drawn);
    Ok(segmented)
}

fn one(study: &Study<'_>, clip: &TrainClip) -> Result<(Segmented, Picture), ReproduceError> {
    let params = PoseParams::default();
    let rows = rows_of(clip, &PivotSet::thesis(), &params)?;
    let found = segment(&rows, params.rate_hz, &PpcaParams::default()).map_err(|source| {
        ReproduceError::Segment {
            clip: clip.name.clone(),
            source,
        }
    })?;
    let secs = clip.clip.duration_secs();
    let cuts_secs: Vec<f64> = found.cuts.iter().map(|cut| cut.secs).collect();
    let borders: Vec<f64> = [0.0]
        .into_iter()
        .chain(cuts_secs.iter().copied())
        .chain([secs])
        .collect();
    let segments: Vec<TimeSpan> = (borders.windows(2))
        .map(|b| TimeSpan::new(b[0], b[1]))
        .collect();
    let samples: Vec<Bar> = study
        .samples
        .iter()
        .filter(|s| s.clip == clip.name)
        .filter_map(|s| {
            let kind = study.classes.iter().position(|c| *c == s.class)?;
            Some(Bar { span: s.span, kind })
        })
        .collect();
    let has_its_own = |sample: &&Bar| {
        let of = sample.span;
        let is_own =
            |s: &TimeSpan| s.overlap_secs(of) > 0.5 * s.duration_secs().max(of.duration_secs());
        segments.iter().any(is_own)
    };
    let cuts = segments.iter().enumerate().map(|(i, span)| Bar {
        span: *span,
        kind: study.classes.len() + i % 2,
    });
    let kinds = study
        .classes
        .iter()
        .cloned()
        .chain(["segment".to_owned(), "next segment".to_owned()]);
    let svg = LaneChart::new(
        format!("{}: labels and automatic segments", clip.name),
        kinds.collect(),
        secs,
    )
    .lane("labelled", samples.iter().copied())
    .lane("cut", cuts)
    .svg();
    let name = format!("segmentation_{}", clip.name);
    let caption = format!("{}: labels and cuts (Fig. 5.1)", clip.name);
    let alone = samples.iter().filter(has_its_own).count();
    let segmented = Segmented {
        clip: clip.name.clone(),
        secs,
        samples: samples.len(),
        cuts_secs,
        alone,
    };
    Ok((
        segmented,
        Picture {
            name,
            caption,
            svg,
            table: None,
        },
    ))
}
