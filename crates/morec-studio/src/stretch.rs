//! A stretch of a clip: what is searched for, compared, labelled.

use morec_db::ClipId;

/// From one moment of a clip to another, seconds from its beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    pub clip: ClipId,
    pub start_secs: f64,
    pub stop_secs: f64,
}
