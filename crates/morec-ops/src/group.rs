//! Grouping: clusters of similar stretches.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use clap::ValueEnum;
use morec::TimeSpan;
use morec::cluster::{
    AffinityParams, Clusters, Dendrogram, Hierarchy, KwasForm, KwasParams, Spectrum, kwas_clusters,
};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::progress::Progress;
use morec::train::thesis::{SvrdmTrainParams, tree_of_samples};
use morec_db::labels::{SampleFilter, SampleId, SampleState};
use morec_db::rows::ClipRows;
use morec_db::{ClipFilter, ClipId, DbError, MotionDb, SegmentKind};
use serde::{Deserialize, Serialize};

use crate::OperationError;
use crate::shapes::Shapes;
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
    /// Tendency towards many groups, 0 to 1 (affinity)
    ///
    /// The preference of affinity propagation, as a quantile of all similarities: 0.5 is the median. A higher preference gives
    /// more groups.
    #[arg(long, value_name = "Q", value_parser = share, default_value_t = AffinityParams::default().preference)]
    pub preference: f64,
    /// Number of groups (hierarchy, tree)
    #[arg(long, value_name = "N", conflicts_with = "height")]
    pub groups: Option<usize>,
    /// Join groups up to this mean distance, instead of --groups (hierarchy)
    #[arg(long, value_name = "DISTANCE")]
    pub height: Option<f64>,
    /// Divide these groups in two (hierarchy, tree)
    ///
    /// Use the group numbers that are printed without this option.
    #[arg(long, value_delimiter = ',', value_name = "GROUPS")]
    pub divide: Vec<usize>,
    /// Join each of these groups with its sibling branch (hierarchy, tree)
    ///
    /// Use the group numbers that are printed without this option.
    #[arg(long, value_delimiter = ',', value_name = "GROUPS")]
    pub join: Vec<usize>,
    /// Similarity above which two samples are in one group (kwas)
    #[arg(hide_short_help = true, long, value_name = "TAU", value_parser = share, default_value_t = KwasParams::default().tau)]
    pub tau: f64,
    /// Number of principal directions compared (kwas)
    #[arg(hide_short_help = true, short, long, value_name = "N", default_value_t = KwasParams::default().k)]
    pub k: usize,
    /// Scale similarity so that each sample has 1 with itself (kwas)
    #[arg(hide_short_help = true, long)]
    pub normalised: bool,
    /// Centre of samples before comparison (kwas, tree)
    #[arg(hide_short_help = true, long, value_enum, default_value = "database")]
    pub centre: Centre,
    /// Share of the variance to keep (kwas, tree)
    #[arg(
        hide_short_help = true,
        long,
        value_name = "SHARE",
        default_value_t = QUALITY
    )]
    pub quality: f64,
    /// Keep N dimensions instead (kwas, tree)
    #[arg(
        hide_short_help = true,
        long,
        value_name = "N",
        conflicts_with = "quality"
    )]
    pub dims: Option<usize>,
}

/// Share of the variance that is kept unless another is chosen.
const QUALITY: f64 = 0.99;

/// Point on which samples are centred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Centre {
    /// The mean of all poses, which are then reduced to --quality or --dims: samples are many small clusters
    #[default]
    Database,
    /// Nothing, and all dimensions are kept: the mean pose counts, samples are more alike, and --tau belongs near 1
    None,
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
    /// The tree of the classifier of 2009 over single samples
    Tree,
}

impl GroupMethod {
    /// True of those of 2009, which look at pose rows: joint rotations, reduced.
    pub fn looks_at_poses(self) -> bool {
        matches!(self, Self::Kwas | Self::Tree)
    }
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
            divide: Vec::new(),
            join: Vec::new(),
            tau: kwas.tau,
            k: kwas.k,
            normalised: kwas.form == KwasForm::Normalised,
            centre: Centre::default(),
            quality: QUALITY,
            dims: None,
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
    /// Its rows: of features, over the bones that all stretches show, or of reduced poses.
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
    ) -> Result<Vec<GroupedStretch>, OperationError> {
        let mut classes = self.classes.iter();
        classes.try_for_each(|class| db.need_class(class))?;
        if self.method.looks_at_poses() {
            return self.posed(db, progress);
        }
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

    /// The stretches as pose rows, reduced by the components of all clips of the database.
    fn posed(
        &self,
        db: &MotionDb,
        progress: &dyn Progress,
    ) -> Result<Vec<GroupedStretch>, OperationError> {
        let (set, params) = (PivotSet::thesis(), PoseParams::default());
        let mut of_clip: BTreeMap<ClipId, Vec<ChosenStretch>> = BTreeMap::new();
        for chosen in self.chosen(db)? {
            of_clip.entry(chosen.0).or_default().push(chosen);
        }
        let clips = db.clips(&ClipFilter::default())?;
        let (mut moments, mut found) = (Moments::new(set.row_dim()), Vec::new());
        for (done, info) in clips.iter().enumerate() {
            progress.report("making pose rows", done, clips.len());
            if progress.cancelled() {
                return Err(DbError::Cancelled.into());
            }
            let stored = db.clip(info.id)?;
            let map = PivotMap::of_clip(&set, &stored.clip, &stored.roles)
                .map_err(|e| OperationError::Settings(format!("{}: {e}", info.name)))?;
            let rows = pose_rows_of_clip(&stored.clip, &set, &map, &stored.rest, &params);
            moments.push_rows(&rows);
            for (clip, span, sample) in of_clip.remove(&info.id).unwrap_or_default() {
                let frames = span.frames_among(rows.len(), params.rate_hz);
                if !frames.is_empty() {
                    found.push(GroupedStretch {
                        clip,
                        span,
                        sample,
                        rows: rows.slice(frames),
                    });
                }
            }
        }
        if let Some(pca) = self.reduction(&moments)? {
            found
                .iter_mut()
                .for_each(|of| of.rows = pca.project(&of.rows));
        }
        Ok(found)
    }

    /// The components that pose rows are reduced to: of all poses, whose moments these are. None where samples are not centred.
    ///
    /// # Errors
    /// A share or number of dimensions that cannot be.
    pub fn reduction(&self, moments: &Moments) -> Result<Option<Pca>, OperationError> {
        if self.centre == Centre::None {
            return Ok(None);
        }
        let keep = self
            .dims
            .map_or(ComponentCount::Quality(self.quality), ComponentCount::Dims);
        keep.check().map_err(OperationError::Settings)?;
        let pca = Pca::fit(moments, keep);
        pca.map(Some)
            .map_err(|e| OperationError::Settings(e.to_string()))
    }

    /// Groups of rows that all have the same columns. O(stretches²) distances.
    ///
    /// # Errors
    /// No direction counts (kwas), too many stretches (tree), or a group that there is not.
    pub fn clusters<'a>(
        &self,
        rows: impl Iterator<Item = &'a Rows>,
    ) -> Result<Clusters, OperationError> {
        let rows: Vec<&Rows> = rows.collect();
        match self.method {
            GroupMethod::Kwas => {
                let spectra: Vec<Spectrum> = rows.iter().map(|r| Spectrum::of_rows(r)).collect();
                Ok(kwas_clusters(&spectra, &self.kwas()?))
            }
            GroupMethod::Affinity => {
                let shapes = Shapes::of(rows.into_iter());
                let params = AffinityParams {
                    preference: self.preference,
                    ..AffinityParams::default()
                };
                Ok(shapes.affinity(&params))
            }
            GroupMethod::Hierarchy => self.cut(&Shapes::of(rows.into_iter()).hierarchy()),
            GroupMethod::Tree => self.cut(&self.tree(&rows)?),
        }
    }

    /// The tree of single samples, which are reduced pose rows.
    ///
    /// # Errors
    /// More samples than can be grown a tree of, or rows of too many values or too few.
    pub fn tree(&self, rows: &[&Rows]) -> Result<Hierarchy, OperationError> {
        if rows.len() > MOST_IN_TREE {
            return Err(OperationError::Settings(format!(
                "tree: expected at most {MOST_IN_TREE} stretches, found {}; choose some with --classes",
                rows.len()
            )));
        }
        let rows: Vec<Rows> = rows.iter().map(|rows| (*rows).clone()).collect();
        let tree = tree_of_samples(&rows, &SvrdmTrainParams::default());
        tree.map_err(|e| OperationError::Settings(e.to_string()))
    }

    /// The groups of a hierarchy: as many as asked for, then branch by branch.
    fn cut(&self, hierarchy: &Hierarchy) -> Result<Clusters, OperationError> {
        let nodes = Dendrogram::of(hierarchy);
        let usual = (hierarchy.items() as f64).sqrt().ceil() as usize;
        let at_height = || self.height.map(|height| hierarchy.groups_at(height));
        let mut cut = nodes.cut(self.groups.or_else(at_height).unwrap_or(usual));
        let groups = nodes.largest_first(&cut);
        let numbered = |option: &str, number: &usize| {
            let group = number.checked_sub(1).and_then(|at| groups.get(at));
            group.map(|(node, _)| *node).ok_or_else(|| {
                let (number, count) = (*number, groups.len());
                OperationError::Settings(format!(
                    "{option} {number}: the groups are numbered 1 to {count}"
                ))
            })
        };
        for number in &self.divide {
            nodes.divide(&mut cut, numbered("divide", number)?);
        }
        for number in &self.join {
            nodes.join(&mut cut, numbered("join", number)?);
        }
        Ok(nodes.clusters(&cut))
    }

    /// The parameters of the thesis's grouping.
    ///
    /// # Errors
    /// No direction counts.
    pub fn kwas(&self) -> Result<KwasParams, OperationError> {
        if self.k == 0 {
            let none = "k must be 1 or more, found 0";
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

/// The tree of single samples takes the square of this at each parting.
pub const MOST_IN_TREE: usize = 600;

/// Clip, span, and number and class of a sample.
type ChosenStretch = (ClipId, TimeSpan, Option<(SampleId, String)>);

/// Members of clusters, the largest first.
pub fn largest_first(clusters: &Clusters) -> Vec<Vec<usize>> {
    let mut groups = clusters.members();
    groups.sort_by_key(|group| Reverse(group.len()));
    groups
}
