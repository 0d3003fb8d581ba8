//! Axes: scales values to positions on paper and chooses round numbers for ticks.

/// Maps `from..to` in values to `low..high` on the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotAxis {
    pub from: f64,
    pub to: f64,
    pub low: f64,
    pub high: f64,
}

impl PlotAxis {
    /// An axis over the finite ones of `values`; a little wider than a point if they are all the same.
    pub fn over(values: impl Iterator<Item = f64>, low: f64, high: f64) -> Self {
        let finite = values.filter(|v| v.is_finite());
        let (from, to) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        let (from, to) = match () {
            () if from > to => (0.0, 1.0),
            () if to - from <= from.abs().max(to.abs()) * 1e-9 => {
                let half = (from.abs() * 0.1).max(0.5);
                (from - half, to + half)
            }
            () => (from, to),
        };
        Self {
            from,
            to,
            low,
            high,
        }
    }

    /// The axis with `share` of its length added at either end.
    pub fn widened(self, share: f64) -> Self {
        let more = share * (self.to - self.from);
        Self {
            from: self.from - more,
            to: self.to + more,
            ..self
        }
    }

    /// Position of `value` on the paper.
    pub fn at(&self, value: f64) -> f64 {
        self.low + (value - self.from) / (self.to - self.from) * (self.high - self.low)
    }

    /// Up to about `most` round values within the axis, with as many decimals as they need.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        let step = round_step((self.to - self.from) / most.max(1) as f64);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let first = (self.from / step).ceil() as i64;
        let last = (self.to / step).floor() as i64;
        let value = |i: i64| i as f64 * step;
        (first..=last)
            .map(|i| (value(i), format!("{:.*}", decimals.min(12), value(i))))
            .collect()
    }
}

/// The least of 1, 2, 5, 10, … times a power of ten that is not below `step`.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let factor = step / power;
    let round = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|r| *r >= factor - 1e-9)
        .unwrap_or(10.0);
    round * power
}

#[cfg(test)]
mod tests {
    use super::PlotAxis;

    #[test]
    fn ticks_are_round_and_within() {
        let labels = |from, to, most| {
            let axis = PlotAxis {
                from,
                to,
                low: 0.0,
                high: 1.0,
            };
            axis.ticks(most)
                .into_iter()
                .map(|(_, label)| label)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            labels(0.0, 1.0, 5),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(-3.2, 41.0, 5), ["0", "10", "20", "30", "40"]);
        assert_eq!(
            labels(0.001, 0.0042, 4),
            ["0.001", "0.002", "0.003", "0.004"]
        );
    }

    #[test]
    fn an_axis_over_nothing_or_one_value_has_length() {
        for values in [
            vec![],
            vec![f64::NAN],
            vec![0.0],
            vec![7.0, 7.0],
            vec![-1e12],
        ] {
            let axis = PlotAxis::over(values.iter().copied(), 0.0, 100.0);
            assert!(axis.to > axis.from, "{values:?}");
            assert!(!axis.ticks(5).is_empty(), "{values:?}");
        }
    }
}
