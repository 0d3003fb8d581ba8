//! `morec teach`: teaches gestures live by performing them.

mod lesson;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use morec::index::MotionIndex;
use morec::live::{Event, EventOptions, MAX_PERFORMERS, Performer, PerformerId, SourceEvent};

use crate::interrupt::stop_on_ctrl_c;
use crate::live::open::TrackerArgs;
use crate::live::sinks::{CountedSink, show_classes};
use crate::live::takes::{Ended, TakeArgs, TakeRecorder, secs};
use lesson::Lessons;
use morec_live::{Address, NamedEvent, WebcamPage};

/// Teach gestures live: name one, perform it three times, see it recognised.
///
/// Type a name and press Enter. Each repetition begins after a countdown and a bell and lasts --secs seconds, or until
/// Enter. Then the index is retrained with all gestures taught so far, and detections are shown until you type the next name. An
/// empty name or Ctrl-C ends.
///
/// The takes are BVH files in a folder beside the index (gestures.index: gestures.takes/), with labels.tsv: remove bad
/// ones, or train from them (morec train --clips gestures.takes --labels gestures.takes/labels.tsv). Sources (--listen)
/// are those of `morec live`.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 ended by an empty name, Ctrl-C, --for or the end of the source; 1 opening, writing or training \
        failed; 2 wrong command line.\n\n\
    Example: morec teach gestures.index --listen vmc://127.0.0.1:39539"
)]
pub struct Args {
    /// Index to teach; created if it does not exist
    index: PathBuf,
    /// Source of poses, as in `morec live`
    #[arg(long, value_name = "SOURCE")]
    listen: Address,
    /// Teach gestures of these names, without asking
    #[arg(long = "name", value_name = "NAME", value_parser = gesture_name)]
    names: Vec<String>,
    /// Repetitions of each gesture
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u32).range(1..=99))]
    repetitions: u32,
    /// Longest repetition, seconds
    #[arg(long, value_name = "SECS", default_value = "3", value_parser = secs)]
    secs: f64,
    /// Sink of events, as in `morec live` [default: terminal:-]
    #[arg(long, value_name = "SINK")]
    emit: Vec<Address>,
    /// End after N seconds
    #[arg(long = "for", value_name = "SECS", value_parser = secs)]
    until: Option<f64>,
    #[command(flatten)]
    take: TakeArgs,
    #[command(flatten)]
    tracker: TrackerArgs,
}

/// A name that can stand in a table of labels and in a file's name.
fn gesture_name(text: &str) -> Result<String, String> {
    let name = text.trim();
    let fits = |c: char| c.is_alphanumeric() || "_- ".contains(c);
    if !name.is_empty() && name.chars().count() <= 60 && name.chars().all(fits) {
        return Ok(name.replace(' ', "_"));
    }
    Err("expected a name of letters, digits, blanks, _ and -, at most 60 of them".to_owned())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut lessons = Lessons::open(&args.index)?;
    let opened = args.tracker.open(&args.listen, None)?;
    let mut watch = Watch::new(args, lessons.index(), opened.page.clone())?;
    let mut stage = TakeRecorder::new(opened, &args.take, stop_on_ctrl_c()?);
    stage.check_end(Some(args.secs))?;
    let begun = Instant::now();
    let mut names = args.names.iter();
    let asks = args.names.is_empty();
    if asks {
        ask();
    }
    while !stage.is_over()
        && !args
            .until
            .is_some_and(|s| begun.elapsed().as_secs_f64() >= s)
    {
        let name = match names.next() {
            Some(name) => Some(name.clone()),
            None if asks => match stage.typed() {
                Some(line) if line.trim().is_empty() => break,
                Some(line) => match gesture_name(&line) {
                    Ok(name) => Some(name),
                    Err(error) => {
                        eprintln!("morec: {error}");
                        None
                    }
                },
                None => None,
            },
            None => None,
        };
        if let Some(name) = name {
            if teach(&name, args, &mut stage, &mut lessons)? {
                watch.begin(lessons.index());
            }
            if asks {
                ask();
            }
        }
        watch.step(&mut stage, lessons.index())?;
    }
    watch.finish(lessons.index(), stage.name())?;
    eprintln!("morec: {}", lessons.summary());
    Ok(ExitCode::SUCCESS)
}

fn ask() {
    eprintln!("morec: name of the gesture, then Enter (Enter alone ends)");
}

/// Records the repetitions and trains; says whether there is a new index.
fn teach(name: &str, args: &Args, stage: &mut TakeRecorder, lessons: &mut Lessons) -> Result<bool> {
    let mut kept = 0;
    for number in 1..=args.repetitions {
        let what = format!("{name}, {number} of {}", args.repetitions);
        let (recording, ended) = stage.take(&what, Some(args.secs));
        // Half a gesture is a bad example.
        let whole = recording.filter(|_| ended != Ended::Stopped);
        match whole {
            Some(recording) => {
                let file = lessons.keep(name, &recording)?;
                kept += 1;
                eprintln!("morec: {}: {:.1} s", file.display(), recording.secs());
                super::record::warn(&recording);
            }
            None => eprintln!("morec: {what}: not recorded"),
        }
        if stage.is_over() {
            break;
        }
    }
    if kept == 0 {
        return Ok(false);
    }
    match lessons.train() {
        Ok(report) => eprintln!("morec: {report}"),
        // What was performed is kept, and more of it may help.
        Err(error) => {
            eprintln!("morec: cannot train yet: {error:#}");
            return Ok(false);
        }
    }
    Ok(true)
}

/// Recognition between lessons.
struct Watch {
    outlets: Vec<CountedSink>,
    performers: Vec<Performer>,
    events: Vec<Event>,
    sequence: u64,
    page: Option<WebcamPage>,
}

impl Watch {
    fn new(args: &Args, index: Option<&MotionIndex>, page: Option<WebcamPage>) -> Result<Self> {
        let terminal = ["terminal:-".parse().map_err(anyhow::Error::msg)?];
        let emit = if args.emit.is_empty() {
            &terminal[..]
        } else {
            &args.emit
        };
        let outlets = emit.iter().map(CountedSink::open);
        let shown = page
            .iter()
            .map(|page| Ok(CountedSink::page(&args.listen, page)));
        let mut watch = Self {
            outlets: outlets.chain(shown).collect::<Result<_>>()?,
            performers: Vec::new(),
            events: Vec::new(),
            sequence: 0,
            page,
        };
        watch.begin(index);
        Ok(watch)
    }

    /// Recognises what `index` knows from now on.
    fn begin(&mut self, index: Option<&MotionIndex>) {
        let options = EventOptions {
            tentative: true,
            ..EventOptions::default()
        };
        self.performers = index.map_or_else(Vec::new, |index| {
            let performer = |actor| Performer::new(&index.model, PerformerId(actor), &options);
            (0..MAX_PERFORMERS as u16).map(performer).collect()
        });
        if let Some((page, index)) = self.page.as_ref().zip(index) {
            show_classes(page, index);
        }
    }

    /// Takes the next thing the source has.
    fn step(&mut self, stage: &mut TakeRecorder, index: Option<&MotionIndex>) -> Result<()> {
        let known = stage.rig().cloned();
        let watched = stage.actor();
        let (next, frame) = stage.next();
        let events = &mut self.events;
        match next {
            SourceEvent::Frame => {
                if let Some(performer) = self.performers.get_mut(frame.actor.index()) {
                    // The skeleton came while this performer's gestures were recorded.
                    let missed = performer.diagnosis().is_none() && frame.actor == watched;
                    if let Some(rig) = known.filter(|_| missed) {
                        events.extend_from_slice(performer.set_rig(&rig));
                    }
                    events.extend_from_slice(performer.push(frame));
                }
            }
            SourceEvent::Rig(actor, rig) => {
                if let Some(performer) = self.performers.get_mut(actor.index()) {
                    events.extend_from_slice(performer.set_rig(&rig));
                }
            }
            SourceEvent::Gone(actor) => {
                if let Some(performer) = self.performers.get_mut(actor.index()) {
                    events.extend_from_slice(performer.finish());
                }
            }
            SourceEvent::Quiet | SourceEvent::Ended => {}
        }
        self.tell(index, stage.name())
    }

    fn finish(&mut self, index: Option<&MotionIndex>, source: &str) -> Result<()> {
        for performer in &mut self.performers {
            self.events.extend_from_slice(performer.finish());
        }
        self.tell(index, source)
    }

    fn tell(&mut self, index: Option<&MotionIndex>, source: &str) -> Result<()> {
        let Some(index) = index else { return Ok(()) };
        for mut event in self.events.drain(..) {
            self.sequence += 1;
            event.sequence = self.sequence;
            let said = NamedEvent {
                event: &event,
                class: index.model.class_name(event.class),
                source,
            };
            for outlet in &mut self.outlets {
                if let Some(failure) = outlet.emit(&said)? {
                    eprintln!("morec: {failure}");
                }
            }
        }
        Ok(())
    }
}
