//! Feature vectors of segments from their `AᵀA` (thesis, §3.7.4, §4.6.4).

use nalgebra::{SMatrix, SymmetricEigen};

use super::{Centring, Gram, MAX_DIM, Scaling};

/// Rounds of the eigenvalue iteration before a matrix is given up; a few a row are the rule.
const MAX_ROUNDS: usize = 64 * MAX_DIM;

/// The first `k` directions of a segment.
///
/// `k × r` values, one direction after the other; shares beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Directions {
    dim: usize,
    vectors: Vec<f64>,
    shares: Vec<f64>,
}

impl Directions {
    /// Number of values.
    pub(super) fn len(&self) -> usize {
        self.vectors.len() + self.shares.len()
    }

    /// Room for `count` directions of `dim` values.
    ///
    /// # Panics
    /// Unless `count ≤ dim ≤` [`MAX_DIM`]: a model's check holds both.
    pub fn new(count: usize, dim: usize) -> Self {
        assert!(
            count <= dim && dim <= MAX_DIM,
            "{count} directions of {dim} values"
        );
        Self {
            dim,
            vectors: vec![0.0; count * dim],
            shares: vec![0.0; count],
        }
    }

    /// Number of directions, `k`.
    pub fn count(&self) -> usize {
        self.shares.len()
    }

    /// Unit vector `j`, of `r` values.
    pub fn vector(&self, j: usize) -> &[f64] {
        &self.vectors[j * self.dim..][..self.dim]
    }

    /// All vectors end to end.
    pub fn vectors(&self) -> &[f64] {
        &self.vectors
    }

    /// For each direction, its singular value over the sum of all `r`.
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// Becomes the directions of `gram`: its eigenvectors by falling eigenvalue, of either sign (see
    /// [`fix_signs`](Self::fix_signs)). Training and live recognition both come through here.
    ///
    /// `false`, and nothing of use left inside, if there is no direction: no motion at all, or a value that is no
    /// number. O(r³), no allocation.
    ///
    /// # Panics
    /// `gram`'s rows have another width.
    pub fn find(&mut self, gram: &Gram, centring: Centring) -> bool {
        assert_eq!(gram.dim(), self.dim, "rows of another width");
        match self.dim {
            0..=4 => find_4(self, gram, centring),
            5..=8 => find_8(self, gram, centring),
            9..=16 => find_16(self, gram, centring),
            17..=32 => find_32(self, gram, centring),
            _ => find_64(self, gram, centring),
        }
    }

    /// Becomes directions that were found elsewhere: component `i` of the `j`th is `vector(j, i)`.
    pub(super) fn set(
        &mut self,
        vector: impl Fn(usize, usize) -> f64,
        share: impl Fn(usize) -> f64,
    ) {
        for (j, place) in self.shares.iter_mut().enumerate() {
            *place = share(j);
        }
        for (place, value) in self.vectors.iter_mut().enumerate() {
            *value = vector(place / self.dim, place % self.dim);
        }
    }

    /// Turns every vector to the side of its sign vector: `signs` are `k` vectors of `r` values, as Algorithm 5 finds
    /// them from the training samples.
    pub fn fix_signs(&mut self, signs: &[f64]) {
        for (vector, sign) in self
            .vectors
            .chunks_exact_mut(self.dim)
            .zip(signs.chunks_exact(self.dim))
        {
            let side: f64 = vector.iter().zip(sign).map(|(v, w)| v * w).sum();
            if side < 0.0 {
                vector.iter_mut().for_each(|v| *v = -*v);
            }
        }
    }

    /// Writes the feature vector, `k · r` values (Eq. 3.37, or §5.3).
    ///
    /// # Panics
    /// `out` has another length.
    pub fn feature(&self, scaling: Scaling, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            self.vectors.len(),
            "room for another feature vector"
        );
        for (j, share) in self.shares.iter().enumerate() {
            let out = &mut out[j * self.dim..][..self.dim];
            for (value, v) in out.iter_mut().zip(self.vector(j)) {
                *value = match scaling {
                    Scaling::SingularShare => share * v,
                    Scaling::UnitRange => (v + 1.0) / 2.0,
                };
            }
        }
    }

    /// Writes the profile of a segment: its rows' projections on the first direction (thesis, §3.8, "motion
    /// vector"); `rows` are `r` values each. With [`Centring::Segment`], less the mean.
    pub fn profile<'a>(
        &self,
        rows: impl Iterator<Item = &'a [f32]>,
        gram: &Gram,
        centring: Centring,
        out: &mut [f32],
    ) {
        let direction = self.vector(0);
        let level: f64 = match centring {
            Centring::Database => 0.0,
            Centring::Segment => direction
                .iter()
                .enumerate()
                .map(|(i, v)| v * gram.mean(i))
                .sum(),
        };
        for (value, row) in out.iter_mut().zip(rows) {
            let along: f64 = row
                .iter()
                .zip(direction)
                .map(|(a, v)| f64::from(*a) * v)
                .sum();
            *value = (along - level) as f32;
        }
    }

    /// Keeps the first directions of `values`, which need no order; `vector(j, i)` is component `i` of the `j`th.
    fn keep(&mut self, values: &[f64], vector: impl Fn(usize, usize) -> f64) -> bool {
        let total: f64 = values.iter().map(|v| v.max(0.0).sqrt()).sum();
        if !(total.is_finite() && total > 0.0) {
            return false;
        }
        let mut taken = [false; MAX_DIM];
        for (j, share) in self.shares.iter_mut().enumerate() {
            let free = (0..values.len()).filter(|i| !taken[*i]);
            let Some(best) = free.reduce(|a, b| if values[b] > values[a] { b } else { a }) else {
                return false;
            };
            taken[best] = true;
            *share = values[best].max(0.0).sqrt() / total;
            for i in 0..self.dim {
                self.vectors[j * self.dim + i] = vector(best, i);
            }
        }
        true
    }
}

/// Row `i`, column `j ≤ i` of the matrix whose eigenvectors are the directions.
#[inline]
pub(super) fn entry(gram: &Gram, centring: Centring, i: usize, j: usize) -> f64 {
    match centring {
        Centring::Database => gram.product(i, j),
        Centring::Segment => gram.centred(i, j),
    }
}

/// `find` in a matrix of a size known when compiling, which needs no memory from the system. A narrower `gram` is
/// put beside a diagonal below all its eigenvalues: the directions of that come last and are never taken.
macro_rules! find_in {
    ($name:ident, $size:literal) => {
        // Not inlined: the larger matrices would sit on the stack of every caller.
        #[inline(never)]
        fn $name(directions: &mut Directions, gram: &Gram, centring: Centring) -> bool {
            let dim = directions.dim;
            let entry = |i, j| entry(gram, centring, i, j);
            let trace: f64 = (0..dim).map(|i| entry(i, i)).sum();
            // Not a number, or no motion.
            if !(trace.is_finite() && trace > 0.0) {
                return false;
            }
            let mut matrix = SMatrix::<f64, $size, $size>::zeros();
            for i in 0..dim {
                for j in 0..=i {
                    matrix[(i, j)] = entry(i, j);
                    matrix[(j, i)] = matrix[(i, j)];
                }
            }
            for i in dim..$size {
                matrix[(i, i)] = -trace;
            }
            let Some(found) = SymmetricEigen::try_new(matrix, f64::EPSILON, MAX_ROUNDS) else {
                return false;
            };
            directions.keep(found.eigenvalues.as_slice(), |j, i| {
                found.eigenvectors[(i, j)]
            })
        }
    };
}

find_in!(find_4, 4);
find_in!(find_8, 8);
find_in!(find_16, 16);
find_in!(find_32, 32);
find_in!(find_64, 64);

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    /// Rows that go mostly along the first coordinates, less along each after it.
    fn rows(dim: usize) -> impl Strategy<Value = Vec<f32>> {
        prop::collection::vec(prop::collection::vec(-1.0f32..1.0, dim), dim + 2..dim + 30).prop_map(
            |rows| {
                let scaled = |row: Vec<f32>| {
                    row.into_iter()
                        .enumerate()
                        .map(|(i, v)| v / (1.0 + 2.0 * i as f32))
                };
                rows.into_iter().flat_map(scaled).collect()
            },
        )
    }

    fn any_rows() -> impl Strategy<Value = (usize, Vec<f32>)> {
        prop_oneof![2usize..=6, 15usize..=17, Just(40)].prop_flat_map(|dim| (Just(dim), rows(dim)))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..Default::default() })]

        #[test]
        fn directions_are_the_singular_vectors((dim, rows) in any_rows(), own_mean in any::<bool>()) {
            let centring = if own_mean { Centring::Segment } else { Centring::Database };
            let mut directions = Directions::new(2, dim);
            prop_assert!(directions.find(&Gram::of_rows(&rows, dim, 16), centring));
            let mut matrix = DMatrix::from_row_iterator(rows.len() / dim, dim, rows.iter().map(|v| f64::from(*v)));
            if own_mean {
                let mean = matrix.row_mean();
                matrix.row_iter_mut().for_each(|mut row| row -= &mean);
            }
            // Of the rows themselves, not of their products.
            let found = matrix.svd(false, true);
            let (values, turned) = (&found.singular_values, found.v_t.as_ref().unwrap());
            prop_assume!(values[0] - values[1] > 0.02 && values[1] - values[2.min(dim - 1)] > 0.02 || dim == 2);
            for j in 0..2 {
                let share = values[j] / values.sum();
                prop_assert!((directions.shares()[j] - share).abs() < 1e-6, "{} {share}", directions.shares()[j]);
                let along: f64 = directions.vector(j).iter().zip(turned.row(j).iter()).map(|(a, b)| a * b).sum();
                prop_assert!(along.abs() > 1.0 - 1e-8, "{along}");
            }
        }

        #[test]
        fn signs_are_put_right_whatever_they_were((dim, rows) in any_rows(), flip in any::<[bool; 2]>()) {
            let mut directions = Directions::new(2, dim);
            prop_assert!(directions.find(&Gram::of_rows(&rows, dim, 16), Centring::Database));
            let mut flipped = directions.clone();
            for j in (0..2).filter(|j| flip[*j]) {
                flipped.vectors[j * dim..][..dim].iter_mut().for_each(|v| *v = -*v);
            }
            let signs: Vec<f64> = (0..2 * dim).map(|i| 1.0 / (1.0 + i as f64)).collect();
            directions.fix_signs(&signs);
            flipped.fix_signs(&signs);
            prop_assert_eq!(&directions, &flipped);
            for j in 0..2 {
                let side: f64 = directions.vector(j).iter().zip(&signs[j * dim..]).map(|(a, b)| a * b).sum();
                prop_assert!(side >= 0.0);
            }
        }
    }

    #[test]
    fn scalings_are_the_printed_ones() {
        // Two rows at right angles, lengths 3 and 1: singular values 3 and 1.
        let gram = Gram::of_rows(&[3.0, 0.0, 0.0, 1.0], 2, 16);
        let mut directions = Directions::new(2, 2);
        assert!(directions.find(&gram, Centring::Database));
        directions.fix_signs(&[1.0, 0.0, 0.0, -1.0]);
        let mut out = [0.0; 4];
        directions.feature(Scaling::SingularShare, &mut out);
        assert_eq!(out, [0.75, 0.0, 0.0, -0.25]);
        directions.feature(Scaling::UnitRange, &mut out);
        assert_eq!(out, [1.0, 0.5, 0.5, 0.0]);
        let rows = [[3.0f32, 0.0], [0.0, 1.0]];
        let mut profile = [0.0; 2];
        directions.profile(
            rows.iter().map(|r| &r[..]),
            &gram,
            Centring::Database,
            &mut profile,
        );
        assert_eq!(profile, [3.0, 0.0]);
        directions.profile(
            rows.iter().map(|r| &r[..]),
            &gram,
            Centring::Segment,
            &mut profile,
        );
        assert_eq!(profile, [1.5, -1.5]);
    }

    #[test]
    fn no_motion_and_no_number_have_no_direction() {
        let mut directions = Directions::new(1, 3);
        assert!(!directions.find(&Gram::of_rows(&[0.0; 12], 3, 16), Centring::Database));
        assert!(!directions.find(&Gram::of_rows(&[0.5; 12], 3, 16), Centring::Segment));
        let spoilt = [0.1, f32::NAN, 0.2, 0.0, f32::INFINITY, 0.0];
        assert!(!directions.find(&Gram::of_rows(&spoilt, 3, 16), Centring::Database));
    }
}
