//! glTF 2.0, binary (GLB) or text, and what is made of it: VRM models and VRM animations (VRMA).
//!
//! After the *glTF 2.0 Specification* (Khronos, 2021) and *VRMC_vrm_animation-1.0* (VRM Consortium). Meshes and
//! pictures are not looked at. Files that break rules without consequence here are read: no `asset`, no `specVersion`,
//! accessors without bounds, channels that lead nowhere, more keys than values.

mod accessor;
mod animation;
mod document;
mod nodes;
mod write;

pub use self::write::{write, write_vrma};
pub use super::descriptor::Beside;

use self::animation::Animation;
use self::document::Document;
use self::nodes::GltfScene;
use super::builder::clip_names;
use super::descriptor::FormatDescriptor;
use super::head::Head;
use super::scene::{self, Local, Sampling, SceneSize, SceneSkeleton};
use super::{Limits, Loaded, ParseError, Place, Warning, keys};
use crate::clip::Clip;
use crate::math::Axis;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "gltf",
    title: "glTF",
    noun: "a glTF scene",
    endings: &["gltf", "glb", "vrm", "vrma"],
    looks_so: |h| h.bytes.starts_with(b"glTF") || is_gltf(h),
    up: Some(Axis::Y),
    read: |file| {
        read_at(
            file.bytes,
            file.name,
            file.rate_hz,
            file.beside,
            file.limits,
        )
    },
};

/// An object with glTF's words.
fn is_gltf(head: &Head) -> bool {
    let lists = || head.contains(b"\"nodes\"") && head.contains(b"\"scenes\"");
    head.starts("{") && (head.contains(b"\"asset\"") || lists())
}

/// Reads the skeletal animations of a glTF, GLB, VRM or VRMA file: a clip for each animation and each skeleton that it
/// moves, called `name` (`name#animation` for several). `beside` finds buffers that lie in files of their own.
///
/// Clips are sampled at the rate at which their keys lie (30 Hz for keys far apart, 60 Hz for keys without a rate).
/// Joints of a humanoid are called by its bone names (`leftUpperLeg`), others as their nodes. Scales are folded into the
/// positions. Axes and lengths are the file's: by the specification Y up and metres.
///
/// # Errors
/// The place and the cause: no glTF, another version, no animation of a skeleton, a buffer that is not there, more than `limits`
/// allow. O(bytes + frames × nodes).
pub fn read(
    bytes: &[u8],
    name: &str,
    beside: Beside<'_>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    read_at(bytes, name, None, beside, limits)
}

/// [`read`], sampled at `rate_hz` where it is given.
fn read_at(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    beside: Beside<'_>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut warnings = Vec::new();
    let limits = &Document::limits_beside(bytes, limits)?;
    let document = Document::parse(bytes, limits, &mut warnings)?;
    let mut stage = GltfScene::of(&document, limits, &mut warnings)?;
    stage.rate_hz = rate_hz;
    // Half for the keys, half for the poses that are made of them.
    let limits = &Limits {
        memory: limits.memory / 2,
        ..*limits
    };
    let mut animations = animation::all(&document, beside, limits, &mut warnings)?;
    if animations.is_empty() {
        return Err(without_animation(&document, &stage, ""));
    }
    if animations
        .iter()
        .all(|animation| animation.channels.is_empty())
        && stage.is_character()
    {
        let note = "the animation has no keys; one frame of the rest pose is read";
        warnings.push(Warning::new(Place::File, note));
        animations.truncate(1);
    } else {
        animations.retain(|animation| {
            let moves = stage.rigs.iter().any(|rig| animation.moves(rig));
            if !moves {
                let text = format!("{} moves no joint and is left out", animation.title());
                warnings.push(Warning::new(Place::File, text));
            }
            moves
        });
    }
    if animations.is_empty() {
        let what = "; its animations are of other things (shapes, cameras)";
        return Err(without_animation(&document, &stage, what));
    }
    let clips = clips(
        &animations,
        &stage,
        name,
        bytes.len(),
        limits,
        &mut warnings,
    )?;
    Ok(Loaded { clips, warnings })
}

fn without_animation(document: &Document, stage: &GltfScene, but: &str) -> ParseError {
    let kind = document.kind();
    let joints = match stage.rigs.iter().map(SceneSkeleton::len).sum::<usize>() {
        0 => "without a skeleton or animation".to_owned(),
        joints => format!("with a skeleton of {joints} joints, without animation of it{but}"),
    };
    ParseError::new(
        Place::File,
        "an animation of a skeleton",
        format!("{kind}, a model {joints}"),
    )
}

fn clips(
    animations: &[Animation],
    stage: &GltfScene,
    name: &str,
    bytes: usize,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Clip>, ParseError> {
    let still = animations.len() == 1 && animations[0].channels.is_empty();
    let pairs: Vec<(&Animation, &SceneSkeleton)> = animations
        .iter()
        .flat_map(|animation| {
            let moved = stage
                .rigs
                .iter()
                .filter(move |rig| still || animation.moves(rig));
            moved.map(move |rig| (animation, rig))
        })
        .collect();
    let titles: Vec<String> = pairs
        .iter()
        .map(|(animation, rig)| match stage.rigs.len() {
            1 => animation.name.clone(),
            _ if animations.len() == 1 => stage.joint_name(rig.root()),
            _ => format!("{} {}", animation.name, stage.joint_name(rig.root())),
        })
        .collect();
    let mut clips = Vec::with_capacity(pairs.len());
    let mut size = SceneSize { bytes, earlier: 0 };
    for ((animation, rig), clip_name) in pairs.into_iter().zip(clip_names(name, &titles)) {
        let clip = clip(animation, rig, stage, clip_name, size, limits, warnings)?;
        size.earlier += clip.rotations.len();
        clips.push(clip);
    }
    Ok(clips)
}

fn clip(
    animation: &Animation,
    rig: &SceneSkeleton,
    stage: &GltfScene,
    clip_name: String,
    size: SceneSize,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Clip, ParseError> {
    let times = animation.key_times(rig);
    let grid = keys::grid_at(times, stage.rate_hz).unwrap_or(keys::KeyGrid {
        start_secs: 0.0,
        rate_hz: stage.rate_hz.unwrap_or(30.0),
        frames: 1,
        exact: true,
    });
    grid.warn_if_uneven(&clip_name, warnings);
    let sampling = Sampling {
        nodes: &stage.nodes,
        grid,
        name: &|node| stage.joint_name(node),
        size,
        limits,
    };
    let by_node = animation.by_node(stage.nodes.len());
    scene::sample(&sampling, rig, clip_name, |node, time| {
        let mut local: Local = stage.nodes[node].rest;
        for &channel in &by_node[node] {
            animation.channels[channel].apply(time, &mut local);
        }
        local
    })
}

#[cfg(test)]
mod tests;
