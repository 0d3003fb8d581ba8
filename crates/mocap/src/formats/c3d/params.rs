//! The parameter section: groups of named tables.

use super::number::Processor;
use crate::formats::{Place, Warning};

/// Bytes in a block, the unit in which C3D counts.
pub(super) const BLOCK: usize = 512;

/// A table of a group.
#[derive(Debug, Clone, PartialEq)]
struct Parameter {
    group: u8,
    name: String,
    /// −1 text, 1 bytes, 2 integers, 4 floats.
    kind: i8,
    dims: Vec<usize>,
    /// Start of its values; as many as `dims` say, cut at the end of the file.
    data: usize,
}

/// All parameters of a file.
#[derive(Debug, Clone)]
pub(super) struct Parameters<'a> {
    bytes: &'a [u8],
    pub(super) processor: Processor,
    /// Byte behind the section, by the blocks it says it has.
    pub(super) end: usize,
    groups: Vec<(u8, String)>,
    parameters: Vec<Parameter>,
}

impl<'a> Parameters<'a> {
    /// Reads the section that begins at byte `start`. Records that make no sense end it, with a warning.
    pub(super) fn read(
        bytes: &'a [u8],
        start: usize,
        processor: Processor,
        warnings: &mut Vec<Warning>,
    ) -> Self {
        let mut section = Self {
            bytes,
            processor,
            end: start + BLOCK * usize::from(bytes.get(start + 2).copied().unwrap_or(1).max(1)),
            groups: Vec::new(),
            parameters: Vec::new(),
        };
        let mut at = start + 4;
        // Each record is three bytes at least, so this ends.
        while let Some(next) = section.record(at) {
            match next {
                Ok(next) => at = next,
                Err(text) => {
                    warnings.push(Warning::new(Place::Byte(at as u64), text));
                    break;
                }
            }
        }
        section
    }

    /// Reads the record at `at`; where the next one is, `None` after the last.
    fn record(&mut self, at: usize) -> Option<Result<usize, String>> {
        let &[length, id] = self.bytes.get(at..at + 2)? else {
            return None;
        };
        // A negative length marks a locked record.
        let length = usize::from((length as i8).unsigned_abs());
        let id = id as i8;
        if length == 0 || id == 0 {
            return None;
        }
        let broken = || Some(Err("the parameters end in a broken record".to_owned()));
        let Some(name) = self.bytes.get(at + 2..at + 2 + length) else {
            return broken();
        };
        if !name.iter().all(|b| (b' '..0x7F).contains(b)) {
            return broken();
        }
        let name = String::from_utf8_lossy(name).trim().to_ascii_uppercase();
        let link = at + 2 + length;
        let Some(&[a, b]) = self.bytes.get(link..link + 2) else {
            return broken();
        };
        let step = usize::from(self.processor.u16([a, b]));
        if id < 0 {
            self.groups.push((id.unsigned_abs(), name));
        } else if let Some(parameter) = self.parameter(id.unsigned_abs(), name, link + 2) {
            self.parameters.push(parameter);
        } else {
            return broken();
        }
        if step == 0 {
            return None;
        }
        Some(Ok(link + step.max(2)))
    }

    fn parameter(&self, group: u8, name: String, at: usize) -> Option<Parameter> {
        let &[kind, dims] = self.bytes.get(at..at + 2)? else {
            return None;
        };
        let sizes = self.bytes.get(at + 2..at + 2 + usize::from(dims))?;
        Some(Parameter {
            group,
            name,
            kind: kind as i8,
            dims: sizes.iter().map(|&size| usize::from(size)).collect(),
            data: at + 2 + usize::from(dims),
        })
    }

    fn find(&self, group: &str, name: &str) -> Option<&Parameter> {
        let ids: Vec<u8> = self
            .groups
            .iter()
            .filter(|(_, known)| known == group)
            .map(|(id, _)| *id)
            .collect();
        self.parameters
            .iter()
            .find(|p| p.name == name && ids.contains(&p.group))
    }

    /// The bytes of a table, as far as the file has them.
    fn data(&self, parameter: &Parameter) -> &'a [u8] {
        let width = usize::from(parameter.kind.unsigned_abs().max(1));
        let values = parameter
            .dims
            .iter()
            .fold(width, |size, &dim| size.saturating_mul(dim));
        let end = parameter.data.saturating_add(values).min(self.bytes.len());
        self.bytes.get(parameter.data..end).unwrap_or_default()
    }

    /// The numbers of a table; integers are without a sign, as counts are. Empty if there is none.
    pub(super) fn numbers(&self, group: &str, name: &str) -> Vec<f64> {
        let Some(parameter) = self.find(group, name) else {
            return Vec::new();
        };
        let data = self.data(parameter);
        match parameter.kind {
            1 => data.iter().map(|&b| f64::from(b)).collect(),
            2 => data
                .chunks_exact(2)
                .map(|c| f64::from(self.processor.u16([c[0], c[1]])))
                .collect(),
            4 => data
                .chunks_exact(4)
                .map(|c| self.processor.f32([c[0], c[1], c[2], c[3]]))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// The first number of a table, if it is finite.
    pub(super) fn number(&self, group: &str, name: &str) -> Option<f64> {
        let first = self.numbers(group, name).first().copied();
        first.filter(|value| value.is_finite())
    }

    /// Two words that make one count, the lower first.
    pub(super) fn long(&self, group: &str, name: &str) -> Option<f64> {
        match self.numbers(group, name).as_slice() {
            [low, high] if low.fract() == 0.0 => Some(low + high * 65536.0),
            [one] => Some(*one),
            _ => None,
        }
    }

    /// The texts of a table, without blanks around them.
    pub(super) fn texts(&self, group: &str, name: &str) -> Vec<String> {
        let Some(parameter) = self.find(group, name).filter(|p| p.kind == -1) else {
            return Vec::new();
        };
        let data = self.data(parameter);
        let width = match parameter.dims.as_slice() {
            [] => 1,
            [width, ..] => *width,
        };
        if width == 0 {
            return Vec::new();
        }
        data.chunks(width).map(text).collect()
    }

    /// The texts of a table and of those that continue it: `LABELS`, `LABELS2`, `LABELS3` and so on. One table holds
    /// 255 at most.
    pub(super) fn all_texts(&self, group: &str, name: &str) -> Vec<String> {
        let mut all = self.texts(group, name);
        for number in 2.. {
            let more = self.texts(group, &format!("{name}{number}"));
            if more.is_empty() {
                break;
            }
            all.extend(more);
        }
        all
    }
}

/// Text in a field: UTF-8 if it is, else Latin.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    let bytes = &bytes[..end];
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned(),
    };
    text.trim().to_owned()
}
