//! Roles: the joint of each body part in a skeleton.

mod check;
mod find;
mod fingers;
mod languages;
mod limbs;
pub mod mapping;
mod meaning;
mod names;
mod pairs;
pub mod points;
#[doc(hidden)] // What the diagnosis of streams in `morec` shares with the finding of roles.
pub mod proportions;
mod sides;
mod tree;
mod trunk;
mod words;

pub use crate::role::{ARMS, BODY_LINES, LEGS, Role, RoleMap};
pub use check::check;
#[cfg(feature = "formats")]
pub(crate) use check::check_named;
pub use find::{find, find_moving};
#[cfg(feature = "formats")]
pub(crate) use find::{find_named, zero_pose};
#[cfg(feature = "formats")]
pub(crate) use names::JointNames;
pub use pairs::RolesFound;

#[cfg(test)]
mod tests;
