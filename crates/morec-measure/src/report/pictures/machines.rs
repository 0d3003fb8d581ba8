//! Pictures of a tree and of its branches.

use crate::plot::{Chart, Regions, TreeBox, tree_svg};
use morec::svrdm::{Branch, Node, PathStep, Tree};

use morec::train::svrdm::FeatureSample;

/// Cells along each axis.
const CELLS: usize = 120;
/// Characters in a line of a box of the tree.
const BOX_CHARS: usize = 26;

/// A branch in its plane (thesis, Figs. 5.3–5.12) as SVG: where each machine says at least `high` (`T`) and at least
/// `low` (`t`), and the samples that come here, class by class. `node` is the branch's place among the nodes; `None`
/// if there is no branch. O(cells · points).
pub fn branch_picture(
    tree: &Tree,
    node: usize,
    samples: &[FeatureSample],
    names: &[String],
    [low, high]: [f64; 2],
) -> Option<String> {
    let Some(Node::Branch(branch)) = tree.nodes().get(node) else {
        return None;
    };
    let planar: Vec<Vec<(f64, f64)>> = classes(branch)
        .map(|class| planar(tree, branch, samples, class))
        .collect();
    let range = |pick: fn(&(f64, f64)) -> f64| widened(planar.iter().flatten().map(pick));
    let (x, y) = (range(|p| p.0), range(|p| p.1));
    let title = format!(
        "{} | {}, σ_f {:.4}, σ_r {:.4}",
        listed(&branch.classes[0], names),
        listed(&branch.classes[1], names),
        branch.sigma_full,
        branch.sigma_reduced
    );
    let regions = Regions {
        x,
        y,
        columns: CELLS,
        kinds: kinds(branch, x, y, [low, high]),
        names: vec![
            format!("left ≥ {high}"),
            format!("right ≥ {high}"),
            format!("both ≥ {high}"),
            format!("left ≥ {low}"),
            format!("right ≥ {low}"),
        ],
    };
    let chart = Chart::new(title)
        .axes("near the left centroid", "near the right, apart from that")
        .size(720, 560);
    let chart = chart.regions(regions);
    let series = classes(branch).zip(planar);
    Some(
        series
            .fold(chart, |chart, (class, points)| {
                chart.points(&name(class, names), points)
            })
            .svg(),
    )
}

fn classes(branch: &Branch) -> impl Iterator<Item = morec::classes::ClassId> {
    branch.classes.iter().flatten().copied()
}

/// A class's samples in the plane of a branch.
fn planar(
    tree: &Tree,
    branch: &Branch,
    samples: &[FeatureSample],
    class: morec::classes::ClassId,
) -> Vec<(f64, f64)> {
    let shown = samples
        .iter()
        .filter(|s| s.class == class && s.vector.len() == tree.dim());
    shown
        .map(|s| tree.reduce(branch, &s.vector).into())
        .collect()
}

/// Machines that accept in each cell, as an index into the names of the regions.
fn kinds(branch: &Branch, x: (f64, f64), y: (f64, f64), [low, high]: [f64; 2]) -> Vec<Option<u8>> {
    let at =
        |(from, to): (f64, f64), i: usize| from + (to - from) * (i as f64 + 0.5) / CELLS as f64;
    let kind = |[left, right]: [f64; 2]| match () {
        () if left >= high && right >= high => Some(2),
        () if left >= high => Some(0),
        () if right >= high => Some(1),
        () if left >= low && left >= right => Some(3),
        () if right >= low => Some(4),
        () => None,
    };
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column)));
    cells
        .map(|(row, column)| kind(branch.outputs_at([at(x, column), at(y, row)])))
        .collect()
}

/// The range of values and a fifth more at each end.
fn widened(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (from, to) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    if from > to {
        return (0.0, 1.0);
    }
    let more = 0.2 * (to - from).max(0.05);
    (from - more, to + more)
}

fn name(class: morec::classes::ClassId, names: &[String]) -> String {
    names
        .get(class.index())
        .cloned()
        .unwrap_or_else(|| format!("class {}", class.0))
}

/// Some names of a side; how many more there are.
fn listed(classes: &[morec::classes::ClassId], names: &[String]) -> String {
    let shown: Vec<String> = classes.iter().take(3).map(|c| name(*c, names)).collect();
    let more = classes.len().saturating_sub(3);
    if more > 0 {
        format!("{} and {more} more", shown.join(", "))
    } else {
        shown.join(", ")
    }
}

/// The classes of a side in the width of a box.
fn short(classes: &[morec::classes::ClassId], names: &[String]) -> String {
    let all: Vec<String> = classes.iter().map(|c| name(*c, names)).collect();
    let mut shown = all.len();
    loop {
        let text = all[..shown].join(", ");
        let text = match all.len() - shown {
            0 => text,
            more => format!("{text} + {more}"),
        };
        if text.chars().count() <= BOX_CHARS || shown <= 1 {
            return text;
        }
        shown -= 1;
    }
}

/// A sample's way down a tree in words, a line for each branch (thesis, Fig. 5.2).
pub fn path_text(tree: &Tree, names: &[String], path: &[PathStep]) -> Vec<String> {
    let all = |classes: &[morec::classes::ClassId]| {
        let names: Vec<String> = classes.iter().map(|c| name(*c, names)).collect();
        names.join(", ")
    };
    let line = |step: &PathStep| match &tree.nodes()[step.node] {
        Node::Leaf(class) => name(*class, names),
        Node::Branch(branch) => {
            let [a, b] = [0, 1]
                .map(|side| format!("{} ({:.2})", all(&branch.classes[side]), step.outputs[side]));
            match step.taken {
                Some(0) => format!("{a}, not {b}"),
                Some(_) => format!("{b}, not {a}"),
                None => format!("neither {a} nor {b}"),
            }
        }
    };
    path.iter().map(line).collect()
}

/// The tree (thesis, Fig. 5.2) as SVG: at each branch its classes and widths, at each leaf its class; the nodes of `path`, a sample's
/// way, are marked.
pub fn tree_picture(tree: &Tree, names: &[String], path: &[PathStep]) -> String {
    let marked = |at: usize| path.iter().any(|step| step.node == at);
    let drawn = tree
        .nodes()
        .iter()
        .enumerate()
        .map(|(at, node)| match node {
            Node::Leaf(class) => TreeBox {
                lines: vec![name(*class, names)],
                marked: marked(at),
                children: vec![],
            },
            Node::Branch(branch) => TreeBox {
                lines: vec![
                    short(&branch.classes[0], names),
                    format!("| {}", short(&branch.classes[1], names)),
                    format!(
                        "σ_f {:.3}, σ_r {:.4}",
                        branch.sigma_full, branch.sigma_reduced
                    ),
                ],
                marked: marked(at),
                children: branch.children.iter().map(|c| *c as usize).collect(),
            },
        });
    tree_svg("Classifier tree", &drawn.collect::<Vec<_>>())
}
