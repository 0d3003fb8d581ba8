//! The words of joint names: splitting names, and the meaning of each word.

use super::meaning::{NameMeaning, Side};

/// Lower-case words of a name: cut at anything but letters and where the case changes, digits dropped.
pub(super) fn words(name: &str) -> Vec<String> {
    words_of(name, char::is_alphabetic)
}

/// The same of the characters that are `kept`; the others are where it is cut.
pub(super) fn words_of(name: &str, kept: impl Fn(char) -> bool) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = Vec::new();
    let mut word = String::new();
    for (i, &c) in letters.iter().enumerate() {
        let next_is_lower = letters.get(i + 1).is_some_and(|n| n.is_lowercase());
        let before_is_lower = i > 0 && letters[i - 1].is_lowercase();
        let begins = c.is_uppercase() && (before_is_lower || next_is_lower);
        if (begins || !kept(c)) && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        if kept(c) {
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
pub(super) fn glued_side(words: &[&str]) -> Option<(Side, NameMeaning)> {
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

/// More words of the same kind, as whole words only.
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
const PARTS: [(&str, NameMeaning); 75] = [
    ("finger", NameMeaning::Finger),
    ("thumb", NameMeaning::Finger),
    ("pinky", NameMeaning::Finger),
    ("metacarpal", NameMeaning::Finger),
    ("radiocarpal", NameMeaning::Hand),
    ("carpal", NameMeaning::Finger),
    ("index", NameMeaning::Finger),
    ("toe", NameMeaning::Toe),
    ("metatarsal", NameMeaning::Toe),
    ("talocrural", NameMeaning::Foot),
    ("talus", NameMeaning::Foot),
    ("forearm", NameMeaning::Forearm),
    ("lowerarm", NameMeaning::Forearm),
    ("lowarm", NameMeaning::Forearm),
    ("loarm", NameMeaning::Forearm),
    ("armlower", NameMeaning::Forearm),
    ("radius", NameMeaning::Forearm),
    ("ulna", NameMeaning::Forearm),
    ("elbow", NameMeaning::Forearm),
    ("upperarm", NameMeaning::UpperArm),
    ("uparm", NameMeaning::UpperArm),
    ("armupper", NameMeaning::UpperArm),
    ("humerus", NameMeaning::UpperArm),
    ("bicep", NameMeaning::UpperArm),
    ("collar", NameMeaning::Collar),
    ("clavic", NameMeaning::Collar),
    ("scapula", NameMeaning::Collar),
    ("shoulder", NameMeaning::Shoulder),
    ("shldr", NameMeaning::Shoulder),
    ("hipjoint", NameMeaning::HipJoint),
    ("buttock", NameMeaning::HipJoint),
    ("thigh", NameMeaning::Thigh),
    ("femur", NameMeaning::Thigh),
    ("upleg", NameMeaning::Thigh),
    ("upperleg", NameMeaning::Thigh),
    ("legupper", NameMeaning::Thigh),
    ("shin", NameMeaning::Shin),
    ("shank", NameMeaning::Shin),
    ("calf", NameMeaning::Shin),
    ("tibia", NameMeaning::Shin),
    ("lowleg", NameMeaning::Shin),
    ("loleg", NameMeaning::Shin),
    ("lowerleg", NameMeaning::Shin),
    ("leglower", NameMeaning::Shin),
    ("knee", NameMeaning::Shin),
    ("foot", NameMeaning::Foot),
    ("ankle", NameMeaning::Foot),
    ("hand", NameMeaning::Hand),
    ("wrist", NameMeaning::Hand),
    ("palm", NameMeaning::Hand),
    ("fist", NameMeaning::Hand),
    ("pelvis", NameMeaning::Hips),
    ("sacro", NameMeaning::Hips),
    ("lowerbody", NameMeaning::Hips),
    ("lowertorso", NameMeaning::Hips),
    ("hip", NameMeaning::Hips),
    ("neck", NameMeaning::Neck),
    ("head", NameMeaning::Head),
    ("skull", NameMeaning::Head),
    ("spine", NameMeaning::Spine),
    ("chest", NameMeaning::Spine),
    ("torso", NameMeaning::Spine),
    ("thorax", NameMeaning::Spine),
    ("abdomen", NameMeaning::Spine),
    ("stomach", NameMeaning::Spine),
    ("belly", NameMeaning::Spine),
    ("waist", NameMeaning::Spine),
    ("back", NameMeaning::Spine),
    ("trunk", NameMeaning::Spine),
    ("upperbody", NameMeaning::Spine),
    ("wing", NameMeaning::Animal),
    ("tentacle", NameMeaning::Animal),
    ("hoof", NameMeaning::Animal),
    ("leg", NameMeaning::Leg),
    ("arm", NameMeaning::Arm),
];

/// The kind that the words together say; they are also read as one, so that `up leg` is `upleg`.
pub(super) fn kind_of(words: &[&str]) -> NameMeaning {
    if words.iter().any(|w| OTHER.contains(w)) {
        return NameMeaning::Other;
    }
    // Letters beside the words (`clavicule_g`) make no other word of them.
    let long: Vec<&str> = words.iter().copied().filter(|w| w.len() > 1).collect();
    let joined = long.concat();
    if joined.contains("armature") {
        return NameMeaning::Unknown;
    }
    let legs_of_four = ["frontleg", "foreleg", "hindleg", "rearleg", "backleg"];
    if words.iter().any(|w| ANIMAL.contains(w)) || legs_of_four.iter().any(|w| joined.contains(w)) {
        return NameMeaning::Animal;
    }
    let part = PARTS
        .iter()
        .find(|(part, _)| joined.contains(part))
        .map(|(_, kind)| *kind);
    // A turn of the neck or the spine is a joint of its own; one of a limb shares its bone.
    let turns = |w: &&str| {
        w.contains("twist") || w.ends_with("roll") || matches!(*w, "rolls" | "part" | "share")
    };
    if words.iter().any(turns)
        && !matches!(
            part,
            Some(NameMeaning::Neck | NameMeaning::Spine | NameMeaning::Head)
        )
    {
        return NameMeaning::Twist;
    }
    let has = |some: &[&str]| words.iter().any(|w| some.contains(w));
    // The hand's middle finger; but a spine may have a middle, too.
    let of_finger = has(&["middle", "mid", "ring", "little"]);
    let central = has(&["center", "centre", "mid", "middle"]);
    match part {
        Some(NameMeaning::Shoulder) if joined.contains("spine") => NameMeaning::Spine,
        Some(NameMeaning::Shoulder) if central => NameMeaning::Neck,
        None if has(&["ball"]) => NameMeaning::Toe,
        None if has(&["ab"]) => NameMeaning::Spine,
        None | Some(NameMeaning::Hand) if of_finger => NameMeaning::Finger,
        Some(kind) => kind,
        None => NameMeaning::Unknown,
    }
}
