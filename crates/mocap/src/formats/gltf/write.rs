//! Writing GLB and VRM animations.

use std::io::{self, Write};

use serde_json::{Value, json};

use crate::clip::{Clip, Joint};
use crate::kinematics::WorldPose;
use crate::math::{Quat, Vec3};
use crate::roles::{Role, RoleMap};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const LINES: u32 = 1;

/// Writes a clip as binary glTF 2.0: a node for each joint, an animation with a key for each frame, and a skin with lines
/// from joint to joint, so that viewers show something. By the specification lengths are metres and Y is up: an
/// imported clip has them so. O(frames × joints) memory.
///
/// # Errors
/// An I/O error of `out`; a clip too large for the format (4 GiB, 65,535 joints).
pub fn write(clip: &Clip, out: &mut dyn Write) -> io::Result<()> {
    let rest = vec![Quat::identity(); clip.skeleton.len()];
    Glb::of(clip, &rest)?
        .with_lines(clip)?
        .finish(clip, None, out)
}

/// Writes a clip as a VRM animation (`VRMC_vrm_animation` 1.0): the humanoid bones that play roles, with a T-pose at rest.
/// Joints between them are folded into them; only the hips move in space, as the format wants it. `clip` is in metres and
/// Y-up. O(frames × joints) memory.
///
/// # Errors
/// An I/O error of `out`; a clip without rotations, or one in which a bone is missing that the format asks for.
pub fn write_vrma(clip: &Clip, roles: &RoleMap, out: &mut dyn Write) -> io::Result<()> {
    let refused = |what: String| io::Error::new(io::ErrorKind::InvalidInput, what);
    if !clip.has_rotations() {
        return Err(refused(
            "a VRM animation needs rotations, which a clip of points does not have; convert it with --fit first".to_owned(),
        ));
    }
    let missing = BONES
        .iter()
        .find(|bone| bone.required && roles.joint(bone.role).is_none());
    if let Some(bone) = missing {
        return Err(refused(format!(
            "a VRM animation needs {}, but no joint has this role (assign it with --roles FILE)",
            bone.role
        )));
    }
    let (human, rest) = humanoid(clip, roles);
    let bones: serde_json::Map<String, Value> = human
        .skeleton
        .joints()
        .iter()
        .enumerate()
        .map(|(node, joint)| (joint.name.clone(), json!({"node": node})))
        .collect();
    let extension = json!({"specVersion": "1.0", "humanoid": {"humanBones": bones}});
    Glb::of(&human, &rest)?.finish(&human, Some(extension), out)
}

/// A bone of a VRM humanoid.
struct VrmBone {
    role: Role,
    name: &'static str,
    required: bool,
}

const fn bone(role: Role, name: &'static str, required: bool) -> VrmBone {
    VrmBone {
        role,
        name,
        required,
    }
}

/// After *VRMC_vrm-1.0*, humanoid.
const BONES: [VrmBone; Role::BODY_COUNT] = [
    bone(Role::Hips, "hips", true),
    bone(Role::Torso, "spine", true),
    bone(Role::Neck, "neck", false),
    bone(Role::Head, "head", true),
    bone(Role::LeftThigh, "leftUpperLeg", true),
    bone(Role::LeftShin, "leftLowerLeg", true),
    bone(Role::LeftFoot, "leftFoot", true),
    bone(Role::RightThigh, "rightUpperLeg", true),
    bone(Role::RightShin, "rightLowerLeg", true),
    bone(Role::RightFoot, "rightFoot", true),
    bone(Role::LeftShoulder, "leftShoulder", false),
    bone(Role::LeftArm, "leftUpperArm", true),
    bone(Role::LeftForearm, "leftLowerArm", true),
    bone(Role::LeftHand, "leftHand", true),
    bone(Role::RightShoulder, "rightShoulder", false),
    bone(Role::RightArm, "rightUpperArm", true),
    bone(Role::RightForearm, "rightLowerArm", true),
    bone(Role::RightHand, "rightHand", true),
];

/// A joint that becomes a humanoid bone.
struct Chosen {
    /// Its role; the chest has none.
    role: Option<Role>,
    name: &'static str,
    joint: usize,
}

/// The joints that become bones, parents first and the hips before all others: those that play roles, and of the spine
/// between the first of these and the arms one or two more, as `chest` and `upperChest`.
fn choose(clip: &Clip, roles: &RoleMap) -> Vec<Chosen> {
    let joints = clip.skeleton.joints();
    let above = |joint: usize| std::iter::successors(joints[joint].parent, |&j| joints[j].parent);
    let mut chosen: Vec<Chosen> = Vec::new();
    for bone in &BONES {
        let Some(joint) = roles.joint(bone.role) else {
            continue;
        };
        // What the arms hang on is no neck, even where it stands for one.
        let carries_arm = || {
            let arm = roles.joint(Role::LeftArm);
            arm.is_some_and(|arm| above(arm).any(|j| j == joint))
        };
        let is_chest = bone.role == Role::Neck && carries_arm();
        if !is_chest && chosen.iter().all(|other| other.joint != joint) {
            chosen.push(Chosen {
                role: Some(bone.role),
                name: bone.name,
                joint,
            });
        }
    }
    let arms = (roles.joint(Role::LeftArm), roles.joint(Role::RightArm));
    if let (Some(torso), (Some(left), Some(right))) = (roles.joint(Role::Torso), arms) {
        let top = above(left).find(|&joint| above(right).any(|other| other == joint));
        let up = |joint: &usize| *joint != torso;
        let mut spine: Vec<usize> = top
            .into_iter()
            .flat_map(|top| std::iter::once(top).chain(above(top)))
            .take_while(up)
            .collect();
        spine.reverse();
        // A spine that does not lead to the torso is another.
        let hangs = spine
            .first()
            .is_some_and(|&first| above(first).any(|j| j == torso));
        let free = |joint: usize| chosen.iter().all(|other| other.joint != joint);
        let named: Vec<(&'static str, usize)> = match spine.as_slice() {
            [] => Vec::new(),
            [one] => vec![("chest", *one)],
            [first, .., last] => vec![("chest", *first), ("upperChest", *last)],
        };
        let named = named.into_iter().filter(|&(_, joint)| hangs && free(joint));
        let added: Vec<Chosen> = named
            .map(|(name, joint)| Chosen {
                role: None,
                name,
                joint,
            })
            .collect();
        chosen.extend(added);
    }
    let hips = roles.joint(Role::Hips);
    // Parents come first in a skeleton, and the hips before all that hangs on them here.
    chosen.sort_by_key(|bone| (Some(bone.joint) != hips, bone.joint));
    chosen
}

/// The bones of the humanoid, each under the nearest of them above it; and how each is turned in its parent's frame in a
/// T-pose that faces +Z.
fn humanoid(clip: &Clip, roles: &RoleMap) -> (Clip, Vec<Quat>) {
    let hips = roles.joint(Role::Hips);
    let chosen = choose(clip, roles);
    let place = |joint: usize| chosen.iter().position(|other| other.joint == joint);
    let joints = clip.skeleton.joints();
    let parents: Vec<Option<usize>> = chosen
        .iter()
        .map(|bone| {
            let above = joints[bone.joint].parent;
            let mut above = std::iter::successors(above, |&j| joints[j].parent);
            let rooted = (Some(bone.joint) != hips).then_some(0);
            above.find_map(place).or(rooted)
        })
        .collect();
    let zero = zero_pose(clip);
    let rest = t_pose(&chosen, &parents, &zero, roles);
    let skeleton = chosen.iter().zip(&parents).map(|(bone, &parent)| Joint {
        name: bone.name.to_owned(),
        parent,
        offset: match parent {
            Some(parent) => zero[bone.joint] - zero[chosen[parent].joint],
            None => zero[bone.joint],
        },
        tip: None,
    });
    let skeleton = skeleton.collect();
    let mut rotations = Vec::with_capacity(clip.frames * chosen.len());
    let mut places = Vec::with_capacity(clip.frames);
    let mut world = WorldPose::default();
    for frame in 0..clip.frames {
        world.set(clip, frame);
        places.push(world.positions[chosen[0].joint]);
        for (bone, &parent) in chosen.iter().zip(&parents) {
            let own = world.rotations[bone.joint];
            rotations.push(match parent {
                Some(parent) => world.rotations[chosen[parent].joint].inverse() * own,
                None => own,
            });
        }
    }
    let human = Clip::of_chain(clip, skeleton, rotations, places);
    (human, rest)
}

/// Positions of the joints in the zero pose.
fn zero_pose(clip: &Clip) -> Vec<Vec3> {
    let mut positions: Vec<Vec3> = Vec::with_capacity(clip.skeleton.len());
    for joint in clip.skeleton.joints() {
        positions.push(joint.offset + joint.parent.map_or_else(Vec3::zeros, |p| positions[p]));
    }
    positions
}

/// Rotation of each bone in its parent's frame when arms are out to the sides, legs are straight and the body faces +Z:
/// the whole body by its trunk and hip joints, then each limb by the least rotation.
fn t_pose(
    chosen: &[Chosen],
    parents: &[Option<usize>],
    zero: &[Vec3],
    roles: &RoleMap,
) -> Vec<Quat> {
    let at = |role: Role| roles.joint(role).map(|joint| zero[joint]);
    let body = || {
        let left = at(Role::LeftThigh)? - at(Role::RightThigh)?;
        let up = at(Role::Head)? - at(Role::Hips)?;
        let front = left.cross(&up);
        // From the body's own frame to one whose front is +Z and whose up is +Y.
        let turn = Quat::face_towards(&front, &up).inverse();
        (front.norm() > 0.0 && up.norm() > 0.0).then_some(turn)
    };
    let body = body().unwrap_or_else(Quat::identity);
    let mut world: Vec<Quat> = Vec::with_capacity(chosen.len());
    for (bone, &parent) in chosen.iter().zip(parents) {
        let above = parent.map_or(body, |parent| world[parent]);
        let next = bone.role.and_then(next_in_limb).and_then(|(next, wanted)| {
            let direction = above * (at(next)? - zero[bone.joint]);
            Quat::rotation_between(&direction, &wanted)
        });
        world.push(next.map_or(above, |turn| turn * above));
    }
    let local = |(i, own): (usize, &Quat)| match parents[i] {
        Some(parent) => world[parent].inverse() * own,
        None => *own,
    };
    world.iter().enumerate().map(local).collect()
}

/// The role at the far end of a bone of a limb, and where it points in a T-pose.
fn next_in_limb(role: Role) -> Option<(Role, Vec3)> {
    Some(match role {
        Role::LeftArm => (Role::LeftForearm, Vec3::x()),
        Role::LeftForearm => (Role::LeftHand, Vec3::x()),
        Role::RightArm => (Role::RightForearm, -Vec3::x()),
        Role::RightForearm => (Role::RightHand, -Vec3::x()),
        Role::LeftThigh => (Role::LeftShin, -Vec3::y()),
        Role::LeftShin => (Role::LeftFoot, -Vec3::y()),
        Role::RightThigh => (Role::RightShin, -Vec3::y()),
        Role::RightShin => (Role::RightFoot, -Vec3::y()),
        _ => return None,
    })
}

/// A document and its one buffer.
struct Glb {
    json: Value,
    views: Vec<Value>,
    accessors: Vec<Value>,
    bytes: Vec<u8>,
}

impl Glb {
    fn of(clip: &Clip, rest: &[Quat]) -> io::Result<Self> {
        let too_large = |what: &str| io::Error::new(io::ErrorKind::InvalidInput, what.to_owned());
        let joints = clip.skeleton.joints();
        if joints.len() > usize::from(u16::MAX) {
            return Err(too_large("more joints than a glTF skin can have"));
        }
        let mut glb = Self {
            json: json!({}),
            views: Vec::new(),
            accessors: Vec::new(),
            bytes: Vec::new(),
        };
        let nodes: Vec<Value> = joints
            .iter()
            .enumerate()
            .map(|(j, joint)| node(clip, j, joint, rest[j]))
            .collect();
        glb.json["nodes"] = nodes.into();
        if clip.frames > 0 {
            glb.animate(clip);
        }
        if glb.bytes.len() > u32::MAX as usize - (1 << 26) {
            return Err(too_large("more than 4 GiB, which GLB cannot hold"));
        }
        Ok(glb)
    }

    fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        let begin = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - begin;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": 0, "byteOffset": begin, "byteLength": length}));
        self.views.len() - 1
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: Vec<u8>) -> usize {
        let view = self.view(bytes);
        self.accessors.push(
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind}),
        );
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(kind, FLOAT, values.len() / width, bytes)
    }

    fn animate(&mut self, clip: &Clip) {
        let times: Vec<f32> = (0..clip.frames)
            .map(|frame| (frame as f64 / clip.rate_hz) as f32)
            .collect();
        let input = self.floats("SCALAR", 1, &times);
        // Times of keys have to state their bounds.
        self.accessors[input]["min"] = json!([times[0]]);
        self.accessors[input]["max"] = json!([times[times.len() - 1]]);
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        let mut channel = |node: usize, path: &str, output: usize| {
            channels
                .push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
            samplers.push(json!({"input": input, "output": output, "interpolation": "LINEAR"}));
        };
        let joints = clip.skeleton.len();
        if clip.has_rotations() {
            for joint in 0..joints {
                let turns = clip.rotations.iter().skip(joint).step_by(joints);
                let values: Vec<f32> = turns.flat_map(quat).collect();
                channel(joint, "rotation", self.floats("VEC4", 4, &values));
            }
        }
        for track in &clip.tracks {
            let values: Vec<f32> = track.positions.iter().flat_map(vec3).collect();
            channel(track.joint, "translation", self.floats("VEC3", 3, &values));
        }
        self.json["animations"] =
            json!([{"name": clip.name, "samplers": samplers, "channels": channels}]);
    }

    /// A mesh of lines between joints and their parents, bound to a skin of all joints.
    fn with_lines(mut self, clip: &Clip) -> io::Result<Self> {
        let joints = clip.skeleton.joints();
        let lines: Vec<u16> = (0u16..)
            .zip(joints)
            .filter_map(|(j, joint)| Some([u16::try_from(joint.parent?).ok()?, j]))
            .flatten()
            .collect();
        let zero = zero_pose(clip);
        let inverse: Vec<f32> = zero
            .iter()
            .flat_map(|p| {
                let [x, y, z] = vec3(&-p);
                [
                    1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0,
                ]
            })
            .collect();
        let inverse = self.floats("MAT4", 16, &inverse);
        let all: Vec<usize> = (0..joints.len()).collect();
        self.json["skins"] = json!([{"joints": all, "inverseBindMatrices": inverse}]);
        if lines.is_empty() {
            return Ok(self);
        }
        let places: Vec<f32> = zero.iter().flat_map(vec3).collect();
        let position = self.floats("VEC3", 3, &places);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..3)
                .map(|axis| {
                    places
                        .iter()
                        .skip(axis)
                        .step_by(3)
                        .copied()
                        .reduce(pick)
                        .unwrap_or(0.0)
                })
                .collect()
        };
        self.accessors[position]["min"] = bound(f32::min).into();
        self.accessors[position]["max"] = bound(f32::max).into();
        let count = joints.len();
        let owner = (0..count).flat_map(|j| [j as u16, 0, 0, 0]);
        let owner = owner.flat_map(u16::to_le_bytes).collect();
        let owner = self.accessor("VEC4", UNSIGNED_SHORT, count, owner);
        let weights: Vec<f32> = (0..count).flat_map(|_| [1.0, 0.0, 0.0, 0.0]).collect();
        let weights = self.floats("VEC4", 4, &weights);
        let ends = lines.len();
        let indices = lines.into_iter().flat_map(u16::to_le_bytes).collect();
        let indices = self.accessor("SCALAR", UNSIGNED_SHORT, ends, indices);
        self.json["meshes"] = json!([{"name": "bones", "primitives": [{
            "mode": LINES,
            "indices": indices,
            "attributes": {"POSITION": position, "JOINTS_0": owner, "WEIGHTS_0": weights},
        }]}]);
        if let Some(nodes) = self.json["nodes"].as_array_mut() {
            nodes.push(json!({"name": "bones", "mesh": 0, "skin": 0}));
        }
        Ok(self)
    }

    fn finish(
        mut self,
        clip: &Clip,
        vrm_animation: Option<Value>,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let joints = clip.skeleton.joints();
        let nodes = self.json["nodes"].as_array().map_or(0, Vec::len);
        let roots: Vec<usize> = (0..nodes)
            .filter(|&j| joints.get(j).is_none_or(|joint| joint.parent.is_none()))
            .collect();
        self.json["asset"] = json!({"version": "2.0", "generator": "morec"});
        self.json["scene"] = json!(0);
        self.json["scenes"] = json!([{"nodes": roots}]);
        self.json["accessors"] = self.accessors.into();
        self.json["bufferViews"] = self.views.into();
        self.json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        if let Some(extension) = vrm_animation {
            self.json["extensionsUsed"] = json!(["VRMC_vrm_animation"]);
            self.json["extensions"] = json!({"VRMC_vrm_animation": extension});
        }
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = |bytes: &[u8]| {
            u32::try_from(bytes.len())
                .map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "more than 4 GiB"))
        };
        let (text_length, bytes_length) = (length(&text)?, length(&self.bytes)?);
        out.write_all(b"glTF")?;
        out.write_all(&2u32.to_le_bytes())?;
        let whole = 12 + 8 + u64::from(text_length) + 8 + u64::from(bytes_length);
        let whole = u32::try_from(whole)
            .map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "more than 4 GiB"))?;
        out.write_all(&whole.to_le_bytes())?;
        for (length, kind, bytes) in [
            (text_length, b"JSON", &text),
            (bytes_length, b"BIN\0", &self.bytes),
        ] {
            out.write_all(&length.to_le_bytes())?;
            out.write_all(kind)?;
            out.write_all(bytes)?;
        }
        Ok(())
    }
}

fn node(clip: &Clip, j: usize, joint: &Joint, rest: Quat) -> Value {
    let mut node = json!({"name": joint.name, "translation": vec3(&joint.offset)});
    if rest.angle() > 0.0 {
        node["rotation"] = json!(quat(&rest));
    }
    let children: Vec<usize> = clip.skeleton.children(j).collect();
    if !children.is_empty() {
        node["children"] = json!(children);
    }
    node
}

fn quat(q: &Quat) -> [f32; 4] {
    [q.i as f32, q.j as f32, q.k as f32, q.w as f32]
}

fn vec3(v: &Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
