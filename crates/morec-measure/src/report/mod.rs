//! The report: one self-contained HTML file with figures, timelines, the confusion matrix and notes on what to add next. Written
//! by
//! `evaluate` and `crossval`; contains no script except the player of clips.
//!
//! Timelines follow the thesis's Figures 5.13 and 5.14: ground truth above, detections below, colour by class.
//! The file has no outside links, and no script but that of the [player](crate::player), if clips were given to play; its
//! pictures are inline SVG, whose titles say in words what they show. It follows the reader's light or dark theme and prints in the light one.

mod curves;
mod figures;
mod grid;
mod html;
mod misses;
mod notes;
mod palette;
mod performances;
pub mod pictures;
mod tables;
mod timeline;

#[cfg(test)]
mod tests;

use crate::eval::{Evaluation, Timeline};
use crate::explain::{Miss, Performance};
use crate::perturb::Perturbation;
use crate::player::Reel;
use html::{Text, with_contents};
use palette::Palette;

pub use notes::{TrainedClass, learning_notes};

/// Everything a report shows.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// Origin of the report, as pairs of name and value: command, data, method, date.
    pub about: &'a [(String, String)],
    /// Measures of all streams together and of each class.
    pub evaluation: &'a Evaluation,
    /// Verdicts on samples and detections, stream by stream.
    pub timelines: &'a [Timeline],
    /// Training data of the classes; empty if unknown.
    pub training: &'a [TrainedClass],
    /// Samples that were missed, and why; empty if that was not computed.
    pub misses: &'a [Miss],
    /// How well correctly recognised motions were performed; empty if that was not computed.
    pub performances: &'a [Performance],
    /// The measures at other rates of false alarms a minute, ascending; may be empty.
    pub sensitivities: &'a [(f64, Evaluation)],
    /// The measures of copies that are worse in one way; may be empty.
    pub perturbed: &'a [(Perturbation, Evaluation)],
    /// Clips to play, with their labels and detections, if there are any.
    pub motion: Option<&'a Reel>,
}

/// Notes that are shown at once; the others unfold.
const NOTES_SHOWN: usize = 12;

pub(crate) const STYLE: &str = include_str!("style.css");

impl Report<'_> {
    /// The report as one HTML document. O(samples + detections), apart from the tables.
    pub fn html(&self) -> String {
        let palette = Palette::new(self.evaluation);
        let title = Text(self.title);
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
        );
        self.push_about(&mut out);
        let mut body = String::new();
        figures::push(&mut body, self.evaluation);
        self.push_notes(&mut body);
        misses::push(&mut body, self.misses);
        performances::push(&mut body, self.performances);
        curves::push_sensitivity(&mut body, self.sensitivities);
        curves::push_reliability(&mut body, &self.evaluation.reliability);
        curves::push_perturbed(&mut body, self.evaluation, self.perturbed);
        timeline::push(&mut body, self.timelines, &palette);
        tables::push_confusion(&mut body, &self.evaluation.confusion);
        tables::push_classes(&mut body, self.evaluation, self.training, self.timelines);
        out.push_str(&with_contents(&body, self.motion.is_some()));
        if let Some(reel) = self.motion {
            out.push_str("<h2 id=\"motion\">Motion</h2>\n");
            out.push_str(&reel.section());
        }
        out.push_str("</body>\n</html>\n");
        out
    }

    fn push_about(&self, out: &mut String) {
        if self.about.is_empty() {
            return;
        }
        out.push_str("<dl class=\"about\">\n");
        for (name, value) in self.about {
            out.push_str(&format!(
                "<div><dt>{}</dt><dd>{}</dd></div>\n",
                Text(name),
                Text(value)
            ));
        }
        out.push_str("</dl>\n");
    }

    fn push_notes(&self, out: &mut String) {
        out.push_str("<h2>What to add next</h2>\n");
        let notes = learning_notes(self.evaluation, self.training);
        let (first, rest) = notes.split_at(notes.len().min(NOTES_SHOWN));
        push_list(out, first);
        if !rest.is_empty() {
            out.push_str(&format!(
                "<details><summary>{} more</summary>\n",
                rest.len()
            ));
            push_list(out, rest);
            out.push_str("</details>\n");
        }
    }
}

fn push_list(out: &mut String, notes: &[String]) {
    out.push_str("<ul class=\"notes\">\n");
    notes
        .iter()
        .for_each(|note| out.push_str(&format!("<li>{}</li>\n", Text(note))));
    out.push_str("</ul>\n");
}
