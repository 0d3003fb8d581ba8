//! The figures at the head of a report.

use super::html::{Figure, secs};
use crate::eval::{Evaluation, MEASURED_OVERLAP};

pub(super) fn push(out: &mut String, e: &Evaluation) {
    let events = &e.events;
    out.push_str(&format!(
        "<h2>Figures</h2>\n<p>{} of {} samples found, {} false or double.</p>\n<div class=\"cards\">\n",
        events.matched,
        events.matched + events.missed,
        events.spurious
    ));
    let detail = format!(
        "precision {}, recall {}; middles within a sample",
        Figure(events.precision),
        Figure(events.recall)
    );
    card(out, "F1 of events", Figure(events.f1), &detail);
    if let Some(half) = e.overlap.iter().find(|o| o.min_iou == MEASURED_OVERLAP) {
        let detail = format!(
            "precision {}, recall {}",
            Figure(half.precision),
            Figure(half.recall)
        );
        card(out, "F1 at half overlap", Figure(half.f1), &detail);
    }
    let alarms = &e.false_alarms;
    card(
        out,
        "False alarms a minute",
        Figure(alarms.per_minute),
        &format!(
            "{} in {:.1} min of labelled clips",
            alarms.count, alarms.minutes
        ),
    );
    if e.unknown.clips > 0 {
        push_unknown(out, e);
    }
    let delay = &e.delay;
    let detail = format!(
        "nine in ten within {}; {} measured",
        secs(delay.p90_secs, false),
        delay.count
    );
    card(
        out,
        "Delay, median",
        secs(delay.median_secs, false),
        &detail,
    );
    let c = &e.classification;
    let detail = format!(
        "wrong (P_E) {}, rejected (P_R) {}",
        Figure(c.p_e),
        Figure(c.p_r)
    );
    card(out, "Samples recognised (P_C)", Figure(c.p_c), &detail);
    let t = &e.thesis;
    let counts = format!(
        "{} right, {} wrong, {} missed, {} correctly not reported",
        t.true_positives, t.false_positives, t.false_negatives, t.true_negatives
    );
    card(out, "Thesis accuracy", Figure(t.accuracy), &counts);
    out.push_str("</div>\n");
    push_overlap_table(out, e);
}

fn push_unknown(out: &mut String, e: &Evaluation) {
    let u = &e.unknown;
    let detail = format!(
        "{} of {} clips with a detection; {} detections in {:.1} min, {} a minute",
        u.clips_accepted,
        u.clips,
        u.detections,
        u.minutes,
        Figure(u.per_minute)
    );
    card(
        out,
        "Unknown motion accepted",
        Figure(u.unknown_accepted),
        &detail,
    );
}

fn card(out: &mut String, name: &str, value: impl std::fmt::Display, detail: &str) {
    out.push_str(&format!(
        "<div class=\"card\"><div class=\"name\">{name}</div><div class=\"value\">{value}</div>\
         <div class=\"detail\">{detail}</div></div>\n"
    ));
}

fn push_overlap_table(out: &mut String, e: &Evaluation) {
    out.push_str(
        "<div class=\"wide\"><table>\n<caption>Detections matched one to one with samples of their class</caption>\n\
         <tr><th scope=\"col\">overlap at least</th><th>F1</th><th>precision</th><th>recall</th><th>matched</th>\
         <th>missed</th><th>surplus</th></tr>\n",
    );
    for o in &e.overlap {
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            o.min_iou,
            Figure(o.f1),
            Figure(o.precision),
            Figure(o.recall),
            o.matched,
            o.missed,
            o.spurious
        ));
    }
    let b = &e.boundaries;
    out.push_str(&format!(
        "</table></div>\n<p class=\"small\">Boundaries of the {} detections matched at {MEASURED_OVERLAP}: starts differ by {} \
         (median; bias {}), stops by {} (bias {}). A positive bias is late.</p>\n",
        b.count,
        secs(b.start_median_abs_secs, false),
        secs(b.start_median_secs, true),
        secs(b.stop_median_abs_secs, false),
        secs(b.stop_median_secs, true),
    ));
}
