//! OpenSim: joint angles, and the model that defines them.
//!
//! A motion (`.mot`, `.sto`) is a table of coordinates, one for each way in which a joint of a model (`.osim`) turns or slides. The
//! model says where each body hangs in another and how the joint between them follows its coordinates (*OpenSim User's Guide*,
//! "OpenSim Models"; Seth et al., *Minimal formulation of joint motion for biomechanisms*, 2010). Bodies become the joints of the
//! clip: the origin of `tibia_r` is the right knee.

mod function;
mod model;
mod motion;
mod values;

pub use self::model::OsimModel;
pub use self::motion::read_motion;
use super::descriptor::{FormatDescriptor, FormatInput};
use super::head::Head;
use super::{Limits, ParseError, Warning};
use crate::math::Axis;

pub(super) const MOTION: FormatDescriptor = FormatDescriptor {
    name: "opensim_motion",
    title: "OpenSim motion",
    noun: "an OpenSim motion",
    endings: &["mot", "sto"],
    looks_so: |h| !h.is_binary() && is_table(h) && !has_markers(h),
    up: Some(Axis::Y),
    read: |_| Err(FormatInput::lacks("the model (.osim) beside it")),
};

pub(super) const MODEL: FormatDescriptor = FormatDescriptor {
    name: "opensim_model",
    title: "OpenSim model",
    noun: "an OpenSim model",
    endings: &["osim"],
    looks_so: |h| h.starts("<") && h.contains(b"<OpenSimDocument"),
    up: None,
    read: |_| Err(FormatInput::lacks("a motion (.mot, .sto) of it")),
};

/// Reads a model, as OpenSim 2 to 4 write it. Muscles, markers, masses and shapes are skipped.
///
/// # Errors
/// The place and the cause: no well-formed XML, no bodies, a joint or function of a kind that is not read, a joint between bodies that are not
/// there, more than `limits` allow. O(bytes).
pub fn read_model(bytes: &[u8], limits: &Limits) -> Result<(OsimModel, Vec<Warning>), ParseError> {
    // Elements of a model; the largest have a hundred thousand, for muscles and shapes.
    const MOST_NODES: usize = 1 << 20;
    let text = super::xml::text_of(bytes)?;
    let limits = super::xml::limits_beside(&text, limits)?;
    let document = super::xml::parse(&text, MOST_NODES)?;
    model::of_document(&document, &limits)
}

/// A header that ends in `endheader`, or has its keys.
pub(super) fn is_table(head: &Head) -> bool {
    let bare = |line: &[u8]| {
        let end = line
            .iter()
            .rposition(|b| !matches!(b, b',' | b';' | b'\t' | b' '));
        line[..end.map_or(0, |end| end + 1)].to_ascii_lowercase()
    };
    let mut keys = 0;
    for line in head.lines().take(200) {
        let line = bare(line);
        keys += usize::from(
            line.starts_with(b"nrows")
                || line.starts_with(b"ncolumns")
                || line.starts_with(b"datacolumns"),
        );
        if line == b"endheader" || keys == 2 {
            return !head.is_binary();
        }
    }
    false
}

/// True if such a table holds places of several markers, `R.ASIS_tx`, and no orientations: those of bodies are of their centres of
/// mass, which are no joints.
pub(super) fn has_markers(head: &Head) -> bool {
    const LEAST: usize = 5;
    let mut lines = head
        .lines()
        .skip_while(|line| !line.eq_ignore_ascii_case(b"endheader"));
    let names = lines.nth(1).unwrap_or_default().to_ascii_lowercase();
    let ends = |end: &[u8]| {
        let columns = names.split(|b| matches!(b, b'\t' | b',' | b' '));
        columns.filter(|name| name.ends_with(end)).count()
    };
    ends(b"_tx").max(ends(b"_x")) >= LEAST && ends(b"_ox") == 0
}

#[cfg(test)]
mod tests;
