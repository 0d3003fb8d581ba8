//! Recognition with an index.

use crate::diagnosis::{Diagnosis, Finding, Severity};
use crate::features::{ALL_BONES, BoneSet};
use crate::index::MotionIndex;
use crate::pivots::NoPivots;
use crate::roles::{Role, RoleMap};

use super::start::check_shown;
use super::{Model, Recognizer, StartError};

/// A shorter stream does not show the kind of performer reliably.
const SHOWN_SECS: f64 = 0.9;
/// A joint that was not seen for so long is not sent.
const MISSING_SECS: f64 = 2.0;

impl MotionIndex {
    /// An error if a stream of this index's method shows `bones` and none of them is the index's: then it is of another kind of performer.
    ///
    /// # Errors
    /// What the index is of, and what is shown.
    pub fn check_shown(&self, bones: BoneSet) -> Result<(), StartError> {
        match &self.model {
            Model::Templates(model) => check_shown(model.bones, bones),
            Model::Svrdm(_) => Ok(()),
        }
    }

    /// What does not fit in this index and a stream with this `diagnosis`: it is of another kind of performer, or takes the heading
    /// from what the stream does not show, or from rotations where the stream has positions alone. `None`, too, while too little was
    /// seen.
    pub fn misfit(&self, diagnosis: &Diagnosis) -> Option<(Severity, String)> {
        if self.model.needs_rotations() && diagnosis.turns == Some(false) {
            let known = diagnosis.secs >= SHOWN_SECS;
            return known.then(|| (Severity::Error, NoPivots::Rotations.to_string()));
        }
        let shown = BoneSet::of_seen(|role| diagnosis.seen.contains(role));
        if let Err(error @ StartError::OtherProfile { .. }) = self.check_shown(shown) {
            let known = diagnosis.secs >= SHOWN_SECS;
            return known.then(|| (Severity::Error, error.to_string()));
        }
        // Joints that were missing at first may come.
        let missing = |finding: &Finding| matches!(finding, Finding::JointsMissing { .. });
        let known = diagnosis.findings().iter().any(missing) || diagnosis.secs >= MISSING_SECS;
        let doubt = self.heading_doubt(diagnosis.seen).filter(|_| known)?;
        Some((Severity::Warning, doubt.to_owned()))
    }

    /// What is wrong with a stream for this index, a sentence each with its severity: its [misfit](Self::misfit), then what else was found,
    /// the gravest first.
    pub fn findings(&self, diagnosis: &Diagnosis) -> Vec<String> {
        let misfit = self.misfit(diagnosis).into_iter();
        let findings = diagnosis.findings();
        let findings = findings.iter().map(|f| (f.severity(), f.to_string()));
        let all = misfit.chain(findings);
        all.map(|(severity, text)| format!("{severity}: {text}"))
            .collect()
    }

    /// The parts that the index's bones need and a performer with these `roles` lacks, who shows the bones `shown`. Empty of one who shows
    /// all of them, and of one who shows [none](Self::check_shown).
    pub fn lacks(&self, roles: &RoleMap, shown: BoneSet) -> Vec<&'static str> {
        let Model::Templates(model) = &self.model else {
            return Vec::new();
        };
        let lacking = || model.bones.indices().filter(|b| !shown.contains(*b));
        if lacking().next().is_none() || self.check_shown(shown).is_err() {
            return Vec::new();
        }
        let needed = |role: &Role| {
            let mut bones = lacking().map(|b| ALL_BONES[b]);
            roles.joint(*role).is_none() && bones.any(|bone| bone.from == *role || bone.to == *role)
        };
        let names: Vec<_> = Role::ALL
            .into_iter()
            .filter(needed)
            .map(Role::name)
            .collect();
        match names.is_empty() {
            true => vec!["bones without a length"],
            false => names,
        }
    }

    /// A recogniser for a stream that offers `bones`.
    ///
    /// # Errors
    /// The index uses none of these bones.
    pub fn recognizer(&self, bones: impl Into<BoneSet>) -> Result<Recognizer, StartError> {
        Recognizer::new(&self.model, bones.into())
    }
}
