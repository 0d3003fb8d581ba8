//! Open Sound Control: events as messages over UDP ([`OscSink`]); packets to messages and back.

mod packet;
mod sink;

pub use packet::{Arg, Message, begin_bundle, read, write_element, write_message};
pub use sink::OscSink;
