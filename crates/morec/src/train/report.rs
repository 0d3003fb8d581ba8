//! Report of a training run, for people to read.

use std::collections::{BTreeMap, BTreeSet};

use crate::classes::{ClassId, ClassInfo};
use crate::features::Profile;
use crate::templates::{Activities, OperatingPoint, ReferenceRows};

use super::activities::labels_of;
use super::alike::AlikeClasses;
use super::from_clips::Prepared;
use super::kind::ClassKind;
use super::notes::class_notes;
use super::params::TrainParams;
use super::second_look::{HeldOutAlarms, OwnSample};
use super::set::{StreamKind, TrainSample, TrainStream};
use super::templates::TrainedTemplates;
use super::thesis::SvrdmReport;

/// Names of the classes of `reference`, each once.
fn class_names(reference: &ReferenceRows, classes: &[ClassInfo]) -> String {
    let distinct = reference.distinct_classes();
    let names = distinct.iter().map(|c| classes[c.index()].name.as_str());
    names.collect::<Vec<_>>().join(", ")
}

/// A note about classes that are activities, and why.
fn activity_note(
    activities: &Activities,
    prepared: &Prepared,
    classes: &[ClassInfo],
    params: &TrainParams,
) -> String {
    let labels = labels_of(&prepared.set.streams, params.features.tick_hz());
    let named = |class: ClassId| {
        let name = &classes[class.index()].name;
        if params.kinds.contains_key(name) {
            return format!("{name} (named one)");
        }
        let labels = labels.get(&Some(class)).copied().unwrap_or_default();
        format!("{name} ({})", labels.reason())
    };
    let names: Vec<String> = activities
        .windows
        .distinct_classes()
        .into_iter()
        .map(named)
        .collect();
    format!(
        "recognised as an activity, from windows of {:.1} s, and reported when it ends: {}",
        activities.window_ticks as f64 / params.features.tick_hz(),
        names.join(", ")
    )
}

/// Samples of gestures are seldom longer than this, seconds: what is may be an activity.
const LONG_GESTURE_SECS: f64 = 3.0;

/// A note about long classes that count as gestures, though nobody named them so.
fn long_gesture_note(
    trained: &TrainedTemplates,
    prepared: &Prepared,
    params: &TrainParams,
) -> Option<String> {
    if !params.activities || Profile::of(prepared.bones) != Profile::Body {
        return None;
    }
    let activities = trained.model.activities.as_ref();
    let classes = (0u16..).map(ClassId).zip(&trained.model.classes);
    let gestures = classes.filter(|(class, info)| {
        !activities.is_some_and(|a| a.holds(*class)) && !params.kinds.contains_key(&info.name)
    });
    let labels = labels_of(&prepared.set.streams, params.features.tick_hz());
    let names: Vec<String> = gestures
        .filter_map(|(class, info)| Some((info, labels.get(&Some(class))?)))
        .filter(|(_, labels)| labels.longest_secs >= LONG_GESTURE_SECS)
        .map(|(info, labels)| format!("{} ({})", info.name, labels.reason()))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "recognised as a gesture: {}; declare it an activity if it is continuous or repeated",
            names.join(", ")
        )
    })
}

/// A note about labels that are much longer than the others of their class.
fn outlier_note(
    trained: &TrainedTemplates,
    prepared: &Prepared,
    params: &TrainParams,
) -> Option<String> {
    let labels = labels_of(&prepared.set.streams, params.features.tick_hz());
    let classes = (0u16..).map(ClassId).zip(&trained.model.classes);
    let outliers = classes.filter_map(|(class, info)| {
        let secs = labels
            .get(&Some(class))?
            .outlier_secs
            .filter(|s| *s >= LONG_GESTURE_SECS)?;
        Some(format!("{} ({secs:.1} s)", info.name))
    });
    let outliers: Vec<String> = outliers.collect();
    (!outliers.is_empty()).then(|| {
        format!(
            "a label is more than three times as long as most labels of its class: {}; does it contain several samples?",
            outliers.join(", ")
        )
    })
}

/// A note about classes that were named as activities and cannot be.
fn no_activity_note(trained: &TrainedTemplates, params: &TrainParams) -> Option<String> {
    let activities = trained.model.activities.as_ref();
    let is_none = |name: &str| {
        let number = (trained.model.classes.iter()).position(|class| class.name == name);
        let class = number.map(|number| ClassId(number as u16));
        class.is_some_and(|class| !activities.is_some_and(|a| a.holds(class)))
    };
    let named = params.kinds.iter();
    let named = named.filter(|(name, kind)| **kind == ClassKind::Activity && is_none(name));
    let names: Vec<&str> = named.map(|(name, _)| name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "recognised as a gesture, although listed as an activity: {}; an activity needs a body and other motion to compare \
             with: unlabelled parts, background, or built-in everyday motion",
            names.join(", ")
        )
    })
}

/// Report of a training run.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct TrainingReport {
    /// The classes and what they were learned from.
    pub classes: Vec<ClassInfo>,
    /// Bones that every labelled clip shows, by name.
    pub bones: Vec<String>,
    /// Seconds of background motion by source: `unlabelled`, `clips`, `everyday`.
    pub background_secs: BTreeMap<String, f64>,
    /// Largest distance that is reported, of templates. What the method of 2009 accepts is in
    /// [`SvrdmReport::min_confidence`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold: Option<f32>,
    /// Origin of the threshold.
    pub threshold_from: String,
    /// Thresholds for other rates of false alarms: distances, or the scores of a verifier.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub operating: Vec<OperatingPoint>,
    /// False alarms of background motion that did not set the least score; only where the whole motion is judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out: Option<HeldOutAlarms>,
    /// Hard negatives found, by the same sources.
    pub negatives: BTreeMap<String, usize>,
    /// True if the whole motion around a match is judged: thresholds are then scores that must be exceeded.
    pub judges_whole: bool,
    /// True if candidates are verified; it takes clips named as background to learn that.
    pub verified: bool,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Results that only the thesis's method has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub svrdm: Option<SvrdmReport>,
}

impl TrainingReport {
    /// The report on `trained`, from `prepared`.
    pub fn of(prepared: &Prepared, trained: &TrainedTemplates, params: &TrainParams) -> Self {
        let tick_hz = params.features.tick_hz();
        let streams = &prepared.set.streams;
        let labelled = streams.iter().filter(|s| s.source == StreamKind::Labelled);
        let labelled: BTreeSet<&str> = labelled.map(|s| s.name.as_str()).collect();
        // Unlabelled stretches of hands are background that bears the name of its clip.
        let origin = |stream: &TrainStream| match labelled.contains(stream.name.as_str()) {
            true => source_name(StreamKind::Labelled).to_owned(),
            false => source_name(stream.source).to_owned(),
        };
        let mut background_secs = BTreeMap::new();
        for stream in streams
            .iter()
            .filter(|s| s.rest_is_background && !s.is_copy)
        {
            let known: usize = stream.known.iter().map(|k| k.ticks.len()).sum();
            let secs = stream.rows.len().saturating_sub(known) as f64 / tick_hz;
            *background_secs.entry(origin(stream)).or_insert(0.0) += secs;
        }
        let mut negatives = BTreeMap::new();
        for miss in &trained.negatives {
            *negatives.entry(origin(&streams[miss.stream])).or_insert(0) += 1;
        }
        let classes = trained.model.classes.clone();
        let mut notes = class_notes(&classes);
        let copies = streams.iter().filter(|s| s.is_copy).count();
        if copies > 0 {
            notes.push(format!("mirrored copies of {copies} samples are used too"));
        }
        let profile = Profile::of(prepared.bones);
        if profile != Profile::Body {
            notes.push(format!(
                "the index recognises {}: it uses {}",
                profile.words(),
                Vec::<String>::from(prepared.bones).join(", ")
            ));
        } else if prepared.hipless > 0 {
            notes.push(format!(
                "{} of {} training clips have no hips, so the heading is taken from the shoulders in every stream; the index \
                 uses {}",
                prepared.hipless,
                prepared.teaching,
                Vec::<String>::from(prepared.bones).join(", ")
            ));
        }
        if let Some(held) = &trained.model.held {
            notes.push(format!(
                "recognised by a pose that is held for {:.1} s or longer, and reported when the pose ends: {}",
                held.least_ticks as f64 / tick_hz,
                class_names(&held.poses, &classes)
            ));
        }
        if let Some(activities) = &trained.model.activities {
            notes.push(activity_note(activities, prepared, &classes, params));
        }
        notes.extend(no_activity_note(trained, params));
        notes.extend(long_gesture_note(trained, prepared, params));
        notes.extend(outlier_note(trained, prepared, params));
        if !prepared.lacking.is_empty() {
            notes.push(format!(
                "left out because bones of the labelled clips are missing: {}",
                prepared.lacking.join(", ")
            ));
        }
        notes.extend(
            trained
                .quiet
                .iter()
                .map(|s| quiet_note(s, prepared, tick_hz)),
        );
        notes.extend(trained.alike.iter().map(|pair| alike_note(pair, &classes)));
        if streams.iter().all(|s| s.source == StreamKind::Labelled) {
            notes.push(
                "no background clips and no everyday motion, so the threshold is a general value: add background clips"
                    .to_owned(),
            );
        }
        notes.extend(own_note(&trained.own, &classes));
        notes.extend(one_teacher_note(&classes));
        let look = trained.model.look.as_ref();
        Self {
            classes,
            bones: prepared.bones.into(),
            background_secs,
            threshold: Some(look.map_or(trained.model.threshold, |look| look.bound)),
            threshold_from: match look {
                Some(_) => "the scores that background motion reaches".to_owned(),
                None => trained.threshold_from.clone(),
            },
            operating: match (&trained.model.verifier, look) {
                (Some(verifier), _) => verifier.operating.clone(),
                (None, Some(look)) => look.operating.clone(),
                (None, None) => trained.model.operating.clone(),
            },
            judges_whole: look.is_some(),
            held_out: trained.held_out,
            negatives,
            verified: trained.model.verifier.is_some(),
            notes,
            svrdm: None,
        }
    }
}

/// Note about a sample that hardly moves.
fn quiet_note(sample: &TrainSample, prepared: &Prepared, tick_hz: f64) -> String {
    format!(
        "{}: the sample in {} from {:.2} to {:.2} s contains almost no motion and is not used; check its label",
        prepared.set.classes[sample.class.index()],
        prepared.set.streams[sample.stream].name,
        sample.ticks.start as f64 / tick_hz,
        sample.ticks.end as f64 / tick_hz,
    )
}

/// What taught samples would be named if only the others were taught, and which classes are taken for each other.
fn own_note(own: &[OwnSample], classes: &[ClassInfo]) -> Option<String> {
    let name = |class: ClassId| classes[class.index()].name.as_str();
    // A class of one sample has no other to be recognised by.
    let repeated = |sample: &&OwnSample| classes[sample.class.index()].samples > 1;
    let judged: Vec<&OwnSample> = own.iter().filter(repeated).collect();
    if judged.is_empty() {
        return None;
    }
    let right = judged.iter().filter(|s| s.class == s.named).count();
    let mut taken = BTreeMap::<(&str, &str), usize>::new();
    for sample in judged.iter().filter(|s| s.class != s.named) {
        *taken
            .entry((name(sample.class), name(sample.named)))
            .or_default() += 1;
    }
    let taken: Vec<String> = taken
        .iter()
        .map(|((class, other), count)| format!("{class} for {other} ({count})"))
        .collect();
    let mistakes = match taken.is_empty() {
        true => String::new(),
        false => format!(
            "; mistaken for another class: {}. Add samples of these classes, or merge classes that show the same motion",
            taken.join(", ")
        ),
    };
    Some(format!(
        "leave-one-out test: {right} of {} samples are recognised as their class by the other samples{mistakes}",
        judged.len()
    ))
}

/// Names the classes that one person taught.
fn one_teacher_note(classes: &[ClassInfo]) -> Option<String> {
    let alone: Vec<&str> = classes
        .iter()
        .filter(|class| class.people == 1)
        .map(|class| class.name.as_str())
        .collect();
    match alone.len() {
        0 => None,
        n if n == classes.len() => Some(
            "all samples are by one person: motions of other people will be recognised less often than with samples by several \
             people".to_owned(),
        ),
        _ => Some(format!("samples by one person only: {}", alone.join(", "))),
    }
}

/// Note about two classes that keep each other from being reported.
fn alike_note(pair: &AlikeClasses, classes: &[ClassInfo]) -> String {
    let (class, other) = (
        &classes[pair.class.index()].name,
        &classes[pair.other.index()].name,
    );
    format!(
        "{class} and {other} have similar samples: {} of {} samples of {class} are as near to {other}, and a motion near to both \
         is not reported. Check the labels, or merge the two classes",
        pair.samples, pair.of
    )
}

/// Name of a background's origin in reports.
pub fn source_name(source: StreamKind) -> &'static str {
    match source {
        StreamKind::Labelled => "unlabelled",
        StreamKind::Background => "clips",
        StreamKind::Everyday => "everyday",
    }
}
