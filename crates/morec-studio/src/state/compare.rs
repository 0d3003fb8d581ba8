//! Performers beside the one that is shown: a sample against its match, aligned by the warping path.

use std::sync::Arc;

use morec::math::Vec3;

use super::State;
use crate::jobs::align::{self, Aligned};
use crate::stretch::Stretch;

/// Name of the job that aligns.
pub(super) const ALIGNING: &str = "Comparing";
/// So many stand beside one another at most.
const MOST: usize = 4;

/// Where companions stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    #[default]
    Beside,
    OnTop,
}

/// Who is seen with the performer of the clip that is shown.
#[derive(Default)]
pub struct Companions {
    pub all: Vec<Arc<Aligned>>,
    pub placement: Placement,
}

/// What can be asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum CompareCommand {
    /// A stretch with another, which is its mirror image if `mirrored`.
    With {
        of: Stretch,
        with: Stretch,
        mirrored: bool,
    },
    /// The selected stretch or label with what is most like it.
    Nearest,
    Place(Placement),
    /// Nobody but the performer.
    Clear,
}

impl State {
    pub(super) fn apply_compare(&mut self, command: CompareCommand) {
        match command {
            CompareCommand::With { of, with, mirrored } => self.compare(of, Some((with, mirrored))),
            CompareCommand::Nearest => match self.selected_stretch() {
                Some((of, _)) => self.compare(of, None),
                None => self.say("select a label or a stretch first"),
            },
            CompareCommand::Place(placement) => self.companions.placement = placement,
            CompareCommand::Clear => self.companions.all.clear(),
        }
    }

    fn compare(&mut self, of: Stretch, with: Option<(Stretch, bool)>) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        self.jobs
            .start(ALIGNING, true, &self.wake, move |progress| {
                align::align(&db, of, with, progress)
            });
    }

    /// Shows what was aligned.
    pub(super) fn aligned(&mut self, aligned: Arc<Aligned>) {
        let of = aligned.of;
        self.say(format!(
            "beside {}, {} to {}{}",
            aligned.motion.clip.name,
            crate::format::secs(aligned.with.start_secs),
            crate::format::secs(aligned.with.stop_secs),
            if aligned.mirrored { ", mirrored" } else { "" }
        ));
        let all = &mut self.companions.all;
        // Several stand beside one another only while all are aligned with the same stretch.
        all.retain(|other| other.of == of && other.with != aligned.with);
        all.truncate(MOST - 2);
        all.push(aligned);
        self.open_clip(of.clip, Some((of.start_secs, of.stop_secs)));
    }

    /// How far beside the performer each companion stands, metres.
    pub fn apart(&self) -> f64 {
        let widest = self.player.motion.as_ref().map_or(1.7, |m| m.body.height);
        match self.companions.placement {
            Placement::Beside => 0.75 * widest,
            Placement::OnTop => 0.0,
        }
    }

    /// The middle of all that are shown, from the performer's place.
    pub(super) fn middle(&self, at: Vec3) -> Vec3 {
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
        at + crate::body::companion::aside(motion, first.of.start_secs) * apart
    }
}
