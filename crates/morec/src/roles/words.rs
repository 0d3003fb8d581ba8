//! The words of joint names: taking names apart, and what each word means.

use super::names::{Kind, Side};

/// Lower-case words of a name: cut at anything but letters and where the case changes, digits dropped.
pub(super) fn words(name: &str) -> Vec<String> {
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

pub(super) fn is_side_word(word: &str) -> bool {
    matches!(
        word,
        "left" | "right" | "l" | "r" | "lft" | "rgt" | "lt" | "rt" | "lf" | "sx" | "dx"
    )
}

/// The side that whole words say, and the one that single letters would say.
pub(super) fn spelt_side(words: &[String]) -> (Option<Side>, Option<Side>) {
    let find = |left: &[&str], right: &[&str]| {
        words.iter().find_map(|w| match w.as_str() {
            w if left.contains(&w) => Some(Side::Left),
            w if right.contains(&w) => Some(Side::Right),
            _ => None,
        })
    };
    let spelt = find(&["left", "links"], &["right", "rechts"]).or_else(|| {
        words.iter().find_map(|w| match w.as_str() {
            w if w.starts_with("left") || w.ends_with("left") => Some(Side::Left),
            w if w.starts_with("right") || w.ends_with("right") && w != "upright" => {
                Some(Side::Right)
            }
            _ => None,
        })
    });
    let letters = find(&["l", "lft", "lt", "lf", "sx"], &["r", "rgt", "rt", "dx"]);
    (spelt, letters)
}

/// Names without any mark between side and part: `lfemur`, `rhumerus`, `lhipjoint`.
pub(super) fn glued_side(words: &[&str]) -> Option<(Side, Kind)> {
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

const GLUED: [&str; 29] = [
    "hip", "femur", "thigh", "tibia", "shin", "calf", "knee", "foot", "ankle", "toe", "clavicle",
    "collar", "shoulder", "shldr", "humerus", "upperarm", "uparm", "arm", "radius", "forearm",
    "elbow", "wrist", "hand", "finger", "thumb", "upleg", "leg", "bicep", "shank",
];

/// Words that say so only as whole words.
const OTHER: [&str; 52] = [
    "end",
    "nub",
    "site",
    "tip",
    "eye",
    "eyes",
    "ear",
    "ears",
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
    "skirt",
    "cloth",
    "breast",
    "bust",
    "boob",
    "pectoral",
    "ribs",
    "ik",
    "pole",
    "prop",
    "weapon",
    "camera",
    "footsteps",
    "face",
    "facial",
    "dummy",
    "cancel",
    "handle",
    "sword",
    "shield",
    "gun",
    "bag",
    "backpack",
    "hat",
    "helmet",
    "cape",
    "heel",
    "target",
    "light",
];

/// Words of animals, as whole words.
const ANIMAL: [&str; 18] = [
    "tail", "tails", "wing", "wings", "fin", "fins", "hoof", "paw", "beak", "claw", "claws",
    "pincer", "tentacle", "antenna", "feather", "hind", "mane", "hock",
];

/// In the order in which they are tried: the more telling part of a joined word first.
const PARTS: [(&str, Kind); 74] = [
    ("finger", Kind::Finger),
    ("thumb", Kind::Finger),
    ("pinky", Kind::Finger),
    ("metacarpal", Kind::Finger),
    ("radiocarpal", Kind::Hand),
    ("carpal", Kind::Finger),
    ("index", Kind::Finger),
    ("toe", Kind::Toe),
    ("metatarsal", Kind::Toe),
    ("talocrural", Kind::Foot),
    ("forearm", Kind::Forearm),
    ("lowerarm", Kind::Forearm),
    ("lowarm", Kind::Forearm),
    ("loarm", Kind::Forearm),
    ("armlower", Kind::Forearm),
    ("radius", Kind::Forearm),
    ("ulna", Kind::Forearm),
    ("elbow", Kind::Forearm),
    ("upperarm", Kind::UpperArm),
    ("uparm", Kind::UpperArm),
    ("armupper", Kind::UpperArm),
    ("humerus", Kind::UpperArm),
    ("bicep", Kind::UpperArm),
    ("collar", Kind::Collar),
    ("clavic", Kind::Collar),
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
    ("shank", Kind::Shin),
    ("calf", Kind::Shin),
    ("tibia", Kind::Shin),
    ("lowleg", Kind::Shin),
    ("loleg", Kind::Shin),
    ("lowerleg", Kind::Shin),
    ("leglower", Kind::Shin),
    ("knee", Kind::Shin),
    ("foot", Kind::Foot),
    ("ankle", Kind::Foot),
    ("hand", Kind::Hand),
    ("wrist", Kind::Hand),
    ("palm", Kind::Hand),
    ("fist", Kind::Hand),
    ("pelvis", Kind::Hips),
    ("sacro", Kind::Hips),
    ("lowerbody", Kind::Hips),
    ("lowertorso", Kind::Hips),
    ("hip", Kind::Hips),
    ("neck", Kind::Neck),
    ("head", Kind::Head),
    ("skull", Kind::Head),
    ("spine", Kind::Spine),
    ("chest", Kind::Spine),
    ("torso", Kind::Spine),
    ("thorax", Kind::Spine),
    ("abdomen", Kind::Spine),
    ("stomach", Kind::Spine),
    ("belly", Kind::Spine),
    ("waist", Kind::Spine),
    ("back", Kind::Spine),
    ("trunk", Kind::Spine),
    ("upperbody", Kind::Spine),
    ("wing", Kind::Animal),
    ("tentacle", Kind::Animal),
    ("hoof", Kind::Animal),
    ("leg", Kind::Leg),
    ("arm", Kind::Arm),
];

/// The kind that the words together say; they are also read as one, so that `up leg` is `upleg`.
pub(super) fn kind_of(words: &[&str]) -> Kind {
    if words.iter().any(|w| OTHER.contains(w)) {
        return Kind::Other;
    }
    // Letters beside the words (`clavicule_g`) make no other word of them.
    let long: Vec<&str> = words.iter().copied().filter(|w| w.len() > 1).collect();
    let joined = long.concat();
    if joined.contains("armature") {
        return Kind::Unknown;
    }
    let legs_of_four = ["frontleg", "foreleg", "hindleg", "rearleg", "backleg"];
    if words.iter().any(|w| ANIMAL.contains(w)) || legs_of_four.iter().any(|w| joined.contains(w)) {
        return Kind::Animal;
    }
    let part = PARTS
        .iter()
        .find(|(part, _)| joined.contains(part))
        .map(|(_, kind)| *kind);
    // A turn of the neck or the spine is a joint of its own; one of a limb shares its bone.
    let turns = |w: &&str| {
        w.contains("twist") || w.ends_with("roll") || matches!(*w, "rolls" | "part" | "share")
    };
    if words.iter().any(turns) && !matches!(part, Some(Kind::Neck | Kind::Spine | Kind::Head)) {
        return Kind::Twist;
    }
    let has = |some: &[&str]| words.iter().any(|w| some.contains(w));
    // The hand's middle finger; but a spine may have a middle, too.
    let of_finger = has(&["middle", "mid", "ring", "little"]);
    let central = has(&["center", "centre", "mid", "middle"]);
    match part {
        Some(Kind::Shoulder) if joined.contains("spine") => Kind::Spine,
        Some(Kind::Shoulder) if central => Kind::Neck,
        None if has(&["ball"]) => Kind::Toe,
        None if has(&["ab"]) => Kind::Spine,
        None | Some(Kind::Hand) if of_finger => Kind::Finger,
        Some(kind) => kind,
        None => Kind::Unknown,
    }
}
