//! Options of the import, and the units and axes that formats define.

use crate::formats::Format;
use crate::roles::mapping::Mapping;

use crate::signed_axis::SignedAxis;

/// Values given by the caller in place of inferred ones.
#[derive(Debug, Clone, Default)]
pub struct ImportOptions {
    /// The direction that is up in the file.
    pub up: Option<SignedAxis>,
    /// Metres in one of the file's units of length.
    pub metres_per_unit: Option<f64>,
    /// Number of frames at the start that show a rest pose instead of the motion.
    pub rest_frames: Option<usize>,
    /// Roles that override those found.
    pub mapping: Option<Mapping>,
    /// Unit and axis that the file's format states; used unless the body contradicts them.
    pub stated: Option<Stated>,
}

/// Unit of length and up axis, as the specification of a format, or a file itself, states them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stated {
    /// The direction that is up.
    pub up: SignedAxis,
    /// Metres in one unit of length.
    pub metres_per_unit: f64,
}

impl Stated {
    /// Unit and axis of all files of `format` by its specification; `None` for those that leave it to the writer.
    pub fn of(format: Format) -> Option<Self> {
        let stated = |axis| Self {
            up: SignedAxis {
                axis,
                negative: false,
            },
            metres_per_unit: 1.0,
        };
        format.up().map(stated)
    }
}
