//! FBX, binary and text, through [`ufbx`].
//!
//! The format has no public specification. `ufbx` evaluates curves, pre- and post-rotations, pivots, rotation orders and
//! layers; what is made of the nodes it gives is decided here.

use ufbx::{ElementType, LoadOpts, Scene as Fbx};

use super::builder::clip_names;
use super::keys::{self, KeyGrid};
use super::scene::{self, Local, Sampling, SceneNode, SceneSize, SceneSkeleton};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::clip::Clip;
use crate::math::{Axis, Quat, Vec3};

/// Memory that reading may take: this many bytes however small the file is,
const FREE_BYTES: usize = 256 << 20;
/// and this many for each byte of it, for arrays are compressed.
const MEMORY_A_BYTE: usize = 64;

/// Reads an FBX file: a clip for each take and each skeleton that it moves, called `name` (`name#take` for several).
///
/// Clips are sampled at the scene's frame rate if the keys lie on it, else at the keys' own, else at the scene's. Scales are folded into the positions. Axes and lengths are the file's.
///
/// # Errors
/// The place and the cause: no FBX, a version before 3.0 or one that cannot be read, no animation of a skeleton, more than
/// `limits` allow. O(bytes + frames × nodes).
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let fbx = load(bytes, limits)?;
    read_scene(&fbx, bytes.len(), name, None, limits)
}

/// [`read`], with what the scene's settings state about lengths and axes, if they do. `rate_hz` is the rate at which keys are sampled in
/// place of the scene's.
///
/// # Errors
/// Those of [`read`].
pub fn read_stated(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<(Loaded, Option<SceneSettings>), ParseError> {
    let fbx = load(bytes, limits)?;
    let loaded = read_scene(&fbx, bytes.len(), name, rate_hz, limits)?;
    Ok((loaded, settings(&fbx)))
}

/// Units and axes in the settings of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneSettings {
    /// The axis that points up or down.
    pub up: Axis,
    /// True if it points down.
    pub is_down: bool,
    /// Metres in one unit of length.
    pub metres_per_unit: f64,
}

fn settings(fbx: &Fbx) -> Option<SceneSettings> {
    use ufbx::CoordinateAxis as Is;
    let (up, is_down) = match fbx.settings.axes.up {
        Is::PositiveX => (Axis::X, false),
        Is::NegativeX => (Axis::X, true),
        Is::PositiveY => (Axis::Y, false),
        Is::NegativeY => (Axis::Y, true),
        Is::PositiveZ => (Axis::Z, false),
        Is::NegativeZ => (Axis::Z, true),
        Is::Unknown => return None,
    };
    let metres_per_unit = fbx.settings.unit_meters;
    (1e-6..1e6)
        .contains(&metres_per_unit)
        .then_some(SceneSettings {
            up,
            is_down,
            metres_per_unit,
        })
}

fn read_scene(
    fbx: &Fbx,
    bytes: usize,
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut warnings: Vec<Warning> = Vec::new();
    let mut nodes = nodes(fbx, limits)?;
    let order = scene::parents_first(&mut nodes, limits)?;
    mark_joints(fbx, &order, &mut nodes);
    let rigs = scene::worthwhile(scene::rigs(&nodes, &order), &nodes, &mut warnings);
    let takes = takes(fbx, &rigs, rate_hz, &mut warnings);
    if takes.is_empty() {
        let joints: usize = rigs.iter().map(SceneSkeleton::len).sum();
        let found = match joints {
            0 => "an FBX scene without a skeleton that moves".to_owned(),
            _ => format!("an FBX model with a skeleton of {joints} joints, without animation"),
        };
        return Err(ParseError::new(
            Place::File,
            "an animation of a skeleton",
            found,
        ));
    }
    let titles: Vec<String> = takes
        .iter()
        .map(|take| match rigs.len() {
            1 => take.name.clone(),
            _ if fbx.anim_stacks.len() == 1 => nodes[take.rig.root()].name.clone(),
            _ => format!("{} {}", take.name, nodes[take.rig.root()].name),
        })
        .collect();
    let mut clips = Vec::with_capacity(takes.len());
    let mut size = SceneSize { bytes, earlier: 0 };
    for (take, clip_name) in takes.iter().zip(clip_names(name, &titles)) {
        let clip = clip(fbx, take, &nodes, clip_name, size, limits, &mut warnings)?;
        size.earlier += clip.rotations.len();
        clips.push(clip);
    }
    Ok(Loaded { clips, warnings })
}

fn load(bytes: &[u8], limits: &Limits) -> Result<ufbx::SceneRoot, ParseError> {
    let memory = FREE_BYTES.saturating_add(bytes.len().saturating_mul(MEMORY_A_BYTE));
    // Two allocators have it.
    let memory = memory.min(limits.memory / 2);
    let mut options = LoadOpts {
        ignore_geometry: true,
        ignore_embedded: true,
        skip_skin_vertices: true,
        load_external_files: false,
        node_depth_limit: u32::try_from(limits.depth).unwrap_or(u32::MAX),
        inherit_mode_handling: ufbx::InheritModeHandling::Compensate,
        file_format: ufbx::FileFormat::Fbx,
        ..LoadOpts::default()
    };
    options.temp_allocator.memory_limit = memory;
    options.result_allocator.memory_limit = memory;
    ufbx::load_memory(bytes, options).map_err(|error| {
        if error.type_ == ufbx::ErrorType::MemoryLimit {
            return ParseError::of_memory(2 * memory, 2 * memory + 1);
        }
        // Not its `info`, which may be no UTF-8 and then panics.
        let what: &str = &error.description;
        let found = match (error.type_, version(bytes)) {
            (ufbx::ErrorType::UnsupportedVersion, Some(version)) => {
                format!("FBX {version}, which is not supported; save the file as FBX 2014 or newer")
            }
            _ => format!("FBX that cannot be read: {what}"),
        };
        ParseError::new(Place::File, "FBX of version 3.0 to 7.7", found)
    })
}

/// The version that a file states, as `7.4`.
fn version(bytes: &[u8]) -> Option<String> {
    let number = match bytes.strip_prefix(b"Kaydara FBX Binary  \0\x1a\0") {
        Some(rest) => u32::from_le_bytes(rest.get(..4)?.try_into().ok()?),
        None => {
            let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
            let digits = head.split_once("FBXVersion:")?.1.trim_start();
            let end = digits
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(digits.len());
            digits[..end].parse().ok()?
        }
    };
    Some(format!("{}.{}", number / 1000, number % 1000 / 100))
}

/// The nodes; a node's number is its place in `fbx.nodes`.
fn nodes(fbx: &Fbx, limits: &Limits) -> Result<Vec<SceneNode>, ParseError> {
    let most = limits.joints.saturating_mul(16);
    if fbx.nodes.len() > most {
        let expected = format!("at most {most} nodes");
        return Err(ParseError::new(
            Place::File,
            expected,
            fbx.nodes.len().to_string(),
        ));
    }
    let nodes = fbx
        .nodes
        .iter()
        .enumerate()
        .map(|(number, node)| SceneNode {
            name: match node.element.name.trim() {
                "" => format!("node{number}"),
                _ => node.element.name.to_string(),
            },
            parent: node.parent.as_ref().map(|p| p.element.typed_id as usize),
            rest: local(&node.local_transform),
            joint: false,
        });
    Ok(nodes.collect())
}

/// Bones, what skins hang on, and animated nodes below these; in a scene without any, all animated nodes that are no
/// cameras or lights.
fn mark_joints(fbx: &Fbx, order: &[usize], nodes: &mut [SceneNode]) {
    for node in &fbx.nodes {
        nodes[node.element.typed_id as usize].joint = node.bone.is_some();
    }
    for cluster in &fbx.skin_clusters {
        if let Some(node) = &cluster.bone_node {
            nodes[node.element.typed_id as usize].joint = true;
        }
    }
    let any = nodes.iter().any(|node| node.joint);
    let mut animated = vec![false; nodes.len()];
    for layer in &fbx.anim_layers {
        for prop in &layer.anim_props {
            if let Some(node) = moved_node(prop, nodes.len()) {
                animated[node] = true;
            }
        }
    }
    for &n in order {
        let node = &fbx.nodes[n];
        let other = matches!(
            node.attrib_type,
            ElementType::Mesh
                | ElementType::Camera
                | ElementType::Light
                | ElementType::CameraSwitcher
        );
        let below = nodes[n].parent.is_some_and(|p| nodes[p].joint);
        if animated[n] && !node.is_root && !other && (below || !any) {
            nodes[n].joint = true;
        }
    }
    if !any && !nodes.iter().any(|node| node.joint) {
        for (node, animated) in nodes.iter_mut().zip(animated) {
            node.joint = animated;
        }
    }
    if !any {
        join_nulls(fbx, order, nodes);
    }
}

/// Among animated nodes of no kind, those between two of them are joints, too.
fn join_nulls(fbx: &Fbx, order: &[usize], nodes: &mut [SceneNode]) {
    let mut leads_to_joint = vec![false; nodes.len()];
    for &n in order.iter().rev() {
        leads_to_joint[n] |= nodes[n].joint;
        if let (true, Some(parent)) = (leads_to_joint[n], nodes[n].parent) {
            leads_to_joint[parent] = true;
        }
    }
    for &n in order {
        let below = nodes[n].parent.is_some_and(|p| nodes[p].joint);
        if below && leads_to_joint[n] && !fbx.nodes[n].is_root {
            nodes[n].joint = true;
        }
    }
}

/// The node that a property's curves turn or shift.
fn moved_node(prop: &ufbx::AnimProp, nodes: usize) -> Option<usize> {
    let moves = matches!(&*prop.prop_name, "Lcl Translation" | "Lcl Rotation");
    let number = prop.element.typed_id as usize;
    let curves = prop.anim_value.curves.iter().flatten();
    let keyed = curves.clone().any(|curve| !curve.keyframes.is_empty());
    (moves && keyed && prop.element.type_ == ElementType::Node && number < nodes).then_some(number)
}

/// An animation of one skeleton.
struct AnimationStack<'a> {
    name: String,
    stack: &'a ufbx::AnimStack,
    rig: &'a SceneSkeleton,
    /// Seconds.
    keys: Vec<f64>,
    /// In place of what keys and scene say.
    rate_hz: Option<f64>,
}

/// The takes that move a skeleton. A take whose keys are one pose is left out where others move.
fn takes<'a>(
    fbx: &'a Fbx,
    rigs: &'a [SceneSkeleton],
    rate_hz: Option<f64>,
    warnings: &mut Vec<Warning>,
) -> Vec<AnimationStack<'a>> {
    let mut takes = Vec::new();
    for stack in &fbx.anim_stacks {
        let before = takes.len();
        for rig in rigs {
            let keys = key_times(stack, rig, fbx.nodes.len());
            if !keys.is_empty() {
                takes.push(AnimationStack {
                    name: stack.element.name.to_string(),
                    stack,
                    rig,
                    keys,
                    rate_hz,
                });
            }
        }
        if takes.len() == before {
            let text = format!(
                "take `{}` moves no joint and is left out",
                &*stack.element.name
            );
            warnings.push(Warning::new(Place::File, text));
        }
    }
    takes
}

fn key_times(stack: &ufbx::AnimStack, rig: &SceneSkeleton, nodes: usize) -> Vec<f64> {
    let mut times = Vec::new();
    for layer in &stack.layers {
        for prop in &layer.anim_props {
            if moved_node(prop, nodes).is_some_and(|node| rig.moved_by(node)) {
                for curve in prop.anim_value.curves.iter().flatten() {
                    times.extend(curve.keyframes.iter().map(|key| key.time));
                }
            }
        }
    }
    times
}

/// The frames of a take: where its keys are, but not outside of what the take says it shows.
fn grid(
    fbx: &Fbx,
    take: &AnimationStack<'_>,
    clip_name: &str,
    warnings: &mut Vec<Warning>,
) -> KeyGrid {
    let stated = fbx.settings.frames_per_second;
    let (begin, end) = (take.stack.time_begin, take.stack.time_end);
    let shown: Vec<f64> = take
        .keys
        .iter()
        .copied()
        .filter(|&time| time >= begin - 1e-4 && time <= end + 1e-4)
        .collect();
    let trimmed = shown.len() < take.keys.len() && end - begin > 1.5 / stated.max(1.0);
    let first = take.keys.iter().copied().fold(f64::INFINITY, f64::min);
    let last = take.keys.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut times = take.keys.clone();
    if trimmed && begin < last && end > first {
        times = shown;
        times.extend([begin.max(first), end.min(last)]);
        let text =
            format!("{clip_name}: keys outside the take, {begin:.3} s to {end:.3} s, are left out");
        warnings.push(Warning::new(Place::File, text));
    }
    if let Some(rate_hz) = take.rate_hz {
        let first = times.iter().copied().fold(f64::INFINITY, f64::min);
        let last = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        return keys::at_rate(first, last, rate_hz, true);
    }
    let grid = keys::grid(times, Some(stated)).unwrap_or(KeyGrid {
        start_secs: 0.0,
        rate_hz: 30.0,
        frames: 0,
        exact: true,
    });
    grid.warn_if_uneven(clip_name, warnings);
    grid
}

fn clip(
    fbx: &Fbx,
    take: &AnimationStack<'_>,
    nodes: &[SceneNode],
    clip_name: String,
    size: SceneSize,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Clip, ParseError> {
    let sampling = Sampling {
        nodes,
        grid: grid(fbx, take, &clip_name, warnings),
        name: &|node| nodes[node].name.clone(),
        size,
        limits,
    };
    scene::sample(&sampling, take.rig, clip_name, |node, time| {
        local(&fbx.nodes[node].evaluate_transform(&take.stack.anim, time))
    })
}

fn local(transform: &ufbx::Transform) -> Local {
    let vector = |v: &ufbx::Vec3| Vec3::new(v.x, v.y, v.z);
    let q = &transform.rotation;
    Local {
        translation: vector(&transform.translation),
        rotation: Quat::new_unchecked(nalgebra::Quaternion::new(q.w, q.x, q.y, q.z)),
        scale: vector(&transform.scale),
    }
}

#[cfg(test)]
mod tests;
