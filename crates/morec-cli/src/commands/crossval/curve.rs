//! Learning curves, as a table and as a picture.

use std::io::Write;
use std::path::Path;

use anyhow::Context;
use morec_measure::plot::Chart;
use morec_ops::{CurveFigures, CurvePoint, LearningCurve};

use crate::json::write_json;
use crate::output;
use crate::table::TextTable;

/// Draws the curve if a picture is asked for, and prints it.
pub(super) fn write(
    curve: &LearningCurve,
    plot: Option<&Path>,
    as_json: bool,
    out: &mut impl Write,
) -> anyhow::Result<()> {
    if let Some(path) = plot {
        output::check_picture(path)?;
        let svg = chart(curve).svg();
        output::write_whole(path, |out| out.write_all(svg.as_bytes()))
            .with_context(|| path.display().to_string())?;
    }
    if as_json {
        write_json(out, curve)?;
    } else {
        let mut table = TextTable::new([
            "samples",
            "people",
            "event F1",
            "recall",
            "alarms/min",
            "delay s",
        ]);
        for point in &curve.points {
            let of = |of: fn(&CurveFigures) -> Option<f64>| spread(point, of);
            table.row([
                number(point.samples),
                number(point.people),
                of(|draw| draw.f1),
                of(|draw| draw.recall),
                of(|draw| draw.alarms_per_minute),
                of(|draw| draw.delay_secs),
            ]);
        }
        write!(out, "{table}")?;
        for sentence in &curve.advice {
            writeln!(out, "\n{sentence}")?;
        }
    }
    out.flush()?;
    Ok(())
}

fn number(most: Option<usize>) -> String {
    most.map_or("all".to_owned(), |most| most.to_string())
}

/// The mean of a measure, and its range over the draws if there are several.
fn spread(point: &CurvePoint, of: fn(&CurveFigures) -> Option<f64>) -> String {
    match point.spread(of) {
        None => "–".to_owned(),
        Some([_, mean, _]) if point.draws.len() == 1 => format!("{mean:.3}"),
        Some([least, mean, largest]) => format!("{mean:.3} ({least:.3}–{largest:.3})"),
    }
}

/// F1 and recall of the points with all people, the last at the number of doublings after the one before.
fn chart(curve: &LearningCurve) -> Chart {
    let of_samples = || {
        curve
            .points
            .iter()
            .filter(|point| point.people.is_none())
            .enumerate()
    };
    let line = |of: fn(&CurveFigures) -> Option<f64>| -> Vec<(f64, f64)> {
        let mean = |(k, point): (usize, &CurvePoint)| Some((k as f64, point.spread(of)?[1]));
        of_samples().filter_map(mean).collect()
    };
    let draws = of_samples().flat_map(|(k, point)| {
        let f1 = point.draws.iter().filter_map(|draw| draw.f1);
        f1.map(move |f1| (k as f64, f1))
    });
    Chart::new("F1 by number of samples of each class")
        .axes(
            "doublings of the number of samples of each class; the last point: all",
            "share",
        )
        .line("F1 of events", line(|draw| draw.f1))
        .line("recall", line(|draw| draw.recall))
        .points("F1 of each draw", draws)
}
