//! The last rows of a stream.

/// A ring of rows by tick. Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct RecentRows {
    /// Row of tick `n` at slot `n & mask`.
    rows: Vec<f32>,
    dim: usize,
    mask: usize,
    pushed: usize,
}

impl RecentRows {
    /// With room for at least `capacity` rows of `dim` values.
    pub fn new(dim: usize, capacity: usize) -> Self {
        let capacity = capacity.next_power_of_two();
        Self {
            rows: vec![0.0; dim * capacity],
            dim,
            mask: capacity - 1,
            pushed: 0,
        }
    }

    /// Takes the row of the next tick, in the place of the oldest when the room is used up.
    pub fn push(&mut self, row: &[f32]) {
        let slot = self.pushed & self.mask;
        self.rows[slot * self.dim..][..self.dim].copy_from_slice(row);
        self.pushed += 1;
    }

    /// The next row is that of tick 0.
    pub fn restart(&mut self) {
        self.pushed = 0;
    }

    /// Number of rows taken, which is the next tick.
    pub fn pushed(&self) -> usize {
        self.pushed
    }

    /// The row of one of the last ticks.
    pub fn row(&self, tick: usize) -> &[f32] {
        &self.rows[(tick & self.mask) * self.dim..][..self.dim]
    }
}
