//! Tables of pandas, as PyTables stores them: in rows of records (`format="table"`), or in arrays (`format="fixed"`).

use std::fmt::Write;

use hdf5_pure::{Datatype, DatatypeByteOrder};

use super::contents::{Hdf5Contents, damaged, text_of};
use crate::formats::npy::Array;
use crate::formats::{ParseError, Place};

/// Columns with their names, one for each level, and the numbers in each row.
struct DataFrame {
    names: Vec<Vec<String>>,
    values: Array,
}

/// The first table of a file as the CSV that pandas and DeepLabCut write: a row for each level of names, then the numbers.
///
/// # Errors
/// A table whose columns or numbers are not as it says.
pub(super) fn as_csv(tree: &Hdf5Contents) -> Result<Option<String>, ParseError> {
    for path in &tree.groups {
        let attributes = tree.group(path)?.attrs().unwrap_or_default();
        let frame = match text_of(attributes.get("pandas_type")) {
            Some("frame_table") => of_records(tree, path)?,
            Some("frame") => of_arrays(tree, path)?,
            _ => continue,
        };
        return frame.csv(tree).map(Some);
    }
    Ok(None)
}

impl DataFrame {
    fn csv(&self, tree: &Hdf5Contents) -> Result<String, ParseError> {
        /// Bytes of a number as text, at most.
        const DIGITS: usize = 26;
        let columns = self.names.len();
        let [rows, width] = self.values.shape[..] else {
            return Err(refuse("numbers in rows and columns"));
        };
        let levels = self.names.first().map_or(0, Vec::len);
        let whole = width == columns && rows * width == self.values.values.len();
        if levels == 0 || !whole || self.names.iter().any(|name| name.len() != levels) {
            return Err(refuse("a name for each column"));
        }
        tree.limits.afford(rows * width, DIGITS)?;
        // What DeepLabCut calls its levels, by which the reader of tables knows them.
        let titles: &[&str] = match levels {
            4 => &["scorer", "individuals", "bodyparts", "coords"],
            3 => &["scorer", "bodyparts", "coords"],
            2 => &["bodyparts", "coords"],
            _ => &["frame"],
        };
        let mut text = String::new();
        for level in 0..levels {
            text.push_str(titles.get(level).copied().unwrap_or("frame"));
            for name in &self.names {
                text.push(',');
                // Animals that have no name of their own are nobody's parts.
                let bare = name[level].replace([',', '\n', '\r', '"'], " ");
                text.push_str(if bare == "single" { "" } else { &bare });
            }
            text.push('\n');
        }
        for (row, values) in self.values.values.chunks_exact(columns).enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(text, "{row}");
            for value in values {
                let _ = if value.is_finite() {
                    write!(text, ",{value}")
                } else {
                    write!(text, ",")
                };
            }
            text.push('\n');
        }
        Ok(text)
    }
}

fn refuse(expected: &str) -> ParseError {
    let expected = format!("a table of pandas with {expected}");
    ParseError::new(Place::File, expected, "another, or none")
}

/// Records of an index and blocks of values; an attribute has the names of each block's columns.
fn of_records(tree: &Hdf5Contents, group: &str) -> Result<DataFrame, ParseError> {
    let none = || refuse("records");
    let table = tree.array(&format!("{group}/table")).ok_or_else(none)?;
    let Datatype::Compound { size, members } = table.datatype().map_err(damaged)? else {
        return Err(none());
    };
    let attributes = table.attrs().map_err(damaged)?;
    let mut names = Vec::new();
    // The first byte and the reader of each column.
    let mut columns: Vec<(usize, Number)> = Vec::new();
    for member in members
        .iter()
        .filter(|member| member.name.starts_with("values_block"))
    {
        let (base, count) = match &member.datatype {
            Datatype::Array {
                base_type,
                dimensions,
            } => {
                let count = dimensions
                    .iter()
                    .map(|&size| size as usize)
                    .product::<usize>();
                (base_type.as_ref(), count)
            }
            single => (single, 1),
        };
        let Some((number, bytes)) = Number::of(base) else {
            continue;
        };
        let kind = attributes.get(&format!("{}_kind", member.name));
        let own = text_of(kind).map(tuples).unwrap_or_default();
        let first = member.byte_offset as usize;
        if own.len() != count || first + count * bytes > size as usize {
            return Err(refuse("a name for each column"));
        }
        names.extend(own);
        columns.extend((0..count).map(|at| (first + at * bytes, number)));
    }
    let raw = tree.raw(&table)?;
    tree.limits.afford(
        columns.len() * (raw.len() / (size as usize).max(1)),
        size_of::<f64>(),
    )?;
    let rows = raw.chunks_exact((size as usize).max(1));
    let shape = vec![rows.len(), columns.len()];
    let values = rows.flat_map(|row| columns.iter().map(|(at, number)| number.read(&row[*at..])));
    let values = values.collect();
    Ok(DataFrame {
        names,
        values: Array { shape, values },
    })
}

/// How a number is stored, the least byte first.
#[derive(Clone, Copy)]
enum Number {
    Double,
    Single,
}

impl Number {
    /// The number with its bytes; `None` of what is no coordinate.
    fn of(datatype: &Datatype) -> Option<(Self, usize)> {
        match datatype {
            Datatype::FloatingPoint {
                size,
                byte_order: DatatypeByteOrder::LittleEndian,
                ..
            } => match size {
                8 => Some((Number::Double, 8)),
                4 => Some((Number::Single, 4)),
                _ => None,
            },
            _ => None,
        }
    }

    fn read(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Number::Double, &[a, b, c, d, e, f, g, h, ..]) => {
                f64::from_le_bytes([a, b, c, d, e, f, g, h])
            }
            (Number::Single, &[a, b, c, d, ..]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        }
    }
}

/// Arrays of names for each level, of each column's number in them, and of values, in the block of numbers that is the widest.
fn of_arrays(tree: &Hdf5Contents, group: &str) -> Result<DataFrame, ParseError> {
    let block = |number: usize| format!("{group}/block{number}");
    let blocks = (0..)
        .map(block)
        .take_while(|block| tree.array(&format!("{block}_values")).is_some());
    let width = |block: &String| {
        let shape = tree.array(&format!("{block}_values"))?.shape().ok()?;
        shape.last().copied()
    };
    let block = blocks.max_by_key(width).ok_or_else(|| refuse("values"))?;
    let values = tree
        .numbers(&format!("{block}_values"))?
        .ok_or_else(|| refuse("values"))?;
    let mut names: Vec<Vec<String>> = Vec::new();
    if let Some(texts) = tree.texts(&format!("{block}_items")) {
        names = texts.into_iter().map(|text| vec![text]).collect();
    }
    for level in 0.. {
        let Some(texts) = tree.texts(&format!("{block}_items_level{level}")) else {
            break;
        };
        let numbers = tree.numbers(&format!("{block}_items_label{level}"))?;
        let numbers = numbers.ok_or_else(|| refuse("labels"))?.values;
        names.resize(numbers.len(), Vec::new());
        for (name, &number) in names.iter_mut().zip(&numbers) {
            name.push(texts.get(number as usize).cloned().unwrap_or_default());
        }
    }
    Ok(DataFrame { names, values })
}

/// The tuples of texts in a list that Python pickled as text (protocol 0, documented in its `pickletools`): of this only texts, tuples
/// and what repeats them matter.
fn tuples(pickle: &str) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    let mut open: Vec<String> = Vec::new();
    let mut memo = std::collections::BTreeMap::new();
    let mut rest = pickle;
    let mut last_is_text = false;
    while let Some(code) = rest.chars().next() {
        rest = &rest[code.len_utf8()..];
        let mut line = || {
            let (line, behind) = rest.split_once('\n').unwrap_or((rest, ""));
            rest = behind;
            line
        };
        let mut is_text = false;
        match code {
            'V' | 'S' => {
                open.push(unescaped(line().trim_matches('\'')));
                is_text = true;
            }
            'I' | 'L' | 'F' => {
                open.push(line().trim_end_matches('L').to_owned());
            }
            'p' => {
                let key = line();
                if last_is_text && let Some(text) = open.last() {
                    memo.insert(key, text.clone());
                }
                is_text = last_is_text;
            }
            'g' => {
                if let Some(text) = memo.get(line()) {
                    open.push(text.clone());
                }
            }
            '(' => open.clear(),
            // What is appended is a tuple, or a text for itself.
            'a' => all.push(std::mem::take(&mut open)),
            _ => {}
        }
        last_is_text = is_text;
    }
    all
}

/// A text without Python's escapes.
fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('\\') {
        plain.push_str(before);
        let digits = match behind.chars().next() {
            Some('u') => 4,
            Some('U') => 8,
            Some('x') => 2,
            _ => 0,
        };
        let code = behind
            .get(1..=digits)
            .and_then(|code| u32::from_str_radix(code, 16).ok());
        match code.and_then(char::from_u32).filter(|_| digits > 0) {
            Some(letter) => {
                plain.push(letter);
                rest = &behind[1 + digits..];
            }
            None => {
                plain.push('\\');
                rest = behind;
            }
        }
    }
    plain.push_str(rest);
    plain
}
