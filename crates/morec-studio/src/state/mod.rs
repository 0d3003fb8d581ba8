//! Everything the window shows, without a widget: tests apply commands to it without a window.

mod actions;
pub mod classes;
mod columns;
mod command;
pub mod compare;
mod crossval;
pub mod cuts;
mod dialog;
mod label_import;
pub mod layout;
mod library;
pub mod live;
pub mod player;
pub mod shelf;
pub mod similar;
pub mod study;
pub mod timeline;
mod train;
pub mod video;
pub mod words;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use morec::labels::ClipDetection;
use morec::roles::{Role, RoleMap};
use morec::smooth::ChannelKind;
use morec_db::{ClipId, ClipInfo};

use crate::body::{Camera, ClipMotion};
use crate::jobs::{JobOutcome, Jobs, channel::ChannelCurve, cut::Curves, import};
use crate::store::{Edit, Store, Wake};
use crate::stretch::Stretch;
use crate::unsaved::{Leftover, OwnFolder};

pub use classes::Classes;
pub use command::{
    Ask, ClassCommand, Column, Command, FileCommand, LibraryCommand, Panel, TimelineCommand,
    TrainCommand, TypedPath, ViewCommand,
};
pub use compare::{Companions, CompareCommand};
pub use crossval::CrossvalView;
pub use cuts::CutCommand;
pub use dialog::{Dialog, DialogKind, dialog};
pub use label_import::LabelImport;
pub use library::Library;
pub use live::{Live, LiveCommand};
use player::LONGEST_FRAME;
pub use player::{PlayCommand, Player, SPEEDS};
pub use similar::SimilarCommand;
pub use timeline::{Drag, Grip, TimelineState};
pub use train::Train;

/// A sentence that stays until it is read, or what caused it is over.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    pub text: String,
    cause: Cause,
}

/// What a notice is about.
#[derive(Debug, Clone, PartialEq)]
enum Cause {
    /// A job of this name, until another of it succeeds.
    Job(String),
    /// What was asked for, by the number of commands until then, until something that was asked for later succeeds.
    Act(u64),
}

/// Everything the window shows.
pub struct State {
    pub store: Option<Store>,
    pub jobs: Jobs,
    pub panel: Panel,
    pub dark: bool,
    pub show_history: bool,
    pub show_keys: bool,
    /// True while it is asked whether a step of another program shall be taken back.
    pub undo_asks: bool,
    /// Errors, until they are dismissed or over.
    pub notices: Vec<Notice>,
    /// Number of commands that may have changed something.
    acts: u64,
    /// Names with letters that no font has.
    pub undrawn: Vec<String>,
    /// Message about the last action, for the status bar.
    pub said: String,
    /// The command that would do the same.
    pub command_line: String,
    pub library: Library,
    pub player: Player,
    pub camera: Camera,
    /// The part of the body that leaves a trail, whichever joint plays it in the clip that is shown.
    pub trail: Option<Role>,
    pub onion: bool,
    /// Performers of other clips beside the one that is shown.
    pub companions: Companions,
    pub timeline: TimelineState,
    /// The channel whose curve is shown: name of the joint, and kind; and the curve, once it is read.
    pub channel_wanted: Option<(String, ChannelKind)>,
    pub channel: Option<ChannelCurve>,
    pub curves: Option<Arc<Curves>>,
    /// Detections of the index in the clip that is shown.
    pub detections: Option<(ClipId, Vec<ClipDetection>)>,
    pub classes: Classes,
    /// Sets that were found without labels.
    pub shelf: shelf::Shelf,
    /// Time budgets and annotators.
    pub study: study::StudyState,
    /// The video of the clip that is shown.
    pub video: video::VideoState,
    pub train: Train,
    pub live: Live,
    pub import_report: Option<import::ImportSummary>,
    /// Labels of files that wait to be applied.
    pub label_import: Option<LabelImport>,
    /// A file dialog that should be shown.
    pub ask: Option<Ask>,
    /// True while the camera stands so far off as what was shown needs.
    fitted: bool,
    /// The clip that the camera stands before already, as it did in the session before.
    framed: Option<ClipId>,
    pub(crate) wake: Wake,
    pub(crate) motions: Motions,
    /// A stretch to show once its clip is decoded.
    pending: Option<(ClipId, Option<(f64, f64)>)>,
    /// A stretch to select once its clip is shown.
    selecting: Option<Stretch>,
    /// A folder of this run's own, for what nobody has named yet, and where such folders lie.
    folder: Option<OwnFolder>,
    unsaved: PathBuf,
    /// Databases that runs before left without saving them.
    pub leftovers: Vec<Leftover>,
    /// The place of the one that may be removed for good, while it is asked.
    pub discarding: Option<usize>,
    /// What waits for an answer whether the database shall be saved.
    pub leaving: Option<FileCommand>,
    /// True once the window may close.
    pub closing: bool,
    /// A path that is typed, where there is no file dialog.
    pub typed: Option<TypedPath>,
    seen_version: u64,
    /// The shown clip, while it is decoded anew.
    reopening: Option<ClipId>,
    /// The database of the last session.
    pub last: Option<PathBuf>,
    /// The name under which this window's steps are written down.
    signature: String,
}

/// A name that no other window has, of now or of another day: each takes back its own steps unasked, and no others.
fn signature() -> String {
    static WINDOWS: AtomicU32 = AtomicU32::new(0);
    let number = WINDOWS.fetch_add(1, Ordering::Relaxed);
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let secs = since.map_or(0, |since| since.as_secs().cast_signed());
    let process = std::process::id();
    let opened = crate::format::utc(secs);
    match number {
        0 => format!("the window of {opened} ({process})"),
        n => format!("the window of {opened} ({process}, {n})"),
    }
}

/// Decoded clips, the ones used last; others are decoded again when they are looked at.
#[derive(Default)]
pub(crate) struct Motions {
    kept: BTreeMap<ClipId, (Arc<ClipMotion>, u64)>,
    failed: BTreeMap<ClipId, String>,
    loading: Vec<ClipId>,
    clock: u64,
}

/// Most decoded motion that is kept: joints times frames, 32 bytes each.
const MOTION_KEPT: usize = 12_000_000;
/// Number of clips that are decoded at once.
const LOADERS: usize = 2;

impl Motions {
    pub fn get(&self, clip: ClipId) -> Option<&Arc<ClipMotion>> {
        self.kept.get(&clip).map(|(motion, _)| motion)
    }

    pub fn failure(&self, clip: ClipId) -> Option<&str> {
        self.failed.get(&clip).map(String::as_str)
    }

    /// Forgets clips whose roles are not what they were when they were decoded.
    fn forget_changed(&mut self, roles: &BTreeMap<ClipId, RoleMap>) {
        let same = |motion: &ClipMotion| roles.get(&motion.id).is_none_or(|r| *r == motion.roles);
        self.kept.retain(|_, (motion, _)| same(motion));
    }

    fn keep(&mut self, motion: Arc<ClipMotion>) {
        self.clock += 1;
        self.kept.insert(motion.id, (motion, self.clock));
        let size = |m: &ClipMotion| m.clip.frames * m.clip.skeleton.len().max(1);
        while self.kept.len() > 2
            && self.kept.values().map(|(m, _)| size(m)).sum::<usize>() > MOTION_KEPT
        {
            let oldest = self.kept.iter().min_by_key(|(_, (_, used))| *used);
            let Some(id) = oldest.map(|(id, _)| *id) else {
                break;
            };
            self.kept.remove(&id);
        }
    }
}

impl State {
    /// A state without a database. `wake` calls for a new frame from any thread; databases without a name lie in `unsaved`.
    pub fn new(wake: Wake, unsaved: PathBuf) -> Self {
        Self {
            store: None,
            jobs: Jobs::default(),
            panel: Panel::Library,
            dark: true,
            show_history: false,
            show_keys: false,
            undo_asks: false,
            notices: Vec::new(),
            acts: 0,
            undrawn: Vec::new(),
            said: String::new(),
            command_line: String::new(),
            library: Library::default(),
            player: Player::new(),
            camera: Camera::default(),
            trail: None,
            onion: false,
            companions: Companions::default(),
            timeline: TimelineState::default(),
            channel_wanted: None,
            channel: None,
            curves: None,
            detections: None,
            classes: Classes::default(),
            shelf: shelf::Shelf::default(),
            study: study::StudyState::default(),
            video: video::VideoState::default(),
            train: Train::default(),
            live: Live::default(),
            import_report: None,
            label_import: None,
            ask: None,
            fitted: false,
            framed: None,
            wake,
            motions: Motions::default(),
            pending: None,
            selecting: None,
            folder: None,
            unsaved,
            leftovers: Vec::new(),
            discarding: None,
            leaving: None,
            closing: false,
            typed: None,
            seen_version: 0,
            reopening: None,
            last: None,
            signature: signature(),
        }
    }

    /// Time passes, and what threads have done arrives. `dt` in seconds.
    pub fn tick(&mut self, dt: f64) {
        self.player.tick(dt.min(LONGEST_FRAME));
        if self.player.playing {
            let (at, end) = (self.player.at_secs, self.player.secs());
            self.timeline.follow(at, end);
        }
        if self.camera.follow
            && let Some(centre) = self.performer_centre()
        {
            self.camera.target = centre;
        }
        self.tick_video();
        self.tick_live(dt);
        self.poll();
    }

    /// The middle of what is shown, which the camera follows.
    fn performer_centre(&self) -> Option<morec::math::Vec3> {
        if self.panel == Panel::Live {
            return self.live.centre();
        }
        let motion = self.player.motion.as_ref()?;
        let centre = motion.centre(&motion.pose(self.player.at_secs))?;
        Some(match motion.is_person {
            true => self.middle(centre),
            false => centre,
        })
    }

    /// Carries out what was asked for.
    pub fn apply(&mut self, command: Command) {
        self.acts += u64::from(!matches!(
            command,
            Command::Show(_) | Command::Dismiss(_) | Command::Play(_) | Command::Look(_)
        ));
        match command {
            Command::Show(panel) => self.show(panel),
            Command::Dark(dark) => self.dark = dark,
            Command::ShowHistory(on) => self.show_history = on,
            Command::ShowKeys(on) => self.show_keys = on,
            Command::Dismiss(at) => {
                if at < self.notices.len() {
                    self.notices.remove(at);
                }
            }
            Command::File(command) => self.apply_file(command),
            Command::Edit(Edit::Undo(None)) if self.is_last_foreign() => self.undo_asks = true,
            Command::UndoAsks(on) => self.undo_asks = on,
            Command::Edit(edit) => self.edit(edit),
            Command::Library(command) => self.apply_library(command),
            Command::Play(command) => self.play(&command),
            Command::Look(look) => self.look(look),
            Command::Timeline(command) => self.apply_timeline(command),
            Command::Classes(command) => self.apply_classes(command),
            Command::Train(command) => self.apply_train(command),
            Command::Live(command) => self.apply_live(command),
            Command::Cuts(command) => self.apply_cuts(command),
            Command::Similar(command) => self.apply_similar(command),
            Command::Shelf(command) => self.apply_shelf(command),
            Command::Compare(command) => self.apply_compare(command),
            Command::Study(command) => self.apply_study(command),
            Command::Video(command) => self.apply_video(command),
            Command::Cancel(at) => {
                if let Some(job) = self.jobs.running.get(at) {
                    job.cancel();
                }
            }
        }
    }

    fn is_last_foreign(&self) -> bool {
        let store = self.store.as_ref();
        store.is_some_and(|s| s.snapshot.foreign_step().is_some())
    }

    fn show(&mut self, panel: Panel) {
        if panel != self.panel {
            // What was said of the panel before says nothing of this one.
            self.said.clear();
        }
        self.panel = panel;
        if panel != Panel::Label {
            self.release_keys();
        }
    }

    pub fn shown_clip(&self) -> Option<&ClipInfo> {
        let id = self.player.motion.as_ref()?.id;
        self.store.as_ref()?.snapshot.clip(id)
    }

    /// Time until something that is shown changes by itself, seconds; `None` if only people and threads change it.
    pub fn next_change_secs(&self) -> Option<f64> {
        let changes = [self.player.next_frame_secs(), self.live.next_change_secs()];
        let next = changes.into_iter().flatten().reduce(f64::min)?;
        // Slow motion goes on evenly if frames are not much further apart than this.
        Some(next.clamp(0.0, 0.8 * LONGEST_FRAME))
    }

    /// True while something lies over the panel.
    pub fn is_covered(&self) -> bool {
        self.show_keys
            || self.undo_asks
            || self.leaving.is_some()
            || self.discarding.is_some()
            || self.typed.is_some()
            || self.label_import.is_some()
            || self.classes.choosing.is_some()
    }

    /// True while threads are at work.
    pub fn is_busy(&self) -> bool {
        !self.jobs.running.is_empty()
            || self.store.as_ref().is_some_and(Store::is_busy)
            || !self.motions.loading.is_empty()
    }

    /// True while the database or what the status bar shows is at work, or a clip is read.
    #[cfg(test)]
    pub fn is_writing(&self) -> bool {
        self.jobs.running.iter().any(|job| job.shown)
            || self.store.as_ref().is_some_and(Store::is_busy)
            || !self.motions.loading.is_empty()
    }

    /// Asks for a clip's motion, if it is not decoded yet.
    pub fn want_motion(&mut self, clip: ClipId) {
        let known = self.motions.kept.contains_key(&clip)
            || self.motions.failed.contains_key(&clip)
            || self.motions.loading.contains(&clip);
        let Some(store) = self.store.as_ref().filter(|_| !known) else {
            return;
        };
        if self.motions.loading.len() >= LOADERS {
            return;
        }
        self.motions.loading.push(clip);
        let path = store.path().to_owned();
        self.jobs.start(
            "Reading a clip",
            false,
            &self.wake,
            JobOutcome::Loaded,
            move |_| Ok(crate::jobs::load::load(&path, clip)),
        );
    }

    pub(crate) fn complain(&mut self, text: impl Into<String>) {
        self.notice(text.into(), Cause::Act(self.acts));
    }

    /// Complains of a job that failed.
    fn complain_of(&mut self, job: &str, text: String) {
        self.notice(text, Cause::Job(job.to_owned()));
    }

    fn notice(&mut self, text: String, cause: Cause) {
        // The same twice says no more than once.
        self.notices.retain(|notice| notice.text != text);
        self.notices.push(Notice { text, cause });
    }

    /// Something that was asked for has succeeded: what was complained of before that was asked for is over.
    fn succeeded(&mut self) {
        let acts = self.acts;
        self.notices
            .retain(|notice| !matches!(notice.cause, Cause::Act(at) if at < acts));
    }

    /// A job has done what it was asked for: what was complained of its like before is over.
    fn job_succeeded(&mut self, name: &str) {
        self.notices
            .retain(|notice| !matches!(&notice.cause, Cause::Job(of) if of == name));
    }

    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.said = text.into();
    }
}
