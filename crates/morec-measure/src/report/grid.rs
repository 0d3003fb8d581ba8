//! The overview of many short clips with one sample each: one square for each clip, one block for each class.

use std::collections::BTreeMap;

use super::html::Text;
use super::palette::Palette;
use crate::eval::{GroundTruthVerdict, Timeline};

/// A clip up to this long, with at most one sample, is short.
const SHORT_SECS: f64 = 15.0;
/// This many short clips are drawn as squares; fewer get timelines like any other.
const MANY: usize = 16;
const SIDE: usize = 18;
const STEP: usize = SIDE + 4;
const PER_ROW: usize = 50;

/// Short clips, if they are many, and the rest.
pub(super) fn split(timelines: &[Timeline]) -> (Vec<&Timeline>, Vec<&Timeline>) {
    let (short, long): (Vec<_>, Vec<_>) = timelines
        .iter()
        .partition(|t| t.stream.duration_secs <= SHORT_SECS && t.truths.len() <= 1);
    if short.len() < MANY {
        (Vec::new(), timelines.iter().collect())
    } else {
        (short, long)
    }
}

pub(super) fn push(out: &mut String, short: &[&Timeline], palette: &Palette) {
    if short.is_empty() {
        return;
    }
    // Classes by name, then what is labelled with nothing, then unknown motion.
    let mut blocks: BTreeMap<(u8, &str), Vec<&Timeline>> = BTreeMap::new();
    for timeline in short {
        let block = match timeline.truths.first() {
            Some((truth, _)) => (0, truth.class.as_str()),
            None if timeline.stream.unknown => (2, "unknown motion"),
            None => (1, "nothing labelled"),
        };
        blocks.entry(block).or_default().push(timeline);
    }
    out.push_str(
        "<p class=\"small\">Each square is a short clip, coloured by the class that was detected in it. Blank: no detection. \
         <b>✗</b>: wrong class. <b>!</b>: detection in a clip without labels.</p>\n",
    );
    for ((_, name), clips) in &blocks {
        push_block(out, name, clips, palette);
    }
}

fn push_block(out: &mut String, name: &str, clips: &[&Timeline], palette: &Palette) {
    let squares: Vec<Square> = clips.iter().map(|t| Square::new(t)).collect();
    let right = squares.iter().filter(|s| s.right).count();
    let (width, height) = (PER_ROW * STEP, clips.len().div_ceil(PER_ROW) * STEP);
    out.push_str(&format!(
        "<figure class=\"block\"><figcaption><b>{}</b> {right} of {} right</figcaption>\n\
         <svg viewBox=\"0 0 {width} {height}\" role=\"img\"><title>{0}: {right} of {1} clips right</title>\n",
        Text(name),
        clips.len()
    ));
    for (i, square) in squares.iter().enumerate() {
        let (x, y) = (i % PER_ROW * STEP + 2, i / PER_ROW * STEP + 2);
        square.push(out, x, y, palette);
    }
    out.push_str("</svg></figure>\n");
}

struct Square<'a> {
    found: Option<&'a str>,
    right: bool,
    mark: &'static str,
    title: String,
}

impl<'a> Square<'a> {
    fn new(timeline: &'a Timeline) -> Self {
        let first_found = timeline.founds.first().map(|(f, _)| f.class.as_str());
        let (found, right, mark) = match timeline.truths.first() {
            Some((truth, GroundTruthVerdict::Right)) => (Some(truth.class.as_str()), true, ""),
            Some((_, GroundTruthVerdict::Mistaken(other))) => (Some(other.as_str()), false, "✗"),
            Some((_, GroundTruthVerdict::Missed)) => (None, false, ""),
            None => (
                first_found,
                first_found.is_none(),
                if first_found.is_some() { "!" } else { "" },
            ),
        };
        let founds: Vec<String> = (timeline.founds.iter())
            .map(|(f, _)| format!("{} {:.2}", f.class, f.span))
            .collect();
        let founds = if founds.is_empty() {
            "nothing found".to_owned()
        } else {
            founds.join(", ")
        };
        Self {
            found,
            right,
            mark,
            title: format!("{}: {founds}", timeline.stream.clip),
        }
    }

    fn push(&self, out: &mut String, x: usize, y: usize, palette: &Palette) {
        let class = match (self.right, self.found) {
            (true, _) => "square",
            (false, Some(_)) => "square wrong",
            (false, None) => "square missed",
        };
        let fill = self.found.map_or("none", |class| palette.colour(class));
        out.push_str(&format!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"{fill}\" pointer-events=\"all\">\
             <title>{}</title></rect>",
            Text(&self.title)
        ));
        if !self.mark.is_empty() {
            let (x, y) = (x + SIDE / 2, y + 14);
            out.push_str(&format!(
                "<text class=\"on\" x=\"{x}\" y=\"{y}\">{}</text>",
                self.mark
            ));
        }
        out.push('\n');
    }
}
