//! Decides by its labels whether a class is a gesture or an activity.

use std::collections::BTreeMap;
use std::ops::Range;

/// A class whose longest sample lasts this many seconds goes on. Gestures with a pause or with repetitions, which templates recognise better,
/// last up to five.
const LONG_SECS: f64 = 6.0;
/// One whose samples follow others [without a break](ClassLabels) does from this length on.
const UNBROKEN_SECS: f64 = 3.0;
/// A label longer than this many times the median of its class does not decide.
const OUTLIER: f64 = 3.0;
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
    /// Duration of the longest but for outliers.
    pub longest_secs: f64,
    /// Duration of the longest outlier: three times as long as the median of the class, and longer.
    pub outlier_secs: Option<f64>,
    labels: usize,
    unbroken: usize,
}

impl ClassLabels {
    /// Of each class of the labels of clips: a clip's duration, and its labels, all in seconds. O(labels · log labels).
    pub fn of_clips<K: Ord + Clone>(
        clips: impl IntoIterator<Item = (f64, Vec<(K, Range<f64>)>)>,
    ) -> BTreeMap<K, Self> {
        let mut classes: BTreeMap<K, Self> = BTreeMap::new();
        let mut secs: BTreeMap<K, Vec<f64>> = BTreeMap::new();
        for (clip_secs, labels) in clips {
            let sorted = |of: fn(&Range<f64>) -> f64| {
                let mut secs: Vec<f64> = labels.iter().map(|(_, label)| of(label)).collect();
                secs.sort_by(f64::total_cmp);
                secs
            };
            let (starts, ends) = (sorted(|label| label.start), sorted(|label| label.end));
            for (class, label) in &labels {
                let before = has_near(&ends, label.start);
                let after = has_near(&starts, label.end);
                let begins = before || has_near(&[0.0], label.start);
                let stops = after || has_near(&[clip_secs], label.end);
                let of_class = classes.entry(class.clone()).or_default();
                let durations = secs.entry(class.clone()).or_default();
                durations.push(label.end - label.start);
                of_class.labels += 1;
                of_class.unbroken += usize::from(begins && stops && (before || after));
            }
        }
        for (of_class, mut secs) in classes.values_mut().zip(secs.into_values()) {
            secs.sort_by(f64::total_cmp);
            let most = OUTLIER * secs[secs.len() / 2];
            let usual = secs.partition_point(|secs| *secs <= most);
            of_class.longest_secs = secs[..usual].last().copied().unwrap_or(0.0);
            of_class.outlier_secs = secs[usual..].last().copied();
        }
        classes
    }

    /// Why it is of that [kind](Self::kind), in words.
    pub fn reason(&self) -> String {
        match self.kind() {
            ClassKind::Activity if self.longest_secs < LONG_SECS => {
                "its labels follow other labels without a gap".to_owned()
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

/// True if one of these times, which increase, is [near](BREAK_SECS) to `secs`.
fn has_near(times: &[f64], secs: f64) -> bool {
    let at = times.partition_point(|time| *time < secs - BREAK_SECS);
    times.get(at).is_some_and(|time| *time <= secs + BREAK_SECS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(labels: &[Range<f64>], of_class: &[usize]) -> ClassKind {
        let labels = labels.iter().cloned().enumerate();
        let named = labels.map(|(at, label)| (of_class.contains(&at), label));
        ClassLabels::of_clips([(20.0, named.collect())])[&true].kind()
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
        // One long label among short ones does not decide; of two, neither is usual.
        let mut push: Vec<Range<f64>> = (0..5)
            .map(|k| 3.0 * f64::from(k)..3.0 * f64::from(k) + 1.6)
            .collect();
        push.push(20.0..56.0);
        let labels =
            ClassLabels::of_clips([(60.0, push.into_iter().map(|label| ((), label)).collect())]);
        assert_eq!(
            (labels[&()].kind(), labels[&()].outlier_secs),
            (ClassKind::Gesture, Some(36.0))
        );
        // A clip that is one sample says nothing.
        assert_eq!(kind(&[0.0..20.0], &[0]), ClassKind::Activity, "it is long");
        let whole = ClassLabels::of_clips([(5.0, vec![((), 0.0..5.0)])]);
        assert_eq!(whole[&()].kind(), ClassKind::Gesture);
    }
}
