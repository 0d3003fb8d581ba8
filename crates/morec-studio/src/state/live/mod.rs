//! A live stream: who performs, what is recognised, what is taught from what just happened.

mod feed;
mod looking;
mod marked;
mod moved;
mod run;
mod tracked;

use std::collections::BTreeMap;
use std::sync::Arc;

use morec::TimeSpan;
use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::live::{Detection, Model, PerformerId, Recording};
use morec::math::Vec3;
use morec_db::ClipId;
use morec_ops::RecognizeSettings;

pub use feed::{ClipFeed, Feed, ThreadFeed};

pub use looking::{Looking, SPANS};
pub use marked::{LiveMark, labelled_there};
pub use run::{Forgot, LiveDetection, LiveDeviation, Run};

/// While seconds are counted down, the window is drawn so often, seconds.
const COUNTED_SECS: f64 = 0.1;

/// Choice of a source.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// A clip of the database.
    Clip(Option<ClipId>),
    /// `vmc://…`, `axis://…`, `json+tcp://…`.
    Network(String),
}

/// Detections in the recorded minutes with other settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Resensed {
    pub settings: RecognizeSettings,
    pub found: Vec<Detection>,
}

/// A stretch that was marked as background, and the poses around it, with their times.
#[derive(Debug, Clone)]
pub struct SilenceWanted {
    pub stretch: TimeSpan,
    pub poses: Vec<(f64, KeyPose)>,
}

/// The live panel's own state.
pub struct Live {
    pub choice: Choice,
    pub run: Option<Run>,
    /// A clip that starts once it is decoded.
    pub(super) starting: Option<ClipId>,
    pub(super) index: Option<Arc<MotionIndex>>,
    /// Speed at which a clip is played as a source, a multiple of the performance.
    pub speed: f64,
    /// How readily motions are reported, and for whom. An index that knows nothing of one of the two recognises as trained.
    pub settings: RecognizeSettings,
    /// A stretch of the stream that is selected, on its clock.
    pub range: Option<(f64, f64)>,
    /// The part of the last minutes that is in view.
    pub looking: Looking,
    /// Marked stretches.
    pub marks: Vec<LiveMark>,
    /// What other settings would have found in the recorded minutes.
    pub resensed: Option<Resensed>,
    /// The settings with which the recorded minutes are being tried.
    pub(super) trying: Option<RecognizeSettings>,
    /// Something that was marked is being kept.
    pub teaching: bool,
    /// What the next index shall be silent on.
    pub(super) checked: Option<SilenceWanted>,
    /// The index is to be trained anew once the mark is in the database.
    pub(super) retrain: bool,
    /// Seconds until a take begins.
    pub countdown: Option<f64>,
    pub take: Option<Recording>,
    /// Number of detections of each class.
    pub counts: BTreeMap<String, usize>,
    /// The performer for whom the camera stands as far off as it does.
    pub(super) framed: Option<PerformerId>,
}

impl Default for Live {
    fn default() -> Self {
        Self {
            choice: Choice::Clip(None),
            run: None,
            starting: None,
            index: None,
            speed: 1.0,
            settings: RecognizeSettings::default(),
            range: None,
            looking: Looking::default(),
            marks: Vec::new(),
            resensed: None,
            trying: None,
            teaching: false,
            checked: None,
            retrain: false,
            countdown: None,
            take: None,
            counts: BTreeMap::new(),
            framed: None,
        }
    }
}

/// Commands for the live panel.
#[derive(Debug, Clone, PartialEq)]
pub enum LiveCommand {
    Choose(Choice),
    Start,
    Stop,
    /// Goes to a moment of the clip that is the source, seconds.
    Seek(f64),
    /// Plays the clip that is the source at a multiple of the performance's speed.
    Speed(f64),
    /// How readily motions are reported, and for whom.
    Settings(RecognizeSettings),
    Range(Option<(f64, f64)>),
    /// Selects a stretch and brings it into view.
    GoTo(f64, f64),
    /// Shows this many seconds of the last minutes.
    Span(f64),
    /// Looks this many seconds back (negative) or on.
    Back(f64),
    /// The selected stretch, or the last motion, shows the class of this key.
    Mark(usize),
    /// Likewise, of this class.
    MarkAs(String),
    /// Likewise, none of the classes.
    MarkBackground,
    /// Watches another performer.
    Watch(PerformerId),
    /// Begins a take after a countdown, or ends it.
    Record,
}

impl Live {
    pub fn is_running(&self) -> bool {
        self.starting.is_some() || self.run.as_ref().is_some_and(Run::is_running)
    }

    /// Time until something that is shown changes without a word from the source, seconds.
    pub fn next_change_secs(&self) -> Option<f64> {
        let run = self.run.as_ref();
        let counting = self.countdown.map(|_| COUNTED_SECS);
        let changes = [run.and_then(Run::next_change_secs), counting];
        changes.into_iter().flatten().reduce(f64::min)
    }

    /// The stream's clock.
    pub fn now_secs(&self) -> f64 {
        self.run.as_ref().map_or(0.0, |run| run.now_secs)
    }

    pub fn centre(&self) -> Option<Vec3> {
        self.run.as_ref()?.watched()?.centre()
    }

    pub fn heading(&self) -> Option<f64> {
        let performer = self.run.as_ref()?.watched()?;
        performer.body.heading(&performer.pose)
    }

    /// The index with the settings that were chosen.
    pub(super) fn model(&self) -> Option<Model> {
        let model = self.index.as_ref()?.model.clone();
        self.used_settings().tuned(model).ok()
    }

    /// The settings that were chosen, as far as the index can be set.
    pub(super) fn used_settings(&self) -> RecognizeSettings {
        RecognizeSettings {
            sensitivity: self.settings.sensitivity.filter(|_| self.can_sense()),
            performer: self.settings.performer.filter(|_| self.knows_performers()),
        }
    }

    /// True if the sensitivity of the index can be changed.
    pub fn can_sense(&self) -> bool {
        let index = self.index.as_ref();
        index.is_some_and(|index| index.model.with_sensitivity(0.3).is_ok())
    }

    /// True if the index recognises people unlike its teacher in a way of their own.
    pub fn knows_performers(&self) -> bool {
        // Asked in every frame of the window: `Model::with_performer` would copy the model.
        let model = self.index.as_ref().map(|index| &index.model);
        matches!(model, Some(Model::Templates(model)) if model.stranger.is_some() || model.look.is_some())
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
        // Classes have other numbers in another index.
        self.resensed = None;
        self.trying = None;
        let model = self.model();
        if let (Some(run), Some(model)) = (&mut self.run, model) {
            run.recognise_with(&model);
        }
    }
}
