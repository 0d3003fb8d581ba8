//! The layout that is remembered from one session to the next, with the database that was open.

use std::path::PathBuf;

use morec::math::Vec3;
use morec::roles::Role;
use morec::smooth::ChannelKind;
use serde::{Deserialize, Serialize};

use super::{Panel, State};
use crate::body::Camera;

/// A session's layout. Sizes of panels and of the window are remembered by the window system's side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Layout {
    pub panel: String,
    pub dark: bool,
    pub strips: bool,
    pub snap: bool,
    pub all_classes: bool,
    pub onion: bool,
    pub follow: bool,
    /// The camera's angles, distance and target.
    pub camera: Option<CameraLayout>,
    /// Name of the part of the body that leaves a trail.
    pub trail: Option<String>,
    /// The channel whose curve is shown.
    pub channel: Option<ChannelLayout>,
    pub mirror: bool,
    /// The annotator of new labels.
    pub annotator: Option<String>,
    /// The database that was open, unless it lay in a temporary folder.
    pub database: Option<PathBuf>,
    /// The clip that was shown.
    pub clip: Option<String>,
}

/// Where the camera stands, without whether it follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CameraLayout {
    pub yaw: f64,
    pub pitch: f64,
    /// Metres.
    pub distance: f64,
    /// Metres.
    pub target: [f64; 3],
}

/// A channel: name of the joint, and `rotation` or `position`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChannelLayout {
    pub joint: String,
    pub kind: String,
}

impl From<&Camera> for CameraLayout {
    fn from(camera: &Camera) -> Self {
        Self {
            yaw: camera.yaw,
            pitch: camera.pitch,
            distance: camera.distance,
            target: camera.target.into(),
        }
    }
}

impl CameraLayout {
    /// The camera; `None` if a number is not valid for a camera.
    fn camera(&self, follow: bool) -> Option<Camera> {
        let all = [self.yaw, self.pitch, self.distance].into_iter();
        let finite = all.chain(self.target).all(f64::is_finite);
        finite.then(|| Camera {
            target: Vec3::from(self.target),
            yaw: self.yaw,
            pitch: self.pitch.clamp(-Camera::STEEPEST, Camera::STEEPEST),
            distance: self.distance.clamp(Camera::NEAREST, Camera::FARTHEST),
            follow,
        })
    }
}

const ROTATION: &str = "rotation";
const POSITION: &str = "position";

impl From<&(String, ChannelKind)> for ChannelLayout {
    fn from((joint, kind): &(String, ChannelKind)) -> Self {
        let kind = match kind {
            ChannelKind::Rotation => ROTATION,
            ChannelKind::Position => POSITION,
        };
        Self {
            joint: joint.clone(),
            kind: kind.to_owned(),
        }
    }
}

impl ChannelLayout {
    /// The channel; `None` for a kind that is not known.
    fn channel(&self) -> Option<(String, ChannelKind)> {
        let kind = match self.kind.as_str() {
            ROTATION => ChannelKind::Rotation,
            POSITION => ChannelKind::Position,
            _ => return None,
        };
        Some((self.joint.clone(), kind))
    }
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            panel: Panel::Library.name().to_owned(),
            dark: true,
            strips: false,
            snap: true,
            all_classes: false,
            onion: false,
            follow: true,
            camera: None,
            trail: None,
            channel: None,
            mirror: false,
            annotator: None,
            database: None,
            clip: None,
        }
    }
}

impl State {
    pub fn layout(&self) -> Layout {
        let store = self.store.as_ref().filter(|s| !s.temporary);
        Layout {
            panel: self.panel.name().to_owned(),
            dark: self.dark,
            strips: self.library.strips,
            snap: self.timeline.snap,
            all_classes: self.timeline.all_classes,
            onion: self.onion,
            follow: self.camera.follow,
            camera: Some((&self.camera).into()),
            trail: self.trail.map(|role| role.name().to_owned()),
            channel: self.channel_wanted.as_ref().map(ChannelLayout::from),
            mirror: self.classes.mirror,
            annotator: self.study.annotator.clone(),
            database: store.map(|s| s.path().to_owned()),
            clip: self.shown_clip().map(|c| c.name.clone()),
        }
    }

    /// Lays things out as they were, and offers the database that was open.
    pub fn lay_out(&mut self, layout: &Layout) {
        self.last.clone_from(&layout.database);
        self.panel = Panel::named(&layout.panel).unwrap_or(Panel::Library);
        self.dark = layout.dark;
        self.library.strips = layout.strips;
        self.timeline.snap = layout.snap;
        self.timeline.all_classes = layout.all_classes;
        self.onion = layout.onion;
        let camera = layout.camera.and_then(|c| c.camera(layout.follow));
        self.camera = camera.unwrap_or(Camera {
            follow: layout.follow,
            ..self.camera
        });
        self.trail = layout.trail.as_deref().and_then(Role::from_name);
        self.want_channel(layout.channel.as_ref().and_then(ChannelLayout::channel));
        self.classes.mirror = layout.mirror;
        self.study.annotator.clone_from(&layout.annotator);
    }

    /// Shows the clip that was shown, if the database that was open is open again.
    pub fn show_again(&mut self, layout: &Layout) {
        let Some(store) = &self.store else { return };
        let clips = store.snapshot.clips.iter();
        let same = clips.filter(|c| Some(&c.name) == layout.clip.as_ref());
        if let Some(id) = same.map(|c| c.id).next() {
            self.framed = layout.camera.map(|_| id);
            self.open_clip(id, None);
        }
    }
}
