//! The plane of two centroids in feature space.

use crate::svrdm::kernel::Gaussian;

/// Lower triangular `L`, as `L₁₁`, `L₂₁`, `L₂₂`, with `L Lᵀ = CᵀC` for the centroids of two sets of exemplars
/// (Eq. 3.39, as corrected in the lower right). Where the centroids all but coincide, `L₂₂` is kept just above 0.
/// O(exemplars² · n).
pub fn centroid_factor<V: AsRef<[f64]>>(exemplars: [&[V]; 2], sigma: f64) -> [f64; 3] {
    let kernel = Gaussian::new(sigma);
    let mean = |a: &[V], b: &[V]| {
        let sum: f64 = a
            .iter()
            .flat_map(|x| b.iter().map(move |y| kernel.of(x.as_ref(), y.as_ref())))
            .sum();
        sum / (a.len() * b.len()) as f64
    };
    let [a, b] = exemplars;
    let l11 = mean(a, a).sqrt();
    let l21 = mean(a, b) / l11;
    let rest = mean(b, b) - l21 * l21;
    [l11, l21, rest.max(1e-12).sqrt()]
}
