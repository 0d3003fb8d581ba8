//! Label a few, confirm the rest: where else are the classes, the surest first.
//!
//! Every accepted sample looks for its like in all clips by subsequence dynamic time warping. How far samples of a class
//! are from one another says how far is still near; a class that another one is nearer than proposes nothing there.
//! Stretches that were accepted or rejected are not asked about again, so every answer makes the next round better.

use std::collections::BTreeMap;
use std::ops::Range;

use morec::features::{FeatureParams, Rows};
use morec::progress::Progress;
use morec::templates::Bank;
use rayon::prelude::*;

use crate::labels::{DbSample, NewSample, SampleFilter, State};
use crate::search::layout::{DIM, lay_out};
use crate::{ClipId, DbError, MotionDb};

/// How to propose.
#[derive(Debug, Clone, PartialEq)]
pub struct ProposeOptions {
    /// Only these classes; all if empty.
    pub classes: Vec<String>,
    /// Samples of a class that look for others.
    pub templates_a_class: usize,
    /// A stretch is proposed within so many times the distance that samples of its class have from one another.
    pub reach: f32,
}

impl Default for ProposeOptions {
    fn default() -> Self {
        Self { classes: Vec::new(), templates_a_class: 12, reach: 2.0 }
    }
}

/// A stretch that may show a class.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Proposal {
    /// Its clip.
    pub clip: ClipId,
    /// What it may show.
    pub class: String,
    /// Where it starts, seconds.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// 1: like a sample; towards 0: hardly nearer than the next class, or than what is none.
    pub score: f32,
}

impl From<Proposal> for NewSample {
    fn from(p: Proposal) -> Self {
        NewSample {
            clip: p.clip,
            class: p.class,
            start_secs: p.start_secs,
            stop_secs: p.stop_secs,
            whole_clip: false,
            state: State::Proposed,
            score: Some(f64::from(p.score)),
        }
    }
}

/// A sample that looks for its like.
struct Template {
    class: usize,
    rows: Rows,
}

impl MotionDb {
    /// Stretches of all clips that may show the classes of accepted samples, the surest first. Nothing is written.
    /// O(rows · rows of the templates).
    pub fn propose(
        &mut self,
        options: &ProposeOptions,
        progress: &dyn Progress,
    ) -> Result<Vec<Proposal>, DbError> {
        let params = FeatureParams::default();
        let clips: BTreeMap<ClipId, Rows> = self
            .rows(&params, progress)?
            .into_iter()
            .map(|clip| (clip.clip, lay_out(&clip.rows, clip.bones).rows))
            .collect();
        let samples = self.samples(&SampleFilter::default())?;
        let tick_hz = params.tick_hz();
        let (classes, templates) = templates(&clips, &samples, options, tick_hz);
        if templates.is_empty() {
            return Err(DbError::Invalid("no accepted sample to go by: label a few first".to_owned()));
        }
        let reach = reaches(classes.len(), &templates, options.reach);
        let lengths: BTreeMap<ClipId, f64> = self
            .clips(&crate::ClipFilter::default())?
            .into_iter()
            .map(|c| (c.id, c.duration_secs()))
            .collect();
        let found: Vec<Vec<Proposal>> = clips
            .par_iter()
            .map(|(id, rows)| {
                let known: Vec<Range<f64>> = samples
                    .iter()
                    .filter(|s| s.clip == *id && s.state != State::Proposed)
                    .map(|s| s.start_secs..s.stop_secs)
                    .collect();
                let end = lengths.get(id).copied().unwrap_or(0.0);
                in_clip(rows, &templates, &reach)
                    .into_iter()
                    .map(|c| Proposal {
                        clip: *id,
                        class: classes[c.class].clone(),
                        start_secs: c.ticks.start as f64 / tick_hz,
                        stop_secs: (c.ticks.end as f64 / tick_hz).min(end),
                        score: c.score,
                    })
                    .filter(|p| p.stop_secs > p.start_secs && !known.iter().any(|k| covers(k, p)))
                    .collect()
            })
            .collect();
        let mut proposals = found.concat();
        proposals.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.clip.cmp(&b.clip)));
        Ok(proposals)
    }
}

/// More than 0.3 of the shorter.
fn covers(known: &Range<f64>, p: &Proposal) -> bool {
    let shared = known.end.min(p.stop_secs) - known.start.max(p.start_secs);
    shared > 0.3 * (known.end - known.start).min(p.stop_secs - p.start_secs)
}

/// Names of the classes, and samples of each: evenly over those there are, so that clips and people take turns.
fn templates(
    clips: &BTreeMap<ClipId, Rows>,
    samples: &[DbSample],
    options: &ProposeOptions,
    tick_hz: f64,
) -> (Vec<String>, Vec<Template>) {
    let mut by_class: BTreeMap<&str, Vec<Rows>> = BTreeMap::new();
    let wanted = |s: &&DbSample| options.classes.is_empty() || options.classes.contains(&s.class);
    for sample in samples.iter().filter(|s| s.state == State::Accepted).filter(wanted) {
        let Some(rows) = clips.get(&sample.clip) else { continue };
        let tick = |secs: f64| ((secs * tick_hz).round() as usize).min(rows.len());
        let span = tick(sample.start_secs)..tick(sample.stop_secs);
        if span.len() >= 4 {
            by_class.entry(&sample.class).or_default().push(rows.slice(span));
        }
    }
    let classes = by_class.keys().map(|name| (*name).to_owned()).collect();
    let most = options.templates_a_class.max(1);
    let taken = by_class.into_values().enumerate().flat_map(|(class, rows)| {
        let stride = rows.len().div_ceil(most);
        rows.into_iter().step_by(stride).map(move |rows| Template { class, rows })
    });
    (classes, taken.collect())
}

/// Where nothing says otherwise, stretches of one motion by different people are so far apart.
const WIDE: f32 = 1.5;

/// For each class: how far from its nearest sample a stretch may be. So many times the median distance of its samples
/// from one another, or, for a class of one sample, the mean of the other classes'. Samples of one person say little of
/// how others differ: so half of the way to the next class is allowed at least, and never more than most of it.
fn reaches(classes: usize, templates: &[Template], share: f32) -> Vec<f32> {
    let mut own: Vec<Vec<f32>> = vec![Vec::new(); classes];
    let mut other = vec![f32::INFINITY; classes];
    let nearest: Vec<(usize, f32, f32)> = templates
        .par_iter()
        .enumerate()
        .map(|(at, template)| {
            let (mut same, mut else_) = (f32::INFINITY, f32::INFINITY);
            let mut bank = Bank::new(std::slice::from_ref(&template.rows), DIM);
            for (k, stream) in templates.iter().enumerate().filter(|(k, _)| *k != at) {
                bank.reset();
                let mut best = f32::INFINITY;
                for row in padded(&stream.rows).iter() {
                    bank.step(row);
                    best = best.min(bank.matched(0).distance);
                }
                let to = if templates[k].class == template.class { &mut same } else { &mut else_ };
                *to = to.min(best);
            }
            (template.class, same, else_)
        })
        .collect();
    for (class, same, else_) in nearest {
        own[class].extend((same < 1e20).then_some(same));
        other[class] = other[class].min(else_);
    }
    let medians: Vec<Option<f32>> = own
        .iter_mut()
        .map(|own| {
            own.sort_by(f32::total_cmp);
            own.get(own.len() / 2).copied()
        })
        .collect();
    let known: Vec<f32> = medians.iter().flatten().copied().collect();
    let usual = if known.is_empty() { 0.8 } else { known.iter().sum::<f32>() / known.len() as f32 };
    let reach = |(median, other): (&Option<f32>, &f32)| {
        let own = share * median.unwrap_or(usual);
        own.max((0.5 * other).min(WIDE)).min(0.9 * other)
    };
    medians.iter().zip(&other).map(reach).collect()
}

/// A row held at the end for as long as the sample: a longer template must be able to end.
fn padded(rows: &Rows) -> Rows {
    let mut out = rows.clone();
    for _ in 0..rows.len() {
        out.push(rows.row(rows.len() - 1));
    }
    out
}

struct Candidate {
    class: usize,
    ticks: Range<usize>,
    score: f32,
}

/// Local minima of each class's distance that are within its reach, the best of those that overlap.
fn in_clip(rows: &Rows, templates: &[Template], reach: &[f32]) -> Vec<Candidate> {
    let laid: Vec<Rows> = templates.iter().map(|t| t.rows.clone()).collect();
    let mut bank = Bank::new(&laid, DIM);
    // For each tick and class: distance of the nearest sample relative to the reach, and where its path begins.
    let mut table: Vec<Vec<(f32, usize)>> = Vec::with_capacity(rows.len());
    for (tick, row) in rows.iter().enumerate() {
        bank.step(row);
        let mut best = vec![(f32::INFINITY, tick); reach.len()];
        for (index, template) in templates.iter().enumerate() {
            let found = bank.matched(index);
            let relative = found.distance / reach[template.class].max(1e-6);
            if relative < best[template.class].0 {
                best[template.class] = (relative, tick - found.age);
            }
        }
        table.push(best);
    }
    let mut candidates = Vec::new();
    for class in 0..reach.len() {
        for tick in 0..table.len() {
            let (distance, start) = table[tick][class];
            let around = tick.saturating_sub(3)..(tick + 4).min(table.len());
            if distance >= 1.0 || table[around].iter().any(|row| row[class].0 < distance) {
                continue;
            }
            let second =
                (0..reach.len()).filter(|c| *c != class).map(|c| table[tick][c].0).fold(1.0, f32::min);
            if distance < second {
                let score = 1.0 - distance / second;
                candidates.push(Candidate { class, ticks: start..tick + 1, score });
            }
        }
    }
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        let shared = |k: &Candidate| {
            k.ticks.end.min(candidate.ticks.end).saturating_sub(k.ticks.start.max(candidate.ticks.start))
        };
        if !kept.iter().any(|k| 10 * shared(k) > 3 * k.ticks.len().min(candidate.ticks.len())) {
            kept.push(candidate);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{database_of_waves, waves};

    /// The waves and bows of one person find those of two others, and what was answered is not asked again.
    #[test]
    fn a_few_labels_find_the_others() {
        let takes = waves(3);
        let (_folder, mut db) = database_of_waves(3);
        assert!(db.propose(&ProposeOptions::default(), &()).is_err());
        let ids: Vec<ClipId> = takes.iter().map(|t| db.find_clip(&t.clip.name).unwrap().id).collect();
        let labelled: Vec<NewSample> = takes[0]
            .labels
            .iter()
            .map(|l| NewSample {
                clip: ids[0],
                class: l.class.to_owned(),
                start_secs: l.start_secs,
                stop_secs: l.stop_secs,
                whole_clip: false,
                state: State::Accepted,
                score: None,
            })
            .collect();
        db.add_samples(&labelled, "test").unwrap();
        let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
        assert!(proposals.windows(2).all(|pair| pair[0].score >= pair[1].score));
        let right = |p: &Proposal| {
            let take = &takes[ids.iter().position(|id| *id == p.clip).unwrap()];
            take.labels.iter().any(|l| {
                let shared = l.stop_secs.min(p.stop_secs) - l.start_secs.max(p.start_secs);
                l.class == p.class && shared > 0.5 * (l.stop_secs - l.start_secs)
            })
        };
        // Four waves and four bows are left to be found: the surest of the proposals are these.
        assert!(proposals.len() >= 6, "{proposals:?}");
        assert!(proposals.iter().take(6).filter(|p| right(p)).count() >= 5, "{proposals:?}");
        assert!(
            proposals.iter().all(|p| p.clip != ids[0] || !right(p)),
            "labelled stretches are not proposed"
        );
        let samples: Vec<NewSample> = proposals.into_iter().map(NewSample::from).collect();
        db.add_samples(&samples, "morec").unwrap();
        let ids: Vec<_> = db.samples(&SampleFilter::default()).unwrap().iter().map(|s| s.id).collect();
        db.judge(&ids, State::Rejected, "test").unwrap();
        db.judge(&ids[..1], State::Accepted, "test").unwrap();
        let again = db.propose(&ProposeOptions::default(), &()).unwrap();
        let known = db.samples(&SampleFilter::default()).unwrap();
        assert!(
            again
                .iter()
                .all(|p| known.iter().all(|k| k.clip != p.clip || !covers(&(k.start_secs..k.stop_secs), p)))
        );
    }
}
