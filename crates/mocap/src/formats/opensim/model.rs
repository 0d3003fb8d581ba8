//! The model: bodies, the joints between them, and how these depend on their coordinates.

use std::collections::HashMap;

use roxmltree::{Document, Node};

use super::super::xml::{child, is, place};
use super::super::{Limits, ParseError, Place, Warning};
use super::function::{Function, warn_of_smoothing};
use super::values::{numbers, vector};
use crate::math::{Axis, Quat, Vec3};
use crate::parse_error::shortened;

/// The bodies of an OpenSim model, parents first, and what moves them.
#[derive(Debug, Clone, PartialEq)]
pub struct OsimModel {
    pub(super) bodies: Vec<OsimBody>,
    pub(super) coordinates: Vec<Coordinate>,
    pub(super) couplings: Vec<Coupling>,
}

/// A body and the joint by which it hangs in another.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OsimBody {
    pub(super) name: String,
    /// `None`: the ground.
    pub(super) parent: Option<usize>,
    /// The joint's frame in the parent and in the body.
    pub(super) in_parent: BodyPlacement,
    pub(super) in_child: BodyPlacement,
    /// Turns, one after the other about axes that turn along; then slides along axes of the parent's frame.
    pub(super) turns: Vec<JointAxis>,
    pub(super) slides: Vec<JointAxis>,
}

/// A frame in another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BodyPlacement {
    pub(super) rotation: Quat,
    pub(super) position: Vec3,
}

impl BodyPlacement {
    const fn new(rotation: Quat, position: Vec3) -> Self {
        Self { rotation, position }
    }

    pub(super) fn then(&self, inner: &Self) -> Self {
        Self::new(
            self.rotation * inner.rotation,
            self.position + self.rotation * inner.position,
        )
    }

    pub(super) fn inverse(&self) -> Self {
        let back = self.rotation.inverse();
        Self::new(back, -(back * self.position))
    }
}

/// Angle by which a joint turns about an axis, or distance by which it slides along it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointAxis {
    pub(super) axis: Vec3,
    pub(super) function: Function,
    /// Numbers of the coordinates that the function takes.
    pub(super) inputs: Vec<usize>,
}

/// A coordinate: an angle in radians or a length in metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coordinate {
    pub(super) name: String,
    pub(super) default: f64,
    /// True if motions give it in degrees if they give angles so.
    pub(super) is_angle: bool,
}

/// A coordinate that follows others.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coupling {
    pub(super) dependent: usize,
    pub(super) inputs: Vec<usize>,
    pub(super) function: Function,
    pub(super) scale: f64,
}

/// A joint as its element says it, its bodies by name.
struct NamedJoint<'a, 'input> {
    node: Node<'a, 'input>,
    child: String,
    parent: String,
    in_parent: BodyPlacement,
    in_child: BodyPlacement,
}

pub(super) fn of_document(
    document: &Document<'_>,
    limits: &Limits,
) -> Result<(OsimModel, Vec<Warning>), ParseError> {
    let root = document.root_element();
    let model = child(root, "Model").unwrap_or(root);
    if !is(root, "OpenSimDocument") && !is(root, "Model") {
        let found = format!("<{}>", root.tag_name().name());
        return Err(ParseError::new(place(root), "<OpenSimDocument>", found));
    }
    let mut warnings = Vec::new();
    warn_of_smoothing(model, &mut warnings);
    let joints = joints(model)?;
    if joints.is_empty() {
        return Err(ParseError::new(
            place(model),
            "bodies with joints in the OpenSim model",
            "none",
        ));
    }
    if joints.len() > limits.joints {
        let expected = format!("at most {} joints", limits.joints);
        return Err(ParseError::new(
            place(model),
            expected,
            joints.len().to_string(),
        ));
    }
    let order = order(&joints, limits, &mut warnings)?;
    let mut built = OsimModel {
        bodies: Vec::with_capacity(order.len()),
        coordinates: Vec::new(),
        couplings: Vec::new(),
    };
    let mut coordinate_numbers = HashMap::new();
    // Before the axes: those of a joint may take coordinates of one that stands after it.
    for joint in &joints {
        add_coordinates(joint.node, &mut built.coordinates, &mut coordinate_numbers)?;
    }
    let mut numbers = HashMap::new();
    for k in order {
        let joint = &joints[k];
        let (turns, slides) = axes(joint.node, &coordinate_numbers)?;
        numbers.insert(joint.child.as_str(), built.bodies.len());
        built.bodies.push(OsimBody {
            name: joint.child.clone(),
            parent: numbers.get(joint.parent.as_str()).copied(),
            in_parent: joint.in_parent,
            in_child: joint.in_child,
            turns,
            slides,
        });
    }
    // Needs all joints: a coordinate may be declared by one and turn another.
    built.judge_coordinates();
    built.couplings = couplings(model, &coordinate_numbers)?;
    Ok((built, warnings))
}

impl OsimModel {
    /// A coordinate that says nothing else is an angle if a joint turns by just that much.
    fn judge_coordinates(&mut self) {
        for body in &self.bodies {
            for turn in &body.turns {
                if let ([input], true) = (turn.inputs.as_slice(), turn.function.is_identity()) {
                    self.coordinates[*input].is_angle = true;
                }
            }
        }
    }
}

/// Every joint: within the body it moves (OpenSim 2 and 3), or in a list of joints (4).
fn joints<'a, 'input>(model: Node<'a, 'input>) -> Result<Vec<NamedJoint<'a, 'input>>, ParseError> {
    let objects = |tag: &str| {
        let list = child(model, tag).and_then(|set| child(set, "objects"));
        list.into_iter()
            .flat_map(|list| list.children().filter(Node::is_element))
    };
    let mut found = Vec::new();
    for body in objects("BodySet") {
        let own = child(body, "Joint").and_then(|joint| joint.children().find(Node::is_element));
        if let Some(node) = own {
            let text = |tag: &str| child(node, tag).and_then(|n| n.text()).unwrap_or_default();
            found.push(NamedJoint {
                node,
                child: body.attribute("name").unwrap_or_default().to_owned(),
                parent: text("parent_body").trim().to_owned(),
                in_parent: placement(node, "location_in_parent", "orientation_in_parent")?,
                in_child: placement(node, "location", "orientation")?,
            });
        }
    }
    for node in objects("JointSet") {
        let (parent, in_parent) = joint_frame(node, "socket_parent_frame")?;
        let (child, in_child) = joint_frame(node, "socket_child_frame")?;
        found.push(NamedJoint {
            node,
            child,
            parent,
            in_parent,
            in_child,
        });
    }
    Ok(found)
}

fn placement(
    node: Node<'_, '_>,
    position: &str,
    orientation: &str,
) -> Result<BodyPlacement, ParseError> {
    let angles = vector(node, orientation)?.unwrap_or_default();
    // Turns about X, Y and Z of the frame itself, one after the other.
    let turn = |rotation, axis: Axis| rotation * axis.rotation(angles[axis.index()]);
    let rotation = Axis::ALL.into_iter().fold(Quat::identity(), turn);
    Ok(BodyPlacement::new(
        rotation,
        vector(node, position)?.unwrap_or_default(),
    ))
}

/// The body that a joint's socket leads to, and the joint's frame in it.
fn joint_frame(joint: Node<'_, '_>, socket: &str) -> Result<(String, BodyPlacement), ParseError> {
    // Frames stand in frames; models have one or two between a joint and its body. More is a circle.
    const DEEPEST: usize = 8;
    let named = |node: Node<'_, '_>, tags: [&str; 2]| {
        let text = tags.into_iter().find_map(|tag| child(node, tag))?.text()?;
        text.trim().rsplit('/').next().map(str::to_owned)
    };
    let older = format!("{socket}_connectee_name");
    let mut name = named(joint, [socket, &older])
        .ok_or_else(|| ParseError::new(place(joint), format!("<{socket}>"), "none"))?;
    let mut whole = BodyPlacement::new(Quat::identity(), Vec3::zeros());
    for _ in 0..DEEPEST {
        let frames = child(joint, "frames");
        let offset = frames.and_then(|f| f.children().find(|n| n.attribute("name") == Some(&name)));
        let Some(offset) = offset else {
            return Ok((name, whole));
        };
        whole = placement(offset, "translation", "orientation")?.then(&whole);
        name = named(offset, ["socket_parent", "socket_parent_connectee_name"])
            .ok_or_else(|| ParseError::new(place(offset), "<socket_parent>", "none"))?;
    }
    Err(ParseError::new(
        place(joint),
        "frames less deep in each other",
        "more",
    ))
}

/// The joints of the largest tree of bodies, parents first.
fn order(
    joints: &[NamedJoint<'_, '_>],
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<usize>, ParseError> {
    let by_child: HashMap<&str, usize> = joints
        .iter()
        .enumerate()
        .map(|(k, j)| (j.child.as_str(), k))
        .collect();
    if let Some(twice) = joints
        .iter()
        .enumerate()
        .find(|(k, j)| by_child[j.child.as_str()] != *k)
    {
        let found = format!("two for {}", twice.1.child);
        return Err(ParseError::new(
            place(twice.1.node),
            "one joint for each body",
            found,
        ));
    }
    let mut trees: HashMap<usize, Vec<(usize, usize)>> = HashMap::new();
    for k in 0..joints.len() {
        let (mut root, mut depth) = (k, 0);
        while let Some(&parent) = by_child.get(joints[root].parent.as_str()) {
            (root, depth) = (parent, depth + 1);
            if depth > limits.depth {
                let expected = format!("bodies at most {} joints from the ground", limits.depth);
                return Err(ParseError::new(
                    place(joints[k].node),
                    expected,
                    "more, or a circle",
                ));
            }
        }
        if !is_ground(&joints[root].parent) {
            let found = format!("`{}`, which is no body", joints[root].parent);
            return Err(ParseError::new(
                place(joints[root].node),
                "a joint with a parent body",
                found,
            ));
        }
        trees.entry(root).or_default().push((depth, k));
    }
    // A treadmill or a box, say, stands on the ground by a joint of its own.
    let count = trees.len();
    let largest = trees
        .into_iter()
        .max_by_key(|(root, tree)| (tree.len(), std::cmp::Reverse(*root)));
    let mut tree = largest.map(|(_, tree)| tree).unwrap_or_default();
    tree.sort_unstable();
    if count > 1 {
        let text = format!(
            "{count} trees of bodies; only the tree with the most limbs is read, {} bodies",
            tree.len()
        );
        warnings.push(Warning::new(Place::File, text));
    }
    Ok(tree.into_iter().map(|(_, k)| k).collect())
}

fn is_ground(name: &str) -> bool {
    name.is_empty() || name.eq_ignore_ascii_case("ground")
}

fn add_coordinates(
    joint: Node<'_, '_>,
    coordinates: &mut Vec<Coordinate>,
    numbers_of: &mut HashMap<String, usize>,
) -> Result<(), ParseError> {
    for node in coordinate_nodes(joint) {
        let default = numbers(node, "default_value", None)?;
        let kind = child(node, "motion_type")
            .and_then(|n| n.text())
            .unwrap_or_default();
        let name = node.attribute("name").unwrap_or_default().to_owned();
        numbers_of.insert(name.clone(), coordinates.len());
        coordinates.push(Coordinate {
            name,
            default: default.first().copied().unwrap_or(0.0),
            is_angle: kind.trim().eq_ignore_ascii_case("rotational"),
        });
    }
    Ok(())
}

fn coordinate_nodes<'a, 'input>(joint: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    let older = child(joint, "CoordinateSet").and_then(|set| child(set, "objects"));
    let list = child(joint, "coordinates").or(older);
    list.into_iter()
        .flat_map(|list| list.children().filter(|n| is(*n, "Coordinate")))
}

/// The axes about which a joint turns, and those along which it slides.
fn axes(
    joint: Node<'_, '_>,
    numbers_of: &HashMap<String, usize>,
) -> Result<(Vec<JointAxis>, Vec<JointAxis>), ParseError> {
    let own: Vec<usize> = coordinate_nodes(joint)
        .filter_map(|node| {
            numbers_of
                .get(node.attribute("name").unwrap_or_default())
                .copied()
        })
        .collect();
    let along = |turns: &[Axis], slides: &[Axis]| {
        let axis = |(axis, input): (&Axis, &usize)| JointAxis {
            axis: axis.unit().into_inner(),
            function: Function::identity(),
            inputs: vec![*input],
        };
        match own.len() == turns.len() + slides.len() {
            true => Ok((
                turns.iter().zip(&own).map(axis).collect(),
                slides.iter().zip(&own[turns.len()..]).map(axis).collect(),
            )),
            false => {
                let expected = format!("{} coordinates of the joint", turns.len() + slides.len());
                Err(ParseError::new(
                    place(joint),
                    expected,
                    own.len().to_string(),
                ))
            }
        }
    };
    use Axis::{X, Y, Z};
    match joint.tag_name().name() {
        "CustomJoint" => custom_axes(joint, numbers_of),
        "WeldJoint" => along(&[], &[]),
        "PinJoint" => along(&[Z], &[]),
        "SliderJoint" => along(&[], &[X]),
        "UniversalJoint" => along(&[X, Y], &[]),
        "BallJoint" | "GimbalJoint" => along(&[X, Y, Z], &[]),
        "PlanarJoint" => along(&[Z], &[X, Y]),
        "FreeJoint" => along(&[X, Y, Z], &[X, Y, Z]),
        other => {
            let expected =
                "a custom, pin, slider, universal, ball, gimbal, planar, free or weld joint";
            Err(ParseError::new(
                place(joint),
                expected,
                format!("<{other}>"),
            ))
        }
    }
}

fn custom_axes(
    joint: Node<'_, '_>,
    numbers_of: &HashMap<String, usize>,
) -> Result<(Vec<JointAxis>, Vec<JointAxis>), ParseError> {
    let (mut turns, mut slides) = (Vec::new(), Vec::new());
    let transform = child(joint, "SpatialTransform");
    let nodes = transform
        .into_iter()
        .flat_map(|t| t.children().filter(|n| is(*n, "TransformAxis")));
    for (k, node) in nodes.enumerate() {
        let inputs = inputs(node, "coordinates", numbers_of)?;
        let function = match Function::in_element(node)? {
            Some(function) => function,
            // An axis without function and coordinate stays at 0.
            None if inputs.is_empty() => continue,
            None => Function::identity(),
        };
        let axis = vector(node, "axis")?.unwrap_or_default();
        // Named `rotation1` to `translation3`; older files are in that order.
        let name = node.attribute("name").unwrap_or_default();
        let is_turn = name.starts_with("rotation") || (!name.starts_with("translation") && k < 3);
        let joint_axis = JointAxis {
            axis: match axis.norm() {
                length if length > 1e-9 => axis / length,
                _ => {
                    return Err(ParseError::new(
                        place(node),
                        "an axis with a length",
                        "none",
                    ));
                }
            },
            function,
            inputs,
        };
        match is_turn {
            true => turns.push(joint_axis),
            false => slides.push(joint_axis),
        }
    }
    Ok((turns, slides))
}

/// Numbers of the coordinates that `tag` names.
fn inputs(
    node: Node<'_, '_>,
    tag: &str,
    numbers_of: &HashMap<String, usize>,
) -> Result<Vec<usize>, ParseError> {
    let text = child(node, tag).and_then(|n| n.text()).unwrap_or_default();
    let number = |name: &str| {
        // OpenSim 4 may write the path of a coordinate: `/jointset/knee_r/knee_angle_r`.
        let name = name.rsplit('/').next().unwrap_or(name);
        numbers_of.get(name).copied().ok_or_else(|| {
            ParseError::new(
                place(node),
                "a coordinate of the model",
                format!("`{}`", shortened(name)),
            )
        })
    };
    text.split_ascii_whitespace().map(number).collect()
}

fn couplings(
    model: Node<'_, '_>,
    numbers_of: &HashMap<String, usize>,
) -> Result<Vec<Coupling>, ParseError> {
    let mut found = Vec::new();
    let set = child(model, "ConstraintSet").and_then(|set| child(set, "objects"));
    let nodes = set.into_iter().flat_map(|list| {
        list.children()
            .filter(|n| is(*n, "CoordinateCouplerConstraint"))
    });
    for node in nodes {
        let dependent = inputs(node, "dependent_coordinate_name", numbers_of)?;
        let function = match child(node, "coupled_coordinates_function") {
            Some(holder) => Function::in_element(holder)?,
            None => None,
        };
        if let (Some(&dependent), Some(function)) = (dependent.first(), function) {
            found.push(Coupling {
                dependent,
                inputs: inputs(node, "independent_coordinate_names", numbers_of)?,
                function,
                scale: numbers(node, "scale_factor", None)?
                    .first()
                    .copied()
                    .unwrap_or(1.0),
            });
        }
    }
    Ok(found)
}
