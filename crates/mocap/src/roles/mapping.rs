//! Mapping files, in which the user assigns roles.
//!
//! Text, one role a line: the role's name, a tab, the joint's name as the clip spells it, blanks and all (the
//! first of that name). `-` gives the role to no joint. Roles that are not named keep what was found. Empty lines
//! and lines that begin with `#` are skipped.
//!
//! Names between `+` stand for the middle of these joints or markers: `left_knee<TAB>LKNE+LKNM`. Names that differ in
//! subject, marks and case alone are taken, too. Some roles have a second name: `left_hip`, `left_knee`, `left_ankle`,
//! `left_elbow` and `left_wrist` are the thigh, shin, foot, forearm and hand, `pelvis` the hips.
//!
//! What is no person is a custom skeleton: `point_1` is its root, `point_2` to `point_8` are points in the middle, `left_point_1` to
//! `left_point_8` and `right_point_1` to `right_point_8` points that a mirror exchanges. A file that names one of these gives nobody
//! the parts of a body that it does not name.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::points::{PointJoint, recognise, said};
use super::{Role, RoleMap};
use crate::clip::Skeleton;
use crate::parse_error::{self, ParseError};

/// The lines of a mapping file: each role at most once. Serialised as a table from roles to joints (`null`: no joint has the role); the text of a file is read too.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "MappingValue", into = "MappingValue")]
pub struct Mapping {
    entries: Vec<MappingEntry>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct MappingEntry {
    line: u64,
    role: Role,
    joint: Option<String>,
}

/// A mapping as a value of a configuration.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum MappingValue {
    Table(BTreeMap<String, Option<String>>),
    Text(String),
}

impl TryFrom<MappingValue> for Mapping {
    type Error = ParseError;

    fn try_from(value: MappingValue) -> Result<Self, ParseError> {
        let text = match value {
            MappingValue::Table(table) => {
                let line = |(role, joint): (String, Option<String>)| {
                    format!("{role}\t{}\n", joint.as_deref().unwrap_or("-"))
                };
                table.into_iter().map(line).collect()
            }
            MappingValue::Text(text) => text,
        };
        Self::read(text.as_bytes())
    }
}

impl From<Mapping> for MappingValue {
    fn from(mapping: Mapping) -> Self {
        let entries = mapping.entries.into_iter();
        MappingValue::Table(
            entries
                .map(|e| (e.role.name().to_owned(), e.joint))
                .collect(),
        )
    }
}

impl Mapping {
    /// Reads a mapping file.
    ///
    /// # Errors
    /// Text that is not UTF-8, a line without a tab, an unknown role, a role named twice, no joint's name.
    pub fn read(bytes: &[u8]) -> Result<Self, ParseError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            ParseError::new(
                parse_error::Place::Byte(error.valid_up_to() as u64),
                "UTF-8",
                "other bytes",
            )
        })?;
        let mut entries: Vec<MappingEntry> = Vec::new();
        for (line, content) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            if content.trim().is_empty() || content.starts_with('#') {
                continue;
            }
            let entry = entry(line, content)?;
            if let Some(before) = entries.iter().find(|e| e.role == entry.role) {
                let found = format!("{} here and on line {}", entry.role, before.line);
                return Err(ParseError::new(
                    parse_error::Place::Line(line),
                    "each role once",
                    found,
                ));
            }
            entries.push(entry);
        }
        Ok(Self { entries })
    }

    /// True if it names no role.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// True if it says what the points of a custom skeleton are.
    pub fn is_custom(&self) -> bool {
        let is_custom = |entry: &MappingEntry| entry.role.is_custom() && entry.joint.is_some();
        self.entries.iter().any(is_custom)
    }

    /// For each role that is named, the place that plays it among joints of these names, or `None` for nobody.
    ///
    /// # Errors
    /// A joint that is not there, with its line in the mapping file.
    pub fn places(&self, names: &[&str]) -> Result<Vec<(Role, Option<PointJoint>)>, ParseError> {
        let mut places = Vec::with_capacity(self.entries.len());
        for MappingEntry { line, role, joint } in &self.entries {
            let place = match joint {
                None => None,
                Some(text) => Some(said(text, names).map_err(|name| {
                    let at = parse_error::Place::Line(*line);
                    ParseError::new(at, "a joint of the skeleton", format!("`{name}`"))
                })?),
            };
            places.push((*role, place));
        }
        Ok(places)
    }

    /// Overrides what was found, by single joints.
    ///
    /// # Errors
    /// A joint that `skeleton` does not have, with its line in the mapping file; `map` is then unchanged.
    pub fn apply(&self, skeleton: &Skeleton, map: &mut RoleMap) -> Result<(), ParseError> {
        let mut changed = map.clone();
        for MappingEntry { line, role, joint } in &self.entries {
            let joint = match joint {
                None => None,
                Some(name) => Some(skeleton.find(name).ok_or_else(|| {
                    ParseError::new(
                        parse_error::Place::Line(*line),
                        "a joint of the skeleton",
                        format!("`{name}`"),
                    )
                })?),
            };
            changed.set(*role, joint);
        }
        *map = changed;
        Ok(())
    }
}

fn entry(line: u64, content: &str) -> Result<MappingEntry, ParseError> {
    let at = parse_error::Place::Line(line);
    let (role, joint) = content.split_once('\t').ok_or_else(|| {
        ParseError::new(
            at,
            "a role, a tab and a joint's name",
            format!("`{content}`"),
        )
    })?;
    let role = role_of(role.trim()).ok_or_else(|| {
        let known: Vec<_> = Role::ALL.iter().map(|r| r.name()).collect();
        ParseError::new(
            at,
            format!("a role ({})", known.join(", ")),
            format!("`{}`", role.trim()),
        )
    })?;
    match joint.trim() {
        "" => Err(ParseError::new(
            at,
            format!("a joint's name or - for {role}"),
            "nothing",
        )),
        "-" => Ok(MappingEntry {
            line,
            role,
            joint: None,
        }),
        name => Ok(MappingEntry {
            line,
            role,
            joint: Some(name.to_owned()),
        }),
    }
}

/// The role of a name in a mapping file.
fn role_of(name: &str) -> Option<Role> {
    const SECOND: [(&str, &str); 5] = [
        ("hip", "thigh"),
        ("knee", "shin"),
        ("ankle", "foot"),
        ("elbow", "forearm"),
        ("wrist", "hand"),
    ];
    let second = || match name.split_once('_') {
        None => (name == "pelvis").then_some(Role::Hips),
        Some((side, joint)) => {
            let (_, role) = SECOND.iter().find(|(second, _)| *second == joint)?;
            Role::from_name(&format!("{side}_{role}"))
        }
    };
    Role::from_name(name).or_else(second)
}

/// Writes `map` as a mapping file that names every role of a person, and the points of a custom skeleton.
pub fn write(map: &RoleMap, skeleton: &Skeleton) -> String {
    let mut text = String::from("# role\tjoint (- for none)\n");
    let is_optional = |role: &Role| role.is_custom() || *role == Role::Face;
    let is_named = |role: &Role| !is_optional(role) || map.joint(*role).is_some();
    for role in Role::ALL.into_iter().filter(is_named) {
        let name = map
            .joint(role)
            .map_or("-", |joint| skeleton.joints()[joint].name.as_str());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{role}\t{name}");
    }
    text
}

/// Markers that make each role, beside those of known sets, for people who name theirs otherwise.
const MADE_BY: [(&str, &str); 9] = [
    (
        "hips",
        "the pelvis, as LASI+RASI+LPSI+RPSI or LASI+RASI+SACR",
    ),
    (
        "thigh",
        "the hip joint: computed from the pelvis, else the trochanter (GTR) or a joint centre (HJC)",
    ),
    (
        "shin",
        "the knee: both sides of it, as KNE+KNM or LFE+MFE, or one",
    ),
    (
        "foot",
        "the ankle: both sides of it, as ANK+ANM or LMAL+MMAL, or one",
    ),
    ("arm", "the shoulder: SHO or the acromion ACR"),
    (
        "forearm",
        "the elbow: both sides of it, as ELB+ELM or LEL+MEL, or one",
    ),
    (
        "hand",
        "the wrist: both sides of it, as WRA+WRB or RAD+ULN, or one",
    ),
    ("neck", "C7+CLAV or C7"),
    ("head", "the middle of the head, as LFHD+RFHD+LBHD+RBHD"),
];

/// A mapping file to start from for points of these names: the roles that are found in their names, and for each of the others which
/// markers would make it, to be filled in. Lines that wait for that are comments.
pub fn template(names: &[&str]) -> String {
    let found = recognise(names);
    let known = found.as_ref().map_or("none", |found| found.set);
    let mut text = format!(
        "# Roles for `--roles`. A role, a tab, and a marker, or markers between + for their middle; - for none.\n# Known set: {known}\n"
    );
    let roles = found.map_or_else(Vec::new, |found| found.roles);
    let mut used = Vec::new();
    for role in Role::BODY {
        let place = roles
            .iter()
            .find(|(known, _)| *known == role)
            .map(|(_, place)| place);
        let bare = role
            .name()
            .trim_start_matches("left_")
            .trim_start_matches("right_");
        let made_by = MADE_BY.iter().find(|(made, _)| *made == bare);
        // Writing to a string cannot fail.
        let _ = match (place, made_by) {
            (Some(place), _) => {
                used.extend(place.points());
                let of: Vec<&str> = place.points().iter().map(|&point| names[point]).collect();
                let is_middle = match place {
                    PointJoint::Point(_) => true,
                    PointJoint::Middle(parts) => parts.iter().all(|part| part.single().is_some()),
                    PointJoint::HipCentre { .. } => false,
                };
                match is_middle {
                    true => writeln!(text, "{role}\t{}", of.join("+")),
                    false => writeln!(text, "# {role} is computed from {}", of.join(", ")),
                }
            }
            (None, Some((_, how))) => writeln!(text, "# {role}\t{how}"),
            (None, None) => Ok(()),
        };
    }
    let others = (0..names.len()).filter(|point| !used.contains(point));
    let others: Vec<&str> = others.map(|point| names[point]).collect();
    if !others.is_empty() {
        let _ = writeln!(text, "# Markers without a role: {}", others.join(", "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_is_read_back_and_says_what_is_missing() {
        let names = [
            "LASI", "RASI", "LPSI", "RPSI", "LKNE", "LKNM", "RKNE", "RKNM", "LANK", "RANK", "LSHO",
            "RSHO", "M7",
        ];
        let text = template(&names);
        assert!(text.contains("\nhips\tLASI+RASI+LPSI+RPSI\n"), "{text}");
        assert!(text.contains("\nleft_shin\tLKNE+LKNM\n"), "{text}");
        assert!(
            text.contains("# left_thigh is computed from LASI"),
            "{text}"
        );
        assert!(text.contains("# left_hand\tthe wrist"), "{text}");
        assert!(text.contains("without a role: M7"), "{text}");
        let mapping = Mapping::read(text.as_bytes()).unwrap();
        let places = mapping.places(&names).unwrap();
        assert!(places.iter().all(|(_, place)| place.is_some()), "{text}");
        let unknown = template(&["B1", "B2", "B3"]);
        assert!(unknown.contains("Known set: none"), "{unknown}");
        assert!(
            Mapping::read(unknown.as_bytes())
                .unwrap()
                .places(&["B1"])
                .unwrap()
                .is_empty()
        );
    }
}
