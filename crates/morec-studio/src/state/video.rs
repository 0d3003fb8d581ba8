//! The video of the clip that is shown: played along in another program, its sound, and its offset from a clap.

use std::path::PathBuf;

use morec_db::ClipId;

use crate::jobs::sound::ClipSound;
use crate::video_player::VideoPlayer;

/// Commands for the video of the clip that is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VideoCommand {
    /// Plays it along, or ends that.
    Along(bool),
    /// Proposes the offset at which a clap is seen when it is heard; `false` ends the proposal.
    FromClap(bool),
}

/// The state of the video of the clip that is shown.
pub struct VideoState {
    /// The programs that play videos and that decode sound.
    pub player: PathBuf,
    pub decoder: PathBuf,
    /// The program that plays along.
    pub along: Option<VideoPlayer>,
    pub sound: Option<ClipSound>,
    /// Whose sound was asked for last: clip and file.
    pub(super) asked: Option<(ClipId, String)>,
    /// True while an offset from a clap is proposed.
    pub proposed: bool,
}

impl Default for VideoState {
    fn default() -> Self {
        Self {
            player: PathBuf::from("mpv"),
            decoder: PathBuf::from("ffmpeg"),
            along: None,
            sound: None,
            asked: None,
            proposed: false,
        }
    }
}
