//! A live stream: who performs, what is recognised, what is taught from what just happened.

mod feed;
mod marks;
mod moved;
mod run;
mod tracked;

use std::collections::BTreeMap;
use std::sync::Arc;

use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::live::{Detection, Model, PerformerId, Recording};
use morec::math::Vec3;
use morec_db::ClipId;

use super::State;
use super::lines::ShownCommand;
use crate::jobs::recognise;
pub use feed::{ClipFeed, Feed, ThreadFeed};
pub use run::Run;
pub use tracked::LivePerformer;

/// Name of the job that keeps what was marked.
pub(super) const TEACHING: &str = "Keeping what was marked";

/// Choice of a source.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// A clip of the database.
    Clip(Option<ClipId>),
    /// `vmc://…`, `axis://…`, `json+tcp://…`.
    Network(String),
}

/// The live panel's own state.
pub struct Live {
    pub choice: Choice,
    pub run: Option<Run>,
    /// A clip that starts once it is decoded.
    starting: Option<ClipId>,
    index: Option<Arc<MotionIndex>>,
    /// False alarms a minute that are put up with; `None` as trained.
    pub alarms: Option<f64>,
    /// A stretch of the stream that is selected, on its clock.
    pub range: Option<(f64, f64)>,
    /// Marked stretches: start, stop, class.
    pub marks: Vec<(f64, f64, String)>,
    /// Detections in the recorded minutes at this sensitivity.
    pub resensed: Option<Vec<Detection>>,
    /// Something that was marked is being kept.
    pub teaching: bool,
    /// The index is to be trained anew once the mark is in the database.
    retrain: bool,
    /// Seconds until a take begins.
    pub countdown: Option<f64>,
    /// The take.
    pub take: Option<Recording>,
    /// Number of detections of each class.
    pub counts: BTreeMap<String, usize>,
}

impl Default for Live {
    fn default() -> Self {
        Self {
            choice: Choice::Clip(None),
            run: None,
            starting: None,
            index: None,
            alarms: None,
            range: None,
            marks: Vec::new(),
            resensed: None,
            teaching: false,
            retrain: false,
            countdown: None,
            take: None,
            counts: BTreeMap::new(),
        }
    }
}

/// Commands for the live panel.
#[derive(Debug, Clone, PartialEq)]
pub enum LiveCommand {
    Choose(Choice),
    Start,
    Stop,
    /// False alarms a minute.
    Sensitivity(f64),
    Range(Option<(f64, f64)>),
    /// The selected stretch, or the last motion, shows the class of this key.
    Mark(usize),
    /// Likewise, of this class.
    MarkAs(String),
    /// Watches another performer.
    Watch(PerformerId),
    /// Begins a take after a countdown, or ends it.
    Record,
}

impl Live {
    pub fn is_running(&self) -> bool {
        self.run.is_some() || self.starting.is_some()
    }

    pub fn centre(&self) -> Option<Vec3> {
        self.run.as_ref()?.watched()?.centre()
    }

    pub fn heading(&self) -> Option<f64> {
        let performer = self.run.as_ref()?.watched()?;
        performer.body.heading(&performer.pose)
    }

    /// The index, at the sensitivity that was chosen.
    fn model(&self) -> Option<Model> {
        let model = self.index.as_ref()?.model.clone();
        match self.alarms.map(|alarms| model.with_sensitivity(alarms)) {
            Some(Ok(changed)) => Some(changed),
            _ => Some(model),
        }
    }

    /// True if the sensitivity of the index can be changed.
    pub fn can_sense(&self) -> bool {
        let index = self.index.as_ref();
        index.is_some_and(|index| index.model.with_sensitivity(0.3).is_ok())
    }

    pub fn index(&self) -> Option<&Arc<MotionIndex>> {
        self.index.as_ref()
    }

    /// Recognises with another index from the next frame on.
    pub(super) fn follow_index(&mut self, index: Option<&Arc<MotionIndex>>) {
        let Some(index) = index else { return };
        if self
            .index
            .as_ref()
            .is_some_and(|mine| Arc::ptr_eq(mine, index))
        {
            return;
        }
        self.index = Some(index.clone());
        let model = self.model();
        if let (Some(run), Some(model)) = (&mut self.run, model) {
            run.recognise_with(&model);
        }
    }
}

impl State {
    pub(super) fn apply_live(&mut self, command: LiveCommand) {
        match command {
            LiveCommand::Choose(choice) => self.live.choice = choice,
            LiveCommand::Start => self.start_live(),
            LiveCommand::Stop => self.stop_live(),
            LiveCommand::Sensitivity(alarms) => self.set_sensitivity(alarms),
            LiveCommand::Range(range) => self.live.range = range.filter(|r| r.1 - r.0 > 0.05),
            LiveCommand::Mark(slot) => {
                if self.live.run.is_some() {
                    let class = self.class_of_key(slot);
                    self.mark(&class);
                }
            }
            LiveCommand::MarkAs(class) => self.mark(&class),
            LiveCommand::Record => self.record(),
            LiveCommand::Watch(actor) => {
                // A take is of one performer.
                if self.live.take.is_some() {
                    self.say("end the take first");
                } else if let Some(run) = &mut self.live.run {
                    run.watch(actor);
                    self.live.range = None;
                }
            }
        }
    }

    fn start_live(&mut self) {
        self.stop_live();
        match self.live.choice.clone() {
            Choice::Clip(chosen) => {
                let shown = self.player.motion.as_ref().map(|m| m.id);
                let Some(clip) = chosen.or(shown) else {
                    self.complain("There is no clip to play: import one first");
                    return;
                };
                self.live.choice = Choice::Clip(Some(clip));
                let line = self.live_line("morec live");
                self.show_line(line);
                self.live.starting = Some(clip);
                self.want_motion(clip);
            }
            Choice::Network(address) => self.listen(&address),
        }
        self.live.follow_index(self.train.index.as_ref());
    }

    fn listen(&mut self, address: &str) {
        let opened = match crate::sources::open(address) {
            Ok(opened) => opened,
            Err(why) => return self.complain(crate::store::sentence(&why)),
        };
        match ThreadFeed::start(opened.source, self.wake.clone()) {
            Ok(feed) => {
                self.run(Feed::Thread(feed), opened.name);
                let line = self.live_line("morec live");
                self.show_line(line);
                if let Some(run) = &mut self.live.run {
                    run.notices = Some(opened.notices);
                }
            }
            Err(error) => self.complain(format!("{address}: {error}")),
        }
    }

    /// The address at which the command finds the source that was chosen.
    fn live_source(&self) -> Option<String> {
        match &self.live.choice {
            Choice::Network(address) => Some(address.clone()),
            Choice::Clip(clip) => {
                let clip = self.store.as_ref()?.snapshot.clip((*clip)?)?;
                Some(format!("clip://{}", clip.path))
            }
        }
    }

    /// A command with the index and the source that was chosen.
    fn live_line(&self, command: &str) -> Option<ShownCommand> {
        let line = ShownCommand::new(command).word(format!("{}.index", super::train::INDEX));
        Some(line.with("--listen", self.live_source()?))
    }

    fn run(&mut self, feed: Feed, name: String) {
        let mut run = Run::new(feed, name);
        if let Some(model) = self.live.model() {
            run.recognise_with(&model);
        }
        self.live.run = Some(run);
        self.live.marks.clear();
        self.live.counts.clear();
        self.live.range = None;
        self.live.resensed = None;
        self.player.playing = false;
    }

    fn stop_live(&mut self) {
        if self.live.take.is_some() {
            self.keep_take();
        }
        self.live.run = None;
        self.live.starting = None;
        self.live.countdown = None;
    }

    /// Time passes on the stream.
    pub(super) fn tick_live(&mut self, dt: f64) {
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
        if let Some(take) = &mut live.take {
            frames.iter().for_each(|frame| take.push(frame));
        }
        if let Some(index) = &live.index {
            for class in run.news.drain(..) {
                let name = index.model.class_name(class).to_owned();
                *live.counts.entry(name).or_default() += 1;
            }
        }
        if let Some(left) = &mut live.countdown {
            *left -= dt;
            if *left <= 0.0 {
                live.countdown = None;
                live.take = run
                    .watched()
                    .and_then(|w| Some(Recording::new(w.rig.as_ref()?)));
            }
        }
    }

    fn set_sensitivity(&mut self, alarms: f64) {
        self.live.alarms = Some(alarms);
        let Some(model) = self.live.model() else {
            return;
        };
        let Some(run) = &mut self.live.run else {
            return;
        };
        run.recognise_with(&model);
        let poses: Vec<(f64, KeyPose)> = run.watched().map(|w| w.key_poses()).unwrap_or_default();
        let line = self.live_line("morec live");
        self.show_line(line.map(|line| line.with("--sensitivity", format!("{alarms:.2}"))));
        if poses.len() > 30 && !self.jobs.is_running("Trying the sensitivity") {
            self.jobs.start(
                "Trying the sensitivity",
                false,
                &self.wake,
                move |progress| recognise::poses(&model, &poses, progress),
            );
        }
    }
}
