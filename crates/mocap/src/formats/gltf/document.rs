//! The JSON of a glTF file, and the binary chunk after it.

use serde_json::Value;

use super::super::json::limits_beside;
use super::super::{Limits, ParseError, Place, Warning};

/// A parsed file. Values are looked up leniently: what is missing or of another type is `None`.
pub(super) struct Document<'a> {
    pub(super) json: Value,
    /// The binary chunk of a GLB file, where its bytes begin.
    pub(super) binary: Option<(&'a [u8], usize)>,
    /// True if the file is shorter than it says.
    pub(super) cut: bool,
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BINARY: u32 = u32::from_le_bytes(*b"BIN\0");

impl<'a> Document<'a> {
    pub(super) fn parse(
        bytes: &'a [u8],
        limits: &Limits,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, ParseError> {
        let document = if bytes.starts_with(MAGIC) {
            Self::binary(bytes, warnings)?
        } else {
            Self {
                json: json(bytes, 0)?,
                binary: None,
                cut: false,
            }
        };
        document.check(limits)?;
        Ok(document)
    }

    /// What is left of `limits` beside the document.
    pub(super) fn limits_beside(bytes: &[u8], limits: &Limits) -> Result<Limits, ParseError> {
        // The keys of a binary file are no document, and lie behind it.
        let length = || Some(u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize);
        let text = match bytes.starts_with(MAGIC) {
            true => length().and_then(|length| bytes.get(..length.saturating_add(20))),
            false => None,
        };
        limits_beside(text.unwrap_or(bytes), limits)
    }

    fn binary(bytes: &'a [u8], warnings: &mut Vec<Warning>) -> Result<Self, ParseError> {
        let word = |at: usize| -> Option<u32> {
            Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
        };
        match word(4) {
            Some(2) => {}
            Some(version) => {
                let found = format!("binary glTF {version}");
                return Err(ParseError::new(Place::Byte(4), "binary glTF 2", found));
            }
            None => return Err(ParseError::new(Place::Byte(4), "a version", "the end")),
        }
        let (mut text, mut binary, mut cut) = (None, None, false);
        let mut at = 12;
        while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
            let (begin, length) = (at + 8, length as usize);
            let end = begin.saturating_add(length);
            let chunk = bytes.get(begin..end).unwrap_or(&bytes[begin..]);
            if chunk.len() < length {
                cut = true;
                let found = format!("{} bytes of the {length} of a chunk", chunk.len());
                if text.is_none() {
                    let place = Place::Byte(begin as u64);
                    return Err(ParseError::new(place, "the JSON chunk", found));
                }
                let note = format!("the file is cut short: {found} are there");
                warnings.push(Warning::new(Place::Byte(begin as u64), note));
            }
            match kind {
                JSON if text.is_none() => text = Some((chunk, begin)),
                BINARY if binary.is_none() => binary = Some((chunk, begin)),
                _ => {}
            }
            at = end;
        }
        let (text, begin) =
            text.ok_or_else(|| ParseError::new(Place::Byte(12), "a JSON chunk", "none"))?;
        Ok(Self {
            json: json(text, begin)?,
            binary,
            cut,
        })
    }

    fn check(&self, limits: &Limits) -> Result<(), ParseError> {
        let refuse = |expected: &str, found: String| {
            Err(ParseError::new(Place::File, expected.to_owned(), found))
        };
        if !self.json.is_object() {
            return refuse("glTF, a JSON object", "other JSON".to_owned());
        }
        // glTF 1.0 keeps nodes by name, in an object.
        if self.json["nodes"].is_object() {
            return refuse("glTF 2.0", "glTF 1.0".to_owned());
        }
        if let Some(version) = self.json["asset"]["version"].as_str()
            && !version.starts_with('2')
        {
            return refuse("glTF 2.0", format!("glTF {version}"));
        }
        let most = limits.joints.saturating_mul(16);
        match self.list("nodes").len() {
            nodes if nodes > most => refuse(&format!("at most {most} nodes"), nodes.to_string()),
            _ => Ok(()),
        }
    }

    /// The elements of a list at the top; none if there is no such list.
    pub(super) fn list(&self, key: &str) -> &[Value] {
        self.json[key].as_array().map_or(&[], Vec::as_slice)
    }

    /// Kind of the file, in words.
    pub(super) fn kind(&self) -> &'static str {
        let extensions = &self.json["extensions"];
        match () {
            () if extensions["VRMC_vrm_animation"].is_object() => "VRM animation (VRMA)",
            () if extensions["VRMC_vrm"].is_object() => "VRM 1.0",
            () if extensions["VRM"].is_object() => "VRM 0.x",
            () => "glTF 2.0",
        }
    }
}

/// The index that `value` holds.
pub(super) fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

/// The numbers of a list, if it has `N` of them.
pub(super) fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let list = value.as_array()?;
    let mut numbers = [0.0; N];
    if list.len() != N {
        return None;
    }
    for (number, value) in numbers.iter_mut().zip(list) {
        *number = value.as_f64().filter(|v| v.is_finite())?;
    }
    Some(numbers)
}

fn json(bytes: &[u8], begin: usize) -> Result<Value, ParseError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    // Chunks are padded, by some with zeros.
    let end = bytes
        .iter()
        .rposition(|b| *b != 0)
        .map_or(0, |last| last + 1);
    // Names in other encodings lose their odd letters.
    let text = String::from_utf8_lossy(&bytes[..end]);
    serde_json::from_str(&text).map_err(|error| {
        let at = match begin {
            0 => Place::Column(error.line() as u64, error.column() as u64),
            _ => Place::Byte(begin as u64),
        };
        ParseError::new(at, "the JSON of glTF", error.to_string())
    })
}
