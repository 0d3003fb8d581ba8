//! How the time of clips is divided among classes: the time budget of behavioural studies.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::{ClipLength, Sample};
use crate::TimeSpan;

/// How much time each class takes, for everyone and for each person, and which class follows which.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeBudget {
    /// Number of clips with labels.
    pub clips: usize,
    /// Their duration together, seconds.
    pub secs: f64,
    /// Seconds of it that no label covers.
    pub unlabelled_secs: f64,
    /// Every class by name, of all people together.
    pub classes: Vec<ClassBudget>,
    /// The same of each person who is named, by name.
    pub people: Vec<PersonBudget>,
    /// Which class follows which.
    pub transitions: ClassTransitions,
}

/// The time that a class takes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassBudget {
    /// Name of the class.
    pub class: String,
    /// Number of its labels.
    pub count: usize,
    /// Seconds that they cover; where labels of the class overlap, once.
    pub total_secs: f64,
    /// Mean duration of a label, seconds.
    pub mean_secs: f64,
    /// `total_secs` as a share of the clips' duration.
    pub share: f64,
    /// Labels a minute of the clips' duration.
    pub per_minute: f64,
}

/// The time of one person.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PersonBudget {
    /// Name of the person.
    pub person: String,
    /// Duration of the clips with a label of this person, seconds.
    pub secs: f64,
    /// Every class of which the person has a label.
    pub classes: Vec<ClassBudget>,
}

/// How often the next label of the same clip and person has which class. Labels follow each other by their starts, whatever lies between.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ClassTransitions {
    /// Names of rows and columns.
    pub classes: Vec<String>,
    /// Row by row the number of times that the class of the column follows that of the row.
    pub counts: Vec<Vec<usize>>,
}

impl TimeBudget {
    /// Of labels that were resolved against `lengths`. Clips without labels do not count. O(n log n).
    pub fn of(samples: &[Sample], lengths: &BTreeMap<String, ClipLength>) -> Self {
        let everybody: Vec<&Sample> = samples.iter().collect();
        let (secs, classes) = budget_of(&everybody, lengths);
        let mut by_person = BTreeMap::<&str, Vec<&Sample>>::new();
        for sample in samples {
            if let Some(person) = &sample.person {
                by_person.entry(person).or_default().push(sample);
            }
        }
        let people = by_person.into_iter().map(|(person, of_person)| {
            let (secs, classes) = budget_of(&of_person, lengths);
            PersonBudget {
                person: person.to_owned(),
                secs,
                classes,
            }
        });
        Self {
            clips: clips_of(&everybody).len(),
            secs,
            unlabelled_secs: (secs - covered_secs(&everybody)).max(0.0),
            people: people.collect(),
            transitions: ClassTransitions::of(samples),
            classes,
        }
    }
}

impl TimeBudget {
    /// A table (TSV): a row for each class of all people, then of each person; a column `next_CLASS` for each class counts the labels of
    /// all people that it follows.
    pub fn tsv(&self) -> String {
        let names = &self.transitions.classes;
        let next: String = names.iter().map(|name| format!("\tnext_{name}")).collect();
        let header = "class\tperson\tlabels\ttotal_secs\tmean_secs\tshare\tper_minute";
        let mut table = format!("{header}{next}\n");
        let mut add = |person: &str, of: &ClassBudget, next: String| {
            let (class, count) = (&of.class, of.count);
            let (total, mean) = (of.total_secs, of.mean_secs);
            let (share, rate) = (of.share, of.per_minute);
            table += &format!(
                "{class}\t{person}\t{count}\t{total:.3}\t{mean:.3}\t{share:.5}\t{rate:.4}{next}\n"
            );
        };
        for class in &self.classes {
            let row = names.iter().position(|name| *name == class.class);
            let counts = row.map_or(&[][..], |row| &self.transitions.counts[row]);
            let counts = counts.iter().map(|count| format!("\t{count}"));
            add("", class, counts.collect());
            for person in &self.people {
                let of_person = person.classes.iter().find(|c| c.class == class.class);
                if let Some(of_person) = of_person {
                    add(&person.person, of_person, "\t".repeat(names.len()));
                }
            }
        }
        table
    }
}

impl ClassTransitions {
    fn of(samples: &[Sample]) -> Self {
        let names: BTreeSet<&str> = samples.iter().map(|s| s.class.as_str()).collect();
        let place: BTreeMap<&str, usize> = names.iter().copied().zip(0..).collect();
        let mut counts = vec![vec![0; names.len()]; names.len()];
        let mut streams = BTreeMap::<(&str, Option<&str>), Vec<&Sample>>::new();
        for sample in samples {
            let stream = (sample.clip.as_str(), sample.person.as_deref());
            streams.entry(stream).or_default().push(sample);
        }
        for stream in streams.values_mut() {
            stream.sort_by(|a, b| by_start(a.span, b.span));
            for pair in stream.windows(2) {
                counts[place[pair[0].class.as_str()]][place[pair[1].class.as_str()]] += 1;
            }
        }
        Self {
            classes: names.into_iter().map(str::to_owned).collect(),
            counts,
        }
    }
}

fn by_start(a: TimeSpan, b: TimeSpan) -> std::cmp::Ordering {
    let starts = a.start_secs.total_cmp(&b.start_secs);
    starts.then(a.stop_secs.total_cmp(&b.stop_secs))
}

fn clips_of<'s>(samples: &[&'s Sample]) -> BTreeSet<&'s str> {
    samples.iter().map(|s| s.clip.as_str()).collect()
}

/// Duration of the clips that have one of `samples`, and the time of each class.
fn budget_of(
    samples: &[&Sample],
    lengths: &BTreeMap<String, ClipLength>,
) -> (f64, Vec<ClassBudget>) {
    let durations = clips_of(samples)
        .into_iter()
        .filter_map(|clip| lengths.get(clip))
        .map(ClipLength::duration_secs);
    let secs: f64 = durations.sum();
    let mut by_class = BTreeMap::<&str, Vec<&Sample>>::new();
    for sample in samples {
        by_class.entry(&sample.class).or_default().push(sample);
    }
    let of_class = |(class, of_class): (&str, Vec<&Sample>)| {
        let (count, total_secs) = (of_class.len(), covered_secs(&of_class));
        let durations = of_class.iter().map(|s| s.span.duration_secs());
        let of_time = |value: f64| if secs > 0.0 { value / secs } else { 0.0 };
        ClassBudget {
            class: class.to_owned(),
            count,
            total_secs,
            mean_secs: durations.sum::<f64>() / count as f64,
            share: of_time(total_secs),
            per_minute: 60.0 * of_time(count as f64),
        }
    };
    (secs, by_class.into_iter().map(of_class).collect())
}

/// Seconds that labels cover, clip by clip, overlaps once.
fn covered_secs(samples: &[&Sample]) -> f64 {
    let mut by_clip = BTreeMap::<&str, Vec<TimeSpan>>::new();
    for sample in samples {
        by_clip.entry(&sample.clip).or_default().push(sample.span);
    }
    let covered = by_clip.into_values().map(|mut spans| {
        spans.sort_by(|a, b| by_start(*a, *b));
        let disjoint = TimeSpan::union(spans).into_iter();
        disjoint.map(|span| span.duration_secs()).sum::<f64>()
    });
    covered.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(clip: &str, class: &str, span: (f64, f64), person: Option<&str>) -> Sample {
        Sample {
            clip: clip.to_owned(),
            class: class.to_owned(),
            span: TimeSpan::new(span.0, span.1),
            whole_clip: false,
            person: person.map(str::to_owned),
            line: 1,
        }
    }

    #[test]
    fn time_is_counted_once_and_people_apart() {
        let length = |secs: usize| ClipLength {
            frames: 10 * secs,
            rate_hz: 10.0,
        };
        let lengths = [("a", 20), ("b", 40), ("empty", 60)];
        let lengths = lengths.map(|(name, secs)| (name.to_owned(), length(secs)));
        let samples = [
            sample("a", "walk", (4.0, 8.0), Some("ann")),
            sample("a", "walk", (6.0, 10.0), Some("ann")),
            sample("a", "wave", (0.0, 2.0), Some("ann")),
            sample("b", "wave", (10.0, 14.0), Some("ben")),
            sample("b", "walk", (30.0, 36.0), None),
        ];
        let budget = TimeBudget::of(&samples, &lengths.into());
        assert_eq!((budget.clips, budget.secs), (2, 60.0));
        assert_eq!(budget.unlabelled_secs, 60.0 - 6.0 - 2.0 - 4.0 - 6.0);
        let walk = &budget.classes[0];
        assert_eq!((walk.count, walk.total_secs), (3, 12.0));
        assert!((walk.mean_secs - 14.0 / 3.0).abs() < 1e-12);
        assert_eq!((walk.share, walk.per_minute), (0.2, 3.0));
        // A person's share is of the clips in which that person is labelled.
        let ann = &budget.people[0];
        assert_eq!((ann.person.as_str(), ann.secs), ("ann", 20.0));
        assert_eq!((ann.classes[0].share, ann.classes[1].share), (0.3, 0.1));
        let table = budget.tsv();
        let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split('\t').collect()).collect();
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{table}");
        assert_eq!(rows[0][7..], ["next_walk", "next_wave"]);
        let walk = [
            "walk", "", "3", "12.000", "4.667", "0.20000", "3.0000", "1", "0",
        ];
        assert_eq!(rows[1], walk);
        assert_eq!(rows[2][..3], ["walk", "ann", "2"]);
        assert_eq!(rows.len(), 1 + 2 + 3);
        // wave, walk, walk by ann; what nobody is named for does not follow ben's.
        assert_eq!(budget.transitions.counts, [[1, 0], [1, 0]]);
    }

    #[test]
    fn no_labels_take_no_time() {
        let budget = TimeBudget::of(&[], &BTreeMap::new());
        assert_eq!((budget.clips, budget.secs), (0, 0.0));
        assert!(budget.classes.is_empty() && budget.transitions.counts.is_empty());
    }
}
