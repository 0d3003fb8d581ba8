//! OpenSim: joint angles and the model that gives them a meaning.
//!
//! A motion (`.mot`, `.sto`) is a table of coordinates, one for each way in which a joint of a model (`.osim`) turns or slides. The
//! model says where each body hangs in another and how the joint between them follows its coordinates (*OpenSim User's Guide*,
//! "OpenSim Models"; Seth et al., *Minimal formulation of joint motion for biomechanisms*, 2010). Bodies become the joints of the
//! clip: the origin of `tibia_r` is the right knee.

mod function;
mod model;
mod motion;

use roxmltree::Node;

pub use self::model::OsimModel;
pub use self::motion::read_motion;
use super::xml::{child, place};
use super::{Limits, ParseError, Warning};
use crate::math::Vec3;

/// Reads a model, as OpenSim 2 to 4 write it. Muscles, markers, masses and shapes are skipped.
///
/// # Errors
/// Where and what: no well-formed XML, no bodies, a joint or function of a kind that is not read, a joint between bodies that are not
/// there, more than `limits` allow. O(bytes).
pub fn read_model(bytes: &[u8], limits: &Limits) -> Result<(OsimModel, Vec<Warning>), ParseError> {
    // Elements that a model has for each of its joints, muscles and shapes among them.
    const NODES_A_JOINT: usize = 4096;
    let text = super::xml::text_of(bytes)?;
    let document = super::xml::parse(&text, limits.joints.saturating_mul(NODES_A_JOINT))?;
    model::of_document(&document, limits)
}

/// The numbers in the child `tag` of `node`; none without it.
///
/// # Errors
/// Something else than numbers, or not `count` of them.
fn numbers(node: Node<'_, '_>, tag: &str, count: Option<usize>) -> Result<Vec<f64>, ParseError> {
    let Some(holder) = child(node, tag) else {
        return Ok(Vec::new());
    };
    let text = holder.text().unwrap_or_default();
    let wrong = || {
        let expected = match count {
            Some(count) => format!("{count} numbers in <{tag}>"),
            None => format!("numbers in <{tag}>"),
        };
        ParseError::new(
            place(holder),
            expected,
            format!("`{}`", shortened(text.trim())),
        )
    };
    let parse = |word: &str| {
        fast_float2::parse::<f64, _>(word)
            .ok()
            .filter(|v| v.is_finite())
    };
    let found: Option<Vec<f64>> = text.split_ascii_whitespace().map(parse).collect();
    let found = found.ok_or_else(wrong)?;
    match count {
        Some(count) if found.len() != count => Err(wrong()),
        _ => Ok(found),
    }
}

/// The three numbers in the child `tag`; `None` without it.
fn vector(node: Node<'_, '_>, tag: &str) -> Result<Option<Vec3>, ParseError> {
    let found = numbers(node, tag, Some(3));
    match child(node, tag) {
        Some(_) => Ok(Some(Vec3::from_column_slice(&found?))),
        None => Ok(None),
    }
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests;
