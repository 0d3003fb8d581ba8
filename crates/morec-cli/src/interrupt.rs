//! Ctrl-C as a request to end, passed to the running operation.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

/// Exit code of a command that was stopped by Ctrl-C.
pub const STOPPED: u8 = 130;

/// Set when somebody wants the program to end.
pub fn stop_on_ctrl_c() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = stop.clone();
    let handler = move || {
        if set.swap(true, Ordering::Relaxed) {
            // Asked twice: whatever is in the way stays there.
            std::process::exit(130);
        }
    };
    ctrlc::set_handler(handler).context("cannot take Ctrl-C")?;
    Ok(stop)
}
