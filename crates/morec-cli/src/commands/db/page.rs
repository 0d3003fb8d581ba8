//! A page of HTML with strips of poses: one file, nothing loaded from elsewhere.

use std::path::Path;

use anyhow::{Context, Result};
use morec_db::{ClipId, MotionDb, StoredClip};

use super::strip::strip;
use crate::output;

/// Poses in a strip.
const POSES: usize = 8;

const STYLE: &str = "body{font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;\
color:#222;background:#fff}h2{margin-top:1.6em}figure{display:inline-block;margin:.3em 1em .6em 0}\
figcaption{font-size:13px}svg{background:#f4f4f4;border-radius:4px}path{fill:none;stroke-width:1.3;stroke-linecap:round}\
@media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}svg{background:#262626}}";

/// Whether a page can be written there: asked before the work.
pub fn check(path: &Path) -> Result<()> {
    output::check(path).with_context(|| path.display().to_string())
}

/// A page in the making.
#[derive(Default)]
pub struct Page {
    html: String,
    strips: usize,
    /// The clip decoded last: stretches mostly come clip by clip.
    last: Option<(ClipId, StoredClip)>,
}

impl Page {
    /// Strips of poses so far.
    pub fn strips(&self) -> usize {
        self.strips
    }

    pub fn heading(&mut self, text: &str) {
        self.html.push_str(&format!("<h2>{}</h2>\n", escaped(text)));
    }

    pub fn paragraph(&mut self, text: &str) {
        self.html.push_str(&format!("<p>{}</p>\n", escaped(text)));
    }

    pub fn new_line(&mut self) {
        self.html.push_str("<br>\n");
    }

    /// A stretch of a clip of the database.
    pub fn figure(
        &mut self,
        db: &MotionDb,
        clip: ClipId,
        start_secs: f64,
        stop_secs: f64,
        caption: &str,
    ) -> Result<()> {
        let stored = match self.last.take() {
            Some((id, stored)) if id == clip => stored,
            _ => db.clip(clip)?,
        };
        self.figure_of(&stored, start_secs, stop_secs, caption);
        self.last = Some((clip, stored));
        Ok(())
    }

    /// A stretch of any clip.
    pub fn figure_of(
        &mut self,
        stored: &StoredClip,
        start_secs: f64,
        stop_secs: f64,
        caption: &str,
    ) {
        let svg = strip(stored, start_secs, stop_secs, POSES);
        self.html.push_str(&format!(
            "<figure>{svg}<figcaption>{}</figcaption></figure>\n",
            escaped(caption)
        ));
        self.strips += 1;
    }

    /// Writes the page under `title`, with `head` as its first line; the file is whole or not there.
    pub fn write(&self, path: &Path, title: &str, head: &str) -> Result<()> {
        let (title, head) = (escaped(title), escaped(head));
        let html = format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n<p>{head}</p>\n{}</body></html>\n",
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
