//! Notes in plain words: what the figures say about what to teach next.

use super::TrainedClass;
use crate::eval::{ClassFigures, Evaluation};

/// Fewer training samples than this are called few.
const FEW_SAMPLES: usize = 5;
/// A median boundary error of at least this is worth a note.
const NOTABLE_BIAS_SECS: f64 = 0.2;

/// What went wrong and what would help, the most frequent first, a sentence each. Never empty.
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
    let untested =
        training.iter().filter(|t| !evaluation.classes.iter().any(|c| c.class == t.class && c.samples > 0));
    notes.extend(
        untested
            .map(|t| (0, format!("{} is trained but has no sample here: nothing is known of it.", t.class))),
    );
    // Stable: notes of equal weight stay in the order of the classes.
    notes.sort_by_key(|(weight, _)| std::cmp::Reverse(*weight));
    if notes.is_empty() {
        return vec![nothing_wrong(evaluation).to_owned()];
    }
    notes.into_iter().map(|(_, text)| text).collect()
}

fn nothing_wrong(evaluation: &Evaluation) -> &'static str {
    match (evaluation.totals.samples, evaluation.unknown.clips) {
        (0, 0) => "There is nothing labelled here, so there is nothing to learn from it.",
        (0, _) => "Nothing was found in the unknown motion.",
        _ => "Every sample was recognised, and nothing else was found.",
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
            format!("{name}: {} of {} missed.", class.missed, count(class.samples, "sample")),
        ));
    }
    for mistake in &class.mistaken_for {
        let text = format!("{name} is mistaken for {} {}.", mistake.class, times(mistake.count));
        notes.push((mistake.count, text));
    }
    if class.false_alarms.count > 0 {
        let alarms = class.false_alarms.count;
        let text = format!(
            "{name} is seen where nothing is labelled, {}: more background, or labels, would tell.",
            times(alarms)
        );
        notes.push((alarms, text));
    }
    if class.unknown_detections > 0 {
        let text = format!("{name} is seen in unknown motion {}.", times(class.unknown_detections));
        notes.push((class.unknown_detections, text));
    }
    if class.samples == 0 && class.detections > 0 {
        notes.push((class.detections, format!("{name} is found but labelled nowhere in these clips.")));
    }
    bias_note(class, notes);
}

fn bias_note(class: &ClassFigures, notes: &mut Vec<(usize, String)>) {
    let ends = [("start", class.boundaries.start_median_secs), ("stop", class.boundaries.stop_median_secs)];
    for (end, bias) in ends {
        // A single detection has no tendency.
        if let Some(bias) = bias.filter(|b| b.abs() >= NOTABLE_BIAS_SECS && class.boundaries.count > 1) {
            let late = if bias > 0.0 { "late" } else { "early" };
            notes.push((
                1,
                format!("Detections of {} {end} {:.1} s {late} (median).", class.class, bias.abs()),
            ));
        }
    }
}

fn need_of(trained: &TrainedClass) -> Option<String> {
    let samples = count(trained.samples, "sample");
    match trained.people {
        Some(people @ 0..=1) => {
            Some(format!("{} needs more people: {samples} of {people} person.", trained.class))
        }
        Some(people) if trained.samples < FEW_SAMPLES => {
            Some(format!("{} needs more samples: {samples} of {people} people.", trained.class))
        }
        None if trained.samples < FEW_SAMPLES => {
            Some(format!("{} needs more samples: {samples}.", trained.class))
        }
        _ => None,
    }
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn times(n: usize) -> String {
    match n {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        n => format!("{n} times"),
    }
}
