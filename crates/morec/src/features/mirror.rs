//! The mirror image of feature rows.

use super::bones::{ALL_BONES, BoneSet};
use super::layout::RowLayout;
use super::rows::Rows;

/// The bone of [`ALL_BONES`] on the other side of the body; the same for bones of the middle.
pub fn opposite_bone(bone: usize) -> usize {
    let name = ALL_BONES[bone].name;
    let other = match name.split_once('_') {
        Some(("left", rest)) => format!("right_{rest}"),
        Some(("right", rest)) => format!("left_{rest}"),
        _ => return bone,
    };
    let place = ALL_BONES.iter().position(|b| b.name == other);
    place.unwrap_or(bone)
}

/// The direction of `bone` in a mirror beside the performer, of that of its opposite, both (lateral, up, forward).
///
/// The line of the shoulders goes from left to right: its image runs the other way, so its lateral part stays and the
/// others turn.
pub fn reflected_direction(bone: usize, of_opposite: &[f32]) -> [f32; 3] {
    let sign = if ALL_BONES[bone].name == "shoulder_line" {
        -1.0
    } else {
        1.0
    };
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
    use crate::features::{FeatureParams, FeatureStream, KeyPose, for_each_pose};
    use crate::perturb::mirrored;
    use crate::roles::RoleMap;
    use crate::synth::{Person, Script};

    fn rows(poses: &[(f64, KeyPose)]) -> Rows {
        let mut stream = FeatureStream::new(BoneSet::ALL, &FeatureParams::default());
        let mut rows = Rows::new(stream.dim());
        for (t, pose) in poses {
            stream.push(*t, pose, &mut |row| rows.push(row));
        }
        stream.finish(&mut |row| rows.push(row));
        rows
    }

    #[test]
    fn mirrored_rows_are_the_rows_of_a_mirrored_performer() {
        let take = Script::new(1, Person::draw(1, 0))
            .play("walk")
            .play("wave")
            .film("m", 60.0)
            .unwrap();
        let roles = RoleMap::find(&take.clip.skeleton);
        let mut poses = Vec::new();
        for_each_pose(&take.clip, &roles, &(0..0), |t, pose| {
            poses.push((t, *pose))
        });
        let image: Vec<(f64, KeyPose)> = poses.iter().map(|(t, p)| (*t, mirrored(p))).collect();
        let expected = rows(&image);
        let found = mirrored_rows(&rows(&poses), BoneSet::ALL).unwrap();
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.values().iter().zip(expected.values()) {
            assert!((a - b).abs() < 2e-3, "{a} and {b}");
        }
    }

    #[test]
    fn a_bone_without_its_opposite_has_no_mirror_image() {
        let left_arm = BoneSet::NONE.with(6);
        assert!(mirrored_rows(&Rows::new(10), left_arm).is_none());
    }
}
