//! The person of each clip.

use std::collections::BTreeMap;

use super::table::Table;
use crate::formats::{ParseError, Warning};

/// A table of people.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct People {
    /// Person by clip name.
    pub by_clip: BTreeMap<String, String>,
    /// Omissions and oddities.
    pub warnings: Vec<Warning>,
}

/// Reads a table with the columns `clip` and `person`. A clip named twice keeps its last person, with a warning
/// if the two differ. A clip without a person is left out.
///
/// # Errors
/// An empty table, a missing or repeated column, or a row without a clip, with its place.
pub fn read_people(bytes: &[u8]) -> Result<People, ParseError> {
    let table = Table::new(bytes)?;
    let (clip, person) = (table.need("clip")?, table.need("person")?);
    // Tables of whole clips carry these as well; they are no mistake here.
    let mut warnings = table.unknown_columns(&["clip", "person", "class", "style"]);
    let (rows, too_long) = table.rows();
    warnings.extend(too_long);
    let mut by_clip = BTreeMap::new();
    for row in &rows {
        let name = row.text(clip, "a clip's name")?;
        let who = row.cell(person).to_owned();
        if who.is_empty() {
            continue;
        }
        let before = by_clip.insert(name.clone(), who.clone());
        if let Some(before) = before.filter(|b| *b != who) {
            let text =
                format!("{name} was assigned to {before} before; now it is assigned to {who}");
            warnings.push(Warning::new(row.place(person), text));
        }
    }
    Ok(People { by_clip, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Labels;

    #[test]
    fn people_fill_the_gaps_of_labels() {
        let people = read_people(b"clip\tperson\na\tx\nb\ty\nb\tz\nc\t\n").unwrap();
        assert_eq!(people.by_clip["b"], "z");
        assert!(!people.by_clip.contains_key("c"));
        assert!(
            people.warnings[0]
                .to_string()
                .starts_with("line 4, column 3: b was assigned to y")
        );
        let mut labels =
            Labels::read(b"clip\tclass\tperson\na\twave\t\na\twave\tother\nd\twave\n").unwrap();
        labels.add_people(&people);
        let persons: Vec<_> = labels.rows.iter().map(|r| r.person.as_deref()).collect();
        assert_eq!(persons, [Some("x"), Some("other"), None]);
    }
}
