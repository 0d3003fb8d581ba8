//! Opens sinks by their addresses.

use std::io::{self, Write};

use crate::osc::OscSink;
use crate::websocket::WebSocketSink;
use crate::{Address, LiveError, NamedEvent, Sink};

/// A sink that has been opened.
pub struct OpenSink {
    /// Ready for events.
    pub sink: Box<dyn Sink>,
    /// Name of the sink, with the port that was free if it asked for any.
    pub name: String,
    /// Notes for the user, each in a sentence.
    pub notes: Vec<String>,
}

/// Opens `osc://HOST:PORT` or `ws://HOST:PORT`.
///
/// # Errors
/// Another address, an option that the sink does not have, a socket that cannot be opened.
pub fn open_sink(address: &Address) -> Result<OpenSink, LiveError> {
    match address.kind.as_str() {
        "osc" => Ok(OpenSink {
            sink: Box::new(OscSink::open(address)?),
            name: address.to_string(),
            notes: Vec::new(),
        }),
        "ws" => {
            let (sink, at) = WebSocketSink::open(address)?;
            let mut notes: Vec<String> = crate::address::openness(at).into_iter().collect();
            notes.push(format!("events at ws://{at}"));
            Ok(OpenSink {
                sink: Box::new(sink),
                name: format!("ws://{at}"),
                notes,
            })
        }
        other => Err(LiveError::Address(format!(
            "{address}: no sink is called {other}; the sinks are terminal:-, json:-, json:FILE, osc://HOST:PORT, ws://HOST:PORT"
        ))),
    }
}

/// One JSON object a line.
pub struct JsonLines<W>(pub W);

impl<W: Write + Send> Sink for JsonLines<W> {
    fn emit(&mut self, event: &NamedEvent<'_>) -> io::Result<()> {
        writeln!(self.0, "{}", event.json())?;
        // An event that waits in a buffer is late.
        self.0.flush()
    }
}
