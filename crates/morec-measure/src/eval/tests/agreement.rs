//! Agreement of two annotators, against counts made by hand and against chance itself.

use super::*;

fn of(a: &[GroundTruth], b: &[GroundTruth], secs: f64, unit_secs: f64) -> LabelAgreement {
    LabelAgreement::of(&[stream("a", secs)], a, b, unit_secs).unwrap()
}

#[test]
fn kappa_is_that_of_a_table_counted_by_hand() {
    // Units of 1 s: A says 4 × walk, 2 × jump, 4 × nothing; B says 3 × walk, 3 × jump, 4 × nothing, and both agree in 8.
    let a = [truth("a", "walk", 0.0, 4.0), truth("a", "jump", 6.0, 8.0)];
    let b = [truth("a", "walk", 0.0, 3.0), truth("a", "jump", 6.0, 9.0)];
    let found = of(&a, &b, 10.0, 1.0);
    assert_eq!(found.time.units, 10);
    close(found.time.observed, 0.8);
    // (4·3 + 2·3 + 4·4) / 100.
    close(found.time.chance, 0.34);
    close(found.time.kappa, (0.8 - 0.34) / 0.66);
    assert_eq!(found.confusion.classes, ["jump", "walk"]);
    assert_eq!(found.confusion.units, [[2, 0, 0], [0, 3, 1], [1, 0, 3]]);
    // A label counts from the unit whose middle it begins with, and not in that whose middle it ends with.
    let ends = [truth("a", "walk", 1.5, 3.5)];
    assert_eq!(
        of(&ends, &ends, 10.0, 1.0).confusion.units,
        [[2, 0], [0, 8]]
    );
    // Walk or not: both 3, A alone 1, neither 6.
    let walk = &found.classes[1];
    close(walk.time.observed, 0.9);
    close(walk.time.chance, (4.0 * 3.0 + 6.0 * 7.0) / 100.0);
}

#[test]
fn events_are_paired_by_class_and_their_ends_compared() {
    let a = [
        truth("a", "walk", 0.0, 2.0),
        truth("a", "walk", 3.0, 5.0),
        truth("a", "jump", 8.0, 9.0),
    ];
    let b = [
        truth("a", "walk", 0.2, 2.1),
        truth("a", "jump", 3.0, 5.0),
        truth("a", "jump", 8.1, 9.0),
    ];
    let events = of(&a, &b, 60.0, 0.1).events;
    assert_eq!((events.of_a, events.of_b, events.matched), (3, 3, 2));
    close(events.f1, 2.0 / 3.0);
    close(events.boundaries.start_median_secs, 0.15);
    close(events.stop_p90_secs, 0.09);
    // A minute with three short events hardly agrees by chance.
    assert!(events.chance.unwrap() < 0.1 && events.corrected.unwrap() < 2.0 / 3.0);
}

#[test]
fn annotators_agree_with_themselves_and_random_ones_with_nobody() {
    let mut rng = morec::rng::Rng::new(3);
    let mut random = || {
        let label = |_| {
            let class = ["walk", "jump"][rng.below(2)];
            let start = rng.range(0.0, 1990.0);
            truth("a", class, start, start + rng.range(1.0, 4.0))
        };
        (0..200).map(label).collect::<Vec<_>>()
    };
    let (a, b) = (random(), random());
    let same = of(&a, &a, 2000.0, 0.5);
    close(same.time.kappa, 1.0);
    close(same.events.corrected, 1.0);
    let different = of(&a, &b, 2000.0, 0.5);
    assert!(
        different.time.kappa.unwrap().abs() < 0.05,
        "{:?}",
        different.time
    );
    assert!(
        different.events.corrected.unwrap().abs() < 0.05,
        "{:?}",
        different.events
    );
    // B is not asked first: both directions say the same but for the signs of the ends.
    let back = of(&b, &a, 2000.0, 0.5);
    close(back.time.kappa, different.time.kappa.unwrap());
    assert_eq!(back.events.matched, different.events.matched);
}

#[test]
fn nothing_to_say_of_nothing() {
    let nothing = of(&[], &[], 10.0, 1.0);
    assert_eq!(nothing.time.kappa, None);
    assert_eq!((nothing.events.f1, nothing.events.corrected), (None, None));
}
