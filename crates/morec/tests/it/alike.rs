//! Classes taught with the same motion: the report says which is taken for which.

use morec::Trainer;
use morec::import::{ImportOptions, Take, normalize};
use morec::labels::Labels;
use morec::synth::{DatabaseSpec, SyntheticTake, database};

fn films() -> Vec<SyntheticTake> {
    let spec = DatabaseSpec {
        people: 4,
        repetitions: 1,
        rate_hz: 30.0,
        ..Default::default()
    };
    database(5, &spec)
}

/// Notes of training on `films` with their classes renamed, a film and a class each.
fn notes(renamed: impl Fn(usize, &str) -> String) -> Vec<String> {
    let films = films();
    let mut labels = Labels::default();
    for (number, film) in films.iter().enumerate() {
        for sample in film.samples() {
            let class = renamed(number, &sample.class);
            labels.add(&sample.clip, &class, sample.span);
        }
    }
    let ready = |film: SyntheticTake| normalize(film.clip, &ImportOptions::default()).unwrap();
    let takes: Vec<Take> = films.into_iter().map(ready).collect();
    let (_, report) = Trainer::new()
        .labels(&labels)
        .train_with_report(&takes)
        .unwrap();
    let alike = |note: &String| note.contains("taken for another class");
    report.notes.into_iter().filter(alike).collect()
}

#[test]
fn two_names_for_one_motion_are_told_and_different_motions_are_not() {
    assert_eq!(notes(|_, class| class.to_owned()), Vec::<String>::new());
    let halves = notes(|film, class| match class {
        // The first and the third person wave alike, as the second and the fourth do.
        "wave" if film < 2 => "greet".to_owned(),
        other => other.to_owned(),
    });
    let [note] = halves.as_slice() else {
        panic!("{halves:?}")
    };
    assert!(note.contains("greet") && note.contains("wave"), "{note}");
}
