//! OpenSim: joint angles and the model that gives them a meaning.
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
use super::{Limits, ParseError, Warning};

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

#[cfg(test)]
mod tests;
