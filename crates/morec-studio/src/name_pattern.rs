//! Class and person in the names of clips, by a pattern: `{person}_{class}_{}`.
//!
//! A pattern with slashes is one of the clip's file with its folders: `{class}/{person}_{}`. The class takes as much as it can, all
//! else as little: `u01_uppercut_right_0` is `uppercut_right` by `u01`.

use std::collections::BTreeMap;

use morec_db::ClipInfo;

#[derive(Debug, Clone, PartialEq, Eq)]
enum PatternPart {
    Text(String),
    Person,
    Class,
    Any,
}

/// A pattern of names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamePattern {
    parts: Vec<PatternPart>,
    /// Number of folders that belong to the name.
    folders: usize,
}

/// What a name says.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NamedParts {
    pub person: Option<String>,
    pub class: Option<String>,
}

impl NamePattern {
    /// The pattern of a text.
    ///
    /// # Errors
    /// What is wrong with it, in a sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        let mut rest = text.trim();
        while !rest.is_empty() {
            let Some(open) = rest.find('{') else {
                parts.push(PatternPart::Text(rest.to_owned()));
                break;
            };
            if open > 0 {
                parts.push(PatternPart::Text(rest[..open].to_owned()));
            }
            let close = rest.find('}').filter(|close| *close > open);
            let close = close.ok_or("A brace { is not closed")?;
            let part = match rest[open + 1..close].trim() {
                "person" => PatternPart::Person,
                "class" => PatternPart::Class,
                "" => PatternPart::Any,
                other => {
                    return Err(format!(
                        "{{{other}}}: expected {{class}}, {{person}} or {{}}"
                    ));
                }
            };
            parts.push(part);
            rest = &rest[close + 1..];
        }
        let is_text = |part: &PatternPart| matches!(part, PatternPart::Text(_));
        if parts.windows(2).any(|p| !is_text(&p[0]) && !is_text(&p[1])) {
            return Err("Separate parts in braces by text".to_owned());
        }
        if !parts.contains(&PatternPart::Class) && !parts.contains(&PatternPart::Person) {
            return Err("Expected {class}, {person} or both".to_owned());
        }
        let folders = text.matches('/').count();
        Ok(Self { parts, folders })
    }

    /// What the name of a clip says; `None` if it does not fit.
    pub fn read(&self, clip: &ClipInfo) -> Option<NamedParts> {
        let named = match self.folders {
            0 => clip.name.clone(),
            folders => tail(&clip.path, folders)?,
        };
        let mut found = NamedParts::default();
        fits(&self.parts, &named, &mut found).then_some(found)
    }
}

/// The end of a path with this many folders, without the file's ending.
fn tail(path: &str, folders: usize) -> Option<String> {
    let parts: Vec<&str> = path.split(['/', '\\']).collect();
    let from = parts.len().checked_sub(folders + 1)?;
    let joined = parts[from..].join("/");
    let name_at = joined.rfind('/').map_or(0, |at| at + 1);
    let end = joined[name_at..].rfind('.').map(|at| name_at + at);
    Some(joined[..end.unwrap_or(joined.len())].to_owned())
}

fn fits(parts: &[PatternPart], text: &str, found: &mut NamedParts) -> bool {
    let Some((part, rest)) = parts.split_first() else {
        return text.is_empty();
    };
    if let PatternPart::Text(expected) = part {
        let after = text.strip_prefix(expected.as_str());
        return after.is_some_and(|after| fits(rest, after, found));
    }
    let ends = text.char_indices().map(|(at, sign)| at + sign.len_utf8());
    let mut ends: Vec<usize> = ends.collect();
    if *part == PatternPart::Class {
        ends.reverse();
    }
    for end in ends {
        if fits(rest, &text[end..], found) {
            let value = || Some(text[..end].to_owned());
            match part {
                PatternPart::Person => found.person = value(),
                PatternPart::Class => found.class = value(),
                _ => {}
            }
            return true;
        }
    }
    false
}

/// The pattern that most of the names may have.
pub fn guess<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut shapes: BTreeMap<(char, usize, bool), usize> = BTreeMap::new();
    for name in names {
        let parted = ['_', '-', ' ']
            .into_iter()
            .find(|sign| name.contains(*sign));
        let sign = parted.unwrap_or('_');
        let last = name.rsplit(sign).next().unwrap_or_default();
        let numbered = last.chars().all(|c| c.is_ascii_digit());
        let count = name.split(sign).count().min(3);
        *shapes.entry((sign, count, numbered)).or_default() += 1;
    }
    let most = shapes.into_iter().max_by_key(|(_, count)| *count);
    let Some(((sign, count, numbered), _)) = most else {
        return "{class}".to_owned();
    };
    let parts: &[&str] = match (count, numbered) {
        (3, true) => &["{person}", "{class}", "{}"],
        (2 | 3, false) => &["{person}", "{class}"],
        (2, true) => &["{class}", "{}"],
        _ => &["{class}"],
    };
    parts.join(&sign.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(pattern: &str, name: &str) -> Option<(Option<String>, Option<String>)> {
        let pattern = NamePattern::parse(pattern).unwrap();
        let mut found = NamedParts::default();
        fits(&pattern.parts, name, &mut found).then_some((found.person, found.class))
    }

    fn both(person: &str, class: &str) -> Option<(Option<String>, Option<String>)> {
        Some((Some(person.to_owned()), Some(class.to_owned())))
    }

    #[test]
    fn class_and_person_are_read_where_they_stand() {
        let pattern = "{person}_{class}_{}";
        assert_eq!(read(pattern, "ada_wave_1"), both("ada", "wave"));
        assert_eq!(
            read(pattern, "u01_uppercut_right_0"),
            both("u01", "uppercut_right")
        );
        assert_eq!(read(pattern, "ada_wave"), None);
        assert_eq!(
            read("{class}-{}", "wave-3"),
            Some((None, Some("wave".to_owned())))
        );
        assert_eq!(
            read("take {person}: {class}", "take Zoë: jump"),
            both("Zoë", "jump")
        );
        assert_eq!(
            tail("/data/wave/ada_1.bvh", 1).as_deref(),
            Some("wave/ada_1")
        );
        assert_eq!(
            read("{class}/{person}_{}", "wave/ada_1"),
            both("ada", "wave")
        );
    }

    #[test]
    fn what_is_no_pattern_says_why() {
        for (text, why) in [
            ("{class", "not closed"),
            ("{who}_{class}", "{who}"),
            ("{person}{class}", "by text"),
            ("take_{}", "Expected"),
            ("", "Expected"),
        ] {
            let said = NamePattern::parse(text).unwrap_err();
            assert!(said.contains(why), "{text}: {said}");
        }
    }

    #[test]
    fn the_pattern_of_most_names_is_guessed() {
        let guessed = |names: &[&str]| guess(names.iter().copied());
        assert_eq!(
            guessed(&["u01_kick_0", "u02_side_kick_1", "x"]),
            "{person}_{class}_{}"
        );
        assert_eq!(guessed(&["wave_1", "wave_2"]), "{class}_{}");
        assert_eq!(guessed(&["ada-wave", "ben-bow"]), "{person}-{class}");
        assert_eq!(guessed(&["wave"]), "{class}");
        assert_eq!(guessed(&[]), "{class}");
    }
}
