//! Proposals: accepted and rejected, the doubtful first.

use morec_db::labels::{DbSample, SampleId, SampleState as Judged};
use morec_db::{Proposal, most_informative};

use crate::state::{Panel, State};
use crate::store::Edit;

impl State {
    pub(in crate::state) fn judge(&mut self, id: SampleId, state: Judged) {
        self.edit(Edit::Judge {
            ids: vec![id],
            state,
        });
        self.next_doubtful(Some(id));
    }

    /// The proposals whose answers tell most, first.
    pub fn doubtful(&self) -> Vec<&DbSample> {
        let Some(store) = &self.store else {
            return Vec::new();
        };
        let proposed: Vec<&DbSample> = store
            .snapshot
            .samples
            .iter()
            .filter(|s| s.state == Judged::Proposed)
            .collect();
        let as_proposals: Vec<Proposal> = proposed
            .iter()
            .map(|s| Proposal {
                clip: s.clip,
                class: s.class.clone(),
                start_secs: s.start_secs,
                stop_secs: s.stop_secs,
                whole_clip: s.whole_clip,
                score: s.score.unwrap_or(0.0) as f32,
            })
            .collect();
        let order = most_informative(&as_proposals, as_proposals.len());
        order.into_iter().map(|at| proposed[at]).collect()
    }

    /// Shows the next proposal, other than one that was just judged.
    pub(in crate::state) fn next_doubtful(&mut self, not: Option<SampleId>) {
        let next = self.doubtful().into_iter().find(|s| Some(s.id) != not);
        let Some((id, clip, start, stop)) = next.map(|s| (s.id, s.clip, s.start_secs, s.stop_secs))
        else {
            self.say("no proposal is left to look at");
            return;
        };
        self.open_clip(clip, Some((start, stop)));
        self.timeline.selected = [id].into();
        if self.panel != Panel::Label && self.panel != Panel::Classes {
            self.panel = Panel::Label;
        }
    }
}
