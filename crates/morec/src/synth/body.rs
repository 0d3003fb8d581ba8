//! A person's skeleton, and the joint rotations that put hands, feet, hips and head where a timeline wants them.
//!
//! Y up, metres, T-pose, facing +Z, left side at +X.

use super::limb::{self, Bend};
use super::person::Person;
use super::smooth::{min_jerk, sin_cos, soft_max, soft_min, turn};
use super::timeline::{
    Controls, FOOT, HAND, HEAD, HIPS, HIPS_TURN, LimbSide, SPINE, SWIVEL, WRIST,
};
use crate::clip::{Joint, Skeleton};
use crate::math::{Axis, Quat, Vec3};

const SPINE_JOINT: usize = 1;
const CHEST: usize = 2;
const NECK: usize = 3;
const HEAD_JOINT: usize = 4;
/// First joints of the left and the right arm: shoulder, arm, forearm, hand follow each other.
const ARM: [usize; 2] = [5, 9];
/// First joints of the left and the right leg: thigh, shin, foot, toes follow each other.
const LEG: [usize; 2] = [13, 17];

/// A skeleton with the lengths that posing it needs.
#[derive(Debug, Clone)]
pub struct SyntheticBody {
    skeleton: Skeleton,
    arm: [f64; 2],
    leg: [f64; 2],
    ankle_height: f64,
    stand_height: f64,
    stoop_rad: f64,
    elbow_rad: f64,
}

impl SyntheticBody {
    /// The body of `person`; segment lengths as shares of the height after Drillis and Contini (1966).
    pub fn of(person: &Person) -> Self {
        let h = person.height_m;
        let leg = [0.245 * h * person.leg_ratio, 0.246 * h * person.leg_ratio];
        let arm = [0.178 * h * person.arm_ratio, 0.146 * h * person.arm_ratio];
        let ankle_height = 0.04 * h;
        Self {
            skeleton: skeleton(person, arm, leg),
            arm,
            leg,
            ankle_height,
            stand_height: ankle_height + 0.99 * (leg[0] + leg[1]),
            stoop_rad: person.stoop_rad,
            elbow_rad: person.elbow_rad,
        }
    }

    /// Joints with the lengths of this body, metres.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Length of a leg from hip joint to ankle, metres.
    pub fn leg_m(&self) -> f64 {
        self.leg[0] + self.leg[1]
    }

    /// Half the distance between the hip joints, metres.
    pub fn hip_m(&self) -> f64 {
        self.offset(LEG[0]).x
    }

    /// Writes the `parent_from_joint` rotations of `controls` and returns the hips' position in the world.
    pub fn pose(&self, controls: &Controls, locals: &mut [Quat]) -> Vec3 {
        let world_from_hips = turned(&controls[HIPS_TURN..HIPS_TURN + 3]);
        locals[0] = world_from_hips;
        self.pose_trunk(controls, locals);
        for side in LimbSide::BOTH {
            self.pose_arm(controls, side, locals);
        }
        let feet = LimbSide::BOTH.map(|side| self.foot(controls, side));
        let hips = self.hips(controls, &world_from_hips, &feet);
        for side in LimbSide::BOTH {
            self.pose_leg(&hips, &world_from_hips, &feet[side.index()], side, locals);
        }
        hips
    }

    fn offset(&self, joint: usize) -> Vec3 {
        self.skeleton.joints()[joint].offset
    }

    fn pose_trunk(&self, controls: &Controls, locals: &mut [Quat]) {
        let spine = &controls[SPINE..SPINE + 3];
        let head = &controls[HEAD..HEAD + 3];
        locals[SPINE_JOINT] = turned(&[
            0.45 * spine[0] + 0.3 * self.stoop_rad,
            0.5 * spine[1],
            0.5 * spine[2],
        ]);
        locals[CHEST] = turned(&[
            0.55 * spine[0] + 0.7 * self.stoop_rad,
            0.5 * spine[1],
            0.5 * spine[2],
        ]);
        // Whoever stoops still looks ahead.
        locals[NECK] = turned(&[0.4 * head[0], 0.5 * head[1], 0.5 * head[2]]);
        locals[HEAD_JOINT] = turned(&[
            0.6 * head[0] - 0.9 * self.stoop_rad,
            0.5 * head[1],
            0.5 * head[2],
        ]);
    }

    /// In coordinates with x outward, so that both arms are left arms; mirrored at the end.
    fn pose_arm(&self, controls: &Controls, side: LimbSide, locals: &mut [Quat]) {
        let i = side.index();
        let wanted = Vec3::new(
            controls[HAND[i]],
            controls[HAND[i] + 1],
            controls[HAND[i] + 2],
        );
        // The shoulder goes up with the hand: 0 hanging, about 0.4 rad overhead.
        let lift_rad = 0.1 * (1.0 + wanted.y.clamp(-1.0, 1.2)) * (1.0 + wanted.y.clamp(-1.0, 1.2));
        let (sin, cos) = sin_cos(lift_rad);
        let collar = self.offset(ARM[0]);
        let bone = self.offset(ARM[0] + 1);
        let shoulder = collar
            + Vec3::new(
                bone.x * cos - bone.y * sin,
                bone.x * sin + bone.y * cos,
                bone.z,
            );
        let length = self.arm[0] + self.arm[1];
        let target = self.outside_trunk(shoulder + wanted * length) - shoulder;
        let pole = elbow_side(&target, self.elbow_rad + controls[SWIVEL[i]]);
        let bend = limb::reach(self.arm, target, pole);
        let mirror = |v: Vec3| Vec3::new(side.sign() * v.x, v.y, v.z);
        // A mirrored axis of rotation turns the other way.
        let bend = Bend {
            upper: mirror(bend.upper),
            lower: mirror(bend.lower),
            hinge: mirror(bend.hinge) * side.sign(),
        };
        let (rest, hinge) = (Vec3::x() * side.sign(), -Vec3::y() * side.sign());
        let chest_from_collar = turn(Axis::Z, lift_rad * side.sign());
        let chest_from_arm = limb::carry(&rest, &hinge, &bend.upper, &bend.hinge);
        let chest_from_forearm = limb::carry(&rest, &hinge, &bend.lower, &bend.hinge);
        locals[ARM[i]] = chest_from_collar;
        locals[ARM[i] + 1] = chest_from_collar.inverse() * chest_from_arm;
        locals[ARM[i] + 2] = chest_from_arm.inverse() * chest_from_forearm;
        locals[ARM[i] + 3] = turn(Axis::X, controls[WRIST[i] + 1])
            * turn(Axis::Y, -side.sign() * controls[WRIST[i]]);
    }

    /// `point` of the chest's frame, pushed out of an upright elliptic cylinder around the trunk.
    fn outside_trunk(&self, point: Vec3) -> Vec3 {
        let top = self.offset(ARM[0]).y;
        let half_width = 0.78 * (self.offset(ARM[0]).x + self.offset(ARM[0] + 1).x) + 0.03;
        let half_depth = 0.72 * half_width;
        let out = ((point.x / half_width) * (point.x / half_width)
            + (point.z / half_depth) * (point.z / half_depth))
            .sqrt()
            .max(1e-3);
        // No trunk above the shoulders.
        let wall = 1.0 - min_jerk((point.y - top + 0.02) / 0.16);
        let scale = soft_max(out, wall, 0.15) / out;
        Vec3::new(point.x * scale, point.y, point.z * scale)
    }

    /// The hips where the controls want them, or as much lower as planted feet demand.
    fn hips(&self, controls: &Controls, world_from_hips: &Quat, feet: &[Foot; 2]) -> Vec3 {
        let length = self.leg_m();
        let height = self.stand_height + controls[HIPS + 1] * length;
        let mut hips = Vec3::new(controls[HIPS], height, controls[HIPS + 2]);
        for side in LimbSide::BOTH {
            let joint = world_from_hips * self.offset(LEG[side.index()]);
            let ankle = feet[side.index()].ankle;
            let (dx, dz) = (hips.x + joint.x - ankle.x, hips.z + joint.z - ankle.z);
            let reach = 0.99 * length;
            let rise = (reach * reach - dx * dx - dz * dz)
                .max(0.04 * length * length)
                .sqrt();
            hips.y = soft_min(hips.y, ankle.y + rise - joint.y, 0.025);
        }
        hips
    }

    /// A foot turns about its ball when the heel comes up, about the ankle when the toes do.
    fn foot(&self, controls: &Controls, side: LimbSide) -> Foot {
        let c = &controls[FOOT[side.index()]..FOOT[side.index()] + 5];
        let (yaw, pitch) = (turn(Axis::Y, c[3]), c[4]);
        let heel_up_rad = soft_max(pitch, 0.0, 0.02);
        let ball = self.offset(LEG[side.index()] + 3);
        let ankle_flat = Vec3::new(c[0], self.ankle_height + c[1], c[2]);
        let ankle = ankle_flat + yaw * (ball - turn(Axis::X, heel_up_rad) * ball);
        Foot {
            ankle,
            world_from_foot: yaw * turn(Axis::X, pitch),
            heel_up_rad,
            yaw,
        }
    }

    fn pose_leg(
        &self,
        hips: &Vec3,
        world_from_hips: &Quat,
        foot: &Foot,
        side: LimbSide,
        locals: &mut [Quat],
    ) {
        let first = LEG[side.index()];
        let target = foot.ankle - (hips + world_from_hips * self.offset(first));
        // Knees go where the feet point, a little outward; upward when the leg is raised in front.
        let ahead =
            foot.yaw * Vec3::new(0.15 * side.sign(), 0.0, 1.0) + world_from_hips * Vec3::z();
        let bend = limb::reach(self.leg, target, ahead + Vec3::y() * 0.6);
        let (rest, hinge) = (-Vec3::y(), Vec3::x());
        let world_from_thigh = limb::carry(&rest, &hinge, &bend.upper, &bend.hinge);
        let world_from_shin = limb::carry(&rest, &hinge, &bend.lower, &bend.hinge);
        locals[first] = world_from_hips.inverse() * world_from_thigh;
        locals[first + 1] = world_from_thigh.inverse() * world_from_shin;
        locals[first + 2] = world_from_shin.inverse() * foot.world_from_foot;
        locals[first + 3] = turn(Axis::X, -0.8 * foot.heel_up_rad);
    }
}

struct Foot {
    ankle: Vec3,
    world_from_foot: Quat,
    heel_up_rad: f64,
    yaw: Quat,
}

/// Yaw about Y, then pitch about X, then roll about Z.
fn turned(pitch_yaw_roll: &[f64]) -> Quat {
    turn(Axis::Y, pitch_yaw_roll[1])
        * turn(Axis::X, pitch_yaw_roll[0])
        * turn(Axis::Z, pitch_yaw_roll[2])
}

/// Direction of an elbow when the hand is at `target` from the shoulder (x outward): backward when the arm hangs,
/// down when it is level, outward and ahead when it is raised.
fn elbow_side(target: &Vec3, swivel_rad: f64) -> Vec3 {
    let along = target / target.norm().max(1e-9);
    let down = (1.0 - along.y) / 2.0;
    let pole = Vec3::new(
        0.45 + 0.25 * (1.0 - down),
        -(0.1 + 3.2 * down * (1.0 - down)),
        -(1.3 * down - 0.3),
    );
    let side = limb::perpendicular(&pole, &along);
    let (sin, cos) = sin_cos(swivel_rad);
    side * cos + along.cross(&side) * sin
}

fn skeleton(person: &Person, arm: [f64; 2], leg: [f64; 2]) -> Skeleton {
    let h = person.height_m;
    let wide = h * person.width_ratio;
    let mut joints = vec![
        joint("Hips", None, Vec3::new(0.0, 0.53 * h, 0.0)),
        joint("Spine", Some(0), Vec3::new(0.0, 0.055 * h, 0.0)),
        joint("Chest", Some(SPINE_JOINT), Vec3::new(0.0, 0.115 * h, 0.0)),
        joint("Neck", Some(CHEST), Vec3::new(0.0, 0.135 * h, 0.0)),
        end(
            "Head",
            NECK,
            Vec3::new(0.0, 0.05 * h, 0.01 * h),
            Vec3::new(0.0, 0.11 * h, 0.02 * h),
        ),
    ];
    for side in LimbSide::BOTH {
        let (s, name) = (side.sign(), side.name());
        let at = ARM[side.index()];
        let hand = Vec3::new(s * arm[1], 0.0, 0.0);
        joints.push(joint(
            &format!("{name}Shoulder"),
            Some(CHEST),
            Vec3::new(s * 0.018 * wide, 0.105 * h, 0.0),
        ));
        joints.push(joint(
            &format!("{name}Arm"),
            Some(at),
            Vec3::new(s * 0.1 * wide, -0.005 * h, 0.0),
        ));
        joints.push(joint(
            &format!("{name}ForeArm"),
            Some(at + 1),
            Vec3::new(s * arm[0], 0.0, 0.0),
        ));
        joints.push(end(
            &format!("{name}Hand"),
            at + 2,
            hand,
            Vec3::new(s * 0.1 * h, 0.0, 0.0),
        ));
    }
    for side in LimbSide::BOTH {
        let (s, name) = (side.sign(), side.name());
        let at = LEG[side.index()];
        let toes = Vec3::new(0.0, -0.03 * h, 0.09 * h);
        joints.push(joint(
            &format!("{name}UpLeg"),
            Some(0),
            Vec3::new(s * 0.052 * wide, 0.0, 0.0),
        ));
        joints.push(joint(
            &format!("{name}Leg"),
            Some(at),
            Vec3::new(0.0, -leg[0], 0.0),
        ));
        joints.push(joint(
            &format!("{name}Foot"),
            Some(at + 1),
            Vec3::new(0.0, -leg[1], 0.0),
        ));
        joints.push(end(
            &format!("{name}ToeBase"),
            at + 2,
            toes,
            Vec3::new(0.0, 0.0, 0.045 * h),
        ));
    }
    Skeleton::new(joints).expect("parents are listed before their children")
}

fn joint(name: &str, parent: Option<usize>, offset: Vec3) -> Joint {
    Joint {
        name: name.to_owned(),
        parent,
        offset,
        tip: None,
    }
}

fn end(name: &str, parent: usize, offset: Vec3, tip: Vec3) -> Joint {
    Joint {
        name: name.to_owned(),
        parent: Some(parent),
        offset,
        tip: Some(tip),
    }
}
