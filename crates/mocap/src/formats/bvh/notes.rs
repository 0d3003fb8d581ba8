//! Warnings that are given once, with a count, however often the cause occurs in a file.

use crate::formats::{Place, Warning};

/// Findings so far, in the order of first notice.
#[derive(Debug, Default)]
pub(super) struct Notes {
    entries: Vec<Entry>,
}

#[derive(Debug)]
struct Entry {
    kind: &'static str,
    first: Warning,
    count: u64,
    last: Place,
}

impl Notes {
    /// Adds a warning that stands alone.
    pub fn add(&mut self, at: Place, text: impl Into<String>) {
        self.entries.push(Entry {
            kind: "",
            first: Warning::new(at, text),
            count: 1,
            last: at,
        });
    }

    /// Adds one of possibly many of `kind`: the first is kept word for word, the others are counted.
    pub fn count(&mut self, kind: &'static str, line: u64, text: impl FnOnce() -> String) {
        let at = Place::Line(line);
        match self.entries.iter_mut().find(|e| e.kind == kind) {
            Some(entry) => {
                entry.count += 1;
                entry.last = at;
            }
            None => {
                self.entries.push(Entry {
                    kind,
                    first: Warning::new(at, text()),
                    count: 1,
                    last: at,
                });
            }
        }
    }

    /// The warnings, each kind once.
    pub fn into_warnings(self) -> Vec<Warning> {
        self.entries.into_iter().map(Entry::into_warning).collect()
    }
}

impl Entry {
    fn into_warning(self) -> Warning {
        let Warning { at, text } = self.first;
        match self.count - 1 {
            0 => Warning { at, text },
            more => Warning {
                at,
                text: format!(
                    "{text} (and {more} more like it, the last on {})",
                    self.last
                ),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_said_once_with_its_count() {
        let mut notes = Notes::default();
        for line in 3..=1002 {
            notes.count("glued", line, || format!("numbers glued on {line}"));
        }
        notes.add(Place::File, "something else");
        let warnings = notes.into_warnings();
        assert_eq!(warnings.len(), 2);
        assert_eq!(
            warnings[0].to_string(),
            "line 3: numbers glued on 3 (and 999 more like it, the last on line 1002)"
        );
    }
}
