//! Import: converts clips to metres with Y up, infers the joints of body parts (roles), and determines the kind of
//! performer. Every command reads clips through it, so that all see the same motion.
//!
//! Everything is inferred from the motion itself, never from the zero pose, which need not be a pose that anybody
//! ever stood in; and everything inferred can be overridden in [`ImportOptions`].
//!
//! ```
//! use mocap::roles::Role;
//! use mocap::{ImportOptions, import::normalize};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let bytes = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/mclip/v1.mclip"));
//! let clip = mocap::read(bytes, "push.mclip")?.clips.remove(0);
//! let take = normalize(clip, &ImportOptions::default())?;
//! let shin = take.roles.joint(Role::LeftShin).ok_or("no knee")?;      // the joint at its near end
//! println!("the left knee is {}", take.clip.skeleton.joints()[shin].name);
//! for (secs, pose) in take.poses() {                                    // as a live source would have sent them
//!     assert!(secs >= 0.0 && pose.get(Role::Head).is_some());
//! }
//! # Ok(())
//! # }
//! ```

mod axes;
mod body;
mod normalize;
mod options;
mod points;
mod report;
mod rest;
mod take;
mod travel;
mod units;

pub use crate::signed_axis::SignedAxis;
pub use normalize::normalize;
pub use options::{ImportOptions, Stated};
pub use report::ImportReport;
pub use rest::rest_frames;
pub use take::{Take, points_by_role};

#[cfg(test)]
mod tests;
