//! Label a few, confirm the rest: where else are the classes, the surest first.
//!
//! More motions like the accepted samples are searched for as the trained recogniser does: under a metric that forgets how samples of one
//! class differ (with one sample a class there is nothing to forget, and rows are compared as they are), against the
//! other classes and against what was rejected. The threshold is learned from the answers: every
//! judged stretch is looked for without its own template, and what that says about right and wrong becomes the
//! probability that a proposal is right, on one scale for all classes ([`confidence`]).
//!
//! A class goes on being asked about however unlikely its best candidates are, so answers never come to an end before
//! its samples do. Stretches that were judged are not asked about again.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::TimeSpan;
use morec::features::FeatureParams;
use morec::progress::Progress;
use morec::train::overlap_share;
use rayon::prelude::*;

use crate::labels::{NewSample, SampleFilter, SampleId, SampleState};
use crate::{ClipId, DbError, MotionDb};

mod candidates;
mod confidence;
mod material;
mod options;
mod pieces;
mod questions;
mod stretches;
mod views;

pub use options::ProposeOptions;
pub use questions::most_informative;

use candidates::{ClassDistances, ProposalCandidate};
use confidence::{Confidence, Judgement, NEAR_NOTHING};
use material::{JudgedSpan, ProposalData, overlap};
use stretches::joined;
use views::{chosen, views};

/// A stretch that may show a class.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Proposal {
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Name of the class that is proposed.
    pub class: String,
    /// Start and stop, seconds.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// True if the clip as a whole is meant: so where all samples of the class are whole clips.
    pub whole_clip: bool,
    /// Probability that it is right, 0 to 1, estimated from the answers so far.
    pub score: f32,
}

impl Proposal {
    /// True if it is likelier right than wrong.
    pub fn is_sure(&self) -> bool {
        self.score >= 0.5
    }
}

impl From<Proposal> for NewSample {
    fn from(p: Proposal) -> Self {
        NewSample {
            clip: p.clip,
            class: p.class,
            start_secs: p.span.start_secs,
            stop_secs: p.span.stop_secs,
            whole_clip: p.whole_clip,
            state: SampleState::Proposed,
            score: Some(f64::from(p.score)),
        }
    }
}

/// Author of the proposals of [`MotionDb::propose_and_keep`].
const PROPOSED_BY: &str = "propose";

impl MotionDb {
    /// [`propose`](Self::propose), and what is proposed is kept in place of the proposals of an earlier round that nobody
    /// judged.
    ///
    /// # Errors
    /// As `propose`; the database cannot be written.
    pub fn propose_and_keep(
        &mut self,
        options: &ProposeOptions,
        progress: &dyn Progress,
    ) -> Result<Vec<Proposal>, DbError> {
        let proposals = self.propose(options, progress)?;
        let proposed = self.samples(&SampleFilter {
            state: Some(SampleState::Proposed),
            ..SampleFilter::default()
        })?;
        let old = proposed.into_iter().filter(|s| s.set_by == PROPOSED_BY);
        let old: Vec<SampleId> = old.map(|s| s.id).collect();
        let new: Vec<NewSample> = proposals.iter().cloned().map(NewSample::from).collect();
        self.replace_proposals(&old, &new, PROPOSED_BY)?;
        Ok(proposals)
    }

    /// Searches all clips for stretches that may show the classes of accepted samples, most probable first. Nothing is
    /// written except feature rows that were missing. O(rows · rows of the templates).
    ///
    /// # Errors
    /// [`DbError::Invalid`] if no sample is accepted; [`DbError::Cancelled`]; the database cannot be read.
    pub fn propose(
        &mut self,
        options: &ProposeOptions,
        progress: &dyn Progress,
    ) -> Result<Vec<Proposal>, DbError> {
        let params = FeatureParams::default();
        let rows = self.rows(&params, progress)?;
        let samples = self.samples(&SampleFilter::default())?;
        let clips = self.clips(&crate::ClipFilter::default())?;
        let material = ProposalData::new(rows, &clips, &samples, params.tick_hz());
        if material.classes.is_empty() {
            return Err(DbError::Invalid(
                "no accepted sample: label a few motions first".to_owned(),
            ));
        }
        let seen = look(&material, options, progress)?;
        let judgements: Vec<Judgement> = seen
            .iter()
            .flat_map(|(clip, seen)| judged(&material, *clip, seen))
            .collect();
        let confidence = Confidence::learn(material.classes.len(), &judgements);
        let of_clip = |(clip, seen): &(usize, ClassDistances)| {
            in_clip(&material, *clip, seen, &confidence, params.tick_hz())
        };
        let mut proposals: Vec<Proposal> = seen.par_iter().flat_map_iter(of_clip).collect();
        proposals.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.clip.cmp(&b.clip)));
        Ok(enough(proposals, options))
    }
}

/// Distances of every clip to the templates.
fn look(
    material: &ProposalData,
    options: &ProposeOptions,
    progress: &dyn Progress,
) -> Result<Vec<(usize, ClassDistances)>, DbError> {
    let templates = chosen(material, options);
    let views = views(material, &templates);
    let (done, total) = (AtomicUsize::new(0), material.clips.len());
    let see = |clip: usize| {
        if progress.cancelled() {
            return Some(Err(DbError::Cancelled));
        }
        let view = views.get(&material.clips[clip].laid.bones.and(material.bones))?;
        let seen = ClassDistances::of(material, clip, &templates, view);
        progress.report("looking", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        Some(Ok((clip, seen)))
    };
    (0..total).into_par_iter().filter_map(see).collect()
}

/// Judgements of the stretches of a clip, as training data of the confidence.
fn judged(material: &ProposalData, clip: usize, seen: &ClassDistances) -> Vec<Judgement> {
    let mut found = Vec::new();
    for judged in material.judged.iter().filter(|j| j.clip == clip) {
        let Some(class) = judged.class else { continue };
        let evidence = seen.evidence(class, &judged.ticks, judged.whole);
        if judged.accepted && evidence.distance < NEAR_NOTHING {
            // The class that it is most like, of those that it is not.
            let others = (0..material.classes.len()).filter(|c| *c != class);
            let others = others.map(|c| (c, seen.evidence(c, &judged.ticks, judged.whole)));
            let nearest = others.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
            found.extend(nearest.map(|(class, evidence)| Judgement {
                class,
                evidence,
                right: false,
                whole: judged.whole,
            }));
        }
        found.push(Judgement {
            class,
            evidence,
            right: judged.accepted,
            whole: judged.whole,
        });
    }
    found
}

/// The likeliest of the candidates that overlap, none of what was judged already.
fn in_clip(
    material: &ProposalData,
    clip: usize,
    seen: &ClassDistances,
    confidence: &Confidence,
    tick_hz: f64,
) -> Vec<Proposal> {
    let of = &material.clips[clip];
    let everything = 0..of.laid.rows.len();
    let known: Vec<&JudgedSpan> = material.judged.iter().filter(|j| j.clip == clip).collect();
    let mut candidates: Vec<(f64, ProposalCandidate)> = Vec::new();
    for class in 0..material.classes.len() {
        let whole = material.whole[class];
        let found = if whole {
            seen.whole(class).into_iter().collect()
        } else {
            seen.peaks(class)
        };
        for mut candidate in found {
            if whole {
                candidate.ticks = everything.clone();
            }
            let answered = |j: &&JudgedSpan| match j.accepted {
                true => j.whole || whole || overlap_share(&j.label, &candidate.ticks) > 0.5,
                // A piece of an activity lies within what was rejected.
                false if material.activity[class] => {
                    j.class == Some(class)
                        && (j.whole || overlap_share(&j.label, &candidate.ticks) > 0.5)
                }
                false => {
                    j.class == Some(class) && (j.whole || overlap(&j.ticks, &candidate.ticks) > 0.5)
                }
            };
            if !known.iter().any(answered) {
                candidates.push((confidence.of(class, &candidate.evidence), candidate));
            }
        }
    }
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<(f64, ProposalCandidate)> = Vec::new();
    for candidate in candidates {
        if !kept
            .iter()
            .any(|k| overlap_share(&k.1.ticks, &candidate.1.ticks) > 0.3)
        {
            kept.push(candidate);
        }
    }
    let proposal = |(score, c): (f64, ProposalCandidate)| {
        let whole_clip = material.whole[c.class];
        let mut span = TimeSpan::of_frames(c.ticks, tick_hz);
        if whole_clip || span.stop_secs > of.end_secs {
            span.stop_secs = of.end_secs;
        }
        Proposal {
            clip: of.id,
            class: material.classes[c.class].clone(),
            span,
            whole_clip,
            score: score as f32,
        }
    };
    joined(kept, |class| material.activity[class])
        .into_iter()
        .map(proposal)
        .filter(|p| p.span.is_stretch())
        .collect()
}

/// Of proposals by score, those of the classes asked for that are likely enough, and the best few of each class.
fn enough(proposals: Vec<Proposal>, options: &ProposeOptions) -> Vec<Proposal> {
    let mut of_class: BTreeMap<String, usize> = BTreeMap::new();
    let mut keep = |p: &Proposal| {
        let count = of_class.entry(p.class.clone()).or_default();
        *count += 1;
        let wanted = options.classes.is_empty() || options.classes.contains(&p.class);
        wanted && (p.score >= options.least || *count <= options.always)
    };
    proposals.into_iter().filter(|p| keep(p)).collect()
}

#[cfg(test)]
mod tests;
