//! From clips to groups without one label: the thesis's own chain, cuts (§5.1) then clusters of the segments (§5.2), beside sets of today.

use serde::Serialize;

use morec::TimeSpan;
use morec::cluster::{KwasParams, PairCounts, Spectrum, adjusted_rand_index, kwas_clusters};
use morec::discover::{DiscoverParams, discover};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows, bones_of_clip, rows_of_clip};
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotSet, PoseParams};
use morec::train::{StreamKind, TrainClip};

use super::Segmented;
use super::study::{ReproduceError, Study, rows_of};

/// What a way from clips to groups gives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnlabelledChain {
    /// Name of the method in the report.
    pub method: &'static str,
    /// Segments that are grouped.
    pub segments: usize,
    /// Number of groups found.
    pub groups: usize,
    /// Labelled samples.
    pub samples: usize,
    /// Those that have a segment of their own: the two share more than half of the longer one.
    pub alone: usize,
    /// Rand index of their groups against their classes.
    pub rand_index: f64,
    /// The same, 0 for chance.
    pub adjusted_rand_index: f64,
}

/// Clip, span and group of a segment.
type GroupedSegment<'a> = (&'a str, TimeSpan, usize);

pub(super) fn run(
    study: &Study<'_>,
    segmented: &[Segmented],
) -> Result<Vec<UnlabelledChain>, ReproduceError> {
    let clips = study.clips.iter();
    let clips: Vec<&TrainClip> = clips.filter(|c| c.source == StreamKind::Labelled).collect();
    Ok(vec![
        measured(study, "PPCA cuts, kWAS", &by_thesis(&clips, segmented)?),
        measured(study, "sets without labels", &by_sets(&clips)?),
    ])
}

fn by_thesis<'a>(
    clips: &[&'a TrainClip],
    segmented: &[Segmented],
) -> Result<Vec<GroupedSegment<'a>>, ReproduceError> {
    let (set, params) = (PivotSet::thesis(), PoseParams::default());
    let mut moments = Moments::new(set.row_dim());
    let (mut places, mut rows) = (Vec::new(), Vec::new());
    for clip in clips {
        let of_clip = rows_of(clip, &set, &params)?;
        moments.push_rows(&of_clip);
        let cuts = segmented.iter().find(|s| s.clip == clip.name);
        let cuts = cuts.iter().flat_map(|s| &s.cuts_secs).copied();
        let mut start = 0.0;
        for stop in cuts.chain([clip.clip.duration_secs()]) {
            let span = TimeSpan::new(std::mem::replace(&mut start, stop), stop);
            let frames = span.frames_among(of_clip.len(), params.rate_hz);
            if frames.len() > 1 {
                places.push((clip.name.as_str(), span));
                rows.push(of_clip.slice(frames));
            }
        }
    }
    let other = |e: &dyn std::fmt::Display| ReproduceError::Other(e.to_string());
    let pca = Pca::fit(&moments, ComponentCount::Dims(16)).map_err(|e| other(&e))?;
    let spectra = rows
        .iter()
        .map(|rows| Spectrum::of_rows(&pca.project(rows)));
    let clusters = kwas_clusters(&spectra.collect::<Vec<_>>(), &KwasParams::default());
    let grouped = places.into_iter().zip(clusters.of);
    Ok(grouped
        .map(|((clip, span), group)| (clip, span, group))
        .collect())
}

fn by_sets<'a>(clips: &[&'a TrainClip]) -> Result<Vec<GroupedSegment<'a>>, ReproduceError> {
    let features = FeatureParams::default();
    let bones = |c: &TrainClip| bones_of_clip(&c.clip, &c.roles, &c.rest);
    let common = clips.iter().map(|c| bones(c)).reduce(BoneSet::and);
    let common = common.unwrap_or(BoneSet::NONE);
    let rows = clips.iter().map(|c| {
        let rows = rows_of_clip(&c.clip, &c.roles, &c.rest, bones(c), &features);
        rows.columns(&RowLayout::kept_columns(bones(c), common))
    });
    let rows: Vec<Rows> = rows.collect();
    let found = discover(&rows, features.tick_hz(), &DiscoverParams::default(), &());
    let sets = found
        .map_err(|e| ReproduceError::Other(e.to_string()))?
        .sets;
    let numbered = sets.into_iter().enumerate();
    let instances = numbered.flat_map(|(n, set)| set.instances.into_iter().map(move |i| (n, i)));
    Ok(instances
        .map(|(n, i)| (clips[i.clip].name.as_str(), i.span, n))
        .collect())
}

fn measured(
    study: &Study<'_>,
    method: &'static str,
    segments: &[GroupedSegment<'_>],
) -> UnlabelledChain {
    let (mut classes, mut groups, mut samples) = (Vec::new(), Vec::new(), 0);
    for sample in study.samples {
        let Some(class) = study.classes.iter().position(|c| *c == sample.class) else {
            continue;
        };
        samples += 1;
        let own = segments.iter().find(|(clip, span, _)| {
            let longer = span.duration_secs().max(sample.span.duration_secs());
            *clip == sample.clip && span.overlap_secs(sample.span) > 0.5 * longer
        });
        if let Some((.., group)) = own {
            classes.push(class);
            groups.push(*group);
        }
    }
    let mut all: Vec<usize> = segments.iter().map(|(.., group)| *group).collect();
    all.sort_unstable();
    all.dedup();
    UnlabelledChain {
        method,
        segments: segments.len(),
        groups: all.len(),
        samples,
        alone: classes.len(),
        rand_index: PairCounts::count(&classes, &groups).rand_index(),
        adjusted_rand_index: adjusted_rand_index(&classes, &groups),
    }
}

/// The table of the page.
pub(super) fn push(out: &mut String, chains: &[UnlabelledChain]) {
    out.push_str(
        "<h2>From clips to groups without a label</h2>\n<p>The thesis cuts clips and groups the segments between cuts; it has no method for repeated \
         motions, which it calls important (ch. 6). For comparison: sets of repetitions (docs/guide/discover.md). Rand indices are over samples with a segment of \
         their own.</p>\n<div class=\"wide\"><table>\n<tr><th></th><th>segments</th><th>groups</th><th>samples</th>\
         <th>with a segment of their own</th><th>Rand</th><th>adjusted</th></tr>\n",
    );
    for c in chains {
        let index = |value: f64| match c.alone {
            0 | 1 => "–".to_owned(),
            _ => format!("{value:.3}"),
        };
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            c.method,
            c.segments,
            c.groups,
            c.samples,
            c.alone,
            index(c.rand_index),
            index(c.adjusted_rand_index)
        ));
    }
    out.push_str("</table></div>\n");
}
