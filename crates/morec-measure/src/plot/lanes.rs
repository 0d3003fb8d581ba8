//! Lanes of named spans of time, with labels above detections.

use super::axis::PlotAxis;
use super::{Text, colour, open};
use morec::TimeSpan;

const WIDTH: f64 = 1100.0;
const LEFT: f64 = 90.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BAR: f64 = 22.0;
const LANE: f64 = BAR + 6.0;

/// A bar of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// From where to where.
    pub span: TimeSpan,
    /// Kind of the bar, an index into the names of [`LaneChart::new`]; decides the colour.
    pub kind: usize,
}

/// Lanes of bars over one axis of time.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneChart {
    title: String,
    kinds: Vec<String>,
    secs: f64,
    lanes: Vec<(String, Vec<Bar>)>,
}

impl LaneChart {
    /// No lanes yet; `kinds` name what bars may be, `secs` is how long the axis is.
    pub fn new(title: impl Into<String>, kinds: Vec<String>, secs: f64) -> Self {
        Self {
            title: title.into(),
            kinds,
            secs: if secs > 0.0 { secs } else { 1.0 },
            lanes: vec![],
        }
    }

    /// Adds a lane below those there are.
    #[must_use]
    pub fn lane(mut self, name: &str, bars: impl IntoIterator<Item = Bar>) -> Self {
        self.lanes
            .push((name.to_owned(), bars.into_iter().collect()));
        self
    }

    /// The picture. Kinds that no bar has are not in the legend.
    pub fn svg(&self) -> String {
        let axis = PlotAxis {
            from: 0.0,
            to: self.secs,
            low: LEFT,
            high: WIDTH - RIGHT,
        };
        let bottom = TOP + self.lanes.len() as f64 * LANE;
        let mut out = String::new();
        let legend = self.legend(bottom + 36.0);
        let height = legend.iter().map(|l| l.1).fold(bottom + 24.0, f64::max) + 12.0;
        open(&mut out, WIDTH, height, &self.title);
        for (value, label) in axis.ticks(12) {
            let x = axis.at(value);
            out.push_str(&format!(
                "<line class=\"grid\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{bottom:.1}\"/>\
                 <text class=\"mid\" x=\"{x:.1}\" y=\"{:.1}\">{label} s</text>\n",
                bottom + 15.0
            ));
        }
        for (i, (name, bars)) in self.lanes.iter().enumerate() {
            let y = TOP + i as f64 * LANE + 3.0;
            let text = y + BAR * 0.7;
            out.push_str(&format!(
                "<text class=\"end\" x=\"{:.1}\" y=\"{text:.1}\">{}</text>\n",
                LEFT - 8.0,
                Text(name)
            ));
            bars.iter()
                .for_each(|bar| self.push_bar(&mut out, bar, &axis, y));
        }
        for (x, y, kind) in legend {
            out.push_str(&format!(
                "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"12\" height=\"8\" fill=\"{}\"/>\
                 <text x=\"{:.1}\" y=\"{y:.1}\">{}</text>\n",
                y - 8.0,
                colour(kind),
                x + 17.0,
                Text(&self.kinds[kind])
            ));
        }
        out.push_str("</svg>\n");
        out
    }

    fn push_bar(&self, out: &mut String, bar: &Bar, axis: &PlotAxis, y: f64) {
        if !(bar.span.start_secs.is_finite() && bar.span.stop_secs.is_finite()) {
            return;
        }
        let shown = bar.span.map(|secs| secs.clamp(0.0, self.secs));
        let (from, to) = (shown.start_secs, shown.stop_secs);
        let (x, wide) = (axis.at(from), (axis.at(to) - axis.at(from)).max(1.0));
        let name = self.kinds.get(bar.kind).map_or("", String::as_str);
        out.push_str(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{BAR}\" rx=\"2\" fill=\"{}\">\
             <title>{}, {from:.2} to {to:.2} s</title></rect>\n",
            colour(bar.kind),
            Text(name)
        ));
    }

    /// Position of each kind that occurs in the legend.
    fn legend(&self, first_y: f64) -> Vec<(f64, f64, usize)> {
        let (mut at, mut places) = ((LEFT, first_y), vec![]);
        for (kind, name) in self.kinds.iter().enumerate() {
            if !self
                .lanes
                .iter()
                .any(|(_, bars)| bars.iter().any(|bar| bar.kind == kind))
            {
                continue;
            }
            let wide = 34.0 + 6.2 * name.chars().count() as f64;
            if at.0 + wide > WIDTH - RIGHT && at.0 > LEFT {
                at = (LEFT, at.1 + 18.0);
            }
            places.push((at.0, at.1, kind));
            at.0 += wide;
        }
        places
    }
}
