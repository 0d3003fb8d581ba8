//! `morec send`: plays clips as a tracker would send them.

use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use morec::kinematics::WorldPose;
use morec::roles::RoleMap;
use morec_live::axis::AxisSender;
use morec_live::vmc::{Bundling, VmcSender};

use crate::files::{ReadArgs, expand, mapping, rate};
use crate::interrupt::stop_on_ctrl_c;
use crate::live::network::NetworkArgs;
use morec_live::Address;
use morec_live::Broadcast;
use morec_live::Network;
use morec_live::PAUSE_SECS;
use morec_live::load;

/// Play clips as a VMC sender or an Axis broadcast, to try receivers without a tracker.
///
/// Each joint with a role, and each finger joint, is sent as the humanoid bone of that part, in Unity's left-handed
/// axes. As a broadcast (--to axis://HOST:PORT), sending starts with the first TCP connection and goes to every connected
/// program, without positions if ?positions=0. Clips are separated by a pause of 1 second. A bad network can be simulated.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 everything was sent, or Ctrl-C; 1 reading or sending failed; 2 wrong command line.\n\n\
    Example: morec send take.bvh --to vmc://127.0.0.1:39539 --loop\n         \
    morec send take.bvh --to axis://127.0.0.1:7001"
)]
pub struct Args {
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Receiver
    #[arg(
        long,
        value_name = "vmc|axis://HOST:PORT",
        default_value = "vmc://127.0.0.1:39539"
    )]
    to: Address,
    /// Frames a second
    #[arg(long, value_name = "HZ", default_value = "60", value_parser = rate)]
    rate: f64,
    /// Play N times as fast
    #[arg(long, value_name = "TIMES", default_value = "1", value_parser = rate)]
    speed: f64,
    /// Repeat until Ctrl-C
    #[arg(long = "loop")]
    looped: bool,
    /// Bundling of messages: whole, single or a number of bytes
    ///
    /// whole: one bundle for each frame; single: each message alone; a number: at most so many bytes in a bundle.
    #[arg(long, value_name = "whole|single|BYTES", default_value = "1500", value_parser = bundling)]
    pub bundle: Bundling,
    /// Also send bones that the clip lacks, unmoved
    #[arg(long)]
    every_bone: bool,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    conditions: NetworkArgs,
    #[command(flatten)]
    read: ReadArgs,
}

/// A way of bundling, as it is typed.
pub fn bundling(text: &str) -> Result<Bundling, String> {
    match (text, text.parse::<usize>()) {
        ("whole", _) => Ok(Bundling::Whole),
        ("single", _) => Ok(Bundling::Single),
        (_, Ok(bytes)) if (200..=60_000).contains(&bytes) => Ok(Bundling::Bytes(bytes)),
        _ => Err("expected whole, single or a number of bytes from 200 to 60000".to_owned()),
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let reader = args.read.reader_with(mapping(args.roles.as_deref())?);
    let clips = load(&expand(&args.clips)?, &reader, None, Some(args.rate))?;
    let stop = stop_on_ctrl_c()?;
    let mut to: Box<dyn Receiver> = match args.to.kind.as_str() {
        "vmc" => Box::new(ToVmc::open(args)?),
        "axis" | "axis+udp" => Box::new(ToAxis::open(args, &stop)?),
        _ => bail!(
            "{}: expected vmc://HOST:PORT, axis://HOST:PORT or axis+udp://HOST:PORT",
            args.to
        ),
    };
    eprintln!("morec: sending to {} at {} Hz", args.to, args.rate);
    let (mut time, mut pose, mut frames) = (Time::begin(args), WorldPose::default(), 0u64);
    'all: loop {
        for loaded in &clips {
            let roles = loaded.roles.with_fingers(&loaded.clip.skeleton);
            for frame in loaded.first..loaded.clip.frames {
                if stop.load(Ordering::Relaxed) {
                    break 'all;
                }
                time.wait(to.delay_secs());
                pose.set(&loaded.clip, frame);
                to.frame(time.at_secs / args.speed, &pose, &roles)
                    .with_context(|| args.to.to_string())?;
                frames += 1;
                time.at_secs += 1.0 / loaded.clip.rate_hz;
            }
            time.at_secs += PAUSE_SECS;
        }
        if !args.looped {
            break;
        }
    }
    eprintln!("morec: sent {frames} frames{}", to.summary());
    Ok(ExitCode::SUCCESS)
}

/// Time of the performance.
struct Time {
    begun: Instant,
    at_secs: f64,
    speed: f64,
}

impl Time {
    fn begin(args: &Args) -> Self {
        Self {
            begun: Instant::now(),
            at_secs: 0.0,
            speed: args.speed,
        }
    }

    /// Waits until it is time to send the next frame, and `delay_secs` more.
    fn wait(&self, delay_secs: f64) {
        let due = Duration::from_secs_f64(self.at_secs / self.speed + delay_secs);
        std::thread::sleep(due.saturating_sub(self.begun.elapsed()));
    }
}

/// The other end of the connection.
trait Receiver {
    /// Sends a frame; `time_secs` of the performance as it is played.
    fn frame(&mut self, time_secs: f64, pose: &WorldPose, roles: &RoleMap) -> std::io::Result<()>;

    /// Delay of the next frame.
    fn delay_secs(&mut self) -> f64 {
        0.0
    }

    /// Last line of the report.
    fn summary(&self) -> String;
}

/// What the network did to packets, for the report.
fn on_purpose(network: &Network) -> String {
    let (lost, overtaken) = (network.lost, network.overtaken);
    format!("; lost {lost} and delayed {overtaken} of them on purpose")
}

struct ToVmc {
    socket: UdpSocket,
    to: std::net::SocketAddr,
    sender: VmcSender,
    network: Network,
    packets: u64,
}

impl ToVmc {
    fn open(args: &Args) -> Result<Self> {
        args.to.allow(&[])?;
        let to = args.to.socket()?;
        let here = if to.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
        let socket = UdpSocket::bind(here).context("UDP socket")?;
        let sender = VmcSender::new(args.bundle, args.every_bone);
        Ok(Self {
            socket,
            to,
            sender,
            network: Network::new(&args.conditions.accidents()),
            packets: 0,
        })
    }
}

impl Receiver for ToVmc {
    fn frame(&mut self, time_secs: f64, pose: &WorldPose, roles: &RoleMap) -> std::io::Result<()> {
        let (socket, to, packets) = (&self.socket, self.to, &mut self.packets);
        for packet in self.sender.frame(time_secs, pose, roles) {
            self.network.carry(packet, &mut |bytes| {
                *packets += 1;
                match socket.send_to(bytes, to) {
                    // Nobody listens there yet; they may come.
                    Err(error) if error.kind() == std::io::ErrorKind::ConnectionRefused => Ok(()),
                    sent => sent.map(drop),
                }
            })?;
        }
        Ok(())
    }

    fn delay_secs(&mut self) -> f64 {
        self.network.delay_secs()
    }

    fn summary(&self) -> String {
        let on_purpose = on_purpose(&self.network);
        format!(" in {} packets{on_purpose}", self.packets)
    }
}

struct ToAxis {
    to: Broadcast,
    sender: AxisSender,
    network: Network,
}

impl ToAxis {
    /// Opens it, and waits for somebody to come.
    fn open(args: &Args, stop: &AtomicBool) -> Result<Self> {
        args.to.allow(&["positions"])?;
        let positions = args.to.number("positions", 1.0)?.unwrap_or(1.0) > 0.0;
        let mut to = Broadcast::open(&args.to)?;
        if let Some(at) = to.address() {
            eprintln!("morec: waiting for a program to connect to axis://{at}");
        }
        while to.accept() == 0 && !stop.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let sender = AxisSender::new(0, "morec", positions);
        Ok(Self {
            to,
            sender,
            network: Network::new(&args.conditions.accidents()),
        })
    }
}

impl Receiver for ToAxis {
    fn frame(&mut self, _: f64, pose: &WorldPose, roles: &RoleMap) -> std::io::Result<()> {
        let to = &mut self.to;
        self.network
            .carry(self.sender.frame(pose, roles), &mut |bytes| {
                to.send(bytes);
                Ok(())
            })
    }

    fn delay_secs(&mut self) -> f64 {
        self.network.delay_secs()
    }

    fn summary(&self) -> String {
        on_purpose(&self.network)
    }
}
