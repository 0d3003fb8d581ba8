//! The state of the eight calls, and the order in which they may be called.

use std::collections::VecDeque;
use std::ffi::c_char;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Duration;

use morec::import::Take;
use morec::index::MotionIndex;
use morec::live::{Event, EventReader, OverflowPolicy, Phase, Recognizer, Session, SessionOptions};

use super::clips;
use super::player::{Control, SourcePlayer};
use super::segment::{MotionSeg, NAME_BYTES};
use crate::MorecStatus;
use crate::index;
use crate::status::CallError;

/// Motions that are kept in the solution.
const KEPT: usize = 16_384;

/// Everything there is between `mrInit` and `mrTerminate`.
pub(super) struct ThesisState {
    index: Option<MotionIndex>,
    source: Option<SourceClip>,
    run: Option<RunningSession>,
    solution: VecDeque<MotionSeg>,
    found: u64,
    speed: f64,
}

struct SourceClip {
    take: Arc<Take>,
    control: Arc<Control>,
}

/// A recognition under way.
struct RunningSession {
    session: Session,
    events: EventReader,
    rate_hz: f64,
    /// Of the source it recognises.
    control: Arc<Control>,
}

fn out_of_order(text: &str) -> CallError {
    CallError::new(MorecStatus::WrongOrder, text)
}

impl ThesisState {
    pub(super) const fn new() -> Self {
        Self {
            index: None,
            source: None,
            run: None,
            solution: VecDeque::new(),
            found: 0,
            speed: 1.0,
        }
    }

    pub(super) fn init(&mut self, path: &Path) -> Result<(), CallError> {
        if self.index.is_some() {
            return Err(out_of_order(
                "an index is loaded already: call mrTerminate first",
            ));
        }
        self.index = Some(index::load(path)?);
        Ok(())
    }

    pub(super) fn terminate(&mut self) {
        // What a session still holds is not asked for: dropping it ends it.
        *self = Self::new();
    }

    pub(super) fn set_source(&mut self, path: &Path) -> Result<(), CallError> {
        let index = self
            .index
            .as_ref()
            .ok_or_else(|| out_of_order("call mrInit first"))?;
        if self.source.is_some() {
            return Err(out_of_order(
                "a data source is set already: call mrStopDataSource first",
            ));
        }
        if self.run.is_some() {
            return Err(out_of_order(
                "recognition of another data source is running: call mrStop first",
            ));
        }
        let take = Arc::new(clips::load(path, index)?);
        self.source = Some(SourceClip {
            take,
            control: Arc::new(Control::new(self.speed)),
        });
        Ok(())
    }

    pub(super) fn set_speed(&mut self, speed: f64) -> Result<(), CallError> {
        if speed.is_nan() || speed <= 0.0 {
            return Err(CallError::invalid(format!(
                "speed is {speed}, expected more than 0"
            )));
        }
        self.speed = speed;
        if let Some(source) = &self.source {
            source.control.set_speed(speed);
        }
        Ok(())
    }

    pub(super) fn stop_source(&mut self) -> Result<(), CallError> {
        if self.source.take().is_none() {
            return Err(out_of_order(
                "no data source is set: call mrSetDataSource first",
            ));
        }
        if let Some(run) = &self.run {
            run.control.stop.store(true, Relaxed);
        }
        // A source that waits for recognition, which waits for its events to be read, would not hear of it.
        while self
            .run
            .as_ref()
            .is_some_and(|run| !run.control.depleted.load(Relaxed))
        {
            self.read();
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(())
    }

    pub(super) fn is_depleted(&mut self) -> bool {
        self.read();
        self.source
            .as_ref()
            .is_none_or(|source| source.control.depleted.load(Relaxed))
    }

    pub(super) fn start(&mut self) -> Result<(), CallError> {
        let index = self
            .index
            .as_ref()
            .ok_or_else(|| out_of_order("call mrInit first"))?;
        if self.run.is_some() {
            return Err(out_of_order(
                "recognition is running already: call mrStop first",
            ));
        }
        let Some(source) = &mut self.source else {
            return Err(out_of_order(
                "no data source is set: call mrSetDataSource first",
            ));
        };
        Recognizer::new(&index.model, source.take.bones())
            .map_err(|error| CallError::new(MorecStatus::NothingInCommon, error.to_string()))?;
        let control = Arc::new(Control::new(self.speed));
        source.control = control.clone();
        let options = SessionOptions {
            overload: OverflowPolicy::Wait,
            ..Default::default()
        };
        let player = Box::new(SourcePlayer::new(&source.take, &control));
        let started = Session::start(&index.model, player, &options);
        let (session, readers) =
            started.map_err(|error| CallError::new(MorecStatus::Internal, error.to_string()))?;
        let Some(events) = readers.into_iter().next() else {
            return Err(MorecStatus::Internal.into());
        };
        (self.solution, self.found) = (VecDeque::new(), 0);
        self.run = Some(RunningSession {
            session,
            events,
            rate_hz: source.take.clip.rate_hz,
            control,
        });
        Ok(())
    }

    pub(super) fn stop(&mut self) -> Result<(), CallError> {
        let Some(run) = &self.run else {
            return Err(out_of_order(
                "recognition is not running: call mrStart first",
            ));
        };
        run.control.stop.store(true, Relaxed);
        while self.run.as_ref().is_some_and(|run| !run.events.is_ended()) {
            self.read();
            std::thread::sleep(Duration::from_millis(1));
        }
        if let Some(run) = self.run.take() {
            run.session.join();
        }
        Ok(())
    }

    /// The motions so far, the oldest first.
    pub(super) fn solution(&mut self) -> Result<&VecDeque<MotionSeg>, CallError> {
        if self.index.is_none() {
            return Err(out_of_order("call mrInit first"));
        }
        self.read();
        Ok(&self.solution)
    }

    /// Takes up what recognition has said meanwhile.
    fn read(&mut self) {
        let (Some(run), Some(index)) = (&mut self.run, &self.index) else {
            return;
        };
        while let Some(event) = run.events.pop() {
            if event.phase != Phase::End {
                continue;
            }
            self.found += 1;
            if self.solution.len() == KEPT {
                self.solution.pop_front();
            }
            let name = index
                .model
                .classes()
                .get(event.class.index())
                .map_or("", |class| &class.name);
            self.solution
                .push_back(segment(self.found, &event, name, run.rate_hz));
        }
    }
}

fn segment(number: u64, event: &Event, name: &str, rate_hz: f64) -> MotionSeg {
    let frame = |secs: f64| (secs * rate_hz).round() as u32;
    let fits = (0..NAME_BYTES.min(name.len() + 1))
        .rev()
        .find(|&end| name.is_char_boundary(end))
        .unwrap_or(0);
    let mut class_name = [0; NAME_BYTES];
    for (to, from) in class_name.iter_mut().zip(&name.as_bytes()[..fits]) {
        *to = *from as c_char;
    }
    MotionSeg {
        number,
        class_id: u32::from(event.class.0),
        start_frame: frame(event.span.start_secs),
        stop_frame: frame(event.span.stop_secs),
        class_name_bytes: fits as u32,
        start_secs: event.span.start_secs,
        stop_secs: event.span.stop_secs,
        confidence: event.score,
        class_name,
    }
}
