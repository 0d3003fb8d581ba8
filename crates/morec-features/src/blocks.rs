//! Levels of feature rows in blocks of 32 rows, each of which is read by itself and without a branch for each value.
//!
//! In a block the levels of a column, or what each adds to the one before, whichever takes less, are whole numbers of as few bits as hold
//! their range (Lemire and Boytsov, *Decoding billions of integers per second through vectorization*, 2015: frame of
//! reference). For each column there are a byte of the width, whose top bit says that changes are kept, for changes the first level,
//! the least value, then the bits, from the lowest on, filled up to whole bytes. Levels before them take a byte, or five: a 128, and 32 bits.

/// Rows in a block.
const BLOCK: usize = 32;
/// In a width: changes are kept.
const CHANGES: u8 = 1 << 7;
/// Bits of the widest values: levels are within ±2^24, and changes within twice that.
const WIDEST: u32 = 26;
/// Values that end at a whole byte.
const EIGHT: usize = 8;
/// Bytes that a column of a block takes at least.
const LEAST_BYTES: usize = 2;
/// Says that four bytes follow.
const LONG: i8 = i8::MIN;

/// Writes levels of `dim` columns, row by row. O(levels).
pub fn write_blocks(levels: &[i32], dim: usize, out: &mut Vec<u8>) {
    for block in levels.chunks(BLOCK * dim.max(1)) {
        for column in 0..dim {
            let of_column = block.iter().skip(column).step_by(dim);
            let values: Vec<i32> = of_column.copied().collect();
            write_column(&values, out);
        }
    }
}

fn write_column(values: &[i32], out: &mut Vec<u8>) {
    let changes: Vec<i32> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (width, of_changes) = (width_of(values), width_of(&changes));
    if of_changes < width {
        out.push(of_changes as u8 | CHANGES);
        write_signed(out, values[0]);
        write_bits(&changes, of_changes, out);
    } else {
        out.push(width as u8);
        write_bits(values, width, out);
    }
}

fn least_of(values: &[i32]) -> i32 {
    values.iter().copied().min().unwrap_or(0)
}

fn width_of(values: &[i32]) -> u32 {
    let range = values.iter().copied().max().unwrap_or(0) - least_of(values);
    i32::BITS - range.leading_zeros()
}

fn write_bits(values: &[i32], width: u32, out: &mut Vec<u8>) {
    let least = least_of(values);
    write_signed(out, least);
    let (mut bits, mut count) = (0u64, 0);
    for value in values {
        bits |= ((value - least) as u64) << count;
        count += width;
        while count >= u8::BITS {
            out.push(bits as u8);
            (bits, count) = (bits >> u8::BITS, count - u8::BITS);
        }
    }
    if count > 0 {
        out.push(bits as u8);
    }
}

fn write_signed(out: &mut Vec<u8>, value: i32) {
    match i8::try_from(value) {
        Ok(short) if short != LONG => out.push(short.cast_unsigned()),
        _ => {
            out.push(LONG.cast_unsigned());
            out.extend(value.to_le_bytes());
        }
    }
}

/// Reads `rows` rows of `dim` levels, each times `step`; `None` if the bytes are damaged. O(levels).
pub fn read_blocks(mut bytes: &[u8], rows: usize, dim: usize, step: f32) -> Option<Vec<f32>> {
    // What claims to be endless takes no memory.
    let most = bytes.len() / LEAST_BYTES / dim.max(1) * BLOCK;
    if rows > most {
        return None;
    }
    let mut out = vec![0f32; rows * dim];
    for block in out.chunks_mut(BLOCK * dim.max(1)) {
        let count = block.len() / dim.max(1);
        for column in 0..dim {
            let values = read_column(&mut bytes, count)?;
            for (row, value) in block.chunks_exact_mut(dim).zip(values) {
                row[column] = value as f32 * step;
            }
        }
    }
    bytes.is_empty().then_some(out)
}

#[inline]
fn read_signed(bytes: &mut &[u8]) -> Option<i32> {
    let (short, rest) = bytes.split_first()?;
    let short = short.cast_signed();
    if short != LONG {
        *bytes = rest;
        return Some(i32::from(short));
    }
    let (long, rest) = rest.split_first_chunk()?;
    *bytes = rest;
    Some(i32::from_le_bytes(*long))
}

#[inline]
fn read_column(bytes: &mut &[u8], count: usize) -> Option<[i32; BLOCK]> {
    let (head, rest) = bytes.split_first()?;
    *bytes = rest;
    let width = u32::from(head & !CHANGES);
    if width > WIDEST {
        return None;
    }
    if head & CHANGES == 0 {
        return read_bits(bytes, count, width);
    }
    let first = read_signed(bytes)?;
    let changes = read_bits(bytes, count - 1, width)?;
    let mut values = [first; BLOCK];
    for i in 1..count {
        values[i] = values[i - 1].wrapping_add(changes[i - 1]);
    }
    Some(values)
}

#[inline]
fn read_bits(bytes: &mut &[u8], count: usize, width: u32) -> Option<[i32; BLOCK]> {
    let least = read_signed(bytes)?;
    let (packed, rest) = bytes.split_at_checked((count * width as usize).div_ceil(8))?;
    // Eight values are as many bytes as they have bits: they lie within a word of as many bytes as there may be bits.
    let mask = (1u64 << width) - 1;
    let mut values = [0i32; BLOCK];
    let word = |at: usize| match bytes.get(at..).and_then(<[u8]>::first_chunk) {
        Some(whole) => u64::from_le_bytes(*whole),
        None => {
            let mut padded = [0u8; 8];
            let there = packed.get(at..).unwrap_or_default();
            padded[..there.len().min(8)].copy_from_slice(&there[..there.len().min(8)]);
            u64::from_le_bytes(padded)
        }
    };
    for (eight, values) in values.chunks_exact_mut(EIGHT).enumerate() {
        let at = eight * width as usize;
        if width <= u8::BITS {
            let word = word(at);
            for (i, value) in values.iter_mut().enumerate() {
                *value = ((word >> (i as u32 * width)) & mask) as i32;
            }
        } else {
            for (i, value) in values.iter_mut().enumerate() {
                let bit = i * width as usize;
                *value = ((word(at + bit / 8) >> (bit % 8)) & mask) as i32;
            }
        }
    }
    for value in &mut values {
        *value = value.wrapping_add(least);
    }
    *bytes = rest;
    Some(values)
}
