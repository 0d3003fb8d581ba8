//! A table of feature rows.

/// Feature rows of one stream, one for each tick: `len` × `dim`, row-major, single precision.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rows {
    dim: usize,
    data: Vec<f32>,
}

impl Rows {
    /// An empty table of rows of `dim` values.
    pub fn new(dim: usize) -> Self {
        Self {
            dim,
            data: Vec::new(),
        }
    }

    /// An empty table with room for `rows` rows of `dim` values.
    pub fn with_room(dim: usize, rows: usize) -> Self {
        Self {
            dim,
            data: Vec::with_capacity(dim * rows),
        }
    }

    /// A table from its values, row after row; surplus values at the end are dropped.
    pub fn from_values(dim: usize, mut data: Vec<f32>) -> Self {
        data.truncate(data.len().checked_div(dim).unwrap_or(0) * dim);
        Self { dim, data }
    }

    /// Values in one row.
    #[inline]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of rows.
    #[inline]
    pub fn len(&self) -> usize {
        self.data.len().checked_div(self.dim).unwrap_or(0)
    }

    /// True if there is no row.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Row `index`, from 0: `dim` values. Panics beyond the last row.
    #[inline]
    pub fn row(&self, index: usize) -> &[f32] {
        &self.data[index * self.dim..(index + 1) * self.dim]
    }

    /// All rows in order.
    #[inline]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f32]> + Clone {
        self.data.chunks_exact(self.dim.max(1))
    }

    /// All values, row after row.
    #[inline]
    pub fn values(&self) -> &[f32] {
        &self.data
    }

    /// All values, row after row, without a copy.
    pub fn into_values(self) -> Vec<f32> {
        self.data
    }

    /// Removes all rows; their room stays.
    pub fn clear(&mut self) {
        self.data.clear();
    }

    /// Adds a row; it must have `dim` values.
    ///
    /// # Panics
    /// The row has another width.
    #[inline]
    pub fn push(&mut self, row: &[f32]) {
        assert_eq!(row.len(), self.dim, "a row of another width");
        self.data.extend_from_slice(row);
    }

    /// A copy of some columns, in the order of `columns`, which must lie inside the table.
    pub fn columns(&self, columns: &[usize]) -> Rows {
        let data = self
            .iter()
            .flat_map(|row| columns.iter().map(|c| row[*c]))
            .collect();
        Rows {
            dim: columns.len(),
            data,
        }
    }

    /// A copy of rows `span`, which must lie inside the table.
    pub fn slice(&self, span: std::ops::Range<usize>) -> Rows {
        Rows {
            dim: self.dim,
            data: self.data[span.start * self.dim..span.end * self.dim].to_vec(),
        }
    }
}
