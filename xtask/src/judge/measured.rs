//! What was measured for each row, as a table, and beside the one before.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::Result;
use morec_measure::crossval::Tested;
use morec_measure::eval::{Evaluation, MEASURED_OVERLAP};

/// Columns of the table, after the name of the row.
pub const COLUMNS: [&str; 10] = [
    "events",
    "P",
    "R",
    "F1",
    "F1@.5",
    "accuracy",
    "alarms/min",
    "calib",
    "delay",
    "R@.5/min",
];

/// Figures by row, in the order of [`COLUMNS`]; what cannot be measured is NaN.
pub type JudgeTable = BTreeMap<String, [f64; COLUMNS.len()]>;

/// False alarms a minute at which recall is measured beside F1.
const ALARMS_PER_MINUTE: f64 = 0.5;
/// Halvings of the detections in search of the score that this many false alarms exceed.
const HALVINGS: usize = 12;

/// The figures of one row.
pub fn figures(tested: &Tested) -> Result<[f64; COLUMNS.len()]> {
    let e = &Evaluation::of(&tested.streams, &tested.truths, &tested.founds)?;
    let of = |figure: Option<f64>| figure.unwrap_or(f64::NAN);
    Ok([
        e.totals.samples as f64,
        of(e.events.precision),
        of(e.events.recall),
        of(e.events.f1),
        of(e.f1_at(MEASURED_OVERLAP)),
        of(e.thesis.accuracy),
        alarms(e),
        of(e.reliability.error),
        of(e.delay.median_secs),
        recall_at_rate(tested)?,
    ])
}

fn alarms(e: &Evaluation) -> f64 {
    let alarms = match e.totals.known_clips {
        0 => e.unknown.per_minute,
        _ => e.false_alarms.per_minute,
    };
    alarms.unwrap_or(f64::NAN)
}

/// Recall of the most probable detections that raise no more than [`ALARMS_PER_MINUTE`]; NaN where there is nothing to find.
fn recall_at_rate(tested: &Tested) -> Result<f64> {
    let mut scores: Vec<f64> = tested
        .founds
        .iter()
        .filter_map(|found| found.score)
        .collect();
    scores.sort_by(f64::total_cmp);
    let (mut refused, mut kept) = (0, scores.len());
    let mut recall = f64::NAN;
    // The fewest detections that have to be refused lie from `refused` to `kept`.
    let mut tried = 0;
    for _ in 0..HALVINGS {
        let least = scores.get(tried).copied().unwrap_or(f64::INFINITY);
        let founds = tested
            .founds
            .iter()
            .filter(|found| found.score >= Some(least));
        let founds: Vec<_> = founds.cloned().collect();
        let e = Evaluation::of(&tested.streams, &tested.truths, &founds)?;
        match alarms(&e) > ALARMS_PER_MINUTE {
            true => refused = tried + 1,
            false => {
                recall = e.events.recall.unwrap_or(f64::NAN);
                kept = tried;
            }
        }
        if refused >= kept {
            break;
        }
        tried = (refused + kept) / 2;
    }
    Ok(recall)
}

/// The table as tab-separated text.
pub fn to_tsv(table: &JudgeTable) -> String {
    let mut text = format!("row\t{}\n", COLUMNS.join("\t"));
    for (row, figures) in table {
        let cells: Vec<String> = figures.iter().map(|f| format!("{f:.4}")).collect();
        let _ = writeln!(text, "{row}\t{}", cells.join("\t"));
    }
    text
}

/// A table that [`to_tsv`] wrote; lines that are none are left out.
pub fn from_tsv(text: &str) -> JudgeTable {
    let row = |line: &str| {
        let (row, cells) = line.split_once('\t')?;
        let cells: Option<Vec<f64>> = cells.split('\t').map(|c| c.parse().ok()).collect();
        Some((row.to_owned(), cells?.try_into().ok()?))
    };
    text.lines().filter_map(row).collect()
}

/// The table for people, each figure with its change since `before`.
pub fn beside(table: &JudgeTable, before: &JudgeTable) -> String {
    let mut text = format!("{:34}", "");
    for column in COLUMNS {
        let _ = write!(text, "{column:>16}");
    }
    text.push('\n');
    for (row, figures) in table {
        let _ = write!(text, "{row:34}");
        for (i, figure) in figures.iter().enumerate() {
            let digits = if i == 0 { 0 } else { 3 };
            let change = before.get(row).map_or(0.0, |b| figure - b[i]);
            let change = match change.abs() >= 0.0005 {
                true => format!("{change:+.3}"),
                false => String::new(),
            };
            let shown = match figure.is_nan() {
                true => "-".to_owned(),
                false => format!("{figure:.digits$}"),
            };
            let _ = write!(text, "{shown:>9}{change:7}");
        }
        text.push('\n');
    }
    text
}
