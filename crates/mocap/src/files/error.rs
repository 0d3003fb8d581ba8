//! Errors of reading files.

use std::io;
use std::path::{Path, PathBuf};

use crate::formats::ParseError;

/// A file that cannot be used, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}: {kind}", path.display())]
pub struct FileError {
    /// The file, as it was named.
    pub path: PathBuf,
    /// Why. It is in the message, and so no source: reports that print the chain would say it twice.
    pub kind: Box<FileErrorKind>,
}

/// Why a file cannot be used; the fault is of the file itself unless another is named.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileErrorKind {
    /// It cannot be read from disk.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// It is not what it should be.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// A skeleton file cannot be opened.
    #[error("skeleton {}: {why}", path.display())]
    OpenSkeleton {
        /// Path of the skeleton.
        path: PathBuf,
        /// Error of the system.
        why: io::Error,
    },
    /// A skeleton file is not what it should be.
    #[error("skeleton {}: {why}", path.display())]
    Skeleton {
        /// Path of the skeleton.
        path: PathBuf,
        /// Place and cause.
        why: ParseError,
    },
    /// The motion is not what it should be, or not of this skeleton.
    #[error("with skeleton {}: {why}", skeleton.display())]
    Motion {
        /// Path of the skeleton.
        skeleton: PathBuf,
        /// Place and cause.
        why: ParseError,
    },
    /// There is no skeleton near an AMC motion.
    #[error(
        "an AMC motion needs its ASF skeleton, but its folder and the folders above contain none; name it with --skeleton"
    )]
    NoSkeleton,
    /// There is no model near an OpenSim motion.
    #[error(
        "OpenSim's joint angles (MOT, STO) need their model, but their folder and the folders above contain no .osim file; give \
         --skeleton MODEL.osim, or the TRC file that the angles were computed from"
    )]
    NoModel,
    /// An OpenSim model, which holds no motion.
    #[error("an OpenSim model without motion; give the MOT or STO file of joint angles")]
    OnlyModel,
    /// A file in a folder that holds motion in a format that is not read: its format and what to do.
    #[error("{0}")]
    NotRead(String),
    /// A folder in which no clip can be read, with the first reasons.
    #[error("no readable clip in this folder or its subfolders{0}")]
    NoClip(String),
}

impl FileErrorKind {
    /// True if the file was refused for the memory it needs: it may be read with more, or in parts.
    pub fn is_of_memory(&self) -> bool {
        match self {
            Self::Parse(why) | Self::Skeleton { why, .. } | Self::Motion { why, .. } => {
                why.is_of_memory()
            }
            _ => false,
        }
    }

    /// This error with the path of the file that it concerns.
    pub fn at(self, path: &Path) -> FileError {
        FileError {
            path: path.to_owned(),
            kind: Box::new(self),
        }
    }
}
