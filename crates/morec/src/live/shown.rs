//! Which bones a stream really shows.

use crate::features::{ALL_BONES, BoneSet, KeyPose};

/// What is looked at together.
const WINDOW_SECS: f64 = 1.0;
/// Fewer poses in it say nothing.
const LEAST_POSES: u16 = 5;

/// Follows which bones a stream shows, to use others than a recogniser was made for: a performer whose legs are never in the picture
/// would not be recognised by them at all. Bones that are seen later are taken in; bones that were seen once stay, where they were last.
#[derive(Debug, Clone)]
pub struct ShownBones {
    /// What the model can use.
    possible: BoneSet,
    is_first: bool,
    begun_secs: Option<f64>,
    poses: u16,
    /// Poses of the window that show each bone.
    counts: [u16; ALL_BONES.len()],
}

impl ShownBones {
    /// Of a model that can use the bones `possible`.
    pub fn new(possible: BoneSet) -> Self {
        Self {
            possible,
            is_first: true,
            begun_secs: None,
            poses: 0,
            counts: [0; ALL_BONES.len()],
        }
    }

    /// Takes a pose of a stream that is recognised by the bones `used`. The bones to use from now on, if others: after the first second
    /// those that at least half of its poses show, after each later one those that have come. Bones of which the model has none, where
    /// nothing else is shown: a recogniser for them says why there is none. Next to nothing once all are used.
    pub fn take(&mut self, used: BoneSet, time_secs: f64, pose: &KeyPose) -> Option<BoneSet> {
        if self.possible.is_empty() || (!self.is_first && used == self.possible) {
            return None;
        }
        let begun_secs = *self.begun_secs.get_or_insert(time_secs);
        for bone in BoneSet::of_pose(pose).indices() {
            self.counts[bone] += 1;
        }
        self.poses += 1;
        if time_secs - begun_secs < WINDOW_SECS && self.poses < u16::MAX {
            return None;
        }
        let shown = (0..ALL_BONES.len())
            .filter(|&bone| 2 * u32::from(self.counts[bone]) >= u32::from(self.poses))
            .fold(BoneSet::NONE, BoneSet::with);
        let (was_first, is_known) = (self.is_first, self.poses >= LEAST_POSES);
        self.reset();
        if !is_known || shown.is_empty() {
            self.is_first = was_first;
            return None;
        }
        let usable = shown.and(self.possible);
        self.is_first = was_first && usable.is_empty();
        match (was_first, usable.is_empty()) {
            (true, true) => Some(shown),
            (true, false) => Some(usable),
            (false, _) => Some(used.or(usable)),
        }
        .filter(|wanted| *wanted != used)
    }

    /// The next pose is of another stream.
    pub fn reset(&mut self) {
        *self = Self::new(self.possible);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::roles::Role;

    /// A pose that shows `roles`, each somewhere else.
    fn showing(roles: &[Role]) -> KeyPose {
        let mut pose = KeyPose::default();
        for role in roles {
            let at = role.index() as f64;
            pose.set(*role, Vec3::new(at.sin(), at.cos(), 0.1 * at));
        }
        pose
    }

    const ARM: [Role; 3] = [Role::LeftArm, Role::LeftForearm, Role::LeftHand];
    const LEG: [Role; 3] = [Role::LeftThigh, Role::LeftShin, Role::LeftFoot];

    /// What is used after each change, with poses at `rate_hz`.
    fn used(rate_hz: f64, secs: f64, show: impl Fn(f64) -> Vec<Role>) -> Vec<BoneSet> {
        let possible = BoneSet::of_pose(&showing(&[ARM, LEG].concat()));
        let mut watch = ShownBones::new(possible);
        let mut used = vec![possible];
        for frame in 0..(secs * rate_hz) as usize {
            let secs = frame as f64 / rate_hz;
            let now = *used.last().unwrap();
            used.extend(watch.take(now, secs, &showing(&show(secs))));
        }
        used
    }

    #[test]
    fn what_never_comes_is_left_out_and_what_comes_later_is_taken_in() {
        let both = [ARM, LEG].concat();
        let (arm, all) = (
            BoneSet::of_pose(&showing(&ARM)),
            BoneSet::of_pose(&showing(&both)),
        );
        for rate_hz in [10.0, 30.0, 200.0] {
            assert_eq!(used(rate_hz, 10.0, |_| both.clone()), [all]);
            assert_eq!(used(rate_hz, 10.0, |_| ARM.to_vec()), [all, arm]);
            let later = used(rate_hz, 10.0, |secs| match secs < 4.2 {
                true => ARM.to_vec(),
                false => both.clone(),
            });
            assert_eq!(later, [all, arm, all]);
            // Once seen, nothing is given up.
            let gone = used(rate_hz, 10.0, |secs| match secs < 4.2 {
                true => both.clone(),
                false => ARM.to_vec(),
            });
            assert_eq!(gone, [all]);
            assert_eq!(used(rate_hz, 10.0, |_| Vec::new()), [all]);
        }
        // Two poses a second say too little.
        assert_eq!(used(2.0, 10.0, |_| ARM.to_vec()), [all]);
    }
}
