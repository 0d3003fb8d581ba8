//! The last rows of a stream, to compare performances with samples.

use crate::TimeSpan;
use crate::features::{RowLayout, Rows};
use crate::templates::{Deviation, DeviationMeter, RecentRows, TemplateModel};

/// Motion is remembered for so long, seconds: longer performances, and those reported later, are not compared.
pub(super) const MEMORY_SECS: f64 = 20.0;

/// Remembers rows and compares stretches of them. Nothing is allocated after construction.
#[derive(Debug)]
pub(super) struct PerformanceMemory {
    tick_hz: f64,
    rows: RecentRows,
    ended: bool,
    /// The stream's clock at the first row.
    origin_secs: f64,
    /// With room for all that is remembered.
    stretch: Rows,
    meter: DeviationMeter,
}

impl PerformanceMemory {
    pub(super) fn new(model: &TemplateModel) -> Self {
        let (dim, tick_hz) = (RowLayout::of(model.bones).dim(), model.features.tick_hz());
        let capacity = remembered(tick_hz);
        let repetitions = model.activities.iter().flat_map(|a| &a.repetitions);
        let longest = repetitions.map(|s| s.rows.len()).max().unwrap_or(0);
        // A template that is not run through around needs half the room.
        let longest = longest.max(model.longest().div_ceil(2));
        Self {
            tick_hz,
            rows: RecentRows::new(dim, capacity),
            ended: false,
            origin_secs: 0.0,
            stretch: Rows::with_room(dim, capacity),
            meter: DeviationMeter::with_room(model.bones, tick_hz, (longest, capacity)),
        }
    }

    /// Takes the next row of the stretch that began at `origin_secs`.
    pub(super) fn push(&mut self, row: &[f32], origin_secs: f64) {
        if std::mem::take(&mut self.ended) {
            self.rows.restart();
        }
        self.origin_secs = origin_secs;
        self.rows.push(row);
    }

    /// The stretch is over: the next row begins another.
    pub(super) fn end(&mut self) {
        self.ended = true;
    }

    /// How far the performance in `span` was from the nearest of `samples`; with `around`, they are turns of what repeats.
    pub(super) fn compare<'r>(
        &mut self,
        span: TimeSpan,
        samples: impl Iterator<Item = &'r Rows> + Clone,
        around: bool,
    ) -> Option<Deviation> {
        let origin_secs = self.origin_secs;
        let pushed = self.rows.pushed();
        let ticks = TimeSpan::new(span.start_secs - origin_secs, span.stop_secs - origin_secs)
            .frames_among(pushed, self.tick_hz);
        if ticks.start + remembered(self.tick_hz) < pushed {
            return None;
        }
        self.stretch.clear();
        for tick in ticks {
            self.stretch.push(self.rows.row(tick));
        }
        self.meter.compare(samples, &self.stretch, around)?;
        self.meter.in_short()
    }
}

/// Ticks that are remembered.
fn remembered(tick_hz: f64) -> usize {
    (MEMORY_SECS * tick_hz).ceil() as usize
}

impl Clone for PerformanceMemory {
    /// By hand, because a copied vector has room only for what it holds.
    fn clone(&self) -> Self {
        Self {
            rows: self.rows.clone(),
            stretch: Rows::with_room(self.stretch.dim(), remembered(self.tick_hz)),
            meter: self.meter.emptied(),
            ..*self
        }
    }
}
