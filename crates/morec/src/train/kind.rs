//! Whether a class is a gesture or goes on, by its labels.

use std::ops::Range;

/// A class whose longest sample lasts this many seconds goes on. Gestures with a pause or with repetitions, which templates recognise better,
/// last up to five.
const LONG_SECS: f64 = 6.0;
/// One whose samples follow others [without a break](ClassLabels) does from this length on.
const UNBROKEN_SECS: f64 = 3.0;
/// Labels this near to each other, in seconds, follow each other.
const BREAK_SECS: f64 = 0.25;

/// How a class is recognised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClassKind {
    /// By templates of its samples: it has a beginning and an end.
    Gesture,
    /// By what a window of a few seconds shows: it goes on.
    Activity,
}

/// What the labels of a class say of its kind. Around a gesture there is other motion, unlabelled; where a label begins as another
/// ends, people have divided what goes on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ClassLabels {
    /// Duration of the longest.
    pub longest_secs: f64,
    labels: usize,
    unbroken: usize,
}

impl ClassLabels {
    /// Takes a label of the class, in seconds of a clip of this duration with these labels.
    pub fn add(
        &mut self,
        label: &Range<f64>,
        mut all: impl Iterator<Item = Range<f64>>,
        clip_secs: f64,
    ) {
        self.longest_secs = self.longest_secs.max(label.end - label.start);
        self.labels += 1;
        let near = |a: f64, b: f64| (a - b).abs() <= BREAK_SECS;
        let [mut before, mut after] = [false; 2];
        while let Some(other) = all.next().filter(|_| !(before && after)) {
            before |= near(other.end, label.start);
            after |= near(other.start, label.end);
        }
        let begins = before || near(label.start, 0.0);
        let ends = after || near(label.end, clip_secs);
        self.unbroken += usize::from(begins && ends && (before || after));
    }

    /// Why it is of that [kind](Self::kind), in words.
    pub fn reason(&self) -> String {
        match self.kind() {
            ClassKind::Activity if self.longest_secs < LONG_SECS => {
                "its labels follow others without a break".to_owned()
            }
            _ => format!("its longest label lasts {:.1} s", self.longest_secs),
        }
    }

    /// The kind of such a class.
    pub fn kind(&self) -> ClassKind {
        let follows_others = 2 * self.unbroken > self.labels;
        let goes_on =
            self.longest_secs >= LONG_SECS || follows_others && self.longest_secs >= UNBROKEN_SECS;
        match goes_on {
            true => ClassKind::Activity,
            false => ClassKind::Gesture,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(labels: &[Range<f64>], of_class: &[usize]) -> ClassKind {
        let mut class = ClassLabels::default();
        for &at in of_class {
            class.add(&labels[at], labels.iter().cloned(), 20.0);
        }
        class.kind()
    }

    #[test]
    fn what_is_divided_without_a_break_goes_on_and_what_stands_alone_does_not() {
        let labels = [0.1..4.0, 4.1..8.0, 8.0..9.5, 12.0..16.0, 16.5..20.0];
        assert_eq!(kind(&labels, &[0]), ClassKind::Activity);
        assert_eq!(kind(&labels, &[1]), ClassKind::Activity);
        assert_eq!(kind(&labels, &[2]), ClassKind::Gesture, "it is short");
        assert_eq!(kind(&labels, &[3]), ClassKind::Gesture);
        assert_eq!(kind(&labels, &[4]), ClassKind::Gesture);
        assert_eq!(
            kind(&labels, &[1, 3]),
            ClassKind::Gesture,
            "not most of them"
        );
        // A clip that is one sample says nothing.
        assert_eq!(kind(&[0.0..20.0], &[0]), ClassKind::Activity, "it is long");
        let mut whole = ClassLabels::default();
        whole.add(&(0.0..5.0), std::iter::once(0.0..5.0), 5.0);
        assert_eq!(whole.kind(), ClassKind::Gesture);
    }
}
