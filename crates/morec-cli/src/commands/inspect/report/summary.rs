//! A summary of several files: their number, length, skeletons, and unusual files.

use std::collections::BTreeMap;
use std::io::{self, Write};

use morec::diagnosis::Severity;
use morec::labels::some_of;

use super::{ClipReport, FileReport, significant};

/// What was inspected so far.
#[derive(Default)]
pub struct FolderSummary {
    files: usize,
    failed: usize,
    clips: usize,
    secs: f64,
    formats: BTreeMap<&'static str, usize>,
    rates: BTreeMap<String, usize>,
    /// Names of the clips of each, by the names of its joints.
    skeletons: BTreeMap<Vec<String>, Vec<String>>,
    /// Clips that are to be looked at, and why.
    odd: Vec<(String, String)>,
}

impl FolderSummary {
    pub fn add(&mut self, file: &FileReport) {
        self.files += 1;
        let FileReport::Read(report) = file else {
            self.failed += 1;
            return;
        };
        for clip in &report.clips {
            *self.formats.entry(report.format.title()).or_default() += 1;
            self.add_clip(clip);
        }
    }

    fn add_clip(&mut self, clip: &ClipReport) {
        self.clips += 1;
        self.secs += clip.duration_secs;
        let rate = format!("{} Hz", significant(clip.rate_hz));
        *self.rates.entry(rate).or_default() += 1;
        let skeleton = clip.joints.iter().map(|joint| joint.name.clone()).collect();
        let alike = self.skeletons.entry(skeleton).or_default();
        alike.push(clip.name.clone());
        if let Some(why) = oddity(clip) {
            self.odd.push((clip.name.clone(), why));
        }
    }

    /// Writes it, if there is more than one file.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.files < 2 {
            return Ok(());
        }
        let counted = |counts: Vec<(&str, usize)>| match &counts[..] {
            [(only, _)] => (*only).to_owned(),
            _ => {
                let each = counts
                    .iter()
                    .map(|(what, count)| format!("{what} ({count})"));
                each.collect::<Vec<_>>().join(", ")
            }
        };
        let formats = self.formats.iter().map(|(what, count)| (*what, *count));
        let rates = self
            .rates
            .iter()
            .map(|(what, count)| (what.as_str(), *count));
        writeln!(
            out,
            "\n{} files, {}, {:.0} s together; {}; {}",
            self.files,
            count(self.clips, "clip"),
            self.secs,
            counted(formats.collect()),
            counted(rates.collect())
        )?;
        self.write_skeletons(out)?;
        for (name, why) in &self.odd {
            writeln!(out, "  check {name}: {why}")?;
        }
        if self.failed > 0 {
            let failed = count(self.failed, "file");
            writeln!(out, "  {failed} could not be read")?;
        }
        if self.odd.is_empty() && self.failed == 0 {
            writeln!(out, "  nothing unusual found")?;
        }
        Ok(())
    }

    /// The skeleton of most clips first; the clips of the others are named.
    fn write_skeletons(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut skeletons: Vec<(&Vec<String>, &Vec<String>)> = self.skeletons.iter().collect();
        skeletons.sort_by_key(|(_, clips)| std::cmp::Reverse(clips.len()));
        for (at, (joints, clips)) in skeletons.into_iter().enumerate() {
            let named = match at {
                0 => String::new(),
                _ => format!(": {}", some_of(clips)),
            };
            let joints = count(joints.len(), "joint");
            let clips = count(clips.len(), "clip");
            writeln!(out, "  skeleton of {joints} in {clips}{named}")?;
        }
        Ok(())
    }
}

fn count(n: usize, what: &str) -> String {
    match n {
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}

/// Why a clip is to be looked at: what is an error, what cannot be true of a body, nothing in it.
fn oddity(clip: &ClipReport) -> Option<String> {
    if clip.frames == 0 {
        return Some("no frames".to_owned());
    }
    let findings = clip.findings().map(|finding| finding.of_file());
    let mut errors = findings.filter(|(severity, _)| *severity == Severity::Error);
    let error = errors.next().map(|(_, text)| text);
    error.or_else(|| clip.facts.doubts.first().cloned())
}
