//! `morec live`: recognises performers in front of a tracker and sends events to other programs.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use morec::index::MotionIndex;
use morec::live::{EventReader, Session, SessionOptions, Status, StatusHandle};

use super::recognize::open_index;
use crate::interrupt::stop_on_ctrl_c;
use crate::live::layout::LayoutArg;
use crate::live::on::{ClassCommands, OnClass};
use crate::live::open::TrackerArgs;
use crate::live::sinks::{CountedSink, show_classes};
use crate::live::status::StatusLine;
use crate::live::takes::secs;
use morec_live::{Address, Advice, NamedEvent, Notices, WebcamPage, advice_of_status, summary};
use morec_ops::StreamSettings;

/// Recognise motions live, from a tracker to an event.
///
/// Each line of JSON is one pose:
///   {"t": 1.25, "positions": {"hips": [0, 0.92, 0], "left_hand": [0.7, 1.4, 0]}}
/// t is in seconds; axes are right-handed, Y up; lengths have any unit. Body
/// parts are hips, torso, neck, head, and left_ and right_ thigh, shin, foot,
/// shoulder, arm, forearm, hand. Each is given at its near end: thigh at the hip
/// joint, shin at the knee, foot at the ankle, arm at the shoulder joint,
/// forearm at the elbow, hand at the wrist.
///
/// Each recognised motion gives an end event with score, start and stop, which
/// is never revoked. With --tentative, a start event and updates with the
/// progress come before it; if the motion is not confirmed, a cancel event comes
/// instead of the end. With --each-repetition, an activity also gives an event,
/// with start and stop, for each completed repetition. Ctrl-C ends the session.
#[derive(clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Sources (--listen):
  vmc://127.0.0.1:39539      VMC senders on this UDP port, several performers
  axis://127.0.0.1:7001      BVH broadcast of Axis Neuron, Axis Studio
                             (axis+udp:// listens)
  json:-                     poses as lines of JSON on standard input
  json+tcp://127.0.0.1:9000  the same over TCP connections
  webcam                     this machine's camera, by a page in the browser
                             (webcam://127.0.0.1:8000 does not open the page)
  clip://FILE                a clip; ?speed=4 (0: as fast as possible),
                             ?loop, ?loss=0.05, ?jitter=20,
                             ?rate=30 of a table

Sinks (--emit):
  terminal:-                 a line for each motion (the default)
  json:- or json:FILE        a JSON object for each event
  osc://HOST:PORT            /morec/event and /VMC/Thru/morec/event
  ws://HOST:PORT             every WebSocket that connects

Exit codes: 0 ended by Ctrl-C, --for or the end of every source; 1 an address
cannot be opened, or json:FILE lacks events; 2 wrong command line.

Without a tracker, in two terminals:
  morec live demo.index --listen vmc://127.0.0.1:39539
  morec send new/person_06.bvh --to vmc://127.0.0.1:39539"
)]
pub struct Args {
    /// Index file of `morec train`
    index: PathBuf,
    #[command(flatten)]
    stream: StreamSettings,
    /// Source of poses; can be repeated
    #[arg(long, required = true, value_name = "SOURCE")]
    listen: Vec<Address>,
    /// Sink of events; can be repeated [default: terminal:-]
    #[arg(long, value_name = "SINK")]
    emit: Vec<Address>,
    /// Run a program when a motion of a class ends; can be repeated
    ///
    /// A program with its arguments, without a shell. MOREC_CLASS, MOREC_PHASE, MOREC_SCORE, MOREC_START and MOREC_STOP
    /// (seconds) are in its environment.
    #[arg(long, value_name = "CLASS=COMMAND")]
    on: Vec<OnClass>,
    #[command(flatten)]
    tracker: TrackerArgs,
    /// Threads of recognition; detections are the same
    #[arg(hide_short_help = true, long, value_enum, default_value = "inline")]
    layout: LayoutArg,
    /// End after N seconds
    #[arg(long = "for", value_name = "SECS", value_parser = secs)]
    secs: Option<f64>,
    /// No status line
    #[arg(long)]
    quiet: bool,
}

/// A session, its source's name and its events.
struct Listening {
    name: String,
    session: Session,
    reader: EventReader,
    notices: Notices,
    page: Option<WebcamPage>,
}

/// Interval at which the pages of webcams show faults of their streams.
const TELL_EVERY: Duration = Duration::from_secs(1);

impl Listening {
    /// Shows faults of the stream on the page of the camera.
    fn show_problems(&self, status: &Status, index: &MotionIndex) {
        let Some(page) = &self.page else { return };
        let diagnosed = status.actors.iter().filter_map(|actor| actor.diagnosis);
        let sentences = diagnosed.flat_map(|diagnosis| index.findings(&diagnosis));
        page.problems(&sentences.collect::<Vec<_>>());
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut index = open_index(&args.index)?;
    index.model = args.stream.options().tuned(index.model)?;
    let mut outlets = match args.emit.as_slice() {
        [] => vec![CountedSink::open(
            &"terminal:-".parse().map_err(anyhow::Error::msg)?,
        )?],
        emit => emit.iter().map(CountedSink::open).collect::<Result<_>>()?,
    };
    let mut commands = ClassCommands::new(&args.on, &index)?;
    let mut listening: Vec<Listening> = args
        .listen
        .iter()
        .map(|address| listen(address, &index, args, &mut outlets))
        .collect::<Result<_>>()?;
    let stop = stop_on_ctrl_c()?;
    let handles: Vec<StatusHandle> = listening.iter().map(|l| l.session.handle()).collect();
    let begun = Instant::now();
    let mut line = StatusLine::new(args.quiet);
    let (mut dropped, mut told) = (0, begun);
    let mut advice = Advice::new(listening.iter().map(|l| l.name.clone()));
    let over = |secs: f64| begun.elapsed().as_secs_f64() >= secs;
    // One source can wait for its events; several are looked at in turn.
    let nap = Duration::from_millis(if listening.len() == 1 { 50 } else { 2 });
    while !stop.load(Ordering::Relaxed) && !args.secs.is_some_and(over) {
        let mut ended = true;
        for source in &mut listening {
            if let Some(event) = source.reader.wait(nap) {
                let class = index.model.class_name(event.class);
                let said = NamedEvent {
                    event: &event,
                    class,
                    source: &source.name,
                };
                tell(&said, &mut outlets, &mut commands, &mut line)?;
            }
            ended &= source.reader.is_ended();
            complain(&source.name, &source.notices, &mut line);
        }
        if ended {
            break;
        }
        let statuses: Vec<Status> = handles.iter().map(StatusHandle::get).collect();
        if told.elapsed() >= TELL_EVERY {
            told = Instant::now();
            for (source, status) in listening.iter().zip(&statuses) {
                source.show_problems(status, &index);
            }
        }
        if !args.quiet {
            for text in advice.look(&statuses, &index) {
                line.clear();
                eprintln!("morec: {text}");
            }
        }
        line.draw(&statuses, index.model.classes());
    }
    line.clear();
    for mut source in listening {
        let status = source.session.stop();
        // What the last moments held.
        while let Some(event) = source.reader.pop() {
            let class = index.model.class_name(event.class);
            tell(
                &NamedEvent {
                    event: &event,
                    class,
                    source: &source.name,
                },
                &mut outlets,
                &mut commands,
                &mut line,
            )?;
        }
        complain(&source.name, &source.notices, &mut line);
        dropped += status.dropped_events;
        eprintln!("morec: {}", summary(&source.name, &status));
        advice_of_status(&status, &index)
            .iter()
            .for_each(|text| eprintln!("morec:   {text}"));
    }
    outlets
        .iter()
        .filter_map(CountedSink::farewell)
        .for_each(|text| eprintln!("morec: {text}"));
    Ok(match outlets.iter().any(|o| o.is_incomplete(dropped)) {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    })
}

fn tell(
    said: &NamedEvent,
    outlets: &mut [CountedSink],
    commands: &mut ClassCommands,
    line: &mut StatusLine,
) -> Result<()> {
    if said.is_final() {
        line.clear();
    }
    for failure in commands.run(said) {
        line.clear();
        eprintln!("morec: {failure}");
    }
    for outlet in outlets {
        if let Some(failure) = outlet.emit(said)? {
            line.clear();
            eprintln!("morec: {failure}");
        }
    }
    Ok(())
}

/// Says what the source has found wrong with what it was sent.
fn complain(source: &str, notices: &Notices, line: &mut StatusLine) {
    for text in notices.take() {
        line.clear();
        eprintln!("morec: {source}: {text}");
    }
}

/// Opens a source and a session. A page that it serves becomes an outlet.
fn listen(
    address: &Address,
    index: &MotionIndex,
    args: &Args,
    outlets: &mut Vec<CountedSink>,
) -> Result<Listening> {
    let opened = args.tracker.open(address, Some(index))?;
    if let Some(page) = &opened.page {
        show_classes(page, index);
        outlets.push(CountedSink::page(address, page));
    }
    let session_options = SessionOptions {
        events: args.stream.options().events()?,
        overload: opened.overload,
        ..args.layout.options()
    };
    let (session, readers) = Session::start(&index.model, opened.source, &session_options)?;
    let reader = readers
        .into_iter()
        .next()
        .context("a session has a reader")?;
    Ok(Listening {
        name: opened.name,
        session,
        reader,
        notices: opened.notices,
        page: opened.page,
    })
}
