//! `morec live`: recognise whoever moves in front of a tracker, and tell others.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use morec::import::ImportOptions;
use morec::index::MotionIndex;
use morec::live::axis::AxisOptions;
use morec::live::vmc::VmcOptions;
use morec::live::{
    EventOptions, EventReader, MAX_ACTORS, Overload, Session, SessionOptions, Source, Status,
    StatusHandle,
};

use super::recognize::open_index;
use crate::files::mapping;
use crate::interrupt::stop_on_ctrl_c;
use crate::live::Said;
use crate::live::address::Address;
use crate::live::axis::{self, AxisSource};
use crate::live::clip::ClipSource;
use crate::live::json::JsonSource;
use crate::live::layout::LayoutArg;
use crate::live::sinks::Outlet;
use crate::live::status::{StatusLine, summary};
use crate::live::vmc::VmcSource;

/// Recognise motions live, from a tracker to an event.
///
/// Sources (--listen, several if you like):
///   vmc://127.0.0.1:39539   VMC senders on this UDP port, any number of performers
///   axis://127.0.0.1:7001   the BVH broadcast of Axis Neuron or Axis Studio at this address; axis+udp:// listens
///   json:-                  poses as lines of JSON on standard input
///   json+tcp://127.0.0.1:9000 the same from whoever connects
///   clip://FILE             a clip, in real time; ?speed=4 (0: as fast as it goes), ?loop, ?loss=0.05, ?jitter=20
///
/// Events go (--emit) to:
///   terminal:-              a line for each motion (the default)
///   json:- or json:FILE     a JSON object for each event
///   osc://HOST:PORT         /morec/event and /VMC/Thru/morec/event
///   ws://HOST:PORT          whoever connects there with a WebSocket
///
/// An event is a start (tentative), updates with progress (tentative), and then either an end (final, with score, start
/// and stop) or a cancellation. One motion ends once, and nothing that ended is taken back. Ctrl-C ends the session.
#[derive(clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "Exit codes: 0 ended by Ctrl-C, --for or the end of every source; 1 something cannot be opened; 2 wrong \
    command line.\n\n\
    Without a tracker, in two terminals:\n  \
    morec live demo.index --listen vmc://127.0.0.1:39539\n  \
    morec send new/person_06.bvh --to vmc://127.0.0.1:39539"
)]
pub struct Args {
    /// The index, as `morec train` writes it
    index: PathBuf,
    /// Where poses come from
    #[arg(long, required = true, value_name = "SOURCE")]
    listen: Vec<Address>,
    /// Where events go [default: terminal:-]
    #[arg(long, value_name = "SINK")]
    emit: Vec<Address>,
    /// Exchange left and right, for VMC senders that show their performer as a mirror would
    #[arg(long)]
    mirror: bool,
    /// Performers that one VMC port, or one broadcast, follows at once
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u16).range(1..=MAX_ACTORS as i64))]
    actors: u16,
    /// A BVH file of the program at axis://, for how bones hang together and how long they are [default: a person of
    /// 1.7 m]
    #[arg(long, value_name = "BVH")]
    skeleton: Option<PathBuf>,
    /// Recognise T-poses that are too exact to be a person's, too: else they are a sender's that lost its tracker
    #[arg(long)]
    keep_t_pose: bool,
    /// Do not tell a motion that ends within so many seconds of the last of its class
    #[arg(long, value_name = "SECS", default_value = "0", value_parser = secs)]
    refractory: f64,
    /// Tell motions at their end only
    #[arg(long)]
    no_early: bool,
    /// How recognition is laid out on threads; detections are the same
    #[arg(long, value_enum, default_value = "inline")]
    layout: LayoutArg,
    /// End after so many seconds
    #[arg(long = "for", value_name = "SECS", value_parser = secs)]
    secs: Option<f64>,
    /// No status line
    #[arg(long)]
    quiet: bool,
    /// Roles of joints of clips, where inference fails: lines of `role<TAB>joint name`
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
}

fn secs(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(secs) if (0.0..=1e9).contains(&secs) => Ok(secs),
        _ => Err("expected seconds, 0 or more".to_owned()),
    }
}

/// A session, its source's name and its events.
struct Listening {
    name: String,
    session: Session,
    reader: EventReader,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let index = open_index(&args.index)?;
    let mut outlets = match args.emit.as_slice() {
        [] => vec![Outlet::open(
            &"terminal:-".parse().map_err(anyhow::Error::msg)?,
        )?],
        emit => emit.iter().map(Outlet::open).collect::<Result<_>>()?,
    };
    let options = ImportOptions {
        mapping: mapping(args.roles.as_deref())?,
        ..ImportOptions::default()
    };
    let mut listening: Vec<Listening> = args
        .listen
        .iter()
        .map(|address| listen(address, &index, &options, args))
        .collect::<Result<_>>()?;
    let stop = stop_on_ctrl_c()?;
    let handles: Vec<StatusHandle> = listening.iter().map(|l| l.session.handle()).collect();
    let begun = Instant::now();
    let mut line = StatusLine::new(args.quiet);
    let over = |secs: f64| begun.elapsed().as_secs_f64() >= secs;
    // One source can wait for its events; several are looked at in turn.
    let nap = Duration::from_millis(if listening.len() == 1 { 50 } else { 2 });
    while !stop.load(Ordering::Relaxed) && !args.secs.is_some_and(over) {
        let mut ended = true;
        for source in &mut listening {
            if let Some(event) = source.reader.wait(nap) {
                let class = index.model.class_name(event.class);
                let said = Said {
                    event: &event,
                    class,
                    source: &source.name,
                };
                tell(&said, &mut outlets, &mut line)?;
            }
            ended &= source.reader.is_ended();
        }
        if ended {
            break;
        }
        let statuses: Vec<Status> = handles.iter().map(StatusHandle::get).collect();
        line.draw(&statuses, index.model.classes());
    }
    line.clear();
    for mut source in listening {
        let status = source.session.stop();
        // What the last moments held.
        while let Some(event) = source.reader.pop() {
            let class = index.model.class_name(event.class);
            tell(
                &Said {
                    event: &event,
                    class,
                    source: &source.name,
                },
                &mut outlets,
                &mut line,
            )?;
        }
        eprintln!("morec: {}", summary(&source.name, &status));
    }
    outlets
        .iter()
        .filter_map(Outlet::farewell)
        .for_each(|text| eprintln!("morec: {text}"));
    Ok(ExitCode::SUCCESS)
}

fn tell(said: &Said, outlets: &mut [Outlet], line: &mut StatusLine) -> Result<()> {
    if said.is_final() {
        line.clear();
    }
    for outlet in outlets {
        if let Some(failure) = outlet.tell(said)? {
            line.clear();
            eprintln!("morec: {failure}");
        }
    }
    Ok(())
}

fn listen(
    address: &Address,
    index: &MotionIndex,
    options: &ImportOptions,
    args: &Args,
) -> Result<Listening> {
    let (source, overload, name): (Box<dyn Source>, Overload, String) = match address.kind.as_str()
    {
        "vmc" => {
            address.allow(&[])?;
            let vmc = VmcOptions {
                mirrored: args.mirror,
                actors: args.actors.into(),
                skip_t_pose: !args.keep_t_pose,
            };
            let source = VmcSource::bind(address.socket()?, &vmc)?;
            let name = format!("vmc://{}", source.address()?);
            (Box::new(source), Overload::Drop, name)
        }
        "axis" | "axis+udp" => {
            let skeleton = args
                .skeleton
                .as_deref()
                .map(axis::skeleton)
                .transpose()?
                .unwrap_or_default();
            let axis = AxisOptions {
                skeleton,
                actors: args.actors.into(),
            };
            let (source, name) = AxisSource::open(address, &axis)?;
            (Box::new(source), Overload::Drop, name)
        }
        "json" => (
            Box::new(JsonSource::open(address)?),
            Overload::Wait,
            address.to_string(),
        ),
        "json+tcp" => {
            let (source, at) = JsonSource::listen(address)?;
            (Box::new(source), Overload::Wait, format!("json+tcp://{at}"))
        }
        "clip" => {
            let source = ClipSource::open(address, index, options)?;
            let overload = if source.is_paced() {
                Overload::Drop
            } else {
                Overload::Wait
            };
            (Box::new(source), overload, address.to_string())
        }
        other => bail!(
            "{address}: no source is called {other}; there are vmc://HOST:PORT, axis://HOST:PORT, axis+udp://HOST:PORT, json:-, json+tcp://HOST:PORT, clip://FILE"
        ),
    };
    eprintln!("morec: listening to {name}");
    let events = EventOptions {
        early: !args.no_early,
        refractory_secs: args.refractory,
    };
    let session_options = SessionOptions {
        events,
        overload,
        ..args.layout.options()
    };
    let (session, readers) = Session::start(&index.model, source, &session_options)?;
    let reader = readers
        .into_iter()
        .next()
        .context("a session has a reader")?;
    Ok(Listening {
        name,
        session,
        reader,
    })
}
