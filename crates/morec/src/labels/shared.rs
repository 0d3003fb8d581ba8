//! Clips that two annotators both labelled.

use std::collections::{BTreeMap, BTreeSet};

use super::ClipLength;
use super::ground_truth::{GroundTruth, StreamInfo};

/// The clips that two annotators both labelled.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedClips {
    /// The clips with their durations, by name.
    pub streams: Vec<StreamInfo>,
    /// Names of the clips that only the first annotator labelled, and of those that only the second did.
    pub alone: [Vec<String>; 2],
}

impl SharedClips {
    /// Of labels that were resolved against `lengths`; labels of other clips are removed from both.
    pub fn of(
        a: &mut Vec<GroundTruth>,
        b: &mut Vec<GroundTruth>,
        lengths: &BTreeMap<String, ClipLength>,
    ) -> Self {
        let clips = |labels: &[GroundTruth]| -> BTreeSet<String> {
            labels.iter().map(|label| label.clip.clone()).collect()
        };
        let (of_a, of_b) = (clips(a), clips(b));
        for labels in [a, b] {
            labels.retain(|label| of_a.contains(&label.clip) && of_b.contains(&label.clip));
        }
        let stream = |clip: &String| {
            Some(StreamInfo {
                duration_secs: lengths.get(clip)?.duration_secs(),
                clip: clip.clone(),
                unknown: false,
            })
        };
        Self {
            streams: of_a.intersection(&of_b).filter_map(stream).collect(),
            alone: [(&of_a, &of_b), (&of_b, &of_a)]
                .map(|(own, other)| own.difference(other).cloned().collect()),
        }
    }
}
