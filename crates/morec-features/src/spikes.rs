//! Single joints that jump away for a moment.

use mocap::math::Vec3;
use mocap::roles::Role;

use crate::{KeyPose, Profile};

/// Faster than this, in metres a second for a leg of 0.85 m, no joint moves relative to the hips, or to the shoulders before hips are
/// seen: thrown balls leave the hand at up to 45, but their hands, seen at 120 Hz, stay below 25. For a hand of 19 cm it is 6.3 m/s
/// relative to the palm, which fingers do not reach either.
const FASTEST: f64 = 28.0;
/// A joint that stays where it jumped to for longer than this is there.
const LONGEST_SECS: f64 = 0.12;
const LEG_METRES: f64 = 0.85;

/// Takes joints out of a pose that jumped farther from the pose before than any joint moves, until they come back.
///
/// A joint that is taken out counts as unseen: its bones keep their last directions. No delay, no allocation.
#[derive(Debug, Clone)]
pub(crate) struct SpikeFilter {
    /// Last position of each joint, relative to the hips or the shoulders, and its time.
    last: [Option<(f64, Vec3)>; Role::COUNT],
    /// True if the hips have been seen: positions then stay relative to them.
    hips_seen: bool,
    profile: Profile,
}

impl SpikeFilter {
    pub fn new(profile: Profile) -> Self {
        Self {
            last: [None; Role::COUNT],
            hips_seen: false,
            profile,
        }
    }

    pub fn reset(&mut self) {
        *self = Self::new(self.profile);
    }

    /// `pose` without the joints that jumped, if any did. `unit_length` gives the scale of the source's unit.
    pub fn clean(
        &mut self,
        time_secs: f64,
        pose: &KeyPose,
        unit_length: Option<f64>,
    ) -> Option<KeyPose> {
        // Before the length is known, too: it remembers whether hips were seen.
        let origin = self.origin(pose);
        let (unit, origin) = (unit_length?, origin?);
        let mut cleaned: Option<KeyPose> = None;
        let fastest = FASTEST * unit / LEG_METRES;
        for role in pose.roles() {
            let Some(place) = pose.get(role).map(|p| p - origin) else {
                continue;
            };
            let slot = &mut self.last[role.index()];
            if let Some((then, before)) = *slot {
                let secs = time_secs - then;
                let jumped = (place - before).norm() > fastest * secs.max(1e-3);
                if jumped && secs < LONGEST_SECS {
                    let cleaned = cleaned.get_or_insert(*pose);
                    cleaned.set(role, Vec3::repeat(f64::NAN));
                    continue;
                }
            }
            *slot = Some((time_secs, place));
        }
        cleaned
    }

    /// The place that others are relative to.
    fn origin(&mut self, pose: &KeyPose) -> Option<Vec3> {
        if self.profile != Profile::Body {
            return self.profile.root(pose);
        }
        let hips = pose.get(Role::Hips);
        if hips.is_some() && !self.hips_seen {
            self.reset();
            self.hips_seen = true;
        }
        if self.hips_seen {
            return hips;
        }
        Some((pose.get(Role::LeftArm)? + pose.get(Role::RightArm)?) / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hand(x: f64) -> KeyPose {
        let mut pose = KeyPose::default();
        pose.set(Role::Hips, Vec3::new(0.0, 1.0, 0.0));
        pose.set(Role::LeftHand, Vec3::new(x, 1.0, 0.0));
        pose
    }

    #[test]
    fn a_jump_and_back_is_unseen_and_what_stays_is_believed() {
        let mut filter = SpikeFilter::new(Profile::Body);
        let mut seen = |frame: usize, x: f64| {
            let pose = hand(x);
            let cleaned = filter.clean(frame as f64 / 30.0, &pose, Some(0.85));
            cleaned.unwrap_or(pose).get(Role::LeftHand).is_some()
        };
        assert!(seen(0, 0.3));
        assert!(!seen(1, 1.5), "36 m/s");
        assert!(seen(2, 0.35));
        assert!(!seen(3, 2.0));
        assert!(!seen(4, 5.0));
        let back: Vec<bool> = (5..12).map(|f| seen(f, 5.0)).collect();
        assert!(back[6], "it stays there: {back:?}");
    }

    #[test]
    fn without_hips_jumps_are_seen_from_the_shoulders() {
        let mut filter = SpikeFilter::new(Profile::Body);
        let mut seen = |frame: usize, x: f64, hips: bool| {
            let mut pose = hand(x);
            pose.set(Role::LeftArm, Vec3::new(0.2, 1.4, 0.0));
            pose.set(Role::RightArm, Vec3::new(-0.2, 1.4, 0.0));
            if !hips {
                pose.set(Role::Hips, Vec3::repeat(f64::NAN));
            }
            let cleaned = filter.clean(frame as f64 / 30.0, &pose, Some(0.85));
            cleaned.unwrap_or(pose).get(Role::LeftHand).is_some()
        };
        assert!(seen(0, 0.3, false));
        assert!(!seen(1, 1.5, false), "36 m/s");
        assert!(seen(2, 0.35, false));
        // Hips that come into view later are no jump of all joints.
        assert!(seen(3, 0.35, true));
        assert!(!seen(4, 2.0, true));
    }

    #[test]
    fn hips_that_were_seen_before_any_length_keep_the_shoulders_from_counting() {
        let mut filter = SpikeFilter::new(Profile::Body);
        let mut pose = hand(0.3);
        pose.set(Role::LeftArm, Vec3::new(0.2, 1.4, 0.0));
        pose.set(Role::RightArm, Vec3::new(-0.2, 1.4, 0.0));
        assert!(filter.clean(0.0, &pose, None).is_none());
        pose.set(Role::Hips, Vec3::repeat(f64::NAN));
        assert!(filter.clean(1.0 / 30.0, &pose, Some(0.85)).is_none());
        pose.set(Role::LeftHand, Vec3::new(1.5, 1.0, 0.0));
        assert!(filter.clean(2.0 / 30.0, &pose, Some(0.85)).is_none());
    }

    #[test]
    fn fast_motion_is_left_alone() {
        let mut filter = SpikeFilter::new(Profile::Body);
        for frame in 0..60 {
            let x = 0.6 * (frame as f64 / 120.0 * 30.0).sin();
            let cleaned = filter.clean(frame as f64 / 120.0, &hand(x), Some(0.85));
            assert!(cleaned.is_none(), "18 m/s");
        }
    }
}
