//! The ASF skeleton of an AMC motion: which files near it may be it, the likeliest first.

use std::fs;
use std::path::{Path, PathBuf};

use crate::formats::container::Member;
use crate::formats::probe::{Format, format_of_name};

/// So many skeletons in one folder are a library's, and trying them all no way to find the right one.
const MAX_PER_FOLDER: usize = 64;

/// A skeleton file that may be a motion's.
pub(super) struct SkeletonFile {
    /// How much the names have in common; 0 if the name says nothing.
    pub kinship: usize,
    pub path: PathBuf,
}

/// Skeletons beside a motion and then those a folder above, in each the likeliest first: of the same stem, of
/// the longest part of it (`13` for `13_29`), the others.
pub(super) fn skeletons_near(path: &Path, stem: &str) -> Vec<SkeletonFile> {
    if path == Path::new("-") {
        return Vec::new();
    }
    let beside = match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let above = match (beside.file_name(), beside.parent()) {
        (Some(_), Some(above)) if above != Path::new("") => above.to_owned(),
        (Some(_), _) => PathBuf::from("."),
        (None, _) => beside.join(".."),
    };
    let mut found = Vec::new();
    for folder in [beside, above] {
        let paths = fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()));
        let mut here = likeliest_first(paths, stem);
        here.truncate(MAX_PER_FOLDER);
        found.append(&mut here);
    }
    found
}

/// Skeletons in the archive that a motion is in.
pub(super) fn skeletons_among(members: &[Member], stem: &str) -> Vec<SkeletonFile> {
    likeliest_first(members.iter().map(|m| PathBuf::from(&m.path)), stem)
}

fn likeliest_first(paths: impl Iterator<Item = PathBuf>, stem: &str) -> Vec<SkeletonFile> {
    let mut found: Vec<SkeletonFile> = paths
        .filter(|path| format_of_name(&path.to_string_lossy()) == Some(Format::Asf))
        .map(|path| SkeletonFile {
            kinship: kinship(
                &path.file_stem().unwrap_or_default().to_string_lossy(),
                stem,
            ),
            path,
        })
        .collect();
    found.sort_by(|a, b| b.kinship.cmp(&a.kinship).then_with(|| a.path.cmp(&b.path)));
    found
}

/// How much of a motion's stem a skeleton's stem says: its length if the motion's begins with it and a mark
/// follows, else 0.
fn kinship(skeleton: &str, motion: &str) -> usize {
    match motion.to_lowercase().strip_prefix(&skeleton.to_lowercase()) {
        Some(rest) if rest.chars().next().is_none_or(|c| !c.is_alphanumeric()) => {
            skeleton.len() + 1
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subjects_own_their_trials() {
        assert!(kinship("13_29", "13_29") > kinship("13", "13_29"));
        assert!(kinship("13", "13_29") > 0);
        assert_eq!(kinship("1", "13_29"), 0);
        assert_eq!(kinship("skeleton", "13_29"), 0);
        assert!(kinship("HDM_dg", "hdm_dg_06-03_120") > 0);
    }
}
