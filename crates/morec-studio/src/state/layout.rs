//! The layout that is remembered from one session to the next, with the database that was open.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{Panel, State};

/// A session's layout. Sizes of panels and of the window are remembered by the window system's side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Layout {
    pub panel: String,
    pub dark: bool,
    pub strips: bool,
    pub snap: bool,
    pub all_classes: bool,
    pub onion: bool,
    pub follow: bool,
    pub mirror: bool,
    /// The database that was open, unless it lay in a temporary folder.
    pub database: Option<PathBuf>,
    /// The clip that was shown.
    pub clip: Option<String>,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            panel: Panel::Library.name().to_owned(),
            dark: true,
            strips: false,
            snap: true,
            all_classes: false,
            onion: false,
            follow: true,
            mirror: false,
            database: None,
            clip: None,
        }
    }
}

impl State {
    /// The present layout.
    pub fn layout(&self) -> Layout {
        let store = self.store.as_ref().filter(|s| !s.temporary);
        Layout {
            panel: self.panel.name().to_owned(),
            dark: self.dark,
            strips: self.library.strips,
            snap: self.timeline.snap,
            all_classes: self.timeline.all_classes,
            onion: self.onion,
            follow: self.camera.follow,
            mirror: self.classes.mirror,
            database: store.map(|s| s.path().to_owned()),
            clip: self.shown_clip().map(|c| c.name.clone()),
        }
    }

    /// Lays things out as they were, and offers the database that was open.
    pub fn lay_out(&mut self, layout: &Layout) {
        self.last.clone_from(&layout.database);
        self.panel = Panel::named(&layout.panel).unwrap_or(Panel::Library);
        self.dark = layout.dark;
        self.library.strips = layout.strips;
        self.timeline.snap = layout.snap;
        self.timeline.all_classes = layout.all_classes;
        self.onion = layout.onion;
        self.camera.follow = layout.follow;
        self.classes.mirror = layout.mirror;
    }

    /// Shows the clip that was shown, if the database that was open is open again.
    pub fn show_again(&mut self, layout: &Layout) {
        let Some(store) = &self.store else { return };
        let clips = store.snapshot.clips.iter();
        let same = clips.filter(|c| Some(&c.name) == layout.clip.as_ref());
        if let Some(id) = same.map(|c| c.id).next() {
            self.open_clip(id, None);
        }
    }
}
