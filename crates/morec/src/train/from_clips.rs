//! Turns clips and labels into streams of feature rows with samples.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::classes::ClassId;
use crate::clip::{Clip, Span};
use crate::features::{
    BoneSet, FeatureParams, HeadingLine, Profile, all_bones_of_clip, rows_of_clip, shows_hips,
};
use crate::import::Take;
use crate::labels::Sample;
use crate::roles::{Role, RoleMap};

use super::error::TrainError;
use super::params::TrainParams;
use super::set::{LabelledSpan, StreamKind, TrainSet, TrainStream};
use super::trim::motion_span;

/// A clip ready for training: Y up, its joints' roles known.
#[derive(Debug, Clone)]
pub struct TrainClip {
    /// Name under which labels refer to it.
    pub name: String,
    /// Skeleton and frames.
    pub clip: Clip,
    /// Joint of each role.
    pub roles: RoleMap,
    /// Frames that a conversion left at the start.
    pub rest: Span,
    /// Whether it is labelled, background or everyday motion.
    pub source: StreamKind,
    /// The person who moves, if known.
    pub person: Option<String>,
}

impl TrainClip {
    /// Joint names by role.
    pub fn role_names(&self) -> BTreeMap<Role, String> {
        let joints = self.clip.skeleton.joints();
        let name = |role: Role| Some((role, joints[self.roles.joint(role)?].name.clone()));
        Role::ALL.into_iter().filter_map(name).collect()
    }
}

impl From<Take> for TrainClip {
    /// A labelled clip without a person.
    fn from(take: Take) -> Self {
        Self {
            name: take.clip.name.clone(),
            clip: take.clip,
            roles: take.roles,
            rest: take.report.rest_frames,
            source: StreamKind::Labelled,
            person: None,
        }
    }
}

/// Labels of clips, and the use of unlabelled parts.
#[derive(Debug, Clone, Default)]
pub struct LabelSet<'a> {
    /// Samples to learn from.
    pub samples: &'a [Sample],
    /// Samples held back: to be learned neither as a class nor as background.
    pub held_back: &'a [Sample],
    /// The classes to learn, in order; labels of other classes make a stretch background.
    pub classes: &'a [String],
    /// True if unlabelled parts of labelled clips are background.
    pub unlabelled_is_background: bool,
}

/// Streams to train from, and which clips could not serve.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Streams and classes.
    pub set: TrainSet,
    /// Bones that every labelled clip shows.
    pub bones: BoneSet,
    /// Parameters that rows were made with: the heading is the shoulders' if a clip that teaches shows no hips, and hands have
    /// [parameters of their own](FeatureParams::usual).
    pub features: FeatureParams,
    /// Number of clips that hold samples.
    pub teaching: usize,
    /// Number of those among them that show no hips.
    pub hipless: usize,
    /// Those among them that show no bone at all.
    pub bodiless: Vec<String>,
    /// Background clips left out because they lack bones that the labelled ones have.
    pub lacking: Vec<String>,
}

impl Prepared {
    /// `params` with the features that rows were made with.
    pub fn params(&self, params: &TrainParams) -> TrainParams {
        TrainParams {
            features: self.features.clone(),
            ..params.clone()
        }
    }

    /// Why there is no bone to learn from, where [`bones`](Self::bones) is empty.
    pub fn no_bone(&self, wanted: BoneSet) -> TrainError {
        const NAMED: usize = 3;
        if wanted != BoneSet::BODY && self.teaching > 0 {
            let wanted: Vec<String> = wanted.into();
            return TrainError::Params(format!(
                "no bone to train on: not every labelled clip has one of {}",
                wanted.join(", ")
            ));
        }
        match (self.bodiless.len(), self.teaching) {
            (0, 0) => TrainError::NoSamples,
            (0, _) => TrainError::NoCommonBone,
            (count, _) => {
                let named = self.bodiless[..count.min(NAMED)].join(", ");
                let more = count.saturating_sub(NAMED);
                TrainError::NoBody(match more {
                    0 => named,
                    more => format!("{named} and {more} more clips"),
                })
            }
        }
    }
}

/// Cuts clips into what training needs. Rows are made in parallel, in the order of `clips`.
///
/// `wanted` are the bones that count, of those that every labelled clip shows. Where these clips show no body, and no bones but the
/// body's are wanted, those of hands or of tracked points count.
pub fn build_train_set(
    clips: &[TrainClip],
    labelling: &LabelSet<'_>,
    wanted: BoneSet,
    params: &FeatureParams,
) -> Prepared {
    let by_clip = by_clip(labelling.samples);
    let clips = &*with_fingers(clips, wanted);
    let shown: Vec<BoneSet> = clips
        .par_iter()
        .map(|c| all_bones_of_clip(&c.clip, &c.roles, &c.rest))
        .collect();
    let taught = clips
        .iter()
        .zip(&shown)
        .filter(|(c, _)| by_clip.contains_key(c.name.as_str()));
    let hipless = taught
        .clone()
        .filter(|(c, _)| !shows_hips(&c.clip, &c.roles, &c.rest))
        .count();
    let bodiless = taught
        .clone()
        .filter(|(_, shown)| shown.is_empty())
        .map(|(clip, _)| clip.name.clone())
        .collect();
    let common = taught
        .clone()
        .map(|(_, b)| *b)
        .reduce(BoneSet::and)
        .unwrap_or(BoneSet::NONE);
    let bones = match common.and(BoneSet::BODY).is_empty() && wanted.and(BoneSet::BODY) == wanted {
        true => Profile::usual_bones(common),
        false => common.and(wanted),
    };
    let faced = taught
        .clone()
        .all(|(c, _)| c.roles.joint(Role::Face).is_some());
    let params = &features(params, Profile::of(bones), hipless > 0, faced);
    let serves = |shown: &BoneSet| shown.and(bones) == bones && !bones.is_empty();
    let (usable, left_out): (Vec<_>, Vec<_>) =
        clips.iter().zip(&shown).partition(|(_, b)| serves(b));
    let held_back = self::by_clip(labelling.held_back);
    let mut streams: Vec<TrainStream> = usable
        .par_iter()
        .map(|(clip, _)| stream(clip, bones, params, labelling, &by_clip, &held_back))
        .collect();
    clips_are_people_if_one_is_named(&mut streams);
    if Profile::of(bones) != Profile::Body {
        unlabelled_as_background(&mut streams, params);
    }
    Prepared {
        set: TrainSet {
            classes: labelling.classes.to_vec(),
            streams,
            everyday: Vec::new(),
        },
        bones,
        features: params.clone(),
        hipless,
        teaching: taught.clone().count(),
        bodiless,
        lacking: left_out
            .into_iter()
            .map(|(clip, _)| clip.name.clone())
            .collect(),
    }
}

/// Streams of clips that hold no class, as rows of `bones`; clips that do not show them all are left out.
pub(super) fn background_streams(
    clips: &[TrainClip],
    bones: BoneSet,
    params: &FeatureParams,
) -> Vec<TrainStream> {
    let (labelling, none) = (LabelSet::default(), ByClip::new());
    let serves = |clip: &&TrainClip| {
        all_bones_of_clip(&clip.clip, &clip.roles, &clip.rest).and(bones) == bones
    };
    let usable = clips.par_iter().filter(serves);
    usable
        .map(|clip| stream(clip, bones, params, &labelling, &none, &none))
        .collect()
}

/// The clips with the fingers of their skeletons, if `wanted` asks for hands.
fn with_fingers(clips: &[TrainClip], wanted: BoneSet) -> Cow<'_, [TrainClip]> {
    if wanted.and(BoneSet::HANDS).is_empty() {
        return Cow::Borrowed(clips);
    }
    let with_fingers = |clip: &TrainClip| TrainClip {
        roles: (clip.roles.for_bones(&clip.clip.skeleton, wanted)).into_owned(),
        ..clip.clone()
    };
    clips.iter().map(with_fingers).collect()
}

/// `params` for the rows of a profile: its own in place of each that is as usual for bodies.
fn features(params: &FeatureParams, profile: Profile, hipless: bool, faced: bool) -> FeatureParams {
    match profile {
        Profile::Body if hipless && params.heading == HeadingLine::Hips => FeatureParams {
            heading: HeadingLine::Shoulders,
            ..params.clone()
        },
        Profile::Body => params.clone(),
        _ => {
            let (usual, own) = (FeatureParams::default(), FeatureParams::usual(profile));
            let choose =
                |given: f64, usual: f64, own: f64| if given == usual { own } else { given };
            FeatureParams {
                heading: match params.heading {
                    HeadingLine::Sensor => HeadingLine::Sensor,
                    _ if profile == Profile::Points3 && faced => HeadingLine::Headset,
                    _ => own.heading,
                },
                velocity_saturation: choose(
                    params.velocity_saturation,
                    usual.velocity_saturation,
                    own.velocity_saturation,
                ),
                root_weight: choose(params.root_weight, usual.root_weight, own.root_weight),
                ..params.clone()
            }
        }
    }
}

/// Leaving out a person needs a second one: where a single person shows all samples, clips count as people.
fn clips_are_people_if_one_is_named(streams: &mut [TrainStream]) {
    let teaching = || {
        streams
            .iter()
            .filter(|s| s.known.iter().any(|k| k.class.is_some()))
    };
    let people: BTreeSet<&str> = teaching().map(|s| s.group.as_str()).collect();
    if people.len() < 2 {
        streams.iter_mut().for_each(|s| s.group.clone_from(&s.name));
    }
}

/// Unlabelled stretches of a second and more become background by themselves: hands are never at rest, so that what they do between
/// gestures is what must be kept out.
fn unlabelled_as_background(streams: &mut Vec<TrainStream>, params: &FeatureParams) {
    let least = params.tick_hz() as usize;
    let mut found = Vec::new();
    for stream in streams.iter_mut() {
        if stream.source != StreamKind::Labelled || !stream.rest_is_background {
            continue;
        }
        let unlabelled = stream.unknown(least).into_iter();
        found.extend(unlabelled.map(|ticks| TrainStream {
            source: StreamKind::Background,
            rows: stream.rows.slice(ticks),
            known: Vec::new(),
            ..stream.clone()
        }));
        stream.rest_is_background = false;
    }
    streams.extend(found);
}

type ByClip<'a> = BTreeMap<&'a str, Vec<&'a Sample>>;

fn by_clip(samples: &[Sample]) -> ByClip<'_> {
    let mut map = ByClip::new();
    for sample in samples {
        map.entry(&sample.clip).or_default().push(sample);
    }
    map
}

fn stream(
    clip: &TrainClip,
    bones: BoneSet,
    params: &FeatureParams,
    labelling: &LabelSet<'_>,
    taught: &ByClip<'_>,
    held_back: &ByClip<'_>,
) -> TrainStream {
    let rows = rows_of_clip(&clip.clip, &clip.roles, &clip.rest, bones, params);
    let none = Vec::new();
    let samples = taught.get(clip.name.as_str()).unwrap_or(&none);
    let held = held_back.get(clip.name.as_str()).unwrap_or(&none);
    let ticks = |sample: &Sample| {
        if sample.whole_clip {
            return motion_span(&rows, bones);
        }
        // Half a frame's tolerance: a label given in seconds must not gain a tick by rounding.
        let (first, last) = (
            sample.span.start_secs * params.tick_hz(),
            sample.span.stop_secs * params.tick_hz(),
        );
        (first + 0.05).floor().max(0.0) as usize..(last - 0.05).ceil().max(0.0) as usize
    };
    let class = |s: &Sample| {
        labelling
            .classes
            .iter()
            .position(|c| *c == s.class)
            .map(|c| ClassId(c as u16))
    };
    let wanted = samples.iter().filter_map(|s| {
        Some(LabelledSpan {
            ticks: ticks(s),
            class: Some(class(s)?),
        })
    });
    let spared = held.iter().map(|s| LabelledSpan {
        ticks: ticks(s),
        class: None,
    });
    let mut known: Vec<LabelledSpan> = wanted.chain(spared).collect();
    known.sort_by_key(|k| (k.ticks.start, k.ticks.end));
    let whole = samples.iter().chain(held).any(|s| s.whole_clip);
    let labelled = clip.source == StreamKind::Labelled;
    let named = samples.iter().chain(held).find_map(|s| s.person.clone());
    let person = clip.person.clone().or(named);
    TrainStream {
        name: clip.name.clone(),
        group: person.clone().unwrap_or_else(|| clip.name.clone()),
        person,
        source: clip.source,
        rest_is_background: !labelled || (labelling.unlabelled_is_background && !whole),
        is_copy: false,
        rows,
        known,
    }
}
