//! Names that are not there, and the ones that may have been meant.

use std::cmp::Reverse;

use rusqlite::Connection;

use crate::{DbError, MotionDb};

/// Bytes in the name of a class or a clip: with what is escaped of it and an ending it is still a file's.
pub(crate) const LONGEST: usize = 200;

/// Most names listed when none is similar.
const LISTED: usize = 8;

/// Most similar names offered.
const OFFERED: usize = 3;

/// Hint for a name that is not among `known`, to be put behind a sentence: the nearest ones, or some of them and how
/// many more there are.
pub fn hint(name: &str, known: &[String]) -> String {
    if known.is_empty() {
        return "; there is none".to_owned();
    }
    let wanted = name.to_lowercase();
    let mut near: Vec<(usize, bool, &String)> = known
        .iter()
        .map(|other| {
            let other_lower = other.to_lowercase();
            let apart = strsim::damerau_levenshtein(&wanted, &other_lower);
            let part = !wanted.is_empty() && other_lower.contains(&wanted);
            (apart, part, other)
        })
        .filter(|(apart, part, _)| *part || *apart <= (wanted.chars().count() / 3).max(1))
        .collect();
    near.sort_by_key(|(apart, part, name)| (Reverse(*part && *apart < 2), *apart, *name));
    if near.is_empty() {
        let shown: Vec<&str> = known.iter().take(LISTED).map(String::as_str).collect();
        let more = match known.len().saturating_sub(LISTED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        return format!("; there are {}{more}", shown.join(", "));
    }
    let offered: Vec<String> = near
        .iter()
        .take(OFFERED)
        .map(|(_, _, name)| format!("`{name}`"))
        .collect();
    format!("; did you mean {}?", offered.join(" or "))
}

fn column(conn: &Connection, sql: &str) -> Result<Vec<String>, DbError> {
    let mut statement = conn.prepare(sql)?;
    Ok(statement
        .query_map([], |row| row.get(0))?
        .collect::<Result<_, _>>()?)
}

/// The error for a name of this kind that is not there.
pub(crate) fn unknown(conn: &Connection, kind: &'static str, name: &str) -> DbError {
    let sql = match kind {
        "clip" => "SELECT name FROM clips ORDER BY name",
        "class" => "SELECT name FROM classes ORDER BY name",
        "index" => "SELECT name FROM indexes ORDER BY name",
        "person" => "SELECT DISTINCT subject FROM clips WHERE subject IS NOT NULL ORDER BY 1",
        "tag" => "SELECT DISTINCT tag FROM tags ORDER BY 1",
        _ => return DbError::unknown(kind, name),
    };
    match column(conn, sql) {
        Err(error) => error,
        Ok(known) => DbError::Unknown {
            kind,
            name: name.to_owned(),
            hint: hint(name, &known),
        },
    }
}

impl MotionDb {
    /// Checks that there is a class of this name.
    ///
    /// # Errors
    /// [`DbError::Unknown`] with the nearest names.
    pub fn need_class(&self, name: &str) -> Result<(), DbError> {
        let sql = "SELECT 1 FROM classes WHERE name = ?1";
        match self.conn.prepare(sql)?.exists([name])? {
            true => Ok(()),
            false => Err(unknown(&self.conn, "class", name)),
        }
    }

    /// Hint for a clip that is not there: the nearest names, after a semicolon.
    pub fn hint_of_clip(&self, name: &str) -> String {
        match unknown(&self.conn, "clip", name) {
            DbError::Unknown { hint, .. } => hint,
            _ => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::hint;

    fn known(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn the_nearest_names_are_offered() {
        let names = known(&["signals_1", "signals_2", "signals_3", "walk", "Jump"]);
        assert_eq!(
            hint("signal_3", &names),
            "; did you mean `signals_3` or `signals_1` or `signals_2`?"
        );
        assert_eq!(hint("jmup", &names), "; did you mean `Jump`?");
        assert_eq!(hint("wlak", &names), "; did you mean `walk`?");
        assert!(hint("crouch", &names).starts_with("; there are signals_1, "));
        assert_eq!(hint("x", &[]), "; there is none");
    }

    #[test]
    fn a_long_list_says_how_long_it_is() {
        let names: Vec<String> = (0..30).map(|n| format!("class number {n}")).collect();
        let hint = hint("zzzzzz", &names);
        assert!(hint.ends_with("and 22 more"), "{hint}");
    }

    #[test]
    fn a_part_of_a_name_is_near() {
        let names = known(&["hands_up_slow", "walk"]);
        assert_eq!(hint("hands", &names), "; did you mean `hands_up_slow`?");
    }
}
