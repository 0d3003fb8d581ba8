//! Reads numbers from buffers through accessors and views, including sparse replacements.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io;

use base64::Engine;
use serde_json::Value;

use super::super::{Beside, Limits, ParseError, Place};
use super::document::{Document, index};

/// The buffers of a document, opened when they are first needed.
pub(super) struct Buffers<'a> {
    document: &'a Document<'a>,
    beside: Beside<'a>,
    opened: HashMap<usize, Cow<'a, [u8]>>,
    /// For each file beside the scene, the first buffer that is in it.
    files: HashMap<String, usize>,
    /// Bytes of all buffers that were opened,
    bytes: usize,
    /// of those among them that lie beside the scene,
    beside_bytes: usize,
    /// and the numbers that were read: any number of accessors may lie on the same bytes.
    numbers: usize,
    limits: Limits,
}

/// Numbers of an accessor, `width` for each element, integers mapped as `normalized` says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbers {
    pub(super) values: Vec<f64>,
    pub(super) width: usize,
}

/// All animations of a file may have this many numbers however small it is, for accessors may lie on the same bytes,
const FREE_NUMBERS: usize = 1 << 22;
/// this many for each byte of it and its buffers,
const NUMBERS_A_BYTE: usize = 4;
/// and never more: an hour of 100 joints at 60 Hz has 150 million.
const MOST_NUMBERS: usize = 1 << 28;

/// All files beside a scene have this many bytes at most.
const MOST_BESIDE: usize = 2 << 30;

/// An accessor may stand for this many numbers without any bytes (they are zeros).
const MOST_ZEROS: usize = 1 << 22;

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Document<'a>, beside: Beside<'a>, limits: &Limits) -> Self {
        Self {
            document,
            beside,
            opened: HashMap::new(),
            files: HashMap::new(),
            bytes: 0,
            beside_bytes: 0,
            numbers: 0,
            limits: *limits,
        }
    }

    /// Counts numbers before they are read.
    fn spend(&mut self, accessor: usize, numbers: usize) -> Result<(), ParseError> {
        self.numbers = self.numbers.saturating_add(numbers);
        let most = FREE_NUMBERS + self.bytes.saturating_mul(NUMBERS_A_BYTE);
        let most = most.min(MOST_NUMBERS);
        if self.numbers > most {
            return Err(fail(accessor, &format!("at most {most} numbers"), "more"));
        }
        self.limits.afford(self.memory(), 1)
    }

    /// Bytes of memory for what was opened and read.
    fn memory(&self) -> usize {
        (self.numbers.saturating_mul(size_of::<f64>())).saturating_add(self.beside_bytes)
    }

    /// All numbers of accessor `number`; integers become −1..1 or 0..1 if the file or `normalize` asks for it.
    pub(super) fn numbers(
        &mut self,
        number: usize,
        normalize: bool,
    ) -> Result<Numbers, ParseError> {
        let document = self.document;
        let accessor = document.list("accessors").get(number);
        let accessor = accessor.ok_or_else(|| fail(number, "an accessor", "none"))?;
        let width = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            other => {
                let found = format!("type {}", other.unwrap_or("none"));
                return Err(fail(number, "numbers or vectors", &found));
            }
        };
        let kind = Component::of(&accessor["componentType"])
            .ok_or_else(|| fail(number, "a componentType of glTF 2.0", "another"))?;
        let normalize = normalize || accessor["normalized"].as_bool().unwrap_or(false);
        let count =
            index(&accessor["count"]).ok_or_else(|| fail(number, "a count of elements", "none"))?;
        let mut values = match index(&accessor["bufferView"]) {
            Some(view) => {
                let at = index(&accessor["byteOffset"]).unwrap_or(0);
                self.column(number, view, at, count, width, kind, normalize)?
            }
            None if count.saturating_mul(width) <= MOST_ZEROS => {
                self.spend(number, count * width)?;
                vec![0.0; count * width]
            }
            None => return Err(fail(number, "a bufferView", "none")),
        };
        self.replace(
            number,
            &accessor["sparse"],
            &mut values,
            width,
            kind,
            normalize,
        )?;
        Ok(Numbers { values, width })
    }

    /// Elements that a sparse accessor puts in place of others.
    fn replace(
        &mut self,
        number: usize,
        sparse: &Value,
        values: &mut [f64],
        width: usize,
        kind: Component,
        normalize: bool,
    ) -> Result<(), ParseError> {
        let Some(count) = index(&sparse["count"]) else {
            return Ok(());
        };
        let view = |part: &str| {
            index(&sparse[part]["bufferView"])
                .ok_or_else(|| fail(number, "a sparse bufferView", "none"))
        };
        let offset = |part: &str| index(&sparse[part]["byteOffset"]).unwrap_or(0);
        let places_kind = Component::of(&sparse["indices"]["componentType"])
            .ok_or_else(|| fail(number, "sparse indices of a known type", "another"))?;
        let (places, at) = (view("indices")?, offset("indices"));
        let places = self.column(number, places, at, count, 1, places_kind, false)?;
        let (view, at) = (view("values")?, offset("values"));
        let new = self.column(number, view, at, count, width, kind, normalize)?;
        for (place, new) in places.iter().zip(new.chunks_exact(width)) {
            let begin = (*place as usize).saturating_mul(width);
            let old = values
                .get_mut(begin..begin.saturating_add(width))
                .ok_or_else(|| fail(number, "sparse indices below its count", "others"))?;
            old.copy_from_slice(new);
        }
        Ok(())
    }

    #[allow(clippy::too_many_arguments)] // What an accessor is made of.
    fn column(
        &mut self,
        number: usize,
        view: usize,
        offset: usize,
        count: usize,
        width: usize,
        kind: Component,
        normalize: bool,
    ) -> Result<Vec<f64>, ParseError> {
        let document = self.document;
        let view = document.list("bufferViews").get(view);
        let view = view.ok_or_else(|| fail(number, "a bufferView", "none"))?;
        if view["extensions"]["EXT_meshopt_compression"].is_object() {
            let found = "one compressed by EXT_meshopt_compression; decompress it first, for instance with `gltf-transform`";
            return Err(fail(number, "a plain bufferView", found));
        }
        let buffer = index(&view["buffer"]).ok_or_else(|| fail(number, "a buffer", "none"))?;
        let buffer = self.of_same_file(buffer);
        let length = self.buffer(buffer)?.len();
        let element = width * kind.size();
        let stride = index(&view["byteStride"])
            .filter(|&s| s > 0)
            .unwrap_or(element);
        let begin = index(&view["byteOffset"])
            .unwrap_or(0)
            .saturating_add(offset);
        let needed = match count {
            0 => return Ok(Vec::new()),
            _ => (count - 1)
                .saturating_mul(stride)
                .saturating_add(element)
                .saturating_add(begin),
        };
        if needed > length {
            let expected = format!("{needed} bytes in buffer {buffer}");
            return Err(fail(number, &expected, &length.to_string()));
        }
        let all = count.saturating_mul(width);
        self.spend(number, all)?;
        let bytes = &self.opened[&buffer];
        let mut values = Vec::with_capacity(all);
        for k in 0..count {
            let element = &bytes[begin + k * stride..][..element];
            let parts = element.chunks_exact(kind.size());
            values.extend(parts.map(|part| kind.value(part, normalize)));
        }
        Ok(values)
    }

    fn buffer(&mut self, number: usize) -> Result<&[u8], ParseError> {
        if !self.opened.contains_key(&number) {
            let bytes = self.open(number)?;
            self.bytes = self.bytes.saturating_add(bytes.len());
            if self.file_of(number).is_some() {
                self.beside_bytes = self.beside_bytes.saturating_add(bytes.len());
            }
            if self.beside_bytes > MOST_BESIDE {
                let expected = format!("at most {} MB in files beside it", MOST_BESIDE >> 20);
                return Err(ParseError::new(Place::File, expected, "more"));
            }
            self.limits.afford(self.memory(), 1)?;
            self.opened.insert(number, bytes);
        }
        Ok(&self.opened[&number])
    }

    /// The file beside the scene that a buffer is in.
    fn file_of(&self, number: usize) -> Option<String> {
        let uri = self.document.list("buffers").get(number)?["uri"].as_str()?;
        let file = percent_decoded(uri);
        let file = file.trim_start_matches("./");
        (!uri.starts_with("data:")).then(|| file.to_owned())
    }

    /// The first buffer that is in the same file: each is opened once.
    fn of_same_file(&mut self, number: usize) -> usize {
        match self.file_of(number) {
            Some(file) => *self.files.entry(file).or_insert(number),
            None => number,
        }
    }

    fn open(&self, number: usize) -> Result<Cow<'a, [u8]>, ParseError> {
        let wrong = |found: String| {
            ParseError::new(Place::File, format!("the bytes of buffer {number}"), found)
        };
        let buffer = self.document.list("buffers").get(number);
        let Some(uri) = buffer.and_then(|buffer| buffer["uri"].as_str()) else {
            return match self.document.binary {
                Some((bytes, _)) if number == 0 => Ok(bytes.into()),
                _ => Err(wrong("none in the file".to_owned())),
            };
        };
        if let Some(data) = uri.strip_prefix("data:") {
            let (kind, text) = data.split_once(',').unwrap_or(("", data));
            if !kind.ends_with(";base64") {
                return Err(wrong("a data address that is not base64".to_owned()));
            }
            return LENIENT
                .decode(text.trim())
                .map(Cow::Owned)
                .map_err(|error| wrong(error.to_string()));
        }
        let file = self.file_of(number).unwrap_or_default();
        // Only files beside the scene are read.
        let outside = file.starts_with(['/', '\\']) || file.contains(':') || file.contains("..");
        let bytes = match outside {
            true => Err(io::Error::from(io::ErrorKind::NotFound)),
            false => (self.beside)(&file),
        };
        bytes.map(Cow::Owned).map_err(|error| {
            wrong(match error.kind() {
                io::ErrorKind::NotFound => format!("no file {file} beside it"),
                _ => format!("{file} beside it: {error}"),
            })
        })
    }
}

/// Padded or not.
const LENIENT: base64::engine::GeneralPurpose = base64::engine::GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    base64::engine::GeneralPurposeConfig::new()
        .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after
            .get(..2)
            .and_then(|hex| std::str::from_utf8(hex).ok())
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match (first, code) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn fail(accessor: usize, expected: &str, found: &str) -> ParseError {
    let expected = format!("{expected} (accessor {accessor})");
    ParseError::new(Place::File, expected, found)
}

/// Types of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(value: &Value) -> Option<Self> {
        Some(match value.as_u64()? {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// `bytes` are [`size`](Self::size) many.
    fn value(self, bytes: &[u8], normalize: bool) -> f64 {
        let two = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        let (value, most): (f64, f64) = match self {
            Self::I8 => (i8::from_le_bytes([bytes[0]]).into(), i8::MAX.into()),
            Self::U8 => (bytes[0].into(), u8::MAX.into()),
            Self::I16 => (i16::from_le_bytes(two()).into(), i16::MAX.into()),
            Self::U16 => (u16::from_le_bytes(two()).into(), u16::MAX.into()),
            Self::U32 => (u32::from_le_bytes(four()).into(), u32::MAX.into()),
            Self::F32 => return f32::from_le_bytes(four()).into(),
        };
        match normalize {
            true => (value / most).max(-1.0),
            false => value,
        }
    }
}
