//! Live recognition: poses in, detections out. A reported detection is never revoked. [`PerformerStream`] has all options of a
//! stream and is the place to start; [`Session`] runs a source, recognition and readers on threads. Nothing here opens files or
//! sockets: sources and sinks are in `morec-live`.
//!
//! Four ways to run it, with the same detections:
//!
//! - [`PerformerStream`]: points or a skeleton of one performer in, events out, on the caller's thread, with [`StreamOptions`].
//! - [`Recognizer`]: poses of one performer in, detections out.
//! - [`Session`]: a [`Source`] on a thread, recognition on another, events for any number of readers. Several
//!   performers, skeletons that change, sources that break off and come back.
//! - [`Pool`]: many streams on a few threads.
//!
//! Real-time contract: construction allocates and may fail with a reason; [`Recognizer::push`] afterwards does not
//! allocate, lock, log or fail. A recogniser is owned by one thread at a time. Detections are the same however the
//! stream is cut into pushes. In sessions and pools frames travel over bounded wait-free rings; when one is full,
//! [`OverflowPolicy`] says who gives way, and everything that is dropped is counted in [`Status`].
//!
//! A session that the caller feeds with places of joints, which know their roles:
//!
//! ```no_run
//! use std::sync::Arc;
//! use std::time::Duration;
//!
//! use morec::MotionIndex;
//! use morec::live::{Frame, PerformerId, Rig, Session, SessionOptions, wall_now_secs};
//!
//! # fn next_pose() -> Option<(f64, morec::KeyPose)> { None }
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let index = MotionIndex::load("signs.index")?;
//! let (session, mut feed, mut readers) = Session::open(&index.model, &SessionOptions::default())?;
//! let mut reader = readers.remove(0);
//! let reporting = std::thread::spawn(move || {
//!     while !reader.is_ended() {
//!         if let Some(event) = reader.wait(Duration::from_millis(50)) {
//!             println!("{event:?}");
//!         }
//!     }
//! });
//! let performer = PerformerId(0);
//! feed.set_rig(performer, &Arc::new(Rig::of_roles()));
//! let mut frame: Box<Frame> = Box::default();
//! while let Some((secs, pose)) = next_pose() {
//!     (frame.actor, frame.time_secs, frame.wall_secs) = (performer, secs, wall_now_secs());
//!     frame.set_key_pose(&pose);
//!     feed.send(&mut frame);                       // leaves a used frame, so that nothing is allocated
//! }
//! drop(feed);                                      // ends the stream: what its last moments hold is reported
//! println!("{} frames", session.join().frames);
//! # reporting.join().map_err(|_| "panicked")?;
//! # Ok(())
//! # }
//! ```

mod broadcast;
mod clock;
mod detection;
mod divided;
mod early;
mod event;
mod event_buffer;
mod event_tracker;
mod feed;
mod frame;
mod of_clip;
mod of_index;
mod performance_memory;
mod performer;
mod performer_stream;
mod performer_table;
mod pipeline;
mod pool;
mod pose;
mod recognizer;
mod recognizer_cache;
mod recording;
mod session;
mod session_error;
mod shown;
mod source;
mod start;
mod status;
mod stream_options;
mod svrdm;
mod sync;
mod template_pipeline;
mod waits;
mod waker;
mod worker;

pub use crate::index::{Model, SensitivityError};
pub use broadcast::EventReader;
pub use clock::wall_now_secs;
pub use detection::{Detection, EarlyDetection, SCORE};
pub use divided::{PartMatcher, match_clip, recognize_matched};
pub use event::{Event, EventOptions, Phase};
pub use feed::{FeedSender, OverflowPolicy};
pub use frame::{Frame, PerformerId, Rig};
pub use of_clip::{recognize_clip, recognize_clip_in_session, recognize_poses};
pub use performer::Performer;
pub use performer_stream::{PerformerStream, StreamError};
pub use performer_table::{Arrival, PerformerTable, largest_holder};
pub use pool::{Pool, PoolStream};
pub use pose::{PoseExtractor, RecognizerInput};
pub use recognizer::Recognizer;
pub use recognizer_cache::RecognizerCache;
pub use recording::{Recording, RecordingError};
pub use session::{Session, SessionOptions, Threading};
pub use session_error::SessionError;
pub use shown::ShownBones;
pub use source::{Source, SourceCounts, SourceEvent, SourceItem};
pub use start::StartError;
pub use status::{MAX_PERFORMERS, PerformerStatus, Status, StatusHandle};
pub use stream_options::{OptionError, StreamOptions};
pub(crate) use template_pipeline::restricted;
pub use waits::LatencyHistogram;
