//! Fingers of a skeleton, by names in the order of the tree.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::words::{is_side_word, spelt_side, words};
use super::{RoleMap, meaning::Side};
use crate::clip::{Joint, Skeleton};
use crate::pose::{BoneSet, Hand};

/// Fewer fingers say nothing of a hand; the index and the little finger, which give its palm, must be among them.
const LEAST_FINGERS: usize = 3;
/// Joints of a finger beyond those of its points are within the palm.
const POINTS: usize = 4;

/// What a name says of a finger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct FingerName {
    hand: Option<Hand>,
    finger: FingerNumber,
    /// True of a joint within the palm.
    is_metacarpal: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FingerNumber {
    /// From the thumb.
    Named(usize),
    /// As it was written: the thumb is 0 or 1.
    Written(usize),
}

impl RoleMap {
    /// The roles that `bones` ask for: [with fingers](Self::with_fingers) if some of them are of hands.
    pub fn for_bones(&self, skeleton: &Skeleton, bones: BoneSet) -> Cow<'_, RoleMap> {
        match bones.and(BoneSet::HANDS).is_empty() {
            true => Cow::Borrowed(self),
            false => self.with_fingers(skeleton),
        }
    }

    /// The roles with those of the fingers that `skeleton` has, where no finger has one yet. Names say which finger a joint is of, the tree
    /// which of its points: the first behind the palm is the base, the fourth the tip, or else the last (a skeleton without joints at
    /// the tips ends with the last bone's base). Joints hang below the hand that `self` names. O(joints · depth).
    pub fn with_fingers(&self, skeleton: &Skeleton) -> Cow<'_, RoleMap> {
        if self.played().any(|(role, _)| role.is_of_hand()) {
            return Cow::Borrowed(self);
        }
        let chains = chains(skeleton, self);
        let mut all = Cow::Borrowed(self);
        for hand in Hand::BOTH {
            let fingers: Vec<Option<&Vec<usize>>> =
                (0..5).map(|finger| chains.get(&(hand, finger))).collect();
            let has_palm = fingers[1].is_some() && fingers[4].is_some();
            if has_palm && fingers.iter().flatten().count() >= LEAST_FINGERS {
                set_hand(all.to_mut(), hand, &fingers, skeleton);
            }
        }
        all
    }
}

fn set_hand(map: &mut RoleMap, hand: Hand, fingers: &[Option<&Vec<usize>>], skeleton: &Skeleton) {
    let points = hand.points();
    for (roles, chain) in points.fingers.iter().zip(fingers) {
        let Some((last, inner)) = chain.and_then(|chain| chain.split_last()) else {
            continue;
        };
        let [inner_roles @ .., tip] = roles;
        map.set(*tip, Some(*last));
        for (role, joint) in inner_roles.iter().zip(inner) {
            map.set(*role, Some(*joint));
        }
    }
    if map.joint(points.wrist).is_none() {
        let base = map.joint(points.fingers[1][0]);
        map.set(
            points.wrist,
            base.and_then(|joint| skeleton.joints()[joint].parent),
        );
    }
}

/// Joints of each finger from its base on, at least two and at most four.
fn chains(skeleton: &Skeleton, map: &RoleMap) -> BTreeMap<(Hand, usize), Vec<usize>> {
    let joints = skeleton.joints();
    let named: Vec<Option<FingerName>> = joints.iter().map(|j| read(&j.name)).collect();
    let written = |number: usize| {
        let has = |name: &FingerName| name.finger == FingerNumber::Written(number);
        named.iter().flatten().any(has)
    };
    let thumb = usize::from(!written(0));
    let mut chains: BTreeMap<(Hand, usize), Vec<usize>> = BTreeMap::new();
    for (at, name) in named.iter().enumerate() {
        let Some(name) = name else { continue };
        let finger = match name.finger {
            FingerNumber::Named(finger) => Some(finger),
            FingerNumber::Written(number) => number.checked_sub(thumb),
        };
        let above = || above(joints, at);
        let hand = hand_above(joints, at, map).or_else(|| {
            let side_above =
                || above().find_map(|joint| side_of(&words(bare(&joints[joint].name))));
            let hand = name.hand.or_else(side_above)?;
            // Where the hand is known, its fingers hang below it.
            map.joint(hand.points().wrist).is_none().then_some(hand)
        });
        let (Some(hand), Some(finger @ 0..5)) = (hand, finger) else {
            continue;
        };
        let chain = chains.entry((hand, finger)).or_default();
        let follows = (chain.last()).is_none_or(|last| above().any(|joint| joint == *last));
        if follows && !(name.is_metacarpal && finger > 0) {
            chain.push(at);
        }
    }
    for chain in chains.values_mut() {
        let within_palm = chain.len().saturating_sub(POINTS);
        chain.drain(..within_palm);
    }
    chains.retain(|_, chain| chain.len() >= 2);
    chains
}

/// The joints that joint `at` hangs on, the nearest first.
fn above(joints: &[Joint], at: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(joints[at].parent, |&joint| joints[joint].parent)
}

/// The hand of `map` that joint `at` hangs on.
fn hand_above(joints: &[Joint], at: usize, map: &RoleMap) -> Option<Hand> {
    let is_below = |hand: &Hand| {
        let wrist = map.joint(hand.points().wrist);
        wrist.is_some_and(|wrist| above(joints, at).any(|joint| joint == wrist))
    };
    Hand::BOTH.into_iter().find(is_below)
}

fn bare(name: &str) -> &str {
    name.rsplit(':').next().unwrap_or(name)
}

/// The hand that words name.
fn side_of(words: &[String]) -> Option<Hand> {
    let (spelt, letter) = spelt_side(words);
    Some(match spelt.or(letter)? {
        Side::Left => Hand::Left,
        Side::Right => Hand::Right,
    })
}

/// What a name says of a finger; `None` for anything else. `LeftHandIndex1`, `index_01_l`, `f_index.01.L`, `rPinky2`, `Bip01 L Finger11`,
/// `LeftFinger2Proximal`, `LeftSecondMC`, `leftLittleDistal`.
fn read(name: &str) -> Option<FingerName> {
    let bare = bare(name);
    let words = words(bare);
    let has = |word: &[&str]| words.iter().any(|w| word.contains(&w.as_str()));
    if has(&["toe", "foot", "ear", "toes", "twist"]) {
        return None;
    }
    let finger = words
        .iter()
        .find_map(|word| named_finger(word))
        .or_else(|| written_finger(bare))
        .or_else(|| counted_finger(&words))?;
    Some(FingerName {
        hand: side_of(&words),
        finger,
        is_metacarpal: has(&["metacarpal", "meta", "carpal", "mc"])
            || words.windows(2).any(|pair| pair == ["in", "hand"]),
    })
}

fn named_finger(word: &str) -> Option<FingerNumber> {
    // Short names have the side before them: `lthumb`.
    let part = match word.as_bytes().first() {
        Some(b'l' | b'r') if word.len() > 4 && !is_side_word(word) => &word[1..],
        _ => word,
    };
    let number = |word: &str| {
        Some(match word {
            "thumb" => 0,
            "index" | "pointer" | "forefinger" => 1,
            "middle" | "mid" => 2,
            "ring" => 3,
            "little" | "pinky" | "pinkie" => 4,
            _ => return None,
        })
    };
    (number(word).or_else(|| number(part))).map(FingerNumber::Named)
}

/// `Finger11`: the second joint of finger 1.
fn written_finger(name: &str) -> Option<FingerNumber> {
    let lower = name.to_ascii_lowercase();
    let (_, after) = lower.split_once("finger")?;
    let digit = after.trim_start_matches(['_', '-', ' ']).chars().next()?;
    Some(FingerNumber::Written(digit.to_digit(10)? as usize))
}

/// `LeftSecondMC`: fingers that are counted, of a bone of a hand.
fn counted_finger(words: &[String]) -> Option<FingerNumber> {
    const BONES: [&str; 4] = ["mc", "pp", "mp", "dp"];
    const COUNTS: [&str; 5] = ["first", "second", "third", "fourth", "fifth"];
    let is_bone = words.iter().any(|word| BONES.contains(&word.as_str()));
    let count = |word: &String| COUNTS.iter().position(|count| count == word);
    let count = words.iter().find_map(count).filter(|_| is_bone)?;
    Some(FingerNumber::Named(count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::roles::Role;

    /// A left hand at the end of an arm with these fingers, each a list of names from the palm on.
    fn skeleton(hand: &str, fingers: &[Vec<String>]) -> Skeleton {
        let joint = |name: &str, parent: Option<usize>| Joint {
            name: name.to_owned(),
            parent,
            offset: Vec3::zeros(),
            tip: None,
        };
        let mut joints = vec![joint("root", None), joint(hand, Some(0))];
        for finger in fingers {
            let mut parent = 1;
            for name in finger {
                joints.push(joint(name, Some(parent)));
                parent = joints.len() - 1;
            }
        }
        Skeleton::new(joints).unwrap()
    }

    /// Names of the base and of the tip of the index finger, and the number of points.
    fn found(hand: &str, fingers: &[Vec<String>]) -> (String, String, usize) {
        let skeleton = skeleton(hand, fingers);
        let mut map = RoleMap::default();
        map.set(Role::LeftHand, Some(1));
        let map = map.with_fingers(&skeleton);
        let name = |role| {
            let joint = map.joint(role).map(|joint| &skeleton.joints()[joint]);
            joint.map_or(String::new(), |joint| joint.name.clone())
        };
        let points = map.played().filter(|(role, _)| role.is_of_hand());
        (
            name(Role::LeftIndex1),
            name(Role::LeftIndexTip),
            points.count(),
        )
    }

    /// Every finger's name put into each of `patterns`.
    fn patterns(fingers: [&str; 5], patterns: &[&str]) -> Vec<Vec<String>> {
        let of_finger = |finger: &&str| {
            let names = patterns.iter().map(|p| p.replace('*', finger));
            names.collect()
        };
        fingers.iter().map(of_finger).collect()
    }

    #[test]
    fn names_of_every_producer_are_understood() {
        const NAMES: [&str; 5] = ["Thumb", "Index", "Middle", "Ring", "Pinky"];
        const LOWER: [&str; 5] = ["thumb", "index", "middle", "ring", "pinky"];
        let cases = [
            (
                "Mixamo",
                "mixamorig:LeftHand",
                NAMES,
                &[
                    "mixamorig:LeftHand*1",
                    "mixamorig:LeftHand*2",
                    "mixamorig:LeftHand*3",
                    "mixamorig:LeftHand*4",
                ][..],
                0,
                3,
            ),
            (
                "HumanIK",
                "LeftHand",
                NAMES,
                &["LeftInHand*", "LeftHand*1", "LeftHand*2", "LeftHand*3"],
                1,
                3,
            ),
            (
                "Unreal",
                "hand_l",
                LOWER,
                &["*_metacarpal_l", "*_01_l", "*_02_l", "*_03_l"],
                1,
                3,
            ),
            (
                "Rigify",
                "hand.L",
                LOWER,
                &["f_*.01.L", "f_*.02.L", "f_*.03.L"],
                0,
                2,
            ),
            (
                "Daz",
                "lHand",
                ["Thumb", "Index", "Mid", "Ring", "Pinky"],
                &["l*1", "l*2", "l*3"],
                0,
                2,
            ),
            (
                "Biped",
                "Bip01 L Hand",
                ["0", "1", "2", "3", "4"],
                &[
                    "Bip01 L Finger*",
                    "Bip01 L Finger*1",
                    "Bip01 L Finger*2",
                    "Bip01 L Finger*Nub",
                ],
                0,
                3,
            ),
            (
                "Rokoko",
                "LeftHand",
                ["1", "2", "3", "4", "5"],
                &[
                    "LeftFinger*Metacarpal",
                    "LeftFinger*Proximal",
                    "LeftFinger*Medial",
                    "LeftFinger*Distal",
                    "LeftFinger*Tip",
                ],
                1,
                4,
            ),
            (
                "Xsens",
                "LeftHand",
                ["First", "Second", "Third", "Fourth", "Fifth"],
                &["Left*MC", "Left*PP", "Left*MP", "Left*DP"],
                1,
                3,
            ),
            (
                "VRM",
                "leftHand",
                ["Thumb", "Index", "Middle", "Ring", "Little"],
                &["left*Proximal", "left*Intermediate", "left*Distal"],
                0,
                2,
            ),
            (
                "OpenXR",
                "left_wrist",
                LOWER,
                &[
                    "left_*_metacarpal",
                    "left_*_proximal",
                    "left_*_intermediate",
                    "left_*_distal",
                    "left_*_tip",
                ],
                1,
                4,
            ),
        ];
        for (producer, hand, fingers, names, base, tip) in cases {
            let chains = patterns(fingers, names);
            let (first, last, points) = found(hand, &chains);
            assert_eq!(
                (first.as_str(), last.as_str()),
                (chains[1][base].as_str(), chains[1][tip].as_str()),
                "{producer}"
            );
            // The thumb's metacarpal is one of its points.
            let thumb = names.len().min(POINTS);
            assert_eq!(points, thumb + 4 * (tip + 1 - base), "{producer}");
        }
    }

    #[test]
    fn half_a_hand_and_other_rings_are_none() {
        let one = |names: &[&str]| vec![names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>()];
        // One joint for all fingers, as in motion of the CMU.
        let cmu = [one(&["LeftFingerBase", "LeftHandIndex1"]), one(&["LThumb"])].concat();
        assert_eq!(found("LeftHand", &cmu).2, 0);
        let body = ["LeftToeIndex", "EarRing", "SpineMiddle", "IndexProp"];
        assert_eq!(found("LeftHand", &one(&body)).2, 0);
    }
}
