//! Groups of stretches that are alike.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use clap::ValueEnum;
use morec::TimeSpan;
use morec::cluster::{
    AffinityParams, Clusters, Hierarchy, KwasForm, KwasParams, Spectrum, affinity_propagation,
    kwas_clusters, resampled, squared_distance,
};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec::progress::Progress;
use morec_db::labels::{SampleFilter, SampleId, SampleState};
use morec_db::rows::ClipRows;
use morec_db::{ClipFilter, ClipId, DbError, MotionDb, SegmentKind};
use serde::{Deserialize, Serialize};

use crate::OperationError;
use crate::words::share;

/// Which stretches are grouped, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct GroupSettings {
    /// Stretches to group [default: samples if there are labels, else cuts]
    #[arg(long, value_enum)]
    pub of: Option<Grouping>,
    /// Only samples of these classes, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    pub classes: Vec<String>,
    /// Method of grouping
    #[arg(long, value_enum, default_value = "affinity")]
    pub method: GroupMethod,
    /// Number of groups: higher gives more, 0 to 1 (affinity)
    ///
    /// Preference of a sample to represent a group, as a quantile of similarities.
    #[arg(long, value_name = "Q", value_parser = share, default_value_t = AffinityParams::default().preference)]
    pub preference: f64,
    /// Number of groups (hierarchy)
    #[arg(long, value_name = "N", conflicts_with = "height")]
    pub groups: Option<usize>,
    /// Mean distance at which groups stay apart (hierarchy)
    #[arg(long, value_name = "DISTANCE")]
    pub height: Option<f64>,
    /// Similarity above which two samples are in one group (kwas)
    #[arg(hide_short_help = true, long, value_name = "TAU", value_parser = share, default_value_t = KwasParams::default().tau)]
    pub tau: f64,
    /// Principal directions of a sample that count (kwas)
    #[arg(hide_short_help = true, short, long, value_name = "N", default_value_t = KwasParams::default().k)]
    pub k: usize,
    /// Scale similarity so that a sample has 1 with itself (kwas)
    #[arg(hide_short_help = true, long)]
    pub normalised: bool,
}

/// Stretches to group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Grouping {
    /// Segments that morec cut found
    Cuts,
    /// Labelled samples
    Labels,
    /// Whole clips
    Clips,
}

/// How samples are grouped, and by what distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum GroupMethod {
    /// Affinity propagation over evenly resampled rows
    #[default]
    Affinity,
    /// Average linkage over evenly resampled rows
    Hierarchy,
    /// Principal directions of poses, as in the thesis of 2009
    Kwas,
}

impl Default for GroupSettings {
    fn default() -> Self {
        let (affinity, kwas) = (AffinityParams::default(), KwasParams::default());
        Self {
            of: None,
            classes: Vec::new(),
            method: GroupMethod::default(),
            preference: affinity.preference,
            groups: None,
            height: None,
            tau: kwas.tau,
            k: kwas.k,
            normalised: kwas.form == KwasForm::Normalised,
        }
    }
}

/// A stretch of a clip of a database, to be grouped.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupedStretch {
    /// Number of the clip.
    pub clip: ClipId,
    /// Where it lies.
    pub span: TimeSpan,
    /// Its number and class, if it is a sample.
    pub sample: Option<(SampleId, String)>,
    /// Its rows, over the bones that all stretches show.
    pub rows: Rows,
}

impl GroupSettings {
    /// The stretches of a database that are grouped: of cuts, where nothing else is said. Such as hold no tick of motion are left out.
    ///
    /// # Errors
    /// A class that there is not; the database cannot be read, or the receiver of progress cancelled.
    pub fn stretches(
        &self,
        db: &MotionDb,
        progress: &dyn Progress,
    ) -> Result<Vec<GroupedStretch>, DbError> {
        let mut classes = self.classes.iter();
        classes.try_for_each(|class| db.need_class(class))?;
        let params = FeatureParams::default();
        let rows = db.rows_kept_if_writable(&params, progress)?;
        let rows: BTreeMap<ClipId, ClipRows> = rows.into_iter().map(|r| (r.clip, r)).collect();
        let chosen = self.chosen(db)?;
        let shown = chosen.iter().filter_map(|(clip, ..)| rows.get(clip));
        let bones = shown.map(|r| r.bones).reduce(BoneSet::and);
        let bones = bones.unwrap_or(BoneSet::NONE);
        let with_rows = |(clip, span, sample): ChosenStretch| {
            let of = rows.get(&clip)?;
            let ticks = span.frames_among(of.rows.len(), params.tick_hz());
            let kept = RowLayout::kept_columns(of.bones, bones);
            (!ticks.is_empty()).then(|| GroupedStretch {
                clip,
                span,
                sample,
                rows: of.rows.slice(ticks).columns(&kept),
            })
        };
        Ok(chosen.into_iter().filter_map(with_rows).collect())
    }

    fn chosen(&self, db: &MotionDb) -> Result<Vec<ChosenStretch>, DbError> {
        Ok(match self.of.unwrap_or(Grouping::Cuts) {
            Grouping::Clips => {
                let clips = db.clips(&ClipFilter::default())?.into_iter();
                let whole = |c: morec_db::ClipInfo| TimeSpan::new(0.0, c.duration_secs());
                clips.map(|c| (c.id, whole(c), None)).collect()
            }
            Grouping::Cuts => {
                let segments = db.segments()?.into_iter();
                let moving = segments.filter(|s| s.kind == SegmentKind::Motion);
                moving.map(|s| (s.clip, s.span, None)).collect()
            }
            Grouping::Labels => {
                let accepted = db.samples(&SampleFilter {
                    state: Some(SampleState::Accepted),
                    ..SampleFilter::default()
                })?;
                let is_wanted =
                    |class: &String| self.classes.is_empty() || self.classes.contains(class);
                let wanted = accepted.into_iter().filter(|s| is_wanted(&s.class));
                let chosen = wanted.map(|s| (s.clip, s.span(), Some((s.id, s.class))));
                chosen.collect()
            }
        })
    }

    /// Groups of rows that all have the same columns. O(stretches²) distances.
    ///
    /// # Errors
    /// No direction counts (kwas).
    pub fn clusters<'a>(
        &self,
        rows: impl Iterator<Item = &'a Rows>,
    ) -> Result<Clusters, OperationError> {
        if self.method == GroupMethod::Kwas {
            let spectra: Vec<Spectrum> = rows.map(Spectrum::of_rows).collect();
            return Ok(kwas_clusters(&spectra, &self.kwas()?));
        }
        let shapes = Shapes::of(rows);
        let count = shapes.0.len();
        Ok(match (self.method, self.groups, self.height) {
            (GroupMethod::Hierarchy, Some(groups), _) => shapes.hierarchy().into_clusters(groups),
            (GroupMethod::Hierarchy, None, Some(height)) => shapes.hierarchy().at_height(height),
            (GroupMethod::Hierarchy, None, None) => {
                let groups = (count as f64).sqrt().ceil() as usize;
                shapes.hierarchy().into_clusters(groups)
            }
            _ => {
                let params = AffinityParams {
                    preference: self.preference,
                    ..AffinityParams::default()
                };
                let alike = |a: usize, b: usize| -shapes.apart(&shapes.0[a], b);
                affinity_propagation(count, alike, &params)
            }
        })
    }

    /// The parameters of the thesis's grouping.
    ///
    /// # Errors
    /// No direction counts.
    pub fn kwas(&self) -> Result<KwasParams, OperationError> {
        if self.k == 0 {
            let none = "k is 0: at least one direction must count";
            return Err(OperationError::Settings(none.to_owned()));
        }
        let form = match self.normalised {
            true => KwasForm::Normalised,
            false => KwasForm::Printed,
        };
        Ok(KwasParams {
            k: self.k,
            tau: self.tau,
            form,
        })
    }
}

/// Clip, span, and number and class of a sample.
type ChosenStretch = (ClipId, TimeSpan, Option<(SampleId, String)>);

/// Members of clusters, the largest first.
pub fn largest_first(clusters: &Clusters) -> Vec<Vec<usize>> {
    let mut groups = clusters.members();
    groups.sort_by_key(|group| Reverse(group.len()));
    groups
}

/// Rows of stretches, brought to one length: what is compared at an even pace.
#[derive(Debug, Clone)]
pub struct Shapes(Vec<Vec<f32>>);

impl Shapes {
    /// Rows that a stretch of any length becomes.
    const POINTS: usize = 16;

    /// Of rows that all have the same columns.
    pub fn of<'a>(rows: impl Iterator<Item = &'a Rows>) -> Self {
        Self(rows.map(|rows| resampled(rows, Self::POINTS)).collect())
    }

    fn apart(&self, shape: &[f32], of: usize) -> f64 {
        squared_distance(shape, &self.0[of], Self::POINTS)
    }

    /// Average linkage of all.
    pub fn hierarchy(&self) -> Hierarchy {
        let distance = |a: usize, b: usize| self.apart(&self.0[a], b).sqrt();
        Hierarchy::average(self.0.len(), distance)
    }

    /// Some of them in the order of how far they are from their mean, outliers first.
    pub fn outliers_first(&self, mut members: Vec<usize>) -> Vec<usize> {
        let mut mean = vec![0f32; self.0.first().map_or(0, Vec::len)];
        let share = 1.0 / members.len() as f32;
        for member in &members {
            let values = mean.iter_mut().zip(&self.0[*member]);
            values.for_each(|(mean, value)| *mean += share * value);
        }
        let off = |member: &usize| self.apart(&mean, *member);
        members.sort_by(|a, b| off(b).total_cmp(&off(a)));
        members
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_group_begins_with_what_is_farthest_from_its_own_mean() {
        let places = [0.0, 0.1, 9.0, -0.8, 9.5, 0.4];
        let rows = places.map(|place| Rows::from_values(1, vec![place; 3]));
        let shapes = Shapes::of(rows.iter());
        let groups = |count: usize| {
            let clusters = shapes.hierarchy().into_clusters(count);
            let groups = largest_first(&clusters).into_iter();
            groups.map(|g| shapes.outliers_first(g)).collect::<Vec<_>>()
        };
        // The means are -0.075 and 9.25: within a group, distance from everything else does not count.
        let two = groups(2);
        assert_eq!(two[0], [3, 5, 1, 0]);
        assert_eq!(two[1].len(), 2);
        // As one group the mean is 3.03.
        assert_eq!(groups(1), [[4, 2, 3, 0, 1, 5]]);
    }
}
