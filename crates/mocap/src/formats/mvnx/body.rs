//! The segments of an MVNX subject and their hierarchy.

use roxmltree::Node;

use super::super::cells::finite;
use super::super::xml::{child, is, place};
use super::super::{Limits, ParseError, Warning};
use crate::math::Vec3;

/// A segment; its joint is its origin.
pub(super) struct MvnxSegment {
    pub(super) label: String,
    /// Number among the segments of the result, which have parents first.
    pub(super) parent: Option<usize>,
    /// Number among the segments of the file: where its numbers stand in a row.
    pub(super) column: usize,
    /// From the parent's origin, metres, if the file says.
    pub(super) offset: Vec3,
    /// End of a segment without children.
    pub(super) tip: Option<Vec3>,
}

/// The parents in Xsens' model of 23 segments, for files that list no joints.
const PARENTS: [(&str, &str); 22] = [
    ("L5", "Pelvis"),
    ("L3", "L5"),
    ("T12", "L3"),
    ("T8", "T12"),
    ("Neck", "T8"),
    ("Head", "Neck"),
    ("RightShoulder", "T8"),
    ("RightUpperArm", "RightShoulder"),
    ("RightForeArm", "RightUpperArm"),
    ("RightHand", "RightForeArm"),
    ("LeftShoulder", "T8"),
    ("LeftUpperArm", "LeftShoulder"),
    ("LeftForeArm", "LeftUpperArm"),
    ("LeftHand", "LeftForeArm"),
    ("RightUpperLeg", "Pelvis"),
    ("RightLowerLeg", "RightUpperLeg"),
    ("RightFoot", "RightLowerLeg"),
    ("RightToe", "RightFoot"),
    ("LeftUpperLeg", "Pelvis"),
    ("LeftLowerLeg", "LeftUpperLeg"),
    ("LeftFoot", "LeftLowerLeg"),
    ("LeftToe", "LeftFoot"),
];

/// Points where bodies end, by segment.
const TIPS: [(&str, &str); 5] = [
    ("Head", "pTopOfHead"),
    ("RightHand", "pRightTopOfHand"),
    ("LeftHand", "pLeftTopOfHand"),
    ("RightToe", "pRightToe"),
    ("LeftToe", "pLeftToe"),
];

/// The numbers in a text; `None` if there is something else. Decimal commas are read as points where no comma separates.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_ascii_whitespace()
        .map(|word| finite(word).or_else(|| finite(&word.replace(',', "."))))
        .collect()
}

/// The segments of a subject, parents first.
pub(super) fn segments(
    subject: Node<'_, '_>,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<MvnxSegment>, ParseError> {
    let list = child(subject, "segments")
        .ok_or_else(|| ParseError::new(place(subject), "<segments>", "none"))?;
    let nodes: Vec<Node> = list.children().filter(|n| is(*n, "segment")).collect();
    if nodes.is_empty() {
        return Err(ParseError::new(place(list), "a <segment>", "none"));
    }
    if nodes.len() > limits.joints {
        let expected = format!("at most {} segments", limits.joints);
        return Err(ParseError::new(
            place(list),
            expected,
            nodes.len().to_string(),
        ));
    }
    let labels: Vec<&str> = nodes
        .iter()
        .map(|n| n.attribute("label").unwrap_or_default())
        .collect();
    let parents = parents(subject, &labels, warnings);
    let order = parents_first(&parents);
    let mut number = vec![0; labels.len()];
    for (at, &column) in order.iter().enumerate() {
        number[column] = at;
    }
    let joints = child(subject, "joints");
    let segment = |&column: &usize| {
        let parent = parents[column];
        let tip = TIPS.iter().find(|(label, _)| *label == labels[column]);
        MvnxSegment {
            label: labels[column].to_owned(),
            parent: parent.map(|p| number[p]),
            column,
            offset: parent
                .and_then(|p| joint_point(joints?, labels[p], labels[column], nodes[p]))
                .unwrap_or_else(Vec3::zeros),
            tip: tip.and_then(|(_, point)| point_of(nodes[column], point)),
        }
    };
    Ok(order.iter().map(segment).collect())
}

/// Parents by the file's joints, else by the model that every suit has.
fn parents(
    subject: Node<'_, '_>,
    labels: &[&str],
    warnings: &mut Vec<Warning>,
) -> Vec<Option<usize>> {
    let find = |label: &str| labels.iter().position(|l| l.eq_ignore_ascii_case(label));
    let mut parents = vec![None; labels.len()];
    for joint in child(subject, "joints")
        .iter()
        .flat_map(|joints| joints.children())
        .filter(|n| is(*n, "joint"))
    {
        if let (Some(above), Some(below)) = (connected(joint, 1), connected(joint, 2))
            && let (Some(above), Some(below)) = (find(above), find(below))
            && above != below
        {
            parents[below] = parents[below].or(Some(above));
        }
    }
    let mut unknown = Vec::new();
    for (column, label) in labels.iter().enumerate() {
        if parents[column].is_none() {
            let known = PARENTS.iter().find(|(l, _)| l.eq_ignore_ascii_case(label));
            parents[column] = known.and_then(|(_, parent)| find(parent));
            if parents[column].is_none() && !label.eq_ignore_ascii_case("pelvis") {
                unknown.push(*label);
            }
        }
    }
    if !unknown.is_empty() {
        let text = format!("segments without a parent: {}", unknown.join(", "));
        warnings.push(Warning::new(place(subject), text));
    }
    cut_circles(&mut parents);
    parents
}

/// `Pelvis` of `<connector1>Pelvis/jL5S1</connector1>`.
fn connected<'a>(joint: Node<'a, '_>, end: usize) -> Option<&'a str> {
    let text = child(joint, &format!("connector{end}"))?.text()?;
    Some(text.split('/').next().unwrap_or(text).trim())
}

/// Position of the joint between two segments in the upper one.
fn joint_point(
    joints: Node<'_, '_>,
    above: &str,
    below: &str,
    segment: Node<'_, '_>,
) -> Option<Vec3> {
    let joint = joints
        .children()
        .filter(|n| is(*n, "joint"))
        .find(|joint| connected(*joint, 1) == Some(above) && connected(*joint, 2) == Some(below))?;
    let text = child(joint, "connector1")?.text()?;
    point_of(segment, text.split_once('/')?.1.trim())
}

/// A point of a segment in its own frame: `pos_s` in version 3, `pos_b` in version 4.
fn point_of(segment: Node<'_, '_>, label: &str) -> Option<Vec3> {
    let point = child(segment, "points")?
        .children()
        .find(|n| is(*n, "point") && n.attribute("label") == Some(label))?;
    let place = child(point, "pos_b").or(child(point, "pos_s"))?;
    match numbers(place.text()?)?[..] {
        [x, y, z] => Some(Vec3::new(x, y, z)),
        _ => None,
    }
}

fn cut_circles(parents: &mut [Option<usize>]) {
    for start in 0..parents.len() {
        let (mut at, mut steps) = (start, 0);
        while let Some(parent) = parents[at] {
            at = parent;
            steps += 1;
            if steps > parents.len() {
                parents[at] = None;
            }
        }
    }
}

fn parents_first(parents: &[Option<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(parents.len());
    let mut placed = vec![false; parents.len()];
    while order.len() < parents.len() {
        for column in 0..parents.len() {
            if !placed[column] && parents[column].is_none_or(|p| placed[p]) {
                placed[column] = true;
                order.push(column);
            }
        }
    }
    order
}
