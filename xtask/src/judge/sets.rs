//! Data sets: clips and the samples in them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use morec::TimeSpan;
use morec::files;
use morec::labels::{ClipLength, Labels, Sample, read_people};
use morec::train::TrainClip;

/// Clips with their people, and samples in them.
#[derive(Default)]
pub struct MotionSet {
    pub clips: Vec<TrainClip>,
    pub samples: Vec<Sample>,
}

impl MotionSet {
    /// Clips of a folder without labels; nothing where the folder is absent.
    pub fn unlabelled(folder: &Path) -> Result<Self> {
        if !folder.exists() {
            return Ok(Self::default());
        }
        let takes = files::open_all(folder).with_context(|| folder.display().to_string())?;
        let clips = takes.into_iter().map(TrainClip::from).collect();
        Ok(Self {
            clips,
            samples: Vec::new(),
        })
    }

    /// Clips of a folder, and the samples that `labels` names in them.
    pub fn labelled(folder: &Path, labels: &Path) -> Result<Self> {
        let mut set = Self::unlabelled(folder)?;
        if set.clips.is_empty() {
            return Ok(set);
        }
        let lengths: BTreeMap<String, ClipLength> = set
            .clips
            .iter()
            .map(|c| {
                let (frames, rate_hz) = (c.clip.frames, c.clip.rate_hz);
                (c.name.clone(), ClipLength { frames, rate_hz })
            })
            .collect();
        set.samples = Labels::from_path(labels)?.resolve(&lengths).samples;
        let persons = set.samples.iter();
        let persons: BTreeMap<String, Option<String>> = persons
            .map(|s| (s.clip.clone(), s.person.clone()))
            .collect();
        for clip in &mut set.clips {
            clip.person = persons.get(&clip.name).cloned().flatten();
        }
        Ok(set)
    }

    /// Names the person of each clip by a table, or by the clip itself.
    pub fn with_people(
        mut self,
        table: Option<&Path>,
        of_name: fn(&str) -> String,
    ) -> Result<Self> {
        let people = match table {
            Some(path) if path.exists() => read_people(&std::fs::read(path)?)?.by_clip,
            _ => BTreeMap::new(),
        };
        for clip in &mut self.clips {
            let named = people.get(&clip.name).cloned();
            clip.person = Some(named.unwrap_or_else(|| of_name(&clip.name)));
        }
        for sample in &mut self.samples {
            let clip = self.clips.iter().find(|c| c.name == sample.clip);
            sample.person = clip.and_then(|c| c.person.clone());
        }
        Ok(self)
    }

    /// Only samples of these classes.
    pub fn of_classes(&self, classes: &[&str]) -> Vec<Sample> {
        let wanted = |s: &&Sample| classes.contains(&s.class.as_str());
        self.samples.iter().filter(wanted).cloned().collect()
    }

    /// Clips whose name begins with one of `starts`.
    pub fn named<'s>(&'s self, starts: &[&str]) -> Vec<&'s TrainClip> {
        let named = |c: &&TrainClip| starts.iter().any(|start| c.name.starts_with(start));
        self.clips.iter().filter(named).collect()
    }
}

/// All data sets of the folder; those that are absent are empty.
pub struct DataSets {
    pub referee: MotionSet,
    pub exercises: MotionSet,
    pub segmentation: MotionSet,
    /// Everyday and unusual motion without labels.
    pub free: MotionSet,
    pub everyday: MotionSet,
    /// Clips of gestures, those that teach sessions among them.
    pub gestures: MotionSet,
    pub session_lessons: Vec<Sample>,
    pub sessions: MotionSet,
    pub actions: MotionSet,
    pub action_sessions: MotionSet,
    pub hands: MotionSet,
}

impl DataSets {
    pub fn read(data: &Path) -> Result<Self> {
        let at = |path: &str| -> PathBuf { data.join(path) };
        let labelled = |clips: &str, labels: &str| MotionSet::labelled(&at(clips), &at(labels));
        let lessons = labelled("gestures/clips", "sessions/teach.tsv")?.samples;
        let of_gesture = |name: &str| name.split('_').next().unwrap_or("").to_owned();
        let of_style = |name: &str| name.rsplit('_').nth(1).unwrap_or("").to_owned();
        Ok(Self {
            referee: labelled("referee/clips", "referee/labels.tsv")?
                .with_people(Some(&at("referee/people.tsv")), str::to_owned)?,
            exercises: labelled("exercises/clips", "exercises/labels.tsv")?,
            segmentation: MotionSet::unlabelled(&at("segmentation/clips"))?,
            free: MotionSet::unlabelled(&at("cmu/clips"))?,
            everyday: labelled("everyday/clips", "everyday/clips.tsv")?
                .with_people(None, of_style)?,
            gestures: labelled("gestures/clips", "gestures/clips.tsv")?
                .with_people(None, of_gesture)?,
            session_lessons: lessons,
            sessions: labelled("sessions/clips", "sessions/labels.tsv")?,
            actions: labelled("kinect_actions/clips", "kinect_actions/teach.tsv")?,
            action_sessions: labelled("kinect_actions/sessions", "kinect_actions/labels.tsv")?,
            hands: labelled("hands/clips", "hands/labels.tsv")?,
        })
    }
}

/// Samples of all clips that are named like one that teaches, but for the number at the end.
pub fn whole_clips(set: &MotionSet) -> Vec<Sample> {
    let kind = |name: &str| name.rsplit_once('_').map(|(kind, _)| kind.to_owned());
    let of_clip = |clip: &TrainClip| {
        let alike = set
            .samples
            .iter()
            .find(|s| kind(&s.clip) == kind(&clip.name))?;
        Some(Sample {
            clip: clip.name.clone(),
            span: TimeSpan::new(0.0, clip.clip.duration_secs()),
            ..alike.clone()
        })
    };
    set.clips.iter().filter_map(of_clip).collect()
}
