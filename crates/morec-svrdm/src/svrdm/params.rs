//! The parameters of the live stages.

use super::{Acceptance, Descent};

/// Widest rows after projection.
pub const MAX_DIM: usize = 64;

/// Longest segment, in frames, and longest profile: the edit distance counts exactly up to their sum.
pub const MAX_PROFILE_FRAMES: usize = 2047;

/// Most chunks in a segment.
const MAX_CHUNKS: usize = 64;

/// Most chunks that a segment may wait for its report.
const MAX_WAIT_CHUNKS: usize = 256;

/// Scaling of eigenvectors in a feature vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// Each eigenvector times its share of all singular values (thesis, Eq. 3.37; what it calls eigenvalues of `A`
    /// are singular values, as corrected).
    SingularShare,
    /// `(v + 1) / 2`: components of a unit vector lie in [−1, 1], so these lie in [0, 1] (thesis, §5.3, last
    /// paragraph; a fixed map is our reading of it).
    UnitRange,
}

/// Subtraction from a segment's rows before its directions are sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Centring {
    /// The mean of the whole database, which projection has subtracted already (thesis, §4.2, §4.6.2). The first
    /// direction is then mostly the mean pose.
    Database,
    /// The segment's own mean.
    Segment,
}

/// Divisor of an edit distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Normalisation {
    /// The length of the cheapest path; of equally cheap ones the longest counts (thesis, §4.6.5).
    CheapestPath,
    /// The path is chosen for the least cost per step itself (Marzal and Vidal, *Computation of normalized edit
    /// distance and applications*, 1993). Several times slower.
    LeastRatio,
}

/// Segments that are local maxima of the map of confidences (thesis, §4.6.5: "higher than the confidence of its 8
/// neighbors").
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Maxima {
    /// Those that no neighbour is above: of segments that are equally certain, which are neighbours wherever a motion
    /// is matched in full by every segment of a length, tracking keeps the first.
    #[default]
    Plateaus,
    /// Those that are above all neighbours: a plateau has none. Indexes written before there was a choice have it.
    Peaks,
}

impl Maxima {
    fn before_there_was_a_choice() -> Self {
        Maxima::Peaks
    }
}

/// Distance between a segment and a class's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentDistance {
    /// One value a frame, along the segment's first direction, which matches or does not (thesis, §3.8): see
    /// [`edr`](super::edr).
    #[default]
    Profiles,
    /// Every `every`th reduced row whole, at a cost that grows with the difference: see
    /// [`rows_edr`](super::rows_edr). Confidence is `1 − distance` then, in place of Eq. 4.5's curve, which is flat
    /// where these distances lie.
    Rows {
        /// Frames from one row to the next.
        every: usize,
    },
}

impl SegmentDistance {
    /// Values in one row of a profile, of rows of `dim` values.
    pub fn width(self, dim: usize) -> usize {
        match self {
            SegmentDistance::Profiles => 1,
            SegmentDistance::Rows { .. } => dim,
        }
    }

    /// Frames from one row of a profile to the next.
    pub fn every(self) -> usize {
        match self {
            SegmentDistance::Profiles => 1,
            SegmentDistance::Rows { every } => every,
        }
    }

    /// Rows in the profile of a segment of this many frames.
    pub fn rows(self, frames: usize) -> usize {
        frames.div_ceil(self.every())
    }
}

/// Parameters of segments: forming, description, scoring, tracking. A model keeps the values it was trained with.
///
/// Chunks are counted at the model's rate: 16 frames at 120 Hz are 0.133 s.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct SvrdmParams {
    /// Frames in a chunk, Δ. 16 (thesis, §4.6.2).
    ///
    /// Segments of 0.53 to 2.67 s. `k` is the number of chunks, as in the text of the thesis, not `k + 1` as in its
    /// sum.
    pub chunk_frames: usize,
    /// Chunks in the shortest segment. 4 (thesis, §4.6.3): 0.53 s; motions much shorter than this go unseen.
    pub min_chunks: usize,
    /// Chunks in the longest segment. 20 (thesis, §4.6.3): 2.67 s.
    pub max_chunks: usize,
    /// Eigenvectors in a feature vector, `k`. 2 (thesis, §4.5).
    ///
    /// Thesis, §4.5; tuned: the first direction about the database's mean is mostly the mean pose.
    pub eigenvectors: usize,
    /// Scaling of eigenvectors in a feature vector. `UnitRange` (thesis, §5.3).
    ///
    /// Thesis, §5.3: `(v + 1) / 2`; `singular_share` is Eq. 3.37.
    pub scaling: Scaling,
    /// Centre of segments. `Database` (thesis, §4.6.2).
    ///
    /// Thesis, §4.6.2; tuned: each segment's own mean is subtracted; in streams this decides.
    pub centring: Centring,
    /// A branch of the tree is followed if its machine's output is at least this value, `T`. 0.92 (thesis, §4.6.5).
    ///
    /// Thesis, §4.6.5; an argument of `Tree::descend`.
    pub accept: f64,
    /// On the way of the larger output, the other machine says at most this, `t`. None (thesis, §4.6.5).
    ///
    /// The thesis wishes it estimated (ch. 6) and recognises without; `thresholds.estimated.other=true` does both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other: Option<f64>,
    /// If both machines of a branch accept: both ways, so that up to four classes are scored (thesis, §4.7.2), or
    /// that of the larger output (§4.6.5). `Larger`.
    ///
    /// `larger`: §4.6.5; `both` gives up to four classes to scoring (§4.7.2).
    pub descent: Descent,
    /// Distance between segments and samples. `Profiles` (thesis, §3.8).
    ///
    /// Thesis, §3.8; tuned: one value a frame matches too much: of unknown motion with wide kernels, 8 to 27 false
    /// alarms a minute were left; none with whole rows.
    pub comparison: SegmentDistance,
    /// ε: profile values match if they differ by at most this many standard deviations of all training profiles.
    /// 0.25 (thesis, §3.8).
    ///
    /// Thesis, §3.8: of the standard deviation of all profile values.
    pub tolerance: f64,
    /// Divisor of edit distances. `CheapestPath` (thesis, §4.6.5).
    ///
    /// Thesis, §4.6.5; of equally cheap paths the longest. `least_ratio` is Marzal and Vidal's, many times slower.
    pub normalisation: Normalisation,
    /// Standard deviation of the length prior, as a share of the class's mean length. 0.25 (thesis, Eq. 4.5).
    pub prior_spread: f64,
    /// Segments that are local maxima of the confidences. `Plateaus` (thesis, §4.6.5, which does not say what equals
    /// are).
    ///
    /// Thesis, §4.6.5: "higher than the confidence of its 8 neighbors". Where segments of a motion match a profile
    /// in full, neighbours are equal to the bit: `peaks` then finds no maximum, and the more a tree accepts the
    /// more motions are lost.
    #[serde(default = "Maxima::before_there_was_a_choice")]
    pub maxima: Maxima,
    /// Of two segments that share more than this of the shorter one, only the better is reported. 0.3 (thesis,
    /// §4.6.5).
    pub overlap: f64,
    /// Segments less certain than this are left out of account. 0 (the thesis names no bound).
    ///
    /// The thesis names none; segments that cannot reach it are not scored.
    pub min_confidence: f64,
    /// A segment is decided upon at the latest this many chunks after its last, on what is known then. 40: by then
    /// everything that overlaps it has been seen twice over; smaller values report sooner and are final all the same.
    ///
    /// Not in the thesis: bounds memory and delay; smaller reports sooner, on less knowledge. Tuned: reports 0.5 s
    /// after the end instead of 0.9 s, at the same accuracy.
    pub wait_chunks: usize,
}

impl SvrdmParams {
    /// What a branch of the tree must say.
    pub fn acceptance(&self) -> Acceptance {
        Acceptance {
            accept: self.accept,
            other: self.other,
            descent: self.descent,
        }
    }
}

impl Default for SvrdmParams {
    /// The values of the thesis.
    fn default() -> Self {
        Self {
            chunk_frames: 16,
            min_chunks: 4,
            max_chunks: 20,
            eigenvectors: 2,
            scaling: Scaling::UnitRange,
            centring: Centring::Database,
            accept: 0.92,
            other: None,
            descent: Descent::Larger,
            comparison: SegmentDistance::Profiles,
            tolerance: 0.25,
            normalisation: Normalisation::CheapestPath,
            prior_spread: 0.25,
            maxima: Maxima::Plateaus,
            overlap: 0.3,
            min_confidence: 0.0,
            wait_chunks: 40,
        }
    }
}

impl SvrdmParams {
    /// Segment lengths that are tried.
    pub fn lengths(&self) -> usize {
        self.max_chunks - self.min_chunks + 1
    }

    /// Frames of the longest segment.
    pub fn max_frames(&self) -> usize {
        self.max_chunks * self.chunk_frames
    }

    /// Values in a feature vector of rows of `dim` values.
    pub fn feature_dim(&self, dim: usize) -> usize {
        self.eigenvectors * dim
    }

    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        let counts = [
            ("chunk_frames", self.chunk_frames, 1, MAX_PROFILE_FRAMES),
            ("min_chunks", self.min_chunks, 1, MAX_CHUNKS),
            ("max_chunks", self.max_chunks, self.min_chunks, MAX_CHUNKS),
            ("eigenvectors", self.eigenvectors, 1, MAX_DIM),
            ("wait_chunks", self.wait_chunks, 1, MAX_WAIT_CHUNKS),
            (
                "comparison.rows.every",
                self.comparison.every(),
                1,
                MAX_PROFILE_FRAMES,
            ),
        ];
        if let Some((name, value, low, high)) =
            counts.iter().find(|(_, v, low, high)| v < low || v > high)
        {
            return Err(format!("{name} must be {low} to {high}, found {value}"));
        }
        if self.max_frames() > MAX_PROFILE_FRAMES {
            let frames = self.max_frames();
            return Err(format!(
                "segments must be at most {MAX_PROFILE_FRAMES} frames, found {frames}"
            ));
        }
        let other = self.other.iter().map(|other| ("other", *other));
        let positive = [("accept", self.accept), ("prior_spread", self.prior_spread)];
        let mut positive = positive.into_iter().chain(other);
        if let Some((name, value)) = positive.find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
            return Err(format!("{name} must be above 0, found {value}"));
        }
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            return Err(format!(
                "tolerance must be 0 or more, found {}",
                self.tolerance
            ));
        }
        let shares = [
            ("overlap", self.overlap),
            ("min_confidence", self.min_confidence),
        ];
        match shares.iter().find(|(_, v)| !(0.0..1.0).contains(v)) {
            Some((name, value)) => Err(format!("{name} must be from 0 to below 1, found {value}")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_pass_and_nonsense_is_named() {
        assert_eq!(SvrdmParams::default().check(), Ok(()));
        let wrong = |change: fn(&mut SvrdmParams)| {
            let mut params = SvrdmParams::default();
            change(&mut params);
            params.check().unwrap_err()
        };
        assert!(wrong(|p| p.max_chunks = 3).contains("max_chunks must be 4 to 64, found 3"));
        assert!(wrong(|p| p.chunk_frames = 200).contains("at most 2047 frames, found 4000"));
        assert!(wrong(|p| p.prior_spread = f64::NAN).contains("prior_spread"));
        assert!(wrong(|p| p.overlap = 1.0).contains("overlap"));
    }
}
