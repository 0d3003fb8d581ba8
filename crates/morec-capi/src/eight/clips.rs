//! A clip from a file, made ready for playing.

use std::path::Path;

use morec::files;
use morec::import::Take;
use morec::index::MotionIndex;
use morec::pivots::NoPivots;

use crate::status::{CallError, MorecStatus};

fn file_error(path: &Path, error: impl std::fmt::Display) -> CallError {
    CallError::new(MorecStatus::File, format!("{}: {error}", path.display()))
}

/// The first clip in the file, in metres and Y up, with its roles.
pub(super) fn load(path: &Path, index: &MotionIndex) -> Result<Take, CallError> {
    if path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("asf"))
    {
        let text = "an ASF file is a skeleton without motion; name the AMC file beside it";
        return Err(file_error(path, text));
    }
    let takes = files::open(path);
    let takes = takes.map_err(|error| file_error(&error.path, error.kind))?;
    let take = takes.into_iter().find(|take| take.clip.frames > 0);
    let mut take = take.ok_or_else(|| file_error(path, "the file contains no frame of motion"))?;
    if index.model.needs_rotations() && !take.clip.has_rotations() {
        return Err(file_error(path, NoPivots::Rotations));
    }
    index.complete_roles(&mut take.roles, &take.clip.skeleton);
    Ok(take)
}
