//! Curve simplification (thesis, Alg. 1): one curve if it is within the thresholds, else two that meet at the largest error.

use super::bezier::{ChannelKind, ChannelValue, CurveSegment};
use super::fit::{FitSpan, Worst};
use super::lattice::{Code, Lattice, MOST_STEPS, Piece, Tangents};
use super::playhead::PlayedChannel;
use super::samples::ChannelSamples;
use crate::clip::Span;

/// A channel being fitted.
///
/// Algorithm 1 as printed measures from the curve to the chord between its ends and divides by the chord's length,
/// which is 0 for whatever returns to where it was. As corrected: from the curve to the samples, against a fixed
/// threshold, which is what its text asks for. Splits that all fall near one end would cost O(n²); below a depth of
/// some log n stretches are halved, so that fitting takes O(n log n).
pub(super) struct ChannelFit<'a> {
    pub lattice: Lattice,
    pub samples: ChannelSamples<'a>,
    /// Largest distance (chord between quaternions) from curve to sample.
    pub tolerance: f64,
    /// Shares of the tolerance that are allowed frame by frame, where they are not 1.
    pub shares: Option<Vec<f32>>,
    pub first: Code,
    pub pieces: Vec<Piece>,
    pub segments: Vec<CurveSegment>,
    /// ChannelSamples seen from the key at hand.
    local: Vec<ChannelValue>,
}

/// The steps are too coarse for what is allowed at this frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooCoarse {
    pub frame: usize,
    /// Values beyond this are more steps away than are counted.
    pub limit: f64,
}

impl PlayedChannel for ChannelFit<'_> {
    fn kind(&self) -> ChannelKind {
        self.lattice.kind
    }

    /// The first key's point.
    fn start(&self) -> ChannelValue {
        self.lattice.key_point(&self.first, None)
    }

    fn segments(&self) -> &[CurveSegment] {
        &self.segments
    }
}

impl<'a> ChannelFit<'a> {
    pub fn new(samples: ChannelSamples<'a>, tolerance: f64) -> Self {
        let lattice = Lattice::new(samples.kind(), tolerance);
        let (pieces, segments) = (Vec::new(), Vec::new());
        Self {
            lattice,
            samples,
            tolerance,
            shares: None,
            first: [0; 3],
            pieces,
            segments,
            local: Vec::new(),
        }
    }

    /// Squared distance that the curve may have from the sample of `frame`.
    pub fn allowed(&self, frame: usize) -> f64 {
        let share = self
            .shares
            .as_ref()
            .map_or(1.0, |shares| f64::from(shares[frame]));
        (self.tolerance * share).powi(2)
    }

    /// Fits from scratch, with steps as fine as it takes.
    ///
    /// # Errors
    /// The frame at which no step is fine enough, or a value is too many steps away.
    pub fn fit(&mut self) -> Result<(), TooCoarse> {
        loop {
            let limit = self.limit();
            let beyond = |sample: ChannelValue| sample.amax() > limit;
            if let Some(frame) = self.samples.iter().position(beyond) {
                return Err(TooCoarse { frame, limit });
            }
            match self.fit_with_steps() {
                Err(_) if self.lattice != self.lattice.finer() => {
                    self.lattice = self.lattice.finer()
                }
                outcome => return outcome,
            }
        }
    }

    /// The largest value that steps reach.
    fn limit(&self) -> f64 {
        MOST_STEPS as f64 * self.lattice.key.size()
    }

    fn fit_with_steps(&mut self) -> Result<(), TooCoarse> {
        self.pieces.clear();
        self.segments.clear();
        if self.samples.is_empty() || self.fit_constant() {
            return Ok(());
        }
        self.first = self.lattice.key_code(&self.samples.at(0));
        let (mut pieces, mut segments) = (Vec::new(), Vec::new());
        self.simplify(
            0,
            self.samples.len() - 1,
            self.start(),
            &mut pieces,
            &mut segments,
        )?;
        (self.pieces, self.segments) = (pieces, segments);
        self.local = Vec::new();
        Ok(())
    }

    /// One key for all frames, if it is within the thresholds of each.
    fn fit_constant(&mut self) -> bool {
        let middle = self.samples.iter().sum::<ChannelValue>() / self.samples.len() as f64;
        let Some(middle) = self.lattice.kind.finish(middle) else {
            return false;
        };
        self.first = self.lattice.key_code(&middle);
        let key = self.start();
        let near = |sample: &ChannelValue| match self.lattice.kind {
            ChannelKind::Position => (sample - key).norm_squared(),
            ChannelKind::Rotation => (sample - key)
                .norm_squared()
                .min((sample + key).norm_squared()),
        };
        (0..self.samples.len()).all(|f| near(&self.samples.at(f)) <= self.allowed(f))
    }

    /// Splits again where less is allowed than before: at `frames`, in increasing order. Returns the ranges of frames
    /// that have changed.
    ///
    /// # Errors
    /// The steps are too coarse; then [`fit`](Self::fit) with finer ones.
    pub fn refine(&mut self, frames: &[usize]) -> Result<Vec<Span>, TooCoarse> {
        if self.pieces.is_empty() {
            self.fit_with_steps()?;
            return Ok(std::iter::once(0..self.samples.len()).collect());
        }
        let (mut pieces, mut segments, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        let mut frames = frames;
        for i in 0..self.pieces.len() {
            let segment = self.segments[i];
            let (from, to) = (
                segment.start as usize,
                (segment.start + segment.frames) as usize,
            );
            frames = &frames[frames.partition_point(|&frame| frame < from)..];
            if frames.first().is_some_and(|&frame| frame <= to) {
                let start: ChannelValue = segments
                    .last()
                    .map_or_else(|| self.start(), |s: &CurveSegment| s.points[3]);
                self.simplify(from, to, start, &mut pieces, &mut segments)?;
                ranges.push(from..to + 1);
            } else {
                pieces.push(self.pieces[i]);
                segments.push(segment);
            }
        }
        (self.pieces, self.segments) = (pieces, segments);
        self.local = Vec::new();
        Ok(ranges)
    }

    /// Algorithm 1 on samples `from..=to`, beginning at the key `start`. Its recursion is a stack of stretches to
    /// come, so that no motion is too deep for it.
    fn simplify(
        &mut self,
        from: usize,
        to: usize,
        start: ChannelValue,
        pieces: &mut Vec<Piece>,
        segments: &mut Vec<CurveSegment>,
    ) -> Result<(), TooCoarse> {
        let depth_of_halving = 2 * (to - from).max(1).ilog2() + 8;
        let mut key = start;
        let mut ahead = vec![(from, to, 0)];
        while let Some((from, to, depth)) = ahead.pop() {
            if from == to {
                continue; // A clip of one frame: its key is all there is.
            }
            match self.one_curve(from, to, key) {
                Ok((piece, segment)) => {
                    key = segment.points[3];
                    pieces.push(piece);
                    segments.push(segment);
                }
                Err(worst) => {
                    if to - from == 1 {
                        return Err(TooCoarse {
                            frame: from + worst.index,
                            limit: self.limit(),
                        });
                    }
                    let at_an_end = worst.index == 0 || worst.index == to - from;
                    let middle = match at_an_end || depth > depth_of_halving {
                        true => from + (to - from) / 2,
                        false => from + worst.index,
                    };
                    ahead.push((middle, to, depth + 1));
                    ahead.push((from, middle, depth + 1));
                }
            }
        }
        Ok(())
    }

    /// The curve of the lowest degree within the thresholds; if no cubic is, the place of its largest error.
    fn one_curve(
        &mut self,
        from: usize,
        to: usize,
        start: ChannelValue,
    ) -> Result<(Piece, CurveSegment), Worst> {
        let (lattice, kind) = (self.lattice, self.lattice.kind);
        let sign = if kind == ChannelKind::Rotation && start.dot(&self.samples.at(from)) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let mut local = std::mem::take(&mut self.local);
        local.clear();
        local.extend(
            self.samples
                .range(from..=to)
                .map(|sample| kind.local(&start, &(sample * sign))),
        );
        let key = lattice.key_code(&self.samples.at(to));
        let end = lattice.key_point(&key, Some(&start));
        let stretch = FitSpan::new(kind, &local, kind.local(&start, &end));
        let try_on = |tangents: Tangents| {
            let resolved = tangents.resolve(&lattice, &stretch.chord());
            (
                tangents,
                stretch.worst(resolved, |i| self.allowed(from + i)),
            )
        };
        let line = || try_on(Tangents::Line);
        let parabola = || {
            stretch
                .parabola()
                .map(|a| try_on(Tangents::Parabola(lattice.tangent_code(&a))))
        };
        let cubic = stretch.cubic().map(|(a, b)| {
            try_on(Tangents::Cubic(
                lattice.tangent_code(&a),
                lattice.tangent_code(&b),
            ))
        });
        let highest = cubic.or_else(parabola).unwrap_or_else(line);
        let outcome = if highest.1.ratio <= 1.0 {
            let near = |tried: &(Tangents, Worst)| tried.1.ratio <= 1.0;
            let lowest = Some(line())
                .filter(near)
                .or_else(|| parabola().filter(near))
                .unwrap_or(highest);
            let piece = Piece {
                frames: (to - from) as u32,
                key,
                tangents: lowest.0,
            };
            Ok((piece, piece.segment(&lattice, from as u32, start)))
        } else {
            Err(highest.1)
        };
        self.local = local;
        outcome
    }
}
