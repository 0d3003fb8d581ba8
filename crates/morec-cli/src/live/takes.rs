//! Takes: countdown, bell, recording, bell.

use std::io::{BufRead, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;

use anyhow::{Result, bail};
use morec::diagnosis::{Diagnoser, Severity};
use morec::live::{Frame, MAX_PERFORMERS, PerformerId, Recording, Rig, SourceEvent};

use morec_live::{OpenSource, WebcamPage};

/// Shorter takes are discarded, seconds.
pub const SHORTEST_SECS: f64 = 0.3;
/// Interval at which the page of a webcam shows faults of the stream.
const TELL_EVERY_SECS: f64 = 1.0;

/// Options of takes.
#[derive(clap::Args, Debug)]
pub struct TakeArgs {
    /// Countdown before each take, seconds
    #[arg(long, value_name = "SECS", default_value = "3", value_parser = secs)]
    pub count_down: f64,
    /// Number of the performer, from 0
    #[arg(hide_short_help = true, long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u16).range(..MAX_PERFORMERS as i64))]
    pub actor: u16,
    /// No bell at the start and end of a take
    #[arg(long)]
    pub no_bell: bool,
}

/// Seconds as they are typed, 0 or more.
pub fn secs(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(secs) if (0.0..=1e9).contains(&secs) => Ok(secs),
        _ => Err("expected seconds, 0 or more".to_owned()),
    }
}

/// Reason for the end of a take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// Its time was over.
    Time,
    /// Somebody pressed Enter.
    Key,
    /// The performer has gone, or another skeleton has come.
    Gone,
    /// The source has ended.
    Source,
    /// Ctrl-C.
    Stopped,
}

/// Faults of the performer's stream, for the page of a webcam.
struct ShownProblems {
    page: WebcamPage,
    diagnoser: Diagnoser,
    /// Time of the last message to the page, seconds of stream.
    told_secs: f64,
}

impl ShownProblems {
    fn new(page: WebcamPage) -> Self {
        Self {
            page,
            diagnoser: Diagnoser::live(),
            told_secs: 0.0,
        }
    }

    fn push(&mut self, frame: &Frame, rig: &Rig) {
        let pose = frame.key_pose(rig);
        self.diagnoser.push(frame.time_secs, frame.wall_secs, &pose);
        if (frame.time_secs - self.told_secs).abs() < TELL_EVERY_SECS {
            return;
        }
        self.told_secs = frame.time_secs;
        let findings = self.diagnoser.diagnosis().findings();
        let wrong = findings
            .iter()
            .filter(|finding| finding.severity() >= Severity::Warning);
        let sentences: Vec<String> = wrong.map(ToString::to_string).collect();
        self.page.problems(&sentences);
    }
}

/// A source before which somebody performs.
pub struct TakeRecorder {
    opened: OpenSource,
    problems: Option<ShownProblems>,
    actor: PerformerId,
    bell: bool,
    count_down_secs: f64,
    stop: Arc<AtomicBool>,
    rig: Option<Arc<Rig>>,
    frame: Frame,
    ended: bool,
    keys: Option<Receiver<String>>,
}

impl TakeRecorder {
    /// Before `opened`. `stop` is set when somebody wants it all to end.
    pub fn new(opened: OpenSource, args: &TakeArgs, stop: Arc<AtomicBool>) -> Self {
        // Poses on standard input leave no room for anybody's words.
        let keys = (!opened.name.starts_with("json:")).then(typed);
        Self {
            problems: opened.page.clone().map(ShownProblems::new),
            opened,
            actor: PerformerId(args.actor),
            bell: !args.no_bell,
            count_down_secs: args.count_down,
            stop,
            rig: None,
            frame: Frame::default(),
            ended: false,
            keys,
        }
    }

    /// True if nothing more will come, or is wanted.
    pub fn is_over(&self) -> bool {
        self.ended || self.stop.load(Ordering::Relaxed)
    }

    /// True if somebody can type something.
    pub fn has_keys(&self) -> bool {
        self.keys.is_some()
    }

    /// The line that was typed last, if one was. `None` for ever once input has ended.
    pub fn typed(&mut self) -> Option<String> {
        match self.keys.as_ref()?.try_recv() {
            Ok(line) => Some(line),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.keys = None;
                None
            }
        }
    }

    /// The next thing that the source has, of whichever performer, and the frame if it is one.
    pub fn next(&mut self) -> (SourceEvent, &Frame) {
        let next = self.opened.source.next(&mut self.frame);
        match &next {
            SourceEvent::Rig(actor, rig) if *actor == self.actor => self.rig = Some(rig.clone()),
            SourceEvent::Frame if self.frame.actor == self.actor => {
                if let Some((problems, rig)) = self.problems.as_mut().zip(self.rig.as_deref()) {
                    problems.push(&self.frame, rig);
                }
            }
            SourceEvent::Ended => self.ended = true,
            _ => {}
        }
        for text in self.opened.notices.take() {
            eprintln!("morec: {}: {text}", self.opened.name);
        }
        (next, &self.frame)
    }

    /// The skeleton of the performer who is watched.
    pub fn rig(&self) -> Option<&Arc<Rig>> {
        self.rig.as_ref()
    }

    /// The performer that is watched.
    pub fn actor(&self) -> PerformerId {
        self.actor
    }

    /// Name of the source.
    pub fn name(&self) -> &str {
        &self.opened.name
    }

    /// Says a text large where the performer looks.
    fn show(&self, text: &str) {
        if let Some(page) = &self.opened.page {
            page.say(text);
        }
    }

    /// Counts down. Time passes as fast as the clock on the wall or as the stream, whichever is faster: a file has no
    /// need to wait.
    fn count_down(&mut self, what: &str) {
        let (begun, mut first_secs) = (Instant::now(), None);
        let mut said = f64::INFINITY;
        while !self.is_over() {
            let streamed = first_secs.map_or(0.0, |first: f64| self.frame.time_secs - first);
            let left = self.count_down_secs - streamed.max(begun.elapsed().as_secs_f64());
            if left <= 0.0 {
                return;
            }
            if left.ceil() < said {
                said = left.ceil();
                eprintln!("morec: {what} in {said} …");
                self.show(&said.to_string());
            }
            let actor = self.actor;
            if let (SourceEvent::Frame, frame) = self.next()
                && frame.actor == actor
                && first_secs.is_none()
            {
                first_secs = Some(frame.time_secs);
            }
        }
    }

    /// Counts down and records until `secs` of stream have passed, if that is said, or one of the other ends of a take.
    /// `None` if there was nothing to record before the end.
    pub fn take(&mut self, what: &str, secs: Option<f64>) -> (Option<Recording>, Ended) {
        self.count_down(what);
        // What was typed before does not end it.
        while self.typed().is_some() {}
        self.ring();
        eprintln!("morec: {what}: go!");
        self.show(what);
        let (recording, ended) = self.record(secs);
        self.ring();
        self.show("");
        let recording = recording.filter(|recording| recording.secs() >= SHORTEST_SECS);
        (recording, ended)
    }

    fn record(&mut self, secs: Option<f64>) -> (Option<Recording>, Ended) {
        let actor = self.actor;
        let mut recording = self.rig.as_ref().map(Recording::new);
        loop {
            if self.stop.load(Ordering::Relaxed) {
                return (recording, Ended::Stopped);
            }
            if self.typed().is_some() {
                return (recording, Ended::Key);
            }
            match self.next() {
                (SourceEvent::Frame, frame) if frame.actor == actor => {
                    if let Some(recording) = &mut recording {
                        recording.push(frame);
                    }
                }
                (SourceEvent::Rig(of, rig), _) if of == actor => {
                    let known = recording.get_or_insert_with(|| Recording::new(&rig));
                    if !known.set_rig(&rig) {
                        return (recording, Ended::Gone);
                    }
                }
                (SourceEvent::Gone(of), _)
                    if of == actor
                        && recording.as_ref().is_some_and(|r| !r.frames().is_empty()) =>
                {
                    return (recording, Ended::Gone);
                }
                (SourceEvent::Ended, _) => return (recording, Ended::Source),
                _ => {}
            }
            let passed = recording.as_ref().map_or(0.0, Recording::secs);
            if secs.is_some_and(|secs| passed >= secs) {
                return (recording, Ended::Time);
            }
        }
    }

    fn ring(&self) {
        if self.bell {
            let mut out = std::io::stderr();
            // If nobody hears it, nothing is lost.
            let _ = out.write_all(b"\x07").and_then(|()| out.flush());
        }
    }

    /// Fails if there is no way to say when a take is over.
    pub fn check_end(&self, secs: Option<f64>) -> Result<()> {
        if secs.is_none() && self.has_keys() && !std::io::stdin().is_terminal() {
            // Takes end with the source or with Ctrl-C.
            return Ok(());
        }
        if secs == Some(0.0) {
            bail!("--secs 0: expected more");
        }
        Ok(())
    }
}

/// Lines of standard input, as they are typed.
fn typed() -> Receiver<String> {
    let (sender, lines) = channel();
    let job = move || {
        for line in std::io::stdin().lock().lines() {
            let Ok(line) = line else { return };
            if sender.send(line).is_err() {
                return;
            }
        }
    };
    // Out of threads: nobody can type anything, and --secs or Ctrl-C end a take.
    let _ = std::thread::Builder::new()
        .name("what is typed".to_owned())
        .spawn(job);
    lines
}
