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

/// TP, FP, FN, TN of streams (Table 5.7) and their accuracy.
pub(super) const STREAMS: ([u64; 4], f64) = ([124, 33, 21, 36], 0.7476);
