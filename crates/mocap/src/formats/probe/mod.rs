//! Telling formats apart: by content first, by name where the content says nothing.
//!
//! A new format is registered in `READ`; one that is only recognised, to be refused by its name, in
//! `unread`.

mod head;
mod unread;

use self::head::Head;
use self::unread::{UNREAD, UNREAD_ENDINGS, Unread, is_opensim};
use super::{ParseError, Place, mocopi, table};
use crate::smooth::MAGIC;

/// A format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
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
    /// Xsens suits, XML.
    Mvnx,
    /// glTF 2.0, binary or text, VRM and VRMA among it.
    Gltf,
    /// Autodesk's exchange of scenes, binary or text.
    Fbx,
    /// A NumPy archive of SMPL poses, as AMASS has them.
    Smpl,
    /// Recorded packets of mocopi.
    Mocopi,
    /// Joints of Kinect v2 as text, as NTU RGB+D has them.
    NtuSkeleton,
    /// JSON with a list of points in each frame.
    Landmarks,
    /// Positions in NumPy arrays.
    Numpy,
    /// Skeletal animation of the Source engine, text.
    Smd,
    /// Skeletal motion of Motion Analysis, text.
    Htr,
    /// Markers of Character Studio, text.
    Csm,
    /// Joint angles of OpenSim, for a [`Format::OpenSimModel`].
    OpenSimMotion,
    /// A model of OpenSim.
    OpenSimModel,
    /// Motion of DeepMimic's humanoid, JSON.
    DeepMimic,
}

impl Format {
    /// Its name in tables and databases; never changes.
    pub fn name(self) -> &'static str {
        self.descriptor().name
    }

    /// What it is called in tables for people: `BVH`.
    pub fn title(self) -> &'static str {
        self.descriptor().title
    }

    /// What a file of it is called within a sentence: `a BVH clip`.
    pub fn noun(self) -> &'static str {
        self.descriptor().noun
    }

    fn descriptor(self) -> &'static FormatDescriptor {
        let own = READ.iter().find(|descriptor| descriptor.format == self);
        // Every format has one: the structural tests count them.
        own.unwrap_or(&READ[0])
    }
}

/// All that is known of a format but its reader.
struct FormatDescriptor {
    format: Format,
    /// See [`Format::name`].
    name: &'static str,
    /// See [`Format::title`].
    title: &'static str,
    /// See [`Format::noun`].
    noun: &'static str,
    /// Endings of files, in lower case.
    endings: &'static [&'static str],
    /// True of content that shows it.
    looks_so: fn(&Head) -> bool,
}

/// Every format that is read, in the order in which its content is asked for.
const READ: &[FormatDescriptor] = &[
    FormatDescriptor {
        format: Format::Mclip,
        name: "mclip",
        title: "MCLIP (curves)",
        noun: "a stored clip",
        endings: &["mclip"],
        looks_so: |h| h.bytes.starts_with(MAGIC),
    },
    FormatDescriptor {
        format: Format::Bvh,
        name: "bvh",
        title: "BVH",
        noun: "a BVH clip",
        endings: &["bvh"],
        looks_so: is_bvh,
    },
    FormatDescriptor {
        format: Format::Asf,
        name: "asf",
        title: "ASF (skeleton only)",
        noun: "an ASF skeleton",
        endings: &["asf"],
        looks_so: is_asf,
    },
    FormatDescriptor {
        format: Format::Amc,
        name: "amc",
        title: "AMC",
        noun: "an AMC motion",
        endings: &["amc"],
        looks_so: is_amc,
    },
    FormatDescriptor {
        format: Format::Fbx,
        name: "fbx",
        title: "FBX",
        noun: "an FBX scene",
        endings: &["fbx"],
        looks_so: |h| {
            h.starts("Kaydara FBX Binary") || h.starts("; FBX") || h.starts("FBXHeaderExtension")
        },
    },
    FormatDescriptor {
        format: Format::Gltf,
        name: "gltf",
        title: "glTF",
        noun: "a glTF scene",
        endings: &["gltf", "glb", "vrm", "vrma"],
        looks_so: |h| h.bytes.starts_with(b"glTF") || is_gltf(h),
    },
    FormatDescriptor {
        format: Format::Mvnx,
        name: "mvnx",
        title: "MVNX",
        noun: "an MVNX recording",
        endings: &["mvnx"],
        looks_so: |h| h.starts("<") && h.contains(b"<mvnx"),
    },
    FormatDescriptor {
        format: Format::Smpl,
        name: "smpl",
        title: "SMPL poses (npz)",
        noun: "an archive of SMPL poses",
        endings: &["npz"],
        looks_so: is_numpy_archive,
    },
    FormatDescriptor {
        format: Format::Mocopi,
        name: "mocopi",
        title: "mocopi packets",
        noun: "recorded mocopi packets",
        endings: &["mocopi"],
        looks_so: |h| mocopi::looks_so(h.bytes),
    },
    FormatDescriptor {
        format: Format::Trc,
        name: "trc",
        title: "TRC",
        noun: "a TRC recording",
        endings: &["trc"],
        looks_so: is_trc,
    },
    FormatDescriptor {
        format: Format::C3d,
        name: "c3d",
        title: "C3D",
        noun: "a C3D recording",
        endings: &["c3d"],
        looks_so: |h| {
            h.bytes.len() >= 512 && matches!(h.bytes, [1..128, 0x50, ..]) && h.is_binary()
        },
    },
    FormatDescriptor {
        format: Format::Jsonl,
        name: "jsonl",
        title: "JSON lines",
        noun: "lines of JSON",
        endings: &["jsonl", "ndjson"],
        looks_so: is_jsonl,
    },
    FormatDescriptor {
        format: Format::NtuSkeleton,
        name: "ntu_skeleton",
        title: "Kinect joints (NTU)",
        noun: "a recording of a Kinect",
        endings: &["skeleton"],
        looks_so: |h| !h.is_binary() && super::ntu::looks_so(h.bytes),
    },
    FormatDescriptor {
        format: Format::DeepMimic,
        name: "deepmimic",
        title: "DeepMimic motion",
        noun: "a motion of DeepMimic",
        // Its files end in .txt or .json: content alone decides.
        endings: &["deepmimic"],
        looks_so: |h| super::deepmimic::looks_so(h.bytes),
    },
    FormatDescriptor {
        format: Format::Landmarks,
        name: "landmarks",
        title: "landmarks (JSON)",
        noun: "JSON of landmarks",
        // Most files that end in .json are no motion: content alone decides.
        endings: &["landmarks"],
        looks_so: |h| !h.is_binary() && super::landmarks::looks_so(h.bytes),
    },
    FormatDescriptor {
        format: Format::Numpy,
        name: "numpy",
        title: "positions (NumPy)",
        noun: "a NumPy array",
        endings: &["npy"],
        looks_so: |h| h.bytes.starts_with(b"\x93NUMPY"),
    },
    FormatDescriptor {
        format: Format::Smd,
        name: "smd",
        title: "SMD",
        noun: "an SMD animation",
        endings: &["smd"],
        looks_so: |h| {
            !h.is_binary()
                && h.lines().take(20).any(|l| l.starts_with(b"version 1"))
                && h.contains(b"\nnodes")
                && h.contains(b"\nskeleton")
                && !h.contains(b"vertexanimation")
        },
    },
    FormatDescriptor {
        format: Format::Htr,
        name: "htr",
        title: "HTR",
        noun: "an HTR motion",
        endings: &["htr", "htr2"],
        looks_so: |h| {
            let says = |word: &str| h.lines().take(200).any(|l| holds(l, word));
            !h.is_binary() && says("[segmentnames&hierarchy]") && !says("filetype gtr")
        },
    },
    FormatDescriptor {
        format: Format::Csm,
        name: "csm",
        title: "CSM",
        noun: "a CSM recording",
        endings: &["csm"],
        looks_so: |h| {
            let says = |word: &str| h.lines().take(200).any(|l| holds(l, word));
            !h.is_binary() && says("$order") && says("$points")
        },
    },
    FormatDescriptor {
        format: Format::OpenSimMotion,
        name: "opensim_motion",
        title: "OpenSim motion",
        noun: "an OpenSim motion",
        endings: &["mot", "sto"],
        looks_so: |h| !h.is_binary() && is_opensim(h) && !unread::has_markers(h),
    },
    FormatDescriptor {
        format: Format::OpenSimModel,
        name: "opensim_model",
        title: "OpenSim model",
        noun: "an OpenSim model",
        endings: &["osim"],
        looks_so: |h| h.starts("<") && h.contains(b"<OpenSimDocument"),
    },
    FormatDescriptor {
        format: Format::Table,
        name: "table",
        title: "table of positions",
        noun: "a table",
        endings: &["csv", "tsv", "tab"],
        looks_so: |h| {
            !h.is_binary() && (!is_opensim(h) || unread::has_markers(h)) && table::looks_so(h.bytes)
        },
    },
];

/// Tells the format of `bytes`; `name` (a file's name or path) decides if they do not say.
///
/// # Errors
/// Content that nothing reads, with the format it looks like if it is known.
pub fn probe(bytes: &[u8], name: &str) -> Result<Format, ParseError> {
    let head = Head::new(bytes);
    if let Some(found) = READ.iter().find(|readable| (readable.looks_so)(&head)) {
        return Ok(found.format);
    }
    if let Some(unread) = UNREAD.iter().find(|unread| (unread.looks_so)(&head)) {
        let Unread { name, help, .. } = unread;
        return Err(ParseError::new(
            Place::File,
            "a motion format that is read",
            format!("what looks like {name}, which is not read: {help}"),
        ));
    }
    let called = |what: &str, help: &str| {
        let found = format!("what by its name is {what}, which is not read: {help}");
        ParseError::new(Place::File, "a motion format that is read", found)
    };
    // What is wrong with a broken C3D file is reported by its reader.
    let by_name = |format: &Format| !head.is_binary() || *format == Format::C3d;
    if let Some(format) = format_of_name(name).filter(by_name) {
        return Ok(format);
    }
    let (_, ending) = name.rsplit_once('.').unwrap_or_default();
    let known = UNREAD_ENDINGS
        .iter()
        .find(|(known, ..)| known.eq_ignore_ascii_case(ending) && !bytes.is_empty());
    if let Some((_, what, help)) = known {
        return Err(called(what, help));
    }
    let found = match bytes {
        [] => "an empty file",
        _ if head.is_binary() => "unknown binary content",
        _ if head.is_markup() => "XML of an unknown kind",
        _ if head.starts("{") || head.starts("[") => "JSON without points, poses or joints",
        _ => table::what_it_measures(head.bytes).unwrap_or("unknown text"),
    };
    let expected = match format_of_name(name) {
        // What it is called and is not.
        Some(format) => format!("{}, as its name says", format.name()),
        None => EXPECTED.to_owned(),
    };
    Err(ParseError::new(Place::File, expected, found))
}

const EXPECTED: &str = "BVH, AMC, FBX, glTF, VRM, MVNX, AMASS, OpenSim MOT, C3D, TRC, MCLIP, JSON lines or a table of positions";

/// The format that a file's ending promises.
pub fn format_of_name(name: &str) -> Option<Format> {
    let (_, extension) = name.rsplit_once('.')?;
    let ends = |ending: &&str| ending.eq_ignore_ascii_case(extension);
    (READ.iter().find(|read| read.endings.iter().any(ends))).map(|read| read.format)
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

/// True if a line holds a word in lower case, however it is written there.
fn holds(line: &[u8], word: &str) -> bool {
    let window = |at: &[u8]| at.eq_ignore_ascii_case(word.as_bytes());
    line.windows(word.len()).any(window)
}

/// An object with poses on the first line.
fn is_jsonl(head: &Head) -> bool {
    let mut lines = head.lines();
    let first = lines.next().unwrap_or_default();
    let holds = |word: &[u8]| first.windows(word.len()).any(|window| window == word);
    // By role or name: lists of numbers are landmarks.
    let named = |field: &[u8]| {
        let at = first
            .windows(field.len())
            .position(|window| window == field);
        let rest = at.map(|at| first[at + field.len()..].trim_ascii_start());
        let rest = rest.and_then(|rest| rest.strip_prefix(b":"));
        rest.is_some_and(|rest| rest.trim_ascii_start().starts_with(b"{"))
    };
    // Lists of points that have a time or a hand are lines; any other list is a document of landmarks.
    let is_numbered =
        named(b"\"points\"") || holds(b"\"points\"") && (holds(b"\"t\"") || holds(b"\"hand\""));
    first.starts_with(b"{")
        && (named(b"\"positions\"") || named(b"\"rotations\"") || is_numbered)
        && !holds(b"\"asset\"")
}

/// An object with glTF's words.
fn is_gltf(head: &Head) -> bool {
    let lists = || head.contains(b"\"nodes\"") && head.contains(b"\"scenes\"");
    head.starts("{") && (head.contains(b"\"asset\"") || lists())
}

/// A zip archive whose first file is an array.
fn is_numpy_archive(head: &Head) -> bool {
    let name = || {
        let length = u16::from_le_bytes([*head.bytes.get(26)?, *head.bytes.get(27)?]);
        head.bytes.get(30..30 + usize::from(length))
    };
    head.bytes.starts_with(b"PK\x03\x04") && name().is_some_and(|name| name.ends_with(b".npy"))
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
            called.expected.contains("gltf, as its name says"),
            "{called}"
        );
        assert!(probe(b"\x01\x02\0\0", "a.bvh").is_err());
    }
}
