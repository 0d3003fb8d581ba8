//! The ways there are of running recognition; the conformance suite goes through all of them.

use std::sync::Arc;
use std::time::Duration;

use morec::features::BoneSet;
use morec::live::{
    Detection, EventReader, Frame, OverflowPolicy, PartMatcher, PerformerId, Phase, Pool,
    PoolStream, Recognizer, Rig, Session, SessionOptions, Source, SourceEvent,
};
use morec::templates::{ClassMatches, TemplateModel};

use crate::made::Timed;

/// One way of running recognition.
pub struct Engine {
    /// Its name in failures.
    pub name: &'static str,
    /// Recognises a whole stream, which ends with the last pose.
    pub run: fn(&Arc<TemplateModel>, BoneSet, &[Timed]) -> Vec<Detection>,
}

/// All of them.
pub const ENGINES: [Engine; 5] = [
    Engine {
        name: "inline",
        run: inline,
    },
    Engine {
        name: "inline, in batches",
        run: batches,
    },
    Engine {
        name: "classes divided among three",
        run: divided,
    },
    Engine {
        name: "session",
        run: session,
    },
    Engine {
        name: "pool of two threads and three streams",
        run: pool,
    },
];

pub fn inline(model: &Arc<TemplateModel>, bones: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let mut recognizer = Recognizer::new(model, bones).unwrap();
    let mut found = Vec::new();
    for (time_secs, pose) in poses {
        found.extend_from_slice(recognizer.push(*time_secs, pose));
    }
    found.extend_from_slice(recognizer.finish());
    found
}

fn batches(model: &Arc<TemplateModel>, bones: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let mut recognizer = Recognizer::new(model, bones).unwrap();
    let mut found = Vec::new();
    for batch in poses.chunks(37) {
        recognizer.push_all(batch, &mut found);
    }
    found.extend_from_slice(recognizer.finish());
    found
}

/// Each part's matches go over bytes, as they would from another machine.
fn divided(model: &Arc<TemplateModel>, bones: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let matches = |part| {
        let mut matcher = PartMatcher::new(&model.part(part, 3), bones).unwrap();
        for (time_secs, pose) in poses {
            matcher.push(*time_secs, pose);
        }
        ClassMatches::from_bytes(&matcher.finish().to_bytes()).unwrap()
    };
    let matches = ClassMatches::merge((0..3).map(matches)).unwrap();
    let mut recognizer = Recognizer::replay(&model.part(0, 3), bones, matches).unwrap();
    let mut found = Vec::new();
    recognizer.push_all(poses, &mut found);
    found.extend_from_slice(recognizer.finish());
    found
}

/// A stream as a source, whose frames are poses of `rig`.
pub struct Played {
    poses: Vec<Timed>,
    played: usize,
    rig: Option<Arc<Rig>>,
}

impl Played {
    pub fn new(poses: &[Timed]) -> Self {
        Self {
            poses: poses.to_vec(),
            played: 0,
            rig: Some(Arc::new(Rig::of_roles())),
        }
    }
}

impl Source for Played {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        if let Some(rig) = self.rig.take() {
            return SourceEvent::Rig(PerformerId(0), rig);
        }
        let Some((time_secs, pose)) = self.poses.get(self.played) else {
            return SourceEvent::Ended;
        };
        self.played += 1;
        fill(frame, *time_secs, pose);
        SourceEvent::Frame
    }
}

fn fill(frame: &mut Frame, time_secs: f64, pose: &morec::features::KeyPose) {
    frame.time_secs = time_secs;
    frame.wall_secs = morec::live::wall_now_secs();
    frame.actor = PerformerId(0);
    frame.set_key_pose(pose);
}

/// The motions that ended among everything a reader gives, until the stream ends.
pub fn ended(mut reader: EventReader) -> Vec<Detection> {
    let mut found = Vec::new();
    while !reader.is_ended() {
        found.extend(
            reader
                .wait(Duration::from_secs(60))
                .filter(|e| e.phase == Phase::End)
                .map(|e| e.detection()),
        );
    }
    found
}

fn session(model: &Arc<TemplateModel>, _: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let options = SessionOptions {
        overload: OverflowPolicy::Wait,
        frame_capacity: 7,
        ..Default::default()
    };
    let (session, readers) = Session::start(model, Box::new(Played::new(poses)), &options).unwrap();
    let found = readers.into_iter().map(ended).next().unwrap();
    let status = session.join();
    assert!(status.ended && status.frames == poses.len() as u64 && status.dropped_frames == 0);
    found
}

/// The same stream three times at once, so that one thread has two of them.
fn pool(model: &Arc<TemplateModel>, _: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let pool = Pool::new(model, 2).unwrap();
    let options = SessionOptions {
        frame_capacity: 9,
        ..Default::default()
    };
    let (mut feeds, mut readers) = (Vec::new(), Vec::new());
    for PoolStream {
        feed,
        readers: of_stream,
        ..
    } in (0..3).map(|_| pool.open(&options))
    {
        feeds.push((feed, Box::<Frame>::default()));
        readers.extend(of_stream);
    }
    let rig = Arc::new(Rig::of_roles());
    feeds
        .iter_mut()
        .for_each(|(feed, _)| feed.set_rig(PerformerId(0), &rig));
    for (time_secs, pose) in poses {
        for (feed, frame) in &mut feeds {
            fill(frame, *time_secs, pose);
            assert!(feed.send(frame));
        }
    }
    drop(feeds);
    let mut found = readers.into_iter().map(ended);
    let first = found.next().unwrap();
    found.for_each(|other| assert_eq!(other, first));
    pool.join();
    first
}
