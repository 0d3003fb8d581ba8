//! Heat maps: a grid of values, drawn darker for larger values.

use super::axis::PlotAxis;
use super::{Text, colour, open};

const TOP: f64 = 34.0;
const RIGHT: f64 = 18.0;
const WIDTH: f64 = 960.0;
/// Height of a row of the legend.
const LEGEND: f64 = 18.0;
/// Cells are not higher than this.
const HIGHEST: f64 = 26.0;

/// A grid of values, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    title: String,
    columns: usize,
    /// Values with what they are of: an index into `kinds`.
    cells: Vec<(f64, usize)>,
    kinds: Vec<String>,
    x_label: String,
    y_label: String,
    row_names: Vec<String>,
    column_names: Vec<String>,
    x_range: Option<(f64, f64)>,
    show_values: bool,
}

impl HeatMap {
    /// A map of `values`, rows of `columns` values from the top. A value is drawn by its share of the largest; what
    /// is not positive is left blank.
    pub fn new(
        title: impl Into<String>,
        columns: usize,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        Self {
            title: title.into(),
            columns: columns.max(1),
            cells: values.into_iter().map(|v| (v, 0)).collect(),
            kinds: vec![],
            x_label: String::new(),
            y_label: String::new(),
            row_names: vec![],
            column_names: vec![],
            x_range: None,
            show_values: false,
        }
    }

    /// Names the axes.
    #[must_use]
    pub fn axes(mut self, x: &str, y: &str) -> Self {
        (self.x_label, self.y_label) = (x.to_owned(), y.to_owned());
        self
    }

    /// Labels of rows and columns, in order.
    #[must_use]
    pub fn names(mut self, rows: Vec<String>, columns: Vec<String>) -> Self {
        (self.row_names, self.column_names) = (rows, columns);
        self
    }

    /// Gives each cell a kind, shown by its hue: an index into `names`.
    #[must_use]
    pub fn kinds(mut self, kinds: impl IntoIterator<Item = usize>, names: Vec<String>) -> Self {
        for (cell, kind) in self.cells.iter_mut().zip(kinds) {
            cell.1 = kind;
        }
        self.kinds = names;
        self
    }

    /// Range of the columns: from the left edge of the first to the right edge of the last.
    #[must_use]
    pub fn x_range(mut self, from: f64, to: f64) -> Self {
        self.x_range = Some((from, to));
        self
    }

    /// Writes the values into the cells.
    #[must_use]
    pub fn with_values(mut self) -> Self {
        self.show_values = true;
        self
    }

    /// The picture. O(cells); blank cells cost nothing.
    pub fn svg(&self) -> String {
        let rows = self.cells.len().div_ceil(self.columns).max(1);
        let widest =
            |names: &[String]| names.iter().map(|n| n.chars().count()).max().unwrap_or(0) as f64;
        let left = (16.0 + 6.2 * widest(&self.row_names)).max(40.0);
        let wide = (WIDTH - left - RIGHT) / self.columns as f64;
        let wide = if self.column_names.is_empty() {
            wide
        } else {
            wide.min(64.0)
        };
        let high = HIGHEST.min((480.0 / rows as f64).max(4.0));
        let bottom = TOP + rows as f64 * high;
        let names = if self.column_names.is_empty() {
            0.0
        } else {
            10.0 + 4.6 * widest(&self.column_names)
        };
        let legend = self.legend_rows(left) * LEGEND;
        let mut out = String::new();
        open(&mut out, WIDTH, bottom + 44.0 + names + legend, &self.title);
        self.push_cells(&mut out, left, wide, high);
        let right = left + self.columns as f64 * wide;
        out.push_str(&format!(
            "<rect class=\"frame\" x=\"{left:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\"/>\n",
            right - left,
            bottom - TOP
        ));
        self.push_names(&mut out, left, wide, high, bottom);
        self.push_labels(&mut out, (left, right), bottom, names);
        self.push_kinds(&mut out, left, bottom + 44.0 + names);
        out.push_str("</svg>\n");
        out
    }

    fn push_cells(&self, out: &mut String, left: f64, wide: f64, high: f64) {
        let most = self
            .cells
            .iter()
            .map(|c| c.0)
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max);
        for (i, (value, kind)) in self.cells.iter().enumerate() {
            let share = value / most;
            if share.is_nan() || share <= 0.002 {
                continue;
            }
            let (x, y) = (
                left + (i % self.columns) as f64 * wide,
                TOP + (i / self.columns) as f64 * high,
            );
            out.push_str(&format!(
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{high:.1}\" fill=\"{}\" opacity=\"{:.2}\"/>",
                colour(*kind),
                0.06 + 0.8 * share.min(1.0)
            ));
            if self.show_values {
                let decimals = if value.fract() == 0.0 { 0 } else { 2 };
                out.push_str(&format!(
                    "<text class=\"mid\" x=\"{:.1}\" y=\"{:.1}\" style=\"fill:var(--ink)\">{value:.decimals$}</text>",
                    x + wide / 2.0,
                    y + high / 2.0 + 4.0
                ));
            }
            out.push('\n');
        }
    }

    fn push_names(&self, out: &mut String, left: f64, wide: f64, high: f64, bottom: f64) {
        for (i, name) in self.row_names.iter().enumerate() {
            let y = TOP + (i as f64 + 0.5) * high + 4.0;
            out.push_str(&format!(
                "<text class=\"end\" x=\"{:.1}\" y=\"{y:.1}\">{}</text>\n",
                left - 6.0,
                Text(name)
            ));
        }
        for (i, name) in self.column_names.iter().enumerate() {
            let (x, y) = (left + (i as f64 + 0.5) * wide, bottom + 12.0);
            out.push_str(&format!(
                "<text class=\"end\" transform=\"translate({x:.1} {y:.1}) rotate(-45)\">{}</text>\n",
                Text(name)
            ));
        }
    }

    fn push_labels(&self, out: &mut String, (left, right): (f64, f64), bottom: f64, names: f64) {
        if let Some((from, to)) = self.x_range.filter(|(from, to)| to > from) {
            let axis = PlotAxis {
                from,
                to,
                low: left,
                high: right,
            };
            for (value, label) in axis.ticks(10) {
                let (x, y) = (axis.at(value), bottom + 15.0);
                out.push_str(&format!(
                    "<text class=\"mid\" x=\"{x:.1}\" y=\"{y:.1}\">{label}</text>\n"
                ));
            }
        }
        out.push_str(&format!(
            "<text class=\"mid\" x=\"{:.1}\" y=\"{:.1}\">{}</text>\
             <text class=\"mid\" transform=\"translate(12 {:.1}) rotate(-90)\">{}</text>\n",
            (left + right) / 2.0,
            bottom + 33.0 + names,
            Text(&self.x_label),
            (TOP + bottom) / 2.0,
            Text(&self.y_label)
        ));
    }

    fn push_kinds(&self, out: &mut String, left: f64, first_y: f64) {
        let (mut x, mut y) = (left, first_y);
        for (kind, name) in self.kinds.iter().enumerate() {
            let wide = 34.0 + 6.2 * name.chars().count() as f64;
            if x + wide > WIDTH - RIGHT && x > left {
                (x, y) = (left, y + LEGEND);
            }
            out.push_str(&format!(
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"12\" height=\"8\" fill=\"{}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
                colour(kind),
                x + 17.0,
                y + 8.0,
                Text(name)
            ));
            x += wide;
        }
    }

    /// Rows that the legend takes, at most.
    fn legend_rows(&self, left: f64) -> f64 {
        let wide: f64 = self
            .kinds
            .iter()
            .map(|name| 34.0 + 6.2 * name.chars().count() as f64)
            .sum();
        // A row may end with room for most of a name.
        (1.25 * wide / (WIDTH - left - RIGHT)).ceil()
    }
}
