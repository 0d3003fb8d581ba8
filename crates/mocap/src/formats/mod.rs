//! Motion-capture file formats: reading, writing, and recognising them. Readers take bytes and never open files; paths are
//! handled in [`files`](crate::files).
//!
//! Readers take bytes, never paths. What can be saved is loaded with a [`Warning`] that names the place; what
//! cannot is refused with a [`ParseError`] that says where, what was expected and what was found.
//!
//! ```
//! use mocap::formats::{Limits, from_positions};
//! use mocap::math::Vec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let head = "HIERARCHY\nROOT Hips {\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site { OFFSET 0 10 0 } }\n";
//! let cut = format!("{head}MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n90 0\n");
//! let file = mocap::read(cut.as_bytes(), "turn.bvh")?;                // as much as can be saved, and what could not
//! assert_eq!(file.clips[0].frames, 1);
//! assert!(file.warnings[0].to_string().starts_with("line 10: an incomplete last line"));
//! let error = mocap::read(b"HIERARCHY\nROOT Hips {\nOFFSET 0 up 0\n", "turn.bvh").unwrap_err();
//! assert!(error.to_string().contains("line 3"), "{error}");            // where, what was expected and what was found
//!
//! // What an application has in memory becomes a clip by the same way: points with names, in metres.
//! let wrist = (0..60).map(|t| Vec3::new(0.0, 1.0 + 0.01 * f64::from(t), 0.0)).collect();
//! let loaded = from_positions("lift", 30.0, vec![("left_wrist".to_owned(), wrist)], Some(1.0), &Limits::default())?;
//! assert_eq!((loaded.clips[0].frames, loaded.clips[0].duration_secs()), (60, 2.0));
//! # Ok(())
//! # }
//! ```

pub mod acclaim;
mod builder;
pub mod bvh;
pub mod c3d;
mod cells;
pub mod container;
pub mod csm;
pub mod deepmimic;
mod descriptor;
mod encoding;
#[cfg(feature = "fbx")]
pub mod fbx;
mod fbx_format;
pub mod gltf;
#[cfg(feature = "hdf5")]
pub mod hdf5;
mod hdf5_format;
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

pub use crate::limits::Limits;
use crate::math::Axis;
pub use crate::parse_error::{ParseError, Place, Warning};
use descriptor::FormatDescriptor;
pub use descriptor::{Beside, FormatInput};
pub use loaded::Loaded;
#[cfg(feature = "files")]
pub(crate) use points::IN_A_PICTURE;
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
    /// Poses of DeepLabCut, SLEAP and NWB in HDF5.
    Hdf5,
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
    (Format::Hdf5, hdf5_format::FORMAT),
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
