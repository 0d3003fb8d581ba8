//! Marking: a stretch of the stream becomes a sample or background, a take becomes a clip.

use std::collections::BTreeSet;
use std::path::Path;

use morec::TimeSpan;
use morec::live::PerformerId;
use morec_db::BACKGROUND;

use super::lines::ShownCommand;
use super::live::TEACHING;
use crate::jobs::teach::{Lesson, Meaning, Taught, teach};
use crate::jobs::{JobOutcome, JobProgress, recognise};
use crate::state::State;
use crate::state::live::{LiveDetection, LiveMark, SilenceWanted, labelled_there};
use crate::store::{DbPlace, Store};

/// Margin kept before and after a marked stretch, seconds.
const AROUND_SECS: f64 = 0.7;
/// Most that is kept around background, seconds.
const AROUND_BACKGROUND_SECS: f64 = 1.5;
/// A detection that was reported so long ago is what somebody means by none of these, seconds.
const FRESH_SECS: f64 = 8.0;
/// The new index is tried on so much before and after what it shall be silent on, seconds.
const LISTENED_SECS: (f64, f64) = (6.0, 2.0);

impl State {
    /// Keeps the selected stretch, or the last motion, as a sample of a class or as background, and trains anew.
    pub(in crate::state) fn mark(&mut self, meaning: Meaning) {
        let Some(store) = self.store.as_ref().map(Store::place) else {
            return;
        };
        let Some(run) = &self.live.run else {
            self.say("start a source first");
            return;
        };
        if self.live.teaching {
            self.say("the previous mark is still being stored");
            return;
        }
        let Some((actor, stretch)) = run.watched().and_then(|watched| {
            let asked = self
                .live
                .range
                .map(|(start, stop)| TimeSpan::new(start, stop));
            let last = || {
                let moved = watched.last_motion();
                let moved = moved.map(|(start, stop)| TimeSpan::new(start, stop));
                self.stretch_to_mark(watched.actor, moved, &meaning)
            };
            Some((watched.actor, asked.or_else(last)?))
        }) else {
            self.say("no motion to mark yet");
            return;
        };
        if let Some(why) = self.contradiction(actor, stretch, &meaning) {
            return self.complain(why);
        }
        let Some(lesson) = self.lesson(stretch, &meaning) else {
            self.complain("This part of the stream is no longer stored");
            return;
        };
        let line = match &meaning {
            Meaning::Class(_) => {
                let line = self.live_line("morec teach");
                line.map(|line| line.with("--name", &lesson.name))
            }
            Meaning::Background => {
                let line = self.record_line(&store.path);
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
        let mark = LiveMark::new(actor, stretch, meaning.clone());
        self.live.marks.push(mark);
        self.live.range = None;
        self.live.teaching = true;
        self.live.checked = match meaning {
            Meaning::Background => self.silence_wanted(stretch),
            Meaning::Class(_) => None,
        };
        self.keep(store, lesson);
    }

    /// What a stretch becomes in the database; `None` if the stream no longer has it.
    fn lesson(&self, stretch: TimeSpan, meaning: &Meaning) -> Option<Lesson> {
        let watched = self.live.run.as_ref()?.watched()?;
        let around = match meaning {
            Meaning::Class(_) => TimeSpan::new(
                stretch.start_secs - AROUND_SECS,
                stretch.stop_secs + AROUND_SECS,
            ),
            Meaning::Background => self.around_background(watched.actor, stretch),
        };
        let (recording, origin) = watched.cut_out(around.start_secs, around.stop_secs)?;
        Some(Lesson {
            recording,
            name: meaning.name().replace(' ', "_"),
            annotator: self.study.annotator.clone(),
            meaning: Some(meaning.clone()),
            extent: stretch.map(|secs| secs - origin),
        })
    }

    /// The stretch that a mark means when none is selected. It is the last movement, extended to the last detection if the two overlap:
    /// speed may fall in the middle of a motion. If they do not overlap, a class is taught by the movement, and background by the detection,
    /// which is the false alarm. Without movement it is the detection. Detections older than [`FRESH_SECS`] do not count.
    fn stretch_to_mark(
        &self,
        actor: PerformerId,
        moved: Option<TimeSpan>,
        meaning: &Meaning,
    ) -> Option<TimeSpan> {
        let run = self.live.run.as_ref()?;
        let fresh =
            |d: &&LiveDetection| d.actor == actor && run.now_secs - d.reported_secs < FRESH_SECS;
        let last = run.seen.iter().rev().find(fresh).map(|d| d.span);
        match (last, moved) {
            (Some(found), Some(moved)) if found.overlap_secs(moved) > 0.0 => Some(TimeSpan::new(
                found.start_secs.min(moved.start_secs),
                found.stop_secs.max(moved.stop_secs),
            )),
            (Some(found), None) => Some(found),
            (Some(found), Some(_)) if *meaning == Meaning::Background => Some(found),
            (_, moved) => moved,
        }
    }

    /// A stretch of background with what came before and after it, as far as that is nothing of a class: what is reported of a motion
    /// is decided by what is around it, too.
    fn around_background(&self, actor: PerformerId, stretch: TimeSpan) -> TimeSpan {
        let Some(run) = &self.live.run else {
            return stretch;
        };
        let (mut start, mut stop) = (
            stretch.start_secs - AROUND_BACKGROUND_SECS,
            stretch.stop_secs + AROUND_BACKGROUND_SECS,
        );
        let detections = run.seen.iter().filter(|d| d.actor == actor).map(|d| d.span);
        let marks = self.live.marks.iter().filter(|mark| mark.actor == actor);
        let marks = marks.filter(|mark| mark.meaning != Meaning::Background);
        let mut others: Vec<TimeSpan> = detections.chain(marks.map(|mark| mark.span)).collect();
        if let (Some(store), Some((clip, at))) = (&self.store, run.moment(stretch.start_secs)) {
            let samples = store.snapshot.samples_of(clip).iter();
            let on_stream = |secs: f64| secs - at + stretch.start_secs;
            others.extend(samples.map(|s| s.span().map(on_stream)));
        }
        for other in others
            .iter()
            .filter(|other| other.overlap_secs(stretch) <= 0.0)
        {
            if other.stop_secs <= stretch.start_secs {
                start = start.max(other.stop_secs);
            } else {
                stop = stop.min(other.start_secs);
            }
        }
        TimeSpan::new(start, stop)
    }

    /// The poses by which it is seen whether the next index is silent on a stretch.
    fn silence_wanted(&self, stretch: TimeSpan) -> Option<SilenceWanted> {
        let watched = self.live.run.as_ref()?.watched()?;
        let mut poses = watched.key_poses();
        poses.retain(|(secs, _)| (secs - stretch.stop_secs) < LISTENED_SECS.1);
        poses.retain(|(secs, _)| (stretch.start_secs - secs) < LISTENED_SECS.0);
        Some(SilenceWanted { stretch, poses })
    }

    /// Looks whether the new index is silent on what was marked as background last.
    pub(super) fn check_silence(&mut self) {
        // An index that was under way before the mark was kept says nothing of it.
        if self.live.teaching || self.live.retrain {
            return;
        }
        let (Some(wanted), Some(model)) = (self.live.checked.take(), self.live.model()) else {
            return;
        };
        let job = move |_: &JobProgress| {
            let found = recognise::poses(&model, &wanted.poses)?;
            let there = found
                .iter()
                .filter(|d| d.span.overlap_secs(wanted.stretch) > 0.0);
            let classes = there.map(|d| model.class_name(d.class).to_owned());
            Ok(classes.collect::<BTreeSet<String>>())
        };
        let outcome = JobOutcome::Silent;
        self.jobs
            .start("Checking the background", false, &self.wake, outcome, job);
    }

    /// Says whether the false alarm is gone.
    pub(in crate::state) fn silent(&mut self, reported: &BTreeSet<String>) {
        if reported.is_empty() {
            return self.say("the new index reports nothing there");
        }
        let classes: Vec<&str> = reported.iter().map(String::as_str).collect();
        self.complain(format!(
            "The new index still reports {} there: mark it again when it comes, or give that class more labels",
            classes.join(", ")
        ));
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
                "Not marked: this motion is marked as {} already; undo that mark first",
                mark.meaning.name()
            ));
        }
        let snapshot = &self.store.as_ref()?.snapshot;
        let (clip, start) = self.live.run.as_ref()?.moment(stretch.start_secs)?;
        let played = snapshot.clip(clip)?;
        let name = &played.name;
        match meaning {
            Meaning::Class(_) if played.is_background() && played.samples == 0 => Some(format!(
                "Not marked: {name} is background, which contains none of the classes; remove its background mark first"
            )),
            Meaning::Class(_) => None,
            Meaning::Background => {
                let there = TimeSpan::new(start, start + stretch.duration_secs());
                let class = labelled_there(snapshot, clip, there)?;
                Some(format!(
                    "Not marked: {name} has a label of {class} at this time"
                ))
            }
        }
    }

    /// The command that records the source into the database.
    fn record_line(&self, db: &Path) -> Option<ShownCommand> {
        let line = ShownCommand::new("morec record").with("--listen", self.live_source()?);
        Some(line.with("-o", db))
    }

    fn keep(&mut self, db: DbPlace, lesson: Lesson) {
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
            self.say("recording cancelled");
        } else if self.live.is_running() {
            self.live.countdown = Some(3.0);
        } else {
            self.say("start a source first");
        }
    }

    pub(in crate::state) fn keep_take(&mut self) {
        let Some(recording) = self.live.take.take() else {
            return;
        };
        let Some(store) = self.store.as_ref().map(Store::place) else {
            return;
        };
        let lesson = Lesson {
            recording,
            meaning: None,
            extent: TimeSpan::new(0.0, 0.0),
            name: "take".to_owned(),
            annotator: None,
        };
        let line = self.record_line(&store.path);
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
