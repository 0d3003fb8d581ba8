//! Index a motion-capture database, recognise its motions live.

pub mod classes;
pub mod clip;
pub mod crossval;
pub mod decode;
pub mod eval;
pub mod features;
pub mod formats;
pub mod import;
pub mod index;
pub mod kinematics;
pub mod labels;
pub mod live;
pub mod math;
pub mod progress;
pub mod report;
pub mod resample;
pub mod roles;
pub mod synth;
pub mod templates;
pub mod train;
