//! What training takes from JavaScript: rows of labels, and options.

use morec::Labels;
use morec::TimeSpan;
use morec::labels::{Extent, Label};
use morec::train::{Everyday, Mirror, TrainOptions};
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
            line,
        });
    }
    Ok(labels)
}

/// Options of training; the words are those of the Python package.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LearnOptions {
    /// Only these classes, in this order; all if empty.
    pub classes: Vec<String>,
    /// Mirrored copies of samples: `auto`, `yes`, `no`.
    pub mirror: String,
    /// Made everyday motion as background: `auto`, `always`, `never`.
    pub everyday: String,
    /// What unlabelled parts of labelled clips are: `background`, `ignore`.
    pub unlabelled: String,
}

impl Default for LearnOptions {
    fn default() -> Self {
        Self {
            classes: Vec::new(),
            mirror: "auto".to_owned(),
            everyday: "always".to_owned(),
            unlabelled: "background".to_owned(),
        }
    }
}

impl LearnOptions {
    /// The options of the library.
    ///
    /// # Errors
    /// An option that is none of its words.
    pub fn train_options(&self) -> Result<TrainOptions, String> {
        Ok(TrainOptions {
            mirror: word(
                "mirror",
                &self.mirror,
                [
                    ("auto", Mirror::Auto),
                    ("yes", Mirror::Yes),
                    ("no", Mirror::No),
                ],
            )?,
            everyday: word(
                "everyday",
                &self.everyday,
                [
                    ("auto", Everyday::Auto),
                    ("always", Everyday::Always),
                    ("never", Everyday::Never),
                ],
            )?,
            unlabelled_is_background: word(
                "unlabelled",
                &self.unlabelled,
                [("background", true), ("ignore", false)],
            )?,
            ..TrainOptions::default()
        })
    }
}

/// What `found` means as the option `name`.
fn word<T, const N: usize>(name: &str, found: &str, words: [(&str, T); N]) -> Result<T, String> {
    let known = words.each_ref().map(|(word, _)| *word).join(", ");
    let meant = words.into_iter().find(|(word, _)| *word == found);
    let meant = meant.map(|(_, meant)| meant);
    meant.ok_or_else(|| format!("{name}: expected one of {known}, found `{found}`"))
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

    #[test]
    fn an_unknown_word_is_refused_with_those_that_are_known() {
        let options = LearnOptions {
            mirror: "maybe".to_owned(),
            ..LearnOptions::default()
        };
        let error = options.train_options().unwrap_err();
        assert_eq!(
            error,
            "mirror: expected one of auto, yes, no, found `maybe`"
        );
    }
}
