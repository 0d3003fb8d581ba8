//! A Godot 4 extension: [`MorecRecognizer`](RecognizerNode), a node that recognises motions of a `Skeleton3D` or of XR trackers of a body and of hands.

mod trackers;

use std::sync::Arc;

use godot::classes::{FileAccess, INode, Node, Skeleton3D};
use godot::prelude::*;
use morec::clip::{Joint, Skeleton};
use morec::index::MotionIndex;
use morec::live::{Event, Frame, PerformerStream, Phase, Rig, StreamOptions, wall_now_secs};
use morec::roles::RoleMap;
use morec::roles::mapping::Mapping;
use morec::templates::PerformerKind;

use trackers::vector;

struct MorecExtension;

// SAFETY: the entry point does nothing but register classes.
#[gdextension]
unsafe impl ExtensionLibrary for MorecExtension {}

/// Who performs: decides how the threshold follows the performer's scores.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy)]
#[godot(via = GString)]
pub enum ExpectedPerformer {
    /// Decided by the performer's motions.
    #[default]
    Auto,
    /// The training subject.
    Teacher,
    /// Anyone, from the first frame.
    Anyone,
}

/// Recognises motions of a skeleton or of XR trackers, frame by frame, with an index, and emits signals.
#[derive(GodotClass)]
#[class(base = Node, init, rename = MorecRecognizer)]
pub struct RecognizerNode {
    /// The index file, written by `morec train` or the studio.
    #[export(file = "*.index")]
    index_file: GString,
    /// The skeleton whose motions are recognised. If not set, the trackers are used.
    #[export]
    skeleton: Option<Gd<Skeleton3D>>,
    /// Names of XR trackers of one performer: of a body, or of one or both hands.
    #[export]
    #[init(val = trackers::usual())]
    trackers: PackedStringArray,
    /// Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous; 0: as trained.
    #[export]
    sensitivity: f64,
    /// Who performs: auto, teacher or anyone.
    #[export]
    performer: ExpectedPerformer,
    /// Also signal motions before they end: `motion_started` and `motion_cancelled`.
    #[export]
    tentative: bool,
    /// Also signal each repetition of an activity: `motion_repeated`.
    #[export]
    each_repetition: bool,
    /// Say in `motion_event` how far from the nearest sample a motion was: off_degrees, pace, worst_bone, worst_degrees.
    #[export]
    deviation: bool,
    /// Also signal with each frame how far every class has come: `motion_progress`.
    #[export]
    progress: bool,
    /// A motion of the same class that ends less than this after the one before it is not signalled, seconds.
    #[export]
    refractory_secs: f64,
    /// Bones of body parts that the names do not identify: lines of a role, a tab and the bone's name.
    #[export(multiline)]
    roles: GString,
    /// Bones of the skeleton in the order in which joints come, parents first.
    bones: Vec<i32>,
    stream: Option<PerformerStream>,
    frame: Frame,
    secs: f64,
    base: Base<Node>,
}

#[godot_api]
impl RecognizerNode {
    /// Any event: a dictionary of phase (`start`, `update`, `repetition`, `progress`, `cancel`, `end`), class, score, progress, start_secs, stop_secs,
    /// reported_secs, wall_secs, actor, motion, sequence, repetitions and period_secs (0 where nothing is counted), off_degrees (-1 where nothing is
    /// compared), pace, worst_bone and worst_degrees.
    #[signal]
    fn motion_event(event: VarDictionary);

    /// A motion has probably started.
    #[signal]
    fn motion_started(name: GString, score: f64);

    /// A motion has ended; start and stop are seconds since the node was ready. `repetitions` is 0 except for repeated
    /// activities.
    #[signal]
    fn motion_ended(name: GString, score: f64, start_secs: f64, stop_secs: f64, repetitions: i64);

    /// A tentative motion was cancelled.
    #[signal]
    fn motion_cancelled(name: GString);

    /// A repetition of an activity is complete; the activity continues.
    #[signal]
    fn motion_repeated(name: GString, number: i64);

    /// How far a class has come and how like it is to a sample, both 0 to 1, and its duration so far over that of the sample.
    #[signal]
    fn motion_progress(name: GString, progress: f64, score: f64, pace: f64);

    /// Problems of the skeleton's or the trackers' poses in the last seconds, one sentence each, the most severe first.
    #[func]
    fn diagnosis(&self) -> PackedStringArray {
        let found = self.stream.iter().flat_map(PerformerStream::findings);
        found.map(|text| GString::from(&text)).collect()
    }

    /// Reads the index and starts again with the current properties. Returns false, with an error in the log, if that fails.
    #[func]
    fn start(&mut self) -> bool {
        let bytes = FileAccess::get_file_as_bytes(&self.index_file);
        let index = MotionIndex::from_bytes(bytes.as_slice()).map_err(|error| error.to_string());
        match index.and_then(|index| self.listen(&Arc::new(index))) {
            Ok(stream) => {
                self.stream = Some(stream);
                self.secs = 0.0;
                true
            }
            Err(error) => {
                godot_error!("morec: {}: {error}", self.index_file);
                false
            }
        }
    }

    fn listen(&mut self, index: &Arc<MotionIndex>) -> Result<PerformerStream, String> {
        let options = self.options()?;
        let rig = match &self.skeleton {
            Some(skeleton) => {
                self.bones = parents_first(skeleton);
                let skeleton = joints(skeleton, &self.bones);
                let mut roles = RoleMap::find(&skeleton);
                index.complete_roles(&mut roles, &skeleton);
                Rig { skeleton, roles }
            }
            None => Rig::of_roles(),
        };
        let stream = PerformerStream::of_rig(index, rig, None, &options);
        stream.map_err(|error| error.to_string())
    }

    fn options(&self) -> Result<StreamOptions, String> {
        let roles = Mapping::read(self.roles.to_string().as_bytes());
        Ok(StreamOptions {
            sensitivity: (self.sensitivity != 0.0).then_some(self.sensitivity),
            performer: match self.performer {
                ExpectedPerformer::Auto => PerformerKind::Auto,
                ExpectedPerformer::Teacher => PerformerKind::Teacher,
                ExpectedPerformer::Anyone => PerformerKind::Anyone,
            },
            tentative: self.tentative,
            each_repetition: self.each_repetition,
            deviation: self.deviation,
            progress: self.progress,
            refractory_secs: self.refractory_secs,
            roles: roles.map_err(|error| format!("roles: {error}"))?,
            // The engine's.
            up: morec::SignedAxis::Y,
        })
    }

    /// Takes the stream back and signals its events; what is connected to a signal may begin another stream.
    fn keep(&mut self, stream: PerformerStream, events: &[Event]) {
        let name = |event: &Event| stream.index().model.class_name(event.class).to_owned();
        let events: Vec<(String, Event)> = events.iter().map(|e| (name(e), *e)).collect();
        self.stream = Some(stream);
        for (name, event) in &events {
            self.emit(name, event);
        }
    }

    fn emit(&mut self, name: &str, event: &Event) {
        let name = GString::from(name);
        let all = dictionary(&name, event);
        self.signals().motion_event().emit(&all);
        let repetitions = event.repetitions.map_or(0, |r| i64::from(r.count));
        let mut signals = self.signals();
        match event.phase {
            Phase::Start => signals.motion_started().emit(&name, event.score),
            Phase::End => {
                let (start, stop) = (event.span.start_secs, event.span.stop_secs);
                let mut ended = signals.motion_ended();
                ended.emit(&name, event.score, start, stop, repetitions);
            }
            Phase::Cancel => signals.motion_cancelled().emit(&name),
            Phase::Repetition => signals.motion_repeated().emit(&name, repetitions),
            Phase::Progress => {
                let (far, pace) = (event.progress, event.pace.unwrap_or_default());
                signals.motion_progress().emit(&name, far, event.score, pace);
            }
            _ => {}
        }
    }
}

#[godot_api]
impl INode for RecognizerNode {
    fn ready(&mut self) {
        if !self.index_file.is_empty() {
            self.start();
        }
    }

    fn process(&mut self, delta: f64) {
        self.secs += delta;
        let Some(mut stream) = self.stream.take() else {
            return;
        };
        match &self.skeleton {
            Some(skeleton) => {
                let to_world = skeleton.get_global_transform();
                let places = self.bones.iter().map(|bone| {
                    let at = to_world * skeleton.get_bone_global_pose(*bone).origin;
                    vector(at)
                });
                self.frame.pose.rotations.clear();
                self.frame.pose.positions.clear();
                self.frame.pose.positions.extend(places);
            }
            None => self.frame.set_key_pose(&trackers::pose(&self.trackers)),
        }
        (self.frame.time_secs, self.frame.wall_secs) = (self.secs, wall_now_secs());
        let events = stream.push(&self.frame).to_vec();
        self.keep(stream, &events);
    }

    fn exit_tree(&mut self) {
        if let Some(mut stream) = self.stream.take() {
            let events = stream.finish().to_vec();
            self.keep(stream, &events);
        }
    }
}

/// An event with all that is known of it.
fn dictionary(name: &GString, event: &Event) -> VarDictionary {
    let (repeated, deviation) = (event.repetitions, event.deviation);
    vdict! {
        "phase" => event.phase.name(),
        "class" => name,
        "score" => event.score,
        "progress" => event.progress,
        "start_secs" => event.span.start_secs,
        "stop_secs" => event.span.stop_secs,
        "reported_secs" => event.reported_secs,
        "wall_secs" => event.wall_secs,
        "actor" => i64::from(event.actor.0),
        "motion" => event.motion as i64,
        "sequence" => event.sequence as i64,
        "repetitions" => repeated.map_or(0, |r| i64::from(r.count)),
        "period_secs" => repeated.map_or(0.0, |r| r.period_secs),
        "off_degrees" => deviation.map_or(-1.0, |d| d.off_degrees),
        "pace" => event.pace.unwrap_or(0.0),
        "worst_bone" => deviation.map_or("", |d| d.worst_bone),
        "worst_degrees" => deviation.map_or(0.0, |d| d.worst_degrees),
    }
}

/// The bones of a skeleton, those without a parent first, each behind its parent.
fn parents_first(skeleton: &Gd<Skeleton3D>) -> Vec<i32> {
    let mut bones: Vec<i32> = skeleton.get_parentless_bones().to_vec();
    let mut at = 0;
    while let Some(bone) = bones.get(at) {
        bones.extend(skeleton.get_bone_children(*bone).as_slice());
        at += 1;
    }
    bones
}

/// The joints of the `bones` of a skeleton, in their order.
fn joints(skeleton: &Gd<Skeleton3D>, bones: &[i32]) -> Skeleton {
    let place = |bone: i32| bones.iter().position(|known| *known == bone);
    let joint = |bone: &i32| Joint {
        name: skeleton.get_bone_name(*bone).to_string(),
        parent: place(skeleton.get_bone_parent(*bone)),
        offset: vector(skeleton.get_bone_rest(*bone).origin),
        tip: None,
    };
    Skeleton::new(bones.iter().map(joint).collect()).unwrap_or_default()
}
