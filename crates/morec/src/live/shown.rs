//! Determines which bones a stream contains, as joints appear.

use crate::features::{ALL_BONES, BoneSet, KeyPose, breaks_stretch};

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
    /// What is used on, if it was: where hands are kept apart, one that is seen alone would be taken for either.
    kept: BoneSet,
    is_first: bool,
    /// True if the last window showed nothing of that, and something else.
    is_other: bool,
    /// Times of the window's first and last pose.
    secs: Option<(f64, f64)>,
    poses: u16,
    /// Poses of the window that show each bone.
    counts: [u16; ALL_BONES.len()],
}

impl ShownBones {
    /// Of a model that can use the bones `possible`.
    pub fn new(possible: BoneSet) -> Self {
        let keeps_hands_apart = !possible.and(BoneSet::LEFT_HAND).is_empty();
        Self {
            possible,
            kept: match keeps_hands_apart {
                true => possible.and(BoneSet::HANDS),
                false => BoneSet::NONE,
            },
            is_first: true,
            is_other: false,
            secs: None,
            poses: 0,
            counts: [0; ALL_BONES.len()],
        }
    }

    /// Takes a pose of a stream that is recognised by the bones `used`, and returns a new set of bones when it changes: after one
    /// second the bones seen in at least half of its poses, after each later second those that appeared. If the model shares none of
    /// them, returns them anyway, so that the caller can report the error. Costs almost nothing once all bones are used.
    pub fn take(&mut self, used: BoneSet, time_secs: f64, pose: &KeyPose) -> Option<BoneSet> {
        if self.possible.is_empty() || (!self.is_first && used == self.possible) {
            return None;
        }
        if !time_secs.is_finite() {
            return None;
        }
        if (self.secs).is_some_and(|(_, last_secs)| breaks_stretch(last_secs, time_secs)) {
            self.begin_window();
        }
        let (begun_secs, last_secs) = self.secs.unwrap_or((time_secs, time_secs));
        // The recogniser leaves out what was overtaken, too.
        if time_secs < last_secs {
            return None;
        }
        self.secs = Some((begun_secs, time_secs));
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
        self.begin_window();
        if !is_known || shown.is_empty() {
            return None;
        }
        let usable = shown.and(self.possible);
        self.is_other = usable.is_empty();
        self.is_first = was_first && self.is_other;
        let wanted = match (was_first, self.is_other) {
            (true, true) => shown,
            (true, false) => usable.or(self.kept.and(used)),
            (false, _) => used.or(usable),
        };
        (wanted != used).then_some(wanted)
    }

    /// True if the last second showed nothing that the model can use, and something else: a performer of another kind.
    pub fn is_other(&self) -> bool {
        self.is_other
    }

    /// The next pose is of another stream.
    pub fn reset(&mut self) {
        (self.is_first, self.is_other) = (true, false);
        self.begin_window();
    }

    fn begin_window(&mut self) {
        (self.secs, self.poses) = (None, 0);
        self.counts.fill(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::Hand;
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
        // A clock that goes back, as of another recording, begins anew.
        let again = |secs: f64| if secs < 0.5 { 100.0 } else { secs };
        let possible = BoneSet::of_pose(&showing(&both));
        let mut watch = ShownBones::new(possible);
        let mut last = None;
        for frame in 0..90 {
            let secs = again(f64::from(frame) / 30.0);
            last = last.or(watch.take(possible, secs, &showing(&ARM)));
        }
        assert_eq!(last, Some(arm));
        // Poses that were overtaken on the way do not count, and neither does one at no time.
        let mut watch = ShownBones::new(possible);
        let mut last = None;
        for frame in 0..60 {
            let secs = f64::from(frame) / 30.0;
            for secs in [secs, secs - 0.05, f64::NAN] {
                last = last.or(watch.take(possible, secs, &showing(&ARM)));
            }
        }
        assert_eq!(last, Some(arm));
        // Two poses a second say too little.
        assert_eq!(used(2.0, 10.0, |_| ARM.to_vec()), [all]);
    }

    /// A hand by its wrist and fingers.
    fn hand(hand: Hand) -> Vec<Role> {
        let points = hand.points();
        [&[points.wrist], points.fingers.as_flattened()].concat()
    }

    #[test]
    fn hands_that_are_kept_apart_stay_so_and_none_is_added() {
        let apart = BoneSet::LEFT_HAND.or(BoneSet::HAND);
        let windows = |used, show: &[Role]| {
            let mut watch = ShownBones::new(apart);
            let poses = (0..90).map(|frame| f64::from(frame) / 30.0);
            let wanted: Vec<BoneSet> = poses
                .filter_map(|secs| watch.take(used, secs, &showing(show)))
                .collect();
            (wanted, watch.is_other())
        };
        // One that was announced and is not seen may come.
        assert_eq!(windows(apart, &hand(Hand::Right)), (vec![], false));
        // One that was not announced is not waited for.
        assert_eq!(windows(BoneSet::HAND, &hand(Hand::Right)), (vec![], false));
        // A performer of another kind.
        let (wanted, is_other) = windows(apart, &ARM);
        assert!(is_other && wanted.iter().all(|bones| bones.and(apart).is_empty()));
        assert!(!wanted.is_empty());
    }
}
