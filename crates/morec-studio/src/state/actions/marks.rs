//! Marking: a stretch of the stream becomes a sample or background, a take becomes a clip.

use std::path::Path;

use morec::TimeSpan;
use morec::live::PerformerId;
use morec_db::BACKGROUND;

use super::lines::ShownCommand;
use super::live::TEACHING;
use crate::jobs::JobOutcome;
use crate::jobs::teach::{Lesson, Meaning, Taught, teach};
use crate::state::State;
use crate::state::live::{LiveMark, labelled_there};
use crate::store::Store;

/// Margin kept before and after a marked stretch, seconds.
const AROUND_SECS: f64 = 0.7;

impl State {
    /// Keeps the selected stretch, or the last motion, as a sample of a class or as background, and trains anew.
    pub(in crate::state) fn mark(&mut self, meaning: Meaning) {
        let Some(store) = self.store.as_ref().map(|s| s.path().to_owned()) else {
            return;
        };
        let Some(run) = &self.live.run else {
            self.say("start a source first");
            return;
        };
        if self.live.teaching {
            self.say("the mark before this one is still being kept");
            return;
        }
        let Some((actor, stretch)) = run.watched().and_then(|watched| {
            let (start, stop) = self.live.range.or_else(|| watched.last_motion())?;
            Some((watched.actor, TimeSpan::new(start, stop)))
        }) else {
            self.say("nothing has moved yet that could be marked");
            return;
        };
        if let Some(why) = self.contradiction(actor, stretch, &meaning) {
            return self.complain(why);
        }
        let Some(lesson) = self.lesson(stretch, &meaning) else {
            self.complain("That part of the stream is no longer kept");
            return;
        };
        let line = match &meaning {
            Meaning::Class(_) => {
                let line = self.live_line("morec teach");
                line.map(|line| line.with("--name", &lesson.name))
            }
            Meaning::Background => {
                let line = self.record_line(&store);
                line.map(|line| line.with("--tag", BACKGROUND))
            }
        };
        self.show_line(line);
        // Background alone teaches nothing.
        let labelled = self
            .store
            .iter()
            .any(|s| s.snapshot.accepted().next().is_some());
        self.live.retrain = labelled || meaning != Meaning::Background;
        self.live.marks.push(LiveMark::new(actor, stretch, meaning));
        self.live.range = None;
        self.live.teaching = true;
        self.keep(store, lesson);
    }

    /// What a stretch becomes in the database; `None` if the stream no longer has it.
    fn lesson(&self, stretch: TimeSpan, meaning: &Meaning) -> Option<Lesson> {
        // What came before and after background may be a motion of a class.
        let around = match meaning {
            Meaning::Class(_) => AROUND_SECS,
            Meaning::Background => 0.0,
        };
        let watched = self.live.run.as_ref()?.watched()?;
        let (recording, origin) =
            watched.cut_out(stretch.start_secs - around, stretch.stop_secs + around)?;
        Some(Lesson {
            recording,
            name: meaning.name().replace(' ', "_"),
            meaning: Some(meaning.clone()),
            extent: stretch.map(|secs| secs - origin),
        })
    }

    /// Reason why a stretch cannot be marked so: the same motion would teach a class and be background too.
    fn contradiction(
        &self,
        actor: PerformerId,
        stretch: TimeSpan,
        meaning: &Meaning,
    ) -> Option<String> {
        let marks = self.live.marks.iter();
        let met = marks
            .filter(|mark| mark.meets(actor, stretch))
            .find(|mark| mark.meaning.contradicts(meaning));
        if let Some(mark) = met {
            return Some(format!(
                "Not marked: that motion is marked as {} already; undo that first",
                mark.meaning.name()
            ));
        }
        let snapshot = &self.store.as_ref()?.snapshot;
        let (clip, start) = self.live.run.as_ref()?.moment(stretch.start_secs)?;
        let played = snapshot.clip(clip)?;
        let name = &played.name;
        match meaning {
            Meaning::Class(_) if played.is_background() && played.samples == 0 => Some(format!(
                "Not marked: {name} is background, in which none of the classes is seen; take that mark from it first"
            )),
            Meaning::Class(_) => None,
            Meaning::Background => {
                let there = TimeSpan::new(start, start + stretch.duration_secs());
                let class = labelled_there(snapshot, clip, there)?;
                Some(format!("Not marked: {name} has a label {class} there"))
            }
        }
    }

    /// The command that records the source into the database.
    fn record_line(&self, db: &Path) -> Option<ShownCommand> {
        let line = ShownCommand::new("morec record").with("--listen", self.live_source()?);
        Some(line.with("-o", db))
    }

    fn keep(&mut self, db: std::path::PathBuf, lesson: Lesson) {
        let folder = self.scratch();
        self.jobs
            .start(TEACHING, false, &self.wake, JobOutcome::Taught, move |_| {
                teach(&db, &folder, &lesson)
            });
    }

    pub(in crate::state) fn taught(&mut self, taught: &Taught) {
        self.live.teaching = false;
        let secs = crate::format::duration(taught.secs);
        self.say(match &taught.meaning {
            Some(meaning) => format!("{}: kept as {}", meaning.name(), taught.name),
            None => format!("take {} kept, {secs}", taught.name),
        });
        if taught.meaning.is_some()
            && let Some(mark) = self.live.marks.iter_mut().rfind(|mark| mark.clip.is_none())
        {
            mark.clip = Some(taught.clip);
        }
    }

    /// What was to be kept could not be: its mark goes.
    pub(in crate::state) fn not_taught(&mut self) {
        if self.live.teaching {
            let at = self.live.marks.iter().rposition(|mark| mark.clip.is_none());
            at.map(|at| self.live.marks.remove(at));
        }
        self.live.teaching = false;
        self.live.retrain = false;
    }

    /// Trains with what was marked, once the snapshot has it: one that comes before the answer to the reload may show the clip
    /// without its label.
    pub(in crate::state) fn teach_again(&mut self) {
        let is_there = !self.live.teaching && !self.store.as_ref().is_some_and(Store::is_busy);
        if self.live.retrain && is_there {
            self.live.retrain = false;
            self.start_training();
        }
    }

    pub(in crate::state) fn record(&mut self) {
        if self.live.take.is_some() {
            self.keep_take();
        } else if self.live.countdown.take().is_some() {
            self.say("recording called off");
        } else if self.live.run.is_some() {
            self.live.countdown = Some(3.0);
        } else {
            self.say("start a source first");
        }
    }

    pub(in crate::state) fn keep_take(&mut self) {
        let Some(recording) = self.live.take.take() else {
            return;
        };
        let Some(store) = self.store.as_ref().map(|s| s.path().to_owned()) else {
            return;
        };
        let lesson = Lesson {
            recording,
            meaning: None,
            extent: TimeSpan::new(0.0, 0.0),
            name: "take".to_owned(),
        };
        let line = self.record_line(&store);
        self.show_line(line);
        self.keep(store, lesson);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn training_waits_for_the_snapshot_that_was_asked_for_after_the_mark_was_kept() {
        let folder = tempfile::tempdir().unwrap();
        let mut state = State::new(std::sync::Arc::new(|| {}), folder.path().to_owned());
        state.open_store(&folder.path().join("moves.mdb"), false);
        // The mark is kept, and the snapshot that has it is asked for; one from before the label arrives first.
        state.live.retrain = true;
        state.store.as_mut().unwrap().reload();
        state.teach_again();
        assert!(
            state.live.retrain,
            "the label is not in the snapshot that is there"
        );
        while state.is_busy() {
            state.poll();
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        assert!(!state.live.retrain, "the snapshot has arrived");
    }
}
