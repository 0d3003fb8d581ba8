//! Archives and encodings around files: gzip, zip, UTF-16.

use std::borrow::Cow;
use std::io::{Cursor, Read};

use super::{ParseError, Place};
pub use crate::limits::memory_of_packed;

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

/// True if `bytes` begin as a gzip file does.
pub fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b\x08")
}

/// True if `bytes` begin as a zip archive does; one without files counts.
pub fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

/// Unpacks a gzip file to at most `most` bytes.
///
/// # Errors
/// Bytes that are no gzip or break off, and more than `most`.
pub fn gunzip(bytes: &[u8], most: usize) -> Result<Vec<u8>, ParseError> {
    read_within(flate2::read::MultiGzDecoder::new(bytes), most, || {
        "a whole gzip file".to_owned()
    })
}

/// All bytes of `from`, of which there may be `most`.
fn read_within(
    from: impl Read,
    most: usize,
    expected: impl FnOnce() -> String,
) -> Result<Vec<u8>, ParseError> {
    let mut unpacked = Vec::new();
    let limit = (most as u64).saturating_add(1);
    match from.take(limit).read_to_end(&mut unpacked) {
        Ok(read) if read > most => Err(ParseError::of_memory(most, read)),
        Ok(_) => Ok(unpacked),
        Err(error) => Err(ParseError::new(Place::File, expected(), error.to_string())),
    }
}

/// The files of a zip archive for which `wanted` holds, unpacked to at most `most` bytes together, in their order there.
///
/// # Errors
/// Bytes that are no zip archive or break off, files that lie on the same bytes, encryption and packing other than deflate, and
/// more than `most`.
pub fn unzip(
    bytes: &[u8],
    wanted: &dyn Fn(&str) -> bool,
    most: usize,
) -> Result<Vec<Member>, ParseError> {
    let refuse =
        |expected: String, found: String| Err(ParseError::new(Place::File, expected, found));
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(no_archive)?;
    if archive.len() > MOST_MEMBERS {
        let expected = format!("at most {MOST_MEMBERS} files in an archive");
        return refuse(expected, archive.len().to_string());
    }
    let (mut left, mut packed) = (most, 0u64);
    let mut members = Vec::new();
    for number in 0..archive.len() {
        let file = archive.by_index(number).map_err(no_archive)?;
        // Files that lie on the same bytes are more than the archive can hold side by side.
        packed = packed.saturating_add(file.compressed_size());
        if packed > bytes.len() as u64 {
            let expected = "files side by side in a zip archive".to_owned();
            return refuse(expected, "files that lie on the same bytes".to_owned());
        }
        let path = file.name().map_err(no_archive)?.replace('\\', "/");
        if file.is_dir() || !wanted(&path) {
            continue;
        }
        let unpacked = read_within(file, left, || format!("{path} whole in the archive"))?;
        // A file takes memory beside its bytes, and there may be many.
        let used = unpacked.len() + path.len() + size_of::<Member>();
        left = left
            .checked_sub(used)
            .ok_or_else(|| ParseError::of_memory(most, most - left + used))?;
        members.push(Member {
            path,
            bytes: unpacked,
        });
    }
    Ok(members)
}

fn no_archive(error: zip::result::ZipError) -> ParseError {
    ParseError::new(Place::File, "a whole zip archive", error.to_string())
}

/// The paths in a zip archive, without unpacking anything.
///
/// # Errors
/// Bytes that are no zip archive.
pub fn zip_paths(bytes: &[u8]) -> Result<Vec<String>, ParseError> {
    let archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(no_archive)?;
    let paths = archive.file_names();
    paths
        .map(|path| Ok(path.map_err(no_archive)?.into_owned()))
        .collect()
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
        assert_eq!(gunzip(&gz(&text), 1000).unwrap(), text);
        let zip = zip_of(&[("a/b.bvh", &text), ("c.txt", b"no")]);
        assert!(is_zip(&zip));
        let members = unzip(&zip, &|path| path.ends_with(".bvh"), 1000).unwrap();
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
        assert!(gunzip(&gz(&zeros), 3 << 20).is_ok());
        let error = gunzip(&gz(&zeros), 2 << 20).unwrap_err();
        assert!(error.is_of_memory(), "{error}");
        let zip = zip_of(&[("a", &zeros[..1 << 20]), ("b", &zeros)]);
        assert!(unzip(&zip, &|_| true, 5 << 20).is_ok());
        let error = unzip(&zip, &|_| true, 3 << 20).unwrap_err();
        assert!(error.is_of_memory(), "{error}");
    }

    /// Every entry of the directory is pointed at the first file, whose bytes would be unpacked for each of them.
    #[test]
    fn files_on_the_same_bytes_are_refused() {
        let text: Vec<u8> = (0..4000u32)
            .flat_map(|n| n.wrapping_mul(2_654_435_761).to_le_bytes())
            .collect();
        let names: Vec<String> = (0..9).map(|n| format!("{n}.bvh")).collect();
        let files: Vec<(&str, &[u8])> = names.iter().map(|n| (n.as_str(), &b""[..])).collect();
        let mut zip = zip_of(&[&[("a.bvh", &text[..])], &files[..]].concat());
        let entries: Vec<usize> = (0..zip.len() - 4)
            .filter(|&at| zip[at..].starts_with(b"PK\x01\x02"))
            .collect();
        let first = zip[entries[0]..entries[0] + 46].to_vec();
        for &entry in &entries[1..] {
            // Method, sums and sizes; place of the file.
            zip[entry + 10..entry + 28].copy_from_slice(&first[10..28]);
            zip[entry + 42..entry + 46].copy_from_slice(&first[42..46]);
        }
        let error = unzip(&zip, &|_| true, 1 << 30).unwrap_err();
        assert!(error.found.contains("same bytes"), "{error}");
    }

    #[test]
    fn cut_and_altered_archives_never_panic() {
        let zip = zip_of(&[("a.bvh", &b"HIERARCHY".repeat(50)), ("b", b"no")]);
        crate::formats::mangle::each(&zip, 400, |bytes| {
            let _ = unzip(bytes, &|_| true, 1 << 20);
        });
        crate::formats::mangle::each(&gz(b"abc"), 100, |bytes| _ = gunzip(bytes, 1 << 20));
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
