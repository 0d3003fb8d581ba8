//! What all readers return, and room for it.

use crate::clip::Clip;
use crate::parse_error::{ParseError, Warning};

/// Room for `count` rows.
///
/// # Errors
/// The system has no memory for them.
pub(super) fn room<T>(count: usize) -> Result<Vec<T>, ParseError> {
    let mut rows = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    rows.try_reserve_exact(count)
        .map_err(|_| ParseError::of_memory(0, bytes))?;
    Ok(rows)
}

/// Result of reading a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// One clip for each character in the file, in file order.
    pub clips: Vec<Clip>,
    /// Repairs and doubts.
    pub warnings: Vec<Warning>,
}
