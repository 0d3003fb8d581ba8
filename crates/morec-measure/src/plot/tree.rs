//! Trees, drawn from the root on the left to the leaves on the right.

use super::{Text, open};

const COLUMN: f64 = 190.0;
const WIDTH: f64 = 160.0;
const ROW: f64 = 46.0;
const LINE: f64 = 14.0;
const LEFT: f64 = 16.0;
const TOP: f64 = 40.0;

/// A node as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct TreeBox {
    /// Lines of text in it.
    pub lines: Vec<String>,
    /// True if it lies on a path that is marked.
    pub marked: bool,
    /// Its children, as places in the list of nodes: each behind the node itself, and nobody else's child.
    pub children: Vec<usize>,
}

/// A tree as SVG; the first node is the root. Children that come before their parent, or that there are not, are left
/// out.
pub fn tree_svg(title: &str, nodes: &[TreeBox]) -> String {
    let depths = depths(nodes);
    let rows = rows(nodes);
    let place = |i: usize| (LEFT + depths[i] * COLUMN, TOP + rows[i] * ROW);
    let most = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let width = LEFT * 2.0 + most(&depths) * COLUMN + WIDTH;
    let mut out = String::new();
    open(&mut out, width, TOP + (most(&rows) + 1.0) * ROW, title);
    for (i, node) in nodes.iter().enumerate() {
        let (x, y) = place(i);
        for child in children(nodes, i) {
            let (cx, cy) = place(child);
            let stroke = match node.marked && nodes[child].marked {
                true => "var(--c1)",
                false => "var(--soft)",
            };
            let (from, to, middle) = (y + ROW * 0.4, cy + ROW * 0.4, (x + WIDTH + cx) * 0.5);
            let start = x + WIDTH;
            out.push_str(&format!(
                "<path class=\"curve\" stroke=\"{stroke}\" d=\"M{start:.1} {from:.1}C{middle:.1} {from:.1} \
                 {middle:.1} {to:.1} {cx:.1} {to:.1}\"/>\n"
            ));
        }
        draw(&mut out, x, y, &node.lines);
    }
    out.push_str("</svg>\n");
    out
}

fn draw(out: &mut String, x: f64, y: f64, lines: &[String]) {
    let height = ROW * 0.8;
    out.push_str(&format!(
        "<g class=\"box\"><rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{WIDTH}\" height=\"{height:.1}\" rx=\"4\" \
         class=\"frame\"/>"
    ));
    let first = y + 0.5 * (height - LINE * lines.len() as f64) + LINE * 0.75;
    for (i, line) in lines.iter().enumerate() {
        let (x, y) = (x + 8.0, first + LINE * i as f64);
        out.push_str(&format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\">{}</text>",
            Text(line)
        ));
    }
    out.push_str("</g>\n");
}

fn children(nodes: &[TreeBox], i: usize) -> impl Iterator<Item = usize> {
    nodes[i]
        .children
        .iter()
        .copied()
        .filter(move |&child| child > i && child < nodes.len())
}

fn depths(nodes: &[TreeBox]) -> Vec<f64> {
    let mut depths = vec![0.0; nodes.len()];
    for i in 0..nodes.len() {
        for child in children(nodes, i) {
            depths[child] = depths[i] + 1.0;
        }
    }
    depths
}

/// Leaves one below the other in the order of the branches, parents half-way between their first and last child.
fn rows(nodes: &[TreeBox]) -> Vec<f64> {
    let mut rows = vec![0.0; nodes.len()];
    let (mut next, mut open) = (0.0, if nodes.is_empty() { vec![] } else { vec![0] });
    while let Some(i) = open.pop() {
        if children(nodes, i).next().is_none() {
            rows[i] = next;
            next += 1.0;
        }
        let from = open.len();
        open.extend(children(nodes, i));
        open[from..].reverse();
    }
    for i in (0..nodes.len()).rev() {
        let below = || children(nodes, i).map(|child| rows[child]);
        if let (Some(first), Some(last)) = (below().next(), below().last()) {
            rows[i] = 0.5 * (first + last);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_stand_between_their_children_and_leaves_below_one_another() {
        let node = |children: &[usize]| TreeBox {
            lines: vec![],
            marked: false,
            children: children.to_vec(),
        };
        let nodes = [
            node(&[1, 2]),
            node(&[3, 4]),
            node(&[]),
            node(&[]),
            node(&[]),
        ];
        assert_eq!(rows(&nodes), [1.25, 0.5, 2.0, 0.0, 1.0]);
        assert_eq!(depths(&nodes), [0.0, 1.0, 1.0, 2.0, 2.0]);
    }

    #[test]
    fn children_that_make_no_tree_are_left_out() {
        let nodes = [TreeBox {
            lines: vec!["a < b".into()],
            marked: false,
            children: vec![0, 7],
        }];
        let drawn = tree_svg("One", &nodes);
        assert!(drawn.contains("a &lt; b") && !drawn.contains("<path"));
        assert!(tree_svg("None", &[]).contains("None"));
    }
}
