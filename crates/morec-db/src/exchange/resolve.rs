//! Turns annotations into samples of clips in the database: finds the clips, cuts labels at the ends of clips, and reports
//! what is left out.

use std::collections::BTreeMap;
use std::path::Path;

use morec::labels::{ClipLength, doubtful_unit, names_of_clip};

use super::annotation::BIDS_SUFFIX;
use super::annotation::{Annotation, ClipLengths, snap};
use super::clip_of_file_name;
use crate::labels::NewSample;
use crate::{ClipId, ClipInfo};

/// Labels run over the end of their clip by so much without a note, seconds: they were drawn by hand.
const OVER_SECS: f64 = 0.1;

/// Annotations as samples, and annotations that cannot become samples.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResolvedLabels {
    /// In the order of the annotations.
    pub samples: Vec<NewSample>,
    /// Who says each of them.
    pub annotators: Vec<Option<String>>,
    /// Clips that are not there, with the number of labels of each.
    pub absent: BTreeMap<String, usize>,
    /// Who is in clips of which that was not known.
    pub people: BTreeMap<ClipId, String>,
    /// Number of labels that were cut or left out at the end of their clips.
    pub beyond: usize,
    /// Number of those that were left out.
    pub left_out: usize,
    /// Labels that lie behind the end of their clip, wholly or in part, and people who are not those that are known, in
    /// sentences.
    pub notes: Vec<String>,
}

impl ResolvedLabels {
    /// Reason why the times are probably not in the unit that the file says; see [`doubtful_unit`].
    pub fn doubtful_unit(&self) -> Option<String> {
        let parts = self.samples.iter().filter(|s| !s.whole_clip);
        let secs = parts.map(|s| s.stop_secs - s.start_secs);
        doubtful_unit(secs, self.beyond, self.left_out)
    }

    /// Notes who is in a clip, as a file says.
    fn add_person(&mut self, clip: &ClipInfo, person: &str) {
        let known = clip.subject.as_deref();
        if known.is_some_and(|known| known != person) {
            let known = known.unwrap_or_default();
            self.differ(&clip.name, known, person);
        } else if known.is_none() {
            match self.people.insert(clip.id, person.to_owned()) {
                Some(before) if before != person => {
                    self.differ(&clip.name, &before, person);
                    self.people.insert(clip.id, before);
                }
                _ => {}
            }
        }
    }

    fn differ(&mut self, clip: &str, kept: &str, person: &str) {
        let note = format!("{clip} is by {kept}; the label's person {person} is ignored");
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}

/// Lengths of clips by name.
pub fn clip_lengths(clips: &[ClipInfo]) -> ClipLengths {
    let length = |clip: &ClipInfo| ClipLength {
        frames: clip.frames,
        rate_hz: clip.rate_hz,
    };
    clips.iter().map(|c| (c.name.clone(), length(c))).collect()
}

/// The clip that a file is called after, if there is such a clip.
pub fn clip_of_file(path: &Path, lengths: &ClipLengths) -> Option<String> {
    let clip = clip_of_file_name(&path.file_stem()?.to_string_lossy());
    let recording = clip.strip_suffix(BIDS_SUFFIX).map(str::to_owned);
    let named = [Some(clip), recording].into_iter().flatten();
    named.into_iter().find(|clip| lengths.contains_key(clip))
}

/// Finds the clips of annotations by name, with or without a file ending or the folders before it; times come to whole frames, a label that runs over the end
/// of its clip is cut there, and one that lies behind it is left out.
pub fn resolve(annotations: Vec<Annotation>, clips: &[ClipInfo]) -> ResolvedLabels {
    let by_name: BTreeMap<&str, &ClipInfo> = clips.iter().map(|c| (c.name.as_str(), c)).collect();
    let mut resolved = ResolvedLabels::default();
    for a in annotations {
        let found = names_of_clip(&a.clip).find_map(|name| by_name.get(name));
        let Some(clip) = found else {
            *resolved.absent.entry(a.clip).or_default() += 1;
            continue;
        };
        if let Some(person) = &a.person {
            resolved.add_person(clip, person);
        }
        let noted = resolved.notes.len();
        let extent = extent(&a, clip, &mut resolved.notes);
        resolved.beyond += resolved.notes.len() - noted;
        let Some((start_secs, stop_secs)) = extent else {
            resolved.left_out += 1;
            continue;
        };
        resolved.annotators.push(a.annotator);
        resolved.samples.push(NewSample {
            clip: clip.id,
            class: a.class,
            start_secs,
            stop_secs,
            whole_clip: a.extent.is_none(),
            state: a.state,
            score: a.score,
        });
    }
    resolved
}

/// Start and stop within the clip, seconds; `None` behind its end.
fn extent(a: &Annotation, clip: &ClipInfo, notes: &mut Vec<String>) -> Option<(f64, f64)> {
    let end = clip.duration_secs();
    let Some((start, stop)) = a.extent else {
        return Some((0.0, end));
    };
    let snap = |secs: f64| snap(secs, clip.rate_hz);
    let mut note = |what: &str| {
        notes.push(format!(
            "{} ends at {end:.2} s: {} from {start:.2} to {stop:.2} s {what}",
            clip.name, a.class
        ));
    };
    if snap(start) >= end {
        note("left out");
        return None;
    }
    if stop > end + OVER_SECS {
        note("cut there");
    }
    Some((snap(start), snap(stop).min(end)))
}
