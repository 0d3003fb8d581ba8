//! A clip and what is known of it, as every part of the package holds it.

use std::ops::Range;
use std::path::PathBuf;

use morec::clip::Clip;
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
    /// Repairs and oddities, a sentence each.
    pub warnings: Vec<String>,
    /// The file it is from.
    pub path: Option<PathBuf>,
    /// The file's format.
    pub format: String,
}

impl From<Take> for ClipData {
    fn from(take: Take) -> Self {
        Self {
            facts: serde_json::to_string(&take.report).unwrap_or_default(),
            rest: take.report.rest_frames,
            warnings: take.warnings.iter().map(ToString::to_string).collect(),
            clip: take.clip,
            roles: take.roles,
            path: None,
            format: String::new(),
        }
    }
}
