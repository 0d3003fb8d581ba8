//! The table of clips: searched, sorted, selected.

use crate::state::{LibraryCommand, State};

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
                    (false, _) => self.open_clip(clip, None),
                }
            }
            LibraryCommand::Open(clip) => self.open_clip(clip, None),
            LibraryCommand::GoTo {
                clip,
                start_secs,
                stop_secs,
            } => self.open_clip(clip, Some((start_secs, stop_secs))),
            LibraryCommand::DismissReport => self.import_report = None,
            LibraryCommand::Strips(on) => self.library.strips = on,
            LibraryCommand::Role(role) => self.library.role = role,
            LibraryCommand::GiveRole { role, joint } => self.give_role(role, joint),
            LibraryCommand::RolesOfAll(all) => self.library.roles_of_one = !all,
        }
        self.refresh_library();
    }

    pub(in crate::state) fn refresh_library(&mut self) {
        if let Some(store) = &self.store {
            self.library.refresh(&store.snapshot.clips, store.version);
        }
    }
}
