//! `morec send`: a clip played as a tracker would send it.

use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use morec::import::ImportOptions;
use morec::kinematics::WorldPose;
use morec::live::vmc::{Bundling, VmcSender};

use super::live::stop_on_ctrl_c;
use crate::files::{ReadArgs, mapping, rate};
use crate::live::address::Address;
use crate::live::clip::PAUSE_SECS;
use crate::live::loaded::{Loaded, load};
use crate::live::network::{Conditions, Network};

/// Play clips as a VMC sender, so that anything that listens to VMC can be tried without a tracker.
///
/// Each joint that plays a role is sent as the humanoid bone of that part, in Unity's left-handed axes, as it is in the
/// clip. Between clips there is a pause of a second. The accidents of a bad network can be had on request.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 everything was sent, or Ctrl-C; 1 something cannot be read or sent; 2 wrong command line.\n\n\
    Example: morec send take.bvh --to vmc://127.0.0.1:39539 --loop"
)]
pub struct Args {
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Where to send them
    #[arg(long, value_name = "vmc://HOST:PORT", default_value = "vmc://127.0.0.1:39539")]
    to: Address,
    /// Frames a second
    #[arg(long, value_name = "HZ", default_value = "60", value_parser = rate)]
    rate: f64,
    /// Play so many times as fast as it was performed
    #[arg(long, value_name = "TIMES", default_value = "1", value_parser = rate)]
    speed: f64,
    /// Begin again at the end, until Ctrl-C
    #[arg(long = "loop")]
    looped: bool,
    /// How messages are put into datagrams: whole (a bundle for each frame), single (each by itself), or the most
    /// bytes of a bundle
    #[arg(long, value_name = "whole|single|BYTES", default_value = "1500", value_parser = bundling)]
    pub bundle: Bundling,
    /// Send fingers, toes and face, too, unmoved
    #[arg(long)]
    every_bone: bool,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint name`
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    conditions: Conditions,
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
    if args.to.kind != "vmc" {
        bail!("{}: expected vmc://HOST:PORT", args.to);
    }
    args.to.allow(&[])?;
    let options = ImportOptions { mapping: mapping(args.roles.as_deref())?, ..ImportOptions::default() };
    let clips = load(&args.clips, &args.read, &options, None, Some(args.rate))?;
    let to = args.to.socket()?;
    let here = if to.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
    let socket = UdpSocket::bind(here).context("UDP socket")?;
    let stop = stop_on_ctrl_c()?;
    eprintln!("morec: sending to {} at {} Hz", args.to, args.rate);
    let mut playing = Playing {
        socket,
        to,
        sender: VmcSender::new(args.bundle, args.every_bone),
        network: Network::new(&args.conditions),
        begun: Instant::now(),
        at_secs: 0.0,
        speed: args.speed,
        packets: 0,
        frames: 0,
        pose: WorldPose::default(),
    };
    'all: loop {
        for loaded in &clips {
            for frame in loaded.first..loaded.clip.frames {
                if stop.load(Ordering::Relaxed) {
                    break 'all;
                }
                playing.frame(loaded, frame).with_context(|| args.to.to_string())?;
            }
            playing.at_secs += PAUSE_SECS;
        }
        if !args.looped {
            break;
        }
    }
    let Playing { frames, packets, network, .. } = playing;
    eprintln!(
        "morec: sent {frames} frames in {packets} packets; lost {} and delayed {} of them on purpose",
        network.lost, network.overtaken
    );
    Ok(ExitCode::SUCCESS)
}

/// A performance under way.
struct Playing {
    socket: UdpSocket,
    to: std::net::SocketAddr,
    sender: VmcSender,
    network: Network,
    begun: Instant,
    /// Time of the performance.
    at_secs: f64,
    speed: f64,
    packets: u64,
    frames: u64,
    pose: WorldPose,
}

impl Playing {
    fn frame(&mut self, loaded: &Loaded, frame: usize) -> std::io::Result<()> {
        let due = Duration::from_secs_f64(self.at_secs / self.speed + self.network.delay_secs());
        std::thread::sleep(due.saturating_sub(self.begun.elapsed()));
        self.pose.set(&loaded.clip, frame);
        let (socket, to, packets) = (&self.socket, self.to, &mut self.packets);
        for packet in self.sender.frame(self.at_secs / self.speed, &self.pose, &loaded.roles) {
            self.network.carry(packet, &mut |bytes| {
                *packets += 1;
                match socket.send_to(bytes, to) {
                    // Nobody listens there yet; they may come.
                    Err(error) if error.kind() == std::io::ErrorKind::ConnectionRefused => Ok(()),
                    sent => sent.map(drop),
                }
            })?;
        }
        self.frames += 1;
        self.at_secs += 1.0 / loaded.clip.rate_hz;
        Ok(())
    }
}
