//! Recognition with an index that is divided by its classes among several machines.
//!
//! Matching the templates is nearly all of the work and of the memory, and it is independent from class to class. So each
//! machine matches some classes ([`PartMatcher`] with a [part](TemplateModel::part) of the model), and one
//! decodes the matches of all ([`Recognizer::replay`]). The detections are those of the whole index, to the bit.

use crate::clip::{Clip, Span};
use crate::features::{BoneSet, FeatureStream, KeyPose, all_bones_of_clip, for_each_pose};
use crate::roles::RoleMap;
use crate::templates::{ClassMatcher, ClassMatches, Metric, TemplateModel};

use super::of_clip::recognize_with;
use super::start::check_shown;
use super::{Detection, Model, Recognizer, StartError};

impl TemplateModel {
    /// Part `part` of `of`: the templates of every `of`-th class, and as large a share of the negatives. Everything else is
    /// the whole model's; only the first part holds the class exemplars of its verifier.
    ///
    /// # Panics
    /// `part` is not below `of`.
    pub fn part(&self, part: usize, of: usize) -> Self {
        assert!(part < of, "part {part} of {of}");
        let mut model = self.clone();
        model.samples.retain(|s| s.class.index() % of == part);
        let negatives = self.negatives.iter().enumerate();
        let mine = negatives.filter(|(i, _)| i % of == part);
        model.negatives = mine.map(|(_, rows)| rows.clone()).collect();
        if part > 0
            && let Some(verifier) = &mut model.verifier
        {
            verifier.classes.clear();
        }
        model
    }
}

/// Matches the templates of a [part](TemplateModel::part) against one performer's stream.
#[derive(Debug, Clone)]
pub struct PartMatcher {
    features: FeatureStream,
    steps: MatchSteps,
}

/// Templates and recorded matches: the steps for each feature row.
#[derive(Debug, Clone)]
struct MatchSteps {
    matcher: ClassMatcher,
    matches: ClassMatches,
    /// Distances from here on do not count.
    reach: f32,
}

impl MatchSteps {
    fn take(&mut self, row: &[f32]) {
        self.matcher.step(row);
        let (near, negative) = (self.matcher.near(), self.matcher.negative());
        self.matches.push(near, negative, self.reach);
    }
}

impl PartMatcher {
    /// For a stream that offers `bones`.
    ///
    /// # Errors
    /// The model uses none of these bones.
    pub fn new(part: &TemplateModel, bones: BoneSet) -> Result<Self, StartError> {
        check_shown(part.bones, bones)?;
        let part = part.restricted(bones)?;
        part.check()?;
        let metric = Metric::new(&part.ridged, &part.total);
        Ok(Self {
            features: FeatureStream::new(part.bones, &part.features),
            steps: MatchSteps {
                matcher: ClassMatcher::new(&part, &metric),
                matches: ClassMatches::new(part.longest()),
                reach: part.reach(),
            },
        })
    }

    /// Takes the pose at `time_secs`, as [`Recognizer::push`] does.
    pub fn push(&mut self, time_secs: f64, pose: &KeyPose) {
        if self.features.breaks_at(time_secs) {
            self.features.finish(&mut |row| self.steps.take(row));
            self.steps.matcher.reset();
        }
        let steps = &mut self.steps;
        self.features
            .push(time_secs, pose, &mut |row| steps.take(row));
    }

    /// Ends the stream; gives all its matches.
    pub fn finish(mut self) -> ClassMatches {
        self.features.finish(&mut |row| self.steps.take(row));
        self.steps.matches
    }
}

/// Matches of a [part](TemplateModel::part) in a clip. `rest` are the frames that a conversion left at the start, as in
/// [`recognize_clip`](super::recognize_clip).
///
/// # Errors
/// The clip shows none of the model's bones.
pub fn match_clip(
    part: &TemplateModel,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<ClassMatches, StartError> {
    let roles = &roles.for_bones(&clip.skeleton, part.bones);
    let mut matcher = PartMatcher::new(part, all_bones_of_clip(clip, roles, rest))?;
    for_each_pose(clip, roles, rest, |time_secs, pose| {
        matcher.push(time_secs, pose);
    });
    Ok(matcher.finish())
}

/// Detections of the whole index in a clip, from its matches with all parts of the index
/// ([merged](ClassMatches::merge)); `first` is the first part.
///
/// # Errors
/// The clip shows none of the model's bones.
pub fn recognize_matched(
    first: &TemplateModel,
    matches: ClassMatches,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<Vec<Detection>, StartError> {
    let model = Model::Templates(std::sync::Arc::new(first.clone()));
    let roles = &model.roles_of(&clip.skeleton, roles);
    let bones = all_bones_of_clip(clip, roles, rest);
    recognize_with(
        Recognizer::replay(first, bones, matches)?,
        &model,
        clip,
        roles,
        rest,
    )
}
