//! Reads clips of a database for looking at them.

use std::path::Path;
use std::sync::Arc;

use morec_db::{ClipId, MotionDb};

use crate::body::ClipMotion;

/// A clip that was asked for.
pub struct DecodedClip {
    pub id: ClipId,
    pub motion: Result<Arc<ClipMotion>, String>,
}

/// Decodes clip `id` of the database at `path`.
pub fn load(path: &Path, id: ClipId) -> DecodedClip {
    let motion = MotionDb::open_read_only(path)
        .and_then(|db| db.clip(id))
        .map(|stored| Arc::new(ClipMotion::of(id, stored)))
        .map_err(|error| error.to_string());
    DecodedClip { id, motion }
}
