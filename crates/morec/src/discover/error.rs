//! Why sets cannot be found.

/// Why sets cannot be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages say it all.
pub enum DiscoverError {
    #[error("feature rows of {found} and of {expected} values: all clips must have the same bones")]
    Width { expected: usize, found: usize },
    #[error("expected feature rows of 6 values for each bone and 4 more, found rows of {0} values")]
    Layout(usize),
    #[error("the clips have no bone in common: choose clips of one kind of skeleton")]
    NoBones,
    #[error("the rate must be above 0 and at most 1000 rows a second, found {0}")]
    Rate(f64),
    #[error("row {row} of clip {clip} contains a value that is not finite")]
    NotFinite { clip: usize, row: usize },
    #[error("cancelled")]
    Cancelled,
}
