//! Results in the terminal: the tables that all evaluating commands share.

use std::io::{self, Write};
use std::path::Path;

use anyhow::Context;
use morec_measure::eval::{ClassFigures, Evaluation, MEASURED_OVERLAP};
use morec_measure::explain::Miss;
use morec_measure::report::Report;

use crate::output;
use crate::table::TextTable;

/// Writes the report as a page, and its path to standard error.
pub fn write_report(path: &Path, report: &Report<'_>) -> anyhow::Result<()> {
    output::check_page(path)?;
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    output::write_whole(path, |out| out.write_all(report.html().as_bytes()))
        .with_context(|| path.display().to_string())?;
    eprintln!("morec: report: {}", path.display());
    Ok(())
}

/// Writes every measure as text tables.
pub fn write_tables(out: &mut impl Write, e: &Evaluation) -> io::Result<()> {
    write_figures(out, e)?;
    write_overlaps(out, e)?;
    write_classes(out, e)?;
    write_confusion(out, e)
}

/// Writes the samples that were missed and the reasons; nothing if there are none.
pub fn write_misses(out: &mut impl Write, misses: &[Miss]) -> io::Result<()> {
    if misses.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nsamples without a detection of their own, and why")?;
    for miss in misses {
        let at = miss.sensitivity.map_or(String::new(), |rate| {
            format!("; found with --sensitivity {rate}")
        });
        writeln!(
            out,
            "  {} {} {:.2}-{:.2} s: {}{at}",
            miss.clip, miss.class, miss.span.start_secs, miss.span.stop_secs, miss.reason
        )?;
    }
    Ok(())
}

fn write_figures(out: &mut impl Write, e: &Evaluation) -> io::Result<()> {
    let totals = &e.totals;
    let events = &e.events;
    writeln!(
        out,
        "{} {}, {:.1} s; {} samples, {} detections\n{} of {} samples found, {} false or double\n",
        totals.known_clips,
        if totals.known_clips == 1 {
            "clip"
        } else {
            "clips"
        },
        totals.known_secs,
        totals.samples,
        totals.detections,
        events.matched,
        events.matched + events.missed,
        events.spurious
    )?;
    let mut line = |name: &str, value: String, detail: String| {
        writeln!(
            out,
            "{}",
            format!("{name:<24} {value:>8}   {detail}").trim_end()
        )
    };
    let detail = format!(
        "precision {}  recall {}, middles within a sample",
        figure(events.precision),
        figure(events.recall)
    );
    line("F1 of events", figure(events.f1), detail)?;
    line(
        "F1 at half overlap",
        figure(e.f1_at(MEASURED_OVERLAP)),
        String::new(),
    )?;
    let detail = "mean difference of score and share of right detections".to_owned();
    line("calibration error", figure(e.reliability.error), detail)?;
    let alarms = &e.false_alarms;
    let detail = format!("{} in {:.2} min", alarms.count, alarms.minutes);
    line("false alarms a minute", figure(alarms.per_minute), detail)?;
    if e.unknown.clips > 0 {
        let u = &e.unknown;
        let detail = format!("{} in {:.2} min of unknown motion", u.detections, u.minutes);
        line("  in unknown motion", figure(u.per_minute), detail)?;
        let detail = format!("{} of {} clips with a detection", u.clips_accepted, u.clips);
        line("unknown accepted", figure(u.unknown_accepted), detail)?;
    }
    let d = &e.delay;
    let detail = format!("90 % within {}, {} measured", secs(d.p90_secs), d.count);
    line("delay, median", secs(d.median_secs), detail)?;
    let b = &e.boundaries;
    let bias = |bias: Option<f64>| format!("bias {}, positive is late", signed_secs(bias));
    line(
        "start error, median",
        secs(b.start_median_abs_secs),
        bias(b.start_median_secs),
    )?;
    line(
        "stop error, median",
        secs(b.stop_median_abs_secs),
        bias(b.stop_median_secs),
    )?;
    let c = &e.classification;
    line(
        "P_C  (right)",
        figure(c.p_c),
        format!("{} samples", c.right),
    )?;
    line(
        "P_E  (wrong)",
        figure(c.p_e),
        format!("{} samples", c.wrong),
    )?;
    line(
        "P_R  (rejected)",
        figure(c.p_r),
        format!("{} samples", c.rejected),
    )?;
    let s = &e.frames;
    let detail = format!("{} of what is labelled", figure(s.labelled_accuracy));
    line("frame accuracy", figure(s.frame_accuracy), detail)?;
    let detail = "order of classes, whenever they were".to_owned();
    line("edit score", figure(s.edit_score), detail)?;
    let t = &e.thesis;
    let detail = format!(
        "TP {}  FP {}  FN {}  TN {}",
        t.true_positives, t.false_positives, t.false_negatives, t.true_negatives
    );
    line("thesis accuracy", figure(t.accuracy), detail)
}

fn write_overlaps(out: &mut impl Write, e: &Evaluation) -> io::Result<()> {
    let mut table = TextTable::new([
        "overlap",
        "F1",
        "precision",
        "recall",
        "matched",
        "missed",
        "surplus",
    ]);
    for o in &e.overlap {
        let rates = [o.f1, o.precision, o.recall].map(figure);
        let counts = [o.matched, o.missed, o.spurious].map(|n| n.to_string());
        table.row(
            [format!("{:.2}", o.min_iou)]
                .into_iter()
                .chain(rates)
                .chain(counts),
        );
    }
    write!(
        out,
        "\ndetections matched one to one with samples of their class\n{table}"
    )
}

fn write_classes(out: &mut impl Write, e: &Evaluation) -> io::Result<()> {
    let mut table = TextTable::new([
        "class",
        "samples",
        "found",
        "F1",
        "precision",
        "recall",
        "P_C",
        "P_E",
        "P_R",
        "missed",
        "false alarms",
        "in unknown",
        "delay",
        "start",
        "stop",
    ]);
    e.classes
        .iter()
        .for_each(|class| table.row(class_row(class)));
    write!(
        out,
        "\nclass by class (overlap {MEASURED_OVERLAP}; delay, start and stop are medians, positive is late)\n{table}"
    )
}

fn class_row(class: &ClassFigures) -> Vec<String> {
    let mut row = vec![
        class.class.clone(),
        class.samples.to_string(),
        class.detections.to_string(),
    ];
    if let Some(o) = class.overlap.iter().find(|o| o.min_iou == MEASURED_OVERLAP) {
        row.extend([o.f1, o.precision, o.recall].map(figure));
    }
    let c = &class.classification;
    row.extend([c.p_c, c.p_e, c.p_r].map(figure));
    row.extend(
        [
            class.missed,
            class.false_alarms.count,
            class.unknown_detections,
        ]
        .map(|n| n.to_string()),
    );
    row.push(secs(class.delay.median_secs));
    row.extend(
        [
            class.boundaries.start_median_secs,
            class.boundaries.stop_median_secs,
        ]
        .map(signed_secs),
    );
    row
}

fn write_confusion(out: &mut impl Write, e: &Evaluation) -> io::Result<()> {
    // Long class names would make the columns of a matrix too wide: columns are numbered, rows say the names.
    let columns = &e.confusion.columns;
    let number = |class: &String| columns.iter().position(|c| c == class).map_or(0, |i| i + 1);
    let mut header = vec![String::new()];
    header.extend((1..=columns.len()).map(|i| i.to_string()));
    header.push("nothing".to_owned());
    let mut table = TextTable::with_header(header);
    let names = e
        .confusion
        .rows
        .iter()
        .map(|name| format!("{} {name}", number(name)));
    for (name, counts) in names.chain(["nothing".to_owned()]).zip(&e.confusion.counts) {
        let cells = counts.iter().map(|n| {
            if *n == 0 {
                "·".to_owned()
            } else {
                n.to_string()
            }
        });
        table.row([name].into_iter().chain(cells));
    }
    write!(
        out,
        "\nconfusion (rows: what is labelled; columns: what was found)\n{table}"
    )?;
    let unlabelled: Vec<String> = columns
        .iter()
        .filter(|c| !e.confusion.rows.contains(c))
        .map(|c| format!("{} {c}", number(c)))
        .collect();
    match unlabelled.is_empty() {
        true => Ok(()),
        false => writeln!(out, "  found only: {}", unlabelled.join(", ")),
    }
}

/// A share to three places, or a dash.
pub fn figure(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |v| format!("{v:.3}"))
}

/// Seconds to two places, or a dash.
pub fn secs(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |v| format!("{:.2} s", no_minus_zero(v)))
}

fn signed_secs(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |v| format!("{:+.2} s", no_minus_zero(v)))
}

fn no_minus_zero(secs: f64) -> f64 {
    if secs.abs() < 0.005 { 0.0 } else { secs }
}
