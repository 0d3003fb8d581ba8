//! Groups of what is alike, and what of them becomes classes.

use morec_db::labels::{NewSample, SampleId, SampleState as Judged};

use super::State;
use super::files::quoted;
use crate::jobs::{group, propose};
use crate::store::Edit;

impl State {
    pub(super) fn propose(&mut self) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        self.command_line = format!("morec db propose {}", quoted(&db));
        self.jobs
            .start("Looking for more", true, &self.wake, move |progress| {
                propose::propose(&db, progress)
            });
    }

    pub(super) fn group(&mut self, cuts: bool) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        let of = if cuts { "cuts" } else { "labels" };
        self.command_line = format!("morec group {} --of {of} --method hierarchy", quoted(&db));
        self.jobs
            .start("Grouping", true, &self.wake, move |progress| {
                group::group(&db, cuts, progress)
            });
    }

    /// A group's samples become a class; cuts in it become labels of the class.
    pub(super) fn name_group(&mut self, group: usize, name: &str) {
        let Some(groups) = &self.classes.groups else {
            return;
        };
        let members = groups.at(self.classes.depth);
        let Some(group) = members.get(group).filter(|_| !name.trim().is_empty()) else {
            return;
        };
        let items = || group.members.iter().map(|&m| &groups.items[m]);
        let ids: Vec<SampleId> = items().filter_map(|i| i.sample).collect();
        let new: Vec<NewSample> = items()
            .filter(|i| i.sample.is_none())
            .map(|i| NewSample {
                clip: i.clip,
                class: name.trim().to_owned(),
                start_secs: i.start_secs,
                stop_secs: i.stop_secs,
                whole_clip: false,
                state: Judged::Accepted,
                score: None,
            })
            .collect();
        if !ids.is_empty() {
            let class = name.trim().to_owned();
            self.edit(Edit::Reclass { ids, class });
        }
        if !new.is_empty() {
            self.edit(Edit::Label(new));
        }
    }
}
