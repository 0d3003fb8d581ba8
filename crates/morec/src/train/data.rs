//! Sorts clips and labels into training clips, background and unused clips, with notes about the latter.

use std::collections::{BTreeMap, BTreeSet};

use crate::features::BoneSet;
use crate::labels::{
    ClipLength, Label, Labels, People, Resolved, Sample, hint, said_absent, some_of,
};
use crate::roles::{Role, RoleMap};

use super::{StreamKind, TrainClip};

/// Clips, labels and people as they are given, to learn from and to test on.
#[derive(Debug, Clone, Copy)]
pub struct TrainingMaterial<'a> {
    /// Labelled samples.
    pub labels: &'a Labels,
    /// The person of each clip, where the labels do not say.
    pub people: Option<&'a People>,
    /// The classes to learn, in order; every class of the labels if empty.
    pub classes: &'a [String],
    /// Names of clips that hold none of the classes and are only tested; those of [`StreamKind::Background`] among them also
    /// teach.
    pub unknown: &'a BTreeSet<String>,
}

/// Clips, samples and classes that fit together.
#[derive(Debug, Clone, Default)]
pub struct TrainingData {
    /// Labelled clips that hold a sample, and background.
    pub clips: Vec<TrainClip>,
    /// Samples of the classes in the labelled clips.
    pub samples: Vec<Sample>,
    /// The classes, in order.
    pub classes: Vec<String>,
    /// Clips that hold none of the classes, for testing.
    pub unknown: Vec<TrainClip>,
    /// What was left out or cut, each in a sentence.
    pub notes: Vec<String>,
}

/// Why clips and labels do not make training data.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// Two clips of one name.
    #[error("two clips are called {0}, so labels cannot distinguish them: rename one")]
    SameName(String),
    /// A class was asked for that the labels do not show.
    #[error("no clip has a sample of the requested class {class}{hint}")]
    NoSampleOf {
        /// Name of the class.
        class: String,
        /// Classes of the labels that may have been meant.
        hint: String,
    },
    /// No label lies in any clip.
    #[error(
        "no sample to train on: no label names any of these clips (labels name clips by their file name without the ending)"
    )]
    NoSample,
    /// Times that are probably in another unit.
    #[error("labels: {0}")]
    Unit(String),
}

impl TrainingMaterial<'_> {
    /// Sorts out which of `clips` teach. Clips of [`StreamKind::Labelled`] teach where labels lie in them; labels in
    /// background and unknown clips are not used.
    ///
    /// # Errors
    /// Two clips of one name, a class without a sample, no sample at all, times that are probably in another unit.
    pub fn sort_out(&self, clips: Vec<TrainClip>) -> Result<TrainingData, DataError> {
        let mut labels = self.labels.clone();
        let wanted = |row: &Label| self.classes.is_empty() || self.classes.contains(&row.class);
        labels.rows.retain(wanted);
        if let Some(people) = self.people {
            labels.add_people(people);
        }
        let lengths = lengths(&clips)?;
        let resolved = labels.resolve(&lengths);
        if let Some(why) = resolved.doubtful_unit() {
            return Err(DataError::Unit(why));
        }
        let mut notes = notes(&resolved, &lengths);
        let clips = self.with_people(clips, &resolved.samples);
        let teaches = |clip: &TrainClip| {
            clip.source == StreamKind::Labelled && !self.unknown.contains(&clip.name)
        };
        let teaching: BTreeSet<String> = clips
            .iter()
            .filter(|clip| teaches(clip))
            .map(|clip| clip.name.clone())
            .collect();
        let strangers = strangers(&clips, &teaching, &resolved.samples);
        if !strangers.is_empty() {
            notes.push(format!(
                "{} labelled clips have no bone in common with the others and are not used: {}",
                strangers.len(),
                some_of(&strangers)
            ));
        }
        let (aside, samples): (Vec<_>, Vec<_>) =
            (resolved.samples.into_iter()).partition(|s| strangers.contains(&s.clip));
        let samples = samples.into_iter();
        let (samples, ignored): (Vec<_>, Vec<_>) =
            samples.partition(|s| teaching.contains(&s.clip));
        if !ignored.is_empty() {
            let clips: BTreeSet<&String> = ignored.iter().map(|s| &s.clip).collect();
            notes.push(format!(
                "{} labels are ignored because their clips are given as background or unknown: {}",
                ignored.len(),
                some_of(clips)
            ));
        }
        let aside: BTreeSet<&String> = aside.iter().map(|s| &s.class).collect();
        let classes = self.learned(&samples, &aside)?;
        let unknown = clips.iter().filter(|c| self.unknown.contains(&c.name));
        let unknown = unknown.cloned().map(|clip| TrainClip {
            source: StreamKind::Labelled,
            ..clip
        });
        let unknown = unknown.collect();
        let with_samples: BTreeSet<&str> = samples.iter().map(|s| s.clip.as_str()).collect();
        let (clips, unused): (Vec<_>, Vec<_>) = clips.into_iter().partition(|clip| {
            clip.source != StreamKind::Labelled || with_samples.contains(clip.name.as_str())
        });
        let unused = unused.into_iter().map(|clip| clip.name);
        let unused =
            unused.filter(|name| !self.unknown.contains(name) && !strangers.contains(name));
        let unused: Vec<String> = unused.collect();
        if !unused.is_empty() {
            notes.push(format!(
                "{} clips have no sample of the classes and are not used (if they contain none of the classes, add them as \
                 background): {}",
                unused.len(),
                some_of(&unused)
            ));
        }
        Ok(TrainingData {
            clips,
            samples,
            classes,
            unknown,
            notes,
        })
    }

    /// `clips` with who is seen in them, labelled or not.
    fn with_people(&self, mut clips: Vec<TrainClip>, samples: &[Sample]) -> Vec<TrainClip> {
        let mut people: BTreeMap<&str, &String> = BTreeMap::new();
        let by_clip = self.people.iter().flat_map(|people| &people.by_clip);
        people.extend(by_clip.map(|(clip, person)| (clip.as_str(), person)));
        let labelled = samples
            .iter()
            .filter_map(|s| Some((s.clip.as_str(), s.person.as_ref()?)));
        people.extend(labelled);
        for clip in &mut clips {
            if let Some(person) = people.get(clip.name.as_str()) {
                clip.person = Some((*person).clone());
            }
        }
        clips
    }

    /// The classes to learn: those asked for, or all that samples show, by name. Classes of samples that were set `aside` are not missed.
    fn learned(
        &self,
        samples: &[Sample],
        aside: &BTreeSet<&String>,
    ) -> Result<Vec<String>, DataError> {
        let present: BTreeSet<&String> = samples.iter().map(|s| &s.class).collect();
        if let Some(class) = self
            .classes
            .iter()
            .find(|c| !present.contains(c) && !aside.contains(c))
        {
            let known: BTreeSet<&String> = self.labels.rows.iter().map(|r| &r.class).collect();
            let known: Vec<String> = known.into_iter().cloned().collect();
            return Err(DataError::NoSampleOf {
                class: class.clone(),
                hint: hint(class, &known),
            });
        }
        match (samples.is_empty(), self.classes.is_empty()) {
            (true, _) => Err(DataError::NoSample),
            (_, true) => Ok(present.into_iter().cloned().collect()),
            _ => Ok((self.classes.iter().filter(|c| present.contains(c)).cloned()).collect()),
        }
    }
}

/// The labelled clips that share no bone with those that hold the most labels, going by their roles: one recording of a hand among
/// bodies would leave nothing to learn from.
fn strangers(
    clips: &[TrainClip],
    teaching: &BTreeSet<String>,
    samples: &[Sample],
) -> BTreeSet<String> {
    let mut labels: BTreeMap<&str, usize> = BTreeMap::new();
    for sample in samples.iter().filter(|s| teaching.contains(&s.clip)) {
        *labels.entry(&sample.clip).or_default() += 1;
    }
    let taught = clips.iter().filter_map(|clip| {
        let count = labels.get(clip.name.as_str())?;
        Some((clip, usable_bones(&clip.roles), *count))
    });
    let taught: Vec<_> = taught.collect();
    let common = BoneSet::most_common(taught.iter().map(|(_, bones, count)| (*bones, *count)));
    if common.is_empty() {
        return BTreeSet::new();
    }
    let is_stranger = |bones: BoneSet| common.and(bones).is_empty();
    let strangers = taught.into_iter().filter(|of| is_stranger(of.1));
    strangers.map(|(clip, _, _)| clip.name.clone()).collect()
}

/// The bones that `roles` show. Without hips and shoulders a body has no heading, so that its bones do not count: a hand may have an arm.
fn usable_bones(roles: &RoleMap) -> BoneSet {
    let shown = BoneSet::of_roles(roles);
    let has = |pair: [Role; 2]| pair.iter().all(|role| roles.joint(*role).is_some());
    if has([Role::LeftThigh, Role::RightThigh]) || has([Role::LeftArm, Role::RightArm]) {
        return shown;
    }
    let others = shown
        .indices()
        .filter(|bone| !BoneSet::BODY.contains(*bone));
    others.fold(BoneSet::NONE, BoneSet::with)
}

/// Lengths of clips, by name.
fn lengths(clips: &[TrainClip]) -> Result<BTreeMap<String, ClipLength>, DataError> {
    let mut lengths = BTreeMap::new();
    for clip in clips {
        let length = ClipLength::from(&clip.clip);
        if lengths.insert(clip.name.clone(), length).is_some() {
            return Err(DataError::SameName(clip.name.clone()));
        }
    }
    Ok(lengths)
}

/// What of labels was cut or left out.
fn notes(resolved: &Resolved, clips: &BTreeMap<String, ClipLength>) -> Vec<String> {
    let warnings = resolved.warnings.iter();
    let mut notes: Vec<String> = warnings.map(|w| format!("labels, {w}")).collect();
    if !resolved.absent.is_empty() {
        let known: Vec<String> = clips.keys().cloned().collect();
        notes.push(said_absent(&resolved.absent, &known));
    }
    notes.extend(
        resolved
            .misspelled()
            .into_iter()
            .map(|asked| format!("labels: {asked}")),
    );
    notes
}

impl TrainingData {
    /// The clips that hold samples.
    pub fn labelled(&self) -> impl Iterator<Item = &TrainClip> {
        self.clips
            .iter()
            .filter(|c| c.source == StreamKind::Labelled)
    }

    /// Joint names by role, of the first labelled clip.
    pub fn role_names(&self) -> BTreeMap<Role, String> {
        let first = self.labelled().next();
        first.map_or_else(BTreeMap::new, TrainClip::role_names)
    }
}

#[cfg(test)]
mod tests {
    use crate::TimeSpan;
    use crate::import::Take;
    use crate::synth::{DatabaseSpec, database};

    use super::*;

    const NAMES: [&str; 4] = ["taught", "resting", "tested", "both"];

    fn clips() -> Vec<TrainClip> {
        let spec = DatabaseSpec {
            people: 1,
            repetitions: 1,
            classes: vec!["wave"],
            ..DatabaseSpec::default()
        };
        let take = Take::new(database(1, &spec).remove(0).clip).unwrap();
        let clip = |name: &str| TrainClip {
            name: name.to_owned(),
            source: match name {
                "resting" | "both" => StreamKind::Background,
                _ => StreamKind::Labelled,
            },
            ..take.clone().into()
        };
        NAMES.map(clip).into()
    }

    fn sorted_out(labelled: &[(&str, &str)], classes: &[&str]) -> Result<TrainingData, DataError> {
        let mut labels = Labels::default();
        for (clip, class) in labelled {
            labels.add(clip, class, TimeSpan::new(0.0, 1.0));
        }
        let people = People {
            by_clip: [("resting".to_owned(), "ada".to_owned())].into(),
            ..People::default()
        };
        let material = TrainingMaterial {
            labels: &labels,
            people: Some(&people),
            classes: &classes.iter().map(|c| (*c).to_owned()).collect::<Vec<_>>(),
            unknown: &["tested", "both"].map(str::to_owned).into(),
        };
        material.sort_out(clips())
    }

    fn names(clips: &[TrainClip]) -> Vec<&str> {
        clips.iter().map(|clip| clip.name.as_str()).collect()
    }

    #[test]
    fn every_clip_has_its_part() {
        let data = sorted_out(&[("taught", "wave"), ("tested", "wave")], &[]).unwrap();
        assert_eq!(names(&data.clips), ["taught", "resting", "both"]);
        assert_eq!(names(&data.unknown), ["tested", "both"]);
        assert_eq!(data.samples.len(), 1);
        assert_eq!(data.clips[1].person.as_deref(), Some("ada"));
        let said =
            "1 labels are ignored because their clips are given as background or unknown: tested";
        assert_eq!(data.notes, [said]);
    }

    #[test]
    fn clips_and_labels_of_no_use_are_said() {
        let data = sorted_out(&[("both", "bow"), ("elsewhere", "wave")], &["wave"]);
        assert!(matches!(data, Err(DataError::NoSampleOf { .. })));
        let labelled = [("both", "wave"), ("elsewhere", "bow"), ("taught", "bow")];
        let data = sorted_out(&labelled, &["bow"]).unwrap();
        let said = "1 labels are of unknown clips: elsewhere";
        assert_eq!(data.notes, [said], "labels of other classes are not missed");
        let mut labels = Labels::default();
        labels.add("taught", "bow", TimeSpan::new(0.0, 1.0));
        let material = TrainingMaterial {
            labels: &labels,
            people: None,
            classes: &[],
            unknown: &BTreeSet::new(),
        };
        let data = material.sort_out(clips()).unwrap();
        assert_eq!(names(&data.clips), ["taught", "resting", "both"]);
        assert!(data.notes[0].starts_with("1 clips have no sample of the classes"));
        assert!(data.notes[0].ends_with("tested"), "{:?}", data.notes);
    }

    #[test]
    fn a_class_without_a_sample_is_refused_with_those_that_may_be_meant() {
        let error = sorted_out(&[("taught", "wave")], &["wvae"]).unwrap_err();
        assert!(
            error.to_string().ends_with("; did you mean `wave`?"),
            "{error}"
        );
        assert_eq!(sorted_out(&[], &[]).unwrap_err(), DataError::NoSample);
    }
}
