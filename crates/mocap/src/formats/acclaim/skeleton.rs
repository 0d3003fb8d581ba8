//! An Acclaim skeleton, and its joints in morec's form.

use crate::clip::{Joint, Skeleton};
use crate::math::{Axis, Quat, Vec3};

/// One number of a bone's line in a motion file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AmcChannel {
    /// `tx`, `ty`, `tz`: movement of the near end.
    Translation(Axis),
    /// `rx`, `ry`, `rz`: rotation.
    Rotation(Axis),
    /// `l`: what is added to the bone's length.
    Length,
}

impl AmcChannel {
    /// Reads `rx`, `TY`, `l` and the like.
    pub(super) fn from_token(token: &[u8]) -> Option<Self> {
        match token.to_ascii_lowercase().as_slice() {
            [b't', axis] => Axis::from_letter(char::from(*axis)).map(AmcChannel::Translation),
            [b'r', axis] => Axis::from_letter(char::from(*axis)).map(AmcChannel::Rotation),
            b"l" => Some(AmcChannel::Length),
            _ => None,
        }
    }
}

/// Rotations applied one after the other about fixed axes: the last in the list is the outermost factor.
pub(super) fn composed(rotations: impl IntoIterator<Item = (Axis, f64)>) -> Quat {
    rotations
        .into_iter()
        .fold(Quat::identity(), |done, (axis, angle_rad)| {
            axis.rotation(angle_rad) * done
        })
}

/// Contents of `:root`.
#[derive(Debug, Clone, PartialEq)]
pub struct Root {
    /// The numbers of the root's line in a motion file, in their order.
    pub channels: Vec<AmcChannel>,
    /// Added to every position; zero in every library known.
    pub position: Vec3,
    /// Applied after every rotation, and to every position; identity in every library known.
    pub orientation: Quat,
}

/// One entry of `:bonedata`.
#[derive(Debug, Clone, PartialEq)]
pub struct AsfBone {
    /// Name of the bone.
    pub name: String,
    /// From the near end to the far end, in the file's length unit.
    pub vector: Vec3,
    /// `C`: the axes that its motion is given about.
    pub axes: Quat,
    /// The numbers of its line in a motion file, in their order; none for a bone that has no line.
    pub channels: Vec<AmcChannel>,
}

/// A skeleton file.
#[derive(Debug, Clone, PartialEq)]
pub struct Asf {
    /// Contents of `:name`; may be empty.
    pub name: String,
    /// The `length` of `:units`: what inches were multiplied by.
    pub length_unit: f64,
    /// True if its angles, and those of motions that do not say otherwise, are in degrees.
    pub degrees: bool,
    /// Position, orientation and channels of the root.
    pub root: Root,
    /// The bones that hang on the root, parents first.
    pub bones: Vec<AsfBone>,
    /// For each bone, the bone it continues; `None` for the root.
    pub parents: Vec<Option<usize>>,
}

impl Asf {
    /// The name of the root in motion files, and of its joint.
    pub const ROOT: &str = "root";

    /// Metres in a unit of length, if the header's `length` is a factor on inches as in the CMU library
    /// (0.45 there). Body height is the better witness; see [`import`](crate::import).
    pub fn metres_per_unit(&self) -> f64 {
        0.0254 / self.length_unit
    }

    /// Joint 0 is the root, joint `b + 1` the near end of bone `b`.
    pub fn skeleton(&self) -> Skeleton {
        let mut joints = vec![Joint {
            name: Self::ROOT.to_owned(),
            parent: None,
            offset: Vec3::zeros(),
            tip: None,
        }];
        for (b, bone) in self.bones.iter().enumerate() {
            let parent = self.parents[b];
            joints.push(Joint {
                name: bone.name.clone(),
                parent: Some(parent.map_or(0, |p| p + 1)),
                offset: parent.map_or_else(Vec3::zeros, |p| self.bones[p].vector),
                tip: Some(bone.vector),
            });
            if let Some(p) = parent {
                joints[p + 1].tip = None;
            }
        }
        // The order is right by construction: `parents` only ever names earlier bones.
        Skeleton::new(joints).unwrap_or_default()
    }
}
