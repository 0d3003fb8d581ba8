//! Applying perturbations to a sequence of poses.

use morec::features::KeyPose;
use morec::math::{Axis, Vec3};
use morec::rng::Rng;
use morec::roles::Role;

use super::noise::{normal3, slow};
use super::{OCCLUSION_SECS, Perturbation, REFERENCE_LEG_METRES, SLOW_SIGMA_SECS, SPIKE_METRES};

/// A perturbed sequence and where its time came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Perturbed {
    /// Poses with their times in seconds.
    pub poses: Vec<(f64, KeyPose)>,
    /// Times in the original and in the copy, increasing.
    clock: Vec<(f64, f64)>,
}

impl Perturbed {
    /// A copy that is not perturbed yet.
    pub fn of(poses: Vec<(f64, KeyPose)>) -> Self {
        let clock = poses.iter().map(|(t, _)| (*t, *t)).collect();
        Self { poses, clock }
    }

    /// When the moment `secs` of the original happens in the copy, in seconds. O(log frames).
    pub fn secs_in_copy(&self, secs: f64) -> f64 {
        let after = self.clock.partition_point(|(old, _)| *old < secs);
        let (Some(last), Some(first)) = (self.clock.last(), self.clock.first()) else {
            return secs;
        };
        if after == 0 {
            return first.1 + (secs - first.0);
        }
        if after == self.clock.len() {
            return last.1 + (secs - last.0);
        }
        let (a, b) = (self.clock[after - 1], self.clock[after]);
        a.1 + (b.1 - a.1) * ((secs - a.0) / (b.0 - a.0).max(1e-12))
    }

    /// Replaces each time `t` by `new(t)`.
    fn retime(&mut self, new: impl Fn(f64) -> f64) {
        self.poses.iter_mut().for_each(|(t, _)| *t = new(*t));
        self.clock.iter_mut().for_each(|(_, t)| *t = new(*t));
    }
}

/// `poses` with every perturbation of `list` applied in turn, reproducibly from `seed`. O(frames) for each.
pub fn perturb(poses: Vec<(f64, KeyPose)>, list: &[Perturbation], seed: u64) -> Perturbed {
    let mut copy = Perturbed::of(poses);
    for (part, perturbation) in list.iter().enumerate() {
        let mut rng = Rng::for_part(seed, part as u64);
        apply(&mut copy, *perturbation, &mut rng);
    }
    copy
}

fn apply(copy: &mut Perturbed, perturbation: Perturbation, rng: &mut Rng) {
    let scale = leg_metres(&copy.poses) / REFERENCE_LEG_METRES;
    match perturbation {
        Perturbation::White(metres) => {
            each_joint(copy, |_, _, p| *p += normal3(rng) * (metres * scale));
        }
        Perturbation::Slow(metres) => add_slow(copy, metres * scale, rng),
        Perturbation::Constant(metres) => {
            let mut offsets = [Vec3::zeros(); Role::COUNT];
            for role in roles_of(copy) {
                offsets[role.index()] = normal3(rng) * (metres * scale);
            }
            each_joint(copy, |_, role, p| *p += offsets[role.index()]);
        }
        Perturbation::Tilt(degrees) => {
            let heading = Axis::Y.rotation(rng.range(0.0, std::f64::consts::TAU));
            let turn = heading * Axis::X.rotation(degrees.to_radians()) * heading.inverse();
            each_joint(copy, |_, _, p| *p = turn * *p);
        }
        Perturbation::Duration(factor) => copy.retime(|t| t * factor),
        Perturbation::Drop(share) => drop_frames(copy, share, rng),
        Perturbation::Repeat(share) => {
            for i in 1..copy.poses.len() {
                if rng.chance(share) {
                    copy.poses[i].1 = copy.poses[i - 1].1;
                }
            }
        }
        Perturbation::Spikes(share) => {
            let roles = roles_of(copy);
            for (_, pose) in &mut copy.poses {
                if rng.chance(share) {
                    let role = roles[rng.below(roles.len())];
                    let off = normal3(rng).normalize() * (SPIKE_METRES * scale);
                    if let Some(place) = pose.get(role) {
                        pose.set(role, place + off);
                    }
                }
            }
        }
        Perturbation::Occlude(share) => occlude(copy, share, rng),
        Perturbation::Mirror => {
            for (_, pose) in &mut copy.poses {
                *pose = pose.mirrored();
            }
        }
        Perturbation::Camera(factor) => {
            for part in [
                Perturbation::White(0.01 * factor),
                Perturbation::Slow(0.02 * factor),
                Perturbation::Constant(0.015 * factor),
            ] {
                apply(copy, part, rng);
            }
        }
        Perturbation::Rate(hz) => resample(copy, hz),
    }
}

/// The parts of the body, seen or not, and what is seen of hands and custom skeletons.
fn roles_of(copy: &Perturbed) -> Vec<Role> {
    let seen = |role: &Role| {
        let mut poses = copy.poses.iter();
        role.is_of_body() || poses.any(|(_, pose)| pose.get(*role).is_some())
    };
    Role::ALL.into_iter().filter(seen).collect()
}

/// Length of a leg, the mean over the poses that show one; the reference where none does.
fn leg_metres(poses: &[(f64, KeyPose)]) -> f64 {
    let leg = |pose: &KeyPose| {
        let hip = pose.get(Role::LeftThigh)?;
        let knee = pose.get(Role::LeftShin)?;
        let foot = pose.get(Role::LeftFoot)?;
        Some((knee - hip).norm() + (foot - knee).norm())
    };
    let (sum, count) = poses
        .iter()
        .filter_map(|(_, pose)| leg(pose))
        .fold((0.0, 0usize), |(sum, count), leg| (sum + leg, count + 1));
    if count == 0 {
        REFERENCE_LEG_METRES
    } else {
        sum / count as f64
    }
}

fn each_joint(copy: &mut Perturbed, mut change: impl FnMut(usize, Role, &mut Vec3)) {
    for (frame, (_, pose)) in copy.poses.iter_mut().enumerate() {
        for role in pose.roles() {
            if let Some(mut place) = pose.get(role) {
                change(frame, role, &mut place);
                pose.set(role, place);
            }
        }
    }
}

fn add_slow(copy: &mut Perturbed, metres: f64, rng: &mut Rng) {
    let frames = copy.poses.len();
    let (Some(first), Some(last)) = (copy.poses.first(), copy.poses.last()) else {
        return;
    };
    let step_secs = (last.0 - first.0) / (frames.max(2) - 1) as f64;
    let sigma_frames = SLOW_SIGMA_SECS / step_secs.max(1e-6);
    let mut noise = vec![Vec::new(); Role::COUNT];
    for role in roles_of(copy) {
        noise[role.index()] = slow(frames, sigma_frames.min(frames as f64), rng);
    }
    each_joint(copy, |frame, role, p| {
        *p += noise[role.index()][frame] * metres;
    });
}

/// The joints of a limb below its first, which vanish together.
const LIMBS: [[Role; 2]; 4] = [
    [Role::LeftForearm, Role::LeftHand],
    [Role::RightForearm, Role::RightHand],
    [Role::LeftShin, Role::LeftFoot],
    [Role::RightShin, Role::RightFoot],
];

/// Hides limbs for [`OCCLUSION_SECS`] at a time, each for `share` of the time.
fn occlude(copy: &mut Perturbed, share: f64, rng: &mut Rng) {
    let (Some(first), Some(last)) = (copy.poses.first(), copy.poses.last()) else {
        return;
    };
    let windows = ((last.0 - first.0) / OCCLUSION_SECS) as usize + 1;
    let start = first.0;
    for limb in LIMBS {
        let hidden: Vec<bool> = (0..windows).map(|_| rng.chance(share)).collect();
        for (t, pose) in &mut copy.poses {
            let window = ((*t - start) / OCCLUSION_SECS) as usize;
            if hidden[window.min(windows - 1)] {
                limb.iter()
                    .for_each(|role| pose.set(*role, Vec3::from_element(f64::NAN)));
            }
        }
    }
}

/// Takes frames away; those that stay follow each other at the even pace of the original.
fn drop_frames(copy: &mut Perturbed, share: f64, rng: &mut Rng) {
    let times: Vec<f64> = copy.poses.iter().map(|(t, _)| *t).collect();
    let mut kept = Vec::with_capacity(copy.poses.len());
    let mut clock = Vec::with_capacity(copy.poses.len());
    for (i, (_, pose)) in copy.poses.iter().enumerate() {
        clock.push((copy.clock[i].0, times[kept.len().min(times.len() - 1)]));
        if !rng.chance(share) {
            kept.push((times[kept.len()], *pose));
        }
    }
    copy.poses = kept;
    copy.clock = clock;
}

fn resample(copy: &mut Perturbed, hz: f64) {
    let (Some(first), Some(last)) = (copy.poses.first(), copy.poses.last()) else {
        return;
    };
    let (start, stop) = (first.0, last.0);
    let count = ((stop - start) * hz + 1e-6).floor() as usize + 1;
    let mut after = 0;
    let mut out = Vec::with_capacity(count);
    for i in 0..count {
        let t = start + i as f64 / hz;
        while after + 1 < copy.poses.len() && copy.poses[after].0 < t {
            after += 1;
        }
        let (a, b) = (&copy.poses[after.saturating_sub(1)], &copy.poses[after]);
        let share = ((t - a.0) / (b.0 - a.0).max(1e-12)).clamp(0.0, 1.0);
        let mut pose = KeyPose::default();
        for role in a.1.roles() {
            if let (Some(p), Some(q)) = (a.1.get(role), b.1.get(role)) {
                pose.set(role, p.lerp(&q, share));
            }
        }
        out.push((t, pose));
    }
    copy.poses = out;
}
