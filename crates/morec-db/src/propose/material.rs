//! Input of proposing: feature rows of all clips, and the stretches that were accepted or rejected.

use std::collections::BTreeMap;
use std::ops::Range;

use morec::features::BoneSet;
use morec::train::{ClassKind, ClassLabels, TrainParams, motion_span};

use super::pieces::pieces;
use crate::labels::{DbSample, SampleState};
use crate::rows::ClipRows;
use crate::search::layout::{CanonicalRows, to_canonical};
use crate::{ClipId, ClipInfo};

/// Shorter samples are no motion.
const LEAST_TICKS: usize = 4;

/// A clip's rows over all bones, and what else counts.
pub struct ClipFeatures {
    pub id: ClipId,
    pub laid: CanonicalRows,
    pub end_secs: f64,
    /// Person in the clip; the clip's name if none is named.
    pub group: String,
}

/// A stretch that somebody judged.
pub struct JudgedSpan {
    /// Its clip's place in [`ProposalData::clips`].
    pub clip: usize,
    /// Its class's place in [`ProposalData::classes`]; none if no sample of the class is accepted.
    pub class: Option<usize>,
    pub accepted: bool,
    /// True if the clip as a whole was judged; `ticks` are then its moving part.
    pub whole: bool,
    pub ticks: Range<usize>,
    /// The label that it is a piece of, where its class is an activity; else the same.
    pub label: Range<usize>,
}

pub struct ProposalData {
    /// Names of classes of which a sample is accepted.
    pub classes: Vec<String>,
    /// For each class, whether all its samples are whole clips.
    pub whole: Vec<bool>,
    /// For each class, whether it is an activity: its labels are long, and judged piece by piece.
    pub activity: Vec<bool>,
    pub clips: Vec<ClipFeatures>,
    pub judged: Vec<JudgedSpan>,
    /// Bones that every clip with an accepted sample shows.
    pub bones: BoneSet,
}

impl ProposalData {
    pub fn new(
        rows: Vec<ClipRows>,
        infos: &[ClipInfo],
        samples: &[DbSample],
        tick_hz: f64,
    ) -> Self {
        let infos: BTreeMap<ClipId, &ClipInfo> = infos.iter().map(|c| (c.id, c)).collect();
        let mut taught = BoneSet::BODY;
        let (mut moving, mut places) = (Vec::new(), BTreeMap::new());
        let mut clips = Vec::new();
        for of in rows {
            let Some(info) = infos.get(&of.clip) else {
                continue;
            };
            let own: Vec<&DbSample> = samples.iter().filter(|s| s.clip == of.clip).collect();
            if own.iter().any(|s| s.state == SampleState::Accepted) {
                taught = taught.and(of.bones);
            }
            let whole = own.iter().any(|s| s.whole_clip);
            moving.push(if whole {
                motion_span(&of.rows, of.bones)
            } else {
                0..0
            });
            places.insert(of.clip, clips.len());
            clips.push(ClipFeatures {
                id: of.clip,
                laid: to_canonical(&of.rows, of.bones),
                end_secs: info.duration_secs(),
                group: info.subject.clone().unwrap_or_else(|| info.name.clone()),
            });
        }
        let ticks = |s: &DbSample| {
            let clip = *places.get(&s.clip)?;
            let ticks = if s.whole_clip {
                moving[clip].clone()
            } else {
                s.span().frames_among(clips[clip].laid.rows.len(), tick_hz)
            };
            (ticks.len() >= LEAST_TICKS).then_some((clip, ticks))
        };
        let usable: Vec<(&DbSample, (usize, Range<usize>))> = samples
            .iter()
            .filter(|s| s.state != SampleState::Proposed)
            .filter_map(|s| Some((s, ticks(s)?)))
            .collect();
        let accepted = || {
            usable
                .iter()
                .filter(|(s, _)| s.state == SampleState::Accepted)
        };
        let mut classes: Vec<String> = accepted().map(|(s, _)| s.class.clone()).collect();
        classes.sort();
        classes.dedup();
        let whole = classes
            .iter()
            .map(|c| {
                accepted()
                    .filter(|(s, _)| s.class == *c)
                    .all(|(s, _)| s.whole_clip)
            })
            .collect();
        let mut by_clip: Vec<Vec<(&str, Range<f64>)>> = vec![Vec::new(); clips.len()];
        for (s, (clip, _)) in accepted().filter(|(s, _)| !s.whole_clip) {
            by_clip[*clip].push((s.class.as_str(), s.start_secs..s.stop_secs));
        }
        let labels = ClassLabels::of_clips(clips.iter().map(|clip| clip.end_secs).zip(by_clip));
        let is_activity = |class: &String| {
            let labels = labels.get(class.as_str()).copied().unwrap_or_default();
            TrainParams::default().kind(class, &labels) == ClassKind::Activity
        };
        let activity: Vec<bool> = classes.iter().map(is_activity).collect();
        let spans = |(s, (clip, label)): &(&DbSample, (usize, Range<usize>))| {
            let class = classes.iter().position(|c| *c == s.class);
            let pieces = match class.is_some_and(|class| activity[class]) && !s.whole_clip {
                true => {
                    let rows = clips[*clip].laid.rows.slice(label.clone());
                    pieces(&rows, label, tick_hz)
                }
                false => vec![label.clone()],
            };
            let span = |ticks| JudgedSpan {
                clip: *clip,
                class,
                accepted: s.state == SampleState::Accepted,
                whole: s.whole_clip,
                ticks,
                label: label.clone(),
            };
            pieces.into_iter().map(span).collect::<Vec<_>>()
        };
        let judged = usable.iter().flat_map(spans).collect();
        Self {
            classes,
            whole,
            activity,
            clips,
            judged,
            bones: taught,
        }
    }

    /// Accepted samples of each class.
    pub fn accepted(&self, class: usize) -> impl Iterator<Item = (usize, &JudgedSpan)> {
        self.judged
            .iter()
            .enumerate()
            .filter(move |(_, j)| j.accepted && j.class == Some(class))
    }
}

/// Ticks in both, of ticks in either.
pub fn overlap(a: &Range<usize>, b: &Range<usize>) -> f64 {
    let shared = a.end.min(b.end).saturating_sub(a.start.max(b.start));
    shared as f64 / (a.end.max(b.end) - a.start.min(b.start)).max(1) as f64
}
