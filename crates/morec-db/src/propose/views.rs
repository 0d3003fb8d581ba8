//! Templates and metric reduced to the bones that a clip has.

use std::collections::{BTreeMap, BTreeSet};

use morec::classes::ClassId;
use morec::features::{BoneSet, Rows};
use morec::templates::{Metric, TemplateBank};
use morec::train::{LabelledSpan, StreamKind, TrainParams, TrainSet, TrainStream, scatters};

use super::material::{JudgedSpan, ProposalData};
use super::options::ProposeOptions;
use crate::search::layout::shared_columns;

/// Pairs of samples that tell how a class varies: more say the same, and a round must stay quick.
const PAIRS: usize = 40;

/// Templates and metric for clips that show these bones.
pub struct BoneView {
    /// Columns of laid-out rows that count.
    columns: Vec<usize>,
    metric: Metric,
    /// Brings distances over these bones to the scale of all.
    pub factor: f32,
    /// A template for each of the chosen stretches; empty where its clip lacks bones.
    pub bank: TemplateBank,
}

impl BoneView {
    /// Laid-out rows under the metric.
    pub fn map(&self, laid: &Rows) -> Rows {
        self.metric.apply_all(&laid.columns(&self.columns))
    }
}

/// Samples that look for others and rejected stretches that speak against them, as places in [`ProposalData::judged`].
pub fn chosen(material: &ProposalData, options: &ProposeOptions) -> Vec<usize> {
    let mut chosen = Vec::new();
    for class in 0..material.classes.len() {
        let mut by_group: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (at, sample) in material.accepted(class) {
            by_group
                .entry(&material.clips[sample.clip].group)
                .or_default()
                .push(at);
        }
        // A long label has many pieces that are alike: some of all of them.
        let most = options.templates_a_class.max(1);
        for group in by_group.values_mut().filter(|group| group.len() > most) {
            *group = (0..most).map(|i| group[i * group.len() / most]).collect();
        }
        let longest = by_group.values().map(Vec::len).max().unwrap_or(0);
        let turns =
            (0..longest).flat_map(|turn| by_group.values().filter_map(move |g| g.get(turn)));
        chosen.extend(turns.take(options.templates_a_class.max(1)));
    }
    let rejected: Vec<usize> = material
        .judged
        .iter()
        .enumerate()
        .filter(|(_, j)| !j.accepted)
        .map(|(at, _)| at)
        .collect();
    let stride = rejected.len().div_ceil(options.negatives.max(1)).max(1);
    chosen.extend(rejected.into_iter().step_by(stride));
    chosen
}

/// A view for each set of bones that clips show, of those that are taught. O(pairs · rows² · d + d³).
pub fn views(material: &ProposalData, chosen: &[usize]) -> BTreeMap<BoneSet, BoneView> {
    let columns = shared_columns(material.bones);
    let Some((ridged, total)) = scatters(&train_set(material, &columns), &params()) else {
        return BTreeMap::new();
    };
    let sets: BTreeSet<BoneSet> = material
        .clips
        .iter()
        .map(|c| c.laid.bones.and(material.bones))
        .collect();
    let view = |bones: BoneSet| {
        let kept = shared_columns(bones);
        let keep: Vec<usize> = (0..columns.len())
            .filter(|at| kept.contains(&columns[*at]))
            .collect();
        let part = total.restricted(&keep);
        let factor = (total.trace() / part.trace().max(1e-12)) as f32;
        let metric = Metric::new(&ridged.restricted(&keep), &part);
        let template = |judged: &JudgedSpan| {
            let laid = &material.clips[judged.clip].laid;
            match laid.bones.and(bones) == bones {
                true => metric.apply_all(&laid.rows.slice(judged.ticks.clone()).columns(&kept)),
                false => Rows::new(kept.len()),
            }
        };
        let templates: Vec<Rows> = chosen
            .iter()
            .map(|at| template(&material.judged[*at]))
            .collect();
        (
            bones,
            BoneView {
                bank: TemplateBank::new(&templates, kept.len()),
                columns: kept,
                metric,
                factor,
            },
        )
    };
    sets.into_iter()
        .filter(|bones| !bones.is_empty())
        .map(view)
        .collect()
}

fn params() -> TrainParams {
    TrainParams {
        max_pairs: PAIRS,
        ..TrainParams::default()
    }
}

/// The clips that hold accepted samples.
fn train_set(material: &ProposalData, columns: &[usize]) -> TrainSet {
    let mut by_clip: BTreeMap<usize, Vec<&JudgedSpan>> = BTreeMap::new();
    for judged in material.judged.iter().filter(|j| j.accepted) {
        by_clip.entry(judged.clip).or_default().push(judged);
    }
    let stream = |(clip, judged): (usize, Vec<&JudgedSpan>)| {
        let known = |j: &&JudgedSpan| {
            Some(LabelledSpan {
                ticks: j.label.clone(),
                class: Some(ClassId(j.class? as u16)),
            })
        };
        // Pieces of one label are not alike in phase with those of another: how a class varies is learned from whole labels.
        let mut judged = judged;
        judged.dedup_by(|a, b| (a.class, &a.label) == (b.class, &b.label));
        TrainStream {
            name: String::new(),
            group: material.clips[clip].group.clone(),
            person: None,
            source: StreamKind::Labelled,
            rest_is_background: false,
            is_copy: false,
            rows: material.clips[clip].laid.rows.columns(columns),
            known: judged.iter().filter_map(known).collect(),
        }
    };
    TrainSet {
        classes: material.classes.clone(),
        streams: by_clip.into_iter().map(stream).collect(),
        ..TrainSet::default()
    }
}
