//! Recognises formats, by content first and by name if the content is ambiguous.
//!
//! Formats that are recognised only to be refused by their names are in `unread.tsv`.

mod unread;

use super::head::Head;
use super::{Format, ParseError, Place, READ, table};

/// Tells the format of `bytes`; `name` (a file's name or path) decides if they do not say.
///
/// # Errors
/// Content that nothing reads, with the format it looks like if it is known.
pub fn probe(bytes: &[u8], name: &str) -> Result<Format, ParseError> {
    let head = Head::new(bytes);
    if let Some((found, _)) = READ.iter().find(|(_, known)| (known.looks_so)(&head)) {
        return Ok(*found);
    }
    if let Some(unread) = unread::of_content(&head) {
        let (name, advice) = (unread.name, unread.advice);
        return Err(ParseError::new(
            Place::File,
            "a supported motion format",
            format!("content that looks like {name}, which is not supported: {advice}"),
        ));
    }
    // What is wrong with a broken C3D file is reported by its reader.
    let by_name = |format: &Format| !head.is_binary() || *format == Format::C3d;
    if let Some(format) = format_of_name(name).filter(by_name) {
        return Ok(format);
    }
    let (_, ending) = name.rsplit_once('.').unwrap_or_default();
    if let Some(unread) = unread::of_ending(ending).filter(|_| !bytes.is_empty()) {
        let (name, advice) = (unread.name, unread.advice);
        let found = format!("a file that by its name is {name}, which is not supported: {advice}");
        return Err(ParseError::new(
            Place::File,
            "a supported motion format",
            found,
        ));
    }
    let found = match bytes {
        [] => "an empty file".to_owned(),
        _ if head.is_binary() => "unknown binary content".to_owned(),
        _ if head.is_markup() => "XML of an unknown kind".to_owned(),
        _ if head.starts("{") || head.starts("[") => {
            "JSON without points, poses or joints".to_owned()
        }
        _ => table::what_it_is(head.bytes).unwrap_or_else(|| "unknown text".to_owned()),
    };
    let expected = match format_of_name(name) {
        // What it is called and is not.
        Some(format) => format!("{}, according to its name", format.name()),
        None => {
            let titles: Vec<&str> = READ.iter().map(|(_, known)| known.title).collect();
            titles.join(", ")
        }
    };
    Err(ParseError::new(Place::File, expected, found))
}

/// The format that a file's ending promises.
pub fn format_of_name(name: &str) -> Option<Format> {
    let (_, extension) = name.rsplit_once('.')?;
    let ends = |ending: &&str| ending.eq_ignore_ascii_case(extension);
    let found = READ
        .iter()
        .find(|(_, known)| known.endings.iter().any(ends));
    found.map(|(format, _)| *format)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_comes_before_the_name() {
        let mut c3d = vec![2u8, 0x50];
        c3d.resize(512, 0);
        for (bytes, name, format) in [
            (b"HIERARCHY\nROOT Hips".as_slice(), "a.amc", Format::Bvh),
            (b"\xEF\xBB\xBF# junk\n{\nhierarchy\r\n", "a", Format::Bvh),
            (b"MOTION\nFrames: 1\n", "a", Format::Bvh),
            (b"# AST/ASF file\n:version 1.10\n", "a.txt", Format::Asf),
            (
                b"#!OML:ASF X:\\f\xFCr\n:FULLY-SPECIFIED\n1\n",
                "a",
                Format::Amc,
            ),
            (b"1\nroot 0 1 0 0 0 0\n", "a.bvh", Format::Amc),
            (b"hello", "dir.x/a.AMC", Format::Amc),
            (b"MCLIP\n\x01\0", "a.bvh", Format::Mclip),
            (b"", "a.bvh", Format::Bvh),
            (&c3d, "a.bvh", Format::C3d),
            (b"\x02\x50\0", "a.c3d", Format::C3d),
            (b"PathFileType\t4\t(X/Y/Z)\ta.trc\n", "a", Format::Trc),
            (b"{\"t\": 0, \"positions\": {}}\n", "a", Format::Jsonl),
            (
                b"frame,a_x,a_y,a_z,b_x,b_y,b_z\n1,2,3,4,5,6,7\n",
                "a",
                Format::Table,
            ),
            (b"clip\tclass\nx\ty\n", "a.tsv", Format::Table),
            (b"Kaydara FBX Binary  \0", "a.bvh", Format::Fbx),
            (b"; FBX 7.3.0 project file", "a", Format::Fbx),
            (b"glTF\x02\0\0\0", "a", Format::Gltf),
            (b"{ \"asset\": {} }", "a", Format::Gltf),
            (b"{ }", "a.vrma", Format::Gltf),
            (b"<?xml?><mvnx version=\"4\">", "a", Format::Mvnx),
            (
                b"PK\x03\x04......................\x05\0\0\0a.npy",
                "a",
                Format::Smpl,
            ),
            (b"\x23\0\0\0head\x12\0\0\0ftyp", "a", Format::Mocopi),
            (
                b"Coordinates\nversion=1\nendheader\ntime\tpelvis_tilt\n",
                "a",
                Format::OpenSimMotion,
            ),
            (
                b"#a\n[Header]\n[SegmentNames&Hierarchy]\n",
                "a",
                Format::Htr,
            ),
            (b"$Rate 120\n$Order\nLFHD\n$Points\n", "a", Format::Csm),
            (
                b"Coordinates\nnRows=2\nnColumns=3,,,\n",
                "a",
                Format::OpenSimMotion,
            ),
            (
                b"<?xml?>\n<OpenSimDocument Version=\"40000\">",
                "a",
                Format::OpenSimModel,
            ),
        ] {
            assert_eq!(probe(bytes, name), Ok(format), "{name}");
        }
    }

    #[test]
    fn what_is_not_read_is_named() {
        for (bytes, found) in [
            (b"PK\x03\x04....".as_slice(), "zip"),
            (b"#usda 1.0\n", "USD"),
            (b"Vocaloid Motion Data 0002\0", "VMD"),
            (b"\x80\x04\x95", "pickle"),
            (b"", "an empty file"),
            (b"a,b,c\n1,2,3\n", "unknown text"),
            (b"\x01\x02\0\0", "unknown binary"),
            (b"\x7FELF\0\0", "a program"),
            (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS"),
            (b"<!DOCTYPE html>\n<html>", "HTML"),
            (b"PAR1\0", "Parquet"),
            (
                b"\x20\0\0\0\0\0\0\0{\"__metadata__\":{\"morec\":\"morec-index\"}}",
                "an index of morec",
            ),
            (b"[Header]\nFileType gtr\n", "GTR"),
            (b"{\"poses\": [[0]], \"shapes\": [[0]]}", "SMPL as JSON"),
            (b"{\"file_version\": 1, \"asset_info\": {}}", "DUF"),
            (b"<?xml?><MMM>", "Master Motor Map"),
        ] {
            let error = probe(bytes, "file.dat").unwrap_err();
            assert!(error.found.contains(found), "{error}");
        }
        let called = probe(b"\x01\x02\0\0", "a.glb").unwrap_err();
        assert!(
            called.expected.contains("gltf, according to its name"),
            "{called}"
        );
        assert!(probe(b"\x01\x02\0\0", "a.bvh").is_err());
    }
}
