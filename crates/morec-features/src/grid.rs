//! The even grid of instants that a stream of poses is brought to.

/// A pause longer than this ends one stretch of stream and begins another: what lies between is unknown, and
/// interpolating it would invent motion.
pub const MAX_GAP_SECS: f64 = 0.5;

/// True if a pose at `time_secs` begins a new stretch after one at `last_secs`: it comes too long after it, or from another clock.
#[inline]
pub fn breaks_stretch(last_secs: f64, time_secs: f64) -> bool {
    time_secs > last_secs + MAX_GAP_SECS || time_secs < last_secs - MAX_GAP_SECS
}

/// Clock of a stream at a fixed rate: which grid frames a new pose completes, and where between two poses they lie.
///
/// `S` is what is known of a pose. The first pose of a stretch is its grid frame 0.
#[derive(Debug, Clone)]
pub struct Grid<S> {
    rate_hz: f64,
    /// Time of grid frame 0 of this stretch.
    origin_secs: f64,
    /// Grid frames made in this stretch.
    frames: u64,
    last_secs: Option<f64>,
    last: S,
    /// Time of the pose whose grid frames are being taken.
    now_secs: Option<f64>,
    now: S,
}

/// A grid frame between two poses, or at the first.
#[derive(Debug)]
pub struct GridFrame<'a, S> {
    /// The pose before, and how far from it to this one the frame lies, 0 … 1; `None` where it is this pose itself.
    pub before: Option<(&'a S, f64)>,
    /// The pose at the frame's time, or the next one after it.
    pub now: &'a S,
}

impl<S: Clone> Grid<S> {
    /// Frames at `rate_hz`. Poses are copied into the places that two copies of `blank` take.
    pub fn new(rate_hz: f64, blank: S) -> Self {
        Self {
            rate_hz,
            origin_secs: 0.0,
            frames: 0,
            last_secs: None,
            last: blank.clone(),
            now_secs: None,
            now: blank,
        }
    }

    /// Time of the first frame of the present stretch.
    pub fn origin_secs(&self) -> f64 {
        self.origin_secs
    }

    /// The last pose of the present stretch.
    pub fn last(&self) -> Option<&S> {
        self.last_secs.map(|_| &self.last)
    }

    /// True if a pose at `time_secs` would begin a new stretch.
    pub fn breaks_at(&self, time_secs: f64) -> bool {
        self.last_secs
            .is_some_and(|last_secs| breaks_stretch(last_secs, time_secs))
    }

    /// True if a pose at `time_secs` comes too late to count, or at no time at all.
    pub fn ignores(&self, time_secs: f64) -> bool {
        !time_secs.is_finite() || self.last_secs.is_some_and(|last| time_secs <= last)
    }

    /// Takes a pose that is not [ignored](Self::ignores), after [`next_frame`](Self::next_frame) gave all frames of
    /// the pose before. Its own come from there.
    pub fn push(&mut self, time_secs: f64, now: &S) {
        if self.last_secs.is_none() {
            self.origin_secs = time_secs;
            self.frames = 0;
        }
        self.now_secs = Some(time_secs);
        self.now.clone_from(now);
    }

    /// The next grid frame in `(last, time_secs]` of the pose that was pushed; `None` if there are no more.
    pub fn next_frame(&mut self) -> Option<GridFrame<'_, S>> {
        // A source at the model's own rate must fall on the grid whatever its clock's last bits say.
        let tolerance_secs = 1e-6;
        let time_secs = self.now_secs?;
        let grid_secs = self.origin_secs + self.frames as f64 / self.rate_hz;
        let is_first = self.last_secs.is_none();
        if (is_first && self.frames > 0) || (!is_first && grid_secs > time_secs + tolerance_secs) {
            self.last_secs = self.now_secs.take();
            std::mem::swap(&mut self.last, &mut self.now);
            return None;
        }
        self.frames += 1;
        let before = self.last_secs.map(|last_secs| {
            let t = (grid_secs - last_secs) / (time_secs - last_secs);
            let is_now = time_secs - grid_secs < tolerance_secs;
            (&self.last, if is_now { 1.0 } else { t })
        });
        Some(GridFrame {
            before,
            now: &self.now,
        })
    }

    /// Ends the stretch.
    pub fn end(&mut self) {
        self.last_secs = None;
        self.now_secs = None;
        self.frames = 0;
    }
}
