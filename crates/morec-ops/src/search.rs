//! Search by example.

use morec::clip::{Clip, Span};
use morec::features::{FeatureParams, bones_of_clip, rows_of_clip};
use morec::roles::RoleMap;
use morec_db::labels::{SampleFilter, SampleState};
use morec_db::search::{Example, LearnedMetric, SearchIndex, SearchOptions};
use morec_db::{DbError, MotionDb};
use serde::{Deserialize, Serialize};

/// How a database is searched for motions like an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct SearchSettings {
    /// Also find mirrored motions
    #[arg(long)]
    pub mirror: bool,
    /// At most N
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub limit: usize,
    /// Only the best hit of each clip
    #[arg(long)]
    pub one_a_clip: bool,
    /// Learn from accepted samples which differences matter
    ///
    /// Needs two classes with two samples each.
    #[arg(long)]
    pub learned: bool,
    /// Learn from these classes only, separated by commas
    #[arg(
        long,
        value_name = "CLASSES",
        value_delimiter = ',',
        requires = "learned"
    )]
    pub classes: Vec<String>,
    /// Weight of the exact path, 0 to 1, against the summary
    #[arg(long, value_name = "SHARE", default_value_t = SearchOptions::default().warp_share)]
    pub warp_share: f32,
}

impl Default for SearchSettings {
    fn default() -> Self {
        let usual = SearchOptions::default();
        Self {
            mirror: usual.mirror,
            limit: usual.limit,
            one_a_clip: usual.one_a_clip,
            learned: false,
            classes: Vec::new(),
            warp_share: usual.warp_share,
        }
    }
}

impl SearchSettings {
    /// What concerns the order of hits, but for a learned metric.
    pub fn options(&self) -> SearchOptions {
        SearchOptions {
            limit: self.limit,
            mirror: self.mirror,
            one_a_clip: self.one_a_clip,
            warp_share: self.warp_share.clamp(0.0, 1.0),
        }
    }

    /// The metric that the accepted samples teach, if one is to be learned.
    ///
    /// # Errors
    /// A class that there is not, too few samples; the database cannot be read.
    pub fn metric(
        &self,
        db: &MotionDb,
        index: &SearchIndex,
    ) -> Result<Option<LearnedMetric>, DbError> {
        if !self.learned {
            return Ok(None);
        }
        let mut classes = self.classes.iter();
        classes.try_for_each(|class| db.need_class(class))?;
        let mut samples = db.samples(&SampleFilter {
            state: Some(SampleState::Accepted),
            ..SampleFilter::default()
        })?;
        samples.retain(|s| self.classes.is_empty() || self.classes.contains(&s.class));
        index.learn(&samples).map(Some)
    }
}

/// The stretch from `start_secs` (to the end without `stop_secs`) of a clip that is in no database, as an example.
///
/// # Errors
/// It is shorter than 0.1 s.
pub fn example_of_clip(
    (clip, roles, rest): (&Clip, &RoleMap, &Span),
    start_secs: f64,
    stop_secs: Option<f64>,
) -> Result<Example, DbError> {
    let params = FeatureParams::default();
    let bones = bones_of_clip(clip, roles, rest);
    let rows = rows_of_clip(clip, roles, rest, bones, &params);
    let tick = |secs: f64| ((secs * params.tick_hz()).round().max(0.0) as usize).min(rows.len());
    let (start, stop) = (tick(start_secs), stop_secs.map_or(rows.len(), tick));
    let span = rows.slice(start..stop.max(start));
    let all = span.len() == rows.len();
    let example = SearchIndex::example_of(&span, bones);
    let example = example.ok_or_else(|| too_short(&clip.name))?;
    Ok(if all { example } else { example.cut_out() })
}

/// The same of a clip of the database.
///
/// # Errors
/// It is shorter than 0.1 s, or there is no clip of this name.
pub fn example_of_database(
    db: &MotionDb,
    index: &SearchIndex,
    name: &str,
    start_secs: f64,
    stop_secs: Option<f64>,
) -> Result<Example, DbError> {
    let info = db.find_clip(name)?;
    let stop_secs = stop_secs.unwrap_or(info.duration_secs());
    let example = index.example(info.id, start_secs..stop_secs);
    example.ok_or_else(|| too_short(name))
}

fn too_short(name: &str) -> DbError {
    DbError::Invalid(format!(
        "{name}: the example must contain at least 0.1 s of motion"
    ))
}
