//! Candidates for the ASF skeleton of an AMC motion, or for the model of an OpenSim motion, most likely first.

use std::fs;
use std::path::{Path, PathBuf};

use crate::formats::Format;
use crate::formats::container::Member;
use crate::formats::probe::format_of_name;

use super::FileErrorKind;

/// This many skeletons in one folder are a library's, and trying them all no way to find the right one.
const MAX_PER_FOLDER: usize = 64;

/// Kind of skeleton file that a motion needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SkeletonKind {
    /// Of AMC motions.
    Asf,
    /// Of OpenSim's joint angles.
    OsimModel,
}

impl SkeletonKind {
    fn format(self) -> Format {
        match self {
            SkeletonKind::Asf => Format::Asf,
            SkeletonKind::OsimModel => Format::OpenSimModel,
        }
    }

    /// The error of a motion without a skeleton near it.
    pub(super) fn missing(self) -> FileErrorKind {
        match self {
            SkeletonKind::Asf => FileErrorKind::NoSkeleton,
            SkeletonKind::OsimModel => FileErrorKind::NoModel,
        }
    }
}

/// A skeleton file that may be a motion's.
pub(super) struct SkeletonFile {
    /// Likeness of the names; 0 if the name says nothing.
    pub kinship: usize,
    pub path: PathBuf,
}

/// Skeletons beside a motion and then those a folder above, in each the likeliest first: of the same stem, of
/// the longest part of it (`13` for `13_29`), the others.
pub(super) fn skeletons_near(path: &Path, stem: &str, kind: SkeletonKind) -> Vec<SkeletonFile> {
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
        let mut here = likeliest_first(paths, stem, kind);
        here.truncate(MAX_PER_FOLDER);
        found.append(&mut here);
    }
    found
}

/// Skeletons in the archive that a motion is in.
pub(super) fn skeletons_among(
    members: &[Member],
    stem: &str,
    kind: SkeletonKind,
) -> Vec<SkeletonFile> {
    likeliest_first(members.iter().map(|m| PathBuf::from(&m.path)), stem, kind)
}

fn likeliest_first(
    paths: impl Iterator<Item = PathBuf>,
    stem: &str,
    kind: SkeletonKind,
) -> Vec<SkeletonFile> {
    let mut found: Vec<SkeletonFile> = paths
        .filter(|path| format_of_name(&path.to_string_lossy()) == Some(kind.format()))
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

/// A skeleton whose name is stated on the first lines of a motion (`#!OML:ASF C:\\takes\\anna.ASF`) comes before all others.
pub(super) fn prefer_stated(candidates: &mut [SkeletonFile], motion: &[u8]) {
    const LINES: usize = 10;
    let head = String::from_utf8_lossy(&motion[..motion.len().min(4096)]).to_lowercase();
    let stated: Vec<&str> = head
        .lines()
        .take(LINES)
        .filter_map(|line| line.trim().strip_suffix(".asf"))
        .filter_map(|line| line.rsplit(['\\', '/', ' ', ':']).next())
        .collect();
    for candidate in candidates.iter_mut() {
        let stem = candidate.path.file_stem().unwrap_or_default();
        if stated.contains(&stem.to_string_lossy().to_lowercase().as_str()) {
            // As much as a file of the motion's own name.
            candidate.kinship = usize::MAX;
        }
    }
    candidates.sort_by_key(|candidate| std::cmp::Reverse(candidate.kinship));
}

/// Likeness of a motion's stem to a skeleton's stem: most if the motion's begins with it and a mark follows; less if all
/// its words are among the motion's, whatever zeros stand before their numbers; else 0.
fn kinship(skeleton: &str, motion: &str) -> usize {
    const BEGINS: usize = 1000;
    let (skeleton, motion) = (skeleton.to_lowercase(), motion.to_lowercase());
    match motion.strip_prefix(&skeleton) {
        Some(rest) if rest.chars().next().is_none_or(|c| !c.is_alphanumeric()) => {
            BEGINS + skeleton.len()
        }
        _ => {
            let (own, of_motion) = (words(&skeleton), words(&motion));
            match !own.is_empty() && own.iter().all(|word| of_motion.contains(word)) {
                true => skeleton.len(),
                false => 0,
            }
        }
    }
}

/// Words and numbers of a name, without zeros before them; words for what such files are say nothing.
fn words(name: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let same = |c: char| match first {
            first if first.is_ascii_digit() => c.is_ascii_digit(),
            first if first.is_alphabetic() => c.is_alphabetic(),
            _ => !c.is_alphanumeric(),
        };
        let end = rest.find(|c| !same(c)).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        if first.is_alphanumeric() {
            words.push(word.trim_start_matches('0'));
        }
        rest = after;
    }
    words.retain(|word| {
        !matches!(
            *word,
            "skeleton" | "skel" | "subject" | "actor" | "asf" | "model" | "osim"
        )
    });
    words
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
        assert!(kinship("subject13", "walk_13_02") > 0);
        assert!(kinship("07", "7_walk") > 0);
        assert_eq!(kinship("3", "13_29"), 0);
        assert!(kinship("13", "13_29") > kinship("29", "13_29"));
    }

    #[test]
    fn a_motion_may_state_its_skeleton() {
        let mut near = likeliest_first(
            ["a.asf", "walk.asf", "rory3.ASF"]
                .map(PathBuf::from)
                .into_iter(),
            "walk",
            SkeletonKind::Asf,
        );
        assert_eq!(near[0].path, PathBuf::from("walk.asf"));
        prefer_stated(
            &mut near,
            b"#!OML:ASF F:\\VICON\\USERDATA\\rory3.ASF\n:FULLY-SPECIFIED\n1\n",
        );
        assert_eq!(near[0].path, PathBuf::from("rory3.ASF"));
    }
}
