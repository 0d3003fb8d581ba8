//! A clip posed by other pose rows, to look at what a change of the rows does to the motion.

use mocap::clip::Clip;
use mocap::math::{Quat, same_hemisphere};
use morec_features::Rows;
use nalgebra::Quaternion;

use super::{PivotMap, PivotSet, PoseParams};

/// `clip` with its pivots turned as `rows` say, for example rows that were reduced to a few dimensions and brought back (thesis Eq. 3.10).
///
/// `rows` has `4 pivots` values a row, at the rate of `params` from the clip's first frame on; frames between two rows are turned in
/// between. Joints that are no pivots keep their rotation in their parent's frame; the root keeps its place and orientation, because
/// rows hold how it turns from frame to frame alone, and errors of turning would add up. A quaternion without length leaves its joint
/// as it is. O(frames · joints).
///
/// # Panics
/// If rows have another width.
pub fn clip_of_pose_rows(
    clip: &Clip,
    set: &PivotSet,
    map: &PivotMap,
    rows: &Rows,
    params: &PoseParams,
) -> Clip {
    assert_eq!(rows.dim(), 4 * set.len(), "a row of another width");
    let joints = clip.skeleton.joints();
    // Pivot of each joint, the root's left out.
    let mut pivot_of = vec![None; joints.len()];
    for pivot in 1..set.len() {
        if let Some(joint) = map.joint(pivot) {
            pivot_of[joint] = Some(pivot);
        }
    }
    let mut rebuilt = clip.clone();
    let mut world = vec![Quat::identity(); joints.len()];
    let mut pivots = vec![Quat::identity(); set.len()];
    for frame in 0..clip.frames {
        let place = frame as f64 / clip.rate_hz * params.rate_hz;
        let turns: Vec<Option<Quat>> = (0..set.len()).map(|p| turned(rows, place, p)).collect();
        let locals = &mut rebuilt.rotations[frame * joints.len()..][..joints.len()];
        for (joint, of) in joints.iter().enumerate() {
            let above = of.parent.map_or(Quat::identity(), |parent| world[parent]);
            world[joint] = above * locals[joint];
            if map.joint(0) == Some(joint) {
                pivots[0] = world[joint];
                for pivot in 1..set.len() {
                    let turn = turns[pivot].unwrap_or_else(Quat::identity);
                    pivots[pivot] = pivots[set.parent(pivot)] * turn;
                }
            }
            if let Some(pivot) = pivot_of[joint].filter(|pivot| turns[*pivot].is_some()) {
                world[joint] = pivots[pivot];
                locals[joint] = above.conjugate() * world[joint];
            }
        }
    }
    for at in joints.len()..rebuilt.rotations.len() {
        let before = rebuilt.rotations[at - joints.len()];
        rebuilt.rotations[at] = same_hemisphere(&before, rebuilt.rotations[at]);
    }
    rebuilt
}

/// The rotation of a pivot at `place`, counted in rows; `None` without rows, or if its quaternion has no length.
fn turned(rows: &Rows, place: f64, pivot: usize) -> Option<Quat> {
    let last = rows.len().checked_sub(1)?;
    let before = (place as usize).min(last);
    let share = (place - before as f64).clamp(0.0, 1.0) as f32;
    let [a, b] = [before, (before + 1).min(last)].map(|row| &rows.row(row)[4 * pivot..][..4]);
    let [w, i, j, k] = std::array::from_fn(|n| f64::from(a[n] + (b[n] - a[n]) * share));
    Quat::try_new(Quaternion::new(w, i, j, k), 1e-6)
}
