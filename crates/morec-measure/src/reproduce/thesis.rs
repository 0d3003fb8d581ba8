//! The thesis's own numbers, for comparison with ours.

/// τ, clusters found, pairs TP, FP, FN, TN (Tables 5.2 to 5.4).
pub(super) const CLUSTERS: [(f64, usize, [u64; 4]); 3] = [
    (0.95, 2, [708, 3852, 0, 2821]),
    (0.98, 3, [708, 3042, 0, 3631]),
    (0.99, 14, [588, 438, 120, 6235]),
];

/// P_C, P_E, P_R of the two splits (§5.3).
pub(super) const CLASSIFICATION: [[f64; 3]; 2] =
    [[0.7704, 0.0081, 0.2213], [0.7049, 0.0081, 0.2868]];

/// Classes, their shortest, middle and longest length in seconds, samples, subjects (Table 5.1).
pub(super) const CLASSES: [(&str, [f64; 3], usize, usize); 11] = [
    ("Walk", [0.96, 1.078, 1.196], 12, 4),
    ("VisibleCount", [0.9, 0.903, 0.906], 12, 7),
    ("Traveling", [0.353, 0.4365, 0.52], 20, 7),
    ("Swing", [1.739, 1.7995, 1.86], 10, 1),
    ("IllegalDribble", [0.886, 0.8995, 0.913], 11, 7),
    ("DribbleRight", [0.74, 0.8365, 0.933], 16, 3),
    ("DribbleLeft", [0.866, 0.8795, 0.893], 3, 1),
    ("TechnicalFoul", [0.595, 0.598, 0.601], 10, 7),
    ("StopClock", [0.595, 0.601, 0.607], 8, 7),
    ("Pushing", [0.69, 0.696, 0.702], 10, 7),
    ("NoScore", [0.696, 0.702, 0.708], 10, 7),
];

/// Stages, code and data in KB, clocks per instruction (Table 5.8).
pub(super) const STAGES: [(&str, f64, f64); 6] = [
    ("IA", 148.33, 1.84),
    ("SA", 126.84, 1.92),
    ("FVE", 149.22, 1.82),
    ("SC", 140.08, 1.86),
    ("SS", 147.73, 1.21),
    ("ST", 102.08, 2.02),
];

/// Frames a second on six SPEs (§5.5).
pub(super) const FRAMES_PER_SECOND: f64 = 4487.0;

/// TP, FP, FN, TN of streams (Table 5.7) and their accuracy.
pub(super) const STREAMS: ([u64; 4], f64) = ([124, 33, 21, 36], 0.7476);
