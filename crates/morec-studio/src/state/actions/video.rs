//! The video of the clip that is shown: played along, its sound, its offset from a clap.

use morec_db::ClipVideo;

use crate::jobs::JobOutcome;
use crate::jobs::sound::{self, ClipSound};
use crate::state::video::VideoCommand;
use crate::state::{Panel, PlayCommand, State};
use crate::video_player::{VideoMoment, VideoPlayer};

/// Name of the job that reads the sound.
pub(super) const LISTENING: &str = "Reading the sound";

impl State {
    pub(in crate::state) fn apply_video(&mut self, command: VideoCommand) {
        match command {
            VideoCommand::Along(false) => self.video.along = None,
            VideoCommand::Along(true) => {
                let player = &self.video.player;
                let start = |first| VideoPlayer::start(player, first, self.wake.clone());
                self.video.along = self.video_moment().map(start);
            }
            VideoCommand::FromClap(false) => self.video.proposed = false,
            VideoCommand::FromClap(true) => match self.video.sound.as_ref().map(|s| &s.clap) {
                None => self.say("the sound is being read"),
                Some(Err(why)) => self.complain(format!("No offset: {why}")),
                Some(Ok(clap)) => {
                    let hands = clap.hands_secs;
                    self.video.proposed = true;
                    self.play(&PlayCommand::Pause);
                    self.play(&PlayCommand::Seek(hands));
                }
            },
        }
    }

    /// The video of the clip that is shown.
    pub fn shown_video(&self) -> Option<&ClipVideo> {
        let clip = self.player.motion.as_ref()?.id;
        self.store.as_ref()?.snapshot.videos.get(&clip)
    }

    /// The sound of the clip that is shown.
    pub fn shown_sound(&self) -> Option<&ClipSound> {
        let asked = self.video.asked.as_ref();
        self.video.sound.as_ref().filter(|s| Some(&s.of) == asked)
    }

    fn video_moment(&self) -> Option<VideoMoment> {
        let video = self.shown_video()?;
        Some(VideoMoment {
            file: video.path.clone(),
            at_secs: video.offset_secs + self.player.at_secs,
            playing: self.player.playing && self.panel != Panel::Live,
            speed: self.player.speed,
        })
    }

    /// Brings the video to the playhead, and asks for the sound of another video.
    pub(in crate::state) fn tick_video(&mut self) {
        let moment = self.video_moment();
        if let Some(along) = &mut self.video.along {
            match (along.ended(), moment) {
                (Some(why), _) => {
                    self.video.along = None;
                    match why {
                        Some(why) => self.complain(why),
                        None => self.say("the video is closed"),
                    }
                }
                (None, Some(moment)) => along.follow(moment),
                (None, None) => along.hold(),
            }
        }
        self.want_sound();
    }

    fn want_sound(&mut self) {
        let motion = self.player.motion.clone();
        let file = self.shown_video().map(|video| video.path.clone());
        let wanted = motion.as_ref().map(|m| m.id).zip(file);
        if wanted == self.video.asked {
            return;
        }
        self.video.asked.clone_from(&wanted);
        self.video.sound = None;
        self.video.proposed = false;
        for job in self.jobs.running.iter().filter(|j| j.name == LISTENING) {
            job.cancel();
        }
        let (Some(motion), Some((_, file))) = (motion, wanted) else {
            return;
        };
        let decoder = self.video.decoder.clone();
        self.jobs.start(
            LISTENING,
            true,
            &self.wake,
            JobOutcome::Sound,
            move |progress| sound::read(&decoder, &motion, &file, progress),
        );
    }
}
