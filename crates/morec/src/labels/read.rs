//! Reading a table of labels.

use super::table::{Row, Table};
use super::{Extent, Label, Labels};
use crate::TimeSpan;
use crate::formats::{ParseError, Place, Warning};

/// The columns that may say where a label lies.
pub(super) struct ExtentColumns {
    frames: Option<(usize, usize)>,
    secs: Option<(usize, usize)>,
}

impl Labels {
    /// Reads a table of labels, or of whole clips, which is one without extents.
    ///
    /// If a row gives both frames and seconds, the frames count; where a column `whole_clip` says 1, neither. Fails on a missing column, an empty clip or
    /// class, a cell that is no number, a negative one, and a stop that does not come after its start.
    ///
    /// # Errors
    /// As above, with the place, what was expected and what was found.
    pub fn read(bytes: &[u8]) -> Result<Self, ParseError> {
        Ok(Self::of_table(&Table::new(bytes)?, &[])?.0)
    }

    /// The same, and the cells of one more column, one for each row; `None` if the table has no such column.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_with(
        bytes: &[u8],
        column: &str,
    ) -> Result<(Self, Option<Vec<String>>), ParseError> {
        let table = Table::new(bytes)?;
        let (labels, rows) = Self::of_table(&table, &[column])?;
        let cells = |at: usize| rows.iter().map(|row| row.cell(at).to_owned()).collect();
        Ok((labels, table.find(column).map(cells)))
    }

    /// Labels and the rows that they are of. Columns in `more` are somebody else's, not unknown.
    fn of_table<'a>(table: &Table<'a>, more: &[&str]) -> Result<(Self, Vec<Row<'a>>), ParseError> {
        let (clip, class) = (table.need("clip")?, table.need("class")?);
        let (person, annotator) = (table.find("person"), table.find("annotator"));
        let extents = ExtentColumns::find(table)?;
        let known = [
            "clip",
            "class",
            "person",
            "annotator",
            "start",
            "stop",
            "start_secs",
            "stop_secs",
            "whole_clip",
        ];
        let whole = table.find("whole_clip");
        let mut warnings = table.unknown_columns(&[&known, more].concat());
        let (rows, too_long) = table.rows();
        warnings.extend(too_long);
        let mut labels = Vec::with_capacity(rows.len());
        let mut kept = Vec::with_capacity(rows.len());
        for row in rows {
            let class = row.text(class, "a class")?;
            let extent = match whole.map(|column| row.cell(column)) {
                Some("1") => Some(Extent::WholeClip),
                _ => extents.read(&row)?,
            };
            let Some(extent) = extent else {
                let text = format!("`{class}` is a point in time without a duration; left out");
                warnings.push(Warning::new(Place::Line(row.line), text));
                continue;
            };
            let name = |column: Option<usize>| {
                let named = column.map(|column| row.cell(column));
                named.filter(|name| !name.is_empty()).map(str::to_owned)
            };
            labels.push(Label {
                clip: row.text(clip, "a clip's name")?,
                class,
                extent,
                person: name(person),
                annotator: name(annotator),
                line: row.line,
            });
            kept.push(row);
        }
        Ok((
            Self {
                rows: labels,
                warnings,
            },
            kept,
        ))
    }
}

impl ExtentColumns {
    pub fn find(table: &Table<'_>) -> Result<Self, ParseError> {
        Ok(Self {
            frames: table.find_pair("start", "stop")?,
            secs: table.find_pair("start_secs", "stop_secs")?,
        })
    }

    /// True if the table has any of them.
    pub fn any(&self) -> bool {
        self.frames.is_some() || self.secs.is_some()
    }

    /// The extent of a row; `None` for a point in time, whose start and stop are equal.
    ///
    /// # Errors
    /// A cell is not a number, or the stop is before the start.
    pub fn read(&self, row: &Row<'_>) -> Result<Option<Extent>, ParseError> {
        let filled = |(start, stop): (usize, usize)| {
            !(row.cell(start).is_empty() && row.cell(stop).is_empty())
        };
        match (self.frames, self.secs) {
            (None, None) => Ok(Some(Extent::WholeClip)),
            (Some(columns), None) => frames(row, columns),
            (Some(columns), Some(secs)) if filled(columns) || !filled(secs) => frames(row, columns),
            (_, Some(columns)) => secs(row, columns),
        }
    }
}

fn frames(row: &Row<'_>, (start, stop): (usize, usize)) -> Result<Option<Extent>, ParseError> {
    let (from, to) = (row.frame(start)?, row.frame(stop)?);
    if to < from {
        return Err(row.error(
            stop,
            &format!("a stop after the start, {from} (stop is exclusive)"),
        ));
    }
    Ok((to > from).then_some(Extent::Frames(from..to)))
}

fn secs(row: &Row<'_>, (start, stop): (usize, usize)) -> Result<Option<Extent>, ParseError> {
    let (from, to) = (row.secs(start)?, row.secs(stop)?);
    if to < from {
        return Err(row.error(stop, &format!("a stop after the start, {from} s")));
    }
    Ok((to > from).then_some(Extent::Secs(TimeSpan::new(from, to))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Labels {
        Labels::read(text.as_bytes()).unwrap()
    }

    fn fails(text: &str) -> String {
        Labels::read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn frames_seconds_and_whole_clips() {
        let frames = read("clip\tstart\tstop\tclass\na\t3\t9\twalk\n");
        assert_eq!(frames.rows[0].extent, Extent::Frames(3..9));
        assert_eq!(frames.rows[0].line, 2);
        let secs = read(
            "class\tclip\tstart_secs\tstop_secs\tperson\nwalk\ta\t0.5\t1.25\tp\nrun\ta\t2\t3\t\n",
        );
        assert_eq!(secs.rows[0].extent, Extent::Secs(TimeSpan::new(0.5, 1.25)));
        assert_eq!(secs.rows[0].person.as_deref(), Some("p"));
        assert_eq!(secs.rows[1].person, None);
        let some = read(
            "clip\tclass\tstart\tstop\twhole_clip\na\tw\t3\t9\t0\nb\tw\t0\t9\t1\nc\tw\t\t\t1\n",
        );
        let extents: Vec<&Extent> = some.rows.iter().map(|row| &row.extent).collect();
        assert_eq!(
            extents,
            [
                &Extent::Frames(3..9),
                &Extent::WholeClip,
                &Extent::WholeClip
            ]
        );
        let whole = read("clip\tclass\tstyle\na\twave\tsoft\n");
        assert_eq!(whole.rows[0].extent, Extent::WholeClip);
        assert_eq!(whole.warnings.len(), 1);
        assert!(
            whole.warnings[0].text.contains("`style`"),
            "{}",
            whole.warnings[0]
        );
    }

    #[test]
    fn text_as_programs_leave_it() {
        let plain = read("clip\tstart\tstop\tclass\na\t3\t9\twalk\nb\t1\t2\trun\n");
        for text in [
            "\u{feff}clip\tstart\tstop\tclass\r\na\t3\t9\twalk\r\n\r\nb\t1\t2\trun",
            "\nClip\tStart\tStop\tClass\t\t\na\t3.0\t9.00\twalk\t\t\n\t\t\nb \t 1\t2\t run\n\n",
            "clip\tstart\tstop\tclass\ra\t3\t9\twalk\rb\t1\t2\trun\r",
            "\"clip\",\"start\",\"stop\",\"class\"\n\"a\",3,9,\"walk\"\n\"b\",1,2,\"run\"\n",
            "\"clip\" \"start\" \"stop\" \"class\"\n\"1\" \"a\" 3 9 \"walk\"\n\"2\" \"b\" 1 2 \"run\"\n",
            "# by hand\nclip;start;stop;class\na;3;9;walk\n# b;3;4;jump\nb;1;2;run\n",
            "#clip\tstart\tstop\tclass\na\t3\t9\twalk\nb\t1\t2\trun\n",
        ] {
            let other = read(text);
            assert!(other.warnings.is_empty(), "{text:?}: {:?}", other.warnings);
            for (a, b) in plain.rows.iter().zip(&other.rows) {
                assert_eq!(
                    (&a.clip, &a.class, &a.extent),
                    (&b.clip, &b.class, &b.extent),
                    "{text:?}"
                );
            }
            assert_eq!(other.rows.len(), 2);
        }
    }

    #[test]
    fn moments_are_left_out_and_commas_are_points() {
        let labels = read("clip;class;start_secs;stop_secs\na;wave;1,2;2,4\na;tap;3;3\n");
        assert_eq!(labels.rows.len(), 1);
        assert_eq!(labels.rows[0].extent, Extent::Secs(TimeSpan::new(1.2, 2.4)));
        assert_eq!(labels.warnings[0].at, Place::Line(3));
        assert!(labels.warnings[0].text.contains("`tap` is a point in time"));
    }

    #[test]
    fn mistakes_are_located() {
        let head = "clip\tstart\tstop\tclass\n";
        let cases = [
            ("", "file: expected a header line"),
            ("clip\tstart\tclass\n", "line 1: expected a column `stop`"),
            ("clip\tstart\tstop\n", "line 1: expected a column `class`"),
            ("clip\tclass\tclip\n", "a second column `clip`"),
            (
                &format!("{head}a\t9\t8\twalk"),
                "line 2, column 5: expected a stop after the start, 9",
            ),
            (
                &format!("{head}\na\tx\t9\twalk"),
                "line 3, column 3: expected a frame",
            ),
            (&format!("{head}a\t-3\t9\twalk"), "found `-3`"),
            (&format!("{head}a\t3.5\t9\twalk"), "found `3.5`"),
            (
                &format!("{head}a\t3\t99999999999999999999999\twalk"),
                "line 2, column 5",
            ),
            (
                &format!("{head}a\t3"),
                "line 2, column 4: expected a class, found nothing",
            ),
            (
                &format!("{head}a\t3\t9\t \n"),
                "expected a class, found nothing",
            ),
            (
                &format!("{head}\t3\t9\twalk\n"),
                "line 2, column 1: expected a clip's name",
            ),
            (
                "clip\tclass\tstart_secs\tstop_secs\na\tb\t1\tNaN",
                "line 2, column 7: expected seconds",
            ),
            (
                "clip,class,start_secs,stop_secs\na,b,\"1,5\",2",
                "seconds: a number, 0 or more, found `1,5`",
            ),
        ];
        for (text, message) in cases {
            assert!(fails(text).contains(message), "{text:?}: {}", fails(text));
        }
    }

    #[test]
    fn what_is_not_utf8_is_refused_with_its_line() {
        let error = Labels::read(b"clip\tclass\r\na\tb\r\na\t\xe9\n").unwrap_err();
        assert_eq!(error.at, Place::Line(3));
        assert!(
            Labels::read(b"\xff\xfec\0")
                .unwrap_err()
                .found
                .contains("UTF-16")
        );
    }

    #[test]
    fn cells_beyond_the_header_are_said() {
        let labels = read("clip\tclass\na\twalk\tsurplus\n");
        assert_eq!(labels.rows.len(), 1);
        assert_eq!(labels.warnings[0].at, Place::Column(2, 8));
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_give_labels_or_an_error(bytes in proptest::collection::vec(0u8..=255, 0..200)) {
            let _ = Labels::read(&bytes);
            let mut table = b"clip\tclass\tstart\tstop\n".to_vec();
            table.extend(bytes);
            let _ = Labels::read(&table);
        }
    }
}
