//! Takes the results of threads, once a frame.

use crate::jobs::{JobError, JobOutcome};
use crate::state::{Panel, Player, State};
use crate::store::StoreMessage;

impl State {
    /// Takes what threads have done since the last frame.
    pub fn poll(&mut self) {
        for said in self.store.as_mut().map(|s| s.poll()).unwrap_or_default() {
            match said {
                StoreMessage::Done(text) => {
                    self.succeeded();
                    self.say(text);
                }
                StoreMessage::Failed(text) => {
                    self.timeline.drag = None;
                    self.timeline.held_cut = None;
                    self.timeline.awaited = None;
                    self.complain(text);
                }
            }
        }
        for (name, outcome) in self.jobs.poll() {
            self.take(&name, outcome);
        }
        let version = self.store.as_ref().map_or(0, |s| s.version);
        if version != self.seen_version {
            self.seen_version = version;
            self.changed();
        }
        // Whoever could not be loaded at once, because others were, is asked for again.
        let waiting = [self.pending.map(|(id, _)| id), self.reopening];
        for clip in waiting.into_iter().flatten() {
            self.want_motion(clip);
        }
        self.refresh_library();
        self.refresh_study();
    }

    /// The database is not what it was.
    fn changed(&mut self) {
        let Some(store) = &self.store else { return };
        let (snapshot, is_writing) = (store.snapshot.clone(), store.is_busy());
        if self.timeline.drag.as_ref().is_some_and(|d| d.dropped) {
            self.timeline.drag = None;
        }
        if self.timeline.held_cut.is_some_and(|c| c.dropped) {
            self.timeline.held_cut = None;
        }
        self.roles_changed(&snapshot);
        self.timeline
            .selected
            .retain(|id| snapshot.sample(*id).is_some());
        self.library
            .selected
            .retain(|id| snapshot.clip(*id).is_some());
        self.select_awaited(&snapshot);
        let places = self.classes.follow(&snapshot);
        self.keep_places(places);
        self.study.follow(&snapshot);
        if !is_writing {
            self.shelf.follow(&snapshot);
        }
        self.train.follow(&snapshot);
        self.live.marks.retain_mut(|mark| mark.follow(&snapshot));
        let gone = self
            .player
            .motion
            .as_ref()
            .is_some_and(|m| snapshot.clip(m.id).is_none());
        if gone {
            self.player = Player::new();
            self.curves = None;
        }
        if self.player.motion.is_none()
            && self.pending.is_none()
            && let Some(first) = snapshot.clips.first()
        {
            self.open_clip(first.id, None);
        }
        self.teach_again();
    }

    fn reload(&mut self) {
        if let Some(store) = &mut self.store {
            store.reload();
        }
    }

    fn take(&mut self, name: &str, outcome: JobOutcome) {
        if !matches!(outcome, JobOutcome::Stopped(_)) {
            self.job_succeeded(name);
        }
        if matches!(
            outcome,
            JobOutcome::Imported(_) | JobOutcome::Trained(_) | JobOutcome::Written(_)
        ) {
            self.succeeded();
        }
        match outcome {
            JobOutcome::Made(made) => self.show_made(made),
            JobOutcome::Loaded(loaded) => {
                self.motions.loading.retain(|id| *id != loaded.id);
                match loaded.motion {
                    Ok(motion) => {
                        self.motions.keep(motion.clone());
                        self.reopened(&motion);
                        if let Some((_, stretch)) = self.pending.filter(|(id, _)| *id == motion.id)
                        {
                            self.show_motion(motion, stretch);
                        }
                    }
                    Err(why) => {
                        if self.pending.is_some_and(|(id, _)| id == loaded.id) {
                            self.pending = None;
                            self.complain(crate::store::sentence(&why));
                        }
                        self.motions.failed.insert(loaded.id, why);
                    }
                }
            }
            JobOutcome::Curves(curves) => {
                let shown = self.player.motion.as_ref().map(|m| m.id);
                if curves.clip == shown {
                    self.curves = Some(curves.into());
                }
            }
            JobOutcome::Imported(report) => {
                self.show_report(report);
                self.reload();
            }
            JobOutcome::LabelsRead(files) => self.labels_read(files),
            JobOutcome::Cut(report) => {
                let clips = crate::format::count(report.clips, "clip");
                let segments = crate::format::count(report.segments, "segment");
                let kept = match report.by_hand {
                    0 => String::new(),
                    n => format!(
                        "; {} cut by hand not changed",
                        crate::format::count(n, "clip")
                    ),
                };
                self.say(format!("{clips} cut into {segments}{kept}"));
                for (clip, why) in report.left.iter().take(3) {
                    self.complain(format!("{clip}: not cut: {why}"));
                }
                self.reload();
            }
            JobOutcome::Proposed(count) => {
                self.say(match count {
                    0 => "no candidate was found".to_owned(),
                    n => format!("{n} proposals to check"),
                });
                self.reload();
            }
            JobOutcome::Discovered(found) => self.found_sets(found),
            JobOutcome::Grouped(groups) => self.classes.show_groups(groups),
            JobOutcome::Trained(trained) => self.trained(*trained),
            JobOutcome::Judged(judged) => {
                self.say("cross-validation done");
                self.keep_judged(&judged);
                self.show_judged(*judged);
            }
            JobOutcome::Curve(curve) => {
                self.say("learning curve measured");
                self.keep_curve(curve);
            }
            JobOutcome::Recognised((clip, found)) => self.detections = Some((clip, found)),
            JobOutcome::Resensed(found) => self.take_resensed(found),
            JobOutcome::Silent(reported) => self.silent(&reported),
            JobOutcome::Taught(taught) => {
                self.taught(&taught);
                self.reload();
            }
            JobOutcome::Similar(similar) => self.found_similar(similar),
            JobOutcome::Words(found) => self.found_words(found),
            JobOutcome::ComparedAnnotators(compared) => self.annotators_compared(*compared),
            JobOutcome::Captions(captions) => self.captions_read(captions),
            JobOutcome::Sound(sound) => self.video.sound = Some(sound),
            JobOutcome::Aligned(aligned) => self.aligned(aligned),
            JobOutcome::Channel(channel) => self.channel = Some(channel),
            JobOutcome::Thesis((thesis, trained)) => {
                self.trained(*trained);
                self.thesis_trained(thesis);
            }
            JobOutcome::Map(map) => self.train.map = Some(map),
            JobOutcome::Written(said) => self.say(said),
            JobOutcome::Stopped(JobError::Failed(why)) => {
                if name == super::live::TEACHING {
                    self.not_taught();
                }
                self.complain_of(name, why);
            }
            JobOutcome::Stopped(JobError::Cancelled) => {
                // What looks at a clip is cancelled whenever another is shown.
                let quiet = [
                    super::shown::CURVES,
                    super::similar::SEARCHING,
                    super::thesis::MAPPING,
                    super::video::LISTENING,
                ];
                if !quiet.contains(&name) {
                    self.say(format!("{name}: stopped"));
                }
                self.reload();
            }
        }
        if self.panel == Panel::Live {
            self.live.follow_index(self.train.index.as_ref());
        }
    }
}
