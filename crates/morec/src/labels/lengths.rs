//! Lengths of the samples of each class (thesis, Table 5.1).

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::Sample;

/// How long a class's samples are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassLengths {
    /// Name of the class.
    pub class: String,
    /// Number of its samples.
    pub samples: usize,
    /// People who show it, of those who are known.
    pub people: usize,
    /// Seconds of its shortest sample.
    pub shortest_secs: f64,
    /// Median of its samples' lengths, seconds.
    pub median_secs: f64,
    /// Seconds of its longest sample.
    pub longest_secs: f64,
}

impl Sample {
    /// Its class, its person and its length in seconds, as [`class_lengths`] takes them.
    pub fn length(&self) -> (&str, Option<&str>, f64) {
        let secs = self.span.duration_secs();
        (&self.class, self.person.as_deref(), secs)
    }
}

/// Lengths of the samples of each class, by name; of each sample its class, its person and its length in seconds.
pub fn class_lengths<'s>(
    samples: impl IntoIterator<Item = (&'s str, Option<&'s str>, f64)>,
) -> Vec<ClassLengths> {
    let mut classes: BTreeMap<&str, (Vec<f64>, BTreeSet<&str>)> = BTreeMap::new();
    for (class, person, length) in samples {
        let (secs, people) = classes.entry(class).or_default();
        secs.push(length);
        people.extend(person);
    }
    let lengths = |(class, (mut secs, people)): (&str, (Vec<f64>, BTreeSet<&str>))| {
        secs.sort_by(f64::total_cmp);
        let last = secs.len() - 1;
        ClassLengths {
            class: class.to_owned(),
            samples: secs.len(),
            people: people.len(),
            shortest_secs: secs[0],
            median_secs: 0.5 * (secs[last / 2] + secs[last.div_ceil(2)]),
            longest_secs: secs[last],
        }
    };
    classes.into_iter().map(lengths).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TimeSpan;

    #[test]
    fn each_class_has_its_lengths_and_people() {
        let sample = |class: &str, secs: f64, person: Option<&str>| Sample {
            clip: "c".into(),
            class: class.into(),
            span: TimeSpan::new(1.0, 1.0 + secs),
            whole_clip: false,
            person: person.map(str::to_owned),
            line: 1,
        };
        let samples = [
            sample("wave", 2.0, Some("a")),
            sample("bow", 1.0, None),
            sample("wave", 0.5, Some("b")),
            sample("wave", 1.0, Some("a")),
            sample("bow", 2.0, None),
        ];
        let found = class_lengths(samples.iter().map(Sample::length));
        let figures = |c: &ClassLengths| {
            (
                c.samples,
                c.people,
                c.shortest_secs,
                c.median_secs,
                c.longest_secs,
            )
        };
        assert_eq!(figures(&found[0]), (2, 0, 1.0, 1.5, 2.0));
        assert_eq!(figures(&found[1]), (3, 2, 0.5, 1.0, 2.0));
    }
}
