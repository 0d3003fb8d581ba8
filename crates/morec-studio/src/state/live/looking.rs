//! The part of the stream's last minutes that the timeline shows.

use super::tracked::KEPT_SECS;

/// Lengths that can be chosen, seconds, with their names.
pub const SPANS: [(f64, &str); 4] = [
    (20.0, "20 s"),
    (60.0, "1 min"),
    (120.0, "2 min"),
    (KEPT_SECS, "5 min"),
];
/// Shortest view, seconds.
const SHORTEST: f64 = 5.0;

/// What is in view, seconds on the stream's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Looking {
    pub span_secs: f64,
    /// The end of the view when it stands still; `None` goes on with the stream.
    pub until_secs: Option<f64>,
}

impl Default for Looking {
    fn default() -> Self {
        Self {
            span_secs: 60.0,
            until_secs: None,
        }
    }
}

impl Looking {
    /// First and last moment in view.
    pub fn extent(&self, now_secs: f64) -> (f64, f64) {
        let to = match self.until_secs {
            // A view that stands still ends with what is kept.
            Some(until) => until.max(oldest(now_secs) + self.span_secs),
            None => now_secs.max(self.span_secs),
        };
        (to - self.span_secs, to)
    }

    /// Shows this many seconds; a view that stands still keeps its end.
    pub fn show(&mut self, span_secs: f64, now_secs: f64) {
        self.span_secs = span_secs.clamp(SHORTEST, KEPT_SECS);
        self.move_by(0.0, now_secs);
    }

    /// Looks this many seconds back (negative) or on; at the present it goes on with the stream.
    pub fn move_by(&mut self, secs: f64, now_secs: f64) {
        let (_, to) = self.extent(now_secs);
        let to = (to + secs).max(oldest(now_secs) + self.span_secs);
        let still = to < now_secs && (secs != 0.0 || self.until_secs.is_some());
        self.until_secs = still.then_some(to);
    }

    /// Moves the view to a stretch that is not in it.
    pub fn bring(&mut self, (start, stop): (f64, f64), now_secs: f64) {
        let (from, to) = self.extent(now_secs);
        if start < from || stop > to {
            self.move_by(0.5 * (start + stop) - 0.5 * (from + to), now_secs);
        }
    }
}

/// The oldest moment that is kept.
fn oldest(now_secs: f64) -> f64 {
    (now_secs - KEPT_SECS).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_goes_back_stands_still_and_comes_back_to_the_present() {
        let mut view = Looking::default();
        assert_eq!(view.extent(10.0), (0.0, 60.0));
        assert_eq!(view.extent(200.0), (140.0, 200.0));
        view.move_by(-100.0, 200.0);
        assert_eq!(view.extent(200.0), (40.0, 100.0));
        assert_eq!(view.extent(230.0), (40.0, 100.0), "it stands still");
        view.move_by(-100.0, 230.0);
        assert_eq!(view.extent(230.0), (0.0, 60.0), "nothing is before");
        // What is no longer kept leaves the view.
        assert_eq!(view.extent(400.0), (100.0, 160.0));
        view.bring((350.0, 352.0), 400.0);
        assert_eq!(view.extent(400.0), (321.0, 381.0));
        view.move_by(30.0, 400.0);
        assert_eq!(view.until_secs, None, "it goes on with the stream");
    }

    #[test]
    fn as_much_is_shown_as_is_kept() {
        let mut view = Looking::default();
        view.show(1e9, 1000.0);
        assert_eq!(view.extent(1000.0), (700.0, 1000.0));
        view.show(20.0, 1000.0);
        assert_eq!(view.extent(1000.0), (980.0, 1000.0));
        assert_eq!(view.until_secs, None);
        view.show(0.0, 1000.0);
        assert_eq!(view.span_secs, SHORTEST);
    }
}
