//! A page of HTML with strips of poses that move when they are chosen: one file, nothing loaded from elsewhere.

use std::iter::repeat;
use std::path::Path;

use anyhow::{Context, Result};
use morec::TimeSpan;
use morec_db::{ClipId, MotionDb, StoredClip};
use morec_measure::player::{PlayedClip, Reel};

use super::strip::strip;
use crate::output;
use crate::table::TextTable;

/// Poses in a strip.
const POSES: usize = 8;
/// Frames of a stretch that moves: a minute at 30 a second; of longer ones not every frame is kept.
const FRAMES: usize = 1800;
/// A page of this many bytes of motion takes no more: a browser must still open it.
const MOST_BYTES: usize = 48 << 20;

const STYLE: &str = "body{font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;\
color:#222;background:#fff}h2{margin-top:1.6em}figure{display:inline-block;margin:.3em 1em .6em 0}\
figcaption{font-size:13px}td,th{padding:.1em .8em .1em 0;text-align:right}td:first-child,th:first-child{text-align:left}svg{background:#f4f4f4;border-radius:4px}path{fill:none;stroke-width:1.3;stroke-linecap:round}\
nav.contents{display:flex;flex-wrap:wrap;gap:.2em 1em}nav.contents a{color:inherit}\
@media(prefers-color-scheme:dark){:root{color-scheme:dark}body{color:#ddd;background:#181818}svg{background:#262626}}";

/// Checks that a page can be written there, before the work.
pub fn check(path: &Path) -> Result<()> {
    output::check_page(path)
}

/// A page in the making.
#[derive(Default)]
pub struct Page {
    html: String,
    headings: Vec<String>,
    strips: usize,
    reel: Reel,
    /// Strips that do not move, as the page would be too large.
    still: usize,
    /// The clip decoded last: stretches mostly come clip by clip.
    last: Option<(ClipId, StoredClip)>,
}

impl Page {
    /// Strips of poses so far.
    pub fn strips(&self) -> usize {
        self.strips
    }

    /// A section, which the table of contents names.
    pub fn heading(&mut self, text: &str) {
        self.headings.push(text.to_owned());
        let number = self.headings.len();
        self.html
            .push_str(&format!("<h2 id=\"s{number}\">{}</h2>\n", escaped(text)));
    }

    /// A list that unfolds.
    pub fn folded(&mut self, summary: &str, items: &[String]) {
        let items: String = items
            .iter()
            .map(|item| format!("<li>{}</li>\n", escaped(item)))
            .collect();
        self.html.push_str(&format!(
            "<details><summary>{}</summary>\n<ul>\n{items}</ul>\n</details>\n",
            escaped(summary)
        ));
    }

    /// A table as the terminal shows it.
    pub fn table(&mut self, table: &TextTable) {
        self.html.push_str("<table>\n");
        for (tag, row) in ["th"].into_iter().chain(repeat("td")).zip(table.rows()) {
            let cells = row
                .iter()
                .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)));
            self.html
                .push_str(&format!("<tr>{}</tr>\n", cells.collect::<String>()));
        }
        self.html.push_str("</table>\n");
    }

    /// A drawing: an element `<svg>`.
    pub fn drawing(&mut self, svg: &str) {
        self.html.push_str(svg);
    }

    pub fn new_line(&mut self) {
        self.html.push_str("<br>\n");
    }

    /// A stretch of a clip of the database.
    pub fn figure(
        &mut self,
        db: &MotionDb,
        clip: ClipId,
        span: TimeSpan,
        caption: &str,
    ) -> Result<()> {
        let stored = match self.last.take() {
            Some((id, stored)) if id == clip => stored,
            _ => db.clip(clip)?,
        };
        self.figure_of(&stored, span, caption);
        self.last = Some((clip, stored));
        Ok(())
    }

    /// A stretch of any clip.
    pub fn figure_of(&mut self, stored: &StoredClip, span: TimeSpan, caption: &str) {
        let svg = strip(stored, span, POSES);
        let moves = match self.reel.bytes() < MOST_BYTES {
            true => {
                let played = PlayedClip {
                    clip: &stored.clip,
                    roles: &stored.roles,
                    beside: None,
                    span: Some(span),
                    labels: Vec::new(),
                    detections: Vec::new(),
                    video: None,
                };
                let number = self.reel.add(&played, FRAMES);
                format!(" data-motion=\"{number}\"")
            }
            false => {
                self.still += 1;
                String::new()
            }
        };
        self.html.push_str(&format!(
            "<figure{moves}>{svg}<figcaption>{}</figcaption></figure>\n",
            escaped(caption)
        ));
        self.strips += 1;
    }

    /// Writes the page under `title`, with `head` as its first line; the file is whole or not there.
    pub fn write(&self, path: &Path, title: &str, head: &str) -> Result<()> {
        let (title, head) = (escaped(title), escaped(head));
        let contents: String = (1..)
            .zip(&self.headings)
            .map(|(number, text)| format!("<a href=\"#s{number}\">{}</a>\n", escaped(text)))
            .collect();
        let hint = match (self.strips, self.still) {
            (0, _) => String::new(),
            (_, 0) => "<p>Click a strip to play it.</p>\n".to_owned(),
            (_, still) => format!(
                "<p>Click a strip to play it. The last {still} do not play, to keep the page small enough to open.</p>\n"
            ),
        };
        let panel = match self.reel.is_empty() {
            true => String::new(),
            false => self.reel.panel(),
        };
        let html = format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n<p>{head}</p>\n\
             <nav class=\"contents\" aria-label=\"Contents\">\n{contents}</nav>\n{hint}{}{panel}</body></html>\n",
            self.html
        );
        output::write_whole(path, |out| out.write_all(html.as_bytes()))
            .with_context(|| path.display().to_string())
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
