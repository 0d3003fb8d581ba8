//! The second look: compares the whole motion around a match once with every training sample. It decides in indexes of
//! bodies; the template match only proposes candidates.
//!
//! A subsequence match explains only a part of a motion: a push is found inside a serve. The second look takes each match as a
//! candidate, finds the whole motion around it, compares that segment from end to end with the taught segments of
//! all classes ([`Comparison`]), names it after the nearest one, and accepts it by one score with one bound ([`LookDecoder`]). The
//! rows that are compared follow from feature rows alone ([`BodyTrack`]): stored clips, databases and live streams give the same.

mod body;
mod bounds;
mod comparison;
mod decoder;
mod extent;
mod mapped;
mod model;
mod segment;
#[cfg(test)]
mod tests;

pub use body::BodyTrack;
#[cfg(feature = "train")]
pub(crate) use comparison::NEAREST_OF_ATLAS;
pub use comparison::{Comparison, Judged};
pub use decoder::LookDecoder;
pub use model::SecondLook;
#[cfg(feature = "train")]
pub use segment::grown_of;
pub use segment::{SEGMENT_ROWS, sample_span, segment_of};

/// Values of a row of the second look over a whole body, see [`BodyTrack`].
pub const LOOK_COLUMNS: usize = 73;
