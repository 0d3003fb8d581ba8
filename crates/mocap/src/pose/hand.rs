//! Hands: their points, the frame of the palm, and their length.

use crate::math::Vec3;
use crate::roles::Role;

use super::KeyPose;

/// A hand of a performer.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Hand {
    /// The performer's left.
    Left,
    /// The performer's right.
    Right,
}

/// Points of a finger from its base to its tip.
type Finger = [Role; 4];

/// Roles of the joints of one hand.
pub struct HandPoints {
    /// The joint of the wrist.
    pub wrist: Role,
    /// Middle of the palm.
    pub palm: Role,
    /// Thumb, index, middle, ring and little finger.
    pub fingers: [Finger; 5],
}

const fn points(wrist: Role, palm: Role) -> HandPoints {
    let mut fingers = [[palm; 4]; 5];
    let mut finger = 0;
    while finger < 5 {
        let mut point = 0;
        while point < 4 {
            fingers[finger][point] = Role::ALL[palm.index() + 1 + 4 * finger + point];
            point += 1;
        }
        finger += 1;
    }
    HandPoints {
        wrist,
        palm,
        fingers,
    }
}

const LEFT: HandPoints = points(Role::LeftHand, Role::LeftPalm);
const RIGHT: HandPoints = points(Role::RightHand, Role::RightPalm);

/// Length of a hand from the wrist to the tip of the middle finger, in mean lengths of the four fingers: a round figure, of some
/// 19 cm and 8 cm. Travel is measured in it, and units of length are recognised by it.
const HAND_OF_FINGER: f64 = 2.4;

/// Axes of a palm in the world, at right angles to each other, of length 1.
///
/// Forward goes to the bases of the fingers, lateral from the index to the little finger. The normal is lateral × forward of a
/// right hand and forward × lateral of a left one, so that a hand and its mirror image have the same coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PalmFrame {
    /// Across the palm.
    pub lateral: Vec3,
    /// Out of the palm.
    pub normal: Vec3,
    /// Towards the fingers.
    pub forward: Vec3,
}

impl PalmFrame {
    /// Coordinates of a vector of the world: (lateral, normal, forward).
    pub fn of_world(&self, v: &Vec3) -> Vec3 {
        Vec3::new(self.lateral.dot(v), self.normal.dot(v), self.forward.dot(v))
    }
}

impl Hand {
    /// Both, left first.
    pub const BOTH: [Hand; 2] = [Hand::Left, Hand::Right];

    /// `left` or `right`.
    pub const fn name(self) -> &'static str {
        match self {
            Hand::Left => "left",
            Hand::Right => "right",
        }
    }

    /// The hand of the other side.
    pub const fn other(self) -> Hand {
        match self {
            Hand::Left => Hand::Right,
            Hand::Right => Hand::Left,
        }
    }

    /// Roles of its joints.
    pub const fn points(self) -> HandPoints {
        match self {
            Hand::Left => LEFT,
            Hand::Right => RIGHT,
        }
    }

    /// Where it is: the palm, the wrist of a source that knows no palms.
    pub fn root(self, pose: &KeyPose) -> Option<Vec3> {
        let points = self.points();
        pose.get(points.palm).or_else(|| pose.get(points.wrist))
    }

    /// The palm's axes; `None` if its points are not seen or lie on a line.
    pub fn palm_frame(self, pose: &KeyPose) -> Option<PalmFrame> {
        let points = self.points();
        let origin = pose.get(points.wrist).or_else(|| pose.get(points.palm))?;
        let bases = points.fingers[1..].iter().map(|finger| finger[0]);
        let (sum, count) = bases
            .filter_map(|base| pose.get(base))
            .fold((Vec3::zeros(), 0.0), |(sum, n), at| (sum + at, n + 1.0));
        let [_, index, .., little] = points.fingers;
        let across = pose.get(little[0])? - pose.get(index[0])?;
        let forward = (sum / count - origin).try_normalize(1e-9)?;
        let lateral = (across - forward * across.dot(&forward)).try_normalize(1e-9)?;
        let normal = match self {
            Hand::Right => lateral.cross(&forward),
            Hand::Left => forward.cross(&lateral),
        };
        Some(PalmFrame {
            lateral,
            normal,
            forward,
        })
    }

    /// Mean length of the index, middle, ring and little finger that are seen whole, in the source's unit.
    pub fn finger_length(self, pose: &KeyPose) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0);
        for finger in &self.points().fingers[1..] {
            if let Some(length) = length_of(pose, finger) {
                sum += length;
                count += 1.0;
            }
        }
        (count > 0.0 && sum > 1e-9).then(|| sum / count)
    }

    /// From the wrist to the tip of the middle finger when stretched, from the lengths of the fingers: sources disagree on where a
    /// palm begins.
    pub fn length(self, pose: &KeyPose) -> Option<f64> {
        Some(HAND_OF_FINGER * self.finger_length(pose)?)
    }

    /// The hand that a role is of, wrists included.
    pub fn of(role: Role) -> Option<Hand> {
        let is_of =
            |hand: &Hand| role == hand.points().wrist || hand.beside_wrist().contains(&role);
        Hand::BOTH.into_iter().find(is_of)
    }

    /// The palm and the points of the fingers: those that a body's arm does not have.
    pub const fn beside_wrist(self) -> [Role; 21] {
        let first = self.points().palm.index();
        let mut roles = [Role::ALL[first]; 21];
        let mut at = 0;
        while at < roles.len() {
            roles[at] = Role::ALL[first + at];
            at += 1;
        }
        roles
    }

    /// The lines in which a hand is drawn of which those points are known: from the wrist, or else the palm, to the bases of the
    /// fingers, along the fingers, and across from base to base. The first that ends in a point comes from nearer to the wrist.
    pub fn lines(self, is_known: impl Fn(Role) -> bool) -> Vec<(Role, Role)> {
        let HandPoints {
            wrist,
            palm,
            fingers,
        } = self.points();
        let root = [wrist, palm].into_iter().find(|role| is_known(*role));
        let (mut along, mut across, mut beside) = (Vec::new(), Vec::new(), None);
        for finger in fingers {
            let points = finger.into_iter().filter(|role| is_known(*role));
            let chain: Vec<Role> = root.into_iter().chain(points).collect();
            along.extend(chain.windows(2).map(|ends| (ends[0], ends[1])));
            let base = Some(finger[0]).filter(|role| is_known(*role));
            across.extend(beside.zip(base));
            beside = base;
        }
        along.extend(across);
        along
    }

    /// True if any of its points beside the wrist is seen.
    pub fn is_seen(self, pose: &KeyPose) -> bool {
        let mut roles = self.beside_wrist().into_iter();
        roles.any(|role| pose.get(role).is_some())
    }
}

/// Length along points that are all seen.
fn length_of(pose: &KeyPose, points: &[Role]) -> Option<f64> {
    let steps = points.windows(2);
    let lengths = steps.map(|ends| Some((pose.get(ends[1])? - pose.get(ends[0])?).norm()));
    lengths.sum()
}

/// A pose that shows a left hand and no right one as its mirror image, which shows a right hand; `None` of any other.
pub fn lone_left_as_right(pose: &KeyPose) -> Option<KeyPose> {
    if Hand::Right.is_seen(pose) || !Hand::Left.is_seen(pose) {
        return None;
    }
    Some(pose.mirrored())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::flat_hand;

    #[test]
    fn a_hand_and_its_mirror_image_have_the_same_coordinates() {
        let (left, right) = (
            flat_hand(Hand::Left, 0.3, 1.0),
            flat_hand(Hand::Right, 0.3, 1.0),
        );
        let tip = |hand: Hand, pose: &KeyPose| {
            let [base, .., tip] = hand.points().fingers[2];
            let along = pose.get(tip).unwrap() - pose.get(base).unwrap();
            hand.palm_frame(pose).unwrap().of_world(&along)
        };
        let (of_left, of_right) = (tip(Hand::Left, &left), tip(Hand::Right, &right));
        assert!((of_left - of_right).norm() < 1e-12);
        let image = lone_left_as_right(&left).unwrap();
        for role in right.roles() {
            assert!((image.get(role).unwrap() - right.get(role).unwrap()).norm() < 1e-12);
        }
        assert!(lone_left_as_right(&right).is_none());
    }

    #[test]
    fn lines_begin_at_the_wrist_and_pass_over_what_is_not_known() {
        let points = Hand::Left.points();
        let whole = Hand::Left.lines(|role| Hand::of(role) == Some(Hand::Left));
        assert_eq!(whole.len(), 5 * 4 + 4);
        assert_eq!(whole[0], (points.wrist, points.fingers[0][0]));
        let lacks = [points.wrist, points.fingers[0][2]];
        let palm =
            Hand::Left.lines(|role| Hand::of(role) == Some(Hand::Left) && !lacks.contains(&role));
        assert_eq!(palm[0].0, points.palm);
        assert!(palm.contains(&(points.fingers[0][1], points.fingers[0][3])));
        assert!(Hand::Left.lines(|role| role == points.wrist).is_empty());
    }

    #[test]
    fn the_length_of_a_hand_does_not_depend_on_its_pose() {
        let lengths = [0.0, 0.4, 0.9].map(|bend| {
            let pose = flat_hand(Hand::Right, bend, 1.0);
            Hand::Right.length(&pose).unwrap()
        });
        assert!((lengths[0] - 0.078 * HAND_OF_FINGER).abs() < 1e-9);
        assert!(lengths.iter().all(|l| (l - lengths[0]).abs() < 1e-9));
    }
}
