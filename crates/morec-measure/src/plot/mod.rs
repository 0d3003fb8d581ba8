//! Charts as SVG text: lines, points, spans and heat maps with axes, for files and for the report.
//!
//! A picture stands alone (its style is inside), follows the reader's light or dark theme, and says in its
//! title what it shows. Values that are not finite are left out.
//!
//! ```
//! use morec_measure::plot::Chart;
//!
//! let chart = Chart::new("distance").axes("seconds", "metres").line("hand", (0..9).map(|t| (f64::from(t), 0.1)));
//! assert!(chart.svg().starts_with("<svg"));
//! ```

mod axis;
mod chart;
mod heat_map;
mod lanes;
mod text;
mod tree;

#[cfg(test)]
mod tests;

pub use chart::{Chart, Regions};
pub use heat_map::HeatMap;
pub use lanes::{Bar, LaneChart};
pub(crate) use text::Text;
pub use tree::{TreeBox, tree_svg};

/// Colour of the `i`th thing in a picture; neighbours differ well, however many there are.
pub fn colour(i: usize) -> String {
    // Hues a golden angle apart.
    let hue = (210.0 + i as f64 * 137.508) % 360.0;
    let lightness = [52, 44, 60][i % 3];
    format!("hsl({hue:.0} 62% {lightness}%)")
}

/// Opening of every picture: size, style, title.
fn open(out: &mut String, width: f64, height: f64, title: &str) {
    out.push_str(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" role=\"img\"><title>{title}</title>\n<style>{STYLE}</style>\n\
         <rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n\
         <text class=\"head\" x=\"12\" y=\"20\">{title}</text>\n",
        title = Text(title)
    ));
}

const STYLE: &str = ".plot{--ink:#20262c;--soft:#68737d;--line:#d5dbe0;--paper:#fff}\
@media(prefers-color-scheme:dark){.plot{--ink:#e3e7ea;--soft:#98a3ad;--line:#3a434b;--paper:#14181c}}\
.plot text{font:11px system-ui,sans-serif;fill:var(--soft)}.plot .head{font-size:13px;font-weight:600;fill:var(--ink)}\
.plot .paper{fill:var(--paper)}.plot .grid{stroke:var(--line);stroke-width:1}.plot .frame{fill:none;stroke:var(--soft)}\
.plot .curve{fill:none;stroke-width:1.4;stroke-linejoin:round}.plot .mark{stroke-width:1.2;stroke-dasharray:4 3}\
.plot .mid{text-anchor:middle}.plot .end{text-anchor:end}";
