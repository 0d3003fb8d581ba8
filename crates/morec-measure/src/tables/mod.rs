//! Clips as tables of numbers for NumPy and spreadsheets: joint positions, joint rotations and feature rows, with names,
//! units and rate included.
//!
//! Tables are made of imported clips: metres, Y up, right-handed; rotations are quaternions `x, y, z, w` that take the
//! joint's own frame to its parent's; times are seconds.
//!
//! ```
//! use morec::Take;
//! use morec::synth::{DatabaseSpec, database};
//! use morec_measure::tables::{Content, write_csv};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let take = Take::new(database(1, &DatabaseSpec { people: 1, ..Default::default() }).remove(0).clip)?;
//! let mut csv = Vec::new();
//! write_csv(&take, Content::Positions, &mut csv)?;
//! assert_eq!(csv.iter().filter(|byte| **byte == b'\n').count(), take.clip.frames + 1);   // and a header
//! # Ok(())
//! # }
//! ```

mod csv;
mod npz;

pub use csv::{Content, write as write_csv};
pub use npz::write as write_npz;

use morec::clip::Clip;
use morec::features::{FeatureParams, RowLayout, Rows, bones_of_clip, rows_of_clip};
use morec::import::Take;
use morec::kinematics::WorldPose;

/// The feature rows of a clip with the name of each column.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    /// Name of each column: `left_thigh.direction.x`.
    pub names: Vec<String>,
    /// Rows, the first of which ends at one over [`rate_hz`](Self::rate_hz) seconds.
    pub rows: Rows,
    /// Rows a second.
    pub rate_hz: f64,
}

impl Features {
    /// The rows over the bones that `take` shows, by the usual parameters. `None` where no heading is known: without
    /// hip joints there are no rows.
    pub fn of(take: &Take) -> Option<Self> {
        let Take {
            clip,
            roles,
            report,
            ..
        } = take;
        let params = FeatureParams::default();
        let bones = bones_of_clip(clip, roles, &report.rest_frames);
        if bones.is_empty() || clip.frames == 0 {
            return None;
        }
        let rows = rows_of_clip(clip, roles, &report.rest_frames, bones, &params);
        (!rows.is_empty()).then(|| Self {
            names: RowLayout::column_names(bones),
            rows,
            rate_hz: params.tick_hz(),
        })
    }
}

/// Calls `each` with the number and the world pose of every frame.
fn for_each_frame(
    clip: &Clip,
    mut each: impl FnMut(usize, &WorldPose) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let mut pose = WorldPose::default();
    for frame in 0..clip.frames {
        pose.set(clip, frame);
        each(frame, &pose)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
