//! Motion-capture files: reading, writing, and telling them apart.
//!
//! Readers take bytes, never paths. What can be saved is loaded with a [`Warning`] that names the place; what
//! cannot is refused with a [`ParseError`] that says where, what was expected and what was found.

pub mod acclaim;
mod builder;
pub mod bvh;
pub mod c3d;
mod cells;
pub mod container;
pub mod csm;
pub mod deepmimic;
mod descriptor;
#[cfg(feature = "fbx")]
pub mod fbx;
mod fbx_format;
pub mod gltf;
mod head;
pub mod htr;
mod json;
pub mod jsonl;
mod keys;
pub mod landmarks;
mod loaded;
#[cfg(test)]
pub(crate) mod mangle;
pub mod mclip;
pub mod mocopi;
pub mod mvnx;
mod npy;
pub mod ntu;
pub mod numpy;
pub mod opensim;
mod points;
pub mod probe;
mod scene;
pub mod smd;
pub mod smpl;
pub mod table;
mod timing;
pub mod trc;
mod xml;

use crate::math::Axis;
pub use crate::parse_error::{ParseError, Place, Warning};
use descriptor::FormatDescriptor;
pub use descriptor::{Beside, FormatInput};
pub use loaded::{Limits, Loaded};
pub use points::from_positions;

/// A format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Format {
    /// Biovision: skeleton and motion in one file.
    Bvh,
    /// Acclaim skeleton, for motions in [`Format::Amc`].
    Asf,
    /// Acclaim motion of an [`Format::Asf`] skeleton.
    Amc,
    /// The stored form of a compressed clip ([`smooth`](crate::smooth)).
    Mclip,
    /// Points of biomechanics, binary.
    C3d,
    /// Points as tab-separated text.
    Trc,
    /// Lines of JSON, a pose in each.
    Jsonl,
    /// A table of positions, CSV or TSV.
    Table,
    /// Xsens suits, XML.
    Mvnx,
    /// glTF 2.0, binary or text, VRM and VRMA among it.
    Gltf,
    /// Autodesk's exchange of scenes, binary or text.
    Fbx,
    /// A NumPy archive of SMPL poses, as AMASS has them.
    Smpl,
    /// Recorded packets of mocopi.
    Mocopi,
    /// Joints of Kinect v2 as text, as NTU RGB+D has them.
    NtuSkeleton,
    /// JSON with a list of points in each frame.
    Landmarks,
    /// Positions in NumPy arrays.
    Numpy,
    /// Skeletal animation of the Source engine, text.
    Smd,
    /// Skeletal motion of Motion Analysis, text.
    Htr,
    /// Markers of Character Studio, text.
    Csm,
    /// Joint angles of OpenSim, for a [`Format::OpenSimModel`].
    OpenSimMotion,
    /// A model of OpenSim.
    OpenSimModel,
    /// Motion of DeepMimic's humanoid, JSON.
    DeepMimic,
}

/// Every format that is read, in the order in which its content is asked for.
const READ: &[(Format, FormatDescriptor)] = &[
    (Format::Mclip, mclip::FORMAT),
    (Format::Bvh, bvh::FORMAT),
    (Format::Asf, acclaim::ASF),
    (Format::Amc, acclaim::AMC),
    (Format::Fbx, fbx_format::FORMAT),
    (Format::Gltf, gltf::FORMAT),
    (Format::Mvnx, mvnx::FORMAT),
    (Format::Smpl, smpl::FORMAT),
    (Format::Mocopi, mocopi::FORMAT),
    (Format::Trc, trc::FORMAT),
    (Format::C3d, c3d::FORMAT),
    (Format::Jsonl, jsonl::FORMAT),
    (Format::NtuSkeleton, ntu::FORMAT),
    (Format::DeepMimic, deepmimic::FORMAT),
    (Format::Landmarks, landmarks::FORMAT),
    (Format::Numpy, numpy::FORMAT),
    (Format::Smd, smd::FORMAT),
    (Format::Htr, htr::FORMAT),
    (Format::Csm, csm::FORMAT),
    (Format::OpenSimMotion, opensim::MOTION),
    (Format::OpenSimModel, opensim::MODEL),
    (Format::Table, table::FORMAT),
];

impl Format {
    /// Its name in tables and databases; never changes.
    pub fn name(self) -> &'static str {
        self.descriptor().name
    }

    /// What it is called in tables for people: `BVH`.
    pub fn title(self) -> &'static str {
        self.descriptor().title
    }

    /// What a file of it is called within a sentence: `a BVH clip`.
    pub fn noun(self) -> &'static str {
        self.descriptor().noun
    }

    /// The axis that is up in all of its files by its specification, which says as well that lengths are metres.
    pub(crate) fn up(self) -> Option<Axis> {
        self.descriptor().up
    }

    /// True of skeletons that are read for the motions beside them.
    pub fn is_skeleton(self) -> bool {
        matches!(self, Format::Asf | Format::OpenSimModel)
    }

    /// Reads a file of it.
    ///
    /// # Errors
    /// The place, what was expected and what was found; a format of which a file needs another one beside it.
    pub fn read(self, file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
        (self.descriptor().read)(file)
    }

    fn descriptor(self) -> &'static FormatDescriptor {
        let own = READ.iter().find(|(format, _)| *format == self);
        // Every format has one: the structural tests count them.
        &own.unwrap_or(&READ[0]).1
    }
}
