//! Acclaim's pair of formats: a skeleton (ASF) that serves many motions (AMC).
//!
//! Sources: M. Schafer, "Acclaim Skeleton File Definition V1.10" (1995), and Oxford Metrics' "Acclaim Format:
//! ASF line details". What they leave open is decided as the CMU and HDM05 libraries need it:
//!
//! - A bone's rotation `M` is given about its own axes `C`, so that `parent_from_joint = C·M·C⁻¹`.
//! - A list of rotations is applied in the order in which it is written, about fixed axes: `rx ry rz` is
//!   `Rz·Ry·Rx`. This holds for the root's `order`, for `dof` and for `axis`.
//! - An Acclaim bone becomes the joint at its near end, which is the far end of its parent bone. A bone without
//!   children gives its joint a [`tip`](crate::clip::Joint::tip).
//! - Lengths stay in the file's own unit; [`Asf::metres_per_unit`] says what the header declares.

mod amc;
mod asf;
mod motion;
mod skeleton;
mod text;

pub use amc::{AmcOptions, DEFAULT_RATE_HZ, read_amc};
pub use asf::read_asf;
pub use skeleton::{AmcChannel, Asf, AsfBone, Root};

#[cfg(test)]
mod tests;
