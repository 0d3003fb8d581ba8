//! Search by vectors that a user has computed: a table of embeddings ranks clips by their cosine to one of them.

use std::collections::BTreeMap;

use morec::TimeSpan;
use morec::formats::{ParseError, Place};
use morec::labels::names_of_clip;

use crate::exchange::{records, separator, text};
use crate::{ClipId, ClipInfo, DbError};

/// Named vectors of one length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EmbeddingTable {
    rows: Vec<(String, Vec<f64>)>,
}

/// A clip with its likeness to a vector.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EmbeddingHit {
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Its name.
    #[serde(rename = "clip")]
    pub clip_name: String,
    /// All of it.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// The cosine of both vectors, -1 to 1; 0 if one of them is zero.
    pub score: f64,
}

/// What a vector is like.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EmbeddingHits {
    /// The nearest first.
    pub hits: Vec<EmbeddingHit>,
    /// Number of rows that are of no clip of the database.
    #[serde(skip)]
    pub absent: usize,
}

impl EmbeddingTable {
    /// Reads a table: a name and numbers in each line, separated by commas, tabs or semicolons. A first line without numbers has the names
    /// of columns.
    ///
    /// # Errors
    /// The line where something else was expected.
    pub fn read(bytes: &[u8]) -> Result<Self, ParseError> {
        let text = text(bytes)?;
        let mut rows: Vec<(String, Vec<f64>)> = Vec::new();
        for (at, (line, cells)) in records(text, separator(text))?.into_iter().enumerate() {
            let numbers = cells[1..].iter().map(|cell| cell.trim().parse::<f64>());
            let numbers: Option<Vec<f64>> = numbers.map(Result::ok).collect();
            let vector = numbers.filter(|all| !all.is_empty() && all.iter().all(|v| v.is_finite()));
            let width = rows.first().map(|(_, first)| first.len());
            match vector {
                Some(vector) if width.is_none_or(|width| width == vector.len()) => {
                    rows.push((cells[0].trim().to_owned(), vector));
                }
                None if at == 0 => {}
                found => {
                    let width = width.map_or_else(String::new, |width| format!("{width} "));
                    let found = found.map_or_else(|| cells.join(" "), |v| v.len().to_string());
                    let expected = format!("a name and {width}finite numbers");
                    return Err(ParseError::new(Place::Line(line), expected, found));
                }
            }
        }
        match rows.is_empty() {
            true => Err(ParseError::new(
                Place::File,
                "a name and numbers in each line",
                "none",
            )),
            false => Ok(Self { rows }),
        }
    }

    /// The clips whose vectors are most like the one called `like`, `limit` at most: a vector of `queries`, else of this table, whose own
    /// clip is then left out. O(rows · numbers).
    ///
    /// # Errors
    /// No vector is called so, or it has another length.
    pub fn nearest(
        &self,
        clips: &[ClipInfo],
        like: &str,
        queries: Option<&Self>,
        limit: usize,
    ) -> Result<EmbeddingHits, DbError> {
        let named = |(name, _): &&(String, Vec<f64>)| name == like;
        let wanted = queries.unwrap_or(self).rows.iter().find(named);
        let (_, wanted) = wanted.ok_or_else(|| DbError::unknown("embedding", like))?;
        let (expected, found) = (self.rows[0].1.len(), wanted.len());
        if expected != found {
            let text =
                format!("{like}: expected {expected} numbers as in the table, found {found}");
            return Err(DbError::Invalid(text));
        }
        let known: BTreeMap<&str, &ClipInfo> = clips
            .iter()
            .map(|clip| (clip.name.as_str(), clip))
            .collect();
        let (mut hits, mut absent) = (Vec::new(), 0);
        for (name, vector) in &self.rows {
            let Some(clip) = names_of_clip(name).find_map(|name| known.get(name)) else {
                absent += 1;
                continue;
            };
            if queries.is_some() || name != like {
                hits.push(EmbeddingHit {
                    clip: clip.id,
                    clip_name: clip.name.clone(),
                    span: TimeSpan::new(0.0, clip.duration_secs()),
                    score: cosine(vector, wanted),
                });
            }
        }
        hits.sort_by(|a, b| {
            let scores = b.score.total_cmp(&a.score);
            scores.then_with(|| a.clip_name.cmp(&b.clip_name))
        });
        hits.truncate(limit);
        Ok(EmbeddingHits { hits, absent })
    }
}

fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let sizes = (dot(a, a) * dot(b, b)).sqrt();
    if sizes > 0.0 { dot(a, b) / sizes } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_with_and_without_a_header_are_read_and_others_refused_with_their_line() {
        let table = EmbeddingTable::read(b"clip\tx\ty\na\t1\t0\nb\t0.5\t-2e1\n").unwrap();
        let plain = EmbeddingTable::read(b"a,1,0\nb,0.5,-20\n").unwrap();
        assert_eq!(table, plain);
        assert_eq!(plain.rows[1], ("b".to_owned(), vec![0.5, -20.0]));
        for (text, line) in [
            ("a,1,0\nb,1\n", "line 2"),
            ("a,1,0\nb,1,nan\n", "line 2"),
            ("clip,x\na,one\n", "line 2"),
            ("clip,x\n", "none"),
        ] {
            let error = EmbeddingTable::read(text.as_bytes())
                .unwrap_err()
                .to_string();
            assert!(error.contains(line), "{text}: {error}");
        }
    }
}
