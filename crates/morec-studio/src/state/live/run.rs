//! One run of a live source: its performers, what was recognised, how the stream is.

use std::collections::VecDeque;

use morec::TimeSpan;
use morec::classes::ClassId;
use morec::diagnosis::{Diagnosis, Severity};
use morec::index::MotionIndex;
use morec::live::{EarlyDetection, Event, Frame, Model, PerformerId, Phase};
use morec::templates::Deviation;
use morec_db::ClipId;

use super::feed::{Feed, LiveItem};
use super::tracked::LivePerformer;
use crate::state::player::LONGEST_FRAME;

/// A stream that says nothing for so long has been lost, seconds on the wall.
const LOST_SECS: f64 = 1.5;
/// Most performers that are followed; minutes of poses are kept of each.
const MOST: usize = 16;

/// Performances whose deviations are shown at most.
const MOST_COMPARED: usize = 24;

/// Something that was recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveDetection {
    pub class: String,
    pub actor: PerformerId,
    pub span: TimeSpan,
    pub reported_secs: f64,
    pub score: f64,
    /// Of an activity that repeats.
    pub repetitions: Option<u32>,
}

/// How far a gesture, or a repetition of an activity, was from the nearest sample.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveDeviation {
    pub class: String,
    pub actor: PerformerId,
    /// Of a repetition, its number.
    pub repetition: Option<u32>,
    pub deviation: Deviation,
}

/// Why the last minutes of a performer are no longer kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Forgot {
    OtherSkeleton,
    ClockWentBack,
}

impl Forgot {
    /// In words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::OtherSkeleton => {
                "the skeleton of the performer changed: the minutes before are no longer kept"
            }
            Self::ClockWentBack => {
                "the sender's clock went back: the minutes before are no longer kept"
            }
        }
    }
}

/// A source that runs.
pub struct Run {
    feed: Feed,
    pub name: String,
    /// In the order in which they came.
    pub performers: Vec<LivePerformer>,
    /// Place of the performer who is watched, taught from and recorded.
    watched: usize,
    /// On the clock of the performer who is watched.
    pub now_secs: f64,
    pub seen: Vec<LiveDetection>,
    /// The last that were compared with samples.
    pub compared: VecDeque<LiveDeviation>,
    /// Classes of motions that ended since they were asked for.
    pub news: Vec<ClassId>,
    /// Why the last minutes of the performer who is watched were dropped, until it is said.
    pub forgot: Option<Forgot>,
    model: Option<Model>,
    /// Time for which nothing has come, seconds on the wall.
    pub silent_secs: f64,
    pub ended: bool,
    /// True once the user stopped it: what came can still be looked at and labelled.
    stopped: bool,
    /// Faults of the data that the source is sent.
    pub notices: Option<morec_live::Notices>,
    noticed: Vec<String>,
}

impl Run {
    pub fn new(feed: Feed, name: String) -> Self {
        Self {
            feed,
            name,
            performers: Vec::new(),
            watched: 0,
            now_secs: 0.0,
            seen: Vec::new(),
            compared: VecDeque::new(),
            news: Vec::new(),
            forgot: None,
            model: None,
            silent_secs: 0.0,
            ended: false,
            stopped: false,
            notices: None,
            noticed: Vec::new(),
        }
    }

    /// True while poses come or may come.
    pub const fn is_running(&self) -> bool {
        !self.stopped && !self.ended
    }

    /// Stops the source. Motions that are under way end.
    pub fn stop(&mut self) {
        self.stopped = true;
        self.feed.stop();
        let mut events = Vec::new();
        for performer in &mut self.performers {
            performer.finish(&mut events);
        }
        self.take_events(&events);
    }

    /// The performer who is watched.
    pub fn watched(&self) -> Option<&LivePerformer> {
        self.performers.get(self.watched)
    }

    /// The clip of the database that is played, and the moment of it that a moment of the stream shows.
    pub fn moment(&self, stream_secs: f64) -> Option<(ClipId, f64)> {
        self.feed.moment(stream_secs)
    }

    /// Watches another performer.
    pub fn watch(&mut self, actor: PerformerId) {
        if let Some(at) = self.performers.iter().position(|p| p.actor == actor) {
            self.watch_place(at);
        }
    }

    /// Performers who come from several senders have clocks of their own.
    fn watch_place(&mut self, at: usize) {
        self.watched = at;
        self.now_secs = self.performers[at].now_secs;
    }

    /// Recognises with this model from the next frame on.
    pub fn recognise_with(&mut self, model: &Model) {
        let mut events = Vec::new();
        for performer in &mut self.performers {
            performer.recognise_with(model, &mut events);
        }
        self.take_events(&events);
        self.model = Some(model.clone());
    }

    /// Takes what has come while `dt` seconds passed; gives the frames of the performer who is watched.
    pub fn tick(&mut self, dt: f64) -> Vec<Frame> {
        let (mut items, mut frames, mut events) = (Vec::new(), Vec::new(), Vec::new());
        if self.stopped {
            return frames;
        }
        self.feed.poll(dt.min(LONGEST_FRAME), &mut items);
        self.silent_secs += dt;
        if let Some(notices) = &self.notices {
            self.noticed.extend(notices.take());
        }
        for item in items {
            match item {
                LiveItem::Rig(actor, rig) => {
                    let performer = self.performer(actor);
                    if performer.is_some_and(|p| p.set_rig(rig, &mut events)) {
                        self.take_events(&std::mem::take(&mut events));
                        self.forget(actor, Forgot::OtherSkeleton);
                    }
                }
                LiveItem::Frame(frame) => {
                    self.silent_secs = 0.0;
                    let Some(performer) = self.performer(frame.actor) else {
                        continue;
                    };
                    if performer.push(&frame, &mut events) {
                        self.forget(frame.actor, Forgot::ClockWentBack);
                    }
                    if self.watched().is_some_and(|w| w.actor == frame.actor) {
                        self.now_secs = frame.time_secs;
                        frames.push(*frame);
                    }
                }
                LiveItem::Gone(actor) => {
                    if let Some(performer) = self.performer(actor) {
                        performer.finish(&mut events);
                        performer.gone = true;
                    }
                }
                LiveItem::Ended => self.ended = true,
            }
        }
        self.take_events(&events);
        frames
    }

    /// The performer of a number; a new one takes the place of one who is gone once all places are taken.
    fn performer(&mut self, actor: PerformerId) -> Option<&mut LivePerformer> {
        if let Some(at) = self.performers.iter().position(|p| p.actor == actor) {
            return self.performers.get_mut(at);
        }
        if self.performers.len() < MOST {
            let new = LivePerformer::new(actor, self.model.as_ref());
            self.performers.push(new);
            return self.performers.last_mut();
        }
        let mut places = self.performers.iter_mut().enumerate();
        let (_, place) = places.find(|(at, p)| p.gone && *at != self.watched)?;
        *place = LivePerformer::new(actor, self.model.as_ref());
        Some(place)
    }

    /// What was recognised of a performer whose frames were dropped cannot be looked at again.
    fn forget(&mut self, actor: PerformerId, why: Forgot) {
        self.seen.retain(|seen| seen.actor != actor);
        self.compared.retain(|compared| compared.actor != actor);
        if self.watched().is_some_and(|w| w.actor == actor) {
            self.forgot = Some(why);
        }
    }

    /// Watches, in place of a performer who is gone, another who came after that performer's last frame: a sender that was started again
    /// has another number. True if another is watched now.
    pub fn watch_successor(&mut self) -> bool {
        let gone = self.watched().filter(|w| w.gone);
        let Some(last) = gone.and_then(|w| w.frames.back()) else {
            return false;
        };
        let came_after = |p: &LivePerformer| {
            let first = p.frames.front();
            !p.gone && first.is_some_and(|first| first.wall_secs > last.wall_secs)
        };
        let Some(successor) = self.performers.iter().position(came_after) else {
            return false;
        };
        self.watch_place(successor);
        true
    }

    fn take_events(&mut self, events: &[Event]) {
        let Some(model) = &self.model else { return };
        for (event, deviation) in events.iter().filter_map(|e| Some((e, e.deviation?))) {
            if self.compared.len() == MOST_COMPARED {
                self.compared.pop_front();
            }
            let is_one = event.phase == Phase::Repetition;
            self.compared.push_back(LiveDeviation {
                class: model.class_name(event.class).to_owned(),
                actor: event.actor,
                repetition: event.repetitions.map(|r| r.count).filter(|_| is_one),
                deviation,
            });
        }
        for event in events.iter().filter(|e| e.phase == Phase::End) {
            self.news.push(event.class);
            self.seen.push(LiveDetection {
                class: model.class_name(event.class).to_owned(),
                actor: event.actor,
                span: event.span,
                reported_secs: event.reported_secs,
                score: event.score,
                repetitions: event.repetitions.map(|r| r.count),
            });
        }
    }

    /// The motion that seems to be under way with the performer who is watched: class and progress.
    pub fn early_detection(&self) -> Option<(String, EarlyDetection)> {
        let early = self.watched()?.early_detection()?;
        let model = self.model.as_ref()?;
        Some((model.class_name(early.class).to_owned(), early))
    }

    /// What is found of the performer who is watched; nothing of one who is gone.
    pub fn diagnosis(&self) -> Option<Diagnosis> {
        self.watched().filter(|w| !w.gone)?.diagnosis()
    }

    /// The clip that is the source: where it is and how long it is, seconds.
    pub fn position(&self) -> Option<(f64, f64)> {
        match &self.feed {
            Feed::Clip(feed) => Some(feed.position()),
            Feed::Thread(_) => None,
        }
    }

    /// Goes to a moment of the clip that is the source, seconds.
    pub fn seek(&mut self, secs: f64) {
        if let Feed::Clip(feed) = &mut self.feed {
            feed.seek(secs);
        }
    }

    /// Plays the clip that is the source at a multiple of the performance's speed.
    pub fn play_at(&mut self, speed: f64) {
        if let Feed::Clip(feed) = &mut self.feed {
            feed.speed = speed;
        }
    }

    /// See [`Live::next_change_secs`](super::Live::next_change_secs). A device wakes the window with each frame.
    pub fn next_change_secs(&self) -> Option<f64> {
        match &self.feed {
            _ if self.stopped => None,
            Feed::Clip(feed) => Some(feed.next_frame_secs()),
            // That the sender has stopped is said once.
            Feed::Thread(_) => (!self.ended && self.silent_secs <= LOST_SECS)
                .then_some(LOST_SECS - self.silent_secs + 0.01),
        }
    }

    /// Health of the stream for the index that recognises it, in sentences, each true if it is a fault.
    pub fn health(&self, index: Option<&MotionIndex>) -> Vec<(String, bool)> {
        let mut said = Vec::new();
        let nothing = self.performers.iter().all(|p| p.frames.is_empty());
        if self.stopped {
            let text = "Stopped: the last minutes can still be labelled";
            said.push((text.to_owned(), false));
        } else if self.ended {
            said.push(("The source has ended".to_owned(), true));
        } else if nothing {
            said.push((
                "No data has arrived yet: check that the sender is on and sends to this address"
                    .to_owned(),
                true,
            ));
        } else if self.silent_secs > LOST_SECS {
            let text =
                format!("No data has arrived for {LOST_SECS} s or longer: the sender has stopped");
            said.push((text, true));
        } else if self.watched().is_some_and(|w| w.gone) {
            said.push(match self.feed {
                Feed::Clip(_) => ("The clip has ended and begins again".to_owned(), false),
                Feed::Thread(_) => ("The watched performer has left".to_owned(), true),
            });
        }
        let counts = self.feed.counts();
        if counts.malformed > 0 {
            said.push((format!("{} packets cannot be read", counts.malformed), true));
        }
        said.extend(self.noticed.iter().rev().map(|text| (text.clone(), true)));
        if let Some(diagnosis) = self.diagnosis() {
            let misfit = index.and_then(|index| index.misfit(&diagnosis));
            said.extend(misfit.map(|(_, text)| (crate::store::sentence(&text), true)));
            for finding in diagnosis.findings().iter() {
                said.push((
                    crate::store::sentence(&finding.to_string()),
                    finding.severity() != Severity::Info,
                ));
            }
        }
        said
    }
}
