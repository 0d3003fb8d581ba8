//! Folds of a cross-validation: the samples that train and the clips that are tested.

use std::collections::{BTreeMap, BTreeSet};

use morec::labels::Sample;
use morec::rng::Rng;

/// Unit that is left out of training in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FoldBy {
    /// Half of each class's samples, rounded down, chosen by a seeded shuffle; all clips are tested once.
    Half {
        /// Of the shuffle.
        seed: u64,
    },
    /// One clip after the other.
    Clip,
    /// One person after the other; a clip without a person counts as one.
    Person,
    /// Nothing is left out: each person teaches alone and is tested in other clips, see
    /// [`CrossvalData::tests`](super::CrossvalData::tests).
    Own,
}

/// One round of training and testing.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// Name of the part that is left out: `half`, a clip or a person.
    pub name: String,
    /// Samples that teach, as places in the list of samples.
    pub taught: Vec<usize>,
    /// Samples of clips in training that must be used for nothing.
    pub held_back: Vec<usize>,
    /// Clips that must not train, and (those with samples) are tested.
    pub left_out: BTreeSet<String>,
    /// Clips that are tested, all of them with samples.
    pub tested: BTreeSet<String>,
}

/// The folds for `samples`, whose clips' people are in `people`.
pub fn folds(by: FoldBy, samples: &[Sample], people: &BTreeMap<String, String>) -> Vec<Fold> {
    match by {
        FoldBy::Half { seed } => vec![half(samples, seed)],
        FoldBy::Clip => leave_out(samples, people.keys(), |clip| clip.to_owned()),
        FoldBy::Person => leave_out(samples, people.keys(), |clip| {
            people.get(clip).map_or(clip, |p| p).to_owned()
        }),
        FoldBy::Own => own(samples, people),
    }
}

/// Each person's own samples, without the clips of all others.
fn own(samples: &[Sample], people: &BTreeMap<String, String>) -> Vec<Fold> {
    let person_of = |clip: &str| people.get(clip).map_or(clip, |p| p).to_owned();
    let persons: BTreeSet<String> = samples.iter().map(|s| person_of(&s.clip)).collect();
    let fold = |person: String| {
        let of_person = |clip: &str| person_of(clip) == person;
        let taught = (0..samples.len()).filter(|&i| of_person(&samples[i].clip));
        // A clip without a person is background in every fold.
        let others = people
            .iter()
            .filter(|(clip, of)| **of != person && clip != of);
        let others = others.map(|(clip, _)| clip.clone());
        Fold {
            taught: taught.collect(),
            held_back: Vec::new(),
            left_out: others.collect(),
            tested: samples
                .iter()
                .filter(|s| of_person(&s.clip))
                .map(|s| s.clip.clone())
                .collect(),
            name: person.clone(),
        }
    };
    persons.into_iter().map(fold).collect()
}

/// What teaches in a fold at most; by default all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TaughtLimit {
    /// Samples of a class, from its people in turn.
    pub samples_per_class: Option<usize>,
    /// People (clips, of people who are not known).
    pub people: Option<usize>,
    /// Which samples and people: 0 the first, other numbers draw them.
    pub draw: u64,
}

/// The taught samples that `limit` leaves, from the groups of `group_of` in turn.
pub fn thin(
    taught: &[usize],
    samples: &[Sample],
    limit: TaughtLimit,
    group_of: impl Fn(&Sample) -> String,
) -> Vec<usize> {
    let mut taught = taught.to_vec();
    let mut groups: Vec<String> = taught.iter().map(|&i| group_of(&samples[i])).collect();
    groups.sort_unstable();
    groups.dedup();
    if limit.draw > 0 {
        let mut rng = Rng::new(limit.draw);
        rng.shuffle(&mut taught);
        rng.shuffle(&mut groups);
    }
    let place: BTreeMap<&str, usize> = (groups.iter().enumerate())
        .take(limit.people.unwrap_or(usize::MAX))
        .map(|(place, group)| (group.as_str(), place))
        .collect();
    let mut turns: BTreeMap<(&str, usize), usize> = BTreeMap::new();
    let mut order: Vec<(&str, usize, usize, usize)> = Vec::new();
    for i in taught {
        let class = samples[i].class.as_str();
        let Some(&group) = place.get(group_of(&samples[i]).as_str()) else {
            continue;
        };
        let turn = turns.entry((class, group)).or_insert(0);
        *turn += 1;
        order.push((class, *turn, group, i));
    }
    order.sort_unstable();
    let most = limit.samples_per_class.unwrap_or(usize::MAX);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut kept: Vec<usize> = order
        .into_iter()
        .filter(|(class, ..)| {
            let count = counts.entry(class).or_insert(0);
            *count += 1;
            *count <= most
        })
        .map(|(.., i)| i)
        .collect();
    kept.sort_unstable();
    kept
}

fn half(samples: &[Sample], seed: u64) -> Fold {
    let mut by_class: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, sample) in samples.iter().enumerate() {
        by_class.entry(&sample.class).or_default().push(i);
    }
    let (mut taught, mut held_back) = (Vec::new(), Vec::new());
    for (number, of_class) in by_class.values_mut().enumerate() {
        Rng::for_part(seed, number as u64).shuffle(of_class);
        let (first, second) = of_class.split_at(of_class.len().div_ceil(2));
        taught.extend_from_slice(first);
        held_back.extend_from_slice(second);
    }
    taught.sort_unstable();
    held_back.sort_unstable();
    let tested = samples.iter().map(|s| s.clip.clone()).collect();
    Fold {
        name: format!("half {seed}"),
        taught,
        held_back,
        left_out: BTreeSet::new(),
        tested,
    }
}

fn leave_out<'p>(
    samples: &'p [Sample],
    other_clips: impl Iterator<Item = &'p String>,
    group_of: impl Fn(&str) -> String,
) -> Vec<Fold> {
    let groups: BTreeSet<String> = samples.iter().map(|s| group_of(&s.clip)).collect();
    let clips: BTreeSet<&str> = samples
        .iter()
        .map(|s| s.clip.as_str())
        .chain(other_clips.map(String::as_str))
        .collect();
    let fold = |group: String| {
        let inside = |clip: &str| group_of(clip) == group;
        Fold {
            taught: (0..samples.len())
                .filter(|&i| !inside(&samples[i].clip))
                .collect(),
            held_back: Vec::new(),
            left_out: clips
                .iter()
                .filter(|c| inside(c))
                .map(|c| (*c).to_owned())
                .collect(),
            tested: samples
                .iter()
                .filter(|s| inside(&s.clip))
                .map(|s| s.clip.clone())
                .collect(),
            name: group,
        }
    };
    groups.into_iter().map(fold).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(clip: &str, class: &str, person: &str) -> Sample {
        Sample {
            clip: clip.into(),
            class: class.into(),
            span: morec::TimeSpan::new(0.0, 1.0),
            whole_clip: false,
            person: Some(person.into()),
            line: 1,
        }
    }

    fn samples() -> Vec<Sample> {
        let rows = [
            ("1", "a", "x"),
            ("1", "b", "x"),
            ("2", "a", "x"),
            ("2", "a", "x"),
            ("3", "a", "y"),
            ("3", "a", "y"),
        ];
        rows.iter().map(|(c, k, p)| sample(c, k, p)).collect()
    }

    fn people() -> BTreeMap<String, String> {
        [("1", "x"), ("2", "x"), ("3", "y"), ("4", "y")]
            .map(|(c, p)| (c.to_owned(), p.to_owned()))
            .into()
    }

    #[test]
    fn half_rounds_up_and_gives_every_sample_one_place() {
        let fold = &folds(FoldBy::Half { seed: 3 }, &samples(), &people())[0];
        assert_eq!((fold.taught.len(), fold.held_back.len()), (4, 2));
        assert!(fold.taught.contains(&1), "the only sample of b must teach");
        assert!(fold.taught.iter().all(|t| !fold.held_back.contains(t)));
        assert_eq!(fold.tested.len(), 3);
        let taught = |seed| {
            folds(FoldBy::Half { seed }, &samples(), &people())[0]
                .taught
                .clone()
        };
        assert_eq!(taught(3), fold.taught);
        assert!(
            (0..20).any(|seed| taught(seed) != fold.taught),
            "the seed must matter"
        );
    }
    #[test]
    fn every_half_comes_up_with_some_seed() {
        let taught = |seed| {
            folds(FoldBy::Half { seed }, &samples(), &people())
                .remove(0)
                .taught
        };
        let halves: BTreeSet<Vec<usize>> = (0..100).map(taught).collect();
        assert_eq!(
            halves.len(),
            10,
            "three of the five samples of a, in as many ways: {halves:?}"
        );
    }

    #[test]
    fn a_person_left_out_takes_all_their_clips_along() {
        let all = folds(FoldBy::Person, &samples(), &people());
        assert_eq!(all.len(), 2);
        assert_eq!(all[1].name, "y");
        assert_eq!(all[1].taught, [0, 1, 2, 3]);
        assert!(
            all[1].left_out.contains("4"),
            "their clip without samples must not train either"
        );
        assert_eq!(all[1].tested.iter().collect::<Vec<_>>(), ["3"]);
    }

    #[test]
    fn alone_means_without_the_clips_of_others() {
        let all = folds(FoldBy::Own, &samples(), &people());
        assert_eq!(all.len(), 2);
        assert_eq!((all[0].name.as_str(), all[0].taught.len()), ("x", 4));
        assert!(all[0].left_out.contains("3") && all[0].left_out.contains("4"));
        assert_eq!(all[1].taught, [4, 5]);
    }

    #[test]
    fn thinning_takes_from_people_in_turn() {
        let all: Vec<usize> = (0..6).collect();
        let person = |s: &Sample| people()[&s.clip].clone();
        let most = |n| TaughtLimit {
            samples_per_class: Some(n),
            ..TaughtLimit::default()
        };
        assert_eq!(thin(&all, &samples(), most(1), person), [0, 1]);
        assert_eq!(thin(&all, &samples(), most(2), person), [0, 1, 4]);
        assert_eq!(thin(&all, &samples(), most(9), person), all);
    }

    #[test]
    fn thinning_takes_few_people_and_draws() {
        let all: Vec<usize> = (0..6).collect();
        let person = |s: &Sample| people()[&s.clip].clone();
        let drawn = |people, draw| {
            let limit = TaughtLimit {
                people: Some(people),
                draw,
                ..TaughtLimit::default()
            };
            thin(&all, &samples(), limit, person)
        };
        assert_eq!(drawn(9, 7), all);
        assert_eq!(drawn(1, 7), drawn(1, 7));
        let ones: BTreeSet<Vec<usize>> = (0..20).map(|draw| drawn(1, draw)).collect();
        let named: BTreeSet<String> = people().into_values().collect();
        assert_eq!(ones.len(), named.len(), "{ones:?}");
    }

    #[test]
    fn every_clip_with_samples_is_left_out_once() {
        let names: Vec<String> = folds(FoldBy::Clip, &samples(), &people())
            .into_iter()
            .map(|f| f.name)
            .collect();
        assert_eq!(names, ["1", "2", "3"]);
    }
}
