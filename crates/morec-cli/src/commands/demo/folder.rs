//! The demo's folder: what lies where, and the commands that work on it.

use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec::synth::SyntheticTake;
use rayon::prelude::*;

use crate::commands::convert::write_clip;
use crate::output;

/// Says that a folder is a demo's, so that a second demo may write over it.
const MARKER: &str = ".morec-demo";
const MARKER_TEXT: &str = "Made by `morec demo`, which writes over the files here when it is run again. Safe to delete.\n";

/// A folder that is the demo's own.
pub struct DemoFolder(PathBuf);

impl DemoFolder {
    /// Makes `folder`, or takes an empty one or an earlier demo's; refuses any other.
    pub fn claim(folder: &Path) -> Result<Self> {
        let shown = || folder.display().to_string();
        let marker = folder.join(MARKER);
        if folder.exists() && !folder.is_dir() {
            bail!("{}: is a file; give another --folder", shown());
        }
        if folder.is_dir()
            && !marker.is_file()
            && std::fs::read_dir(folder)
                .with_context(shown)?
                .next()
                .is_some()
        {
            bail!(
                "{}: holds files that are no demo's, nothing was written; give another --folder",
                shown()
            );
        }
        for part in ["clips", "new"] {
            std::fs::create_dir_all(folder.join(part)).with_context(shown)?;
        }
        output::write_whole(&marker, |out| out.write_all(MARKER_TEXT.as_bytes()))
            .with_context(shown)?;
        Ok(Self(folder.to_owned()))
    }

    /// Writes clips, labels and people of those to train on, and clip and truth of the one to recognise.
    pub fn write(&self, taught: &[SyntheticTake], unseen: &SyntheticTake) -> Result<()> {
        let all: Vec<(&SyntheticTake, bool)> = taught
            .iter()
            .map(|t| (t, false))
            .chain([(unseen, true)])
            .collect();
        all.par_iter().try_for_each(|(take, unseen)| {
            let path = self.clip(take, *unseen);
            write_clip(&take.clip, &path).with_context(|| path.display().to_string())
        })?;
        self.write_text("labels.tsv", &labels(taught))?;
        self.write_text("truth.tsv", &labels(std::slice::from_ref(unseen)))?;
        let people = taught
            .iter()
            .map(|t| format!("{}\t{}\n", t.clip.name, t.person));
        self.write_text(
            "people.tsv",
            &people.fold("clip\tperson\n".to_owned(), |text, row| text + &row),
        )
    }

    fn write_text(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path(name);
        output::write_whole(&path, |out| out.write_all(text.as_bytes()))
            .with_context(|| path.display().to_string())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Where a take's clip lies.
    pub fn clip(&self, take: &SyntheticTake, unseen: bool) -> PathBuf {
        self.path(if unseen { "new" } else { "clips" })
            .join(format!("{}.bvh", take.clip.name))
    }

    /// Where the detections lie.
    pub fn found(&self) -> PathBuf {
        self.path("found.tsv")
    }

    /// What was written, for people to read.
    pub fn contents(&self, taught: &[SyntheticTake], unseen: &SyntheticTake) -> String {
        let minutes: f64 = taught.iter().map(|t| t.clip.duration_secs()).sum::<f64>() / 60.0;
        let samples: usize = taught.iter().map(|t| t.labels.len()).sum();
        let mut text = format!("\nWritten to {}:\n", self.0.display());
        let mut line = |name: &str, about: String| _ = writeln!(text, "  {name:<11} {about}");
        line(
            "clips/",
            format!("{} people, a BVH file each, {minutes:.1} min", taught.len()),
        );
        line(
            "labels.tsv",
            format!("which gesture is where in them: {samples} samples"),
        );
        line("people.tsv", "who is seen in which clip".to_owned());
        line(
            "new/",
            format!(
                "{}, who is not trained on, {:.1} min",
                unseen.person,
                unseen.clip.duration_secs() / 60.0
            ),
        );
        line(
            "truth.tsv",
            format!("what {} does when, for measuring only", unseen.person),
        );
        text.pop();
        text
    }

    /// The command that trains.
    pub fn train(&self) -> Vec<OsString> {
        self.command(
            "train",
            &[
                ("--clips", "clips"),
                ("--labels", "labels.tsv"),
                ("--people", "people.tsv"),
                ("-o", "demo.index"),
            ],
        )
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
                ("--truth", "truth.tsv"),
                ("--found", "found.tsv"),
                ("--clips", "new"),
                ("--report", "report"),
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

    /// What to make of it all.
    pub fn farewell(&self) -> String {
        format!(
            "These people are made, not recorded: the figures above say nothing about accuracy on real people.\n\
             The report, with timelines: {}\n\
             With clips of your own, in any folder, and a table of labels like {}, the same three commands do it:\n  \
             morec train, morec recognize, morec evaluate (--help tells the rest).",
            self.path("report").join("report.html").display(),
            self.path("labels.tsv").display()
        )
    }
}

/// A table of labels in frames.
fn labels(takes: &[SyntheticTake]) -> String {
    let mut text = "clip\tclass\tstart\tstop\n".to_owned();
    for take in takes {
        for label in &take.labels {
            let span = label.span(take.clip.rate_hz);
            _ = writeln!(
                text,
                "{}\t{}\t{}\t{}",
                take.clip.name, label.class, span.start, span.end
            );
        }
    }
    text
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
