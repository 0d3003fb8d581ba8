//! Labels: which stretch of which clip is a sample of which class, and the tables that carry them.
//!
//! Every table is text in UTF-8, cells separated by tabs, names of the columns in the first line. Order of the
//! columns is free, unknown columns are left out with a warning; blank lines, comments (`#`), CRLF, a byte order mark, trailing
//! tabs, quotes, and semicolons or commas in place of tabs are taken as they come. Readers take bytes; a mistake names its line and column.
//!
//! - Labels ([`Labels::read`]): `clip`, `class`, then `start` and `stop` (frames, stop exclusive) or
//!   `start_secs` and `stop_secs`, or neither: the whole clip is one sample. `person` (who moves) and `annotator` (who labelled) if they are known.
//! - People ([`read_people`]): `clip`, `person`.
//! - Detections ([`read_detections`], [`FoundLine`]): what `morec recognize` writes.
//!
//! ```
//! use std::collections::BTreeMap;
//!
//! use morec::TimeSpan;
//! use morec::labels::{ClipLength, Labels};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let table = Labels::read(b"clip\tclass\tstart\tstop\na\twave\t30\t60\nb\twave\t0\t9\n")?;
//! let lengths = BTreeMap::from([("a".to_owned(), ClipLength { frames: 300, rate_hz: 30.0 })]);
//! let resolved = table.resolve(&lengths);
//! assert_eq!(resolved.samples[0].span, TimeSpan::new(1.0, 2.0));
//! assert_eq!(resolved.absent["b"], 1);                                  // a label of a clip that is not there
//! # Ok(())
//! # }
//! ```

mod budget;
mod doubt;
mod found;
mod ground_truth;
mod lengths;
mod mark;
mod names;
mod people;
mod read;
mod resolve;
mod shared;
mod table;

use crate::TimeSpan;
use crate::clip::Span;
use crate::formats::Warning;

pub use budget::{ClassBudget, ClassTransitions, PersonBudget, TimeBudget};
pub use doubt::{doubtful_unit, misspelled, said_absent};
pub use found::{FOUND_HEADER, FoundLine, FoundRow, FoundTable, ReportedAt, read_detections};
pub use ground_truth::{ClipDetection, GroundTruth, StreamInfo};
pub use lengths::{ClassLengths, class_lengths};
pub use mark::Mark;
pub use names::{hint, some_of};
pub use people::{People, read_people};
pub use resolve::{ClipLength, Resolved, Sample, names_of_clip};
pub use shared::SharedClips;

/// Extent of a label in its clip, as the table gives it.
#[derive(Debug, Clone, PartialEq)]
pub enum Extent {
    /// Frames at the clip's own rate, from 0, stop exclusive.
    Frames(Span),
    /// Seconds from the clip's beginning.
    Secs(TimeSpan),
    /// From the clip's first frame to its last.
    WholeClip,
}

/// One row of a table of labels.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The clip's name: the stem of its file.
    pub clip: String,
    /// Class of the motion.
    pub class: String,
    /// When it happens.
    pub extent: Extent,
    /// The person who moves, if the table names one.
    pub person: Option<String>,
    /// Who labelled it, if the table names somebody.
    pub annotator: Option<String>,
    /// The row's line in its file, from 1.
    pub line: u64,
}

/// A table of labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Labels {
    /// The rows in file order.
    pub rows: Vec<Label>,
    /// Omissions and oddities.
    pub warnings: Vec<Warning>,
}

impl Labels {
    /// Reads the table at `path`; see [`read`](Self::read).
    ///
    /// # Errors
    /// A file that cannot be read, or is no table of labels.
    #[cfg(feature = "files")]
    pub fn from_path(path: impl AsRef<std::path::Path>) -> Result<Self, crate::files::FileError> {
        let path = path.as_ref();
        let read = || Ok(Self::read(&crate::files::read_file(path)?)?);
        read().map_err(|kind: crate::files::FileErrorKind| kind.at(path))
    }

    /// Adds a label: in the clip of that name, `class` happens in `span`: `1.2..2.5`, in seconds.
    pub fn add(&mut self, clip: &str, class: &str, span: impl Into<TimeSpan>) {
        self.rows.push(Label {
            clip: clip.to_owned(),
            class: class.to_owned(),
            extent: Extent::Secs(span.into()),
            person: None,
            annotator: None,
            line: self.rows.len() as u64 + 1,
        });
    }

    /// Gives each row without a person the one that `people` names for its clip.
    pub fn add_people(&mut self, people: &People) {
        for row in self.rows.iter_mut().filter(|r| r.person.is_none()) {
            row.person = people.by_clip.get(&row.clip).cloned();
        }
    }
}
