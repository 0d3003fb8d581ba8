//! Lines, points, marks and regions over two axes.

use super::axis::PlotAxis;
use super::{Text, colour, open};

const LEFT: f64 = 64.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
/// Height of a row of the legend.
const LEGEND: f64 = 18.0;

/// A chart, built up series by series and written with [`Chart::svg`].
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    title: String,
    x_label: String,
    y_label: String,
    size: (f64, f64),
    series: Vec<Series>,
    regions: Option<Regions>,
}

#[derive(Debug, Clone, PartialEq)]
struct Series {
    name: String,
    colour: String,
    shape: Shape,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Line(Vec<(f64, f64)>),
    Points(Vec<(f64, f64)>),
    /// Vertical lines.
    Marks(Vec<f64>),
    /// Shaded ranges along x.
    Spans(Vec<(f64, f64)>),
}

/// The plane cut into cells, each of one kind or of none: which decision falls where.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    /// Range along x that the cells cover.
    pub x: (f64, f64),
    /// Range along y.
    pub y: (f64, f64),
    /// Cells along x; `kinds` holds rows of that many, from the least y up.
    pub columns: usize,
    /// The kind of each cell, an index into `names`.
    pub kinds: Vec<Option<u8>>,
    /// Names of the kinds.
    pub names: Vec<String>,
}

impl Chart {
    /// An empty chart of this title.
    pub fn new(title: impl Into<String>) -> Self {
        let (x_label, y_label) = (String::new(), String::new());
        Self {
            title: title.into(),
            x_label,
            y_label,
            size: (960.0, 360.0),
            series: vec![],
            regions: None,
        }
    }

    /// Names the axes; units belong to the names.
    #[must_use]
    pub fn axes(mut self, x: &str, y: &str) -> Self {
        (self.x_label, self.y_label) = (x.to_owned(), y.to_owned());
        self
    }

    /// Sets width and height of the picture in pixels; 960 by 360 otherwise.
    #[must_use]
    pub fn size(mut self, width: usize, height: usize) -> Self {
        self.size = (width.max(160) as f64, height.max(120) as f64);
        self
    }

    /// Adds a line through `points`, interrupted where a value is not finite.
    #[must_use]
    pub fn line(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.add(name, Shape::Line(points.into_iter().collect()))
    }

    /// Adds dots.
    #[must_use]
    pub fn points(self, name: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.add(name, Shape::Points(points.into_iter().collect()))
    }

    /// Adds dashed vertical lines at `xs`.
    #[must_use]
    pub fn marks(self, name: &str, xs: impl IntoIterator<Item = f64>) -> Self {
        self.add(name, Shape::Marks(xs.into_iter().collect()))
    }

    /// Adds shaded ranges along x, one for each pair of start and stop.
    #[must_use]
    pub fn spans(self, name: &str, spans: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.add(name, Shape::Spans(spans.into_iter().collect()))
    }

    /// Lays regions under everything else.
    #[must_use]
    pub fn regions(mut self, regions: Regions) -> Self {
        self.regions = Some(regions);
        self
    }

    fn add(mut self, name: &str, shape: Shape) -> Self {
        let colour = colour(self.series.len());
        self.series.push(Series {
            name: name.to_owned(),
            colour,
            shape,
        });
        self
    }

    /// The picture. O(points); lines of very many points are drawn as what would be seen of them.
    pub fn svg(&self) -> String {
        let (width, plot_height) = self.size;
        let legend = self.legend();
        let height = plot_height + legend.len() as f64 * LEGEND;
        let (x, y) = self.scales();
        let mut out = String::new();
        open(&mut out, width, height, &self.title);
        if let Some(regions) = &self.regions {
            regions.push(&mut out, &x, &y);
        }
        self.push_axes(&mut out, &x, &y);
        for series in &self.series {
            series.push(&mut out, &x, &y);
        }
        push_legend(&mut out, &legend, plot_height);
        out.push_str("</svg>\n");
        out
    }

    fn scales(&self) -> (PlotAxis, PlotAxis) {
        let (width, height) = self.size;
        let regions = self.regions.iter();
        let xs = self.series.iter().flat_map(|s| s.shape.xs());
        let xs = xs.chain(regions.clone().flat_map(|r| [r.x.0, r.x.1]));
        let ys = self.series.iter().flat_map(|s| s.shape.ys());
        let ys = ys.chain(regions.flat_map(|r| [r.y.0, r.y.1]));
        let room = if self.regions.is_some() { 0.0 } else { 0.04 };
        let x = PlotAxis::over(xs, LEFT, width - RIGHT);
        (x, PlotAxis::over(ys, height - BOTTOM, TOP).widened(room))
    }

    fn push_axes(&self, out: &mut String, x: &PlotAxis, y: &PlotAxis) {
        let (left, right, top, bottom) = (x.low, x.high, y.high, y.low);
        for (value, label) in x.ticks(10) {
            let at = x.at(value);
            out.push_str(&format!(
                "<line class=\"grid\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{top:.1}\" y2=\"{bottom:.1}\"/>\
                 <text class=\"mid\" x=\"{at:.1}\" y=\"{:.1}\">{label}</text>\n",
                bottom + 15.0
            ));
        }
        for (value, label) in y.ticks(6) {
            let at = y.at(value);
            out.push_str(&format!(
                "<line class=\"grid\" x1=\"{left:.1}\" x2=\"{right:.1}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                 <text class=\"end\" x=\"{:.1}\" y=\"{:.1}\">{label}</text>\n",
                left - 6.0,
                at + 4.0
            ));
        }
        let (mid_x, mid_y) = ((left + right) / 2.0, (top + bottom) / 2.0);
        out.push_str(&format!(
            "<rect class=\"frame\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>\
             <text class=\"mid\" x=\"{mid_x:.1}\" y=\"{:.1}\">{}</text>\
             <text class=\"mid\" transform=\"translate(14 {mid_y:.1}) rotate(-90)\">{}</text>\n",
            right - left,
            bottom - top,
            bottom + 33.0,
            Text(&self.x_label),
            Text(&self.y_label)
        ));
    }

    /// Names with colours, in rows that fit the width. Names are about 6.2 pixels a character wide.
    fn legend(&self) -> Vec<Vec<(f64, &str, String)>> {
        let regions = self.regions.iter().flat_map(|r| r.names.iter().enumerate());
        let kinds = regions.map(|(i, name)| (name.as_str(), Regions::colour(i)));
        let entries = kinds.chain(
            self.series
                .iter()
                .map(|s| (s.name.as_str(), s.colour.clone())),
        );
        let (mut rows, mut at) = (vec![], f64::INFINITY);
        for (name, colour) in entries.filter(|(name, _)| !name.is_empty()) {
            let wide = 34.0 + 6.2 * name.chars().count() as f64;
            if at + wide > self.size.0 - RIGHT {
                rows.push(vec![]);
                at = LEFT;
            }
            if let Some(row) = rows.last_mut() {
                row.push((at, name, colour));
            }
            at += wide;
        }
        rows
    }
}

fn push_legend(out: &mut String, rows: &[Vec<(f64, &str, String)>], below: f64) {
    for (i, row) in rows.iter().enumerate() {
        let y = below + i as f64 * LEGEND;
        for (x, name, colour) in row {
            out.push_str(&format!(
                "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"12\" height=\"8\" fill=\"{colour}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
                y + 1.0,
                x + 17.0,
                y + 9.0,
                Text(name)
            ));
        }
    }
}

impl Shape {
    fn xs(&self) -> Vec<f64> {
        match self {
            Shape::Line(points) | Shape::Points(points) => points.iter().map(|p| p.0).collect(),
            Shape::Marks(xs) => xs.clone(),
            Shape::Spans(spans) => spans.iter().flat_map(|s| [s.0, s.1]).collect(),
        }
    }

    fn ys(&self) -> Vec<f64> {
        match self {
            Shape::Line(points) | Shape::Points(points) => points.iter().map(|p| p.1).collect(),
            Shape::Marks(_) | Shape::Spans(_) => vec![],
        }
    }
}

impl Series {
    fn push(&self, out: &mut String, x: &PlotAxis, y: &PlotAxis) {
        let (top, bottom, colour) = (y.high, y.low, &self.colour);
        match &self.shape {
            Shape::Line(points) => push_line(out, points, x, y, colour),
            Shape::Points(points) => {
                for (px, py) in points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) {
                    let (cx, cy) = (x.at(*px), y.at(*py));
                    out.push_str(&format!(
                        "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"3\" fill=\"{colour}\"/>\n"
                    ));
                }
            }
            Shape::Marks(xs) => {
                for at in xs.iter().filter(|v| v.is_finite()).map(|v| x.at(*v)) {
                    out.push_str(&format!(
                        "<line class=\"mark\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{top:.1}\" y2=\"{bottom:.1}\" stroke=\"{colour}\"/>\n"
                    ));
                }
            }
            Shape::Spans(spans) => {
                for (from, to) in spans.iter().filter(|s| s.0.is_finite() && s.1.is_finite()) {
                    let (left, wide) = (x.at(*from), (x.at(*to) - x.at(*from)).max(0.5));
                    out.push_str(&format!(
                        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{wide:.1}\" height=\"{:.1}\" fill=\"{colour}\" opacity=\".25\"/>\n",
                        bottom - top
                    ));
                }
            }
        }
    }
}

fn push_line(out: &mut String, points: &[(f64, f64)], x: &PlotAxis, y: &PlotAxis, colour: &str) {
    for part in points
        .split(|p| !p.0.is_finite() || !p.1.is_finite())
        .filter(|part| !part.is_empty())
    {
        let on_paper: Vec<(f64, f64)> = part.iter().map(|p| (x.at(p.0), y.at(p.1))).collect();
        let drawn = what_is_seen(&on_paper);
        let places: Vec<String> = drawn
            .iter()
            .map(|(x, y)| format!("{x:.1},{y:.1}"))
            .collect();
        out.push_str(&format!(
            "<polyline class=\"curve\" stroke=\"{colour}\" points=\"{}\"/>\n",
            places.join(" ")
        ));
    }
}

/// First, lowest, highest and last point of every pixel along x: all of a line that can be seen.
fn what_is_seen(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut seen = vec![];
    for pixel in points.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        if pixel.len() <= 4 {
            seen.extend_from_slice(pixel);
            continue;
        }
        let by_y = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = [
            pixel.first(),
            pixel.iter().min_by(by_y),
            pixel.iter().max_by(by_y),
            pixel.last(),
        ];
        seen.extend(ends.into_iter().flatten());
    }
    seen
}

impl Regions {
    fn colour(kind: usize) -> String {
        let hue = (30.0 + kind as f64 * 137.508) % 360.0;
        format!("hsl({hue:.0} 50% 70% / .55)")
    }

    fn push(&self, out: &mut String, x: &PlotAxis, y: &PlotAxis) {
        if self.columns == 0 {
            return;
        }
        let rows = self.kinds.len() / self.columns;
        let wide = (x.at(self.x.1) - x.at(self.x.0)) / self.columns as f64;
        let high = (y.at(self.y.0) - y.at(self.y.1)) / rows.max(1) as f64;
        for (row, kinds) in self.kinds.chunks_exact(self.columns).enumerate() {
            let top = y.at(self.y.0) - (row + 1) as f64 * high;
            let mut column = 0;
            // Neighbours of one kind are one rectangle.
            for run in kinds.chunk_by(|a, b| a == b) {
                if let Some(kind) = run[0] {
                    out.push_str(&format!(
                        "<rect x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{high:.1}\" fill=\"{}\"/>\n",
                        x.at(self.x.0) + column as f64 * wide,
                        run.len() as f64 * wide,
                        Self::colour(usize::from(kind))
                    ));
                }
                column += run.len();
            }
        }
    }
}
