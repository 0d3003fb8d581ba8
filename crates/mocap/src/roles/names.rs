//! Reads joint names as a side and a possible body part.
//!
//! Names are evidence, not truth: `LeftLeg` is the shin where there is a `LeftUpLeg`, `LeftShoulder` the collar
//! where there is a `LeftArm`. Such words get a kind of their own here and are settled in [`super::limbs`].

use super::languages::{in_english, words_in_english};
use super::meaning::{NameMeaning, Side};
use super::words::{glued_side, is_side_word, kind_of, spelt_side, words};
use crate::clip::Skeleton;

/// A name taken apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reading {
    pub(super) side: Option<Side>,
    pub(super) kind: NameMeaning,
}

/// What the names of a skeleton's joints say. Reading them takes longer than all else about roles: once does.
#[derive(Debug, Clone)]
pub(crate) struct JointNames(Vec<Reading>);

impl JointNames {
    /// Reads all names of `skeleton`. O(joints).
    pub(crate) fn of(skeleton: &Skeleton) -> Self {
        let mut names = Self(Vec::with_capacity(skeleton.len()));
        names.extend(skeleton);
        names
    }

    /// Reads the names of joints that `skeleton` got since. O(new joints).
    pub(crate) fn extend(&mut self, skeleton: &Skeleton) {
        let known = self.0.len().min(skeleton.len());
        let new = &skeleton.joints()[known..];
        self.0.extend(new.iter().map(|joint| read(&joint.name)));
    }

    /// One for each joint.
    pub(super) fn readings(&self) -> &[Reading] {
        &self.0
    }
}

/// Reads a name; namespaces (`mixamorig7:`), prefixes and case do not matter.
pub(super) fn read(name: &str) -> Reading {
    let bare = name.rsplit(':').next().unwrap_or(name);
    let words = words_in_english(words(&in_english(bare)));
    let (mut side, letters) = spelt_side(&words);
    let rest: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|w| !is_side_word(w))
        .collect();
    let mut kind = kind_of(&rest);
    if side.is_none() {
        // A letter is a side only beside a part of the body: `L5` is a vertebra.
        side = letters.filter(|_| kind != NameMeaning::Unknown);
    }
    if let (None, Some((glued, word))) = (side, glued_side(&rest)) {
        side = Some(glued);
        kind = word;
    }
    if side.is_some() && kind == NameMeaning::Hips {
        kind = NameMeaning::Hip;
    }
    Reading { side, kind }
}

#[cfg(test)]
mod tests {
    use super::*;
    use NameMeaning::*;

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
            ("Body Controller", None, Unknown),
            ("CC_Base_NeckTwist01", None, Neck),
            ("CC_Base_L_ForearmTwist02", left, Twist),
            ("LeftForeArmRoll", left, Twist),
            ("__UpLeg_L", left, Thigh),
            ("LoLeg_R", right, Shin),
            ("左ひざ", left, Shin),
            ("右足首", right, Foot),
            ("左腕捩", left, Twist),
            ("下半身", None, Hips),
            ("RFArm", right, Forearm),
            ("LUArm", left, UpperArm),
            ("ShoulderCenter", None, Neck),
            ("SPINE_SHOULDER", None, Spine),
            ("HandLeft", left, Hand),
            ("FrontLeg_L", left, Animal),
            ("Tail3", None, Animal),
            ("hips_joint", None, Hips),
            ("Clavicule_G", left, Collar),
            ("AvantBras_D", right, Forearm),
            ("Antebrazo_Izq", left, Forearm),
            ("Unterschenkel_L", left, Shin),
            ("右小腿", right, Shin),
            ("头", None, Head),
            ("왼쪽손목", left, Hand),
            ("l_radiocarpal", left, Hand),
            ("r_sternoclavicular", right, Collar),
            ("Main", None, Unknown),
        ] {
            assert_eq!(read(name), Reading { side, kind }, "{name}");
        }
    }
}
