//! A Godot 4 extension: [`MorecRecognizer`](RecognizerNode), a node that recognises motions of a `Skeleton3D` or of XR trackers of a body and of hands.

mod stream;
mod trackers;

use godot::classes::{FileAccess, INode, Node, Skeleton3D};
use godot::prelude::*;
use morec::clip::{Joint, Skeleton};
use morec::index::MotionIndex;
use morec::live::{Event, Phase};

use stream::PerformerStream;
use trackers::vector;

struct MorecExtension;

// SAFETY: the entry point does nothing but register classes.
#[gdextension]
unsafe impl ExtensionLibrary for MorecExtension {}

/// Recognises the motions of an index in what a skeleton or XR trackers show, frame by frame, and says so by signals.
#[derive(GodotClass)]
#[class(base = Node, init, rename = MorecRecognizer)]
pub struct RecognizerNode {
    /// The index, as `morec train` and the studio write it.
    #[export(file = "*.index")]
    index_file: GString,
    /// The skeleton whose motions are recognised. Without one, the trackers' are.
    #[export]
    skeleton: Option<Gd<Skeleton3D>>,
    /// Names of XR trackers of one performer: of a body, or of one or both hands.
    #[export]
    #[init(val = trackers::usual())]
    trackers: PackedStringArray,
    /// Bones of the skeleton in the order in which joints come, parents first.
    bones: Vec<i32>,
    stream: Option<PerformerStream>,
    secs: f64,
    base: Base<Node>,
}

#[godot_api]
impl RecognizerNode {
    /// A motion seems to be under way.
    #[signal]
    fn motion_started(name: GString, score: f64);

    /// A motion ended: when it began and ended, in seconds since the node was ready. `repetitions` is 0 but for activities that repeat.
    #[signal]
    fn motion_ended(name: GString, score: f64, start_secs: f64, stop_secs: f64, repetitions: i64);

    /// What seemed to be under way is none.
    #[signal]
    fn motion_cancelled(name: GString);

    /// One repetition of an activity, which still goes on.
    #[signal]
    fn motion_repeated(name: GString, number: i64);

    /// What is wrong with what the skeleton or the trackers showed in the last seconds, a sentence each, the gravest first.
    #[func]
    fn diagnosis(&self) -> PackedStringArray {
        let found = self.stream.iter().flat_map(PerformerStream::findings);
        found.map(|text| GString::from(&text)).collect()
    }

    /// Reads the index and begins anew; false, with an error in the log, if it cannot be read.
    #[func]
    fn start(&mut self) -> bool {
        let bytes = FileAccess::get_file_as_bytes(&self.index_file);
        match MotionIndex::from_bytes(bytes.as_slice()) {
            Ok(index) => {
                self.stream = Some(self.listen(index));
                self.secs = 0.0;
                true
            }
            Err(error) => {
                godot_error!("morec: {}: {error}", self.index_file);
                false
            }
        }
    }

    fn listen(&mut self, index: MotionIndex) -> PerformerStream {
        let Some(skeleton) = &self.skeleton else {
            return PerformerStream::of_roles(index);
        };
        self.bones = parents_first(skeleton);
        PerformerStream::of_skeleton(index, joints(skeleton, &self.bones))
    }

    /// Takes the stream back and says what it has recognised; what is connected to a signal may begin another stream.
    fn keep(&mut self, stream: PerformerStream) {
        let events: Vec<(String, Event)> = stream.events().collect();
        self.stream = Some(stream);
        for (name, event) in &events {
            self.emit(name, event);
        }
    }

    fn emit(&mut self, name: &str, event: &Event) {
        let name = GString::from(name);
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
                stream.push(self.secs, places);
            }
            None => stream.push_places(self.secs, &trackers::pose(&self.trackers)),
        }
        self.keep(stream);
    }

    fn exit_tree(&mut self) {
        if let Some(mut stream) = self.stream.take() {
            stream.finish();
            self.keep(stream);
        }
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
