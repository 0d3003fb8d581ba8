//! The clips that a report plays.

use std::path::PathBuf;

use anyhow::Result;
use morec::import::Take;
use morec::labels::Mark;
use morec_db::{ClipFilter, MotionDb};
use morec_measure::eval::Timeline;
use morec_measure::player::{PlayedClip, Reel};

use crate::files::{ReadArgs, expand};

/// Frames of a clip: two minutes at 30 a second; of longer ones not every frame is kept.
const FRAMES: usize = 3600;
/// A report takes no more clips when they have this many bytes: a browser must still open it.
const MOST_BYTES: usize = 48 << 20;

/// Clips in which something was labelled or found, with both.
pub struct ReportMotion<'a> {
    timelines: &'a [Timeline],
    reel: Reel,
    left_out: usize,
}

impl<'a> ReportMotion<'a> {
    /// None yet, of the clips of `timelines`.
    pub fn of(timelines: &'a [Timeline]) -> Self {
        Self {
            timelines,
            reel: Reel::default(),
            left_out: 0,
        }
    }

    /// Adds those in files and folders.
    pub fn add_files(&mut self, paths: &[PathBuf], read: &ReadArgs) -> Result<()> {
        let reader = read.reader();
        for path in expand(paths)? {
            // What cannot be read was said when it was searched.
            let Ok(takes) = reader.open(&path) else {
                continue;
            };
            takes.iter().for_each(|take| self.add(take));
        }
        Ok(())
    }

    /// Adds those of a database.
    pub fn add_db(&mut self, db: &MotionDb) -> Result<()> {
        for info in db.clips(&ClipFilter::default())? {
            if self.timeline(&info.name).is_some() {
                self.add(&db.clip(info.id)?.into_take()?);
            }
        }
        Ok(())
    }

    /// Clips that the report plays; warns about those that it does not.
    pub fn into_reel(self) -> Option<Reel> {
        if self.left_out > 0 {
            eprintln!(
                "morec: {} clips do not play in the report, to keep it small enough to open",
                self.left_out
            );
        }
        (!self.reel.is_empty()).then_some(self.reel)
    }

    fn timeline(&self, name: &str) -> Option<&'a Timeline> {
        let shows =
            |t: &&Timeline| t.stream.clip == name && !(t.truths.is_empty() && t.founds.is_empty());
        self.timelines.iter().find(shows)
    }

    fn add(&mut self, take: &Take) {
        let Some(timeline) = self.timeline(take.name()) else {
            return;
        };
        if self.reel.bytes() > MOST_BYTES {
            self.left_out += 1;
            return;
        }
        let truths = timeline.truths.iter();
        let founds = timeline.founds.iter();
        let played = PlayedClip {
            clip: &take.clip,
            roles: &take.roles,
            beside: None,
            span: None,
            labels: truths
                .map(|(truth, _)| Mark::new(truth.class.as_str(), truth.span))
                .collect(),
            detections: founds
                .map(|(found, _)| Mark::new(found.class.as_str(), found.span))
                .collect(),
            video: None,
        };
        self.reel.add(&played, FRAMES);
    }
}
