//! Clips whose frames are files of their own, `walk_000000000012_keypoints.json`, as OpenPose, EasyMocap and the CMU Panoptic Studio
//! write them.
//!
//! Each of these files stands for the whole sequence: its bytes are those of all of them, one behind the other.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::formats::container::Member;
use crate::formats::landmarks::is_one_frame;

use super::bounded::{LARGEST_FILE, read_regular, read_whole, too_large};

/// A file's bytes; of one frame of a clip whose frames are files (`walk_000000000012_keypoints.json`), those of all its frames.
///
/// # Errors
/// The file cannot be read, or is larger than [`LARGEST_FILE`] or [`LARGEST_STREAM`](super::LARGEST_STREAM); nothing of a file that is too large
/// is read.
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    match FrameFiles::around(path) {
        Some(frames) => frames.read(),
        None => read_whole(path),
    }
}

/// Fewer numbered files have their numbers by chance.
const LEAST_FILES: usize = 3;
/// A file of one frame is no larger, bytes.
const LARGEST_FRAME: u64 = 1 << 20;
/// This many times the files that there are may lack.
const MOST_MISSING: u64 = 10;

/// The name of a file around its number.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FrameSeries {
    before: String,
    after: String,
}

/// The series that a file's name belongs to, and its number there: the longest run of digits, the last of several, that does
/// not say how many dimensions there are.
fn numbered(path: &Path) -> Option<(FrameSeries, u64)> {
    let name = path.file_name()?.to_str()?;
    let stem = name.strip_suffix(".json").or(name.strip_suffix(".JSON"))?;
    let digits = |c: char| c.is_ascii_digit();
    let mut best: Option<(usize, usize)> = None;
    let mut at = 0;
    while let Some(start) = stem[at..].find(digits).map(|found| at + found) {
        let rest = &stem[start..];
        let end = start + rest.find(|c| !digits(c)).unwrap_or(rest.len());
        at = end;
        let says_dimensions = stem[end..].starts_with(['d', 'D']);
        if !says_dimensions && best.is_none_or(|(a, b)| end - start >= b - a) {
            best = Some((start, end));
        }
    }
    let (start, end) = best?;
    let series = FrameSeries {
        before: name[..start].to_owned(),
        after: name[end..].to_owned(),
    };
    Some((series, name[start..end].parse().ok()?))
}

/// Files of one frame each that together are a clip, by their numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FrameFiles(BTreeMap<u64, PathBuf>);

impl FrameFiles {
    /// The files that `path` is one of; `None` if it is a file by itself.
    pub(super) fn around(path: &Path) -> Option<Self> {
        let (series, _) = numbered(path).filter(|_| is_frame(path))?;
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
        let paths = entries.flatten().map(|entry| match folder {
            Some(_) => entry.path(),
            None => PathBuf::from(entry.file_name()),
        });
        Self::among(paths)
            .into_iter()
            .find_map(|(known, files)| (known == series).then_some(files))
    }

    /// Every such clip among the files of one folder.
    pub(super) fn among(paths: impl Iterator<Item = PathBuf>) -> Vec<(FrameSeries, Self)> {
        let mut all: BTreeMap<FrameSeries, BTreeMap<u64, PathBuf>> = BTreeMap::new();
        for path in paths {
            if let Some((series, number)) = numbered(&path) {
                all.entry(series).or_default().insert(number, path);
            }
        }
        all.retain(|_, files| files.len() >= LEAST_FILES && are_frames(files));
        let all = all.into_iter();
        all.map(|(series, files)| (series, Self(files))).collect()
    }

    /// In the order of their numbers.
    pub(super) fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.0.values()
    }

    /// All their documents; a file that is missing is an empty one.
    pub(super) fn read(&self) -> io::Result<Vec<u8>> {
        let mut all = Vec::new();
        self.each(|path| {
            match path {
                Some(path) => all.extend(read_regular(path)?),
                None => all.extend(b"null"),
            }
            all.push(b'\n');
            match all.len() as u64 {
                size if size > LARGEST_FILE => Err(too_large(LARGEST_FILE)),
                _ => Ok(()),
            }
        })?;
        Ok(all)
    }

    /// What the clip is called: the names up to their numbers, or that of the folder.
    pub(super) fn name(&self) -> Option<String> {
        let first = self.paths().next()?;
        let (series, _) = numbered(first)?;
        let before = series.before.trim_end_matches(['_', '-', '.', ' ']);
        if !before.is_empty() {
            return Some(before.to_owned());
        }
        let folder = first.parent()?.file_name()?;
        Some(folder.to_string_lossy().into_owned())
    }

    fn each(&self, mut take: impl FnMut(Option<&PathBuf>) -> io::Result<()>) -> io::Result<()> {
        let (Some((&first, _)), Some((&last, _))) =
            (self.0.first_key_value(), self.0.last_key_value())
        else {
            return Ok(());
        };
        // Numbers far apart are times, or none of frames.
        let most = (self.0.len() as u64).saturating_mul(MOST_MISSING);
        if last - first >= most {
            return self.0.values().try_for_each(|path| take(Some(path)));
        }
        (first..=last).try_for_each(|number| take(self.0.get(&number)))
    }
}

/// True if the first, the middle and the last hold one frame each.
fn are_frames(files: &BTreeMap<u64, PathBuf>) -> bool {
    let paths: Vec<&PathBuf> = files.values().collect();
    let looked_at = [0, paths.len() / 2, paths.len() - 1];
    looked_at.iter().all(|&at| is_frame(paths[at]))
}

fn is_frame(path: &Path) -> bool {
    let small = fs::metadata(path).is_ok_and(|about| about.len() <= LARGEST_FRAME);
    small && read_regular(path).is_ok_and(|bytes| is_one_frame(&bytes))
}

/// The files of an archive with those of one frame each put together, in place of the first.
pub(super) fn join(mut members: Vec<Member>) -> Vec<Member> {
    let folder = |path: &str| {
        path.rsplit_once('/')
            .map_or("", |(folder, _)| folder)
            .to_owned()
    };
    let mut all: BTreeMap<(String, FrameSeries), BTreeMap<u64, usize>> = BTreeMap::new();
    for (at, member) in members.iter().enumerate() {
        if let Some((series, number)) = numbered(Path::new(&member.path)) {
            let key = (folder(&member.path), series);
            all.entry(key).or_default().insert(number, at);
        }
    }
    let is_frames = |files: &BTreeMap<u64, usize>| {
        let is_frame = |bytes: &[u8]| bytes.len() as u64 <= LARGEST_FRAME && is_one_frame(bytes);
        files.len() >= LEAST_FILES && files.values().all(|&at| is_frame(&members[at].bytes))
    };
    all.retain(|_, files| is_frames(files));
    let mut joined: BTreeMap<usize, Member> = BTreeMap::new();
    let mut taken = vec![false; members.len()];
    for ((folder, series), files) in all {
        let known: BTreeMap<u64, PathBuf> = files
            .iter()
            .map(|(&number, &at)| (number, PathBuf::from(&members[at].path)))
            .collect();
        let places = known.values().cloned().zip(files.values().copied());
        let places: BTreeMap<PathBuf, usize> = places.collect();
        let known = FrameFiles(known);
        let mut bytes = Vec::new();
        // Nothing fails here: all is in memory.
        let _ = known.each(|path| {
            let at = path.and_then(|path| places.get(path));
            // What is joined is held once.
            match at {
                Some(&at) => bytes.append(&mut members[at].bytes),
                None => bytes.extend(b"null"),
            }
            bytes.push(b'\n');
            Ok(())
        });
        let name = known.name().unwrap_or_else(|| series.before.clone());
        let path = match folder.as_str() {
            "" => format!("{name}.json"),
            folder => format!("{folder}/{name}.json"),
        };
        for &at in files.values() {
            taken[at] = true;
        }
        if let Some(&first) = files.values().next() {
            joined.insert(first, Member { path, bytes });
        }
    }
    let kept = members.into_iter().enumerate().filter_map(|(at, member)| {
        joined
            .remove(&at)
            .or_else(|| (!taken[at]).then_some(member))
    });
    kept.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{FileReader, list, read_file};
    use serde_json::json;

    fn frame(number: usize, columns: usize) -> String {
        let row = |width: usize| -> Vec<f64> {
            let point = |j: usize| {
                let unseen = j == 3 && number == 4;
                let sure = if unseen { 0.0 } else { 0.9 };
                let place = [number as f64 * 0.01, 0.1 * j as f64 + 0.1, 0.3];
                let mut point = place[..width].to_vec();
                point.push(sure);
                point
            };
            (0..25).flat_map(point).collect()
        };
        let people = match columns {
            3 => json!([{"pose_keypoints_2d": [], "pose_keypoints_3d": row(3)}]),
            2 => json!([{"pose_keypoints_2d": row(2), "pose_keypoints_3d": []}]),
            _ => json!([]),
        };
        json!({"version": 1.3, "people": people}).to_string()
    }

    fn folder(columns: usize) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for number in (0..12).filter(|&n| n != 7) {
            // Nobody is there at first.
            let text = frame(number, if number < 2 { 0 } else { columns });
            let name = format!("walk_{number:012}_keypoints.json");
            fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    #[test]
    fn frames_in_files_of_their_own_are_a_clip() {
        let folder = folder(3);
        fs::write(folder.path().join("notes_1.json"), "{\"a\": [1, 2]}").unwrap();
        let listing = list(&[folder.path().to_owned()]).unwrap();
        assert_eq!(listing.clips.len(), 1, "{:?}", listing.clips);
        let read = FileReader::default().read(&listing.clips[0]).unwrap();
        let clip = &read.clips[0];
        assert_eq!((clip.name.as_str(), clip.frames), ("walk", 12));
        let x = |frame: usize| clip.tracks[0].positions[frame].x;
        assert!((x(11) - 0.11).abs() < 1e-9);
        // A frame that is missing and a point that nobody saw are interpolated.
        assert!((x(7) - 0.07).abs() < 1e-9);
        assert!((clip.tracks[3].positions[4].x - 0.04).abs() < 1e-9);
        assert!(clip.repaired.iter().any(|span| span.contains(&4)));
        // Any of the files is the clip, and its bytes are those of all.
        let path = folder.path().join("walk_000000000005_keypoints.json");
        assert_eq!(
            FileReader::default().read(&path).unwrap().clips[0].frames,
            12
        );
        assert_eq!(
            read_file(&path).unwrap(),
            read_file(&listing.clips[0]).unwrap()
        );
    }

    #[test]
    fn two_dimensions_are_refused_once() {
        let folder = folder(2);
        let all = FileReader::default().open_all(&[folder.path().to_owned()]);
        let error = all.unwrap_err().to_string();
        assert_eq!(error.matches("two dimensions").count(), 1, "{error}");
    }

    #[test]
    fn an_archive_of_frames_is_a_clip() {
        use std::io::Write;
        let mut zip = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
        for number in 0..5 {
            let options = zip::write::SimpleFileOptions::default();
            zip.start_file(format!("out/{number:06}.json"), options)
                .unwrap();
            zip.write_all(frame(number, 3).as_bytes()).unwrap();
        }
        let bytes = zip.finish().unwrap().into_inner();
        let read = FileReader::default()
            .parse(Path::new("a.zip"), &bytes)
            .unwrap();
        assert_eq!((read.clips.len(), read.clips[0].frames), (1, 5));
        assert_eq!(read.clips[0].name, "out");
    }

    #[test]
    fn clips_with_numbers_stay_clips() {
        let folder = tempfile::tempdir().unwrap();
        let point = json!({"x": 0.1, "y": 0.2, "z": 0.3});
        let clip = json!({"landmarks": vec![vec![point; 33]; 20]}).to_string();
        for number in 0..4 {
            fs::write(folder.path().join(format!("take_{number}.json")), &clip).unwrap();
        }
        let listing = list(&[folder.path().to_owned()]).unwrap();
        assert_eq!(listing.clips.len(), 4);
        assert_eq!(
            fs::read(&listing.clips[2]).unwrap(),
            read_file(&listing.clips[2]).unwrap()
        );
    }

    #[test]
    fn numbers_in_names() {
        for (name, before, number) in [
            ("walk_000000000012_keypoints.json", "walk_", 12),
            ("cam1_000031.json", "cam1_", 31),
            ("body3DScene_00000007.json", "body3DScene_", 7),
            ("f5_3d.json", "f", 5),
        ] {
            let (series, found) = numbered(Path::new(name)).unwrap();
            assert_eq!((series.before.as_str(), found), (before, number), "{name}");
        }
        assert_eq!(numbered(Path::new("walk.json")), None);
        assert_eq!(numbered(Path::new("walk_1.csv")), None);
    }
}
