//! NumPy arrays, after *NEP 1: A Simple File Format for NumPy Arrays*. A page of our own: crates for it bring a parser of
//! Python literals, of which three keys are needed here.

use super::{ParseError, Place};

/// An array of numbers, in C order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Array {
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// Header before the numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NpyHeader {
    pub(super) descr: String,
    fortran_order: bool,
    pub(super) shape: Vec<usize>,
    /// Start of the numbers.
    begin: usize,
}

const MAGIC: &[u8] = b"\x93NUMPY";

pub(super) fn header(bytes: &[u8]) -> Result<NpyHeader, ParseError> {
    let wrong = |found: &str| ParseError::new(Place::Byte(0), "the header of a NumPy array", found);
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or_else(|| wrong("other bytes"))?;
    let (length, begin) = match rest {
        [1, _, a, b, ..] => (u16::from_le_bytes([*a, *b]) as usize, 10),
        [2 | 3, _, a, b, c, d, ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 12),
        _ => return Err(wrong("another version")),
    };
    let end = begin + length;
    let text = bytes
        .get(begin..end)
        .ok_or_else(|| wrong("its beginning"))?;
    let text = String::from_utf8_lossy(text);
    let value = |key: &str| {
        let (_, after) = text.split_once(&format!("'{key}':"))?;
        Some(after.trim_start())
    };
    let descr = value("descr").ok_or_else(|| wrong("none of `descr`"))?;
    let descr = match descr.strip_prefix('\'') {
        Some(quoted) => quoted.split('\'').next().unwrap_or_default(),
        // A list of fields.
        None => "V",
    };
    let shape = value("shape").ok_or_else(|| wrong("none of `shape`"))?;
    let shape = shape
        .strip_prefix('(')
        .and_then(|shape| Some(shape.split_once(')')?.0))
        .ok_or_else(|| wrong("another shape"))?;
    let shape: Option<Vec<usize>> = shape
        .split(',')
        .map(str::trim)
        .filter(|number| !number.is_empty())
        .map(|number| number.trim_end_matches('L').parse().ok())
        .collect();
    Ok(NpyHeader {
        descr: descr.to_owned(),
        fortran_order: value("fortran_order").is_some_and(|order| order.starts_with("True")),
        shape: shape.ok_or_else(|| wrong("another shape"))?,
        begin,
    })
    .map(|header| NpyHeader {
        begin: end,
        ..header
    })
}

/// Reads the numbers of an array.
pub(super) fn read(bytes: &[u8]) -> Result<Array, ParseError> {
    let header = header(bytes)?;
    let wrong = |expected: String, found: String| {
        ParseError::new(Place::Byte(header.begin as u64), expected, found)
    };
    let kind = NumberKind::of(&header.descr).ok_or_else(|| {
        wrong(
            "an array of numbers".into(),
            format!("type {}", header.descr),
        )
    })?;
    let count = header
        .shape
        .iter()
        .try_fold(1usize, |product, &n| product.checked_mul(n))
        .and_then(|count| Some((count, count.checked_mul(kind.size)?)));
    let Some((count, length)) = count else {
        return Err(wrong(
            "a shape that can be".into(),
            format!("{:?}", header.shape),
        ));
    };
    let data = &bytes[header.begin..];
    if data.len() < length {
        let expected = format!("{length} bytes of numbers");
        return Err(wrong(expected, data.len().to_string()));
    }
    let mut values: Vec<f64> = data[..length]
        .chunks_exact(kind.size)
        .map(|bytes| kind.value(bytes))
        .collect();
    if header.fortran_order && header.shape.len() > 1 {
        values = c_order(&values, &header.shape);
    }
    debug_assert_eq!(values.len(), count);
    Ok(Array {
        shape: header.shape,
        values,
    })
}

/// Memory that the numbers or texts of an array take, bytes; none of what is no array.
pub(super) fn memory(bytes: &[u8]) -> usize {
    let Ok(header) = header(bytes) else {
        return 0;
    };
    let data = bytes.len().saturating_sub(header.begin);
    match NumberKind::of(&header.descr) {
        Some(kind) => data / kind.size * size_of::<f64>(),
        // As many texts as there are letters, at most.
        None => data.saturating_mul(size_of::<String>()),
    }
}

/// True if an array holds objects of Python.
pub(super) fn is_of_objects(bytes: &[u8]) -> bool {
    header(bytes).is_ok_and(|header| header.descr.contains('O'))
}

/// Reads the texts of an array of one dimension (`<U14`, `|S14`); `None` of other arrays.
pub(super) fn texts(bytes: &[u8]) -> Option<Vec<String>> {
    let header = header(bytes).ok()?;
    let descr = header.descr.trim_start_matches(['<', '|', '=', '>']);
    let (wide, length) = match descr.split_at_checked(1)? {
        ("U", length) => (true, length),
        ("S" | "a", length) => (false, length),
        _ => return None,
    };
    let width = length
        .parse::<usize>()
        .ok()?
        .checked_mul(if wide { 4 } else { 1 })?;
    let big = header.descr.starts_with('>');
    let letter = |four: &[u8]| {
        let mut word = [four[0], four[1], four[2], four[3]];
        if big {
            word.reverse();
        }
        char::from_u32(u32::from_le_bytes(word)).filter(|c| *c != '\0')
    };
    let text = |field: &[u8]| match wide {
        true => field.chunks_exact(4).filter_map(letter).collect(),
        false => String::from_utf8_lossy(field).trim_matches('\0').to_owned(),
    };
    let count = match header.shape[..] {
        [] => 1,
        [count] => count,
        _ => return None,
    };
    let data = bytes.get(header.begin..)?;
    (width > 0 && data.len() / width >= count)
        .then(|| data.chunks_exact(width).take(count).map(text).collect())
}

/// Numbers whose first index runs fastest, put so that the last one does.
fn c_order(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for &n in shape {
        strides.push(stride);
        stride *= n;
    }
    (0..values.len())
        .map(|number| {
            let (mut rest, mut at) = (number, 0);
            for (&n, &stride) in shape.iter().zip(&strides).rev() {
                at += rest % n * stride;
                rest /= n;
            }
            values[at]
        })
        .collect()
}

/// A type of numbers.
struct NumberKind {
    letter: u8,
    size: usize,
    big: bool,
}

impl NumberKind {
    fn of(descr: &str) -> Option<Self> {
        let (big, rest) = match descr.as_bytes() {
            [b'>', rest @ ..] => (true, rest),
            [b'<' | b'|' | b'=', rest @ ..] => (false, rest),
            rest => (false, rest),
        };
        let (letter, size) = match rest {
            [letter @ (b'f' | b'i' | b'u'), size @ (b'2' | b'4' | b'8')] => (*letter, size - b'0'),
            [letter @ (b'i' | b'u' | b'b'), b'1'] => (*letter, 1),
            _ => return None,
        };
        Some(Self {
            letter,
            size: size.into(),
            big,
        })
    }

    fn value(&self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        for (k, byte) in bytes.iter().enumerate() {
            word[if self.big { self.size - 1 - k } else { k }] = *byte;
        }
        let bits = u64::from_le_bytes(word);
        match (self.letter, self.size) {
            (b'f', 8) => f64::from_bits(bits),
            (b'f', 4) => f32::from_bits(bits as u32).into(),
            (b'f', _) => half(bits as u16),
            (b'i', size) => {
                let unused = 64 - 8 * size as u32;
                (((bits << unused) as i64) >> unused) as f64
            }
            _ => bits as f64,
        }
    }
}

/// A number of 16 bits, IEEE 754.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    sign * match exponent {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2f64.powi(exponent - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
        let order = if fortran { "True" } else { "False" };
        let text =
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\0".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn types_orders_and_shapes() {
        let read = |bytes: Vec<u8>| read(&bytes).unwrap();
        let doubles: Vec<u8> = [1.5f64, -2.0]
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        assert_eq!(
            read(npy("<f8", false, "(2,)", &doubles)).values,
            [1.5, -2.0]
        );
        assert_eq!(
            read(npy(">i2", false, "(1, 2)", &[255, 254, 0, 3])).values,
            [-2.0, 3.0]
        );
        assert_eq!(
            read(npy("<f2", false, "(2,)", &[0, 0x3c, 0, 0xc0])).values,
            [1.0, -2.0]
        );
        assert_eq!(
            read(npy("|u1", true, "(2, 3)", &[1, 4, 2, 5, 3, 6])).values,
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
        );
        let one = read(npy("<i8", false, "()", &120i64.to_le_bytes()));
        assert_eq!((one.shape.len(), one.values), (0, vec![120.0]));
    }

    #[test]
    fn what_is_no_array_of_numbers_is_said() {
        let error = |bytes: Vec<u8>| read(&bytes).unwrap_err();
        assert!(error(npy("|O", false, "()", &[])).found.contains("|O"));
        assert!(
            error(npy("<f8", false, "(3,)", &[0; 8]))
                .expected
                .contains("24 bytes")
        );
        let huge = format!("({0}, {0}, {0})", u64::MAX / 2);
        assert!(
            error(npy("<f8", false, &huge, &[]))
                .expected
                .contains("shape")
        );
        assert!(error(b"\x93NUMPY\x09\0".to_vec()).found.contains("version"));
    }
}
