//! Archives and encodings around files: gzip, zip, UTF-16.

use std::borrow::Cow;
use std::io::{Cursor, Read};

use super::{ParseError, Place};

/// Bytes that are unpacked however small an archive is,
const FREE_BYTES: u64 = 64 << 20;
/// this many for each of its bytes (text of motion has 3 to 20, stillness some hundred),
const BYTES_A_BYTE: u64 = 256;
/// and never more than this.
const MOST_BYTES: u64 = 4 << 30;
/// Files in one archive.
const MOST_MEMBERS: usize = 100_000;

/// A file in an archive.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Its path there, with `/` between folders.
    pub path: String,
    /// Its bytes, unpacked.
    pub bytes: Vec<u8>,
}

/// Most bytes that an archive may unpack to.
fn budget(packed: usize) -> u64 {
    FREE_BYTES
        .saturating_add((packed as u64).saturating_mul(BYTES_A_BYTE))
        .min(MOST_BYTES)
}

/// True if `bytes` begin as a gzip file does.
pub fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b\x08")
}

/// True if `bytes` begin as a zip archive does; one without files counts.
pub fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

/// Unpacks a gzip file.
///
/// # Errors
/// Bytes that are no gzip or break off, and more than 256 bytes for each packed one (64 MiB are free).
pub fn gunzip(bytes: &[u8]) -> Result<Vec<u8>, ParseError> {
    gunzip_within(bytes, budget(bytes.len()))
}

fn gunzip_within(bytes: &[u8], most: u64) -> Result<Vec<u8>, ParseError> {
    let mut unpacked = Vec::new();
    let mut reader = flate2::read::MultiGzDecoder::new(bytes).take(most + 1);
    reader
        .read_to_end(&mut unpacked)
        .map_err(|error| ParseError::new(Place::File, "a whole gzip file", error.to_string()))?;
    match unpacked.len() as u64 {
        length if length > most => Err(too_much(most)),
        _ => Ok(unpacked),
    }
}

fn too_much(most: u64) -> ParseError {
    ParseError::new(
        Place::File,
        format!("an archive that unpacks to at most {} MiB", most >> 20),
        "more",
    )
}

/// The files of a zip archive for which `wanted` holds, unpacked, in their order there.
///
/// # Errors
/// Bytes that are no zip archive or break off, encryption and packing other than deflate, and more than 256 bytes for
/// each packed one (64 MiB are free).
pub fn unzip(bytes: &[u8], wanted: &dyn Fn(&str) -> bool) -> Result<Vec<Member>, ParseError> {
    unzip_within(bytes, wanted, budget(bytes.len()))
}

fn unzip_within(
    bytes: &[u8],
    wanted: &dyn Fn(&str) -> bool,
    most: u64,
) -> Result<Vec<Member>, ParseError> {
    let fail = |error: zip::result::ZipError| {
        ParseError::new(Place::File, "a whole zip archive", error.to_string())
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(fail)?;
    if archive.len() > MOST_MEMBERS {
        let expected = format!("at most {MOST_MEMBERS} files in an archive");
        return Err(ParseError::new(
            Place::File,
            expected,
            archive.len().to_string(),
        ));
    }
    let mut left = most;
    let mut members = Vec::new();
    for number in 0..archive.len() {
        let file = archive.by_index(number).map_err(fail)?;
        let path = file.name().replace('\\', "/");
        if file.is_dir() || !wanted(&path) {
            continue;
        }
        let mut unpacked = Vec::new();
        file.take(left + 1)
            .read_to_end(&mut unpacked)
            .map_err(|error| {
                let expected = format!("{path} whole in the archive");
                ParseError::new(Place::File, expected, error.to_string())
            })?;
        left = left
            .checked_sub(unpacked.len() as u64)
            .ok_or_else(|| too_much(most))?;
        members.push(Member {
            path,
            bytes: unpacked,
        });
    }
    Ok(members)
}

/// The paths in a zip archive, without unpacking anything.
///
/// # Errors
/// Bytes that are no zip archive.
pub fn zip_paths(bytes: &[u8]) -> Result<Vec<String>, ParseError> {
    let archive = zip::ZipArchive::new(Cursor::new(bytes))
        .map_err(|error| ParseError::new(Place::File, "a whole zip archive", error.to_string()))?;
    Ok(archive.file_names().map(str::to_owned).collect())
}

/// Text in UTF-16, with a byte order mark or beginning with ASCII letters, as UTF-8; other bytes as they are.
pub fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let encoding = match bytes {
        [0xff, 0xfe, 0, 0, ..] => return bytes.into(),
        [0xff, 0xfe, ..] => encoding_rs::UTF_16LE,
        [0xfe, 0xff, ..] => encoding_rs::UTF_16BE,
        _ if every_other_is_zero(bytes, 1) => encoding_rs::UTF_16LE,
        _ if every_other_is_zero(bytes, 0) => encoding_rs::UTF_16BE,
        _ => return bytes.into(),
    };
    let (text, _, _) = encoding.decode(bytes);
    text.into_owned().into_bytes().into()
}

/// Text without the zero bytes behind its end, which a disk or a crash leaves there; other bytes as they are.
pub fn without_padding(bytes: &[u8]) -> &[u8] {
    let end = bytes
        .iter()
        .rposition(|b| *b != 0)
        .map_or(0, |last| last + 1);
    match end > 0 && end < bytes.len() && !bytes[..end].contains(&0) {
        true => &bytes[..end],
        false => bytes,
    }
}

/// True if the first 32 bytes are printable ASCII with zeros between, those at `zero` and every other behind.
fn every_other_is_zero(bytes: &[u8], zero: usize) -> bool {
    let Some(head) = bytes.get(..32) else {
        return false;
    };
    let is_text = |b: u8| b.is_ascii_graphic() || b.is_ascii_whitespace();
    head.chunks_exact(2)
        .all(|pair| pair[zero] == 0 && is_text(pair[1 - zero]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gz(bytes: &[u8]) -> Vec<u8> {
        let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        out.write_all(bytes).unwrap();
        out.finish().unwrap()
    }

    fn zip_of(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            let options = zip::write::SimpleFileOptions::default();
            out.start_file(*name, options).unwrap();
            out.write_all(bytes).unwrap();
        }
        out.finish().unwrap().into_inner()
    }

    #[test]
    fn archives_unpack_to_what_was_packed() {
        let text = b"HIERARCHY".repeat(50);
        assert_eq!(gunzip(&gz(&text)).unwrap(), text);
        let zip = zip_of(&[("a/b.bvh", &text), ("c.txt", b"no")]);
        assert!(is_zip(&zip));
        let members = unzip(&zip, &|path| path.ends_with(".bvh")).unwrap();
        assert_eq!(members.len(), 1);
        assert_eq!(
            (members[0].path.as_str(), &members[0].bytes),
            ("a/b.bvh", &text)
        );
        assert_eq!(zip_paths(&zip).unwrap().len(), 2);
    }

    #[test]
    fn bombs_are_refused() {
        let zeros = vec![0; 3 << 20];
        assert!(gunzip_within(&gz(&zeros), 3 << 20).is_ok());
        let error = gunzip_within(&gz(&zeros), 2 << 20).map(drop).unwrap_err();
        assert!(error.expected.contains("at most 2 MiB"), "{error}");
        let zip = zip_of(&[("a", &zeros[..1 << 20]), ("b", &zeros)]);
        assert!(unzip_within(&zip, &|_| true, 4 << 20).is_ok());
        let error = unzip_within(&zip, &|_| true, 3 << 20)
            .map(drop)
            .unwrap_err();
        assert!(error.expected.contains("at most 3 MiB"), "{error}");
        assert_eq!(budget(1 << 30), MOST_BYTES);
    }

    #[test]
    fn cut_and_altered_archives_never_panic() {
        let zip = zip_of(&[("a.bvh", &b"HIERARCHY".repeat(50)), ("b", b"no")]);
        crate::formats::mangle::each(&zip, 400, |bytes| {
            let _ = unzip(bytes, &|_| true);
        });
        crate::formats::mangle::each(&gz(b"abc"), 100, |bytes| _ = gunzip(bytes));
    }

    #[test]
    fn zeros_behind_text_are_left_out() {
        for (bytes, kept) in [
            (&b"a b\0\0"[..], 3),
            (b"a b", 3),
            (b"a\0b\0", 4),
            (b"\0\0", 2),
            (b"", 0),
        ] {
            assert_eq!(without_padding(bytes).len(), kept, "{bytes:?}");
        }
    }

    #[test]
    fn utf_16_becomes_utf_8() {
        let text = "HIERARCHY\r\nROOT Hüfte";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for (mark, bytes) in [
            (vec![0xff, 0xfe], &little),
            (vec![0xfe, 0xff], &big),
            (vec![], &little),
            (vec![], &big),
        ] {
            let marked = [mark, bytes.clone()].concat();
            assert_eq!(utf8(&marked).as_ref(), text.as_bytes());
        }
        assert_eq!(utf8(b"HIERARCHY").as_ref(), b"HIERARCHY");
    }
}
