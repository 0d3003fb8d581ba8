//! Index a motion-capture database, recognise its motions live.
#![doc = ""]
pub mod clip;
pub mod formats;
pub mod import;
pub mod kinematics;
pub mod math;
pub mod resample;
pub mod roles;
