//! The table of clips: searched, sorted, selected.

use morec_db::ClipId;

use crate::state::{LibraryCommand, Panel, State};
use crate::store::Edit;

impl State {
    pub(in crate::state) fn apply_library(&mut self, command: LibraryCommand) {
        match command {
            LibraryCommand::Filter(text) => self.library.filter = text,
            LibraryCommand::Sort(column) => {
                let down = self.library.sort == Some((column, false));
                self.library.sort = Some((column, down));
            }
            LibraryCommand::Select { clip, add } => {
                let selected = &mut self.library.selected;
                match (add, selected.iter().position(|c| *c == clip)) {
                    (true, Some(at)) => {
                        selected.remove(at);
                    }
                    (true, None) => selected.push(clip),
                    (false, _) => self.open_found(clip),
                }
                self.library.chosen = !self.library.selected.is_empty();
            }
            LibraryCommand::SelectTo(clip) => self.select_to(clip),
            LibraryCommand::Step(by) => self.step(by),
            LibraryCommand::Open(clip) => self.open_clip(clip, None),
            LibraryCommand::GoTo(of) => {
                self.open_clip(of.clip, Some((of.span.start_secs, of.span.stop_secs)));
            }
            LibraryCommand::SelectAll => self.select_all(),
            LibraryCommand::Background => self.background(),
            LibraryCommand::Pattern(text) => self.library.pattern = Some(text),
            LibraryCommand::SelectStretch(of) => {
                self.selecting = Some(of);
                self.open_clip(of.clip, Some((of.span.start_secs, of.span.stop_secs)));
            }
            LibraryCommand::DismissReport => self.import_report = None,
            LibraryCommand::Strips(on) => self.library.strips = on,
            LibraryCommand::Role(role) => self.library.role = role,
            LibraryCommand::GiveRole { role, joint } => self.give_role(role, joint),
            LibraryCommand::RolesOfAll(all) => self.library.roles_of_one = !all,
        }
        self.refresh_library();
    }

    fn select_all(&mut self) {
        let Some(store) = &self.store else { return };
        let clips = &store.snapshot.clips;
        let shown = self.library.shown().iter().filter_map(|&at| clips.get(at));
        self.library.selected = shown.map(|c| c.id).collect();
        self.library.chosen = true;
        self.say(format!(
            "{} selected",
            crate::format::count(self.library.selected.len(), "clip")
        ));
    }

    fn step(&mut self, by: i64) {
        let Some(store) = &self.store else { return };
        let clips = &store.snapshot.clips;
        let shown = self.library.shown().iter().filter_map(|&at| clips.get(at));
        let shown: Vec<ClipId> = shown.map(|clip| clip.id).collect();
        let from = match self.panel {
            // The clip that was asked for may still be read.
            Panel::Library => self.library.selected.last().copied(),
            _ => self.player.motion.as_ref().map(|motion| motion.id),
        };
        let from = from.and_then(|from| shown.iter().position(|id| *id == from));
        let last = shown.len().saturating_sub(1);
        let to = match from {
            Some(from) => from.saturating_add_signed(by as isize).min(last),
            None => 0,
        };
        if let Some(&clip) = shown.get(to) {
            self.open_found(clip);
            self.library.chosen = self.panel == Panel::Library;
        }
    }

    /// Uses the clips that somebody has selected as background, or no longer if all of them are.
    fn background(&mut self) {
        let Some(store) = &self.store else { return };
        let selected = self.library.chosen().iter();
        let clips: Vec<_> = selected.filter_map(|id| store.snapshot.clip(*id)).collect();
        if clips.is_empty() {
            return self.say("select clips in the list, then press B");
        }
        let on = !clips.iter().all(|clip| clip.is_background());
        let clips = clips.iter().map(|clip| clip.id).collect();
        self.edit(Edit::Background { clips, on });
    }

    fn select_to(&mut self, clip: ClipId) {
        let Some(store) = &self.store else { return };
        let clips = &store.snapshot.clips;
        let shown = self.library.shown().iter().filter_map(|&at| clips.get(at));
        let shown: Vec<ClipId> = shown.map(|c| c.id).collect();
        let place = |id: ClipId| shown.iter().position(|s| *s == id);
        let from = self.library.selected.first().and_then(|id| place(*id));
        let (Some(from), Some(to)) = (from, place(clip)) else {
            self.open_clip(clip, None);
            self.library.chosen = true;
            return;
        };
        self.library.chosen = true;
        // The first stays the first, from which another click with Shift begins.
        self.library.selected = match from <= to {
            true => shown[from..=to].to_vec(),
            false => shown[to..=from].iter().rev().copied().collect(),
        };
    }

    pub(in crate::state) fn refresh_library(&mut self) {
        if let Some(store) = &self.store {
            self.library.refresh(&store.snapshot.clips, store.version);
        }
        self.search_words();
    }
}
