//! A clip with its description, in the form that all parts of the package use.

use std::ops::Range;
use std::path::PathBuf;

use morec::clip::Clip;
use morec::diagnosis::errors_of_clip;
use morec::import::Take;
use morec::roles::RoleMap;

/// A clip and everything that is known of it.
#[derive(Debug, Clone)]
pub struct ClipData {
    /// The motion, in metres and Y up.
    pub clip: Clip,
    /// The joint of each role.
    pub roles: RoleMap,
    /// Frames that a conversion left at the start.
    pub rest: Range<usize>,
    /// Report of the import, as JSON.
    pub facts: String,
    /// Repairs and oddities, and what spoils training and recognition, a sentence each.
    pub warnings: Vec<String>,
    /// The file it is from.
    pub path: Option<PathBuf>,
    /// The file's format.
    pub format: String,
}

impl From<Take> for ClipData {
    fn from(take: Take) -> Self {
        let errors = errors_of_clip(&take.clip, &take.roles, take.rest());
        let repairs = take.warnings.iter().map(ToString::to_string);
        Self {
            warnings: repairs.chain(errors).collect(),
            facts: serde_json::to_string(&take.report).unwrap_or_default(),
            rest: take.report.rest_frames,
            clip: take.clip,
            roles: take.roles,
            path: None,
            format: String::new(),
        }
    }
}
