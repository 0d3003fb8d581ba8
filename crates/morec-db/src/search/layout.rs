//! One layout for rows of any set of bones, and its mirror image.

use morec::features::{BONES, BoneSet, FeatureParams, Rows, mirrored_rows, opposite_bone};

/// Values in a laid-out row: directions and velocities of every bone, then the root.
pub const DIM: usize = 6 * BONES + 4;
/// How kept rows weigh root motion.
pub const ROOT_WEIGHT: f64 = FeatureParams::ROOT_WEIGHT;

/// Rows over all bones; those that a clip does not show are 0.
#[derive(Debug, Clone)]
pub struct CanonicalRows {
    pub rows: Rows,
    pub bones: BoneSet,
}

/// Puts the columns of `bones` where those of all bones lie.
pub fn to_canonical(rows: &Rows, bones: BoneSet) -> CanonicalRows {
    let present: Vec<usize> = bones.indices().collect();
    let b = present.len();
    let mut out = Rows::new(DIM);
    let mut laid = [0f32; DIM];
    for row in rows.iter() {
        laid.fill(0.0);
        for (at, bone) in present.iter().enumerate() {
            for block in 0..2 {
                let (from, to) = (3 * (block * b + at), 3 * (block * BONES + bone));
                laid[to..to + 3].copy_from_slice(&row[from..from + 3]);
            }
        }
        laid[6 * BONES..].copy_from_slice(&row[6 * b..]);
        out.push(&laid);
    }
    CanonicalRows { rows: out, bones }
}

/// The columns of the directions of `bones`.
pub fn directions(bones: BoneSet) -> Vec<usize> {
    bones.indices().flat_map(|b| 3 * b..3 * b + 3).collect()
}

/// The columns of `bones` and the root: what two clips can be compared by.
pub fn shared_columns(bones: BoneSet) -> Vec<usize> {
    let of_block = |block: usize| {
        bones
            .indices()
            .flat_map(move |b| (0..3).map(move |i| 3 * (block * BONES + b) + i))
    };
    of_block(0)
        .chain(of_block(1))
        .chain(6 * BONES..DIM)
        .collect()
}

/// What a mirror beside the performer shows.
pub fn mirrored(laid: &CanonicalRows) -> CanonicalRows {
    let bones = opposite_bones(laid.bones);
    // Every bone has its opposite among all.
    let rows = mirrored_rows(&laid.rows, BoneSet::ALL).unwrap_or_else(|| Rows::new(DIM));
    CanonicalRows { rows, bones }
}

/// What the mirror image of a skeleton with `bones` shows.
pub fn opposite_bones(bones: BoneSet) -> BoneSet {
    bones
        .indices()
        .map(opposite_bone)
        .fold(BoneSet::NONE, BoneSet::with)
}
