//! The index file: everything recognition needs, in one immutable, versioned file with a checksum.
//!
//! The container is [safetensors](https://huggingface.co/docs/safetensors): eight bytes of header length, a JSON
//! header naming every tensor, the tensors' bytes. Any program that knows the format can look inside
//! (`safetensors.numpy.load_file` in Python), and the bytes can be mapped into memory. What is not a tensor
//! stands as JSON in the header's metadata under the key `morec`: classes, parameters, provenance and the checksum.
//!
//! ```python
//! import json
//! from safetensors import safe_open
//! from safetensors.numpy import load_file
//!
//! tables = load_file("signs.index")
//! with safe_open("signs.index", "np") as file:
//!     manifest = json.loads(file.metadata()["morec"])
//! print([c["name"] for c in manifest["classes"]], tables["templates.rows"].shape)
//! ```
//!
//! A file of a version this program knows opens in every later release; `testdata/index/` keeps one of each.

mod error;
mod manifest;
mod model;
mod read;
mod svrdm;
mod templates;
mod tensors;
mod write;

use std::collections::BTreeMap;

use crate::diagnosis::RoleSet;
use crate::features::HeadingLine;
use crate::roles::{Role, RoleMap};

pub use error::{INDEX_VERSION, IndexError};
pub use model::{Model, PerformerError, SensitivityError};

/// Origin of an index.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Provenance {
    /// When it was trained, `2026-11-21T10:00:00Z`.
    pub created: String,
    /// Version of morec that trained it.
    pub morec_version: String,
    /// Labelled clips it learned from.
    pub clips: Vec<String>,
    /// Samples it learned from.
    pub samples: usize,
    /// Seconds of background motion, by where it came from.
    pub background_secs: BTreeMap<String, f64>,
}

/// A trained index: what a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionIndex {
    /// Templates or tree, with thresholds and parameters.
    pub model: Model,
    /// Names of the joints that played each role in training: a hint for skeletons on which the role map fails.
    pub roles: BTreeMap<Role, String>,
    /// Origin of the index.
    pub provenance: Provenance,
}

impl MotionIndex {
    /// A sentence about a stream that shows the parts in `shown` and no other, if the index takes the heading from the hips, saw them in
    /// training, and the stream has shoulders alone; or from where a headset looks, and the stream does not tell.
    pub fn heading_doubt(&self, shown: RoleSet) -> Option<&'static str> {
        let Model::Templates(model) = &self.model else {
            return None;
        };
        if model.features.heading == HeadingLine::Headset && !shown.contains(Role::Face) {
            return Some(
                "the index takes the heading from the direction of the headset (`face`), which is not sent: motions are missed \
                 if the performer faces another direction than in the samples",
            );
        }
        const HIPS: [Role; 2] = [Role::LeftThigh, Role::RightThigh];
        let taught = HIPS.iter().all(|role| self.roles.contains_key(role));
        let shows = |left, right| shown.contains(left) && shown.contains(right);
        let differs = model.features.heading == HeadingLine::Hips
            && taught
            && !shows(HIPS[0], HIPS[1])
            && shows(Role::LeftArm, Role::RightArm);
        differs.then_some(
            "the index takes the heading from the hips, which this stream lacks: the shoulders are used instead, and motions may \
             be missed; better, train on recordings without hips, or with --param features.heading=shoulders",
        )
    }

    /// True of an index of a skeleton that is no person's: of an animal, a thing, or points in a picture.
    pub fn has_custom_roles(&self) -> bool {
        self.roles.keys().any(|role| role.is_custom())
    }

    /// Fills roles that `map` left empty with [fingers](RoleMap::for_bones), if the index looks at them, and with the joints that played them in training, where `skeleton` has
    /// joints of those names that play nothing else. Returns the roles that were filled. Where the index is of a custom skeleton and `skeleton` has its
    /// root, roles of a person are taken away.
    pub fn complete_roles(&self, map: &mut RoleMap, skeleton: &crate::clip::Skeleton) -> Vec<Role> {
        let mut filled = Vec::new();
        // What the joints of a custom skeleton seem to be of a person does not count.
        let root = self.roles.get(&Role::Point1);
        let unnamed = map.joint(Role::Point1).is_none();
        if unnamed && root.is_some_and(|name| skeleton.find(name).is_some()) {
            *map = RoleMap::default();
        }
        *map = self.model.roles_of(skeleton, map).into_owned();
        for (&role, name) in &self.roles {
            let Some(joint) = skeleton.find(name) else {
                continue;
            };
            let taken = Role::ALL.into_iter().any(|r| map.joint(r) == Some(joint));
            if map.joint(role).is_none() && !taken {
                map.set(role, Some(joint));
                filled.push(role);
            }
        }
        filled
    }
}
