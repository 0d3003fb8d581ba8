//! Sources as they are typed, opened.

use std::path::PathBuf;

use anyhow::{Result, bail};
use morec::import::ImportOptions;
use morec::index::MotionIndex;
use morec::live::axis::AxisOptions;
use morec::live::vmc::VmcOptions;
use morec::live::{MAX_ACTORS, Overload, Source};

use super::address::Address;
use super::axis::{self, AxisSource};
use super::clip::ClipSource;
use super::complaints::Complaints;
use super::json::JsonSource;
use super::vmc::VmcSource;
use crate::files::mapping;

/// What can be said of trackers.
#[derive(clap::Args, Debug)]
pub struct TrackerArgs {
    /// Exchange left and right, for VMC senders that show their performer as a mirror would
    #[arg(long)]
    pub mirror: bool,
    /// Performers that one VMC port, or one broadcast, follows at once
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u16).range(1..=MAX_ACTORS as i64))]
    pub actors: u16,
    /// A BVH file of the program at axis://, for how bones hang together and how long they are [default: a person of
    /// 1.7 m]
    #[arg(long, value_name = "BVH")]
    pub skeleton: Option<PathBuf>,
    /// Take T-poses that are too exact to be a person's, too: else they are a sender's that lost its tracker
    #[arg(long)]
    pub keep_t_pose: bool,
    /// Roles of joints of clips, where inference fails: lines of `role<TAB>joint name`
    #[arg(long, value_name = "FILE")]
    pub roles: Option<PathBuf>,
}

/// A source that has been opened.
pub struct Opened {
    /// It.
    pub source: Box<dyn Source>,
    /// Whether it can wait for whoever takes its frames.
    pub overload: Overload,
    /// What it is called, with the port that was free if it asked for any.
    pub name: String,
    /// What it finds wrong with what it is sent.
    pub complaints: Complaints,
}

impl TrackerArgs {
    /// Opens the source at `address`. `index` knows the roles of joints of its own clips.
    pub fn open(&self, address: &Address, index: Option<&MotionIndex>) -> Result<Opened> {
        let mut complaints = Complaints::default();
        let (source, overload, name): (Box<dyn Source>, Overload, String) = match address
            .kind
            .as_str()
        {
            "vmc" => {
                let source = self.vmc(address)?;
                let name = format!("vmc://{}", source.address()?);
                (Box::new(source), Overload::Drop, name)
            }
            "axis" | "axis+udp" => {
                let (source, name) = AxisSource::open(address, &self.axis()?)?;
                (Box::new(source), Overload::Drop, name)
            }
            "json" => {
                let source = JsonSource::open(address)?;
                complaints = source.complaints();
                (Box::new(source), Overload::Wait, address.to_string())
            }
            "json+tcp" => {
                let (source, at) = JsonSource::listen(address)?;
                complaints = source.complaints();
                (Box::new(source), Overload::Wait, format!("json+tcp://{at}"))
            }
            "clip" => {
                let options = ImportOptions {
                    mapping: mapping(self.roles.as_deref())?,
                    ..ImportOptions::default()
                };
                let source = ClipSource::open(address, index, &options)?;
                let paced = source.is_paced();
                let overload = if paced {
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
        Ok(Opened {
            source,
            overload,
            name,
            complaints,
        })
    }

    fn vmc(&self, address: &Address) -> Result<VmcSource> {
        address.allow(&[])?;
        let options = VmcOptions {
            mirrored: self.mirror,
            actors: self.actors.into(),
            skip_t_pose: !self.keep_t_pose,
        };
        VmcSource::bind(address.socket()?, &options)
    }

    fn axis(&self) -> Result<AxisOptions> {
        let skeleton = self.skeleton.as_deref().map(axis::skeleton).transpose()?;
        Ok(AxisOptions {
            skeleton: skeleton.unwrap_or_default(),
            actors: self.actors.into(),
        })
    }
}
