//! One layout for rows of any set of bones, and its mirror image.

use morec::features::{ALL_BONES, BONES, BoneSet, Rows};

/// Values in a laid-out row: directions and velocities of every bone, then the root.
pub const DIM: usize = 6 * BONES + 4;

/// Rows over all bones; those that a clip does not show are 0.
#[derive(Debug, Clone)]
pub struct Laid {
    pub rows: Rows,
    pub bones: BoneSet,
}

/// Puts the columns of `bones` where those of all bones lie.
pub fn lay_out(rows: &Rows, bones: BoneSet) -> Laid {
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
    Laid { rows: out, bones }
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

/// The bone on the other side.
pub fn opposite(bone: usize) -> usize {
    let name = ALL_BONES[bone].name;
    let other = match name.split_once('_') {
        Some(("left", rest)) => format!("right_{rest}"),
        Some(("right", rest)) => format!("left_{rest}"),
        _ => return bone,
    };
    ALL_BONES
        .iter()
        .position(|b| b.name == other)
        .unwrap_or(bone)
}

/// The direction of `bone` in a mirror beside the performer, of that of its opposite.
pub fn reflected(bone: usize, of_opposite: &[f32]) -> [f32; 3] {
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

/// What a mirror beside the performer shows: sides swapped, lateral parts and turning the other way.
///
/// The line of the shoulders goes from left to right: its image runs the other way, so its lateral part stays and
/// the others turn.
pub fn mirrored(laid: &Laid) -> Laid {
    let mut rows = Rows::new(DIM);
    let mut image = [0f32; DIM];
    for row in laid.rows.iter() {
        for block in 0..2 {
            for bone in 0..BONES {
                let (from, to) = (
                    3 * (block * BONES + opposite(bone)),
                    3 * (block * BONES + bone),
                );
                image[to..to + 3].copy_from_slice(&reflected(bone, &row[from..from + 3]));
            }
        }
        let root = 6 * BONES;
        image[root] = -row[root];
        image[root + 1] = row[root + 1];
        image[root + 2] = row[root + 2];
        image[root + 3] = -row[root + 3];
        rows.push(&image);
    }
    let bones = opposite_bones(laid.bones);
    Laid { rows, bones }
}

/// What the mirror image of a skeleton with `bones` shows.
pub fn opposite_bones(bones: BoneSet) -> BoneSet {
    bones
        .indices()
        .map(opposite)
        .fold(BoneSet::NONE, BoneSet::with)
}
