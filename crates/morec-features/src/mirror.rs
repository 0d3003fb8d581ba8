//! The mirror image of feature rows.

use crate::layout::RowLayout;
use crate::rows::Rows;
use crate::{ALL_BONES, BoneKind, BoneSet};

/// The bone of [`ALL_BONES`] on the other side of the body; the same for bones of the middle.
pub fn opposite_bone(bone: usize) -> usize {
    let name = ALL_BONES[bone].name;
    let other = match (name.strip_prefix("left_"), name.strip_prefix("right_")) {
        (Some(rest), _) => format!("right_{rest}"),
        (_, Some(rest)) => format!("left_{rest}"),
        _ if name.contains("left") => name.replace("left", "right"),
        _ => name.replace("right", "left"),
    };
    let place = ALL_BONES.iter().position(|b| b.name == other);
    place.unwrap_or(bone)
}

/// The direction of `bone` in a mirror beside the performer, of that of its opposite, both (lateral, up, forward).
///
/// A line that goes from left to right, as that of the shoulders, has an image that runs the other way: its lateral part stays and
/// the others turn. A hand and its mirror image have the same coordinates in the frames of their palms; the normal of a palm is no
/// line of points, and its image is that of the other palm.
pub fn reflected_direction(bone: usize, of_opposite: &[f32]) -> [f32; 3] {
    let bone = &ALL_BONES[bone];
    if matches!(bone.kind, BoneKind::Finger(_)) {
        return [of_opposite[0], of_opposite[1], of_opposite[2]];
    }
    let crosses = bone.hand().is_none() && bone.from.opposite() == bone.to;
    let sign = if crosses { -1.0 } else { 1.0 };
    [
        -sign * of_opposite[0],
        sign * of_opposite[1],
        sign * of_opposite[2],
    ]
}

/// Feature rows over `bones` of the mirror image of a motion: left and right exchanged, lateral components and turning
/// reversed. `None` if `bones` hold a bone without its opposite. O(values).
pub fn mirrored_rows(rows: &Rows, bones: BoneSet) -> Option<Rows> {
    let present: Vec<usize> = bones.indices().collect();
    let slot_of = |bone: usize| present.iter().position(|b| *b == bone);
    let opposite: Option<Vec<usize>> = present
        .iter()
        .map(|bone| slot_of(opposite_bone(*bone)))
        .collect();
    let opposite = opposite?;
    let layout = RowLayout::of(bones);
    let mut out = Rows::new(rows.dim());
    let mut image = vec![0f32; rows.dim()];
    for row in rows.iter() {
        for (slot, bone) in present.iter().enumerate() {
            for place in [RowLayout::direction, RowLayout::velocity] {
                let seen = reflected_direction(*bone, &row[place(layout, opposite[slot])]);
                image[place(layout, slot)].copy_from_slice(&seen);
            }
        }
        let [lateral, up, forward, turning] = [0, 1, 2, 3].map(|i| row[layout.root()][i]);
        image[layout.root()].copy_from_slice(&[-lateral, up, forward, -turning]);
        out.push(&image);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bone_without_its_opposite_has_no_mirror_image() {
        let left_arm = BoneSet::NONE.with(6);
        assert!(mirrored_rows(&Rows::new(10), left_arm).is_none());
    }
}
