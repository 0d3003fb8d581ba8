//! More like this: what is like a stretch, and becomes labels by a click.

use crate::stretch::Stretch;

/// Commands for searching by example.
#[derive(Debug, Clone, PartialEq)]
pub enum SimilarCommand {
    /// Searches for what is like the selected stretch or label.
    OfSelection,
    /// Searches for what is like a stretch, of a class if it is a label.
    Of(Stretch, Option<String>),
    /// Searches for the mirror image, too.
    Mirror(bool),
    /// The hit of this place is of a class.
    Label(usize, String),
    /// Hits at least this like the example, percent, are labelled at once by the next.
    Alike(u8),
    /// All those hits are of a class.
    LabelAll(String),
    Close,
}
