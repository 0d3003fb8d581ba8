//! The demo's folder: its files, and the commands that use them.

use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::cast::Cast;
use crate::output;

/// Says that a folder is a demo's, so that a second demo may write over it.
const MARKER: &str = ".morec-demo";
const MARKER_TEXT: &str =
    "Created by `morec demo`, which overwrites these files when run again. Safe to delete.\n";

/// A folder that is the demo's own.
pub struct DemoFolder(PathBuf);

impl DemoFolder {
    /// Makes `folder`, or takes an empty one or an earlier demo's; refuses any other.
    pub fn claim(folder: &Path) -> Result<Self> {
        let shown = || folder.display().to_string();
        let marker = folder.join(MARKER);
        if folder.exists() && !folder.is_dir() {
            bail!(
                "{}: expected a folder, found a file; give another --folder",
                shown()
            );
        }
        if folder.is_dir()
            && !marker.is_file()
            && std::fs::read_dir(folder)
                .with_context(shown)?
                .next()
                .is_some()
        {
            bail!(
                "{}: contains other files; nothing was written; give another --folder",
                shown()
            );
        }
        for part in ["clips", "new", "background"] {
            let part = folder.join(part);
            if part.is_dir() {
                // An earlier demo's, perhaps of other people.
                std::fs::remove_dir_all(&part).with_context(shown)?;
            }
        }
        std::fs::create_dir_all(folder).with_context(shown)?;
        output::write_whole(&marker, |out| out.write_all(MARKER_TEXT.as_bytes()))
            .with_context(shown)?;
        Ok(Self(folder.to_owned()))
    }

    /// Writes the files of a cast.
    pub fn write(&self, cast: &Cast) -> Result<()> {
        for (name, bytes) in &cast.files {
            let path = self.path(name);
            let shown = || path.display().to_string();
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder).with_context(shown)?;
            }
            output::write_whole(&path, |out| out.write_all(bytes)).with_context(shown)?;
        }
        Ok(())
    }

    /// A file or folder in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Path of the detections.
    pub fn found(&self) -> PathBuf {
        self.path("found.tsv")
    }

    /// Summary of the files, for people to read.
    pub fn contents(&self, cast: &Cast) -> String {
        let mut text = format!("\nWritten to {}:\n", self.0.display());
        for (name, about) in &cast.contents {
            _ = writeln!(text, "  {name:<11} {about}");
        }
        text.pop();
        text
    }

    /// The command that trains.
    pub fn train(&self, cast: &Cast) -> Vec<OsString> {
        let mut parts = vec![
            ("--clips", "clips"),
            ("--labels", "labels.tsv"),
            ("--people", "people.tsv"),
        ];
        parts.extend(cast.background.then_some(("--background", "background")));
        parts.push(("-o", "demo.index"));
        self.command("train", &parts)
    }

    /// The command that recognises.
    pub fn recognize(&self) -> Vec<OsString> {
        self.command(
            "recognize",
            &[("", "demo.index"), ("", "new"), ("-o", "found.tsv")],
        )
    }

    /// The command that measures.
    pub fn evaluate(&self) -> Vec<OsString> {
        self.command(
            "evaluate",
            &[
                ("--labels", "truth.tsv"),
                ("--found", "found.tsv"),
                ("--clips", "new"),
                ("--report", "report/report.html"),
            ],
        )
    }

    /// A command over files of this folder; `""` is the option of an argument without one.
    fn command(&self, name: &str, parts: &[(&str, &str)]) -> Vec<OsString> {
        let words = parts.iter().flat_map(|(option, file)| {
            let option = Some(*option).filter(|o| !o.is_empty()).map(OsString::from);
            option.into_iter().chain([self.path(file).into_os_string()])
        });
        std::iter::once(OsString::from(name)).chain(words).collect()
    }

    /// Closing words.
    pub fn farewell(&self, cast: &Cast) -> String {
        format!(
            "{}\n\
             The report, with timelines: {}\n\
             For your own clips, in any folder, with a table of labels like {}, use the same three commands:\n  \
             morec train, morec recognize, morec evaluate (see --help).",
            cast.caveat,
            self.path("report/report.html").display(),
            self.path("labels.tsv").display()
        )
    }
}

/// `morec` and `words` as typed into a shell.
pub fn shell_line(words: &[OsString]) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./\\:+=@%,".contains(c);
    let quoted = words.iter().map(|word| {
        let word = word.to_string_lossy();
        match word.chars().all(plain) && (cfg!(windows) || !word.contains('\\')) {
            true => format!(" {word}"),
            false if cfg!(windows) => format!(" \"{word}\""),
            false => format!(" '{}'", word.replace('\'', r"'\''")),
        }
    });
    std::iter::once("morec".to_owned()).chain(quoted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_can_be_pasted_into_a_shell() {
        let line =
            |words: &[&str]| shell_line(&words.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(
            line(&["train", "-o", "a/b.index"]),
            "morec train -o a/b.index"
        );
        if cfg!(unix) {
            assert_eq!(
                line(&["inspect", "my clips/$a'b"]),
                r"morec inspect 'my clips/$a'\''b'"
            );
        }
    }
}
