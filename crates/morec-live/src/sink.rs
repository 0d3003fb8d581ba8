//! Sinks: receivers of events.

use std::io;

use crate::NamedEvent;

/// Takes events, one by one, without blocking the caller.
pub trait Sink: Send {
    /// Emits one event.
    ///
    /// # Errors
    /// The event could not be written or sent; the next one may.
    fn emit(&mut self, event: &NamedEvent<'_>) -> io::Result<()>;
}
