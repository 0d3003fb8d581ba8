//! The tables whose changes the history records, and restoring their rows. A new table whose changes can be undone is added here.

use rusqlite::{Connection, params};

use crate::DbError;

/// A table of the schema, its columns in the order of its triggers (`migrations/`).
pub struct Tracked {
    pub name: &'static str,
    /// Number of key columns, which stand first.
    pub keys: usize,
    pub columns: &'static [&'static str],
    /// A column that holds much; where it was not changed, the history says NULL.
    pub large: Option<usize>,
}

/// All of them.
pub const TRACKED: [Tracked; 11] = [
    Tracked {
        name: "files",
        keys: 1,
        columns: &[
            "id",
            "hash",
            "path",
            "skeleton_path",
            "format",
            "bytes",
            "imported_secs",
            "warnings",
        ],
        large: None,
    },
    Tracked {
        name: "file_copies",
        keys: 2,
        columns: &["file", "path"],
        large: None,
    },
    Tracked {
        name: "refused",
        keys: 1,
        columns: &["path", "reason", "tried_secs"],
        large: None,
    },
    Tracked {
        name: "clips",
        keys: 1,
        columns: &[
            "id",
            "name",
            "file",
            "character",
            "skeleton",
            "frames",
            "rate_hz",
            "rest_frames",
            "repaired_frames",
            "roles",
            "facts",
            "max_angle_rad",
            "max_position_metres",
            "source",
            "licence",
            "subject",
            "motion",
        ],
        large: Some(16),
    },
    Tracked {
        name: "tags",
        keys: 2,
        columns: &["clip", "tag"],
        large: None,
    },
    Tracked {
        name: "videos",
        keys: 1,
        columns: &["clip", "path", "offset_secs"],
        large: None,
    },
    Tracked {
        name: "segments",
        keys: 1,
        columns: &["id", "clip", "method", "kind", "start_secs", "stop_secs"],
        large: None,
    },
    Tracked {
        name: "classes",
        keys: 1,
        columns: &["id", "name"],
        large: None,
    },
    Tracked {
        name: "samples",
        keys: 1,
        columns: &[
            "id",
            "clip",
            "class",
            "start_secs",
            "stop_secs",
            "whole_clip",
            "state",
            "score",
            "set_by",
            "set_secs",
        ],
        large: None,
    },
    Tracked {
        name: "annotators",
        keys: 2,
        columns: &["sample", "annotator"],
        large: None,
    },
    Tracked {
        name: "indexes",
        keys: 1,
        columns: &["id", "name", "trained_secs", "samples", "bytes"],
        large: Some(4),
    },
];

/// The table of a name.
pub fn tracked(name: &str) -> Option<&'static Tracked> {
    TRACKED.iter().find(|table| table.name == name)
}

impl Tracked {
    /// Its columns without what is large.
    pub fn small(&self) -> impl Iterator<Item = (usize, &'static str)> + use<> {
        let large = self.large;
        let columns = self.columns.iter().copied().enumerate();
        columns.filter(move |(at, _)| Some(*at) != large)
    }

    /// `t.id = w.c0`, for the table as `t` and what was written down as `w`.
    pub fn same_row(&self) -> String {
        let keys = self.columns[..self.keys].iter().enumerate();
        let equal = keys.map(|(at, key)| format!("t.{key} = w.c{at}"));
        equal.collect::<Vec<_>>().join(" AND ")
    }

    /// Restores a row of this table to its content before the change numbered `seq`; `present` is whether the row exists now.
    pub fn restore(&self, conn: &Connection, seq: i64, present: bool) -> Result<(), DbError> {
        let (name, same) = (self.name, self.same_row());
        if !present {
            let sql = format!(
                "DELETE FROM {name} AS t WHERE EXISTS (SELECT 1 FROM was w WHERE w.seq = ?1 AND {same})"
            );
            conn.prepare_cached(&sql)?.execute(params![seq])?;
            return Ok(());
        }
        let values = self.columns.iter().enumerate().skip(self.keys);
        let set: Vec<String> = values
            .map(|(at, column)| match self.large == Some(at) {
                true => format!("{column} = coalesce(w.c{at}, t.{column})"),
                false => format!("{column} = w.c{at}"),
            })
            .collect();
        if !set.is_empty() {
            let set = set.join(", ");
            let sql =
                format!("UPDATE {name} AS t SET {set} FROM was w WHERE w.seq = ?1 AND {same}");
            if conn.prepare_cached(&sql)?.execute(params![seq])? > 0 {
                return Ok(());
            }
        }
        let columns = self.columns.join(", ");
        let from: Vec<String> = (0..self.columns.len()).map(|at| format!("c{at}")).collect();
        let sql = format!(
            "INSERT INTO {name} ({columns}) SELECT {} FROM was WHERE seq = ?1",
            from.join(", ")
        );
        conn.prepare_cached(&sql)?.execute(params![seq])?;
        Ok(())
    }
}
