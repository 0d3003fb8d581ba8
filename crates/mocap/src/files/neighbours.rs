//! Finds the other files that a file needs, such as buffers of glTF. Only files in the same folder or below are read.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use crate::formats::container::Member;

use super::bounded::read_regular;

/// Place of files that another file needs.
#[derive(Clone, Copy)]
pub(super) enum Around<'a> {
    /// On disk.
    Folder,
    /// In the same archive.
    Archive(&'a [Member]),
}

impl Around<'_> {
    /// A file by its path.
    pub(super) fn read(&self, path: &Path) -> io::Result<Cow<'_, [u8]>> {
        match self {
            Around::Folder => read_regular(path).map(Cow::Owned),
            Around::Archive(members) => members
                .iter()
                .find(|member| Path::new(&member.path) == path)
                .map(|member| Cow::Borrowed(member.bytes.as_slice()))
                .ok_or_else(|| io::Error::from(io::ErrorKind::NotFound)),
        }
    }

    /// A file beside another.
    pub(super) fn file(&self, path: &Path, name: &str) -> io::Result<Vec<u8>> {
        match (self, path == Path::new("-")) {
            (Around::Folder, true) => Err(io::Error::from(io::ErrorKind::NotFound)),
            _ => Ok(self.read(&path.with_file_name(name))?.into_owned()),
        }
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::fs::{self, File};
    use std::os::unix::fs::symlink;
    use std::path::Path;
    use std::process::Command;

    use crate::files::{FileReader, open};

    const ASF: &[u8] = include_bytes!("../../testdata/acclaim/arm.asf");
    const AMC: &[u8] = include_bytes!("../../testdata/acclaim/wave.amc");

    fn pipe(path: &Path) {
        let made = Command::new("mkfifo").arg(path).status();
        assert!(made.unwrap().success());
    }

    fn refused(path: &Path, with: &str) {
        let error = open(path).map(drop).unwrap_err().to_string();
        assert!(error.contains(with), "{error}");
    }

    /// Opening a pipe waits for its writer, and a device never ends.
    #[test]
    fn what_a_motion_needs_is_read_from_files_alone() {
        let folder = tempfile::TempDir::new().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("13_29.amc"), AMC).unwrap();
        symlink("/dev/zero", at("13_29.asf")).unwrap();
        refused(&at("13_29.amc"), "13_29.asf: expected a file, found a pipe");
        pipe(&at("13.asf"));
        fs::remove_file(at("13_29.asf")).unwrap();
        refused(&at("13_29.amc"), "13.asf: expected a file, found a pipe");
        let named = FileReader {
            skeleton: Some(at("13.asf")),
            ..FileReader::default()
        };
        assert!(named.open(&at("13_29.amc")).is_err());
        // A file that is too large is not read, and one that fits is found behind it.
        let large = File::create(at("13_2.asf")).unwrap();
        large.set_len(3 << 30).unwrap();
        refused(&at("13_29.amc"), "13.asf");
        fs::write(at("13_29.asf"), ASF).unwrap();
        assert_eq!(open(at("13_29.amc")).unwrap().len(), 1);
        // A file that lies elsewhere is one.
        fs::rename(at("13_29.asf"), at("elsewhere")).unwrap();
        symlink(at("elsewhere"), at("13_29.asf")).unwrap();
        assert_eq!(open(at("13_29.amc")).unwrap().len(), 1);
    }

    #[test]
    fn buffers_and_frames_are_read_from_files_alone() {
        let folder = tempfile::TempDir::new().unwrap();
        let at = |name: &str| folder.path().join(name);
        pipe(&at("keys.bin"));
        let scene = r#"{"asset": {"version": "2.0"}, "scenes": [], "buffers": [{"uri": "keys.bin", "byteLength": 8}],
            "bufferViews": [{"buffer": 0, "byteLength": 8}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"}],
            "nodes": [{"name": "Hips", "children": [1]}, {"name": "Spine", "children": [2]}, {"name": "Head"}],
            "skins": [{"joints": [0, 1, 2]}],
            "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                "samplers": [{"input": 0, "output": 0}]}]}"#;
        fs::write(at("walk.gltf"), scene).unwrap();
        refused(
            &at("walk.gltf"),
            "keys.bin beside it: expected a file, found a pipe",
        );
        fs::remove_file(at("keys.bin")).unwrap();
        refused(&at("walk.gltf"), "no file keys.bin beside it");
        // One frame of a sequence.
        let frame = r#"{"version": 1.3, "people": []}"#;
        for number in [0, 2, 3] {
            fs::write(at(&format!("walk_{number:012}_keypoints.json")), frame).unwrap();
        }
        pipe(&at("walk_000000000001_keypoints.json"));
        refused(
            &at("walk_000000000000_keypoints.json"),
            "expected a file, found a pipe",
        );
    }
}
