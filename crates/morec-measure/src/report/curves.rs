//! Curves of the report: results at other sensitivities, reliability of scores, results on degraded captures.

use std::mem::discriminant;

use super::html::Figure;
use crate::eval::{Evaluation, MEASURED_OVERLAP, Reliability, SCORE_BINS};
use crate::perturb::Perturbation;
use crate::plot::Chart;

const WIDTH: usize = 560;
const HEIGHT: usize = 300;

/// Precision, recall and false alarms against the sensitivity.
pub(super) fn push_sensitivity(out: &mut String, sensitivities: &[(f64, Evaluation)]) {
    if sensitivities.len() < 2 {
        return;
    }
    out.push_str(
        "<h2>Sensitivity</h2>\n<p class=\"small\">Results at other values of <code>--sensitivity</code>, the false alarms a minute in the \
         background motion of training. An event is right if its middle lies within a sample.</p>\n",
    );
    let line = |value: fn(&Evaluation) -> Option<f64>| {
        let points = sensitivities
            .iter()
            .filter_map(move |(rate, e)| Some((rate.log10(), value(e)?)));
        points.collect::<Vec<_>>()
    };
    let chart = Chart::new("Precision and recall of events at each sensitivity")
        .axes(
            "logarithm (base 10) of false alarms a minute in training",
            "share",
        )
        .size(WIDTH, HEIGHT)
        .line("precision", line(|e| e.events.precision))
        .line("recall", line(|e| e.events.recall))
        .line("F1", line(|e| e.events.f1));
    out.push_str(&chart.svg());
    out.push_str(
        "<div class=\"wide\"><table>\n<tr><th scope=\"col\">sensitivity</th><th>precision</th><th>recall</th>\
         <th>F1</th><th>false alarms a minute here</th><th>in unknown motion</th></tr>\n",
    );
    for (rate, e) in sensitivities {
        out.push_str(&format!(
            "<tr><th scope=\"row\">{rate}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            Figure(e.events.precision),
            Figure(e.events.recall),
            Figure(e.events.f1),
            Figure(e.false_alarms.per_minute),
            Figure(e.unknown.per_minute),
        ));
    }
    out.push_str("</table></div>\n");
}

pub(super) fn push_reliability(out: &mut String, reliability: &Reliability) {
    let Some(error) = reliability.error else {
        return;
    };
    let counted: usize = reliability.bins.iter().map(|b| b.count).sum();
    out.push_str(&format!(
        "<h2>Reliability of scores</h2>\n<p class=\"small\">{counted} detections in {SCORE_BINS} bins by score. On the \
         diagonal, the score equals the share of right detections; the mean difference is {error:.3}.</p>\n"
    ));
    let used = || reliability.bins.iter().filter(|b| b.count > 0);
    let chart = Chart::new("Share of right detections at each score")
        .axes("mean score", "share right")
        .size(WIDTH, HEIGHT)
        .line("perfect", [(0.0, 0.0), (1.0, 1.0)])
        .line("measured", used().map(|b| (b.mean_score, b.right)))
        .points("bins", used().map(|b| (b.mean_score, b.right)));
    out.push_str(&chart.svg());
}

/// F1 of copies that are worse in one way: a table, and a curve for each way of several sizes.
pub(super) fn push_perturbed(
    out: &mut String,
    clean: &Evaluation,
    perturbed: &[(Perturbation, Evaluation)],
) {
    if perturbed.is_empty() {
        return;
    }
    out.push_str("<h2>Worse captures</h2>\n<p class=\"small\">Results on copies of the clips, each degraded in one way.</p>\n");
    push_perturbed_curves(out, clean, perturbed);
    out.push_str(
        "<div class=\"wide\"><table>\n<tr><th scope=\"col\">copy</th><th>thesis accuracy</th><th>F1</th><th>F1 of \
         events</th><th>false alarms a minute</th></tr>\n",
    );
    let mut row = |name: &str, e: &Evaluation| {
        out.push_str(&format!(
            "<tr><th scope=\"row\">{name}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            Figure(e.thesis.accuracy),
            Figure(e.f1_at(MEASURED_OVERLAP)),
            Figure(e.events.f1),
            Figure(e.false_alarms.per_minute),
        ));
    };
    row("as it is", clean);
    perturbed.iter().for_each(|(p, e)| row(&p.to_string(), e));
    out.push_str("</table></div>\n");
}

fn push_perturbed_curves(
    out: &mut String,
    clean: &Evaluation,
    perturbed: &[(Perturbation, Evaluation)],
) {
    let mut drawn = Vec::new();
    for (kind, _) in perturbed {
        if drawn.contains(&discriminant(kind)) {
            continue;
        }
        drawn.push(discriminant(kind));
        let of_kind = perturbed
            .iter()
            .filter(|(p, _)| discriminant(p) == discriminant(kind));
        let at = |(p, e): &(Perturbation, Evaluation)| Some((p.size(), e.f1_at(MEASURED_OVERLAP)?));
        let mut points: Vec<(f64, f64)> = of_kind.filter_map(at).collect();
        if points.len() < 2 {
            continue;
        }
        let unchanged = clean.f1_at(MEASURED_OVERLAP);
        points.extend(unchanged.and_then(|f1| Some((kind.unchanged_size()?, f1))));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let chart = Chart::new(format!(
            "F1 at half overlap against the size of {}",
            kind.name()
        ))
        .axes(kind.unit(), "F1")
        .size(WIDTH, HEIGHT)
        .line(kind.name(), points.iter().copied())
        .points("", points.iter().copied());
        out.push_str(&chart.svg());
    }
}
