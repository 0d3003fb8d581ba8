//! Sets of the same motion in clips without labels.

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::discover::{
    DiscoverError, DiscoverParams, Discovery, RepetitionSet, SetInstance, discover,
};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec::labels::some_of;
use morec::progress::Progress;
use morec_db::labels::{NewSample, SampleState};
use morec_db::{ClipFilter, ClipId, DbError, MotionDb};
use serde::{Deserialize, Serialize};

use crate::OperationError;

/// How sets are found.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct DiscoverSettings {
    /// Do not learn a metric from the first sets; takes half the time
    ///
    /// If people rest between motions, the result is as good.
    #[arg(long)]
    pub plain: bool,
    /// Join successive repetitions, so that walking is one stretch
    #[arg(long)]
    pub runs: bool,
}

/// A clip in which sets are looked for.
#[derive(Debug, Clone, PartialEq)]
pub struct DiscoverClip {
    /// Name of the clip.
    pub name: String,
    /// Its number, if it is in a database.
    pub id: Option<ClipId>,
    /// Person in it, if known.
    pub person: Option<String>,
    /// Bones that its rows cover.
    pub bones: BoneSet,
    /// Feature rows, one for each tick.
    pub rows: Rows,
}

/// Sets of the same motion, those that explain most first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DiscoveredSets {
    /// Those that cover the most motion first.
    pub sets: Vec<DiscoveredSet>,
    /// What was seen once, by clip and time.
    pub alone: Vec<AloneStretch>,
    /// Seconds of moving in all clips: time weighted by speed.
    pub moving_secs: f64,
    /// Share of it that lies in sets.
    pub share_in_sets: f64,
    /// Names of clips that share no bone with those searched: of hands beside bodies.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

/// A set of the same motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DiscoveredSet {
    /// Number of the set, from 1.
    pub set: usize,
    /// Median length of an instance.
    pub length_secs: f64,
    /// Number of clips that it is in.
    pub clips: usize,
    /// Number of people who do it, as far as they are known.
    pub people: usize,
    /// Seconds of moving beyond the longest instance.
    pub explained_secs: f64,
    /// By clip and time.
    pub instances: Vec<DiscoveredStretch>,
}

/// An instance of a set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DiscoveredStretch {
    /// Name of the clip.
    pub clip: String,
    /// The clip's number, if it is in a database.
    #[serde(skip)]
    pub id: Option<ClipId>,
    /// When.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Distance from the middle of the set.
    pub distance: f64,
}

/// A stretch that is in no set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AloneStretch {
    /// Name of the clip.
    pub clip: String,
    /// The clip's number, if it is in a database.
    #[serde(skip)]
    pub id: Option<ClipId>,
    /// When.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Number of the nearest set, if any is near.
    pub nearest_set: Option<usize>,
}

impl DiscoverSettings {
    /// The parameters of the method.
    pub fn params(&self) -> DiscoverParams {
        DiscoverParams {
            learned: !self.plain,
        }
    }

    /// Sets in clips of one kind of skeleton, by the bones that all of these show. Where some clips share no bone with others, such as
    /// hands with bodies, the kind with the most time is searched and the other clips are named.
    ///
    /// # Errors
    /// No clip shows a bone; a value that is not finite; the receiver of progress cancelled.
    pub fn of_clips(
        &self,
        clips: &[DiscoverClip],
        progress: &dyn Progress,
    ) -> Result<DiscoveredSets, OperationError> {
        let shown = clips.iter().map(|clip| (clip.bones, clip.rows.len()));
        let bones = BoneSet::most_common(shown);
        let (kept, others): (Vec<_>, Vec<_>) =
            (clips.iter()).partition(|clip| !clip.bones.and(bones).is_empty());
        let rows = kept.iter().map(|clip| {
            let columns = RowLayout::kept_columns(clip.bones, bones);
            clip.rows.columns(&columns)
        });
        let rows: Vec<Rows> = rows.collect();
        let tick_hz = FeatureParams::default().tick_hz();
        let found = discover(&rows, tick_hz, &self.params(), progress).map_err(failed)?;
        let mut found = self.named(&found, &kept);
        found.left_out = others.iter().map(|clip| clip.name.clone()).collect();
        Ok(found)
    }

    /// Sets in the clips of a database that `filter` chooses.
    ///
    /// # Errors
    /// As [`of_clips`](Self::of_clips); the database cannot be read.
    pub fn of_database(
        &self,
        db: &MotionDb,
        filter: &ClipFilter,
        progress: &dyn Progress,
    ) -> Result<DiscoveredSets, OperationError> {
        let rows = db.rows_kept_if_writable(&FeatureParams::default(), progress)?;
        let mut rows: BTreeMap<ClipId, _> = rows.into_iter().map(|r| (r.clip, r)).collect();
        let infos = db.find_clips(filter)?.into_iter();
        let clips = infos.filter_map(|info| {
            let of = rows.remove(&info.id)?;
            Some(DiscoverClip {
                name: info.name,
                id: Some(info.id),
                person: info.subject,
                bones: of.bones,
                rows: of.rows,
            })
        });
        self.of_clips(&clips.collect::<Vec<_>>(), progress)
    }

    fn named(&self, found: &Discovery, clips: &[&DiscoverClip]) -> DiscoveredSets {
        let alone = found.alone.iter().map(|alone| AloneStretch {
            clip: clips[alone.clip].name.clone(),
            id: clips[alone.clip].id,
            span: alone.span,
            nearest_set: alone.nearest.map(|(set, _)| set + 1),
        });
        let sets = (1..).zip(&found.sets);
        DiscoveredSets {
            sets: sets
                .map(|(number, set)| self.named_set(number, set, clips))
                .collect(),
            alone: alone.collect(),
            moving_secs: found.moving_secs,
            share_in_sets: found.share_in_sets(),
            left_out: Vec::new(),
        }
    }

    fn named_set(
        &self,
        number: usize,
        set: &RepetitionSet,
        clips: &[&DiscoverClip],
    ) -> DiscoveredSet {
        let people = set
            .instances
            .iter()
            .filter_map(|of| clips[of.clip].person.as_deref());
        let people: BTreeSet<&str> = people.collect();
        let stretch = |of: &SetInstance| DiscoveredStretch {
            clip: clips[of.clip].name.clone(),
            id: clips[of.clip].id,
            span: of.span,
            distance: of.distance,
        };
        let instances = match self.runs {
            true => set.runs(),
            false => set.instances.clone(),
        };
        DiscoveredSet {
            set: number,
            length_secs: set.length_secs(),
            clips: set.clips(),
            people: people.len(),
            explained_secs: set.explained_secs,
            instances: instances.iter().map(stretch).collect(),
        }
    }
}

impl DiscoveredSets {
    /// Instances as proposed samples of the classes `name_1`, `name_2`, …: what is of a clip of a database.
    pub fn proposals(&self, name: &str) -> Vec<NewSample> {
        let of_set = |set: &DiscoveredSet| {
            let class = format!("{name}_{}", set.set);
            let sample = |of: &DiscoveredStretch| {
                Some(NewSample {
                    clip: of.id?,
                    class: class.clone(),
                    start_secs: of.span.start_secs,
                    stop_secs: of.span.stop_secs,
                    whole_clip: false,
                    state: SampleState::Proposed,
                    score: None,
                })
            };
            set.instances.iter().filter_map(sample).collect::<Vec<_>>()
        };
        self.sets.iter().flat_map(of_set).collect()
    }

    /// `87 repetitions in 12 sets, 83 % of all motion; 14 stretches seen only once`, and which clips were not searched.
    pub fn summary(&self) -> String {
        let instances: usize = self.sets.iter().map(|set| set.instances.len()).sum();
        let left_out = self.left_out().map(|text| format!("; {text}"));
        format!(
            "{instances} repetitions in {} sets, {:.0} % of all motion; {} stretches seen only once{}",
            self.sets.len(),
            100.0 * self.share_in_sets,
            self.alone.len(),
            left_out.unwrap_or_default()
        )
    }

    /// `not searched, having no bone in common with the others: wave_1, wave_2`; `None` if all clips were searched.
    pub fn left_out(&self) -> Option<String> {
        (!self.left_out.is_empty()).then(|| {
            format!(
                "not searched, having no bone in common with the others: {}",
                some_of(&self.left_out)
            )
        })
    }
}

fn failed(error: DiscoverError) -> OperationError {
    match error {
        DiscoverError::Cancelled => OperationError::Database(DbError::Cancelled),
        other => OperationError::Settings(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(name: &str, bones: BoneSet, ticks: usize) -> DiscoverClip {
        let width = RowLayout::of(bones).dim();
        let moving = (0..ticks * width).map(|i| ((i / width) as f32 * 0.4).sin());
        DiscoverClip {
            name: name.to_owned(),
            id: None,
            person: None,
            bones,
            rows: Rows::from_values(width, moving.collect()),
        }
    }

    #[test]
    fn hands_among_bodies_are_left_out_by_name() {
        let clips = [
            clip("wave", BoneSet::HAND, 60),
            clip("walk", BoneSet::BODY, 120),
            clip("run", BoneSet::UPPER, 120),
        ];
        let found = DiscoverSettings::default();
        let found = found.of_clips(&clips, &()).unwrap();
        assert_eq!(found.left_out, ["wave"]);
        assert!(found.summary().ends_with("with the others: wave"));
        let searched = found.sets.iter().flat_map(|set| &set.instances);
        assert!(searched.clone().all(|of| of.clip != "wave"));
    }
}
