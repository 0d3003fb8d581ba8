//! Noise of a stream, and the filter for it.

/// One filter: the standard deviation and half width of a Gaussian, in frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Filter {
    pub sigma_frames: f64,
    pub cut_frames: usize,
}

/// Filters for streams of more noise than the shortest filter takes away, with the noise from which each is used.
///
/// Noise is the root mean square of what a Gaussian of [`PROBE`] takes away from the bones' unit vectors: 0.002 to
/// 0.009 on clean optical clips, 0.04 with 0.5 cm of white noise on every joint at 120 Hz, 0.075 with 1 cm, 0.15
/// with 2 cm.
const STEPS: [(f64, Filter); 3] = [
    (
        0.02,
        Filter {
            sigma_frames: 4.5,
            cut_frames: 9,
        },
    ),
    (
        0.045,
        Filter {
            sigma_frames: 6.0,
            cut_frames: 12,
        },
    ),
    (
        0.1,
        Filter {
            sigma_frames: 8.0,
            cut_frames: 16,
        },
    ),
];

/// [`FeatureStream::noise_gain`](crate::FeatureStream::noise_gain) under each filter, the shortest first. Of white noise on the frames of a
/// camera of 30 Hz for the first two, as faster sources of little noise leave next to none under these; at 120 Hz for the others.
pub(crate) const NOISE_GAINS: [f32; STEPS.len() + 1] = [USUAL_NOISE_GAIN, 3.6, 5.3, 7.3];
/// [`FeatureStream::noise_gain`](crate::FeatureStream::noise_gain) of a stream of little noise.
pub const USUAL_NOISE_GAIN: f32 = 22.0;

/// The filter whose residual is noise.
pub(crate) const PROBE: Filter = Filter {
    sigma_frames: 2.0,
    cut_frames: 4,
};

/// Half width of the widest filter, in frames.
pub(crate) const WIDEST_FRAMES: usize = STEPS[STEPS.len() - 1].1.cut_frames;

/// Share of a new measurement in the running mean: half a second at 30 measurements a second.
const WEIGHT: f64 = 1.0 / 15.0;
/// A longer filter is kept until the noise falls below this share of where it begins.
const RELEASE: f64 = 0.7;

/// Follows the noise of a stream.
#[derive(Debug, Clone, Default)]
pub(crate) struct NoiseMeter {
    mean_square: Option<f64>,
    step: usize,
}

impl NoiseMeter {
    /// Takes the mean squared residual of one frame.
    pub fn take(&mut self, square: f64) {
        let mean = match self.mean_square {
            Some(mean) => mean + WEIGHT * (square - mean),
            None => square,
        };
        self.mean_square = Some(mean);
        let level = mean.sqrt();
        while self.step < STEPS.len() && level > STEPS[self.step].0 {
            self.step += 1;
        }
        while self.step > 0 && level < RELEASE * STEPS[self.step - 1].0 {
            self.step -= 1;
        }
    }

    /// Noise of the last second or so, as a length on the unit sphere; `None` before the first measurement.
    pub fn level(&self) -> Option<f64> {
        self.mean_square.map(f64::sqrt)
    }

    /// Number of the filter to use: 0 is the stream's own.
    pub fn step(&self) -> usize {
        self.step
    }

    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

/// All filters in the order of [`NoiseMeter::step`], none narrower than `own`.
pub(crate) fn filters(own: Filter) -> Vec<Filter> {
    let wider = STEPS.iter().map(|(_, filter)| Filter {
        sigma_frames: filter.sigma_frames.max(own.sigma_frames),
        cut_frames: filter.cut_frames.max(own.cut_frames),
    });
    std::iter::once(own).chain(wider).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_noise_asks_for_a_longer_filter_and_quiet_for_the_first() {
        let mut meter = NoiseMeter::default();
        let mut step_at = |noise: f64| {
            (0..200).for_each(|_| meter.take(noise * noise));
            meter.step()
        };
        assert_eq!(step_at(0.009), 0);
        assert_eq!(step_at(0.037), 1);
        assert_eq!(step_at(0.075), 2);
        assert_eq!(step_at(0.15), 3);
        assert_eq!(step_at(0.08), 3, "a little less noise changes nothing");
        assert_eq!(step_at(0.005), 0);
    }

    #[test]
    fn a_single_frame_hardly_counts() {
        let mut meter = NoiseMeter::default();
        (0..100).for_each(|_| meter.take(1e-6));
        meter.take(0.02 * 0.02 * 10.0);
        assert_eq!(meter.step(), 0);
    }
}
