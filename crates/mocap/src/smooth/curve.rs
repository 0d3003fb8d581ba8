//! One channel of a compressed clip.

use super::bezier::{ChannelKind, ChannelValue, CurveSegment};
use super::lattice::{Code, Lattice, Piece, Tangents};
use super::playhead::PlayedChannel;
use crate::time_span::TimeSpan;

/// A channel as a run of cubic Bézier curves, end to end; a channel that stands still is a single key.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub(super) joint: usize,
    pub(super) lattice: Lattice,
    pub(super) first: Code,
    pub(super) pieces: Vec<Piece>,
    pub(super) segments: Vec<CurveSegment>,
}

/// A Bézier curve of a channel, as a picture or a table needs it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Bezier {
    /// Its time from the clip's start; the parameter runs evenly over it.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Degree it was fitted with: 1, 2 or 3.
    pub degree: u8,
    /// Control points, lower degrees in their cubic form: `[x, y, z, w]` of a quaternion, to be brought to length 1
    /// after evaluation, or `[x, y, z, 0]`.
    pub points: [[f64; 4]; 4],
}

impl Curve {
    /// A curve from what is stored of it.
    pub(super) fn new(joint: usize, lattice: Lattice, first: Code, pieces: Vec<Piece>) -> Self {
        let mut segments: Vec<CurveSegment> = Vec::with_capacity(pieces.len());
        let mut key = lattice.key_point(&first, None);
        let mut start = 0;
        for piece in &pieces {
            let segment = piece.segment(&lattice, start, key);
            key = segment.points[3];
            start += piece.frames;
            segments.push(segment);
        }
        Self {
            joint,
            lattice,
            first,
            pieces,
            segments,
        }
    }

    /// Whose channel it is.
    pub fn joint(&self) -> usize {
        self.joint
    }

    /// Kind of its values.
    pub fn kind(&self) -> ChannelKind {
        self.lattice.kind
    }

    /// Number of keyframes: where curves meet, and both ends; 1 for a channel that stands still.
    pub fn keyframes(&self) -> usize {
        self.pieces.len() + 1
    }

    /// True if it is a single key.
    pub fn is_constant(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Numbers that it takes: the values of its control points and the times of its keys.
    pub fn control_values(&self) -> usize {
        let per_point = match self.kind() {
            ChannelKind::Rotation => 4,
            ChannelKind::Position => 3,
        };
        let points: usize = self
            .pieces
            .iter()
            .map(|piece| usize::from(piece.degree()))
            .sum();
        (1 + points) * per_point
            + if self.is_constant() {
                0
            } else {
                self.keyframes()
            }
    }

    /// The curves, in order, where frames are `rate_hz` a second.
    pub(super) fn beziers(&self, rate_hz: f64) -> impl Iterator<Item = Bezier> + '_ {
        self.pieces
            .iter()
            .zip(&self.segments)
            .map(move |(piece, segment)| Bezier {
                span: TimeSpan::new(
                    f64::from(segment.start) / rate_hz,
                    f64::from(segment.start + segment.frames) / rate_hz,
                ),
                degree: piece.degree(),
                points: segment.points.map(Into::into),
            })
    }

    /// The value at `place`, in sample periods; before the first key and after the last it stands still.
    /// O(log keyframes).
    pub fn at(&self, place: f64) -> ChannelValue {
        let after = self
            .segments
            .partition_point(|s| f64::from(s.start) <= place);
        match self.segments.get(after.saturating_sub(1)) {
            Some(segment) => segment.at(self.kind(), place),
            None => self.lattice.key_point(&self.first, None),
        }
    }

    /// The values at `places`, which do not fall. O(places + keyframes).
    pub fn along(&self, places: impl Iterator<Item = f64>, mut take: impl FnMut(ChannelValue)) {
        let still = self.lattice.key_point(&self.first, None);
        let mut current = 0;
        for place in places {
            while self
                .segments
                .get(current + 1)
                .is_some_and(|next| f64::from(next.start) <= place)
            {
                current += 1;
            }
            take(
                self.segments
                    .get(current)
                    .map_or(still, |segment| segment.at(self.kind(), place)),
            );
        }
    }
}

impl PlayedChannel for Curve {
    fn kind(&self) -> ChannelKind {
        self.lattice.kind
    }

    fn start(&self) -> ChannelValue {
        self.lattice.key_point(&self.first, None)
    }

    fn segments(&self) -> &[CurveSegment] {
        &self.segments
    }
}

impl Piece {
    fn degree(&self) -> u8 {
        match self.tangents {
            Tangents::Line => 1,
            Tangents::Parabola(_) => 2,
            Tangents::Cubic(..) => 3,
        }
    }
}
