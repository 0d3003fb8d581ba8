//! `AᵀA` of rows, in sums that can be added.

/// Sums over rows `a` of `r` values: of `aᵀa`, of `a`, and how many there are.
///
/// The triangle below the diagonal is packed row by row: `r (r + 1) / 2` values.
#[derive(Debug, Clone, PartialEq)]
pub struct Gram {
    products: Vec<f64>,
    sums: Vec<f64>,
    frames: usize,
}

impl Gram {
    /// Of no rows of `dim` values.
    pub fn new(dim: usize) -> Self {
        Self {
            products: vec![0.0; dim * (dim + 1) / 2],
            sums: vec![0.0; dim],
            frames: 0,
        }
    }

    /// Of `rows`, laid end to end, `dim` values each: in chunks of `chunk_frames` from the first row on, added from
    /// the last chunk to the first, as [`SegmentAssembly`](super::SegmentAssembly) adds them. A segment of whole
    /// chunks has the same sums here and there to the bit. O(rows · r²).
    pub fn of_rows(rows: &[f32], dim: usize, chunk_frames: usize) -> Self {
        let mut whole = Self::new(dim);
        for chunk in rows.chunks(dim.max(1) * chunk_frames.max(1)).rev() {
            let mut part = Self::new(dim);
            chunk
                .chunks_exact(dim.max(1))
                .for_each(|row| part.add_row(row));
            whole.add(&part);
        }
        whole
    }

    /// Values in a row.
    #[inline]
    pub fn dim(&self) -> usize {
        self.sums.len()
    }

    /// Rows in it.
    #[inline]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Bytes of its sums.
    pub fn bytes(&self) -> usize {
        8 * (self.products.len() + self.sums.len())
    }

    /// Back to no rows.
    pub fn clear(&mut self) {
        self.products.fill(0.0);
        self.sums.fill(0.0);
        self.frames = 0;
    }

    /// Adds a row of `r` values; sums are in double precision. O(r²).
    ///
    /// # Panics
    /// The row has another width.
    pub fn add_row(&mut self, row: &[f32]) {
        assert_eq!(row.len(), self.dim(), "a row of another width");
        let mut rest = &mut self.products[..];
        for (i, a) in row.iter().enumerate() {
            let (line, after) = rest.split_at_mut(i + 1);
            line.iter_mut()
                .zip(row)
                .for_each(|(product, b)| *product += f64::from(*a) * f64::from(*b));
            rest = after;
        }
        self.sums
            .iter_mut()
            .zip(row)
            .for_each(|(sum, a)| *sum += f64::from(*a));
        self.frames += 1;
    }

    /// Becomes a copy of another, in its own memory.
    pub fn copy_from(&mut self, other: &Gram) {
        self.products.copy_from_slice(&other.products);
        self.sums.copy_from_slice(&other.sums);
        self.frames = other.frames;
    }

    /// Adds the rows of another. O(r²).
    ///
    /// # Panics
    /// The other's rows have another width.
    pub fn add(&mut self, other: &Gram) {
        assert_eq!(other.dim(), self.dim(), "rows of another width");
        self.products
            .iter_mut()
            .zip(&other.products)
            .for_each(|(a, b)| *a += b);
        self.sums
            .iter_mut()
            .zip(&other.sums)
            .for_each(|(a, b)| *a += b);
        self.frames += other.frames;
    }

    /// Row `i`, column `j ≤ i` of `AᵀA`.
    #[inline]
    pub fn product(&self, i: usize, j: usize) -> f64 {
        self.products[i * (i + 1) / 2 + j]
    }

    /// The same of rows with their own mean subtracted: `Σ aᵢaⱼ − (Σ aᵢ)(Σ aⱼ) / n`.
    #[inline]
    pub fn centred(&self, i: usize, j: usize) -> f64 {
        self.product(i, j) - self.sums[i] * self.sums[j] / (self.frames.max(1) as f64)
    }

    /// Mean of the rows' column `i`.
    #[inline]
    pub fn mean(&self, i: usize) -> f64 {
        self.sums[i] / (self.frames.max(1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sums_are_those_of_the_definition(
            rows in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 1..60),
            chunk in 1usize..20,
        ) {
            let gram = Gram::of_rows(&rows.concat(), 3, chunk);
            prop_assert_eq!(gram.frames(), rows.len());
            let n = rows.len() as f64;
            for i in 0..3 {
                let value = |r: &[f32; 3], i: usize| f64::from(r[i]);
            let mean = |i: usize| rows.iter().map(|r| value(r, i)).sum::<f64>() / n;
                prop_assert!((gram.mean(i) - mean(i)).abs() < 1e-12);
                for j in 0..=i {
                    let plain: f64 = rows.iter().map(|r| value(r, i) * value(r, j)).sum();
                    let own: f64 = rows.iter().map(|r| (value(r, i) - mean(i)) * (value(r, j) - mean(j))).sum();
                    prop_assert!((gram.product(i, j) - plain).abs() < 1e-12);
                    prop_assert!((gram.centred(i, j) - own).abs() < 1e-12);
                }
            }
        }
    }
}
