//! Proposals: accepted and rejected, the doubtful first.

use morec::TimeSpan;
use morec_db::labels::{DbSample, SampleId, SampleState as Judged};
use morec_db::{Proposal, most_informative};

use crate::state::classes::LIKELY;
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

    /// Proposals without an answer.
    fn proposed(&self) -> impl Iterator<Item = &DbSample> {
        let samples = self
            .store
            .iter()
            .flat_map(|s| &s.snapshot.samples)
            .map(|s| &**s);
        samples.filter(|s| s.state == Judged::Proposed)
    }

    /// The proposals that are accepted at once, or else those that are rejected.
    pub fn judged_at_once(&self, accept: bool) -> Vec<SampleId> {
        let least = f64::from(self.classes.likely.unwrap_or(LIKELY)) / 100.0;
        let meant = self
            .proposed()
            .filter(|s| (s.score.unwrap_or(0.0) >= least) == accept);
        meant.map(|s| s.id).collect()
    }

    pub(in crate::state) fn judge_all(&mut self, accept: bool) {
        let ids = self.judged_at_once(accept);
        let state = match accept {
            true => Judged::Accepted,
            false => Judged::Rejected,
        };
        if !ids.is_empty() {
            self.edit(Edit::Judge { ids, state });
        }
    }

    /// The proposals whose answers tell most, first.
    pub fn doubtful(&self) -> Vec<&DbSample> {
        let proposed: Vec<&DbSample> = self.proposed().collect();
        let as_proposals: Vec<Proposal> = proposed
            .iter()
            .map(|s| Proposal {
                clip: s.clip,
                class: s.class.clone(),
                span: TimeSpan::new(s.start_secs, s.stop_secs),
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
            self.say("no proposal is left to check");
            return;
        };
        self.open_clip(clip, Some((start, stop)));
        self.timeline.selected = [id].into();
        if self.panel != Panel::Label && self.panel != Panel::Classes {
            self.panel = Panel::Label;
        }
    }
}
