//! Statistics of sliding windows that describe one or two seconds of motion independently of its phase.

use crate::features::{FeatureParams, Rows};

/// Rows of window statistics and how they lie in time.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowRows {
    /// `[mean x; 2 std x; 0.3 rms v; 0.5 mean root; 0.2 std root]` for each window: 9 b + 8 values.
    pub rows: Rows,
    /// Windows a second; row `i`'s window is centred on `i / rate_hz` seconds.
    pub rate_hz: f64,
}

/// Statistics of windows of `window_secs` around every `hop`th tick of feature rows made with `params`. At the ends
/// windows are cut short. O(rows · values), whatever the window.
pub fn window_rows(
    rows: &Rows,
    params: &FeatureParams,
    window_secs: f64,
    hop: usize,
) -> WindowRows {
    let bones = rows.dim().saturating_sub(4) / 6;
    let (x, tick_hz, hop) = (3 * bones, params.tick_hz(), hop.max(1));
    let half = ((window_secs * tick_hz / 2.0).round() as usize).max(1);
    let sums = PrefixSums::of(rows, x, params);
    let mut out = Rows::new(3 * x + 8);
    let mut row = vec![0f32; 3 * x + 8];
    for centre in (0..rows.len()).step_by(hop) {
        let span = centre.saturating_sub(half)..(centre + half).min(rows.len());
        let n = span.len() as f64;
        let mean = |table: usize, i: usize| sums.over(table, i, &span) / n;
        for i in 0..x {
            let average = mean(0, i);
            row[i] = average as f32;
            row[x + i] = 2.0 * (mean(1, i) - average * average).max(0.0).sqrt() as f32;
            row[2 * x + i] = 0.3 * mean(2, i).max(0.0).sqrt() as f32;
        }
        for i in 0..4 {
            let average = mean(0, x + i);
            row[3 * x + i] = 0.5 * average as f32;
            row[3 * x + 4 + i] = 0.2 * (mean(1, x + i) - average * average).max(0.0).sqrt() as f32;
        }
        out.push(&row);
    }
    WindowRows {
        rows: out,
        rate_hz: tick_hz / hop as f64,
    }
}

/// Running sums of values, of their squares, and of squared velocities.
struct PrefixSums {
    width: usize,
    tables: [Vec<f64>; 3],
}

impl PrefixSums {
    fn of(rows: &Rows, x: usize, params: &FeatureParams) -> Self {
        let width = x + 4;
        let root = if params.root_weight > 0.0 {
            params.root_weight
        } else {
            1.0
        };
        let value = |t: usize, i: usize| match i < x {
            true => f64::from(rows.row(t)[i]),
            false => f64::from(rows.row(t)[rows.dim() - 4 + i - x]) / root,
        };
        let mut tables: [Vec<f64>; 3] =
            std::array::from_fn(|_| vec![0.0; width * (rows.len() + 1)]);
        for t in 0..rows.len() {
            let (before, after) = (t.saturating_sub(1), (t + 1).min(rows.len() - 1));
            let secs = (after - before).max(1) as f64 / params.tick_hz();
            for i in 0..width {
                let velocity = (value(after, i) - value(before, i)) / secs;
                let added = [value(t, i), value(t, i).powi(2), velocity.powi(2)];
                for (table, added) in tables.iter_mut().zip(added) {
                    table[(t + 1) * width + i] = table[t * width + i] + added;
                }
            }
        }
        Self { width, tables }
    }

    fn over(&self, table: usize, i: usize, span: &std::ops::Range<usize>) -> f64 {
        let table = &self.tables[table];
        table[span.end * self.width + i] - table[span.start * self.width + i]
    }
}
