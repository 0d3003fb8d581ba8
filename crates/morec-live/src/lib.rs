//! Live sources and sinks for [`morec::live`]: trackers over VMC, Axis broadcasts and lines of JSON, clips played as if
//! somebody performed them; events over OSC, WebSockets and lines of JSON.
//!
//! ```no_run
//! use morec::live::{Session, SessionOptions};
//! use morec_live::{Address, SourceOptions, open_sink, open_source};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let index = morec::MotionIndex::load("signs.index")?;
//! let opened = open_source(&"vmc://127.0.0.1:39539".parse()?, &SourceOptions::default())?;
//! let mut sink = open_sink(&"osc://127.0.0.1:9000".parse()?)?.sink;
//! let options = SessionOptions { overload: opened.overload, ..Default::default() };
//! let (_session, mut readers) = Session::start(&index.model, opened.source, &options)?;
//! while !readers[0].is_ended() {
//!     if let Some(event) = readers[0].wait(std::time::Duration::from_millis(50)) {
//!         let class = index.model.class_name(event.class);
//!         sink.emit(&morec_live::NamedEvent { event: &event, class, source: &opened.name })?;
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! This crate owns sockets and threads, and the protocols of devices as bytes ([`vmc`], [`axis`], [`osc`]), which need neither. It prints nothing:
//! what a source notices is in its [`Notices`].

mod address;
mod advice;
pub mod axis;
mod broadcast;
mod clip;
mod error;
mod event;
mod json;
mod json_line;
mod lines;
mod network;
mod notices;
pub mod osc;
mod places;
mod playable;
mod ready;
mod sink;
mod sinks;
mod sources;
mod summary;
mod threads;
mod unnamed;
pub mod vmc;
mod webcam;
mod websocket;

pub use address::Address;
pub use advice::{Advice, advice_of_status};
pub use axis::{AxisSource, axis_skeleton};
pub use broadcast::Broadcast;
pub use clip::{ClipSource, PAUSE_SECS};
pub use error::LiveError;
pub use event::NamedEvent;
pub use json::JsonSource;
pub use json_line::{PoseLine, write_pose_lines};
pub use network::{Accidents, Network};
pub use notices::Notices;
pub use osc::OscSink;
pub use playable::{PlayableClip, load};
pub use sink::Sink;
pub use sinks::{JsonLines, OpenSink, open_sink};
pub use sources::{OpenSource, SourceOptions, open_source};
pub use summary::summary;
pub use threads::pin_thread;
pub use vmc::VmcSource;
pub use webcam::WebcamPage;
pub use websocket::WebSocketSink;
#[doc(hidden)]
pub use websocket::greet::heard;
