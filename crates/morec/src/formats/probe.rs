//! Telling formats apart: by content first, by name where the content says nothing.
//!
//! A new format is registered in `READ`; one that is only recognised, to be refused by its name, in `UNREAD`.

use super::{ParseError, Place, mocopi, table};
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
}

impl Format {
    /// Its name in tables and databases; never changes.
    pub fn name(self) -> &'static str {
        match self {
            Format::Bvh => "bvh",
            Format::Asf => "asf",
            Format::Amc => "amc",
            Format::Mclip => "mclip",
            Format::C3d => "c3d",
            Format::Trc => "trc",
            Format::Jsonl => "jsonl",
            Format::Table => "table",
            Format::Mvnx => "mvnx",
            Format::Gltf => "gltf",
            Format::Fbx => "fbx",
            Format::Smpl => "smpl",
            Format::Mocopi => "mocopi",
            Format::NtuSkeleton => "ntu_skeleton",
            Format::Landmarks => "landmarks",
        }
    }
}

struct Readable {
    format: Format,
    extension: &'static str,
    looks_so: fn(&Head) -> bool,
}

/// Every format that is read, in the order in which its content is asked for.
const READ: [Readable; 21] = [
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
        format: Format::Fbx,
        extension: "fbx",
        looks_so: |h| {
            h.starts("Kaydara FBX Binary") || h.starts("; FBX") || h.starts("FBXHeaderExtension")
        },
    },
    Readable {
        format: Format::Gltf,
        extension: "gltf",
        looks_so: is_gltf,
    },
    Readable {
        format: Format::Gltf,
        extension: "glb",
        looks_so: |h| h.bytes.starts_with(b"glTF"),
    },
    Readable {
        format: Format::Gltf,
        extension: "vrm",
        looks_so: |_| false,
    },
    Readable {
        format: Format::Gltf,
        extension: "vrma",
        looks_so: |_| false,
    },
    Readable {
        format: Format::Mvnx,
        extension: "mvnx",
        looks_so: |h| h.starts("<") && h.contains(b"<mvnx"),
    },
    Readable {
        format: Format::Smpl,
        extension: "npz",
        looks_so: is_numpy_archive,
    },
    Readable {
        format: Format::Mocopi,
        extension: "mocopi",
        looks_so: |h| mocopi::looks_so(h.bytes),
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
        format: Format::NtuSkeleton,
        extension: "skeleton",
        looks_so: |h| !h.is_binary() && super::ntu::looks_so(h.bytes),
    },
    Readable {
        format: Format::Landmarks,
        // Most files that end in .json are no motion: content alone decides.
        extension: "landmarks",
        looks_so: |h| !h.is_binary() && super::landmarks::looks_so(h.bytes),
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
    /// How to get what can be read; a sentence without its first letter's case.
    help: &'static str,
    looks_so: fn(&Head) -> bool,
}

const fn unread(name: &'static str, help: &'static str, looks_so: fn(&Head) -> bool) -> Unread {
    Unread {
        name,
        help,
        looks_so,
    }
}

const BLENDER: &str = "open it in Blender and export BVH, FBX or glTF";
const UNPACK: &str = "unpack it";
const SCENE: &str = "export FBX, BVH or glTF from the program that made it";
const NUMPY: &str = "save poses as AMASS does, in an .npz, or positions as a table";
const VIDEO: &str = "it holds pictures; a tracker of poses makes positions of them";

/// Formats that are recognised only to say that they are not read.
const UNREAD: [Unread; 39] = [
    unread("a zip archive", UNPACK, |h| {
        h.bytes.starts_with(b"PK\x03\x04") || h.bytes.starts_with(b"PK\x05\x06")
    }),
    unread("a gzip file", UNPACK, |h| {
        h.bytes.starts_with(b"\x1f\x8b\x08")
    }),
    unread("a NumPy array", NUMPY, |h| {
        h.bytes.starts_with(b"\x93NUMPY")
    }),
    unread("an OpenSim motion (MOT, STO)", OPENSIM, is_opensim_table),
    unread("an OpenSim model", OPENSIM, |h| {
        h.starts("<") && h.contains(b"<OpenSimDocument")
    }),
    unread("USD", BLENDER, |h| {
        h.starts("PXR-USDC") || h.starts("#usda")
    }),
    unread("a Blender file", BLENDER, |h| h.starts("BLENDER")),
    unread("Alembic", BLENDER, |h| h.starts("Ogawa")),
    unread("COLLADA", BLENDER, |h| {
        h.starts("<") && h.contains(b"<COLLADA")
    }),
    unread("X3D", BLENDER, |h| h.starts("<") && h.contains(b"<X3D")),
    unread("Maya ASCII", SCENE, |h| h.starts("//Maya ASCII")),
    unread("Maya binary", SCENE, |h| {
        (h.starts("FOR4") || h.starts("FOR8")) && h.contains(b"Maya")
    }),
    unread(
        "a 3ds Max biped motion (BIP)",
        "load it on a Biped in 3ds Max and save BVH or FBX",
        |h| h.starts("BIPF"),
    ),
    unread("a 3ds Max or other OLE file", SCENE, |h| {
        h.bytes.starts_with(b"\xD0\xCF\x11\xE0")
    }),
    unread(
        "a MikuMikuDance motion (VMD)",
        "load it on its model in Blender (mmd_tools) and export BVH or FBX",
        |h| h.starts("Vocaloid Motion Data"),
    ),
    unread(
        "a MikuMikuDance model (PMX, PMD)",
        "it holds no motion",
        |h| h.starts("PMX ") || h.bytes.starts_with(b"Pmd"),
    ),
    unread(
        "a Unity asset",
        "play it in Unity and record it with its FBX exporter, or as VRMA",
        |h| h.starts("%YAML") && h.contains(b"unity3d.com"),
    ),
    unread("DirectX (.x)", BLENDER, |h| h.starts("xof ")),
    unread("a Source engine animation (SMD)", BLENDER, |h| {
        h.starts("version 1") && h.contains(b"nodes") && h.contains(b"skeleton")
    }),
    unread(
        "OpenPose keypoints (JSON) in two dimensions",
        "a direction in space needs three: triangulate several views (Pose2Sim, FreeMoCap) and give TRC, C3D or a table",
        |h| h.starts("{") && h.contains(b"\"pose_keypoints_2d\""),
    ),
    unread("HDF5", NUMPY, |h| h.bytes.starts_with(b"\x89HDF")),
    unread("MATLAB's MAT", NUMPY, |h| h.starts("MATLAB 5.0")),
    unread(
        "a pickle of Python",
        "it can run programs when it is opened; save poses as AMASS does, in an .npz",
        |h| matches!(h.bytes, [0x80, 2..=5, ..]),
    ),
    unread("a PyTorch or old Python archive", NUMPY, |h| {
        h.bytes.starts_with(b"(dp") || h.bytes.starts_with(b"(lp")
    }),
    unread("HTR of Motion Analysis", SCENE, |h| {
        h.contains(b"FileType htr")
            || h.contains(b"FileType gtr")
            || h.contains(b"[SegmentNames&Hierarchy]")
    }),
    unread("a Vicon or Nexus XML file", "export C3D", |h| {
        h.starts("<") && (h.contains(b"<KinematicModel") || h.contains(b"<ViconModel"))
    }),
    unread("Theia or QTM XML", "export C3D, FBX or TRC", |h| {
        h.starts("<") && h.contains(b"<QTM")
    }),
    unread(
        "a recording of Rokoko (JSON)",
        "export BVH or FBX from Rokoko Studio",
        |h| h.starts("{") && h.contains(b"\"actors\"") && h.contains(b"\"scene\""),
    ),
    unread("Biovision's BVA", "save BVH", |h| {
        h.starts("Segment:") && h.contains(b"Frames:")
    }),
    unread("a tar archive", UNPACK, |h| {
        h.bytes.get(257..262) == Some(b"ustar")
    }),
    unread("a bzip2 file", UNPACK, |h| h.bytes.starts_with(b"BZh")),
    unread("an xz file", UNPACK, |h| h.bytes.starts_with(b"\xFD7zXZ")),
    unread("a 7z archive", UNPACK, |h| {
        h.bytes.starts_with(b"7z\xBC\xAF")
    }),
    unread("a rar archive", UNPACK, |h| h.bytes.starts_with(b"Rar!")),
    unread("a Zstandard file", UNPACK, |h| {
        h.bytes.starts_with(b"\x28\xB5\x2F\xFD")
    }),
    unread("an MP4 video", VIDEO, |h| {
        h.bytes.get(4..8) == Some(b"ftyp")
    }),
    unread("an AVI video", VIDEO, |h| h.starts("RIFF")),
    unread("a Matroska video", VIDEO, |h| {
        h.bytes.starts_with(b"\x1A\x45\xDF\xA3")
    }),
    unread("a picture", VIDEO, |h| {
        h.bytes.starts_with(b"\x89PNG") || h.bytes.starts_with(b"\xFF\xD8\xFF")
    }),
];

/// Endings of files whose content does not tell what they are, to be refused by name.
const UNREAD_ENDINGS: [(&str, &str, &str); 20] = [
    (
        "qtm",
        "a Qualisys QTM measurement",
        "export C3D, TSV or FBX from QTM",
    ),
    ("tdf", "a BTS TDF recording", "export C3D from BTS SMART"),
    (
        "v",
        "a Vicon V file",
        "export C3D or FBX from the program that made it",
    ),
    (
        "x1d",
        "a Vicon recording of cameras",
        "process it and export C3D",
    ),
    (
        "x2d",
        "a Vicon recording of cameras",
        "process it and export C3D",
    ),
    (
        "vsk",
        "a Vicon skeleton",
        "it holds no motion; export FBX or C3D of a trial",
    ),
    (
        "trb",
        "a Motion Analysis TRB recording",
        "export TRC or C3D from Cortex",
    ),
    (
        "cap",
        "a Motion Analysis capture",
        "export TRC or C3D from Cortex",
    ),
    ("gtr", "GTR of Motion Analysis", SCENE),
    ("htr", "HTR of Motion Analysis", SCENE),
    (
        "tak",
        "a Motive take",
        "export CSV, BVH, C3D or FBX from Motive",
    ),
    (
        "mvn",
        "an Xsens MVN recording",
        "export MVNX, BVH or FBX from MVN",
    ),
    (
        "raw",
        "a raw recording of Axis Neuron",
        "export BVH or FBX from it",
    ),
    ("x", "DirectX (.x)", BLENDER),
    ("smd", "a Source engine animation (SMD)", BLENDER),
    ("blend", "a Blender file", BLENDER),
    (
        "bip",
        "a 3ds Max biped motion (BIP)",
        "load it on a Biped in 3ds Max and save BVH or FBX",
    ),
    ("anm", "a game's animation", SCENE),
    ("max", "a 3ds Max file", SCENE),
    ("usdz", "USD", BLENDER),
];

const OPENSIM: &str = "joint angles mean something only with the model they were made for; run OpenSim's BodyKinematics \
    or PointKinematics with it and give the positions as a table or TRC";

/// Which format `bytes` have; `name` (a file's name or path) decides if they do not say.
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
    // A broken C3D file is told what is wrong with it by its reader.
    let by_name = |format: &Format| !head.is_binary() || *format == Format::C3d;
    if let Some(format) = format_of_name(name).filter(by_name) {
        return Ok(format);
    }
    let (_, ending) = name.rsplit_once('.').unwrap_or_default();
    let known = UNREAD_ENDINGS
        .iter()
        .find(|(known, ..)| known.eq_ignore_ascii_case(ending) && !bytes.is_empty());
    if let Some((_, what, help)) = known {
        return Err(ParseError::new(
            Place::File,
            "a motion format that is read",
            format!("what by its name is {what}, which is not read: {help}"),
        ));
    }
    let found = match bytes {
        [] => "an empty file",
        _ if head.is_binary() => "unknown binary content",
        _ => "unknown text",
    };
    let expected = match format_of_name(name) {
        // What it is called and is not.
        Some(format) => format!("{}, as its name says", format.name()),
        None => EXPECTED.to_owned(),
    };
    Err(ParseError::new(Place::File, expected, found))
}

const EXPECTED: &str =
    "BVH, AMC, FBX, glTF, VRM, MVNX, AMASS, C3D, TRC, MCLIP, JSON lines or a table of positions";

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

/// A header that ends in `endheader`.
fn is_opensim_table(head: &Head) -> bool {
    let mut lines = head.lines().take(200);
    !head.is_binary() && lines.any(|line| line.eq_ignore_ascii_case(b"endheader"))
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
        ] {
            assert_eq!(probe(bytes, name), Ok(format), "{name}");
        }
    }

    #[test]
    fn what_is_not_read_is_named() {
        for (bytes, found) in [
            (b"PK\x03\x04....".as_slice(), "zip"),
            (b"\x93NUMPY\x01\0", "NumPy array"),
            (
                b"Coordinates\nversion=1\nendheader\ntime\tpelvis_tilt\n",
                "OpenSim",
            ),
            (b"#usda 1.0\n", "USD"),
            (b"Vocaloid Motion Data 0002\0", "VMD"),
            (b"\x80\x04\x95", "pickle"),
            (b"", "an empty file"),
            (b"a,b,c\n1,2,3\n", "unknown text"),
            (b"\x7FELF\0\0", "unknown binary"),
        ] {
            let error = probe(bytes, "file.dat").unwrap_err();
            assert!(error.found.contains(found), "{error}");
        }
        let called = probe(b"\x7FELF\0\0", "a.glb").unwrap_err();
        assert!(
            called.expected.contains("gltf, as its name says"),
            "{called}"
        );
        assert!(probe(b"\x7FELF\0\0", "a.bvh").is_err());
    }
}
