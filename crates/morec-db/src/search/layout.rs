//! One layout for feature rows of any set of bones, and its mirror image, so that all clips can be compared.

use morec::features::{BoneSet, FeatureParams, RowLayout, Rows, mirrored_rows, opposite_bone};

/// Values in a laid-out row: directions and velocities of every bone, then the root.
pub const DIM: usize = RowLayout::BODY.dim();
/// Weight of root motion in kept rows.
pub const ROOT_WEIGHT: f64 = FeatureParams::ROOT_WEIGHT;

/// Rows over all bones of the body; those that a clip does not show are 0. Hands are not searched.
#[derive(Debug, Clone)]
pub struct CanonicalRows {
    pub rows: Rows,
    pub bones: BoneSet,
}

/// Puts the columns of `bones` where those of all bones lie.
pub fn to_canonical(rows: &Rows, bones: BoneSet) -> CanonicalRows {
    let from = RowLayout::of(bones);
    let to = RowLayout::BODY;
    let mut out = Rows::new(DIM);
    let mut laid = [0f32; DIM];
    for row in rows.iter() {
        laid.fill(0.0);
        let of_body = |(_, bone): &(usize, usize)| BoneSet::BODY.contains(*bone);
        for (slot, bone) in bones.indices().enumerate().filter(of_body) {
            laid[to.direction(bone)].copy_from_slice(&row[from.direction(slot)]);
            laid[to.velocity(bone)].copy_from_slice(&row[from.velocity(slot)]);
        }
        laid[to.root()].copy_from_slice(&row[from.root()]);
        out.push(&laid);
    }
    CanonicalRows {
        rows: out,
        bones: bones.and(BoneSet::BODY),
    }
}

/// The columns of the directions of `bones`.
pub fn directions(bones: BoneSet) -> Vec<usize> {
    bones
        .indices()
        .flat_map(|bone| RowLayout::BODY.direction(bone))
        .collect()
}

/// The columns of `bones` and the root: what two clips can be compared by.
pub fn shared_columns(bones: BoneSet) -> Vec<usize> {
    RowLayout::kept_columns(BoneSet::BODY, bones)
}

/// Rows of the mirror image of the performer.
pub fn mirrored(laid: &CanonicalRows) -> CanonicalRows {
    let bones = opposite_bones(laid.bones);
    // Every bone has its opposite among all.
    let rows = mirrored_rows(&laid.rows, BoneSet::BODY).unwrap_or_else(|| Rows::new(DIM));
    CanonicalRows { rows, bones }
}

/// Bones of the mirror image of a skeleton with `bones`.
pub fn opposite_bones(bones: BoneSet) -> BoneSet {
    bones
        .indices()
        .map(opposite_bone)
        .fold(BoneSet::NONE, BoneSet::with)
}
