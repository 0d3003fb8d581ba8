//! Threads and rings: sessions of both layouts and a pool, small enough for Miri to watch every step of them.
//!
//! `MIRIFLAGS=-Zmiri-disable-isolation cargo +nightly miri test -p morec --test threads`

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;
use std::time::Duration;

use morec::index::MotionIndex;
use morec::live::{
    Event, EventReader, Frame, Model, OverflowPolicy, PerformerId, Pool, Rig, Session,
    SessionOptions, Source, SourceEvent, Threading,
};
use morec::math::Axis;
use morec::roles::Role;

/// Chunks of the smallest segment and one more, at 120 Hz.
const FRAMES: u32 = if cfg!(miri) { 16 * 5 + 3 } else { 1200 };

fn model(name: &str) -> Model {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/index/").to_owned() + name;
    MotionIndex::from_bytes(&std::fs::read(path).unwrap())
        .unwrap()
        .model
}

/// Joints that swing, each by itself.
fn fill(frame: &mut Frame, number: u32) {
    frame.clear(Role::COUNT);
    frame.time_secs = f64::from(number) / 120.0;
    for joint in 0..Role::COUNT {
        let swing = (0.1 * f64::from(number) + joint as f64).sin();
        frame.pose.rotations[joint] = Axis::ALL[joint % 3].rotation(swing);
        frame.pose.positions[joint] =
            frame.pose.rotations[joint] * Axis::Y.unit().into_inner() * joint as f64;
    }
}

struct Swinging(u32);

impl Source for Swinging {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        self.0 += 1;
        match self.0 {
            1 => SourceEvent::Rig(PerformerId(0), Arc::new(Rig::of_roles())),
            // A gap in the middle.
            number if number == FRAMES / 2 => SourceEvent::Gone(PerformerId(0)),
            number if number <= FRAMES + 2 => {
                fill(frame, number);
                SourceEvent::Frame
            }
            _ => SourceEvent::Ended,
        }
    }
}

fn all(mut reader: EventReader) -> Vec<Event> {
    let mut events = Vec::new();
    while !reader.is_ended() {
        events.extend(reader.wait(Duration::from_millis(500)));
    }
    events
}

#[test]
fn a_session_in_stages_goes_through_all_its_rings() {
    let model = model("svrdm_v1.index");
    let run = |layout| {
        let options = SessionOptions {
            layout,
            frame_capacity: 5,
            ..SessionOptions::default()
        };
        let (session, readers) = Session::start(&model, Box::new(Swinging(0)), &options).unwrap();
        let events: Vec<Event> = readers.into_iter().flat_map(all).collect();
        let status = session.join();
        assert!(status.ended && status.dropped_frames == 0 && status.unusable_frames == 0);
        (status.frames, events)
    };
    let (inline, staged) = (run(Threading::Inline), run(Threading::Stages));
    assert_eq!(inline.0, u64::from(FRAMES));
    assert_eq!(inline.0, staged.0);
    assert_eq!(inline.1.len(), staged.1.len());
}

#[test]
fn sessions_that_are_stopped_or_dropped_leave_no_thread_behind() {
    for layout in [Threading::Inline, Threading::Stages] {
        let model = model("svrdm_v1.index");
        let options = SessionOptions {
            layout,
            overload: OverflowPolicy::Drop,
            ..SessionOptions::default()
        };
        let (session, mut feed, readers) = Session::open(&model, &options).unwrap();
        feed.set_rig(PerformerId(0), &Arc::new(Rig::of_roles()));
        let mut frame: Box<Frame> = Box::default();
        for number in 0..20 {
            fill(&mut frame, number);
            feed.send(&mut frame);
        }
        // Somebody still holds the feed, and goes on.
        assert!(session.stop().ended);
        (0..500).for_each(|_| _ = feed.send(&mut frame));
        drop(readers);
    }
}

#[test]
fn a_pools_streams_end_with_their_feeds() {
    let pool = Pool::new(&model("v1.index"), 2).unwrap();
    let options = SessionOptions {
        frame_capacity: 3,
        ..SessionOptions::default()
    };
    let mut open: Vec<_> = (0..3).map(|_| pool.open(&options)).collect();
    let mut frame: Box<Frame> = Box::default();
    for stream in &mut open {
        stream
            .feed
            .set_rig(PerformerId(0), &Arc::new(Rig::of_roles()));
        for number in 0..FRAMES / 8 {
            fill(&mut frame, number);
            assert!(stream.feed.send(&mut frame));
        }
    }
    let handles: Vec<_> = open.iter().map(|stream| stream.status.clone()).collect();
    drop(open);
    pool.join();
    assert!(
        handles
            .iter()
            .all(|h| h.get().ended && h.get().frames == u64::from(FRAMES / 8))
    );
}
