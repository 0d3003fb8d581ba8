//! Opens the sources on the command line, with the options of trackers.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Result;
use morec::index::MotionIndex;
use morec::live::MAX_PERFORMERS;
use morec_live::{Address, OpenSource, SourceOptions, open_source};

use crate::files::mapping;
use crate::output;

/// Options of trackers.
#[derive(clap::Args, Debug)]
pub struct TrackerArgs {
    /// Exchange left and right (senders that mirror their performer)
    #[arg(long)]
    pub mirror: bool,
    /// Performers followed at once on one VMC port or broadcast
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u16).range(1..=MAX_PERFORMERS as i64))]
    pub actors: u16,
    /// BVH file with the skeleton of an axis:// broadcast
    ///
    /// [default: a person of 1.7 m]
    #[arg(hide_short_help = true, long, value_name = "BVH")]
    pub skeleton: Option<PathBuf>,
    /// Folder of MediaPipe's files for --listen webcam
    ///
    /// An unpacked `npm pack @mediapipe/pose`, or hands.
    #[arg(long, value_name = "DIR")]
    pub mediapipe: Option<PathBuf>,
    /// Keep exact T-poses
    ///
    /// By default, exact T-poses are dropped, because senders without tracking send them.
    #[arg(hide_short_help = true, long)]
    pub keep_t_pose: bool,
    /// Roles of joints of clips, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    pub roles: Option<PathBuf>,
}

impl TrackerArgs {
    /// Opens the source at `address` and prints what it listens to. `index` has the roles of joints of its training clips.
    pub fn open(&self, address: &Address, index: Option<&MotionIndex>) -> Result<OpenSource> {
        if address.kind == "clip" {
            output::mark_read(Path::new(&address.place));
        }
        if let Some(skeleton) = &self.skeleton {
            output::mark_read(skeleton);
        }
        let options = SourceOptions {
            mirrored: self.mirror,
            actors: self.actors.into(),
            skip_t_pose: !self.keep_t_pose,
            axis_skeleton: self.skeleton.clone(),
            mediapipe: self.mediapipe.clone(),
            roles: mapping(self.roles.as_deref())?,
            index,
        };
        let opened = open_source(address, &options)?;
        eprintln!("morec: listening to {}", opened.name);
        if let Some(at) = opened.name.strip_prefix("webcam://") {
            let page = format!("http://{at}/");
            eprintln!("morec: the page of the webcam is {page}");
            if address.to_string() == "webcam" {
                show_page(&page);
            }
        }
        Ok(opened)
    }
}

/// Shows a page in the user's browser, if there is one: its address has been said.
fn show_page(page: &str) {
    let (program, words): (_, &[&str]) = match std::env::consts::OS {
        "windows" => ("cmd", &["/C", "start", ""]),
        "macos" => ("open", &[]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(words).arg(page).stdin(Stdio::null());
    let _ = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
}
