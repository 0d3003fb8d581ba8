//! Events of C3D recordings as labels: a stretch from `NAME start` to the `NAME end` behind it, else from an event to the next of its name,
//! as strides lie between the strikes of a foot.

use morec::formats::c3d::read_time;
use morec::formats::{ParseError, Place, Warning};

use super::annotation::{Annotation, ReadLabels};

/// True of a C3D recording.
pub(super) fn is_c3d(bytes: &[u8]) -> bool {
    bytes.len() >= 512 && matches!(bytes, [1..128, 0x50, ..])
}

/// The stretches between the events of a recording, labels of `clip`. Events without another one are left out with a warning.
pub(super) fn read(bytes: &[u8], clip: &str) -> Result<ReadLabels, ParseError> {
    let events = read_time(bytes)?.events;
    let mut read = ReadLabels::default();
    if events.is_empty() {
        return Err(ParseError::new(
            Place::File,
            "events in the C3D file",
            "none",
        ));
    }
    for (at, (start, name)) in events.iter().enumerate() {
        let behind = &events[at + 1..];
        let (class, next) = match ends(name, &[" start", " begin", " on", "_start", "_on"]) {
            Some(class) => {
                let is_end = |name: &str| {
                    ends(name, &[" end", " stop", " off", "_end", "_off"]) == Some(class)
                };
                (class, behind.iter().find(|(_, name)| is_end(name)))
            }
            None => (name.as_str(), behind.iter().find(|(_, next)| next == name)),
        };
        match next {
            Some((stop, _)) if stop > start && *start >= 0.0 => {
                read.annotations
                    .push(Annotation::accepted(clip, class, (*start, *stop)));
            }
            _ => {
                let text =
                    format!("`{name}` at {start:.3} s is not followed by another event; left out");
                read.warnings.push(Warning::new(Place::File, text));
            }
        }
    }
    Ok(read)
}

/// What is before one of these endings, in any case.
fn ends<'a>(name: &'a str, endings: &[&str]) -> Option<&'a str> {
    endings.iter().find_map(|ending| {
        let cut = name.len().checked_sub(ending.len())?;
        name.get(cut..)
            .filter(|end| end.eq_ignore_ascii_case(ending))?;
        Some(&name[..cut])
    })
}
