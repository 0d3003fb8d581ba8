//! A folder with small clips and the command run in it, for all tests.

use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

pub const WAVE_BVH: &str = include_str!("../../../mocap/testdata/acclaim/wave.bvh");
/// Hips, knee and foot in centimetres.
pub const KNEE_FBX: &str = include_str!("../../../mocap/testdata/fbx/knee.fbx");
pub const ARM_ASF: &str = include_str!("../../../mocap/testdata/acclaim/arm.asf");
pub const WAVE_AMC: &str = include_str!("../../../mocap/testdata/acclaim/wave.amc");

pub use mocap::testing::{data, skipped};

/// A folder that lives as long as the test.
pub struct Folder(TempDir);

/// Exit code and output of a command.
#[derive(Debug)]
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Folder {
    /// A folder with these files in it.
    pub fn with(files: &[(&str, &str)]) -> Self {
        let folder = Self(TempDir::new().unwrap());
        for (path, content) in files {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, content).unwrap();
        }
        folder
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// Runs `morec` in this folder.
    pub fn morec(&self, args: &[&str]) -> Ran {
        self.morec_fed(args, None)
    }

    /// Trains `index` from this folder's clips and labels.
    pub fn train(&self, index: &str, more: &[&str]) -> Ran {
        let args = ["train", "--clips", "clips", "--labels", "labels.tsv", "-o"];
        self.morec(&[&args[..], &[index], more].concat())
    }

    /// `morec db check` finds no fault in a database.
    pub fn is_whole(&self, db: &str) {
        let said = self.morec(&["db", "check", db]).ok();
        assert!(said.contains("whole"), "{said}");
    }

    /// Runs `morec` with a file of this folder as its standard input.
    pub fn morec_fed(&self, args: &[&str], input: Option<&str>) -> Ran {
        let stdin = match input {
            Some(file) => Stdio::from(std::fs::File::open(self.path().join(file)).unwrap()),
            None => Stdio::null(),
        };
        let output = Command::new(env!("CARGO_BIN_EXE_morec"))
            .args(args)
            .current_dir(self.path())
            .stdin(stdin)
            .output()
            .unwrap();
        Ran {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Ran {
    /// Its standard output, if all went well.
    pub fn ok(self) -> String {
        assert_eq!(self.code, Some(0), "{self:?}");
        self.out
    }

    /// Its standard error, if it failed as something that cannot be done does.
    pub fn fails(self) -> String {
        assert_eq!(self.code, Some(1), "{self:?}");
        self.err
    }
}
