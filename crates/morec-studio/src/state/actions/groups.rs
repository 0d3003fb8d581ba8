//! Groups of what is alike, and what of them becomes classes.

use morec::cluster::KwasParams;
use morec_db::labels::{NewSample, SampleId};
use morec_ops::{GroupMethod, GroupSettings, ProposeSettings};

use super::lines::ShownCommand;
use crate::jobs::{JobOutcome, group, propose};
use crate::state::State;
use crate::store::Edit;

impl State {
    pub(in crate::state) fn propose(&mut self) {
        let Some(store) = &self.store else { return };
        let db = store.place();
        let line = ShownCommand::new("morec db propose").word(&db.path);
        self.show_line(line.settings(&ProposeSettings::default()));
        self.jobs.start(
            "Searching for more samples",
            true,
            &self.wake,
            JobOutcome::Proposed,
            move |progress| propose::propose(&db, progress),
        );
    }

    pub(in crate::state) fn group(&mut self, cuts: bool, method: GroupMethod) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        let line = ShownCommand::new("morec group").word(&db);
        let settings = group::settings(cuts, method);
        self.show_line(line.settings(&settings));
        self.jobs.start(
            "Grouping",
            true,
            &self.wake,
            JobOutcome::Grouped,
            move |progress| group::group(&db, &settings, progress),
        );
    }

    pub(in crate::state) fn group_by(&mut self, kwas: KwasParams) {
        self.classes.group_by(kwas);
        if let (Some(store), Some(groups)) = (&self.store, &self.classes.groups) {
            let settings = GroupSettings {
                tau: kwas.tau,
                k: kwas.k,
                ..groups.settings.clone()
            };
            let line = ShownCommand::new("morec group").word(store.path());
            self.show_line(line.settings(&settings));
        }
    }

    /// A group's samples become a class; cuts in it become labels of the class.
    pub(in crate::state) fn name_group(&mut self, group: usize, name: &str) {
        let Some(groups) = &self.classes.groups else {
            return;
        };
        let members = groups.at(&self.classes.depth);
        let Some(group) = members.get(group).filter(|_| !name.trim().is_empty()) else {
            return;
        };
        let items = || group.members.iter().map(|&m| &groups.items[m]);
        let ids: Vec<SampleId> = items().filter_map(|i| i.sample).collect();
        let new: Vec<NewSample> = items()
            .filter(|i| i.sample.is_none())
            .map(|i| NewSample::accepted(i.of.clip, name.trim(), i.of.span))
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
