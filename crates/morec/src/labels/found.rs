//! Tables of detections, written by recognition or by other programs.

use std::collections::BTreeMap;
use std::fmt;

use super::Extent;
use super::ground_truth::ClipDetection;
use super::read::ExtentColumns;
use super::resolve::{ClipLength, known_name};
use super::table::{Row, Table};
use crate::formats::{ParseError, Place, Warning};
use crate::live::Detection;

/// The first line of a table of detections, without a line ending.
pub const FOUND_HEADER: &str =
    "clip\tstart\tstop\tclass\tscore\treported_at\tstart_secs\tstop_secs";

/// A detection to be written: its line, by [`Display`](fmt::Display), without a line ending.
///
/// Times become frames at the clip's own rate by rounding; tabs and line ends within a name become blanks.
#[derive(Debug, Clone, Copy)]
pub struct FoundLine<'a> {
    /// The clip's name.
    pub clip: &'a str,
    /// The detection, on the clip's clock.
    pub found: Detection<&'a str>,
    /// The clip's frames a second.
    pub rate_hz: f64,
}

impl fmt::Display for FoundLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = &self.found;
        let frames = found.span.frames(self.rate_hz);
        // A detection is never empty, however low the clip's rate.
        let (start, stop) = (frames.start, frames.end.max(frames.start + 1));
        let clean = |name: &str| name.replace(['\t', '\r', '\n'], " ");
        write!(
            f,
            "{}\t{start}\t{stop}\t{}\t{:.4}\t{}\t{:.4}\t{:.4}",
            clean(self.clip),
            clean(found.class),
            found.score,
            (found.reported_secs * self.rate_hz).round() as usize,
            found.span.start_secs,
            found.span.stop_secs
        )
    }
}

/// When a detection was reported, as its table gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReportedAt {
    /// A frame at the clip's own rate (column `reported_at`).
    Frame(usize),
    /// Seconds from the clip's beginning (column `reported_secs`).
    Secs(f64),
}

/// One row of a table of detections.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundRow {
    /// The clip's name.
    pub clip: String,
    /// Name of the class.
    pub class: String,
    /// Frames, seconds, or the whole clip.
    pub extent: Extent,
    /// Score, if the recogniser gives one.
    pub score: Option<f64>,
    /// When it was reported, if the table says.
    pub reported: Option<ReportedAt>,
    /// Repetitions of an activity, if the table says.
    pub repetitions: Option<u32>,
    /// The row's line in its file, from 1.
    pub line: u64,
}

/// A table of detections.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FoundTable {
    /// The rows in file order.
    pub rows: Vec<FoundRow>,
    /// Omissions and oddities.
    pub warnings: Vec<Warning>,
}

/// Reads a table of detections. Columns `clip`, `class` and an extent (frames or seconds, as in labels) must be
/// there; `score`, `reported_at` (a frame), `reported_secs` and `repetitions` may be, and what else `morec recognize` writes. Fails as [`super::Labels::read`] does.
///
/// # Errors
/// As [`super::Labels::read`].
pub fn read_detections(bytes: &[u8]) -> Result<FoundTable, ParseError> {
    let table = Table::new(bytes)?;
    let (clip, class) = (table.need("clip")?, table.need("class")?);
    let extents = ExtentColumns::find(&table)?;
    if !extents.any() {
        table.need("start")?;
    }
    let score = table.find("score");
    let reported = (table.find("reported_at"), table.find("reported_secs"));
    let repetitions = table.find("repetitions");
    let known = [
        "clip",
        "class",
        "start",
        "stop",
        "start_secs",
        "stop_secs",
        "score",
        "reported_at",
        "reported_secs",
        "repetitions",
        "period_secs",
        "off_degrees",
        "pace",
        "worst_bone",
        "worst_degrees",
        "worst_secs",
        "person",
    ];
    let mut warnings = table.unknown_columns(&known);
    let (rows, too_long) = table.rows();
    warnings.extend(too_long);
    let rows = rows
        .iter()
        .map(|row| {
            Ok(FoundRow {
                clip: row.text(clip, "a clip's name")?,
                class: row.text(class, "a class")?,
                extent: extents.read(row)?.ok_or_else(|| {
                    let expected = "a stop after the start";
                    ParseError::new(Place::Line(row.line), expected, "a moment")
                })?,
                score: score.map_or(Ok(None), |column| row.optional_number(column))?,
                reported: read_reported(row, reported)?,
                repetitions: repetitions
                    .map_or(Ok(None), |column| row.optional_number(column))?
                    .map(|count| count.round() as u32),
                line: row.line,
            })
        })
        .collect::<Result<_, _>>()?;
    Ok(FoundTable { rows, warnings })
}

fn read_reported(
    row: &Row<'_>,
    (frame, secs): (Option<usize>, Option<usize>),
) -> Result<Option<ReportedAt>, ParseError> {
    let filled = |column: &usize| !row.cell(*column).is_empty();
    if let Some(column) = frame.filter(filled) {
        return Ok(Some(ReportedAt::Frame(row.frame(column)?)));
    }
    match secs.filter(filled) {
        Some(column) => Ok(Some(ReportedAt::Secs(row.secs(column)?))),
        None => Ok(None),
    }
}

impl FoundTable {
    /// The detections in seconds, in row order, for those of `clips`; what names another clip is left out, with
    /// one warning for each such clip.
    pub fn resolve(
        &self,
        clips: &BTreeMap<String, ClipLength>,
    ) -> (Vec<ClipDetection>, Vec<Warning>) {
        let mut found = Vec::new();
        let mut absent: BTreeMap<&str, (u64, usize)> = BTreeMap::new();
        for row in &self.rows {
            let Some(name) = known_name(&row.clip, clips) else {
                absent.entry(&row.clip).or_insert((row.line, 0)).1 += 1;
                continue;
            };
            let length = clips[name];
            let reported_secs = row.reported.map(|reported| match reported {
                ReportedAt::Frame(frame) => frame as f64 / length.rate_hz,
                ReportedAt::Secs(secs) => secs,
            });
            let (clip, class) = (name.to_owned(), row.class.clone());
            found.push(ClipDetection {
                clip,
                class,
                span: length.span(&row.extent),
                score: row.score,
                reported_secs,
                repetitions: row.repetitions,
            });
        }
        let warnings = absent.into_iter().map(|(clip, (line, rows))| {
            Warning::new(
                Place::Line(line),
                format!("{rows} detections are of the unknown clip {clip}; left out"),
            )
        });
        (found, warnings.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TimeSpan;
    use proptest::prelude::*;

    #[test]
    fn a_foreign_table_needs_no_score() {
        let table = read_detections(b"clip\tstart\tstop\tclass\na\t3\t9\twave\n").unwrap();
        assert_eq!((table.rows[0].score, table.rows[0].reported), (None, None));
        let error = read_detections(b"clip\tclass\na\twave\n").unwrap_err();
        assert!(error.to_string().contains("a column `start`"), "{error}");
        let error =
            read_detections(b"clip\tstart\tstop\tclass\tscore\na\t3\t9\twave\thigh\n").unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 2, column 12: expected a number or nothing, found `high`"
        );
    }

    #[test]
    fn detections_of_other_clips_are_counted() {
        let table = read_detections(
            b"clip\tstart\tstop\tclass\treported_at\na\t30\t60\tx\t90\nb\t0\t1\tx\t\nb\t1\t2\tx\t\n",
        );
        let clips = BTreeMap::from([(
            "a".to_owned(),
            ClipLength {
                frames: 100,
                rate_hz: 30.0,
            },
        )]);
        let (found, warnings) = table.unwrap().resolve(&clips);
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].span, found[0].reported_secs),
            (TimeSpan::new(1.0, 2.0), Some(3.0))
        );
        assert_eq!(
            warnings[0].to_string(),
            "line 3: 2 detections are of the unknown clip b; left out"
        );
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_again(
            start in 0usize..100_000, length in 1usize..1000, delay in 0usize..200, score in -2.0f64..2.0,
            rate_hz in prop::sample::select(vec![30.0, 60.0, 120.000_48, 240.0]), class in "[a-z<&][a-z <&]{0,9}[a-z]",
        ) {
            let found = Detection {
                class: class.as_str(), span: TimeSpan::of_frames(start..start + length, rate_hz), score,
                reported_secs: (start + length + delay) as f64 / rate_hz, repetitions: None,
            };
            let line = FoundLine { clip: "clip 1", found, rate_hz };
            let row = read_detections(format!("{FOUND_HEADER}\n{line}\n").as_bytes()).unwrap().rows.remove(0);
            prop_assert_eq!(row.extent, Extent::Frames(start..start + length));
            prop_assert_eq!(row.reported, Some(ReportedAt::Frame(start + length + delay)));
            prop_assert!((row.score.unwrap() - score).abs() <= 5.1e-5);
            prop_assert_eq!((row.clip.as_str(), row.class), ("clip 1", class));
        }
    }
}
