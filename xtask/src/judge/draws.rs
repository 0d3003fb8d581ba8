//! One teacher's rows again, with other samples to teach: how much depends on which two were recorded.

use morec::labels::Sample;
use morec::rng::Rng;
use morec::train::TrainClip;

use super::sets::{DataSets, MotionSet, whole_clips};
use super::trials::{SIGNALS, Trial, at_most, of_person, people};

/// Draws of two samples of each class.
const DRAWS: u64 = 5;

/// The trials of one teacher and others, for each data set with more than two samples of a class by one person.
pub fn draws(sets: &DataSets) -> Vec<Trial<'_>> {
    let actions = whole_clips(&sets.actions);
    let of_gestures = |s: &&Sample| s.class != "dontcare";
    let gestures: Vec<Sample> = (sets.gestures.samples.iter().filter(of_gestures))
        .cloned()
        .collect();
    let signals = sets.referee.of_classes(&SIGNALS);
    let mut all = drawn("referee one", &sets.referee, &signals, &sets.referee);
    all.extend(drawn(
        "sessions one",
        &sets.gestures,
        &gestures,
        &sets.sessions,
    ));
    all.extend(drawn(
        "actions one",
        &sets.actions,
        &actions,
        &sets.action_sessions,
    ));
    all
}

/// Each person teaches two samples of each class, drawn from `lessons`, and is tested on the others in `tested`.
fn drawn<'a>(
    row: &str,
    teachers: &'a MotionSet,
    lessons: &[Sample],
    tested: &'a MotionSet,
) -> Vec<Trial<'a>> {
    let truths: Vec<Sample> = (tested.samples.iter())
        .filter(|s| lessons.iter().any(|l| l.class == s.class))
        .cloned()
        .collect();
    let mut all = Vec::new();
    for draw in 1..=DRAWS {
        for person in people(lessons) {
            let mut own = of_person(lessons, &person);
            Rng::new(draw).shuffle(&mut own);
            let taught = at_most(own, 2);
            let is_other = |c: &&TrainClip| {
                c.person.as_ref().is_some_and(|p| *p != person)
                    && truths.iter().any(|s| s.clip == c.name)
            };
            let others = tested.clips.iter().filter(is_other);
            let row = format!("{row}, draw {draw}");
            all.push(Trial::new(&row, teachers, taught, others, &truths));
        }
    }
    all
}
