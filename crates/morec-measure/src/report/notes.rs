//! Notes of the report: conclusions from the figures about missing labels and training data.

use std::collections::BTreeSet;

use crate::eval::{Boundaries, ClassFigures, Evaluation};
use morec::labels::Sample;

/// Fewer training samples than this are called few.
const FEW_SAMPLES: usize = 5;
/// A median boundary error of at least this is worth a note.
const NOTABLE_BIAS_SECS: f64 = 0.2;

/// Training data of a class, for the notes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrainedClass {
    /// Name of the class.
    pub class: String,
    /// Number of samples that trained it.
    pub samples: usize,
    /// Number of people who made them, if known.
    pub people: Option<usize>,
}

impl TrainedClass {
    /// Counts the samples of each of `classes`, and their people where any sample names one.
    pub fn count(samples: &[Sample], classes: &[String]) -> Vec<Self> {
        let known = samples.iter().any(|s| s.person.is_some());
        let counted = classes.iter().map(|class| {
            let of_class: Vec<&Sample> = samples.iter().filter(|s| s.class == *class).collect();
            let people: BTreeSet<&String> =
                of_class.iter().filter_map(|s| s.person.as_ref()).collect();
            Self {
                class: class.clone(),
                samples: of_class.len(),
                people: known.then_some(people.len()),
            }
        });
        counted.collect()
    }
}

/// Mistakes and remedies, the most frequent first, a sentence each. Never empty.
///
/// A class is said to need more people or samples only where it also makes mistakes: one person's two samples
/// that are always recognised need nothing.
pub fn learning_notes(evaluation: &Evaluation, training: &[TrainedClass]) -> Vec<String> {
    let mut notes: Vec<(usize, String)> = Vec::new();
    for class in &evaluation.classes {
        notes_on_class(class, &mut notes);
        let trained = training.iter().find(|t| t.class == class.class);
        if let Some(trained) = trained.filter(|_| trouble(class) > 0) {
            notes.extend(need_of(trained).map(|need| (trouble(class), need)));
        }
    }
    let untested = training.iter().filter(|t| {
        !evaluation
            .classes
            .iter()
            .any(|c| c.class == t.class && c.samples > 0)
    });
    notes.extend(untested.map(|t| {
        (
            0,
            format!(
                "{} is in the index but has no sample here, so it is not measured.",
                t.class
            ),
        )
    }));
    bias_notes(evaluation, &mut notes);
    // Stable: notes of equal weight stay in the order of the classes.
    notes.sort_by_key(|(weight, _)| std::cmp::Reverse(*weight));
    if notes.is_empty() {
        return vec![nothing_wrong(evaluation).to_owned()];
    }
    notes.into_iter().map(|(_, text)| text).collect()
}

fn nothing_wrong(evaluation: &Evaluation) -> &'static str {
    match (evaluation.totals.samples, evaluation.unknown.clips) {
        (0, 0) => "There are no labels.",
        (0, _) => "Nothing was detected in the unknown motion.",
        _ => "Every sample was recognised, and nothing else was detected.",
    }
}

/// Samples of the class that were not recognised.
fn trouble(class: &ClassFigures) -> usize {
    class.missed + class.mistaken_for.iter().map(|m| m.count).sum::<usize>()
}

fn notes_on_class(class: &ClassFigures, notes: &mut Vec<(usize, String)>) {
    let name = &class.class;
    if class.missed > 0 {
        notes.push((
            class.missed,
            format!(
                "{name}: {} of {} missed.",
                class.missed,
                count(class.samples, "sample")
            ),
        ));
    }
    if !class.mistaken_for.is_empty() {
        let mistakes = class
            .mistaken_for
            .iter()
            .map(|m| format!("{} {}", m.class, times(m.count)));
        let total = class.mistaken_for.iter().map(|m| m.count).sum();
        notes.push((
            total,
            format!("{name} is mistaken for {}.", listed(mistakes.collect())),
        ));
    }
    if class.false_alarms.count > 0 {
        let alarms = class.false_alarms.count;
        let text = format!(
            "{name} is detected in unlabelled motion, {}: add labels or background there.",
            times(alarms)
        );
        notes.push((alarms, text));
    }
    if class.unknown_detections > 0 {
        let text = format!(
            "{name} is detected in unknown motion {}.",
            times(class.unknown_detections)
        );
        notes.push((class.unknown_detections, text));
    }
    if class.samples == 0 && class.detections > 0 {
        notes.push((
            class.detections,
            format!("{name} is detected but not labelled in these clips."),
        ));
    }
}

/// Notes on detections that lie early or late: of all classes together, and of classes that differ from that.
fn bias_notes(evaluation: &Evaluation, notes: &mut Vec<(usize, String)>) {
    let ends_of = |b: &Boundaries| [("start", b.start_median_secs), ("stop", b.stop_median_secs)];
    let mut note = |whose: &str, end: &str, bias: f64| {
        let late = if bias > 0.0 { "late" } else { "early" };
        notes.push((
            1,
            format!("{whose} {end} {:.1} s {late} (median).", bias.abs()),
        ));
    };
    let notable = |bias: f64| bias.abs() >= NOTABLE_BIAS_SECS;
    for (i, (end, bias)) in ends_of(&evaluation.boundaries).into_iter().enumerate() {
        let common = bias.filter(|b| notable(*b)).unwrap_or(0.0);
        if notable(common) {
            note("Detections", end, common);
        }
        // A single detection has no tendency.
        for class in evaluation.classes.iter().filter(|c| c.boundaries.count > 1) {
            if let Some(bias) = ends_of(&class.boundaries)[i]
                .1
                .filter(|b| notable(*b) && notable(b - common))
            {
                note(&format!("Detections of {}", class.class), end, bias);
            }
        }
    }
}

fn need_of(trained: &TrainedClass) -> Option<String> {
    let samples = count(trained.samples, "sample");
    match trained.people {
        Some(people @ 0..=1) => Some(format!(
            "{} needs more people: {samples} of {people} person.",
            trained.class
        )),
        Some(people) if trained.samples < FEW_SAMPLES => Some(format!(
            "{} needs more samples: {samples} of {people} people.",
            trained.class
        )),
        None if trained.samples < FEW_SAMPLES => {
            Some(format!("{} needs more samples: {samples}.", trained.class))
        }
        _ => None,
    }
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// "a", "a and b", "a, b and c".
fn listed(mut items: Vec<String>) -> String {
    match items.pop() {
        Some(last) if items.is_empty() => last,
        Some(last) => format!("{} and {last}", items.join(", ")),
        None => String::new(),
    }
}

fn times(n: usize) -> String {
    match n {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        n => format!("{n} times"),
    }
}
