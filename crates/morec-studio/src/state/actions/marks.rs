//! Marking: a stretch of the stream becomes a sample, a take becomes a clip.

use super::lines::ShownCommand;
use super::live::TEACHING;
use crate::jobs::JobOutcome;
use crate::jobs::teach::{Lesson, Taught, teach};
use crate::state::State;
use crate::state::live::LivePerformer;

/// Margin kept before and after a marked stretch, seconds.
const AROUND_SECS: f64 = 0.7;

impl State {
    /// Keeps the selected stretch, or the last motion, as a sample of a class, and trains anew.
    pub(in crate::state) fn mark(&mut self, class: &str) {
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
        let Some((start, stop)) = self.live.range.or_else(|| run.watched()?.last_motion()) else {
            self.say("nothing has moved yet that could be marked");
            return;
        };
        let cut =
            |performer: &LivePerformer| performer.cut_out(start - AROUND_SECS, stop + AROUND_SECS);
        let Some((recording, origin)) = run.watched().and_then(cut) else {
            self.complain("That part of the stream is no longer kept");
            return;
        };
        self.live.marks.push((start, stop, class.to_owned()));
        self.live.range = None;
        self.live.teaching = true;
        self.live.retrain = true;
        let lesson = Lesson {
            recording,
            label: Some((class.to_owned(), start - origin, stop - origin)),
            name: class.replace(' ', "_"),
        };
        let line = self.live_line("morec teach");
        self.show_line(line.map(|line| line.with("--name", class.replace(' ', "_"))));
        self.keep(store, lesson);
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
        self.say(match &taught.class {
            Some(class) => format!("{class}: kept as {}", taught.name),
            None => format!("take {} kept, {secs}", taught.name),
        });
    }

    /// Trains with what was marked, once it is in the database.
    pub(in crate::state) fn teach_again(&mut self) {
        if self.live.retrain && !self.live.teaching {
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
            label: None,
            name: "take".to_owned(),
        };
        let line = self.live_source();
        self.show_line(line.map(|source| {
            let line = ShownCommand::new("morec record").with("--listen", source);
            line.with("-o", &store)
        }));
        self.keep(store, lesson);
    }
}
