//! Sets of the same motion in clips without labels: what repeats is found, one set for each motion, ranked by the moving time that it explains.
//!
//! Seven steps, a file each:
//!
//! 1. *candidates*: stretches between minima of speed at three widths and ends of rests;
//! 2. *neighbours*: pairs whose elastic distance over their spread, `r`, is below a bound;
//! 3. *cover*: the candidate whose neighbours explain most moving time leads a set, then the next best, greedily;
//! 4. *split*: members of one clip that are far nearer to their own than to the others come apart;
//! 5. *votes*: sets of different clips whose members name each other as nearest are joined; no bound on distance decides about people;
//! 6. *revise*: every candidate is held against the sets, and those that explain most without overlap are kept (exact interval scheduling);
//! 7. sets are ranked by the moving time beyond their longest instance.
//!
//! In the usual way the sets of a first pass serve as classes for the within-class metric of training, and a second pass uses it.
//!
//! A motion that is done once is in no set. Where a cycle begins is a convention that no method can know: all bounds of a set may be off
//! by the same part of a cycle. Motions that feature rows do not distinguish stay one set.
//!
//! ```
//! use morec::discover::{DiscoverParams, discover};
//! use morec::features::{FeatureParams, rows_of_clip};
//! use morec::synth::{DatabaseSpec, database};
//! use morec::Take;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let spec = DatabaseSpec { people: 2, repetitions: 4, classes: vec!["wave", "bow"], ..Default::default() };
//! let features = FeatureParams::default();
//! let mut clips = Vec::new();
//! for person in database(1, &spec) {
//!     let take = Take::new(person.clip)?;
//!     clips.push(rows_of_clip(&take.clip, &take.roles, take.rest(), take.bones(), &features));
//! }
//! let found = discover(&clips, features.tick_hz(), &DiscoverParams::default(), &())?;
//! assert!(found.sets.iter().any(|set| set.clips() == 2 && set.instances.len() >= 4));
//! # Ok(())
//! # }
//! ```

mod candidates;
mod cover;
mod error;
mod neighbours;
mod revise;
mod schedule;
mod sets;
mod shapes;
mod split;
mod votes;

use rayon::prelude::*;

use crate::TimeSpan;
use crate::features::{RowLayout, Rows};
use crate::pca::{ComponentCount, Moments, Pca};
use crate::progress::Progress;
use crate::templates::Metric;
use crate::train::{ridged, within_groups};
pub use error::DiscoverError;
pub use sets::{Discovery, LoneStretch, RepetitionSet, SetInstance};

use candidates::{Movement, MovingStretch};
use neighbours::Neighbours;
use revise::SetExemplars;
use shapes::ShapeTable;

/// Share of the variance of all rows that is kept: with fewer components nearest neighbours become wrong.
const VARIANCE_KEPT: f64 = 0.99;
/// Rounds of revision.
const ROUNDS: usize = 2;
/// What a stretch seen once is worth less than its moving time, so that one stretch is better than its parts.
const ALONE_PRICE_SECS: f64 = 0.15;

/// Parameters of [`discover`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct DiscoverParams {
    /// The sets of a first pass teach a second one the metric, which takes twice the time. Better where nobody rests between motions, slightly
    /// worse at telling people's ways of one gesture from another gesture.
    pub learned: bool,
}

impl Default for DiscoverParams {
    fn default() -> Self {
        Self { learned: true }
    }
}

/// Bounds of a pass: on `r`, and on support of votes.
#[derive(Debug, Clone, Copy)]
struct PassBounds {
    theta: f32,
    cap: f32,
}

/// Support from which sets are joined.
const SUPPORT: f64 = 0.35;
/// Votes count up to this `r`; after a revision too.
const CAP: f32 = 1.2;

impl DiscoverParams {
    fn passes(self) -> (PassBounds, Option<PassBounds>) {
        let pass = |theta, cap| PassBounds { theta, cap };
        match self.learned {
            false => (pass(0.55, CAP), None),
            true => (pass(0.6, CAP), Some(pass(0.75, 1.6))),
        }
    }

    /// Bound on `r` in revision, and support from which revised sets are joined.
    fn revision(self) -> (f32, f64) {
        if self.learned {
            (1.0, SUPPORT)
        } else {
            (0.9, 0.3)
        }
    }
}

/// Sets of the same motion in feature rows of `clips`, which must all be over the same bones. The same clips give the same sets. O(candidates²)
/// for the comparison, 3 to 4 kilobytes a candidate; 7 to 12 candidates a second of motion.
///
/// # Errors
/// Rows of different or unknown width, a rate or a value that makes no sense; the receiver of progress cancelled.
pub fn discover(
    clips: &[Rows],
    tick_hz: f64,
    params: &DiscoverParams,
    progress: &dyn Progress,
) -> Result<Discovery, DiscoverError> {
    let Some(layout) = check(clips, tick_hz)? else {
        return Ok(Discovery::default());
    };
    let movements: Vec<Movement> = clips
        .par_iter()
        .map(|rows| Movement::of(rows, layout, tick_hz))
        .collect();
    let of_clips: Vec<Vec<MovingStretch>> = movements
        .par_iter()
        .enumerate()
        .map(|(clip, m)| m.candidates(clip))
        .collect();
    let stretches: Vec<MovingStretch> = of_clips.into_iter().flatten().collect();
    let moving_secs = movements.iter().map(Movement::moving_secs).sum();
    let nothing = Discovery {
        moving_secs,
        ..Discovery::default()
    };
    let mut moments = Moments::new(layout.dim());
    clips.iter().for_each(|rows| moments.push_rows(rows));
    let Ok(pca) = Pca::fit(&moments, ComponentCount::Quality(VARIANCE_KEPT)) else {
        return Ok(nothing);
    };
    let mut rows: Vec<Rows> = clips.par_iter().map(|rows| pca.project(rows)).collect();

    let (first, second) = params.passes();
    let mut shapes = ShapeTable::of(&rows, &stretches);
    let mut sets = sets_of(&stretches, &shapes, first, progress)?;
    if let Some(second) = second.filter(|_| !sets.is_empty()) {
        let metric = learned_metric(&shapes, &sets);
        rows = rows.par_iter().map(|rows| metric.apply_all(rows)).collect();
        shapes = ShapeTable::of(&rows, &stretches);
        sets = sets_of(&stretches, &shapes, second, progress)?;
    }
    sets.retain(|set| set.len() > 1);
    let (bound, support) = params.revision();
    for round in 0..ROUNDS {
        if progress.cancelled() {
            return Err(DiscoverError::Cancelled);
        }
        progress.report("revising", round, ROUNDS);
        ranked(&mut sets, &stretches);
        sets = revise::revise(&sets, &stretches, &shapes, bound);
        ranked(&mut sets, &stretches);
        let parts = split::by_clip(&sets, &stretches);
        sets = votes::vote(&parts, &shapes, CAP, support, true);
    }
    ranked(&mut sets, &stretches);
    let exemplars = SetExemplars::of(&sets, &stretches, &shapes);
    let alone = alone(&sets, &stretches, &exemplars, bound, tick_hz);
    let set = |(number, members): (usize, &Vec<usize>)| {
        motion_set(number, members, &stretches, &exemplars, tick_hz)
    };
    let members = sets.iter().flatten();
    Ok(Discovery {
        moving_in_sets_secs: members.map(|&m| stretches[m].moving_secs).sum(),
        sets: sets.iter().enumerate().map(set).collect(),
        alone,
        moving_secs,
    })
}

/// The layout of the rows; `None` if there is no clip.
fn check(clips: &[Rows], tick_hz: f64) -> Result<Option<RowLayout>, DiscoverError> {
    if !(tick_hz > 0.0 && tick_hz <= 1000.0) {
        return Err(DiscoverError::Rate(tick_hz));
    }
    let Some(expected) = clips.first().map(Rows::dim) else {
        return Ok(None);
    };
    let layout = RowLayout::from_dim(expected).ok_or(DiscoverError::Layout(expected))?;
    if layout.bones() == 0 {
        return Err(DiscoverError::NoBones);
    }
    for (clip, rows) in clips.iter().enumerate() {
        let found = rows.dim();
        if found != expected {
            return Err(DiscoverError::Width { expected, found });
        }
        let is_wrong = |row: &[f32]| row.iter().any(|v| !v.is_finite());
        if let Some(row) = rows.iter().position(is_wrong) {
            return Err(DiscoverError::NotFinite { clip, row });
        }
    }
    Ok(Some(layout))
}

/// A pass up to the votes.
fn sets_of(
    stretches: &[MovingStretch],
    shapes: &ShapeTable,
    bounds: PassBounds,
    progress: &dyn Progress,
) -> Result<Vec<Vec<usize>>, DiscoverError> {
    let neighbours = Neighbours::of(stretches, shapes, bounds.theta, progress)?;
    let sets = cover::cover(stretches, &neighbours, f64::from(bounds.theta));
    let parts = split::split(split::by_clip(&sets, stretches), shapes);
    Ok(votes::vote(&parts, shapes, bounds.cap, SUPPORT, false))
}

/// `(S_w + tr(S_w)/d I)^(−1/2)`, up to a factor: `S_w` the covariance of members' points about the mean shape of their set.
fn learned_metric(shapes: &ShapeTable, sets: &[Vec<usize>]) -> Metric {
    let dim = shapes.dim();
    let mut points = Rows::new(dim);
    let mut groups = Vec::new();
    for (set, members) in sets
        .iter()
        .enumerate()
        .filter(|(_, members)| members.len() > 1)
    {
        for &member in members {
            for (at, point) in shapes.points(member).enumerate() {
                points.push(&point);
                groups.push((set, at));
            }
        }
    }
    let within = within_groups(&points, &groups);
    let ridged = ridged(&within, &within, 1.0);
    Metric::new(&ridged, &ridged)
}

/// Sorts sets by the moving time that they explain.
fn ranked(sets: &mut [Vec<usize>], stretches: &[MovingStretch]) {
    sets.iter_mut().for_each(|set| set.sort_unstable());
    sets.sort_by(|a, b| {
        explained(b, stretches)
            .total_cmp(&explained(a, stretches))
            .then(a.cmp(b))
    });
}

fn explained(members: &[usize], stretches: &[MovingStretch]) -> f64 {
    let moving = || members.iter().map(|&m| stretches[m].moving_secs);
    moving().sum::<f64>() - moving().fold(0.0, f64::max)
}

fn span(stretch: &MovingStretch, tick_hz: f64) -> TimeSpan {
    TimeSpan::of_frames(stretch.start..stretch.stop, tick_hz)
}

fn motion_set(
    number: usize,
    members: &[usize],
    stretches: &[MovingStretch],
    exemplars: &SetExemplars<'_>,
    tick_hz: f64,
) -> RepetitionSet {
    let instance = |&member: &usize| SetInstance {
        clip: stretches[member].clip,
        span: span(&stretches[member], tick_hz),
        distance: f64::from(exemplars.distance(member, number)),
    };
    RepetitionSet {
        instances: members.iter().map(instance).collect(),
        explained_secs: explained(members, stretches),
    }
}

/// Candidates outside of all sets, those that hold most motion without overlap.
fn alone(
    sets: &[Vec<usize>],
    stretches: &[MovingStretch],
    exemplars: &SetExemplars<'_>,
    bound: f32,
    tick_hz: f64,
) -> Vec<LoneStretch> {
    let mut explained: Vec<usize> = sets.iter().flatten().copied().collect();
    explained.sort_unstable();
    let mut alone = Vec::new();
    for of_clip in stretches.chunk_by(|a, b| a.clip == b.clip) {
        let clip = of_clip[0].clip;
        let first = stretches.partition_point(|s| s.clip < clip);
        let taken = explained.iter().filter(|&&m| stretches[m].clip == clip);
        let taken: Vec<&MovingStretch> = taken.map(|&m| &stretches[m]).collect();
        // Instances are few beside candidates, and in order.
        let is_free = |s: &MovingStretch| {
            let at = taken.partition_point(|t| t.stop <= s.start + 1);
            taken.get(at).is_none_or(|t| !t.overlaps(s))
        };
        let offers = of_clip.iter().enumerate().filter(|(_, s)| is_free(s));
        let worth = offers.map(|(i, s)| (first + i, s.moving_secs - ALONE_PRICE_SECS));
        let chosen =
            schedule::schedule(worth.filter(|(_, worth)| *worth > 0.0).collect(), stretches);
        alone.extend(chosen);
    }
    let stretch = |i: usize| LoneStretch {
        clip: stretches[i].clip,
        span: span(&stretches[i], tick_hz),
        nearest: exemplars
            .nearest_sets(i, bound)
            .first()
            .map(|&(r, set)| (set, f64::from(r))),
    };
    alone.into_par_iter().map(stretch).collect()
}

#[cfg(test)]
mod tests;
