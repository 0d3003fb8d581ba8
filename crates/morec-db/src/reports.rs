//! Reports of trainings, cross-validations and learning curves, the last of each kind.

use rusqlite::{OptionalExtension, params};
use serde_json::Value;

use crate::time::now_secs;
use crate::{DbError, MotionDb};

/// Number of reports of each kind that are kept; older ones go.
pub const REPORTS_KEPT: usize = 100;

/// Subject of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReportKind {
    /// The training of an index.
    Training,
    /// A cross-validation.
    Crossval,
    /// A learning curve.
    Curve,
}

impl ReportKind {
    /// Name in the database and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Training => "training",
            Self::Crossval => "crossval",
            Self::Curve => "curve",
        }
    }

    /// Name in lists.
    pub fn title(self) -> &'static str {
        match self {
            Self::Training => "training",
            Self::Crossval => "cross-validation",
            Self::Curve => "learning curve",
        }
    }
}

/// A report without its contents.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ReportInfo {
    /// Number of the report in this database.
    pub id: i64,
    /// Its subject.
    pub kind: ReportKind,
    /// Time at which it was made, seconds since 1970.
    pub made_secs: i64,
    /// Its result in a line.
    pub title: String,
}

impl MotionDb {
    /// Keeps a report, and as many before it of its kind as make [`REPORTS_KEPT`]. It is no step of the history. Gives its number.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn keep_report(
        &mut self,
        kind: ReportKind,
        title: &str,
        report: &Value,
    ) -> Result<i64, DbError> {
        let tx = self.write()?;
        tx.execute(
            "INSERT INTO reports (kind, made_secs, title, report) VALUES (?1, ?2, ?3, ?4)",
            params![kind.name(), now_secs(), title, report.to_string()],
        )?;
        let id = tx.last_insert_rowid();
        tx.execute(
            "DELETE FROM reports WHERE kind = ?1 AND id NOT IN \
             (SELECT id FROM reports WHERE kind = ?1 ORDER BY id DESC LIMIT ?2)",
            params![kind.name(), REPORTS_KEPT as i64],
        )?;
        tx.commit()?;
        Ok(id)
    }

    /// All reports that are kept, the last first.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn reports(&self) -> Result<Vec<ReportInfo>, DbError> {
        let sql = "SELECT id, kind, made_secs, title FROM reports ORDER BY id DESC";
        let mut statement = self.conn.prepare(sql)?;
        let reports = statement.query_map([], |row| {
            let kind: String = row.get("kind")?;
            Ok(ReportInfo {
                id: row.get("id")?,
                kind: match kind.as_str() {
                    "crossval" => ReportKind::Crossval,
                    "curve" => ReportKind::Curve,
                    _ => ReportKind::Training,
                },
                made_secs: row.get("made_secs")?,
                title: row.get("title")?,
            })
        })?;
        Ok(reports.collect::<Result<_, _>>()?)
    }

    /// Contents of a report, as they were given to [`keep_report`](Self::keep_report).
    ///
    /// # Errors
    /// There is none of this number, or it is not JSON: the file is damaged.
    pub fn report(&self, id: i64) -> Result<Value, DbError> {
        let sql = "SELECT report FROM reports WHERE id = ?1";
        let found: Option<String> = self
            .conn
            .query_row(sql, params![id], |row| row.get(0))
            .optional()?;
        let text = found.ok_or_else(|| DbError::unknown("report", &id.to_string()))?;
        serde_json::from_str(&text)
            .map_err(|error| DbError::Damaged(format!("report {id}: {error}")))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_last_hundred_of_each_kind_are_kept_and_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("moves.mdb");
        let mut db = MotionDb::create(&path).unwrap();
        let first = db.keep_report(ReportKind::Crossval, "before all", &json!({"f1": 0.5}));
        let first = first.unwrap();
        for number in 0..REPORTS_KEPT + 5 {
            let title = format!("training {number}");
            db.keep_report(ReportKind::Training, &title, &json!({"number": number}))
                .unwrap();
        }
        drop(db);
        let db = MotionDb::open_read_only(&path).unwrap();
        let reports = db.reports().unwrap();
        let of = |kind| reports.iter().filter(move |r| r.kind == kind);
        assert_eq!(of(ReportKind::Training).count(), REPORTS_KEPT);
        assert_eq!(reports[0].title, "training 104", "the last first");
        let oldest = of(ReportKind::Training).next_back().unwrap();
        assert_eq!(oldest.title, "training 5");
        assert_eq!(db.report(oldest.id).unwrap(), json!({"number": 5}));
        assert_eq!(of(ReportKind::Crossval).count(), 1, "another kind");
        assert_eq!(db.report(first).unwrap(), json!({"f1": 0.5}));
        let error = db.report(first + 1).unwrap_err().to_string();
        assert!(error.contains("report"), "{error}");
        assert!(db.history().unwrap().is_empty(), "no steps of the history");
    }
}
