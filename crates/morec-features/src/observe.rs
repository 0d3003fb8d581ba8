//! From joint positions to bone directions as the performer sees them.

use mocap::math::{DirectionSlerp, Vec3, portable};
use mocap::roles::{ARMS, Role};

use crate::{ALL_BONES, Bone, BoneKind, BoneSet, Hand, HeadingLine, KeyPose, PalmFrame, Profile};

/// One frame's bones in the frames they are given in, and where the root is.
///
/// The heading frame turns about the vertical with the hips: lateral axis from the right to the left hip joint
/// without its vertical part, up is +Y, forward is lateral × up. Coordinates are (lateral, up, forward). The shoulders have
/// the hips' place in a stream that shows no hip joints, as of a performer behind a table, and for an index that was trained
/// without hips ([`HeadingLine`]). Hands have no heading: lateral is the source's X, forward its Z.
#[derive(Debug, PartialEq)]
pub struct Observation {
    /// Of each bone of the set's [span](BoneSet::span) what its [`BoneKind`] says, mostly unit vectors, `heading_from_world` applied;
    /// zero for bones outside the set.
    pub directions: Vec<Vec3>,
    /// World position of the hips, of the middle of the shoulders, or what is the root of a performer without a body
    /// ([`Profile`]), in the source's length unit.
    pub root: Vec3,
    /// Heading about +Y from +Z, continuous over time (it does not jump at ±π).
    pub yaw_rad: f64,
    /// The performer's length in the source's unit: of a leg or a hand, the mean over the stream so far; of a custom skeleton the mean
    /// distance of its points from the root; of three tracked points the largest distance from the head to a hand.
    pub unit_length: f64,
}

impl Clone for Observation {
    fn clone(&self) -> Self {
        Self {
            directions: self.directions.clone(),
            ..*self
        }
    }

    /// Without allocation where the bones are the same.
    fn clone_from(&mut self, source: &Self) {
        self.directions.clone_from(&source.directions);
        (self.root, self.yaw_rad, self.unit_length) =
            (source.root, source.yaw_rad, source.unit_length);
    }
}

impl Observation {
    /// One of nothing.
    pub fn blank(bones: BoneSet) -> Self {
        Self {
            directions: vec![Vec3::zeros(); bones.span().len()],
            root: Vec3::zeros(),
            yaw_rad: 0.0,
            unit_length: 1.0,
        }
    }

    /// Makes this the one between `a` and `b`, `t` of the way; unit vectors along great circles, the rest on a line.
    pub fn set(&mut self, a: &Self, b: &Self, t: f64, bones: BoneSet) {
        if t <= 0.0 || t >= 1.0 {
            return self.clone_from(if t <= 0.0 { a } else { b });
        }
        let first = bones.span().start;
        let slerp = DirectionSlerp::new(t);
        for bone in bones.indices() {
            let (from, to) = (&a.directions[bone - first], &b.directions[bone - first]);
            self.directions[bone - first] = match ALL_BONES[bone].kind {
                BoneKind::Direction | BoneKind::PalmForward(_) | BoneKind::PalmNormal(_) => {
                    slerp.between(from, to)
                }
                BoneKind::Offset | BoneKind::Palms | BoneKind::Finger(_) => from.lerp(to, t),
            };
        }
        self.root = a.root.lerp(&b.root, t);
        self.yaw_rad = a.yaw_rad + (b.yaw_rad - a.yaw_rad) * t;
        self.unit_length = a.unit_length + (b.unit_length - a.unit_length) * t;
    }
}

/// A length over a stream: the mean of what was seen, or the largest.
#[derive(Debug, Clone, Copy, Default)]
struct Length {
    sum: f64,
    count: f64,
    largest: f64,
}

impl Length {
    fn take(&mut self, length: Option<f64>) {
        if let Some(length) = length.filter(|length| *length > 1e-9) {
            self.sum += length;
            self.count += 1.0;
            self.largest = self.largest.max(length);
        }
    }

    fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }

    fn largest(&self) -> Option<f64> {
        (self.count > 0.0).then_some(self.largest)
    }
}

/// Turns poses into observations; remembers what a missing joint did last.
#[derive(Debug, Clone)]
pub struct Observer {
    bones: BoneSet,
    profile: Profile,
    heading: HeadingLine,
    last: Observation,
    /// True if there is a last one.
    begun: bool,
    length: Length,
    /// True if the hip joints have been seen and count: the heading then stays theirs.
    hips_seen: bool,
}

impl Observer {
    /// For the bones an index uses, and what it takes the heading from.
    pub fn new(bones: BoneSet, heading: HeadingLine) -> Self {
        let profile = Profile::of(bones);
        Self {
            bones,
            profile,
            heading: match profile {
                Profile::Body => heading,
                // A skeleton that has no pair of points has no heading either.
                Profile::Custom if heading == HeadingLine::Points && has_pair(bones) => heading,
                Profile::Points3 if heading == HeadingLine::Headset => heading,
                _ => HeadingLine::Sensor,
            },
            last: Observation::blank(bones),
            begun: false,
            length: Length::default(),
            hips_seen: false,
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.last.directions.fill(Vec3::zeros());
        self.begun = false;
        self.length = Length::default();
        self.hips_seen = false;
    }

    /// See [`Observation::unit_length`]; `None` until it was seen.
    pub fn unit_length(&self) -> Option<f64> {
        match self.profile {
            Profile::Points3 => self.length.largest(),
            _ => self.length.mean(),
        }
    }

    /// The observation of one pose. A bone or heading that `pose` does not show keeps its last direction;
    /// `None` until the hip joints or the shoulders have been seen once, or the root of a performer without a body.
    pub fn observe(&mut self, pose: &KeyPose) -> Option<&Observation> {
        self.hips_seen |= self.heading == HeadingLine::Hips
            && pair(pose, Role::LeftThigh, Role::RightThigh).is_some();
        let yaw_rad = self.yaw(pose)?;
        let (sin, cos) = portable::sin_cos(yaw_rad);
        let root = self.root(pose)?;
        self.measure_length(pose);
        let unit_length = self.unit_length().unwrap_or(1.0);
        let first = self.bones.span().start;
        let palms = Hand::BOTH.map(|hand| self.palm(hand, pose));
        for index in self.bones.indices() {
            let bone = &ALL_BONES[index];
            let palm = bone.hand().and_then(|hand| palms[hand as usize]);
            if let Some(seen) = seen(bone, pose, palm, unit_length, (sin, cos)) {
                self.last.directions[index - first] = seen;
            }
        }
        (self.last.root, self.last.yaw_rad, self.last.unit_length) = (root, yaw_rad, unit_length);
        self.begun = true;
        Some(&self.last)
    }

    /// The palm of a hand whose bones count, and the length of its fingers; `None` of other hands, and where it is not seen.
    fn palm(&self, hand: Hand, pose: &KeyPose) -> Option<(PalmFrame, Option<f64>)> {
        let bones = match hand {
            Hand::Left => BoneSet::LEFT_HAND,
            Hand::Right => BoneSet::HAND,
        };
        match self.bones.and(bones).is_empty() {
            true => None,
            false => Some((hand.palm_frame(pose)?, hand.finger_length(pose))),
        }
    }

    fn yaw(&self, pose: &KeyPose) -> Option<f64> {
        if self.heading == HeadingLine::Sensor {
            return Some(0.0);
        }
        let last = self.begun.then_some(self.last.yaw_rad);
        if self.heading == HeadingLine::Headset {
            let unknown = last.or(Some(0.0));
            let Some((head, face)) = pair(pose, Role::Head, Role::Face) else {
                return unknown;
            };
            let forward = face - head;
            // Whoever looks straight up or down faces as before.
            return match portable::hypot(forward.x, forward.z) < 1e-3 * forward.norm() {
                true => unknown,
                false => Some(unrolled(portable::atan2(forward.x, forward.z), last)),
            };
        }
        let lateral = match self.heading {
            HeadingLine::Points => pair(pose, Role::LeftPoint1, Role::RightPoint1),
            _ if self.hips_seen => pair(pose, Role::LeftThigh, Role::RightThigh),
            _ => pair(pose, Role::LeftArm, Role::RightArm),
        };
        let Some((left, right)) = lateral else {
            return last;
        };
        let lateral = left - right;
        // Hips seen straight from the side of the vertical have no heading.
        if portable::hypot(lateral.x, lateral.z) < 1e-9 {
            return last;
        }
        Some(unrolled(portable::atan2(-lateral.z, lateral.x), last))
    }

    fn root(&self, pose: &KeyPose) -> Option<Vec3> {
        let middle = |(left, right): (Vec3, Vec3)| (left + right) / 2.0;
        let hips = pose
            .get(Role::Hips)
            .or_else(|| pair(pose, Role::LeftThigh, Role::RightThigh).map(middle));
        // Without hips the root is where the shoulders are: only its velocity counts.
        let shoulders = || pair(pose, Role::LeftArm, Role::RightArm).map(middle);
        let seen = match (self.profile, self.heading) {
            (Profile::Body, HeadingLine::Shoulders) => shoulders(),
            (Profile::Body, HeadingLine::Hips) if self.hips_seen => hips,
            (Profile::Body, _) => hips.or_else(shoulders),
            (profile, _) => profile.root(pose),
        };
        seen.or(self.begun.then_some(self.last.root))
    }

    fn measure_length(&mut self, pose: &KeyPose) {
        let of_arm = || {
            let arm = ARMS.into_iter().find_map(|arm| limb(pose, arm));
            arm.map(|length| length * LEG_OF_ARM)
        };
        let leg = || limb(pose, [Role::LeftThigh, Role::LeftShin, Role::LeftFoot]);
        self.length.take(match self.profile {
            Profile::Body if self.hips_seen => leg(),
            Profile::Body if self.heading == HeadingLine::Sensor => leg().or_else(of_arm),
            Profile::Body => of_arm(),
            Profile::Hand | Profile::Hands => self.profile.hand_length(pose),
            Profile::Points3 => reach(pose),
            Profile::Custom => {
                let ends = self.bones.indices().map(|bone| ALL_BONES[bone].to);
                size(pose, Role::Point1, ends)
            }
        });
    }
}

/// What of a bone is a feature, as [`BoneKind`] says, if `pose` shows it; `palm` is the palm of its hand and the length of the fingers.
fn seen(
    bone: &Bone,
    pose: &KeyPose,
    palm: Option<(PalmFrame, Option<f64>)>,
    unit_length: f64,
    (sin, cos): (f64, f64),
) -> Option<Vec3> {
    let along = || Some(pose.get(bone.to)? - pose.get(bone.from)?);
    let turned = |v: Vec3| heading_from_world(sin, cos, &v);
    match bone.kind {
        BoneKind::Direction => {
            let along = along()?;
            let length = along.norm();
            (length > 1e-9).then(|| turned(along / length))
        }
        BoneKind::Offset => Some(turned(along()? / unit_length)),
        BoneKind::Palms => {
            let [left, right] = Hand::BOTH.map(|hand| hand.root(pose));
            Some(turned((right? - left?) / unit_length))
        }
        BoneKind::Finger(_) => {
            let (frame, finger_length) = palm?;
            Some(frame.of_world(&(along()? / finger_length?)))
        }
        BoneKind::PalmForward(_) => Some(turned(palm?.0.forward)),
        BoneKind::PalmNormal(_) => Some(turned(palm?.0.normal)),
    }
}

/// The larger distance of a hand from the head.
fn reach(pose: &KeyPose) -> Option<f64> {
    let head = pose.get(Role::Head)?;
    let hands = [Role::LeftHand, Role::RightHand];
    let far = hands.map(|hand| Some((pose.get(hand)? - head).norm()));
    far.into_iter().flatten().max_by(f64::total_cmp)
}

/// The mean distance of the `ends` from the root, in a pose that shows them all.
fn size(pose: &KeyPose, root: Role, ends: impl Iterator<Item = Role>) -> Option<f64> {
    let root = pose.get(root)?;
    let (mut sum, mut count) = (0.0, 0.0);
    for end in ends {
        sum += (pose.get(end)? - root).norm();
        count += 1.0;
    }
    Some(sum / count)
}

/// `yaw` by as many whole turns as bring it nearest to the last one.
fn unrolled(yaw: f64, last: Option<f64>) -> f64 {
    let Some(last) = last else { return yaw };
    let turn = yaw - last;
    last + turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()
}

/// True if the points that give the heading of a custom skeleton are among the ends of `bones`.
fn has_pair(bones: BoneSet) -> bool {
    let pair = [Role::LeftPoint1, Role::RightPoint1];
    pair.iter()
        .all(|role| bones.indices().any(|b| ALL_BONES[b].to == *role))
}

/// Length of a leg without the foot in lengths of an arm without the hand, from shares of body height: (.245 + .246) /
/// (.186 + .146) (Winter, *Biomechanics and Motor Control of Human Movement*, 2009, Fig. 4.1).
const LEG_OF_ARM: f64 = 1.48;

/// Positions of two joints, if both are seen.
fn pair(pose: &KeyPose, left: Role, right: Role) -> Option<(Vec3, Vec3)> {
    Some((pose.get(left)?, pose.get(right)?))
}

/// Length of a limb over its three joints. Without the last, the second part counts as long as the first: within 5 % for
/// the legs of grown people.
fn limb(pose: &KeyPose, joints: [Role; 3]) -> Option<f64> {
    let [first, second, third] = joints;
    let (a, b) = pair(pose, first, second)?;
    let upper = (b - a).norm();
    let lower = pose.get(third).map_or(upper, |c| (c - b).norm());
    Some(upper + lower)
}

/// Turns a world direction into the heading frame of the yaw with this sine and cosine.
pub fn heading_from_world(sin: f64, cos: f64, v: &Vec3) -> Vec3 {
    Vec3::new(v.x * cos - v.z * sin, v.y, v.x * sin + v.z * cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap::math::Axis;

    fn observed(bones: BoneSet, pose: &KeyPose) -> Observation {
        let mut observer = Observer::new(bones, HeadingLine::Hips);
        observer.observe(pose).unwrap().clone()
    }

    fn standing(turned_rad: f64, scale: f64) -> KeyPose {
        let mut pose = KeyPose::default();
        let turn = mocap::math::Axis::Y.rotation(turned_rad);
        let mut put =
            |role, x: f64, y: f64, z: f64| pose.set(role, turn * Vec3::new(x, y, z) * scale);
        put(Role::Hips, 0.0, 1.0, 0.0);
        put(Role::LeftThigh, 0.1, 1.0, 0.0);
        put(Role::RightThigh, -0.1, 1.0, 0.0);
        put(Role::LeftShin, 0.1, 0.5, 0.1);
        put(Role::LeftFoot, 0.1, 0.0, 0.0);
        put(Role::Neck, 0.0, 1.5, 0.0);
        put(Role::LeftArm, 0.2, 1.4, 0.0);
        put(Role::LeftForearm, 0.2, 1.4, 0.3);
        pose
    }

    #[test]
    fn heading_and_size_do_not_change_directions() {
        let bones = BoneSet::of_pose(&standing(0.0, 1.0));
        let reference = observed(bones, &standing(0.0, 1.0));
        // The left arm points forward: +Z in the heading frame.
        assert!((reference.directions[6] - Vec3::z()).norm() < 1e-12);
        for step in 0..12 {
            let turned = observed(bones, &standing(f64::from(step), 3.0));
            for b in bones.indices() {
                assert!((turned.directions[b] - reference.directions[b]).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn yaw_is_continuous_over_many_turns() {
        let mut observer = Observer::new(BoneSet::BODY, HeadingLine::Hips);
        let mut last = 0.0;
        for step in 0..200 {
            let yaw = observer
                .observe(&standing(f64::from(step) * 0.2, 1.0))
                .unwrap()
                .yaw_rad;
            assert!(
                (yaw - f64::from(step) * 0.2).abs() < 1e-9,
                "{yaw} after {last}"
            );
            last = yaw;
        }
    }

    #[test]
    fn shoulders_stand_in_for_hips_that_are_never_seen() {
        let upper = |turned| {
            let mut pose = standing(turned, 1.0);
            pose.set(
                Role::RightArm,
                mocap::math::Axis::Y.rotation(turned) * Vec3::new(-0.2, 1.4, 0.0),
            );
            for role in [
                Role::Hips,
                Role::LeftThigh,
                Role::RightThigh,
                Role::LeftShin,
                Role::LeftFoot,
            ] {
                pose.set(role, Vec3::from_element(f64::NAN));
            }
            pose
        };
        let seen = observed(BoneSet::BODY, &upper(0.0));
        assert!((seen.directions[6] - Vec3::z()).norm() < 1e-12);
        let turned = observed(BoneSet::BODY, &upper(2.0));
        assert!((turned.directions[6] - seen.directions[6]).norm() < 1e-9);
        // The upper arm is 0.3 long, and so counts the forearm, which ends nowhere.
        assert!((seen.unit_length - 0.6 * LEG_OF_ARM).abs() < 1e-9);
    }

    #[test]
    fn an_index_of_shoulders_sees_the_same_with_hips_and_without() {
        let mut whole = standing(0.3, 1.0);
        whole.set(Role::RightArm, Vec3::new(-0.2, 1.4, 0.1));
        let mut half = KeyPose::default();
        for role in Role::ALL {
            let upper = role.index() >= Role::Neck.index();
            if let Some(place) = whole.get(role).filter(|_| upper) {
                half.set(role, place);
            }
        }
        let observe = |pose, heading| {
            let bones = BoneSet::ARMS;
            Observer::new(bones, heading).observe(pose).unwrap().clone()
        };
        let seen = observe(&half, HeadingLine::Shoulders);
        assert_eq!(observe(&whole, HeadingLine::Shoulders), seen);
        assert_eq!(observe(&half, HeadingLine::Hips), seen);
        assert_ne!(observe(&whole, HeadingLine::Hips), seen);
    }

    #[test]
    fn hips_that_were_seen_once_keep_the_heading() {
        let mut observer = Observer::new(BoneSet::BODY, HeadingLine::Hips);
        let seen = observer.observe(&standing(1.0, 1.0)).unwrap().clone();
        let mut hidden = standing(2.0, 1.0);
        hidden.set(Role::LeftThigh, Vec3::from_element(f64::NAN));
        assert_eq!(observer.observe(&hidden).unwrap().yaw_rad, seen.yaw_rad);
    }

    #[test]
    fn a_lost_joint_keeps_its_last_direction() {
        let mut observer = Observer::new(BoneSet::BODY, HeadingLine::Hips);
        let seen = observer.observe(&standing(0.0, 1.0)).unwrap().clone();
        let mut hidden = standing(0.0, 1.0);
        hidden.set(Role::LeftForearm, Vec3::new(f64::NAN, 0.0, 0.0));
        assert_eq!(
            observer.observe(&hidden).unwrap().directions[6],
            seen.directions[6]
        );
    }

    #[test]
    fn tracked_points_turn_with_the_headset_if_it_says_where_it_looks() {
        let pose = |turned_rad: f64, face: bool| {
            let mut pose = KeyPose::default();
            let turned = Axis::Y.rotation(turned_rad);
            let places = [
                (Role::Head, Vec3::new(0.0, 1.6, 0.0)),
                (Role::LeftHand, Vec3::new(0.3, 1.1, 0.2)),
                (Role::RightHand, Vec3::new(-0.2, 1.4, 0.5)),
                (Role::Face, Vec3::new(0.0, 1.55, 0.1)),
            ];
            for (role, at) in places {
                if role != Role::Face || face {
                    pose.set(role, turned * at);
                }
            }
            pose
        };
        let directions = |heading, pose: &KeyPose| {
            let mut observer = Observer::new(BoneSet::POINTS3, heading);
            observer.observe(pose).unwrap().directions.clone()
        };
        use HeadingLine::{Headset, Sensor};
        let ahead = directions(Sensor, &pose(0.0, false));
        for turned_rad in [0.0, 1.0, -2.5, 3.1] {
            let seen = directions(Headset, &pose(turned_rad, true));
            let off = seen.iter().zip(&ahead).map(|(a, b)| (a - b).norm());
            assert!(off.fold(0.0, f64::max) < 1e-9, "{turned_rad}");
            // Without a face, as the source has it.
            let (pose, faceless) = (pose(turned_rad, true), pose(turned_rad, false));
            let expected = directions(Sensor, &faceless);
            assert_eq!(directions(Sensor, &pose), expected);
            assert_eq!(directions(Headset, &faceless), expected);
        }
    }
}
