//! Comparing: a stretch beside the one most like it.

use std::path::Path;
use std::sync::Arc;

use morec::labels::ClipDetection;
use morec::math::Vec3;
use morec_measure::explain::MotionDeviation;

use crate::body::Aligned;
use crate::jobs::align::{self, Partner};
use crate::jobs::{JobError, JobOutcome, JobProgress};
use crate::state::compare::Placement;
use crate::state::{CompareCommand, State};
use crate::stretch::Stretch;
use morec_ops::Unlearned;

/// Name of the job that aligns.
pub(in crate::state) const ALIGNING: &str = "Comparing";
/// Most performers beside one another.
const MOST: usize = 4;

impl State {
    pub(in crate::state) fn apply_compare(&mut self, command: CompareCommand) {
        match command {
            CompareCommand::With { of, with, mirrored } => {
                let line = self.search_line(&of);
                self.show_line(line.map(|line| line.flag("--mirror", mirrored)));
                self.compare(of, Partner::Given(with, mirrored));
            }
            CompareCommand::Nearest => match self.selected_stretch() {
                Some((of, _)) => {
                    let line = self.search_line(&of);
                    self.show_line(line.map(|l| l.flag("--mirror", true).with("--limit", "1")));
                    self.compare(of, Partner::Nearest);
                }
                None => self.say("select a label or a stretch first"),
            },
            CompareCommand::NearestOf { of, class } => {
                self.compare_with_nearest(of, class, Unlearned::default());
            }
            CompareCommand::Moment(class) => self.compare_moment(class),
            CompareCommand::Reduced(dims) => match self.selected_stretch() {
                Some((of, _)) => self.align(move |db, _| align::reduced(db, of, dims)),
                None => self.say("select a label or a stretch first"),
            },
            CompareCommand::Place(placement) => self.companions.placement = placement,
            CompareCommand::Clear => self.companions.all.clear(),
        }
    }

    /// Compares a stretch with the nearest label of a class, `but` for some.
    pub(super) fn compare_with_nearest(&mut self, of: Stretch, class: String, but: Unlearned) {
        // The command searches among all stretches, not only among the labels of a class.
        self.show_line(self.search_line(&of));
        self.compare(of, Partner::NearestOf(class, but));
    }

    fn compare(&mut self, of: Stretch, with: Partner) {
        self.align(move |db, progress| align::align(db, of, with, progress));
    }

    fn align(
        &mut self,
        job: impl FnOnce(&Path, &JobProgress) -> Result<Arc<Aligned>, JobError> + Send + 'static,
    ) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        let job = move |progress: &JobProgress| job(&db, progress);
        self.jobs
            .start(ALIGNING, true, &self.wake, JobOutcome::Aligned, job);
    }

    /// Shows what was aligned.
    pub(in crate::state) fn aligned(&mut self, aligned: Arc<Aligned>) {
        let of = aligned.of;
        self.say(format!(
            "beside {}, {} to {}{}",
            aligned.motion.clip.name,
            crate::format::secs(aligned.with.span.start_secs),
            crate::format::secs(aligned.with.span.stop_secs),
            if aligned.mirrored { ", mirrored" } else { "" }
        ));
        let all = &mut self.companions.all;
        // Several stand beside one another only while all are aligned with the same stretch.
        all.retain(|other| other.of == of && other.with != aligned.with);
        all.truncate(MOST - 2);
        all.push(aligned);
        self.open_clip(of.clip, Some((of.span.start_secs, of.span.stop_secs)));
    }

    /// The performance that was compared last with the one that is shown, and how far off it is.
    pub fn deviation(&self) -> Option<(&Aligned, &MotionDeviation)> {
        let shown = self.player.motion.as_ref()?.id;
        let last = self.companions.all.last().filter(|a| a.of.clip == shown)?;
        Some((last, last.deviation.as_ref()?))
    }

    /// The recognised motion that plays in a loop, if one does.
    pub fn chosen_detection(&self) -> Option<(Stretch, &ClipDetection)> {
        let shown = self.player.motion.as_ref()?.id;
        let (clip, found) = self
            .detections
            .as_ref()
            .filter(|(clip, _)| *clip == shown)?;
        let (start_secs, stop_secs) = self.player.looped?;
        let found = found
            .iter()
            .find(|d| (d.span.start_secs, d.span.stop_secs) == (start_secs, stop_secs))?;
        let clip = *clip;
        let stretch = Stretch::new(clip, start_secs..stop_secs);
        Some((stretch, found))
    }

    /// Distance between neighbours, metres.
    pub fn apart(&self) -> f64 {
        let widest = self.player.motion.as_ref().map_or(1.7, |m| m.body.height);
        match self.companions.placement {
            Placement::Beside => 0.75 * widest,
            Placement::OnTop => 0.0,
        }
    }

    /// The middle of all that are shown, from the performer's place.
    pub(in crate::state) fn middle(&self, at: Vec3) -> Vec3 {
        let Some(motion) = &self.player.motion else {
            return at;
        };
        let here = self
            .companions
            .all
            .iter()
            .filter(|a| a.of.clip == motion.id);
        let Some(first) = here.clone().next() else {
            return at;
        };
        let apart = 0.5 * self.apart() * here.count() as f64;
        at + crate::body::companion::aside(motion, first.of.span.start_secs) * apart
    }
}
