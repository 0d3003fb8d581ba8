//! A histogram of positive values over many orders of magnitude, in constant memory, for quantiles of a stream.

/// Half octaves from 2⁻⁴⁸ to 2¹⁶.
const BINS: usize = 128;
/// Exponent of two at which the first bin begins.
const LEAST: i32 = -48;

/// Values by magnitude, two bins to an octave; 512 bytes.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    counts: [f32; BINS],
    total: f32,
}

impl Default for Histogram {
    fn default() -> Self {
        Self {
            counts: [0.0; BINS],
            total: 0.0,
        }
    }
}

impl Histogram {
    /// Counts `value`; what is not a positive number counts as the smallest. O(1).
    pub(super) fn add(&mut self, value: f64) {
        // Exponent and first bit of the mantissa of single precision: a logarithm to a half octave.
        let value = if value > 0.0 { value as f32 } else { 0.0 };
        let half_octaves = (value.to_bits() >> 22) as i32 - 2 * 127;
        let bin = (half_octaves - 2 * LEAST).clamp(0, BINS as i32 - 1);
        self.counts[bin as usize] += 1.0;
        self.total += 1.0;
    }

    /// Makes everything seen so far count `factor` times as much.
    pub(super) fn fade(&mut self, factor: f32) {
        self.counts.iter_mut().for_each(|count| *count *= factor);
        self.total *= factor;
    }

    /// The value that this share of the values does not exceed, to a tenth or so; `None` before the first. O(bins).
    pub(super) fn quantile(&self, share: f32) -> Option<f64> {
        if self.total <= 0.0 {
            return None;
        }
        let mut left = share.clamp(0.0, 1.0) * self.total;
        let bin = self.counts.iter().position(|&count| {
            left -= count;
            left <= 0.0
        });
        let bin = bin.unwrap_or(BINS - 1);
        let within = 1.0 + f64::from(left / self.counts[bin].max(f32::MIN_POSITIVE));
        // A half octave is from 1 to 1.5 or from 1.5 to 2 times a power of two.
        let octave = 2f64.powi(LEAST + bin as i32 / 2);
        let begin = if bin.is_multiple_of(2) { 1.0 } else { 1.5 };
        Some(octave * (begin + 0.5 * within.clamp(0.0, 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quantiles_are_those_of_the_sorted_values(
            mut values in prop::collection::vec(1e-9..1e3f64, 1..300), share in 0.01..1.0f32,
        ) {
            let mut histogram = Histogram::default();
            values.iter().for_each(|v| histogram.add(*v));
            values.sort_by(f64::total_cmp);
            let rank = ((share * values.len() as f32).ceil() as usize).clamp(1, values.len());
            let found = histogram.quantile(share).unwrap();
            // The bin is right, so the value is right to a half octave.
            prop_assert!(found > 0.65 * values[rank - 1] && found < 1.55 * values[rank - 1],
                "{found} for {}", values[rank - 1]);
        }
    }

    #[test]
    fn what_is_no_positive_number_is_counted_as_nothing_much() {
        let mut histogram = Histogram::default();
        assert_eq!(histogram.quantile(0.5), None);
        for value in [0.0, -1.0, f64::NAN, 1e-300, f64::INFINITY] {
            histogram.add(value);
        }
        assert!(histogram.quantile(0.5).is_some_and(|v| v < 1e-12));
        histogram.fade(0.5);
        assert!(histogram.quantile(1.0).is_some_and(|v| v > 1e4));
    }
}
