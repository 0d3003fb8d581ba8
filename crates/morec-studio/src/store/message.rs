//! Messages of the database thread, and how it calls for a frame that shows them.

use std::sync::Arc;

/// Calls for a new frame, from any thread.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A message of the database thread.
#[derive(Debug, Clone, PartialEq)]
pub enum StoreMessage {
    /// An edit was made.
    Done(String),
    /// An edit was not made, and why.
    Failed(String),
}
