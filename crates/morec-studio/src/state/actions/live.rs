//! A live stream: started, stopped, its sensitivity and takes.

use morec::features::KeyPose;
use morec::live::{Detection, Recording};
use morec_ops::RecognizeSettings;

use super::lines::{ShownCommand, train_line};
use super::train::INDEX;
use crate::jobs::teach::Meaning;
use crate::jobs::{JobOutcome, recognise};
use crate::state::live::{Choice, ClipFeed, Feed, Forgot, Resensed, Run, ThreadFeed};
use crate::state::{LiveCommand, State};

/// Name of the job that keeps what was marked.
pub(in crate::state) const TEACHING: &str = "Storing the marked motion";

/// A hand with its fingers stretched reaches so far from its middle, metres.
const HAND_HALF_M: f64 = 0.12;

/// Name of the job that tries settings on the recorded minutes.
const TRYING: &str = "Testing the settings";

impl State {
    pub(in crate::state) fn apply_live(&mut self, command: LiveCommand) {
        match command {
            LiveCommand::Choose(choice) => self.live.choice = choice,
            LiveCommand::Start => self.start_live(),
            LiveCommand::Stop => self.stop_live(),
            LiveCommand::Seek(secs) => {
                if let Some(run) = &mut self.live.run {
                    run.seek(secs);
                }
            }
            LiveCommand::Speed(speed) => {
                self.live.speed = speed;
                if let Some(run) = &mut self.live.run {
                    run.play_at(speed);
                }
            }
            LiveCommand::Settings(settings) => self.recognise_with(settings),
            LiveCommand::Range(range) => self.live.range = range.filter(|r| r.1 - r.0 > 0.05),
            LiveCommand::GoTo(start, stop) => {
                self.live.range = Some((start, stop));
                self.live.looking.bring((start, stop), self.live.now_secs());
            }
            LiveCommand::Span(secs) => self.live.looking.show(secs, self.live.now_secs()),
            LiveCommand::Back(secs) => self.live.looking.move_by(secs, self.live.now_secs()),
            LiveCommand::Mark(slot) => {
                if self.live.run.is_some() {
                    let class = self.class_of_key(slot);
                    self.mark(Meaning::Class(class));
                }
            }
            LiveCommand::MarkAs(class) => self.mark(Meaning::Class(class)),
            LiveCommand::MarkBackground => self.mark(Meaning::Background),
            LiveCommand::Record => self.record(),
            LiveCommand::Watch(actor) => {
                // A take is of one performer.
                if self.live.take.is_some() {
                    self.say("end the take first");
                } else if let Some(run) = &mut self.live.run
                    && run.watched().is_none_or(|w| w.actor != actor)
                {
                    run.watch(actor);
                    self.live.range = None;
                }
            }
        }
    }

    fn start_live(&mut self) {
        self.stop_live();
        self.live.run = None;
        self.live.follow_index(self.train.index.as_ref());
        match self.live.choice.clone() {
            Choice::Clip(chosen) => {
                let shown = self.player.motion.as_ref().map(|m| m.id);
                let Some(clip) = chosen.or(shown) else {
                    self.complain("No clip to play: import one first");
                    return;
                };
                self.live.choice = Choice::Clip(Some(clip));
                self.show_live_line();
                self.live.starting = Some(clip);
                self.want_motion(clip);
            }
            Choice::Network(address) => self.listen(&address),
        }
    }

    fn show_live_line(&mut self) {
        let line = self.live_line("morec live");
        self.show_line(line.map(|line| line.settings(&self.live.used_settings())));
    }

    fn listen(&mut self, address: &str) {
        let opened = match crate::sources::open(address) {
            Ok(opened) => opened,
            Err(why) => return self.complain(crate::store::sentence(&why)),
        };
        match ThreadFeed::start(opened.source, self.wake.clone()) {
            Ok(feed) => {
                self.run(Feed::Thread(feed), opened.name);
                self.show_live_line();
                if let Some(run) = &mut self.live.run {
                    run.notices = Some(opened.notices);
                }
            }
            Err(error) => self.complain(format!("{address}: {error}")),
        }
    }

    /// The address at which the command finds the source that was chosen.
    pub(super) fn live_source(&self) -> Option<String> {
        match &self.live.choice {
            Choice::Network(address) => Some(address.clone()),
            Choice::Clip(clip) => {
                let clip = self.store.as_ref()?.snapshot.clip((*clip)?)?;
                Some(format!("clip://{}", clip.path))
            }
        }
    }

    /// The shell command that runs `command` on the chosen source. If the index was trained in this window, the command that trains and
    /// writes it comes first.
    pub(super) fn live_line(&self, command: &str) -> Option<ShownCommand> {
        let index = format!("{INDEX}.index");
        let line = ShownCommand::new(command).word(&index);
        let line = line.with("--listen", self.live_source()?);
        let store = self.store.as_ref().filter(|_| self.train.report.is_some());
        Some(match store {
            Some(store) => train_line(store.path(), &self.train_settings(), index).and(line),
            None => line,
        })
    }

    fn run(&mut self, feed: Feed, name: String) {
        let mut run = Run::new(feed, name);
        run.play_at(self.live.speed);
        if let Some(model) = self.live.model() {
            run.recognise_with(&model);
        }
        // That another source could not be opened is over.
        self.succeeded();
        self.live.run = Some(run);
        self.live.marks.clear();
        self.live.counts.clear();
        self.live.range = None;
        self.live.resensed = None;
        self.live.looking.until_secs = None;
        self.live.framed = None;
        self.player.playing = false;
    }

    fn stop_live(&mut self) {
        if self.live.take.is_some() {
            self.keep_take();
        }
        if let Some(run) = &mut self.live.run {
            run.stop();
        }
        self.live.starting = None;
        self.live.countdown = None;
    }

    /// Time passes on the stream.
    pub(in crate::state) fn tick_live(&mut self, dt: f64) {
        if let Some(clip) = self.live.starting {
            if let Some(motion) = self.motions.get(clip).cloned() {
                self.live.starting = None;
                let name = motion.clip.name.clone();
                self.run(Feed::Clip(ClipFeed::new(motion)), name);
            } else if let Some(why) = self.motions.failure(clip).map(str::to_owned) {
                self.live.starting = None;
                self.complain(why);
            } else {
                self.want_motion(clip);
            }
        }
        let live = &mut self.live;
        let Some(run) = &mut live.run else { return };
        let frames = run.tick(dt);
        // A take records one performer: nobody else is watched before it ends.
        if live.take.is_none() && run.watch_successor() {
            live.range = None;
        }
        let forgot = run.forgot.take();
        if let Some(take) = &mut live.take {
            frames.iter().for_each(|frame| take.push(frame));
        }
        if let Some(index) = &live.index {
            for class in run.news.drain(..) {
                let name = index.model.class_name(class).to_owned();
                *live.counts.entry(name).or_default() += 1;
            }
        }
        let watched = run.watched().filter(|w| !w.body.limbs.is_empty());
        let new = watched.filter(|w| live.framed != Some(w.actor));
        let seen = new.map(|w| (w.actor, w.body.is_hand));
        if let Some(left) = &mut live.countdown {
            *left -= dt;
            if *left <= 0.0 {
                live.countdown = None;
                live.take = run
                    .watched()
                    .and_then(|w| Some(Recording::new(w.rig.as_ref()?)));
            }
        }
        if let Some((actor, is_hand)) = seen {
            self.live.framed = Some(actor);
            self.stand_off(is_hand.then_some(HAND_HALF_M));
        }
        if let Some(why) = forgot {
            self.forget_minutes(why);
        }
    }

    /// Drops what was shown and selected of minutes that are no longer kept, and says why.
    fn forget_minutes(&mut self, why: Forgot) {
        if self.live.take.is_some() {
            self.keep_take();
        }
        self.live.range = None;
        self.live.marks.clear();
        self.live.resensed = None;
        self.live.looking.until_secs = None;
        self.say(why.text());
    }

    fn recognise_with(&mut self, settings: RecognizeSettings) {
        self.live.settings = settings;
        let Some(model) = self.live.model() else {
            return;
        };
        let Some(run) = &mut self.live.run else {
            return;
        };
        run.recognise_with(&model);
        self.show_live_line();
        self.try_settings();
    }

    /// Looks for what the settings would have found in the recorded minutes.
    fn try_settings(&mut self) {
        if self.jobs.is_running(TRYING) {
            return; // What comes of it is tried again if the settings have changed.
        }
        let (Some(model), Some(run)) = (self.live.model(), &self.live.run) else {
            return;
        };
        let poses: Vec<(f64, KeyPose)> = run.watched().map(|w| w.key_poses()).unwrap_or_default();
        if poses.len() > 30 {
            self.live.trying = Some(self.live.settings.clone());
            self.jobs
                .start(TRYING, false, &self.wake, JobOutcome::Resensed, move |_| {
                    recognise::poses(&model, &poses)
                });
        }
    }

    /// What the settings would have found has come.
    pub(in crate::state) fn take_resensed(&mut self, found: Vec<Detection>) {
        // Another index was taken meanwhile: its classes have other numbers.
        let Some(settings) = self.live.trying.take() else {
            return;
        };
        let again = settings != self.live.settings;
        self.live.resensed = Some(Resensed { settings, found });
        if again {
            self.try_settings();
        }
    }
}
