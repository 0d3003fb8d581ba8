//! Scenes of nodes: finds the skeletons among them, and their motion.

use super::builder::{ClipBuilder, check_size};
use super::keys::KeyGrid;
use super::{Limits, ParseError, Place, Warning};
use crate::clip::{Clip, Joint};
use crate::math::{Quat, Vec3};
use nalgebra::Matrix3;

/// Translation, rotation and scale in the parent's frame, applied in the order scale, rotation, translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Local {
    pub(super) translation: Vec3,
    pub(super) rotation: Quat,
    pub(super) scale: Vec3,
}

impl Local {
    pub(super) const IDENTITY: Local = Local {
        translation: Vec3::new(0.0, 0.0, 0.0),
        rotation: Quat::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0)),
        scale: Vec3::new(1.0, 1.0, 1.0),
    };
}

#[derive(Debug, Clone)]
pub(super) struct SceneNode {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    /// Rest transform.
    pub(super) rest: Local,
    /// True if it is a joint of a skeleton.
    pub(super) joint: bool,
}

/// Nodes that are joints, each with its nearest ancestor among them as its parent.
#[derive(Debug, Clone)]
pub(super) struct SceneSkeleton {
    /// Node and parent of each joint, parents first.
    joints: Vec<(usize, Option<usize>)>,
    /// The joints' nodes and all nodes above them, parents first.
    needed: Vec<usize>,
    /// The same in order of their numbers.
    sorted: Vec<usize>,
}

impl SceneSkeleton {
    /// The joints' nodes, parents first.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.joints.iter().map(|joint| joint.0)
    }

    /// Number of joints.
    pub(super) fn len(&self) -> usize {
        self.joints.len()
    }

    /// True if a node moves the joints: is one of them or above one. O(log nodes).
    pub(super) fn moved_by(&self, node: usize) -> bool {
        self.sorted.binary_search(&node).is_ok()
    }

    /// The root's node.
    pub(super) fn root(&self) -> usize {
        self.joints[0].0
    }
}

/// The scene's nodes so that parents come first; parents that lead in a circle are cut.
pub(super) fn parents_first(
    nodes: &mut [SceneNode],
    limits: &Limits,
) -> Result<Vec<usize>, ParseError> {
    let mut children = vec![Vec::new(); nodes.len()];
    let mut open = Vec::new();
    for (n, node) in nodes.iter().enumerate() {
        match node.parent.filter(|&p| p < nodes.len() && p != n) {
            Some(parent) => children[parent].push(n),
            None => open.push((n, 0)),
        }
    }
    open.reverse();
    let mut order = Vec::with_capacity(nodes.len());
    let mut seen = vec![false; nodes.len()];
    let mut next = 0;
    loop {
        while let Some((n, depth)) = open.pop() {
            if std::mem::replace(&mut seen[n], true) {
                continue;
            }
            if depth >= limits.depth {
                let expected = format!("at most {} nodes below each other", limits.depth);
                return Err(ParseError::new(Place::File, expected, "more"));
            }
            order.push(n);
            open.extend(children[n].iter().rev().map(|&child| (child, depth + 1)));
        }
        // What no root leads to is a circle.
        while next < nodes.len() && seen[next] {
            next += 1;
        }
        if next == nodes.len() {
            break;
        }
        nodes[next].parent = None;
        open.push((next, 0));
    }
    let mut place = vec![0; nodes.len()];
    for (at, &n) in order.iter().enumerate() {
        place[n] = at;
    }
    for n in 0..nodes.len() {
        nodes[n].parent = nodes[n]
            .parent
            .filter(|&p| p < nodes.len() && place[p] < place[n]);
    }
    Ok(order)
}

/// The skeletons of a scene whose nodes `order` lists parents first: joints that hang together.
pub(super) fn rigs(nodes: &[SceneNode], order: &[usize]) -> Vec<SceneSkeleton> {
    // For each node, the nearest joint at or above it: rig and number there.
    let mut nearest: Vec<Option<(usize, usize)>> = vec![None; nodes.len()];
    let mut rigs: Vec<SceneSkeleton> = Vec::new();
    for &n in order {
        let above = nodes[n].parent.and_then(|p| nearest[p]);
        if !nodes[n].joint {
            nearest[n] = above;
            continue;
        }
        let (rig, parent) = match above {
            Some((rig, parent)) => (rig, Some(parent)),
            None => {
                rigs.push(SceneSkeleton {
                    joints: Vec::new(),
                    needed: Vec::new(),
                    sorted: Vec::new(),
                });
                (rigs.len() - 1, None)
            }
        };
        nearest[n] = Some((rig, rigs[rig].joints.len()));
        rigs[rig].joints.push((n, parent));
    }
    let mut place = vec![0; nodes.len()];
    for (at, &n) in order.iter().enumerate() {
        place[n] = at;
    }
    let mut seen_for = vec![usize::MAX; nodes.len()];
    for (number, rig) in rigs.iter_mut().enumerate() {
        for &(node, _) in &rig.joints {
            let mut at = Some(node);
            while let Some(n) = at.filter(|&n| seen_for[n] != number) {
                seen_for[n] = number;
                rig.needed.push(n);
                at = nodes[n].parent;
            }
        }
        rig.sorted = rig.needed.clone();
        rig.sorted.sort_unstable();
        rig.needed.sort_unstable_by_key(|&n| place[n]);
    }
    rigs
}

/// A node in the world.
#[derive(Clone, Copy)]
struct World {
    position: Vec3,
    /// Rotation and scale.
    linear: Matrix3<f64>,
    rotation: Quat,
    /// True if `linear` is the rotation times a positive number.
    plain: bool,
}

impl World {
    const ORIGIN: World = World {
        position: Vec3::new(0.0, 0.0, 0.0),
        linear: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        rotation: Local::IDENTITY.rotation,
        plain: true,
    };

    fn child(&self, local: &Local) -> World {
        let s = local.scale;
        let turned = local.rotation.to_rotation_matrix();
        let linear = self.linear * turned.matrix() * Matrix3::from_diagonal(&s);
        let even = s.x > 0.0 && (s.y / s.x - 1.0).abs() < 1e-4 && (s.z / s.x - 1.0).abs() < 1e-4;
        let plain = self.plain && even;
        World {
            position: self.position + self.linear * local.translation,
            linear,
            rotation: match plain {
                true => self.rotation * local.rotation,
                false => nearest_rotation(&linear).unwrap_or(self.rotation * local.rotation),
            },
            plain,
        }
    }
}

/// The rotation of the polar decomposition `linear = ±Q·P`, for scales that are uneven or mirror.
fn nearest_rotation(linear: &Matrix3<f64>) -> Option<Quat> {
    if !linear.iter().all(|v| v.is_finite()) {
        return None;
    }
    let svd = linear.svd(true, true);
    if svd.singular_values.min() <= 1e-12 * svd.singular_values.max() {
        return None;
    }
    let q = svd.u? * svd.v_t?;
    let q = if q.determinant() < 0.0 { -q } else { q };
    Some(Quat::from_rotation_matrix(
        &nalgebra::Rotation3::from_matrix_unchecked(q),
    ))
}

/// Worlds of the nodes that a rig needs.
fn pose(
    nodes: &[SceneNode],
    rig: &SceneSkeleton,
    worlds: &mut [World],
    mut local: impl FnMut(usize) -> Local,
) {
    for &n in &rig.needed {
        let above = nodes[n].parent.map_or(World::ORIGIN, |p| worlds[p]);
        worlds[n] = above.child(&local(n));
    }
}

/// The joints as they rest; `name` may call them otherwise than their nodes.
fn joints_at_rest(
    nodes: &[SceneNode],
    rig: &SceneSkeleton,
    worlds: &mut [World],
    name: &dyn Fn(usize) -> String,
) -> Vec<Joint> {
    pose(nodes, rig, worlds, |n| nodes[n].rest);
    let offset = |n: usize, parent: Option<usize>| match parent.map(|p| rig.joints[p].0) {
        Some(p) => worlds[p].rotation.inverse() * (worlds[n].position - worlds[p].position),
        None => worlds[n].position,
    };
    let mut joints: Vec<Joint> = rig
        .joints
        .iter()
        .map(|&(n, parent)| Joint {
            name: name(n),
            parent,
            offset: offset(n, parent),
            tip: None,
        })
        .collect();
    let mut is_leaf = vec![true; joints.len()];
    for joint in &joints {
        if let Some(parent) = joint.parent {
            is_leaf[parent] = false;
        }
    }
    let below = only_children(nodes);
    for (j, &(n, _)) in rig.joints.iter().enumerate() {
        if let (true, Some(end)) = (is_leaf[j], below[n]) {
            let away = worlds[n].linear * nodes[end].rest.translation;
            let tip = worlds[n].rotation.inverse() * away;
            joints[j].tip = Some(tip).filter(|tip| tip.norm() > 0.0);
        }
    }
    joints
}

/// For each node its child, if it has just one.
fn only_children(nodes: &[SceneNode]) -> Vec<Option<usize>> {
    let mut counts = vec![0; nodes.len()];
    let mut last = vec![None; nodes.len()];
    for (n, node) in nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            counts[parent] += 1;
            last[parent] = Some(n);
        }
    }
    last.into_iter()
        .zip(counts)
        .map(|(child, count)| child.filter(|_| count == 1))
        .collect()
}

/// Size of a scene, for the limit on its frames.
#[derive(Clone, Copy)]
pub(super) struct SceneSize {
    /// Bytes that the keys have.
    pub(super) bytes: usize,
    /// Poses that were made of them so far.
    pub(super) earlier: usize,
}

/// Sampling of a rig.
pub(super) struct Sampling<'a> {
    pub(super) nodes: &'a [SceneNode],
    pub(super) grid: KeyGrid,
    /// Name of a joint, by its node.
    pub(super) name: &'a dyn Fn(usize) -> String,
    pub(super) size: SceneSize,
    pub(super) limits: &'a Limits,
}

/// Samples one rig; `local` gives a node's transform at a time in seconds. Frames that are not finite are filled.
pub(super) fn sample(
    sampling: &Sampling<'_>,
    rig: &SceneSkeleton,
    clip_name: String,
    mut local: impl FnMut(usize, f64) -> Local,
) -> Result<Clip, ParseError> {
    let Sampling { nodes, grid, .. } = *sampling;
    let SceneSize { bytes, earlier } = sampling.size;
    check_size(grid.frames, rig.len(), earlier, bytes, sampling.limits)?;
    let mut worlds = vec![World::ORIGIN; nodes.len()];
    let joints = joints_at_rest(nodes, rig, &mut worlds, sampling.name);
    let finite = joints
        .iter()
        .all(|joint| joint.offset.iter().all(|v| v.is_finite()));
    if !finite {
        return Err(ParseError::new(
            Place::File,
            "finite positions of joints",
            "positions out of range",
        ));
    }
    let mut builder = ClipBuilder::new(joints);
    builder.reserve(grid.frames)?;
    let (mut rotations, mut positions) = (Vec::new(), Vec::new());
    for frame in 0..grid.frames {
        let time = grid.start_secs + frame as f64 / grid.rate_hz;
        pose(nodes, rig, &mut worlds, |n| local(n, time));
        rotations.clear();
        positions.clear();
        for n in rig.nodes() {
            rotations.push(worlds[n].rotation);
            positions.push(worlds[n].position);
        }
        let finite = positions.iter().flatten().all(|v| v.abs() < 1e100)
            && rotations
                .iter()
                .all(|q| (q.coords.norm() - 1.0).abs() < 1e-3);
        match finite {
            true => builder.push_world(&rotations, &positions),
            false => builder.push_missing(),
        }
    }
    builder.finish(clip_name, grid.rate_hz)
}

/// Skeletons worth reading: those of one or two joints are cameras and props where there is a larger one. The others are
/// named in a warning.
pub(super) fn worthwhile(
    rigs: Vec<SceneSkeleton>,
    nodes: &[SceneNode],
    warnings: &mut Vec<Warning>,
) -> Vec<SceneSkeleton> {
    const NAMED: usize = 5;
    let largest = rigs.iter().map(SceneSkeleton::len).max().unwrap_or(0);
    let is_worthwhile = |rig: &SceneSkeleton| rig.len() > 2 || largest <= 2;
    let (rigs, left): (Vec<_>, Vec<_>) = rigs.into_iter().partition(is_worthwhile);
    if !left.is_empty() {
        let names = left.iter().take(NAMED);
        let names: Vec<&str> = names.map(|rig| nodes[rig.root()].name.as_str()).collect();
        let text = format!(
            "{} single nodes besides the skeleton are left out: {}",
            left.len(),
            names.join(", ")
        );
        warnings.push(Warning::new(Place::File, text));
    }
    rigs
}
