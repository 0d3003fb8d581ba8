//! The clock for arrivals, reports and events of a session.

use std::sync::OnceLock;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Seconds since 1970 (UTC), steady: anchored to the wall clock once in a process, and never set back after that.
pub fn wall_now_secs() -> f64 {
    static ANCHOR: OnceLock<(Instant, f64)> = OnceLock::new();
    let (begun, begun_secs) = ANCHOR.get_or_init(|| {
        let since = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        (Instant::now(), since.as_secs_f64())
    });
    begun_secs + begun.elapsed().as_secs_f64()
}
