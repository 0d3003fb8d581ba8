//! Nodes, skins and humanoids: which nodes are joints, and their names.

use serde_json::Value;

use super::super::scene::{self, Local, SceneNode, SceneSkeleton};
use super::super::{Limits, ParseError, Place, Warning};
use super::animation::rotation;
use super::document::{Document, index, numbers};
use crate::math::{Quat, Vec3};
use nalgebra::{Matrix3, Rotation3};

/// The nodes of a file and the skeletons among them.
pub(super) struct GltfScene {
    pub(super) nodes: Vec<SceneNode>,
    pub(super) rigs: Vec<SceneSkeleton>,
    /// For each node the humanoid bone that it is.
    bones: Vec<Option<String>>,
    /// True if there is a skin or a humanoid.
    character: bool,
    /// The rate at which keys are sampled, where it is given.
    pub(super) rate_hz: Option<f64>,
}

impl GltfScene {
    pub(super) fn of(
        document: &Document,
        limits: &Limits,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, ParseError> {
        let mut nodes = nodes(document);
        let order = scene::parents_first(&mut nodes, limits)?;
        let bones = humanoid(document, nodes.len());
        let skins: Vec<Vec<usize>> = document
            .list("skins")
            .iter()
            .map(|skin| {
                let joints = skin["joints"].as_array().map_or(&[][..], Vec::as_slice);
                let joints = joints.iter().filter_map(index);
                joints.filter(|&joint| joint < nodes.len()).collect()
            })
            .collect();
        for &joint in skins.iter().flatten() {
            nodes[joint].joint = true;
        }
        // Files of motion alone (VRMA) have a humanoid and no skin.
        for (node, bone) in nodes.iter_mut().zip(&bones) {
            node.joint |= bone.is_some();
        }
        let character = nodes.iter().any(|node| node.joint);
        mark_animated(document, &order, character, &mut nodes);
        let rigs = scene::rigs(&nodes, &order);
        let rigs = one_a_skin(rigs, &skins, warnings);
        let rigs = scene::worthwhile(rigs, &nodes, warnings);
        Ok(Self {
            nodes,
            rigs,
            bones,
            character,
            rate_hz: None,
        })
    }

    /// True if there is a skin or a humanoid.
    pub(super) fn is_character(&self) -> bool {
        self.character && !self.rigs.is_empty()
    }

    /// Name of a node's joint: its humanoid bone, else the node's name.
    pub(super) fn joint_name(&self, node: usize) -> String {
        match &self.bones[node] {
            Some(bone) => bone.clone(),
            None => self.nodes[node].name.clone(),
        }
    }
}

fn nodes(document: &Document) -> Vec<SceneNode> {
    let list = document.list("nodes");
    let mut nodes: Vec<SceneNode> = list
        .iter()
        .enumerate()
        .map(|(number, json)| SceneNode {
            name: match json["name"].as_str() {
                Some(name) if !name.is_empty() => name.to_owned(),
                _ => format!("node{number}"),
            },
            parent: None,
            rest: rest(json),
            joint: false,
        })
        .collect();
    for (parent, json) in list.iter().enumerate() {
        for child in json["children"].as_array().into_iter().flatten() {
            if let Some(child) = index(child).and_then(|child| nodes.get_mut(child)) {
                // The specification allows one parent; the first that claims a node has it.
                child.parent.get_or_insert(parent);
            }
        }
    }
    nodes
}

/// A node's transform, of its parts or its matrix.
fn rest(json: &Value) -> Local {
    if let Some(m) = numbers::<16>(&json["matrix"]) {
        return of_matrix(&m);
    }
    let identity = Local::IDENTITY;
    let vector = |key: &str| numbers::<3>(&json[key]).map(Vec3::from);
    Local {
        translation: vector("translation").unwrap_or(identity.translation),
        rotation: numbers::<4>(&json["rotation"])
            .and_then(|q| rotation(&q))
            .unwrap_or(identity.rotation),
        scale: vector("scale").unwrap_or(identity.scale),
    }
}

/// Parts of a matrix in column order; what is sheared comes out without shear.
fn of_matrix(m: &[f64; 16]) -> Local {
    let linear = Matrix3::new(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);
    let mut scale = Vec3::new(
        linear.column(0).norm(),
        linear.column(1).norm(),
        linear.column(2).norm(),
    );
    // A mirrored frame is no rotation: the mirror goes into the scale.
    if linear.determinant() < 0.0 {
        scale.x = -scale.x;
    }
    let mut turned = linear;
    for k in 0..3 {
        let mut column = turned.column_mut(k);
        column /= if scale[k] == 0.0 { 1.0 } else { scale[k] };
    }
    let rotation = if turned.determinant() > 0.1 {
        Quat::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turned))
    } else {
        Quat::identity()
    };
    Local {
        translation: Vec3::new(m[12], m[13], m[14]),
        rotation: Quat::new_normalize(rotation.into_inner()),
        scale,
    }
}

/// For each node its humanoid bone: of VRM 1.0 and VRM animations by name, of VRM 0.x in a list.
fn humanoid(document: &Document, nodes: usize) -> Vec<Option<String>> {
    let mut bones = vec![None; nodes];
    let mut set = |bone: &str, node: &Value| {
        if let Some(place) = index(node).and_then(|node| bones.get_mut(node)) {
            *place = Some(bone.to_owned());
        }
    };
    let extensions = &document.json["extensions"];
    for extension in ["VRMC_vrm", "VRMC_vrm_animation"] {
        let human = &extensions[extension]["humanoid"]["humanBones"];
        for (bone, json) in human.as_object().into_iter().flatten() {
            set(bone, &json["node"]);
        }
    }
    let human = &extensions["VRM"]["humanoid"]["humanBones"];
    for json in human.as_array().into_iter().flatten() {
        if let Some(bone) = json["bone"].as_str() {
            set(bone, &json["node"]);
        }
    }
    bones
}

/// Animated nodes below joints are joints, too; in a file without skin or humanoid all are. Nodes that VRM animations
/// keep expressions and the look in are none.
fn mark_animated(document: &Document, order: &[usize], character: bool, nodes: &mut [SceneNode]) {
    let mut animated = vec![false; nodes.len()];
    for animation in document.list("animations") {
        for channel in animation["channels"].as_array().into_iter().flatten() {
            let target = &channel["target"];
            let moves = matches!(target["path"].as_str(), Some("translation" | "rotation"));
            let node = index(&target["node"]).and_then(|node| animated.get_mut(node));
            if let (true, Some(node)) = (moves, node) {
                *node = true;
            }
        }
    }
    let vrm = &document.json["extensions"]["VRMC_vrm_animation"];
    let groups = ["preset", "custom"].map(|group| &vrm["expressions"][group]);
    let expressions = groups
        .into_iter()
        .filter_map(Value::as_object)
        .flat_map(|group| group.values());
    for json in expressions.chain([&vrm["lookAt"]]) {
        if let Some(node) = index(&json["node"]).and_then(|node| animated.get_mut(node)) {
            *node = false;
        }
    }
    for &n in order {
        let below_joint = nodes[n].parent.is_some_and(|p| nodes[p].joint);
        // Cameras are animated, too.
        let bare = document.list("nodes")[n]["camera"].is_null();
        if animated[n] && bare && (below_joint || !character) {
            nodes[n].joint = true;
        }
    }
}

/// Of several trees of joints in one skin the largest is the body; the others are controls and props.
fn one_a_skin(
    rigs: Vec<SceneSkeleton>,
    skins: &[Vec<usize>],
    warnings: &mut Vec<Warning>,
) -> Vec<SceneSkeleton> {
    let nodes = rigs
        .iter()
        .flat_map(SceneSkeleton::nodes)
        .max()
        .map_or(0, |n| n + 1);
    let mut rig_of = vec![None; nodes];
    for (k, rig) in rigs.iter().enumerate() {
        for node in rig.nodes() {
            rig_of[node] = Some(k);
        }
    }
    let mut keep = vec![true; rigs.len()];
    for skin in skins {
        let mut of_skin: Vec<usize> = skin.iter().filter_map(|&n| rig_of[n]).collect();
        of_skin.sort_unstable();
        of_skin.dedup();
        // A skin of a single rig, as nearly all are, keeps it.
        let largest = of_skin.iter().copied().max_by_key(|&k| rigs[k].len());
        for k in of_skin {
            keep[k] &= Some(k) == largest;
        }
    }
    let count = keep.iter().filter(|keep| !**keep).count();
    if count > 0 {
        let text = format!("{count} separate joint trees of the body's skin are left out");
        warnings.push(Warning::new(Place::File, text));
    }
    let mut keep = keep.into_iter();
    let mut rigs = rigs;
    rigs.retain(|_| keep.next().unwrap_or(true));
    rigs
}
