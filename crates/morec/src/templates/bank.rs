//! Subsequence dynamic time warping of many templates against one stream, tick by tick.

use std::sync::Arc;

use crate::decode::FAR;
use crate::features::Rows;

use super::dot::{self, AT_ONCE, PairProducts, Pairs};
use super::kernel::{self, Cells, CellsFixed, LANES, Reached};
use super::units::{self, StreamRows, Units};

/// Cells left empty before each template, so that transitions from "before the first row" cost [`FAR`] without
/// a branch.
const GUARDS: usize = 2;

/// A set of templates laid end to end, and the dynamic program that matches all of them at once.
///
/// For template rows `T_j` and stream rows `z_t`, with `c(j,t) = |T_j − z_t|²`:
///
/// ```text
/// D(1,t) = c(1,t)
/// D(j,t) = min { D(j−1,t−1) + c(j,t),
///                D(j−1,t−2) + (c(j,t−1) + c(j,t)) / 2,
///                D(j−2,t−1) + c(j−1,t) + c(j,t) }
/// ```
///
/// Every path has weight `n`, the template's length, so `D(n,t) / n` is a mean squared distance; the slope stays
/// between 1/2 and 2. (Sakoe and Chiba 1978, slope constraint P = 1, weighted along the template; open start as
/// in Müller 2007, §4.4.) Transitions read the two ticks before only, so all cells of a tick are independent.
///
/// One step costs O(F·d) for `F` template rows in all; nothing is allocated after construction. Copies share the
/// templates and have cells of their own.
#[derive(Debug, Clone)]
pub struct TemplateBank {
    dim: usize,
    units: Units,
    /// The cells' rows: pair by pair of coordinates, of all cells of a block together.
    rows: Arc<[Pairs]>,
    fixed: Arc<[CellsFixed]>,
    dots: PairProducts,
    /// First and last cell of each template.
    extents: Arc<[(usize, usize)]>,
    /// At the last tick and the one before, in turn.
    cells: Vec<Cells>,
    /// The rows of the last ticks.
    stream: StreamRows,
    /// Totals and ages of the templates' last cells at each of those ticks.
    ends: Vec<Reached>,
    /// The tick that is looked at, of those.
    shown: usize,
    tick: usize,
}

/// Best match of a template to a stretch that ends now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// Mean squared distance along the path.
    pub distance: f32,
    /// Ticks since the path began: 0 means with this tick.
    pub age: usize,
}

impl TemplateBank {
    /// Lays out `templates`, all of rows of `dim` values; empty ones never match.
    pub fn new(templates: &[Rows], dim: usize) -> Self {
        Self::in_units(templates, dim, Units::of(templates))
    }

    /// The same in units that other templates share.
    pub(super) fn in_units(templates: &[Rows], dim: usize, units: Units) -> Self {
        let mut extents = Vec::with_capacity(templates.len());
        let mut cells = GUARDS;
        for template in templates {
            extents.push((cells, (cells + template.len()).saturating_sub(1)));
            cells += template.len() + GUARDS;
        }
        let (blocks, pairs) = (cells.div_ceil(LANES), dim.div_ceil(2));
        let mut rows = vec![Pairs([[0; 2]; LANES]); blocks * pairs];
        let mut fixed = vec![CellsFixed::OUTSIDE; blocks];
        for (template, (first, _)) in templates.iter().zip(&extents) {
            for (cell, row) in (*first..).zip(template.iter()) {
                let (block, lane) = (cell / LANES, cell % LANES);
                let mut norm = 0;
                for (place, pair) in rows[block * pairs..].iter_mut().zip(units.pairs(row)) {
                    place.0[lane] = pair;
                    norm += units::norm(&[pair]);
                }
                fixed[block].set(lane, norm, cell == *first);
            }
        }
        Self {
            dim,
            units,
            rows: rows.into(),
            fixed: fixed.into(),
            dots: dot::fastest(),
            extents: extents.into(),
            cells: vec![Cells::EMPTY; blocks],
            stream: StreamRows::new(dim),
            ends: vec![(FAR, 0); AT_ONCE * templates.len()],
            shown: 0,
            tick: 0,
        }
    }

    /// Number of templates.
    pub fn len(&self) -> usize {
        self.extents.len()
    }

    /// True if there is no template.
    pub fn is_empty(&self) -> bool {
        self.extents.is_empty()
    }

    /// Units of its rows.
    #[cfg(feature = "train")]
    pub(crate) fn units(&self) -> Units {
        self.units
    }

    /// Rows of template `index`.
    pub fn template_len(&self, index: usize) -> usize {
        let (first, last) = self.extents[index];
        (last + 1).saturating_sub(first)
    }

    /// Rows of the longest template.
    pub fn longest(&self) -> usize {
        (0..self.len())
            .map(|i| self.template_len(i))
            .max()
            .unwrap_or(0)
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.cells.fill(Cells::EMPTY);
        self.tick = 0;
    }

    /// Advances by one tick with the stream's row `z`, of `dim` values.
    ///
    /// # Panics
    /// `z` has another width than the templates.
    pub fn step(&mut self, z: &[f32]) {
        self.step_through(std::iter::once(z), |_| {});
    }

    /// Advances by the stream's rows, of `dim` values each, and shows itself at each of them to `look`, which may ask what
    /// [`matched`](Self::matched). As one by one, and faster: a template's row comes from memory once for many of them.
    ///
    /// # Panics
    /// A row has another width than the templates.
    pub fn step_through<'r>(
        &mut self,
        rows: impl Iterator<Item = &'r [f32]>,
        mut look: impl FnMut(&Self),
    ) {
        let mut rows = rows.fuse();
        loop {
            let count = self.advance(rows.by_ref().take(AT_ONCE));
            if count == 0 {
                return;
            }
            for tick in 0..count {
                self.show(tick);
                look(self);
            }
        }
    }

    /// Advances by the stream's rows, [`AT_ONCE`] at most; gives how many there were, of which it shows the last.
    ///
    /// # Panics
    /// There are more, or a row has another width than the templates.
    pub(super) fn advance<'r>(&mut self, rows: impl Iterator<Item = &'r [f32]>) -> usize {
        let mut stream = std::mem::take(&mut self.stream);
        stream.count = 0;
        for z in rows {
            assert_eq!(
                z.len(),
                self.dim,
                "a stream row of another width than the templates'"
            );
            stream.push(z, self.units);
        }
        self.advance_by(&stream);
        self.stream = stream;
        self.stream.count
    }

    /// The same of rows that are in its templates' units already, as banks that share them ask for them once.
    pub(super) fn advance_by(&mut self, stream: &StreamRows) {
        if stream.count == 0 {
            return;
        }
        kernel::step(
            (&self.rows, &self.fixed, self.units.square()),
            (stream, self.dots),
            self.tick % 2,
            &mut self.cells,
            (&self.extents, &mut self.ends),
        );
        self.tick += stream.count;
        self.show(stream.count - 1);
    }

    /// Shows the matches at tick `at` of those that it last advanced by.
    pub(super) fn show(&mut self, at: usize) {
        self.shown = at;
    }

    /// Match of template `index` to a stretch that ends with the last tick stepped, or the one that is shown.
    pub fn matched(&self, index: usize) -> Match {
        let length = self.template_len(index);
        let (total, age) = self.ends[self.shown * self.len() + index];
        // A path that came out of a guard cell is no path.
        if length == 0 || self.tick == 0 || total >= FAR / 2.0 {
            return Match {
                distance: FAR,
                age: 0,
            };
        }
        Match {
            distance: total / length as f32,
            age: age as usize,
        }
    }

    /// Total and age of a cell at the last tick.
    fn at(&self, cell: usize) -> Reached {
        let (block, now) = (&self.cells[cell / LANES], (self.tick + 1) % 2);
        (block.total[now][cell % LANES], block.age[now][cell % LANES])
    }

    /// Best match of the first rows of template `index`, at least `least` of them, to a stretch that ends with the
    /// last tick stepped. O(rows), changes nothing.
    pub fn partial(&self, index: usize, least: usize) -> Option<PartialMatch> {
        let (first, last) = self.extents[index];
        let from = first + least.max(1) - 1;
        if self.tick == 0 || from > last {
            return None;
        }
        let now = (self.tick + 1) % 2;
        let (mut best, mut cell) = ((from, f32::INFINITY), from);
        while cell <= last {
            // As much of the template as lies in one block.
            let end = (cell / LANES * LANES + LANES).min(last + 1);
            let total = &self.cells[cell / LANES].total[now][cell % LANES..][..end - cell];
            let (place, mean) = kernel::least_mean(total, cell - first + 1);
            if mean < best.1 {
                best = (cell + place, mean);
            }
            cell = end;
        }
        let (total, age) = self.at(best.0);
        // A path that came out of a guard cell is no path.
        let real = total < FAR / 2.0;
        real.then(|| PartialMatch {
            distance: best.1,
            age: age as usize,
            rows: best.0 - first + 1,
        })
    }
}

/// Best match of a template's beginning to a stretch that ends now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartialMatch {
    /// Mean squared distance along the path, over the rows it has come to: `D(j,t) / j`.
    pub distance: f32,
    /// Ticks since the path began.
    pub age: usize,
    /// Rows it has come to, of the template's.
    pub rows: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The recurrence as written, over the whole table, in double precision. Returns `D(n,t)/n` and the start
    /// for every tick.
    fn plain(template: &Rows, stream: &Rows) -> Vec<(f64, usize)> {
        let cost = |j: usize, t: usize| -> f64 {
            let pairs = template.row(j).iter().zip(stream.row(t));
            pairs
                .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
                .sum()
        };
        let n = template.len();
        let mut table = vec![vec![(1e30, 0usize); n]; stream.len()];
        for t in 0..stream.len() {
            for j in 0..n {
                if j == 0 {
                    table[t][j] = (cost(0, t), t);
                    continue;
                }
                let mut options = vec![];
                if t >= 1 {
                    options.push((table[t - 1][j - 1].0 + cost(j, t), table[t - 1][j - 1].1));
                }
                if t >= 2 {
                    let c = (cost(j, t - 1) + cost(j, t)) / 2.0;
                    options.push((table[t - 2][j - 1].0 + c, table[t - 2][j - 1].1));
                }
                if t >= 1 && j >= 2 {
                    let c = cost(j - 1, t) + cost(j, t);
                    options.push((table[t - 1][j - 2].0 + c, table[t - 1][j - 2].1));
                }
                if let Some(best) = options
                    .into_iter()
                    .reduce(|a, b| if b.0 < a.0 { b } else { a })
                {
                    table[t][j] = best;
                }
            }
        }
        table
            .into_iter()
            .map(|row| (row[n - 1].0 / n as f64, row[n - 1].1))
            .collect()
    }

    /// Small whole numbers: single and double precision then agree to the last bit, ties included.
    fn rows(len: std::ops::Range<usize>) -> impl Strategy<Value = Rows> {
        len.prop_flat_map(|n| prop::collection::vec((-3i8..=3).prop_map(f32::from), 3 * n))
            .prop_map(|v| Rows::from_values(3, v))
    }

    proptest! {
        #[test]
        fn every_template_matches_as_it_would_alone(
            templates in prop::collection::vec(rows(1..9), 1..5),
            stream in rows(1..40),
        ) {
            let mut bank = TemplateBank::new(&templates, 3);
            let expected: Vec<_> = templates.iter().map(|t| plain(t, &stream)).collect();
            for (t, z) in stream.iter().enumerate() {
                bank.step(z);
                for (i, expected) in expected.iter().enumerate() {
                    let (distance, start) = expected[t];
                    let found = bank.matched(i);
                    if distance > 1e20 {
                        prop_assert!(found.distance > 1e20);
                    } else {
                        prop_assert_eq!(found.distance, distance as f32);
                        prop_assert_eq!(t - found.age, start);
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn a_beginning_matches_as_a_template_of_its_own_would(
            template in rows(2..9),
            stream in rows(1..30),
            least in 1usize..9,
        ) {
            let least = least.min(template.len());
            let alone: Vec<_> =
                (least..=template.len()).map(|n| plain(&template.slice(0..n), &stream)).collect();
            let mut bank = TemplateBank::new(std::slice::from_ref(&template), 3);
            for (t, z) in stream.iter().enumerate() {
                bank.step(z);
                let best = alone.iter().map(|table| table[t].0).fold(f64::INFINITY, f64::min);
                match bank.partial(0, least) {
                    Some(found) => {
                        prop_assert_eq!(found.distance, best as f32);
                        let (_, start) = alone[found.rows - least][t];
                        prop_assert_eq!(t - found.age, start);
                    }
                    None => prop_assert!(best > 1e20),
                }
            }
        }
    }

    proptest! {
        #[test]
        fn values_between_units_and_rows_beyond_them_match_nearly_alike(
            template in prop::collection::vec(-3.0f32..3.0, 3 * 12),
            stream in prop::collection::vec(prop_oneof![30 => -3.0f32..3.0, 1 => -1e4f32..1e4], 3 * 40),
        ) {
            let (template, stream) = (Rows::from_values(3, template), Rows::from_values(3, stream));
            let mut bank = TemplateBank::new(std::slice::from_ref(&template), 3);
            for (z, (distance, _)) in stream.iter().zip(plain(&template, &stream)) {
                bank.step(z);
                let found = f64::from(bank.matched(0).distance);
                prop_assert!(distance > 1e20 || (found - distance).abs() < 1e-3 * distance, "{found} {distance}");
            }
        }

        #[test]
        fn many_rows_match_as_one_by_one(
            templates in prop::collection::vec(rows(0..90), 1..5),
            stream in rows(1..40),
        ) {
            let mut bank = TemplateBank::new(&templates, 3);
            let mut together = bank.clone();
            let all = |bank: &TemplateBank| (0..templates.len()).map(|i| bank.matched(i)).collect::<Vec<_>>();
            let one_by_one = stream.iter().map(|z| {
                bank.step(z);
                all(&bank)
            });
            let one_by_one: Vec<_> = one_by_one.collect();
            let mut found = vec![];
            together.step_through(stream.iter(), |bank| found.push(all(bank)));
            prop_assert_eq!(found, one_by_one);
            prop_assert_eq!(together.partial(0, 1), bank.partial(0, 1));
        }
    }

    #[test]
    fn a_template_finds_itself_where_it_lies() {
        let template = Rows::from_values(1, vec![0.0, 1.0, 3.0, 2.0, -1.0]);
        let stream = Rows::from_values(1, vec![9.0, 9.0, 0.0, 1.0, 3.0, 2.0, -1.0, 9.0]);
        let mut bank = TemplateBank::new(&[template], 1);
        let mut best = (FAR, 0, 0);
        for (t, z) in stream.iter().enumerate() {
            bank.step(z);
            let m = bank.matched(0);
            if m.distance < best.0 {
                best = (m.distance, t - m.age, t);
            }
        }
        assert_eq!(best, (0.0, 2, 6));
    }

    #[test]
    fn a_reset_bank_is_a_new_bank() {
        let template = Rows::from_values(1, vec![0.0, 1.0, 2.0]);
        let mut used = TemplateBank::new(std::slice::from_ref(&template), 1);
        for v in [0.0, 1.0, 2.0, 3.0] {
            used.step(&[v]);
        }
        used.reset();
        let mut fresh = TemplateBank::new(&[template], 1);
        for v in [0.5, 1.0, 2.5, 1.0] {
            used.step(&[v]);
            fresh.step(&[v]);
            assert_eq!(used.matched(0), fresh.matched(0));
        }
    }
}
