use proptest::prelude::*;

use super::*;
use crate::Take;
use crate::features::{FeatureParams, rows_of_clip};
use crate::synth::{DatabaseSpec, database};

/// Rows of synthetic people, and where they wave and bow.
fn people() -> (Vec<Rows>, Vec<(usize, &'static str, TimeSpan)>) {
    let spec = DatabaseSpec {
        people: 3,
        repetitions: 4,
        classes: vec!["wave", "bow"],
        ..Default::default()
    };
    let (mut clips, mut labels) = (Vec::new(), Vec::new());
    for (clip, person) in database(7, &spec).into_iter().enumerate() {
        labels.extend(person.labels.iter().map(|l| (clip, l.class, l.span)));
        let take = Take::new(person.clip).unwrap();
        let features = FeatureParams::default();
        clips.push(rows_of_clip(
            &take.clip,
            &take.roles,
            take.rest(),
            take.bones(),
            &features,
        ));
    }
    (clips, labels)
}

fn found(clips: &[Rows], learned: bool) -> Discovery {
    discover(clips, 30.0, &DiscoverParams { learned }, &()).unwrap()
}

#[test]
fn what_people_repeat_is_in_sets_of_its_own() {
    let (clips, labels) = people();
    for learned in [false, true] {
        let found = found(&clips, learned);
        let class_of = |of: &SetInstance| {
            let middle = of.span.middle_secs();
            let holds = |span: &TimeSpan| span.start_secs <= middle && middle < span.stop_secs;
            let label = labels.iter().find(|l| l.0 == of.clip && holds(&l.2));
            label.map(|l| l.1)
        };
        for class in ["wave", "bow"] {
            let of_class = |set: &&RepetitionSet| {
                set.instances
                    .iter()
                    .all(|of| class_of(of).is_none_or(|c| c == class))
                    && set.clips() > 1
            };
            let in_sets: usize = found
                .sets
                .iter()
                .filter(of_class)
                .map(|s| s.instances.len())
                .sum();
            assert!(in_sets >= 9, "{in_sets} of {class}: {found:?}");
        }
        let explained: Vec<f64> = found.sets.iter().map(|set| set.explained_secs).collect();
        assert!(explained.is_sorted_by(|a, b| a >= b), "{explained:?}");
        assert!(found.share_in_sets() > 0.5 && found.share_in_sets() <= 1.0);
        let mut spans: Vec<(usize, TimeSpan)> = found
            .alone
            .iter()
            .map(|alone| (alone.clip, alone.span))
            .collect();
        spans.extend(
            found
                .sets
                .iter()
                .flat_map(|s| &s.instances)
                .map(|i| (i.clip, i.span)),
        );
        spans.sort_by(|a, b| {
            a.0.cmp(&b.0)
                .then(a.1.start_secs.total_cmp(&b.1.start_secs))
        });
        let apart = |pair: &[(usize, TimeSpan)]| {
            pair[0].0 < pair[1].0 || pair[0].1.stop_secs <= pair[1].1.start_secs + 1.01 / 30.0
        };
        assert!(spans.windows(2).all(apart), "nothing lies in two sets");
    }
}

#[test]
fn the_same_clips_give_the_same_sets_on_any_number_of_threads() {
    let (clips, _) = people();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| found(&clips, true))
    };
    let expected = found(&clips, true);
    assert_eq!(on(1), expected);
    assert_eq!(on(5), expected);
}

#[test]
fn nothing_in_it_is_no_set_and_wrong_rows_are_named() {
    assert_eq!(found(&[], true), Discovery::default());
    let dim = RowLayout::BODY.dim();
    let still = Rows::from_values(dim, vec![0.5; 300 * dim]);
    for clips in [
        vec![still.clone(); 2],
        vec![Rows::new(dim); 2],
        vec![still.slice(0..1)],
    ] {
        assert!(found(&clips, true).sets.is_empty());
    }
    let error =
        |clips: &[Rows], hz| discover(clips, hz, &DiscoverParams::default(), &()).unwrap_err();
    let mut wrong = vec![0.5; 20 * dim];
    wrong[7 * dim + 3] = f32::NAN;
    let clips = [still.clone(), Rows::from_values(dim, wrong)];
    assert_eq!(
        error(&clips, 30.0),
        DiscoverError::NotFinite { clip: 1, row: 7 }
    );
    let found = dim - 6;
    let other = [still.clone(), Rows::new(found)];
    assert_eq!(
        error(&other, 30.0),
        DiscoverError::Width {
            expected: dim,
            found
        }
    );
    assert_eq!(error(&[Rows::new(5)], 30.0), DiscoverError::Layout(5));
    assert_eq!(error(&[Rows::new(4)], 30.0), DiscoverError::NoBones);
    assert_eq!(error(&[still], 0.0), DiscoverError::Rate(0.0));
}

#[test]
fn who_cancels_gets_no_sets() {
    struct Never;
    impl Progress for Never {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let (clips, _) = people();
    let answer = discover(&clips, 30.0, &DiscoverParams::default(), &Never);
    assert_eq!(answer.unwrap_err(), DiscoverError::Cancelled);
}

#[test]
fn repetitions_that_follow_each_other_are_a_run() {
    let instance = |clip, start, stop| SetInstance {
        clip,
        span: TimeSpan::new(start, stop),
        distance: start,
    };
    let set = RepetitionSet {
        instances: vec![
            instance(0, 0.0, 1.0),
            instance(0, 1.3, 2.3),
            instance(0, 2.7, 3.7),
            instance(1, 3.8, 4.8),
        ],
        explained_secs: 3.0,
    };
    let runs: Vec<_> = set
        .runs()
        .iter()
        .map(|r| (r.clip, r.span.start_secs, r.span.stop_secs))
        .collect();
    assert_eq!(runs, [(0, 0.0, 2.3), (0, 2.7, 3.7), (1, 3.8, 4.8)]);
    let found = Discovery {
        sets: vec![set],
        ..Discovery::default()
    };
    assert_eq!(found.cuts_of(0, 3.7), [1.0, 1.3, 2.3, 2.7]);
}

/// Candidates on a line of time, each with a number for a shape.
fn line(spans: &[(usize, usize, f64)]) -> (Vec<MovingStretch>, Vec<Rows>) {
    let mut stretches: Vec<MovingStretch> = spans
        .iter()
        .map(|&(start, ticks, moving_secs)| MovingStretch {
            clip: start % 2,
            start,
            stop: start + ticks,
            moving_secs,
        })
        .collect();
    stretches.sort_by_key(|s| (s.clip, s.start, s.stop));
    let wave = |clip: usize| {
        let values = (0..80).flat_map(|t| {
            let phase = 0.35 * (t + 3 * clip) as f32;
            [phase.sin(), (0.5 * phase).cos()]
        });
        Rows::from_values(2, values.collect())
    };
    (stretches, vec![wave(0), wave(1)])
}

/// The best set, all gains counted anew each time; the first of the best.
fn plain_cover(stretches: &[MovingStretch], shapes: &ShapeTable, theta: f64) -> Vec<Vec<usize>> {
    let mut free = vec![true; stretches.len()];
    let mut sets = Vec::new();
    loop {
        let mut best: (f64, Vec<usize>) = (0.0, Vec::new());
        for of in (0..stretches.len()).filter(|&i| free[i]) {
            let gain = |other: usize| {
                if other == of || !free[other] || stretches[of].overlaps(&stretches[other]) {
                    return None;
                }
                if !stretches[of].as_long(&stretches[other], 2.0) {
                    return None;
                }
                let by_length = |i: usize| (stretches[i].ticks(), i);
                let (a, b) = match by_length(of) <= by_length(other) {
                    true => (of, other),
                    false => (other, of),
                };
                shapes.linear(a, b, 2.0 * theta as f32)?;
                let r = f64::from(shapes.elastic(a, b, theta as f32)?);
                let least = stretches[of].moving_secs.min(stretches[other].moving_secs);
                Some((other, least * (1.0 - (r / theta).powi(2))))
            };
            let mut gains: Vec<_> = (0..stretches.len()).filter_map(gain).collect();
            gains.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            let (mut sum, mut members) = (0.0, vec![of]);
            for (other, gain) in gains {
                if gain > 0.0
                    && members
                        .iter()
                        .all(|&m| !stretches[m].overlaps(&stretches[other]))
                {
                    members.push(other);
                    sum += gain;
                }
            }
            if sum > best.0 && members.len() > 1 {
                best = (sum, members);
            }
        }
        if best.0 < 0.3 {
            return sets;
        }
        for &member in &best.1 {
            let of = stretches[member];
            for (other, free) in stretches.iter().zip(&mut free) {
                let start = other.start.max(of.start);
                let shared = other.stop.min(of.stop).saturating_sub(start) as f64;
                let shorter = other.ticks().min(of.ticks()) as f64;
                if other.clip == of.clip && shared > (0.15 * shorter).max(2.0) {
                    *free = false;
                }
            }
        }
        sets.push(best.1);
    }
}

proptest! {
    #[test]
    fn sets_are_those_of_counting_all_gains_each_time(
        spans in prop::collection::vec((0usize..60, 4usize..18, 0.2f64..2.0), 2..24),
    ) {
        let (stretches, rows) = line(&spans);
        let shapes = ShapeTable::of(&rows, &stretches);
        let theta = 0.55f64;
        let neighbours = Neighbours::of(&stretches, &shapes, theta as f32, &()).unwrap();
        let theta = f64::from(theta as f32);
        // Equal candidates have equal gains, of which rounding chooses one: only the numbers are the same then.
        let found = cover::cover(&stretches, &neighbours, theta);
        let expected = plain_cover(&stretches, &shapes, theta);
        prop_assert_eq!(found, expected);
    }
}
