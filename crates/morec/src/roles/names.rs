//! What a joint's name says: which side, and which part it could be.
//!
//! Names are evidence, not truth: `LeftLeg` is the shin where there is a `LeftUpLeg`, `LeftShoulder` the collar
//! where there is a `LeftArm`. Such words get a kind of their own here and are settled in [`super::limbs`].

/// A side of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// What a name could mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Pelvis, hips, or a hip without a side.
    Hips,
    /// A hip with a side: the thigh, or a joint before it.
    Hip,
    /// A joint between hips and thigh that is not the thigh: `LHipJoint`, `lButtock`.
    HipJoint,
    Thigh,
    Shin,
    /// `LeftLeg`: shin or thigh.
    Leg,
    Foot,
    Toe,
    Spine,
    Neck,
    Head,
    Collar,
    /// `LeftShoulder`: collar or upper arm.
    Shoulder,
    UpperArm,
    /// `LeftArm`: nearly always the upper arm.
    Arm,
    Forearm,
    Hand,
    Finger,
    /// A joint that shares a limb's bone: twist and roll joints.
    Twist,
    /// Nothing of the body: ends, handles, faces, props.
    Other,
    /// The name says nothing.
    Unknown,
}

impl Kind {
    /// Whether the word belongs to the leg.
    pub(super) fn is_leg(self) -> bool {
        use Kind::*;
        matches!(self, Hip | HipJoint | Thigh | Shin | Leg | Foot | Toe)
    }

    /// Whether the word belongs to the arm.
    pub(super) fn is_arm(self) -> bool {
        use Kind::*;
        matches!(
            self,
            Collar | Shoulder | UpperArm | Arm | Forearm | Hand | Finger
        )
    }
}

/// A name taken apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reading {
    pub(super) side: Option<Side>,
    pub(super) kind: Kind,
}

/// Reads a name; namespaces (`mixamorig7:`), prefixes and case do not matter.
pub(super) fn read(name: &str) -> Reading {
    let bare = name.rsplit(':').next().unwrap_or(name);
    let words = words(bare);
    let (mut side, letters) = spelt_side(&words);
    let rest: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|w| !is_side_word(w))
        .collect();
    let mut kind = kind_of(&rest);
    if side.is_none() {
        // A letter is a side only beside a part of the body: `L5` is a vertebra.
        side = letters.filter(|_| kind != Kind::Unknown);
    }
    if let (None, Some((glued, word))) = (side, glued_side(&rest)) {
        side = Some(glued);
        kind = word;
    }
    if side.is_some() && kind == Kind::Hips {
        kind = Kind::Hip;
    }
    Reading { side, kind }
}

/// Lower-case words of a name: cut at anything but letters and where the case changes, digits dropped.
fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = Vec::new();
    let mut word = String::new();
    for (i, &c) in letters.iter().enumerate() {
        let next_is_lower = letters.get(i + 1).is_some_and(|n| n.is_lowercase());
        let before_is_lower = i > 0 && letters[i - 1].is_lowercase();
        let begins = c.is_uppercase() && (before_is_lower || next_is_lower);
        if (begins || !c.is_alphabetic()) && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        if c.is_alphabetic() {
            word.extend(c.to_lowercase());
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

fn is_side_word(word: &str) -> bool {
    matches!(
        word,
        "left" | "right" | "l" | "r" | "lft" | "rgt" | "lt" | "rt" | "lf"
    )
}

/// The side that whole words say, and the one that single letters would say.
fn spelt_side(words: &[String]) -> (Option<Side>, Option<Side>) {
    let find = |left: &[&str], right: &[&str]| {
        words.iter().find_map(|w| match w.as_str() {
            w if left.contains(&w) => Some(Side::Left),
            w if right.contains(&w) => Some(Side::Right),
            _ => None,
        })
    };
    let spelt = find(&["left"], &["right"]).or_else(|| {
        words.iter().find_map(|w| match w.as_str() {
            w if w.starts_with("left") => Some(Side::Left),
            w if w.starts_with("right") => Some(Side::Right),
            _ => None,
        })
    });
    (spelt, find(&["l", "lft", "lt", "lf"], &["r", "rgt", "rt"]))
}

/// Names without any mark between side and part: `lfemur`, `rhumerus`, `lhipjoint`.
fn glued_side(words: &[&str]) -> Option<(Side, Kind)> {
    words.iter().find_map(|word| {
        let (side, part) = match word.as_bytes().first()? {
            b'l' => (Side::Left, &word[1..]),
            b'r' => (Side::Right, &word[1..]),
            _ => return None,
        };
        // The remainder must begin with a part: `radius` and `lowerback` have no side.
        let begins = GLUED.iter().any(|p| part.starts_with(p));
        begins.then(|| (side, kind_of(&[part])))
    })
}

const GLUED: [&str; 27] = [
    "hip", "femur", "thigh", "tibia", "shin", "calf", "knee", "foot", "ankle", "toe", "clavicle",
    "collar", "shoulder", "shldr", "humerus", "upperarm", "uparm", "arm", "radius", "forearm",
    "elbow", "wrist", "hand", "finger", "thumb", "upleg", "leg",
];

/// Words that say so only as whole words.
const OTHER: [&str; 34] = [
    "end",
    "nub",
    "site",
    "tip",
    "eye",
    "eyes",
    "ear",
    "jaw",
    "mouth",
    "lip",
    "lips",
    "brow",
    "cheek",
    "tongue",
    "teeth",
    "chin",
    "nose",
    "lid",
    "eyelid",
    "eyebrow",
    "hair",
    "ponytail",
    "tail",
    "skirt",
    "cloth",
    "breast",
    "pectoral",
    "ik",
    "pole",
    "prop",
    "weapon",
    "camera",
    "footsteps",
    "face",
];

/// In the order in which they are tried: the more telling part of a joined word first.
const PARTS: [(&str, Kind); 59] = [
    ("twist", Kind::Twist),
    ("roll", Kind::Twist),
    ("finger", Kind::Finger),
    ("thumb", Kind::Finger),
    ("pinky", Kind::Finger),
    ("metacarpal", Kind::Finger),
    ("carpal", Kind::Finger),
    ("index", Kind::Finger),
    ("toe", Kind::Toe),
    ("metatarsal", Kind::Toe),
    ("forearm", Kind::Forearm),
    ("lowerarm", Kind::Forearm),
    ("lowarm", Kind::Forearm),
    ("armlower", Kind::Forearm),
    ("radius", Kind::Forearm),
    ("ulna", Kind::Forearm),
    ("elbow", Kind::Forearm),
    ("upperarm", Kind::UpperArm),
    ("uparm", Kind::UpperArm),
    ("armupper", Kind::UpperArm),
    ("humerus", Kind::UpperArm),
    ("collar", Kind::Collar),
    ("clavicle", Kind::Collar),
    ("scapula", Kind::Collar),
    ("shoulder", Kind::Shoulder),
    ("shldr", Kind::Shoulder),
    ("hipjoint", Kind::HipJoint),
    ("buttock", Kind::HipJoint),
    ("thigh", Kind::Thigh),
    ("femur", Kind::Thigh),
    ("upleg", Kind::Thigh),
    ("upperleg", Kind::Thigh),
    ("legupper", Kind::Thigh),
    ("shin", Kind::Shin),
    ("calf", Kind::Shin),
    ("tibia", Kind::Shin),
    ("lowleg", Kind::Shin),
    ("lowerleg", Kind::Shin),
    ("leglower", Kind::Shin),
    ("knee", Kind::Shin),
    ("foot", Kind::Foot),
    ("ankle", Kind::Foot),
    ("hand", Kind::Hand),
    ("wrist", Kind::Hand),
    ("pelvis", Kind::Hips),
    ("hip", Kind::Hips),
    ("neck", Kind::Neck),
    ("head", Kind::Head),
    ("skull", Kind::Head),
    ("spine", Kind::Spine),
    ("chest", Kind::Spine),
    ("torso", Kind::Spine),
    ("thorax", Kind::Spine),
    ("abdomen", Kind::Spine),
    ("waist", Kind::Spine),
    ("back", Kind::Spine),
    ("trunk", Kind::Spine),
    ("leg", Kind::Leg),
    ("arm", Kind::Arm),
];

/// The kind that the words together say; they are also read as one, so that `up leg` is `upleg`.
fn kind_of(words: &[&str]) -> Kind {
    if words.iter().any(|w| OTHER.contains(w)) {
        return Kind::Other;
    }
    let joined = words.concat();
    if joined.contains("armature") {
        return Kind::Unknown;
    }
    // The hand's middle finger; but a spine may have a middle, too.
    let of_finger = words
        .iter()
        .any(|w| matches!(*w, "middle" | "mid" | "ring" | "little"));
    let part = PARTS
        .iter()
        .find(|(part, _)| joined.contains(part))
        .map(|(_, kind)| *kind);
    match part {
        None if words.contains(&"ball") => Kind::Toe,
        None | Some(Kind::Hand) if of_finger => Kind::Finger,
        Some(kind) => kind,
        None => Kind::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Kind::*;

    #[test]
    fn sides_and_parts_in_every_spelling() {
        let left = Some(Side::Left);
        let right = Some(Side::Right);
        for (name, side, kind) in [
            ("LHipJoint", left, HipJoint),
            ("lfemur", left, Thigh),
            ("rradius", right, Forearm),
            ("lowerback", None, Spine),
            ("lowerneck", None, Neck),
            ("mixamorig7:RightForeArm", right, Forearm),
            ("Bip01 L Thigh", left, Thigh),
            ("Bip001 R UpperArm", right, UpperArm),
            ("LEFT_HIP#", left, Hip),
            ("Hips", None, Hips),
            ("lShldr", left, Shoulder),
            ("rForeArm", right, Forearm),
            ("upperleg01.L", left, Thigh),
            ("lowerarm_twist_01_r", right, Twist),
            ("LeftHandIndex1", left, Finger),
            ("LeftHandRing2", left, Finger),
            ("LThumb", left, Finger),
            ("ball_l", left, Toe),
            ("LeftToe_End", left, Other),
            ("HeadEnd", None, Other),
            ("Left_Calf", left, Shin),
            ("UpperLeg_R", right, Thigh),
            ("Character1_LeftLeg", left, Leg),
            ("L5", None, Unknown),
            ("TRH", None, Unknown),
            ("Armature", None, Unknown),
            ("joint_12", None, Unknown),
            ("joint_Root", None, Unknown),
            ("", None, Unknown),
        ] {
            assert_eq!(read(name), Reading { side, kind }, "{name}");
        }
    }
}
