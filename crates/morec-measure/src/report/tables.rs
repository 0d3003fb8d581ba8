//! The confusion matrix as a heat table, and the table of classes.

use super::TrainedClass;
use super::html::{Figure, Text, secs};
use crate::eval::{Confusion, Evaluation, MEASURED_OVERLAP, Timeline};
use morec::labels::{ClassLengths, class_lengths};

/// The strongest tint of a cell: writing on it stays readable in both themes.
const STRONGEST: f64 = 0.6;

pub(super) fn push_confusion(out: &mut String, confusion: &Confusion) {
    out.push_str(
        "<h2>Confusion matrix</h2>
<p class=\"small\">Rows: labelled class. Columns: detected class. Green is right, red is wrong; a darker cell is a larger share of its row.</p>
<div class=\"wide\"><table \
         class=\"heat\">
<tr><td></td>",
    );
    let nothing = ["nothing".to_owned()];
    for name in confusion.columns.iter().chain(&nothing) {
        out.push_str(&format!(
            "<th scope=\"col\"><span>{}</span></th>",
            Text(name)
        ));
    }
    out.push_str("</tr>\n");
    for (name, counts) in confusion.rows.iter().chain(&nothing).zip(&confusion.counts) {
        let is_nothing = std::ptr::eq(name, &nothing[0]);
        let total: usize = counts.iter().sum();
        out.push_str(&format!("<tr><th scope=\"row\">{}</th>", Text(name)));
        for (column, count) in counts.iter().enumerate() {
            let right = match confusion.columns.get(column) {
                Some(found) => !is_nothing && found == name,
                None => is_nothing,
            };
            push_cell(out, *count, total, right);
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</table></div>\n");
}

fn push_cell(out: &mut String, count: usize, total: usize, right: bool) {
    if count == 0 {
        out.push_str(if right {
            "<td class=\"zero\">0</td>"
        } else {
            "<td class=\"zero\">·</td>"
        });
        return;
    }
    let share = STRONGEST * (0.25 + 0.75 * count as f64 / total as f64);
    let colour = if right { "46,160,90" } else { "220,60,50" };
    out.push_str(&format!(
        "<td style=\"background:rgba({colour},{share:.2})\">{count}</td>"
    ));
}

pub(super) fn push_classes(
    out: &mut String,
    e: &Evaluation,
    training: &[TrainedClass],
    timelines: &[Timeline],
) {
    let truths = timelines.iter().flat_map(|timeline| &timeline.truths);
    let lengths = class_lengths(
        truths.map(|(truth, _)| (&truth.class[..], None, truth.span.duration_secs())),
    );
    out.push_str(
        "<h2>Class by class</h2>\n<div class=\"wide\"><table>\n<tr><th scope=\"col\">class</th>",
    );
    if !training.is_empty() {
        out.push_str("<th>trained by</th>");
    }
    let unknown = e.unknown.clips > 0;
    out.push_str(
        "<th>samples</th><th>shortest</th><th>median</th><th>longest</th><th>found</th><th>F1</th><th>precision</th><th>recall</th><th>P_C</th><th>P_E</th><th>P_R</th>\
         <th>missed</th><th>false alarms</th>",
    );
    out.push_str(if unknown { "<th>in unknown</th>" } else { "" });
    out.push_str("<th>delay</th><th>start</th><th>stop</th><th>mistaken for</th></tr>\n");
    for class in &e.classes {
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th>",
            Text(&class.class)
        ));
        if !training.is_empty() {
            let trained = training.iter().find(|t| t.class == class.class);
            out.push_str(&format!(
                "<td>{}</td>",
                trained.map_or("–".to_owned(), trained_by)
            ));
        }
        let lengths = lengths.iter().find(|l| l.class == class.class);
        push_class_figures(out, class, lengths, unknown);
        out.push_str("</tr>\n");
    }
    out.push_str(&format!(
        "</table></div>\n<p class=\"small\">F1, precision and recall at an overlap of {MEASURED_OVERLAP}. Delay, start and \
         stop are medians over detections matched at that overlap.</p>\n"
    ));
}

fn push_class_figures(
    out: &mut String,
    class: &crate::eval::ClassFigures,
    lengths: Option<&ClassLengths>,
    unknown: bool,
) {
    let mut cell = |text: String| out.push_str(&format!("<td>{text}</td>"));
    cell(class.samples.to_string());
    let secs_of = [
        lengths.map(|l| l.shortest_secs),
        lengths.map(|l| l.median_secs),
        lengths.map(|l| l.longest_secs),
    ];
    secs_of
        .into_iter()
        .for_each(|length| cell(secs(length, false)));
    cell(class.detections.to_string());
    if let Some(half) = class.overlap.iter().find(|o| o.min_iou == MEASURED_OVERLAP) {
        [half.f1, half.precision, half.recall]
            .into_iter()
            .for_each(|v| cell(Figure(v).to_string()));
    }
    let c = &class.classification;
    [c.p_c, c.p_e, c.p_r]
        .into_iter()
        .for_each(|v| cell(Figure(v).to_string()));
    cell(class.missed.to_string());
    cell(class.false_alarms.count.to_string());
    if unknown {
        cell(class.unknown_detections.to_string());
    }
    cell(secs(class.delay.median_secs, false));
    cell(secs(class.boundaries.start_median_secs, true));
    cell(secs(class.boundaries.stop_median_secs, true));
    let mistakes: Vec<String> = class
        .mistaken_for
        .iter()
        .map(|m| format!("{}&nbsp;×{}", Text(&m.class), m.count))
        .collect();
    cell(if mistakes.is_empty() {
        "–".to_owned()
    } else {
        mistakes.join(", ")
    });
}

fn trained_by(trained: &TrainedClass) -> String {
    match trained.people {
        Some(people) => format!("{} of {people}", trained.samples),
        None => trained.samples.to_string(),
    }
}
