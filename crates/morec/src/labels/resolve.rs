//! Turns the rows of a table into samples of existing clips, in seconds.

use std::collections::{BTreeMap, BTreeSet};

use super::ground_truth::GroundTruth;
use super::{Extent, Label, Labels, doubtful_unit, misspelled};
use crate::TimeSpan;
use crate::clip::Clip;
use crate::formats::{Place, Warning};

/// What turns frames of a clip into seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipLength {
    /// Number of frames.
    pub frames: usize,
    /// Frames a second; positive.
    pub rate_hz: f64,
}

impl From<&Clip> for ClipLength {
    fn from(clip: &Clip) -> Self {
        Self {
            frames: clip.frames,
            rate_hz: clip.rate_hz,
        }
    }
}

/// A labelled stretch of a clip, in seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The clip's name.
    pub clip: String,
    /// Class of the motion.
    pub class: String,
    /// When it happens, from the clip's beginning.
    pub span: TimeSpan,
    /// True if the table gave no extent: the clip as a whole is the sample, still ends and all.
    pub whole_clip: bool,
    /// The person who moves, if known.
    pub person: Option<String>,
    /// The line of its row.
    pub line: u64,
}

/// Samples and what had to be changed or left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Resolved {
    /// The samples in the order of their rows.
    pub samples: Vec<Sample>,
    /// Clips that the table names and that are not there, with the number of their rows.
    pub absent: BTreeMap<String, usize>,
    /// Number of labels that were cut or left out at the end of their clips.
    pub beyond: usize,
    /// Number of those that were left out.
    pub left_out: usize,
    /// Labels that were cut, left out, or overlap another.
    pub warnings: Vec<Warning>,
}

impl From<Sample> for GroundTruth {
    fn from(sample: Sample) -> Self {
        Self {
            clip: sample.clip,
            class: sample.class,
            span: sample.span,
        }
    }
}

impl ClipLength {
    /// Length in seconds; a frame counts for its whole period.
    pub fn duration_secs(&self) -> f64 {
        self.frames as f64 / self.rate_hz
    }

    /// An extent in seconds, not yet held against the clip's length.
    pub fn span(&self, extent: &Extent) -> TimeSpan {
        match extent {
            Extent::Frames(frames) => TimeSpan::of_frames(frames.clone(), self.rate_hz),
            Extent::Secs(span) => *span,
            Extent::WholeClip => TimeSpan::new(0.0, self.duration_secs()),
        }
    }
}

/// What a clip may be called that labels call `name`: itself, without its file ending, without the folders before it, without both.
pub fn names_of_clip(name: &str) -> impl Iterator<Item = &str> {
    let stem = |name: &str| {
        name.rsplit_once('.')
            .map_or(name.len(), |(stem, _)| stem.len())
    };
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    [name, &name[..stem(name)], base, &base[..stem(base)]].into_iter()
}

/// The name under which `clips` knows a clip that a table calls `name`.
pub(super) fn known_name<'a>(
    name: &'a str,
    clips: &BTreeMap<String, ClipLength>,
) -> Option<&'a str> {
    names_of_clip(name).find(|name| clips.contains_key(*name))
}

impl Labels {
    /// Turns rows into samples of `clips`, by clip name. A label beyond its clip's end is cut or left out, and
    /// samples of a clip that overlap by more than half a frame are kept, each with a warning.
    /// O(n log n) in the number of rows.
    pub fn resolve(&self, clips: &BTreeMap<String, ClipLength>) -> Resolved {
        let mut resolved = Resolved::default();
        for row in &self.rows {
            match known_name(&row.clip, clips) {
                Some(name) => resolved.add(row, name, clips[name]),
                None => *resolved.absent.entry(row.clip.clone()).or_insert(0) += 1,
            }
        }
        resolved.warn_of_overlaps(clips);
        resolved
    }
}

impl Resolved {
    fn add(&mut self, row: &Label, clip: &str, length: ClipLength) {
        let duration_secs = length.duration_secs();
        let half_frame = 0.5 / length.rate_hz;
        let mut span = length.span(&row.extent);
        let mut warn = |text: String| {
            self.beyond += 1;
            self.warnings
                .push(Warning::new(Place::Line(row.line), text))
        };
        let end = format!(
            "{clip} ends at {duration_secs:.3} s (frame {})",
            length.frames
        );
        if length.frames == 0 || span.start_secs >= duration_secs {
            self.left_out += 1;
            return warn(format!(
                "the label starts at {:.3} s but {end}; left out",
                span.start_secs
            ));
        }
        if span.stop_secs > duration_secs {
            // Seconds in a table are rounded: less than half a frame is no mistake.
            if span.stop_secs > duration_secs + half_frame {
                warn(format!(
                    "the label stops at {:.3} s but {end}; cut there",
                    span.stop_secs
                ));
            }
            span.stop_secs = duration_secs;
        }
        self.samples.push(Sample {
            clip: clip.to_owned(),
            class: row.class.clone(),
            span,
            whole_clip: row.extent == Extent::WholeClip,
            person: row.person.clone(),
            line: row.line,
        });
    }

    fn warn_of_overlaps(&mut self, clips: &BTreeMap<String, ClipLength>) {
        let mut order: Vec<&Sample> = self.samples.iter().collect();
        order.sort_by(|a, b| {
            (a.clip.cmp(&b.clip))
                .then(a.span.start_secs.total_cmp(&b.span.start_secs))
                .then(a.line.cmp(&b.line))
        });
        let mut warnings = Vec::new();
        // Whoever reaches furthest so far is the one that the next can overlap.
        let mut furthest: Option<&Sample> = None;
        for sample in order {
            let before = furthest.filter(|f| f.clip == sample.clip);
            if let Some(before) = before.filter(|b| {
                b.span.stop_secs - sample.span.start_secs > 0.5 / clips[&sample.clip].rate_hz
            }) {
                let text = format!(
                    "{} at {:.3} s overlaps {} of line {}, which stops at {:.3} s",
                    sample.class,
                    sample.span.start_secs,
                    before.class,
                    before.line,
                    before.span.stop_secs
                );
                warnings.push(Warning::new(Place::Line(sample.line), text));
            }
            if before.is_none_or(|b| sample.span.stop_secs > b.span.stop_secs) {
                furthest = Some(sample);
            }
        }
        self.warnings.extend(warnings);
    }

    /// Reason why the table's times are probably not in the unit that its columns say; see [`doubtful_unit`].
    pub fn doubtful_unit(&self) -> Option<String> {
        let parts = self.samples.iter().filter(|s| !s.whole_clip);
        let secs = parts.map(|s| s.span.duration_secs());
        doubtful_unit(secs, self.beyond, self.left_out)
    }

    /// Questions about classes that are probably misspelled; see [`misspelled`].
    pub fn misspelled(&self) -> Vec<String> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for sample in &self.samples {
            *counts.entry(&sample.class).or_default() += 1;
        }
        misspelled(&counts)
    }

    /// The classes of the samples, in order.
    pub fn classes(&self) -> BTreeSet<&str> {
        self.samples.iter().map(|s| s.class.as_str()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clips() -> BTreeMap<String, ClipLength> {
        BTreeMap::from([(
            "a".to_owned(),
            ClipLength {
                frames: 300,
                rate_hz: 120.0,
            },
        )])
    }

    fn resolve(text: &str) -> Resolved {
        Labels::read(text.as_bytes()).unwrap().resolve(&clips())
    }

    #[test]
    fn frames_seconds_and_whole_clips_meet_in_seconds() {
        let frames = resolve("clip\tclass\tstart\tstop\na\tx\t60\t240\n");
        let secs = resolve("clip\tclass\tstart_secs\tstop_secs\na.bvh\tx\t0.5\t2\n");
        let whole = resolve("clip\tclass\na\tx\n");
        assert_eq!(frames.samples[0].span, TimeSpan::new(0.5, 2.0));
        assert_eq!(secs.samples, frames.samples);
        assert_eq!(
            (whole.samples[0].span.stop_secs, whole.samples[0].whole_clip),
            (2.5, true)
        );
        assert!(
            frames.warnings.is_empty() && secs.warnings.is_empty() && whole.warnings.is_empty()
        );
    }

    #[test]
    fn labels_beyond_the_end_are_cut_or_left_out() {
        let resolved = resolve(
            "clip\tclass\tstart\tstop\na\tx\t200\t301\na\tx\t300\t310\nb\tx\t0\t1\nb\tx\t1\t2\n",
        );
        assert_eq!(resolved.samples.len(), 1);
        assert_eq!(resolved.samples[0].span.stop_secs, 2.5);
        let texts: Vec<String> = resolved.warnings.iter().map(|w| w.to_string()).collect();
        assert!(
            texts[0].starts_with("line 2: the label stops at 2.508 s but a ends at 2.500 s"),
            "{}",
            texts[0]
        );
        assert!(
            texts[1].starts_with("line 3") && texts[1].ends_with("left out"),
            "{}",
            texts[1]
        );
        assert_eq!(resolved.absent, BTreeMap::from([("b".to_owned(), 2)]));
    }

    #[test]
    fn overlaps_are_said_once_each_and_neighbours_are_none() {
        let touching = resolve("clip\tclass\tstart\tstop\na\tx\t0\t60\na\ty\t60\t90\n");
        assert!(touching.warnings.is_empty());
        // The long first label overlaps both later ones, which do not overlap each other.
        let inside =
            resolve("clip\tclass\tstart\tstop\na\tx\t0\t200\na\ty\t10\t20\na\tz\t30\t40\n");
        let lines: Vec<Place> = inside.warnings.iter().map(|w| w.at).collect();
        assert_eq!(lines, [Place::Line(3), Place::Line(4)]);
        assert!(inside.warnings[1].text.contains("overlaps x of line 2"));
    }
}
