//! Errors of reading an index.

/// Why bytes are not a usable index.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum IndexError {
    /// Another kind of file, or one cut off inside its header.
    #[error("not a morec index, or an incomplete file: {0}")]
    Foreign(String),
    /// Written by a later release.
    #[error(
        "the index has version {found}, this morec reads versions up to {INDEX_VERSION}: use a newer morec"
    )]
    Newer {
        /// The file's version.
        found: u32,
    },
    /// Trained by a method this release does not have.
    #[error(
        "the index was trained by the method {0:?}, which this morec does not have: use a newer morec"
    )]
    Method(String),
    /// The bytes are not those that were written.
    #[error(
        "the index is damaged: its checksum is {found:08x}, the file states {expected:08x}; train it again or restore a \
        copy"
    )]
    Checksum {
        /// The checksum that the file states.
        expected: u32,
        /// The checksum of its bytes.
        found: u32,
    },
    /// Parts that do not fit together.
    #[error("damaged: {0}")]
    Content(String),
}

/// Version of index files that this program writes, and the newest it reads.
pub const INDEX_VERSION: u32 = 1;
