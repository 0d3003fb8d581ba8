//! The clip that is shown, and the camera.

use std::sync::Arc;

use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::smooth::ChannelKind;
use morec_db::ClipId;

use crate::body::Camera;
use crate::body::{ClipMotion, extent};
use crate::jobs::JobOutcome;
use crate::state::{Panel, PlayCommand, State, ViewCommand};

impl State {
    /// Shows a clip, and a stretch of it in a loop if one is named, once it is decoded.
    pub(in crate::state) fn open_clip(&mut self, clip: ClipId, stretch: Option<(f64, f64)>) {
        self.library.selected = vec![clip];
        self.library.chosen = false;
        if let Some(motion) = self.motions.get(clip).cloned() {
            self.show_motion(motion, stretch);
            return;
        }
        if let Some(why) = self.motions.failure(clip).map(str::to_owned) {
            self.complain(why);
            return;
        }
        self.pending = Some((clip, stretch));
        self.want_motion(clip);
    }

    /// Shows a clip that is decoded.
    pub(in crate::state) fn show_motion(
        &mut self,
        motion: Arc<ClipMotion>,
        stretch: Option<(f64, f64)>,
    ) {
        self.pending = None;
        let same = self
            .player
            .motion
            .as_ref()
            .is_some_and(|m| m.id == motion.id);
        if !same {
            self.release_keys();
            self.player.show(motion.clone());
            self.timeline.whole(motion.secs());
            let snapshot = self.store.as_ref().map(|s| s.snapshot.clone());
            let here = |id| Some(snapshot.as_ref()?.sample(id)?.clip == motion.id);
            self.timeline
                .selected
                .retain(|id| here(*id).unwrap_or(false));
            self.timeline.range = None;
            self.timeline.drag = None;
            self.timeline.cut = None;
            self.timeline.held_cut = None;
            self.companions.all.retain(|a| a.of.clip == motion.id);
            self.library.role = None;
            self.frame(&motion);
            self.look_anew(&motion);
        }
        if let Some((start, stop)) = stretch {
            self.player.apply(&PlayCommand::Stretch(start, stop));
            let margin = (stop - start).max(1.0);
            self.timeline.from_secs = (start - 2.0 * margin).max(0.0);
            self.timeline.to_secs = stop + 2.0 * margin;
            self.timeline.pan(0.0, motion.secs());
        }
        if let Some(of) = self.selecting.take().filter(|of| of.clip == motion.id) {
            self.select_range(Some((of.span.start_secs, of.span.stop_secs)));
        }
    }

    /// Brings the whole motion into the picture: around the performer where the camera follows, else around where it takes place.
    fn frame(&mut self, motion: &ClipMotion) {
        if self.framed.take() == Some(motion.id) {
            return;
        }
        let poses: Vec<WorldPose> = motion.poses(FRAMED_POSES).collect();
        let places = |pose: &WorldPose, centre: Vec3| {
            let places = pose.positions.iter().map(move |at| at - centre);
            places.collect::<Vec<Vec3>>()
        };
        let offsets: Vec<Vec3> = if self.camera.follow {
            let seen = poses.iter().filter_map(|p| Some((p, motion.centre(p)?)));
            seen.flat_map(|(p, centre)| places(p, centre)).collect()
        } else {
            let all: Vec<Vec3> = poses.into_iter().flat_map(|p| p.positions).collect();
            let Some((middle, _)) = extent(&all) else {
                return;
            };
            self.camera.target = middle;
            all.iter().map(|at| at - middle).collect()
        };
        let least = match motion.is_person {
            true => Camera::default().distance,
            false => Camera::NEAREST,
        };
        let needed = self.camera.distance_to_see(offsets.into_iter());
        self.camera.distance = needed.max(least);
        self.fitted = true;
    }

    /// Puts the camera so far off that what reaches `half` metres from its middle is seen whole; `None`: a person.
    pub(super) fn stand_off(&mut self, half: Option<f64>) {
        if let Some(half) = half {
            self.camera.distance = Camera::distance_of(half);
        } else if self.fitted {
            self.camera.distance = Camera::default().distance;
        }
        self.fitted = half.is_some();
    }

    pub(in crate::state) fn play(&mut self, command: &PlayCommand) {
        let before = self.player.playing;
        self.player.apply(command);
        // The label that was just made stays selected while nothing plays: then keys are for what passes.
        if self.player.playing && !before && self.timeline.just_made {
            self.timeline.just_made = false;
            self.timeline.selected.clear();
        }
    }

    /// Asks for all that is computed of the clip that is shown.
    pub(in crate::state) fn look_anew(&mut self, motion: &Arc<ClipMotion>) {
        self.curves = None;
        self.want_curves(motion);
        self.want_detections(motion);
        self.want_map(motion);
        self.want_channel(self.channel_wanted.clone());
    }

    /// Computes what both methods of cutting say of a clip.
    fn want_curves(&mut self, motion: &Arc<ClipMotion>) {
        for job in self.jobs.running.iter().filter(|j| j.name == CURVES) {
            job.cancel();
        }
        let motion = motion.clone();
        self.jobs.start(
            CURVES,
            false,
            &self.wake,
            JobOutcome::Curves,
            move |progress| crate::jobs::cut::curves(&motion, progress),
        );
    }

    /// Reads a channel of the clip that is shown. A clip without the joint has none; the next one may.
    pub(in crate::state) fn want_channel(&mut self, wanted: Option<(String, ChannelKind)>) {
        self.channel = None;
        self.channel_wanted = wanted;
        let (Some((joint, kind)), Some(motion)) = (&self.channel_wanted, &self.player.motion)
        else {
            return;
        };
        let (Some(joint), kind) = (motion.clip.skeleton.find(joint), *kind) else {
            return;
        };
        let Some(store) = &self.store else { return };
        let (db, clip) = (store.path().to_owned(), motion.id);
        self.jobs.start(
            "Reading a channel",
            false,
            &self.wake,
            JobOutcome::Channel,
            move |_| crate::jobs::channel::read(&db, clip, joint, kind),
        );
    }

    pub(in crate::state) fn look(&mut self, look: ViewCommand) {
        let heading = self.heading();
        let camera = &mut self.camera;
        match look {
            ViewCommand::Camera(new) => *camera = new,
            ViewCommand::Front => (camera.yaw, camera.pitch) = (heading, 0.08),
            ViewCommand::Side => {
                (camera.yaw, camera.pitch) = (heading + std::f64::consts::FRAC_PI_2, 0.08)
            }
            ViewCommand::Top => (camera.yaw, camera.pitch) = (heading, 1.45),
            ViewCommand::Reset => {
                let target = camera.target;
                *camera = Camera {
                    target,
                    yaw: heading + Camera::default().yaw,
                    ..Camera::default()
                };
            }
            ViewCommand::Follow(on) => camera.follow = on,
            ViewCommand::Trail(role) => self.trail = role,
            ViewCommand::Onion(on) => self.onion = on,
        }
    }

    /// Heading of the performer now, radians.
    fn heading(&self) -> f64 {
        if self.panel == Panel::Live {
            return self.live.heading().unwrap_or(0.0);
        }
        let heading = self
            .player
            .motion
            .as_ref()
            .and_then(|motion| motion.body.heading(&motion.pose(self.player.at_secs)));
        heading.unwrap_or(0.0)
    }
}

/// Poses by which the extent of a motion is known, at most.
const FRAMED_POSES: usize = 200;

/// Name of the job that computes cuts and misfit of the clip that is shown.
pub(in crate::state) const CURVES: &str = "Analysing the clip";
