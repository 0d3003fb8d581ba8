//! Reads rows of labels from JavaScript.

use morec::Labels;
use morec::TimeSpan;
use morec::labels::{Extent, Label};
use serde::Deserialize;

/// A label: in the clip of that name, the class happens from start to stop; without times, the whole clip is one sample.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SampleRow {
    clip: String,
    class: String,
    start_secs: Option<f64>,
    stop_secs: Option<f64>,
    person: Option<String>,
}

/// Rows of labels as a table.
///
/// # Errors
/// The row, counted from 1, that gives only one of its two times.
pub fn labels(rows: Vec<SampleRow>) -> Result<Labels, String> {
    let mut labels = Labels::default();
    for (row, line) in rows.into_iter().zip(1..) {
        let extent = match (row.start_secs, row.stop_secs) {
            (Some(start), Some(stop)) => Extent::Secs(TimeSpan::new(start, stop)),
            (None, None) => Extent::WholeClip,
            _ => {
                return Err(format!(
                    "labels: row {line}: expected both start_secs and stop_secs, or neither"
                ));
            }
        };
        labels.rows.push(Label {
            clip: row.clip,
            class: row.class,
            extent,
            person: row.person,
            annotator: None,
            line,
        });
    }
    Ok(labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_with_one_time_is_refused_with_its_row() {
        let rows = r#"[{"clip":"a","class":"x"},{"clip":"a","class":"x","start_secs":1}]"#;
        let error = labels(serde_json::from_str(rows).unwrap()).unwrap_err();
        assert!(error.starts_with("labels: row 2: expected both"), "{error}");
    }
}
