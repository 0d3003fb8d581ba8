//! Index a motion-capture database, recognise its motions live.
#![doc = ""]
pub mod clip;
pub mod eval;
pub mod formats;
pub mod import;
pub mod kinematics;
pub mod labels;
pub mod math;
pub mod report;
pub mod resample;
pub mod roles;
