//! Telling formats apart: by content first, by name where the content says nothing.
//!
//! A new format is registered in `READ`; one that is only recognised, to be refused by its name, in `UNREAD`.

use super::{ParseError, Place, table};
use crate::smooth::MAGIC;

/// A format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// Biovision: skeleton and motion in one file.
    Bvh,
    /// Acclaim skeleton, for motions in [`Format::Amc`].
    Asf,
    /// Acclaim motion of an [`Format::Asf`] skeleton.
    Amc,
    /// The stored form of a compressed clip ([`smooth`](crate::smooth)).
    Mclip,
    /// Points of biomechanics, binary.
    C3d,
    /// Points as tab-separated text.
    Trc,
    /// Lines of JSON, a pose in each.
    Jsonl,
    /// A table of positions, CSV or TSV.
    Table,
}

struct Readable {
    format: Format,
    extension: &'static str,
    looks_so: fn(&Head) -> bool,
}

/// Every format that is read, in the order in which its content is asked for.
const READ: [Readable; 11] = [
    Readable {
        format: Format::Mclip,
        extension: "mclip",
        looks_so: |h| h.bytes.starts_with(MAGIC),
    },
    Readable {
        format: Format::Bvh,
        extension: "bvh",
        looks_so: is_bvh,
    },
    Readable {
        format: Format::Asf,
        extension: "asf",
        looks_so: is_asf,
    },
    Readable {
        format: Format::Amc,
        extension: "amc",
        looks_so: is_amc,
    },
    Readable {
        format: Format::Trc,
        extension: "trc",
        looks_so: is_trc,
    },
    Readable {
        format: Format::C3d,
        extension: "c3d",
        looks_so: |h| {
            h.bytes.len() >= 512 && matches!(h.bytes, [1..128, 0x50, ..]) && h.is_binary()
        },
    },
    Readable {
        format: Format::Jsonl,
        extension: "jsonl",
        looks_so: is_jsonl,
    },
    Readable {
        format: Format::Jsonl,
        extension: "ndjson",
        looks_so: |_| false,
    },
    Readable {
        format: Format::Table,
        extension: "csv",
        looks_so: |h| !h.is_binary() && table::looks_so(h.bytes),
    },
    Readable {
        format: Format::Table,
        extension: "tsv",
        looks_so: |_| false,
    },
    Readable {
        format: Format::Table,
        extension: "tab",
        looks_so: |_| false,
    },
];

struct Unread {
    name: &'static str,
    looks_so: fn(&Head) -> bool,
}

/// Formats that are recognised only to say that they are not read.
const UNREAD: [Unread; 8] = [
    Unread {
        name: "FBX",
        looks_so: |h| h.starts("Kaydara FBX Binary") || h.starts("; FBX"),
    },
    Unread {
        name: "binary glTF",
        looks_so: |h| h.starts("glTF"),
    },
    Unread {
        name: "glTF",
        looks_so: |h| h.starts("{") && h.contains(b"\"asset\""),
    },
    Unread {
        name: "an npz or other zip archive",
        looks_so: |h| h.starts("PK\x03\x04"),
    },
    Unread {
        name: "a NumPy array",
        looks_so: |h| h.bytes.starts_with(b"\x93NUMPY"),
    },
    Unread {
        name: "MVNX",
        looks_so: |h| h.starts("<") && h.contains(b"<mvnx"),
    },
    Unread {
        name: "USD",
        looks_so: |h| h.starts("PXR-USDC") || h.starts("#usda"),
    },
    Unread {
        name: "HDF5",
        looks_so: |h| h.bytes.starts_with(b"\x89HDF"),
    },
];

/// Which format `bytes` have; `name` (a file's name or path) decides if they do not say.
///
/// # Errors
/// Content that nothing reads, with the format it looks like if it is known.
pub fn probe(bytes: &[u8], name: &str) -> Result<Format, ParseError> {
    let head = Head::new(bytes);
    if let Some(found) = READ.iter().find(|readable| (readable.looks_so)(&head)) {
        return Ok(found.format);
    }
    let expected = "BVH, ASF, AMC, MCLIP, C3D, TRC, JSON lines or a table of positions";
    if let Some(unread) = UNREAD.iter().find(|unread| (unread.looks_so)(&head)) {
        return Err(ParseError::new(
            Place::File,
            expected,
            format!("what looks like {}, not read yet", unread.name),
        ));
    }
    // A broken C3D file is told what is wrong with it by its reader.
    let by_name = |format: &Format| !head.is_binary() || *format == Format::C3d;
    if let Some(format) = format_of_name(name).filter(by_name) {
        return Ok(format);
    }
    let found = match bytes {
        [] => "an empty file",
        _ if head.is_binary() => "unknown binary content",
        _ => "unknown text",
    };
    Err(ParseError::new(Place::File, expected, found))
}

/// The format that a file's ending promises.
pub fn format_of_name(name: &str) -> Option<Format> {
    let (_, extension) = name.rsplit_once('.')?;
    READ.iter()
        .find(|r| r.extension.eq_ignore_ascii_case(extension))
        .map(|r| r.format)
}

/// The beginning of a file.
struct Head<'a> {
    bytes: &'a [u8],
}

impl<'a> Head<'a> {
    const LONGEST: usize = 64 * 1024;

    fn new(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        Self {
            bytes: &bytes[..bytes.len().min(Self::LONGEST)],
        }
    }

    fn starts(&self, text: &str) -> bool {
        self.bytes.trim_ascii_start().starts_with(text.as_bytes())
    }

    fn contains(&self, text: &[u8]) -> bool {
        self.bytes
            .windows(text.len())
            .any(|window| window.eq_ignore_ascii_case(text))
    }

    fn is_binary(&self) -> bool {
        self.bytes.contains(&0)
    }

    /// Lines that are no comment and not empty.
    fn lines(&self) -> impl Iterator<Item = &'a [u8]> {
        let lines = self
            .bytes
            .split(|b| matches!(b, b'\n' | b'\r'))
            .map(<[u8]>::trim_ascii);
        lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"))
    }
}

/// `HIERARCHY` at the start of one of the first lines (junk before it is met), or `MOTION` alone.
fn is_bvh(head: &Head) -> bool {
    let begins = |line: &[u8], word: &[u8]| {
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word)
    };
    head.lines()
        .take(100)
        .any(|line| begins(line, b"HIERARCHY"))
        || head
            .lines()
            .next()
            .is_some_and(|line| line.eq_ignore_ascii_case(b"MOTION"))
}

/// `PathFileType`, or a row that begins with `Frame#` and names points after a row of TRC's header.
fn is_trc(head: &Head) -> bool {
    let begins = |line: &[u8], word: &[u8]| {
        let line = line.strip_prefix(b"\"").unwrap_or(line);
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word)
    };
    let opens = |line: &[u8]| begins(line, b"PathFileType") || begins(line, b"DataRate");
    !head.is_binary() && head.lines().take(3).any(opens)
}

/// An object with poses on the first line.
fn is_jsonl(head: &Head) -> bool {
    let mut lines = head.lines();
    let first = lines.next().unwrap_or_default();
    let holds = |word: &[u8]| first.windows(word.len()).any(|window| window == word);
    first.starts_with(b"{")
        && (holds(b"\"positions\"") || holds(b"\"rotations\""))
        && !holds(b"\"asset\"")
}

fn is_asf(head: &Head) -> bool {
    let first = head.lines().next().unwrap_or_default().to_ascii_lowercase();
    let opens = [
        b":version".as_slice(),
        b":name",
        b":units",
        b":documentation",
        b":root",
        b":bonedata",
    ];
    opens.iter().any(|keyword| first.starts_with(keyword))
}

/// A header of its own, or a number alone on a line and then a name and a number.
fn is_amc(head: &Head) -> bool {
    let opens = |line: &[u8]| {
        let line = line.to_ascii_lowercase();
        [b":fully-specified".as_slice(), b":degrees", b":radians"]
            .iter()
            .any(|word| line.starts_with(word))
    };
    let mut lines = head.lines();
    let Some(first) = lines.next() else {
        return false;
    };
    if opens(first) {
        return true;
    }
    let mut row = lines
        .next()
        .unwrap_or_default()
        .split(u8::is_ascii_whitespace);
    let named = row
        .next()
        .is_some_and(|name| name.first().is_some_and(u8::is_ascii_alphabetic));
    first.iter().all(u8::is_ascii_digit)
        && named
        && row
            .next()
            .is_some_and(|value| fast_float2::parse::<f64, _>(value).is_ok())
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
        ] {
            assert_eq!(probe(bytes, name), Ok(format), "{name}");
        }
    }

    #[test]
    fn what_is_not_read_is_named() {
        for (bytes, found) in [
            (b"Kaydara FBX Binary  \0".as_slice(), "FBX"),
            (b"; FBX 7.3.0 project file", "FBX"),
            (b"glTF\x02\0\0\0", "binary glTF"),
            (b"{ \"asset\": {} }", "glTF"),
            (b"PK\x03\x04....", "npz"),
            (b"<?xml?><mvnx version=\"4\">", "MVNX"),
            (b"", "an empty file"),
            (b"a,b,c\n1,2,3\n", "unknown text"),
            (b"\x7FELF\0\0", "unknown binary"),
        ] {
            let error = probe(bytes, "file.dat").unwrap_err();
            assert!(error.found.contains(found), "{error}");
        }
        assert!(probe(b"\x7FELF\0\0", "a.bvh").is_err());
    }
}
