//! From a stream of poses at any rate to pose rows at the model's.

use mocap::math::{Quat, same_hemisphere, slerp};
use morec_features::Grid;
use morec_features::Pushed;

use super::{MAX_PIVOTS, PivotPose, PivotSet, PoseParams, QuaternionSign, RootForm};

/// Rotations of one frame: the root's in the world, every other pivot's relative to its parent pivot.
type Locals = [Quat; MAX_PIVOTS];

/// Makes pose rows of poses, for training and for live streams alike (thesis §4.2).
///
/// Poses come at any rate, even or uneven; between them, rotations are interpolated along the shortest arc. A row is
/// complete once the frame after it is known, as the root's part is the turn to that frame; the last row of a
/// stretch repeats the turn before it. Rows depend on the poses alone, not on how they were cut into pushes. Nothing
/// is allocated after `new`.
#[derive(Debug, Clone)]
pub struct PoseStream {
    parents: [usize; MAX_PIVOTS],
    grid: Grid<Locals>,
    rows: RowMaker,
}

/// Grid frames in, rows out, one frame later.
#[derive(Debug, Clone)]
struct RowMaker {
    pivots: usize,
    params: PoseParams,
    /// True if a grid frame of this stretch waits for the next.
    waits: bool,
    /// That frame, with the signs it goes into its row with.
    waiting: Locals,
    /// The turn of the root in the last row.
    turn: Quat,
}

impl PoseStream {
    /// A stream of rows over `set`. `params` are taken as they are:
    /// [`PoseParams::check`] says whether they can be.
    pub fn new(set: &PivotSet, params: &PoseParams) -> Self {
        let mut parents = [0; MAX_PIVOTS];
        (0..set.len()).for_each(|pivot| parents[pivot] = set.parent(pivot));
        let rows = RowMaker {
            pivots: set.len(),
            params: *params,
            waits: false,
            waiting: [Quat::identity(); MAX_PIVOTS],
            turn: Quat::identity(),
        };
        Self {
            parents,
            grid: Grid::new(params.rate_hz, [Quat::identity(); MAX_PIVOTS]),
            rows,
        }
    }

    /// Values in a row, `4 pivots`: each as `w x y z`.
    #[inline]
    pub fn dim(&self) -> usize {
        4 * self.rows.pivots
    }

    /// Time of the present stretch's first row: row `i` is the pose at `origin_secs() + i / rate_hz`.
    #[inline]
    pub fn origin_secs(&self) -> f64 {
        self.grid.origin_secs()
    }

    /// True if a pose at `time_secs` would begin a new stretch, so that the caller can
    /// [`finish`](PoseStream::finish) the old one first.
    #[inline]
    pub fn breaks_at(&self, time_secs: f64) -> bool {
        self.grid.breaks_at(time_secs)
    }

    /// Takes the pose at `time_secs` on the stream's clock; calls `out` with every row now complete.
    ///
    /// A pivot that `pose` does not show keeps its last rotation relative to its parent;
    /// [`Pushed::NoHips`] until the root has been seen once. At most `MAX_GAP_SECS` of rows come of one push.
    pub fn push(
        &mut self,
        time_secs: f64,
        pose: &PivotPose,
        out: &mut impl FnMut(&[f32]),
    ) -> Pushed {
        if !time_secs.is_finite() {
            return Pushed::Ignored;
        }
        let restarted = self.breaks_at(time_secs);
        if restarted {
            self.finish(out);
        }
        if self.grid.ignores(time_secs) {
            return Pushed::Ignored;
        }
        let Some(locals) = self.locals(pose) else {
            return Pushed::NoHips;
        };
        self.grid.push(time_secs, &locals);
        while let Some(frame) = self.grid.next_frame() {
            match frame.before {
                Some((last, t)) => {
                    let between = self.rows.between(last, frame.now, t);
                    self.rows.grid_frame(&between, out);
                }
                None => self.rows.grid_frame(frame.now, out),
            }
        }
        if restarted {
            Pushed::Restarted
        } else {
            Pushed::Taken
        }
    }

    /// Ends the stretch: calls `out` with the row that still waited for the next frame, and forgets it.
    pub fn finish(&mut self, out: &mut impl FnMut(&[f32])) {
        self.rows.finish(out);
        self.grid.end();
    }

    fn locals(&self, pose: &PivotPose) -> Option<Locals> {
        let last = self.grid.last();
        let mut locals = last.copied().unwrap_or([Quat::identity(); MAX_PIVOTS]);
        match pose.get(0) {
            Some(root) => locals[0] = *root,
            None => _ = last?,
        }
        for pivot in 1..self.rows.pivots {
            if let (Some(parent), Some(own)) = (pose.get(self.parents[pivot]), pose.get(pivot)) {
                locals[pivot] = parent.conjugate() * own;
            }
        }
        Some(locals)
    }
}

impl RowMaker {
    fn between(&self, last: &Locals, now: &Locals, t: f64) -> Locals {
        let mut between = *now;
        for pivot in 0..self.pivots {
            between[pivot] = slerp(&last[pivot], &now[pivot], t);
        }
        between
    }

    /// Ends the stretch with the row that still waits.
    fn finish(&mut self, out: &mut impl FnMut(&[f32])) {
        if self.waits {
            self.emit(out);
        }
        self.waits = false;
        self.turn = Quat::identity();
    }

    /// Takes the next frame of the grid; the one before it is complete now.
    fn grid_frame(&mut self, locals: &Locals, out: &mut impl FnMut(&[f32])) {
        if self.waits {
            let (now, next) = (self.waiting[0], locals[0]);
            let turn = match self.params.root {
                RootForm::World => next * now.conjugate(),
                RootForm::Body => now.conjugate() * next,
            };
            self.turn = same_hemisphere(&Quat::identity(), turn);
            self.emit(out);
        }
        self.waiting[0] = locals[0];
        for pivot in 1..self.pivots {
            let like = match self.params.signs {
                QuaternionSign::Continuous if self.waits => self.waiting[pivot],
                _ => Quat::identity(),
            };
            self.waiting[pivot] = same_hemisphere(&like, locals[pivot]);
        }
        self.waits = true;
    }

    fn emit(&self, out: &mut impl FnMut(&[f32])) {
        let mut row = [0f32; 4 * MAX_PIVOTS];
        for (pivot, values) in row.chunks_exact_mut(4).take(self.pivots).enumerate() {
            let q = if pivot == 0 {
                &self.turn
            } else {
                &self.waiting[pivot]
            };
            values.copy_from_slice(&[q.w as f32, q.i as f32, q.j as f32, q.k as f32]);
        }
        out(&row[..4 * self.pivots]);
    }
}
