//! Videos beside the pages that play clips.

use std::path::{Path, PathBuf};

use morec_measure::player::PlayedVideo;

/// The video `file` as seen from a page that is written to `page`; the clip begins at `offset_secs` of it.
///
/// # Errors
/// A sentence that begins with the path that is not there.
pub fn video_of_page(page: &Path, file: &Path, offset_secs: f64) -> Result<PlayedVideo, String> {
    let absolute = |path: &Path| -> Result<PathBuf, String> {
        path.canonicalize()
            .map_err(|why| format!("{}: {why}", path.display()))
    };
    let folder = page.parent().filter(|folder| *folder != Path::new(""));
    let folder = absolute(folder.unwrap_or(Path::new(".")))?;
    Ok(PlayedVideo::of(&folder, &absolute(file)?, offset_secs))
}
