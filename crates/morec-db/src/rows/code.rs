//! Rows in a few bits a value.
//!
//! Values are rounded to 63 steps a side of each column's largest. Motion is smooth, so a step is nearly the one before
//! it, or goes on as before; what is left over is small and written in Golomb–Rice codes (Rice and Plaunt, *Adaptive
//! variable-length coding for efficient compression of spacecraft television data*, 1971), column by column.

use morec::features::Rows;

/// Steps from 0 to a column's largest value.
const STEPS: f32 = 63.0;
/// A quotient so long is followed by the whole value instead.
const ESCAPE: u32 = 16;
/// Bits of such a value: three times the range of steps, and its sign.
const WHOLE_BITS: u32 = 10;

/// Number of rows (`u32`), a step for each column (`f32`), then each column's predictor and divisor (a byte) and codes.
pub(crate) fn encode(rows: &Rows) -> Vec<u8> {
    let mut bytes = (rows.len() as u32).to_le_bytes().to_vec();
    let largest = |column: usize| rows.iter().map(|row| row[column].abs()).fold(0.0, f32::max);
    let steps: Vec<f32> = (0..rows.dim()).map(|column| largest(column) / STEPS).collect();
    steps.iter().for_each(|step| bytes.extend(step.to_le_bytes()));
    let mut bits = Bits { bytes, filled: 8 };
    for (column, step) in steps.iter().enumerate() {
        let level = |row: &[f32]| if *step > 0.0 { (row[column] / step).round() as i32 } else { 0 };
        let levels: Vec<i32> = rows.iter().map(level).collect();
        let choices = (0..2u32).flat_map(|order| (0..8u32).map(move |divisor| (order, divisor)));
        let cost = |&(order, divisor): &(u32, u32)| -> u32 {
            residuals(&levels, order)
                .map(|r| (zigzag(r) >> divisor).min(ESCAPE + WHOLE_BITS) + 1 + divisor)
                .sum()
        };
        let (order, divisor) = choices.min_by_key(cost).unwrap_or((0, 0));
        bits.push(order << 3 | divisor, 4);
        for residual in residuals(&levels, order) {
            bits.push_rice(zigzag(residual), divisor);
        }
    }
    bits.bytes
}

/// What encoding rounded; `None` for bytes that are none of it.
pub(crate) fn decode(bytes: &[u8], dim: usize) -> Option<Rows> {
    let (len, rest) = bytes.split_first_chunk::<4>()?;
    let len = u32::from_le_bytes(*len) as usize;
    // Every value takes a bit at least.
    if dim == 0 || rest.len() < 4 * dim || len.checked_mul(dim)? > 8 * rest.len() {
        return None;
    }
    let (steps, codes) = rest.split_at(4 * dim);
    let mut reader = Reader { bytes: codes, at: 0 };
    let mut values = vec![0f32; len * dim];
    for (column, step) in steps.chunks_exact(4).enumerate() {
        let step = f32::from_le_bytes([step[0], step[1], step[2], step[3]]);
        let head = reader.take(4)?;
        let (order, divisor) = (head >> 3, head & 7);
        let (mut last, mut before) = (0i32, 0i32);
        for t in 0..len {
            let code = reader.rice(divisor)?;
            let level = predicted(order, last, before, t).wrapping_add(unzigzag(code));
            (before, last) = (last, level);
            values[t * dim + column] = level as f32 * step;
        }
    }
    Some(Rows::from_values(dim, values))
}

/// The level expected next: the last one, or as far on as the last step went.
fn predicted(order: u32, last: i32, before: i32, t: usize) -> i32 {
    if order == 1 && t > 1 { last.wrapping_mul(2).wrapping_sub(before) } else { last }
}

fn residuals(levels: &[i32], order: u32) -> impl Iterator<Item = i32> + '_ {
    let past = |t: usize, by: usize| t.checked_sub(by).map_or(0, |t| levels[t]);
    levels.iter().enumerate().map(move |(t, level)| level - predicted(order, past(t, 1), past(t, 2), t))
}

fn zigzag(value: i32) -> u32 {
    ((value << 1) ^ (value >> 31)) as u32
}

fn unzigzag(code: u32) -> i32 {
    (code >> 1) as i32 ^ -((code & 1) as i32)
}

/// Bits from the highest of each byte down.
struct Bits {
    bytes: Vec<u8>,
    /// Bits used of the last byte.
    filled: u32,
}

impl Bits {
    fn push(&mut self, value: u32, count: u32) {
        for bit in (0..count).rev() {
            if self.filled == 8 {
                self.bytes.push(0);
                self.filled = 0;
            }
            self.filled += 1;
            if let Some(last) = self.bytes.last_mut() {
                *last |= ((value >> bit & 1) as u8) << (8 - self.filled);
            }
        }
    }

    fn push_rice(&mut self, code: u32, divisor: u32) {
        let quotient = code >> divisor;
        if quotient >= ESCAPE {
            self.push((1 << ESCAPE) - 1, ESCAPE);
            return self.push(code, WHOLE_BITS);
        }
        self.push((1 << quotient) - 1, quotient);
        self.push(0, 1);
        self.push(code, divisor);
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn take(&mut self, count: u32) -> Option<u32> {
        let mut value = 0;
        for _ in 0..count {
            let byte = *self.bytes.get(self.at / 8)?;
            value = value << 1 | u32::from(byte >> (7 - self.at % 8) & 1);
            self.at += 1;
        }
        Some(value)
    }

    fn rice(&mut self, divisor: u32) -> Option<u32> {
        let mut quotient = 0;
        while quotient < ESCAPE && self.take(1)? == 1 {
            quotient += 1;
        }
        if quotient == ESCAPE {
            return self.take(WHOLE_BITS);
        }
        Some(quotient << divisor | self.take(divisor)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn values_are_within_half_a_step(values in prop::collection::vec(-9f32..9.0, 0..200), dim in 1usize..6) {
            let rows = Rows::from_values(dim, values);
            let again = decode(&encode(&rows), dim).unwrap();
            prop_assert_eq!(again.len(), rows.len());
            for column in 0..dim {
                let most = rows.iter().map(|r| r[column].abs()).fold(0.0, f32::max);
                for (a, b) in rows.iter().zip(again.iter()) {
                    prop_assert!((a[column] - b[column]).abs() <= 0.5001 * most / STEPS + 1e-6);
                }
            }
        }

        #[test]
        fn any_bytes_are_rows_or_nothing(bytes in prop::collection::vec(any::<u8>(), 0..300), dim in 0usize..9) {
            let _ = decode(&bytes, dim);
        }
    }

    #[test]
    fn smooth_rows_take_a_few_bits() {
        let rows = Rows::from_values(2, (0..2000).flat_map(|t| [(t as f32 / 9.0).sin(), 1.0]).collect());
        let bytes = encode(&rows).len();
        assert!(bytes < 2000 * 2 * 3 / 8, "{bytes} bytes");
    }
}
