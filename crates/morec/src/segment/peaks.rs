//! Rises from a valley to a peak (Barbič et al. 2004).

/// Looks for the first peak of a series that lies far enough above the valley before it.
#[derive(Debug, Clone)]
pub(super) struct Peaks {
    rise: f64,
    fall: f64,
    valley: f64,
    /// Place and height of the highest value since the series rose by enough.
    peak: Option<(usize, f64)>,
}

impl Peaks {
    /// A peak must rise by more than `rise`, and counts once the series has fallen from it by more than the share
    /// `fall` of its rise.
    pub(super) fn new(rise: f64, fall: f64) -> Self {
        Self {
            rise,
            fall,
            valley: f64::INFINITY,
            peak: None,
        }
    }

    /// Takes the next value, at `place`; gives the place of a peak that counts from now on.
    pub(super) fn push(&mut self, place: usize, value: f64) -> Option<usize> {
        match self.peak {
            None => {
                self.valley = self.valley.min(value);
                if value > self.valley + self.rise {
                    self.peak = Some((place, value));
                }
                None
            }
            Some((_, height)) if value > height => {
                self.peak = Some((place, value));
                None
            }
            Some((at, height)) => {
                (value < height - self.fall * (height - self.valley)).then_some(at)
            }
        }
    }
}
