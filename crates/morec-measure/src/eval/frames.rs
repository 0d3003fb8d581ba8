//! Measures of time: the share with the right class, and the agreement of the order of classes. They suit activities.

use serde::Serialize;

use super::EvaluatedStream;

/// Time and order of what was found in known streams.
///
/// A labelled moment is right if one of the classes labelled there is found there; a moment without a label if nothing is found there.
/// Frame by frame that is the frame accuracy of action segmentation; here it is of the time itself, without a frame's length.
///
/// The edit score is one minus the Levenshtein distance between the classes of a stream's samples and of its detections, each in order of
/// start, over the longer of both; over all streams, the sum of distances over the sum of lengths (Lea et al., *Temporal Convolutional
/// Networks for Action Segmentation and Detection*, 2017, §4.1, who take the mean over streams). It does not ask when, and falls where one
/// performance is several detections.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct FrameScore {
    /// Seconds that are right, of all.
    pub right_secs: f64,
    /// Seconds that are labelled.
    pub labelled_secs: f64,
    /// Seconds that are right, of those that are labelled.
    pub labelled_right_secs: f64,
    /// Share of the time that is right.
    pub frame_accuracy: Option<f64>,
    /// The same of labelled time.
    pub labelled_accuracy: Option<f64>,
    /// Edit score; nothing if nothing is labelled or found.
    pub edit_score: Option<f64>,
}

impl FrameScore {
    /// O((samples + detections)²) within each stream.
    pub(super) fn count(known: &[EvaluatedStream<'_>]) -> Self {
        let mut all = Self::default();
        let (mut secs, mut edits, mut length) = (0.0, 0, 0);
        for stream in known {
            secs += stream.info.duration_secs;
            all.add_time(stream);
            let truths: Vec<&str> = stream.truths.iter().map(|t| t.class.as_str()).collect();
            let founds: Vec<&str> = stream.founds.iter().map(|f| f.class.as_str()).collect();
            edits += edit_distance(&truths, &founds);
            length += truths.len().max(founds.len());
        }
        let share = |part: f64, whole: f64| (whole > 0.0).then(|| part / whole);
        all.frame_accuracy = share(all.right_secs, secs);
        all.labelled_accuracy = share(all.labelled_right_secs, all.labelled_secs);
        all.edit_score = share(edits as f64, length as f64).map(|wrong| 1.0 - wrong);
        all
    }

    fn add_time(&mut self, stream: &EvaluatedStream<'_>) {
        let duration_secs = stream.info.duration_secs;
        let truths = stream.truths.iter().map(|t| t.span);
        let founds = stream.founds.iter().map(|f| f.span);
        let ends = truths
            .chain(founds)
            .flat_map(|span| [span.start_secs, span.stop_secs]);
        let ends = ends.map(|secs| secs.clamp(0.0, duration_secs));
        let mut ends: Vec<f64> = ends.chain([0.0, duration_secs]).collect();
        ends.sort_by(f64::total_cmp);
        for pair in ends.windows(2) {
            let secs = pair[1] - pair[0];
            let middle = 0.5 * (pair[0] + pair[1]);
            let labelled = stream.truths.iter().filter(|t| t.span.contains(middle));
            let mut founds = stream.founds.iter().filter(|f| f.span.contains(middle));
            let is_labelled = labelled.clone().next().is_some();
            let is_right = match is_labelled {
                true => founds.any(|f| labelled.clone().any(|t| t.class == f.class)),
                false => founds.next().is_none(),
            };
            let right_secs = if is_right { secs } else { 0.0 };
            self.right_secs += right_secs;
            if is_labelled {
                self.labelled_secs += secs;
                self.labelled_right_secs += right_secs;
            }
        }
    }
}

/// Insertions, deletions and replacements that make `a` of `b`. O(a · b).
pub(super) fn edit_distance(a: &[&str], b: &[&str]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, class) in a.iter().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(class != other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
