//! Checks role maps for impossible bodies. Each doubt is a sentence that says what to do.

use super::meaning::NameMeaning;
use super::names::JointNames;
use super::tree::JointTree;
use super::{ARMS, LEGS, Role, RoleMap, proportions};
use crate::clip::Skeleton;
use crate::math::Vec3;
use crate::pose::Profile;

/// Advice at the end of every sentence about wrong roles.
const REMEDY: &str = "assign the joints with --roles FILE";

/// Looks for what cannot be true of a person's body in `map`, in a few poses of it (world positions of each joint, any
/// unit and axes). O(poses × roles²).
///
/// Nothing is changed: a doubtful map may still be the best there is.
pub fn check(skeleton: &Skeleton, map: &RoleMap, poses: &[Vec<Vec3>]) -> Vec<String> {
    check_named(skeleton, &JointNames::of(skeleton), map, poses)
}

/// [`check`] with the names as they were read.
pub(crate) fn check_named(
    skeleton: &Skeleton,
    names: &JointNames,
    map: &RoleMap,
    poses: &[Vec<Vec3>],
) -> Vec<String> {
    // Hands and tracked points have no proportions of a body.
    let is_body = map.profile() == Profile::Body && !skeleton.is_empty();
    let Some(first) = poses.first().filter(|_| is_body) else {
        return Vec::new();
    };
    let body = PosedBody {
        skeleton,
        names,
        map,
        poses,
    };
    let mut doubts = Vec::new();
    doubts.extend(body.not_human(first));
    doubts.extend(body.in_one_point());
    doubts.extend(body.exchanged());
    doubts.extend(body.upside_down());
    doubts.extend(body.unequal());
    doubts
}

struct PosedBody<'a> {
    skeleton: &'a Skeleton,
    names: &'a JointNames,
    map: &'a RoleMap,
    poses: &'a [Vec<Vec3>],
}

impl PosedBody<'_> {
    fn at(&self, pose: &[Vec3], role: Role) -> Option<Vec3> {
        self.map.joint(role).map(|joint| pose[joint])
    }

    fn name(&self, role: Role) -> &str {
        match self.map.joint(role) {
            Some(joint) => &self.skeleton.joints()[joint].name,
            None => "-",
        }
    }

    fn middle(&self, pose: &[Vec3], a: Role, b: Role) -> Option<Vec3> {
        Some((self.at(pose, a)? + self.at(pose, b)?) / 2.0)
    }

    /// The median over poses of what can be measured in them.
    fn median(&self, measure: impl Fn(&[Vec3]) -> Option<f64>) -> Option<f64> {
        let mut values: Vec<f64> = self.poses.iter().filter_map(|pose| measure(pose)).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    }

    fn distance(&self, a: Role, b: Role) -> Option<f64> {
        self.median(|pose| Some((self.at(pose, a)? - self.at(pose, b)?).norm()))
    }

    /// Both bones of a limb together.
    fn limb(&self, [a, b, c]: [Role; 3]) -> Option<f64> {
        Some(self.distance(a, b)? + self.distance(b, c)?)
    }

    /// Either limb of a pair, or their mean.
    fn pair(&self, [left, right]: [[Role; 3]; 2]) -> Option<f64> {
        match (self.limb(left), self.limb(right)) {
            (Some(left), Some(right)) => Some((left + right) / 2.0),
            (left, right) => left.or(right),
        }
    }

    fn trunk(&self, pose: &[Vec3]) -> Option<Vec3> {
        let hips = self
            .middle(pose, Role::LeftThigh, Role::RightThigh)
            .or(self.at(pose, Role::Hips))?;
        let top = self
            .middle(pose, Role::LeftArm, Role::RightArm)
            .or(self.at(pose, Role::Neck))?;
        Some(top - hips)
    }

    /// Roles that people have in different places, played in one.
    fn in_one_point(&self) -> Option<String> {
        const NEAR: f64 = 1e-3;
        let size = self
            .pair(LEGS)
            .or(self.pair(ARMS))
            .or_else(|| self.extent())?;
        let mut pairs: Vec<(Role, Role)> = Vec::new();
        for limb in LEGS.iter().chain(&ARMS) {
            pairs.extend([(limb[0], limb[1]), (limb[1], limb[2])]);
        }
        pairs.extend((0..3).map(|i| (LEGS[0][i], LEGS[1][i])));
        pairs.extend((0..3).map(|i| (ARMS[0][i], ARMS[1][i])));
        pairs.extend([(Role::Hips, Role::Neck), (Role::Neck, Role::Head)]);
        let together = |&(a, b): &(Role, Role)| {
            self.poses
                .iter()
                .all(|pose| match (self.at(pose, a), self.at(pose, b)) {
                    (Some(a), Some(b)) => (a - b).norm() <= NEAR * size,
                    _ => false,
                })
        };
        let (a, b) = pairs.into_iter().find(together)?;
        Some(format!(
            "{a} (`{}`) and {b} (`{}`) are at the same point, which is impossible in a person: {REMEDY}",
            self.name(a),
            self.name(b)
        ))
    }

    fn extent(&self) -> Option<f64> {
        let pose = self.poses.first()?;
        let largest = pose
            .iter()
            .map(|p| (p - pose[0]).norm())
            .fold(0.0, f64::max);
        (largest > 0.0).then_some(largest)
    }

    /// Knees that bend backwards.
    fn exchanged(&self) -> Option<String> {
        // Legs that are nearly straight bend any way in the noise of a depth camera.
        const LEAST_BEND: f64 = 0.25;
        const LEAST_POSES: usize = 3;
        let (mut sum, mut count) = (0.0, 0);
        for pose in self.poses {
            let front = || {
                let apart = self.at(pose, Role::LeftThigh)? - self.at(pose, Role::RightThigh)?;
                apart.cross(&self.trunk(pose)?).try_normalize(1e-12)
            };
            let Some(front) = front() else { continue };
            for leg in LEGS {
                let Some([hip, knee, ankle]) = self.joints(pose, leg) else {
                    continue;
                };
                let line = ankle - hip;
                let along = (knee - hip).dot(&line) / line.norm_squared().max(1e-12);
                let out = knee - hip - line * along;
                if out.norm() > LEAST_BEND * line.norm() {
                    sum += out.dot(&front) / out.norm();
                    count += 1;
                }
            }
        }
        (count >= LEAST_POSES && sum / f64::from(u32::try_from(count).ok()?) < -0.5).then(|| {
            "the knees bend backwards: left and right are exchanged, or one axis of the file is reversed; exchange the names \
             with --roles FILE, or export the file again with the other axis direction"
                .to_owned()
        })
    }

    fn joints(&self, pose: &[Vec3], [a, b, c]: [Role; 3]) -> Option<[Vec3; 3]> {
        Some([self.at(pose, a)?, self.at(pose, b)?, self.at(pose, c)?])
    }

    /// A head nearer to the feet than the hips are.
    fn upside_down(&self) -> Option<String> {
        let up_from = |left, right| {
            self.median(|pose| {
                let hips = self.at(pose, Role::Hips)?;
                let head = self.at(pose, Role::Head).or(self.at(pose, Role::Neck))?;
                let below = self.middle(pose, left, right)?;
                Some((head - hips).normalize().dot(&(hips - below).normalize()))
            })
        };
        // Knees are above the hips of somebody who sits low, but not straight below the head.
        let is_wrong = match up_from(Role::LeftFoot, Role::RightFoot) {
            Some(up) => up < -0.2,
            None => up_from(Role::LeftShin, Role::RightShin)? < -0.8,
        };
        is_wrong.then(|| {
            format!(
                "the head (`{}`) is below the hips (`{}`), where the feet are: {REMEDY}",
                self.name(Role::Head),
                self.name(Role::Hips)
            )
        })
    }

    /// Limbs of which one is much longer than the other.
    fn unequal(&self) -> Option<String> {
        // Depth cameras are off by a third.
        const MOST: f64 = 1.6;
        let bones = [LEGS, ARMS].into_iter().flat_map(|[left, right]| {
            [0, 1].map(|i| ([left[i], left[i + 1]], [right[i], right[i + 1]]))
        });
        let mut unequal = bones.filter_map(|(left, right)| {
            let a = self.distance(left[0], left[1])?;
            let b = self.distance(right[0], right[1])?;
            (a.max(b) > MOST * a.min(b)).then_some((left[0], right[0], a, b))
        });
        let (left, right, a, b) = unequal.next()?;
        Some(format!(
            "{left} (`{}`) is {a:.3} long and {right} (`{}`) {b:.3}, which does not fit a person: {REMEDY}",
            self.name(left),
            self.name(right)
        ))
    }

    /// True if this is a body of something else than a person.
    fn not_human(&self, first: &[Vec3]) -> Option<String> {
        let poses = [first.to_vec()];
        let tree = JointTree::new(self.skeleton, self.names, &poses);
        let why = self
            .other_limbs(&tree)
            .or_else(|| self.on_all_fours())
            .or_else(|| self.out_of_proportion())?;
        Some(format!(
            "this is probably not a human body: {why}. It is compared with human motion nevertheless: leave the clip out or, if \
             it shows a person, assign the joints with --roles FILE"
        ))
    }

    /// No limbs at all, limbs of animals, or too many.
    fn other_limbs(&self, tree: &JointTree) -> Option<String> {
        let has = |limb: &[Role; 3]| {
            limb.iter()
                .filter(|r| self.map.joint(**r).is_some())
                .count()
                > 1
        };
        let limbs = LEGS.iter().chain(&ARMS).filter(|limb| has(limb)).count();
        if limbs < 2 {
            return Some("it has no arms and legs".to_owned());
        }
        let has_none = |roles: &[Role]| roles.iter().all(|role| self.map.joint(*role).is_none());
        if LEGS.iter().all(|leg| has_none(leg)) && has_none(&[Role::Torso, Role::Neck, Role::Head])
        {
            return Some("it has neither trunk, head nor legs".to_owned());
        }
        if let Some(name) = self.further_limb(tree) {
            return Some(format!(
                "it has limbs besides its arms and legs, `{name}` among them"
            ));
        }
        let human = self.human_words();
        let mut readings = self.names.readings().iter();
        let animal = readings.position(|r| r.kind == NameMeaning::Animal && r.side.is_some());
        if let Some(joint) = animal.filter(|_| human < 4) {
            let name = &self.skeleton.joints()[joint].name;
            return Some(format!("it has a joint `{name}`"));
        }
        if human >= 4 || !self.skeleton.joints().iter().any(|j| j.parent.is_some()) {
            return None;
        }
        let longest = tree.size();
        let long = |pair: &super::tree::MirroredPair| {
            pair.members
                .iter()
                .all(|&m| tree.reach(m) > 0.45 * longest && tree.main_chain(m).len() > 2)
        };
        let pairs = tree.pairs().iter().filter(|pair| long(pair)).count();
        (pairs > 2).then(|| format!("it has {} long limbs", 2 * pairs))
    }

    /// A joint that begins one of a pair of limbs as long as legs, which are called so or stand where the feet do, and which no
    /// role is played by. Helper joints that lie on the limbs, hair and skirts do not count.
    fn further_limb(&self, tree: &JointTree) -> Option<&str> {
        const LONG: f64 = 0.6;
        const NEAR: f64 = 0.2;
        const LEAST_JOINTS: usize = 3;
        let pose = tree.positions;
        let leg = self.pair(LEGS)?;
        let limbs = LEGS.iter().chain(&ARMS);
        let played: Vec<usize> = limbs
            .flatten()
            .filter_map(|role| self.map.joint(*role))
            .collect();
        let hips = self.middle(pose, Role::LeftThigh, Role::RightThigh)?;
        let down = self.middle(pose, Role::LeftFoot, Role::RightFoot)? - hips;
        let is_further = |&member: &usize| {
            let own = |&joint: &usize| {
                joint == member || tree.is_above(member, joint) || tree.is_above(joint, member)
            };
            let chain = tree.main_chain(member);
            let Some(&end) = chain.last().filter(|_| chain.len() >= LEAST_JOINTS) else {
                return false;
            };
            let beside = |&joint: &usize| (pose[joint] - pose[end]).norm() > NEAR * leg;
            let stands = (pose[end] - hips).dot(&down) > 0.9 * down.norm_squared();
            tree.reach(member) > LONG * leg
                && !played.iter().any(own)
                && played.iter().all(beside)
                && (stands || tree.leg_votes(member) != 0)
        };
        let pairs = tree.pairs();
        let pair = pairs
            .iter()
            .find(|pair| pair.members.iter().all(is_further))?;
        Some(&self.skeleton.joints()[pair.members[0]].name)
    }

    /// Number of parts of human limbs that the names tell, on both sides.
    fn human_words(&self) -> usize {
        let readings = self.names.readings();
        let both = |fits: &dyn Fn(NameMeaning) -> bool| {
            let side = |side| {
                readings
                    .iter()
                    .any(|r| r.side == Some(side) && fits(r.kind))
            };
            side(super::meaning::Side::Left) && side(super::meaning::Side::Right)
        };
        [
            both(&|k| k == NameMeaning::Thigh),
            both(&|k| k == NameMeaning::Shin),
            both(&|k| k == NameMeaning::Foot),
            both(&|k| {
                matches!(
                    k,
                    NameMeaning::UpperArm
                        | NameMeaning::Arm
                        | NameMeaning::Shoulder
                        | NameMeaning::Collar
                )
            }),
            both(&|k| k == NameMeaning::Forearm),
            both(&|k| k == NameMeaning::Hand),
        ]
        .into_iter()
        .filter(|&there| there)
        .count()
    }

    /// A level trunk on four legs, in nearly all poses.
    fn on_all_fours(&self) -> Option<String> {
        let down =
            |pose: &[Vec3], [a, _, c]: [Role; 3]| Some(self.at(pose, c)? - self.at(pose, a)?);
        let both = |pose: &[Vec3], [left, right]: [[Role; 3]; 2]| {
            (down(pose, left)? + down(pose, right)?).try_normalize(1e-12)
        };
        let upright = self.median(|pose| {
            let trunk = self.trunk(pose)?.try_normalize(1e-12)?;
            Some(-trunk.dot(&both(pose, LEGS)?))
        })?;
        let together = self.median(|pose| Some(both(pose, ARMS)?.dot(&both(pose, LEGS)?)))?;
        let share = self.pair(ARMS)? / self.pair(LEGS)?;
        (upright < 0.5 && together > 0.5 && share > 0.55).then(|| {
            "its trunk lies level, and the arms stand on the ground as the legs do".to_owned()
        })
    }

    /// Lengths that no person has, with room for cartoons.
    fn out_of_proportion(&self) -> Option<String> {
        let leg = self.pair(LEGS)?;
        let arm = self.pair(ARMS);
        let trunk = self.median(|pose| Some(self.trunk(pose)?.norm()));
        let part = |[left, right]: [[Role; 3]; 2]| {
            let upper = self
                .distance(left[0], left[1])
                .or(self.distance(right[0], right[1]))?;
            let lower = self
                .distance(left[1], left[2])
                .or(self.distance(right[1], right[2]))?;
            Some(upper / lower)
        };
        let figures = [
            (
                "arms",
                "legs",
                arm.map(|arm| arm / leg),
                proportions::ARM_TO_LEG,
                2.2,
            ),
            (
                "trunk",
                "legs",
                trunk.map(|trunk| trunk / leg),
                proportions::TRUNK_TO_LEG,
                2.6,
            ),
            (
                "thighs",
                "shins",
                part(LEGS),
                proportions::THIGH_TO_SHIN,
                2.0,
            ),
            (
                "upper arms",
                "forearms",
                part(ARMS),
                proportions::ARM_TO_FOREARM,
                2.4,
            ),
        ];
        figures.into_iter().find_map(|(what, of, share, usual, most)| {
            let share = share?;
            let off = (share / usual).max(usual / share);
            (off > most).then(|| {
                format!("its {what} are {share:.2} times as long as its {of}, where people have {usual:.2}")
            })
        })
    }
}

#[cfg(test)]
mod tests;
