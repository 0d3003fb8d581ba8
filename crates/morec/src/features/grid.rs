//! The even grid of instants that a stream of poses is brought to.

use super::MAX_GAP_SECS;

/// Clock of a stream at a fixed rate: which grid frames a new pose completes, and where between two poses they lie.
///
/// `S` is what is known of a pose. The first pose of a stretch is its grid frame 0.
#[derive(Debug, Clone)]
pub(crate) struct Grid<S> {
    rate_hz: f64,
    /// Time of grid frame 0 of this stretch.
    origin_secs: f64,
    /// Grid frames made in this stretch.
    frames: u64,
    last: Option<(f64, S)>,
}

impl<S> Grid<S> {
    pub fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            origin_secs: 0.0,
            frames: 0,
            last: None,
        }
    }

    /// Time of the first frame of the present stretch.
    pub fn origin_secs(&self) -> f64 {
        self.origin_secs
    }

    /// The last pose of the present stretch.
    pub fn last(&self) -> Option<&S> {
        self.last.as_ref().map(|(_, pose)| pose)
    }

    /// True if a pose at `time_secs` would begin a new stretch.
    pub fn breaks_at(&self, time_secs: f64) -> bool {
        let last = self.last.as_ref().map(|(secs, _)| *secs);
        last.is_some_and(|last| time_secs > last + MAX_GAP_SECS || time_secs < last - MAX_GAP_SECS)
    }

    /// Whether a pose at `time_secs` comes too late to count, or at no time at all.
    pub fn ignores(&self, time_secs: f64) -> bool {
        !time_secs.is_finite()
            || self
                .last
                .as_ref()
                .is_some_and(|(last, _)| time_secs <= *last)
    }

    /// Takes a pose that is not [ignored](Self::ignores) and calls `frame` for every grid frame in
    /// `(last, time_secs]`: with the pose before and how far from it to this one (0 … 1) the frame lies, or with
    /// nothing before where it is this pose itself.
    pub fn push(&mut self, time_secs: f64, now: S, frame: &mut impl FnMut(Option<(&S, f64)>, &S)) {
        match &self.last {
            None => {
                self.origin_secs = time_secs;
                self.frames = 1;
                frame(None, &now);
            }
            Some((last_secs, last)) => {
                // A source at the model's own rate must fall on the grid whatever its clock's last bits say.
                let tolerance_secs = 1e-6;
                loop {
                    let grid_secs = self.origin_secs + self.frames as f64 / self.rate_hz;
                    if grid_secs > time_secs + tolerance_secs {
                        break;
                    }
                    let t = (grid_secs - last_secs) / (time_secs - last_secs);
                    let t = if time_secs - grid_secs < tolerance_secs {
                        1.0
                    } else {
                        t
                    };
                    frame(Some((last, t)), &now);
                    self.frames += 1;
                }
            }
        }
        self.last = Some((time_secs, now));
    }

    /// Ends the stretch.
    pub fn end(&mut self) {
        self.last = None;
        self.frames = 0;
    }
}
