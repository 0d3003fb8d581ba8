//! Formats that are recognised by content or ending only to be refused, with how to convert them.

use super::head::Head;

pub(super) struct Unread {
    pub(super) name: &'static str,
    /// Way to a format that is read; a sentence without its first letter's case.
    pub(super) help: &'static str,
    pub(super) looks_so: fn(&Head) -> bool,
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
pub(super) static UNREAD: &[Unread] = &[
    unread(
        "a pointer of Git LFS in place of the file",
        "fetch it with `git lfs pull`",
        |h| h.starts("version https://git-lfs.github.com/"),
    ),
    unread(
        "a page of HTML in place of the file",
        "the download went wrong: open its address in a browser",
        |h| h.starts_any(&["<!doctype html", "<html"]),
    ),
    unread(
        "an Excel workbook (XLSX)",
        "save the sheet of positions as CSV",
        |h| {
            h.bytes.starts_with(b"PK\x03\x04")
                && (h.contains(b"xl/workbook") || h.contains(b"xl/worksheets"))
        },
    ),
    unread("a PyTorch archive", NUMPY, |h| {
        h.bytes.starts_with(b"PK\x03\x04") && h.contains(b"/data.pkl")
    }),
    unread("USD (USDZ)", BLENDER, |h| {
        h.bytes.starts_with(b"PK\x03\x04")
            && (h.contains(b".usdc") || h.contains(b".usda"))
            && !h.contains(b".bvh")
    }),
    unread("a zip archive", UNPACK, |h| {
        h.bytes.starts_with(b"PK\x03\x04") || h.bytes.starts_with(b"PK\x05\x06")
    }),
    unread("a gzip file", UNPACK, |h| {
        h.bytes.starts_with(b"\x1f\x8b\x08")
    }),
    unread("USD", BLENDER, |h| {
        h.starts("PXR-USDC") || h.starts("#usda")
    }),
    unread("a Blender file", BLENDER, |h| h.starts("BLENDER")),
    unread("Alembic", BLENDER, |h| h.starts("Ogawa")),
    unread("COLLADA", BLENDER, |h| {
        h.starts("<") && h.contains(b"<COLLADA")
    }),
    unread("a model of Panda3D (EGG)", BLENDER, |h| {
        h.starts("<CoordinateSystem>")
            || h.starts("<Comment>") && h.contains(b"{") && h.contains(b"<")
    }),
    unread("a model of Panda3D (BAM)", BLENDER, |h| {
        h.bytes.starts_with(b"pbj\0")
    }),
    unread("VRML", BLENDER, |h| h.bytes.starts_with(b"#VRML")),
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
    unread(
        "an Excel workbook (XLS)",
        "save the sheet of positions as CSV",
        |h| {
            let name: Vec<u8> = "Workbook".bytes().flat_map(|b| [b, 0]).collect();
            h.bytes.starts_with(b"\xD0\xCF\x11\xE0") && h.contains(&name)
        },
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
    unread(
        "a Source engine's flexes (VTA)",
        "it holds shapes of a face, no motion of joints",
        |h| h.starts("version 1") && h.contains(b"vertexanimation"),
    ),
    unread(
        "one frame of OpenPose's keypoints (JSON)",
        "each file holds a frame: give the folder that holds all of them",
        |h| {
            h.starts("{")
                && h.contains(b"\"pose_keypoints_3d\"")
                && !is_empty_list(h, b"\"pose_keypoints_3d\"")
        },
    ),
    unread(
        "COCO annotations or AlphaPose's results (JSON) in two dimensions",
        FLAT,
        |h| {
            (h.starts("{") || h.starts("["))
                && h.contains(b"\"keypoints\"")
                && (h.contains(b"\"image_id\"") || h.contains(b"\"num_keypoints\""))
        },
    ),
    unread("OpenPose keypoints (JSON) in two dimensions", FLAT, |h| {
        h.starts("{") && h.contains(b"\"pose_keypoints_2d\"")
    }),
    unread("HDF5", NUMPY, |h| h.bytes.starts_with(b"\x89HDF")),
    unread("MATLAB's MAT", NUMPY, |h| h.starts("MATLAB ")),
    unread("Parquet", NUMPY, |h| h.bytes.starts_with(b"PAR1")),
    unread("Arrow or Feather", NUMPY, |h| {
        h.bytes.starts_with(b"ARROW1") || h.bytes.starts_with(b"FEA1")
    }),
    unread("a pickle of Python", PICKLE, |h| {
        matches!(h.bytes, [0x80, 2..=5, ..])
    }),
    unread("a pickle of Python", PICKLE, |h| {
        [
            &b"(dp"[..],
            b"(lp",
            b"ccopy_reg",
            b"cnumpy",
            b"c__builtin__",
            b"\x80\x02}q",
        ]
        .iter()
        .any(|begin| h.bytes.starts_with(begin))
    }),
    unread("GTR of Motion Analysis", "export HTR, TRC or C3D", |h| {
        h.contains(b"FileType gtr") || h.contains(b"FileType GTR")
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
    unread(
        "poses of SMPL as JSON",
        "save them as AMASS does, in an .npz",
        |h| {
            (h.starts("{") || h.starts("["))
                && h.contains(b"\"poses\"")
                && (h.contains(b"\"shapes\"") || h.contains(b"\"betas\""))
        },
    ),
    unread(
        "poses of sign.mt (.pose)",
        "save their points as a NumPy array, or as a table",
        |h| h.contains(b"POSE_LANDMARKS") && h.is_binary(),
    ),
    unread(
        "a scene of DAZ Studio (DUF)",
        "export BVH or FBX from DAZ Studio",
        |h| h.starts("{") && h.contains(b"\"asset_info\"") && h.contains(b"\"file_version\""),
    ),
    unread("a pose of Poser (PZ2)", "export BVH from Poser", |h| {
        h.starts("{") && h.contains(b"actor ") && h.contains(b"version")
    }),
    unread(
        "a motion of the Master Motor Map (MMM)",
        "its database (KIT) has the same motions as C3D",
        |h| h.is_markup() && h.contains(b"<MMM"),
    ),
    unread("a cache of a mesh's points (PC2)", SCENE, |h| {
        h.starts("POINTCACHE2")
    }),
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
    unread("a sound (WAV)", "it holds no motion", |h| {
        h.starts("RIFF") && h.bytes.get(8..12) == Some(b"WAVE")
    }),
    unread("an AVI video", VIDEO, |h| h.starts("RIFF")),
    unread("a Matroska video", VIDEO, |h| {
        h.bytes.starts_with(b"\x1A\x45\xDF\xA3")
    }),
    unread("a picture", VIDEO, |h| {
        h.bytes.starts_with(b"\x89PNG") || h.bytes.starts_with(b"\xFF\xD8\xFF") || h.starts("GIF8")
    }),
    unread("a PDF document", "it holds no motion", |h| {
        h.starts("%PDF-")
    }),
    unread(
        "a MikuMikuDance pose (VPD)",
        "load it on its model in Blender (mmd_tools) and export BVH or FBX",
        |h| h.starts("Vocaloid Pose Data"),
    ),
    unread(
        "a Maya animation (.anim)",
        "import it on its skeleton in Maya and export FBX",
        |h| h.starts("animVersion"),
    ),
    unread(
        "an asset of Unreal (.uasset)",
        "export FBX from the editor",
        |h| h.bytes.starts_with(b"\xC1\x83\x2A\x9E"),
    ),
    unread("an animation of Unreal (PSA)", BLENDER, |h| {
        h.starts("ANIMHEAD")
    }),
    unread("an MD5 animation", BLENDER, |h| h.starts("MD5Version")),
    unread("an Inter-Quake model", BLENDER, |h| {
        h.starts("INTERQUAKEMODEL")
    }),
    unread("SEAnim", BLENDER, |h| h.starts("SEAnim")),
    unread("a MilkShape model", BLENDER, |h| h.starts("MS3D000000")),
    unread("a Blitz3D model", BLENDER, |h| h.starts("BB3D")),
    unread(
        "a Half-Life or Source model (MDL)",
        "decompile it (Crowbar) and give the SMD",
        |h| h.starts("IDST") || h.starts("IDSQ"),
    ),
    unread("an Ogre skeleton", BLENDER, |h| {
        h.contains(b"[Serializer_v")
            || h.starts("<skeleton")
            || h.contains(b"<animations>") && h.contains(b"<bones")
    }),
    unread("a Cal3D animation", BLENDER, |h| {
        h.starts("CAF\0") || h.starts("<ANIMATION") || h.starts("<HEADER MAGIC=\"XAF\"")
    }),
    unread("LightWave", SCENE, |h| {
        h.starts("LWSC")
            || h.starts("LWMO")
            || h.starts("FORM") && (h.contains(b"LWO2") || h.contains(b"LWOB"))
    }),
    unread("Softimage XSI", SCENE, |h| h.starts("xsi 0")),
    unread("Cinema 4D", SCENE, |h| h.bytes.starts_with(b"QC4DC4D6")),
    unread("Wavefront OBJ", "it is a mesh without motion", |h| {
        let mut lines = h.lines().take(200);
        lines.any(|l| l.starts_with(b"v ")) && h.lines().take(20_000).any(|l| l.starts_with(b"f "))
    }),
    unread("a Roblox model", SCENE, |h| h.starts("<roblox")),
    unread("a recording of ROS (bag, MCAP)", TABLE, |h| {
        h.starts("#ROSBAG") || h.bytes.starts_with(b"\x89MCAP")
    }),
    unread("a recording of Lab Streaming Layer (XDF)", TABLE, |h| {
        h.starts("XDF:")
    }),
    unread("a Kinect Studio recording (XEF)", TABLE, |h| {
        h.starts("EVENTS1")
    }),
    unread("an OpenNI recording (ONI)", TABLE, |h| h.starts("NI10")),
    unread(
        "an index of morec",
        "`morec recognize` and `morec live` take it as their first argument",
        |h| h.bytes.get(8..).is_some_and(|b| b.starts_with(b"{")) && h.contains(b"morec-index"),
    ),
    unread(
        "an SQLite database",
        "a database of morec is opened with `morec db`",
        |h| h.bytes.starts_with(b"SQLite format 3\0"),
    ),
    unread(
        "ELAN's annotations",
        "they are labels: give them where labels are asked for",
        |h| h.is_markup() && h.contains(b"<ANNOTATION_DOCUMENT"),
    ),
    unread("an animation of three.js (JSON)", "export GLB", |h| {
        h.starts("{") && h.contains(b"\"tracks\"") && h.contains(b"\"times\"")
    }),
    unread("a drawing (SVG)", "it holds no motion", |h| {
        h.is_markup() && h.contains(b"<svg")
    }),
    unread("a program", "it holds no motion", |h| {
        h.bytes.starts_with(b"MZ") && h.is_binary() || h.bytes.starts_with(b"\x7FELF")
    }),
];

/// Endings of files whose content does not tell what they are, to be refused by name.
pub(super) static UNREAD_ENDINGS: &[(&str, &str, &str)] = &[
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
    ("gtr", "GTR of Motion Analysis", "export HTR, TRC or C3D"),
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
    ("pkl", "a pickle of Python", PICKLE),
    ("pickle", "a pickle of Python", PICKLE),
    ("pt", "a PyTorch archive", NUMPY),
    ("pth", "a PyTorch archive", NUMPY),
    ("mat", "MATLAB's MAT", NUMPY),
    (
        "calc",
        "calculated data of Axis Neuron",
        "export BVH or FBX from it",
    ),
    ("p3d", "a Theia or Pose3D file", "export C3D from it"),
    (
        "xcp",
        "a Vicon calibration of cameras",
        "it holds no motion",
    ),
    (
        "mp",
        "Vicon's parameters of a model",
        "they hold no motion; export C3D",
    ),
    (
        "enf",
        "Vicon's notes of a trial",
        "they hold no motion; export C3D",
    ),
    (
        "x2p",
        "a Vicon recording of cameras",
        "process it and export C3D",
    ),
    (
        "vsf",
        "a Vicon skeleton",
        "it holds no motion; export FBX or C3D of a trial",
    ),
    (
        "mvns",
        "an Xsens MVN session",
        "export MVNX, BVH or FBX from MVN",
    ),
    ("casc", "a scene of Cascadeur", "export FBX from Cascadeur"),
    (
        "rlmotion",
        "a motion of iClone",
        "export FBX or BVH from iClone or 3DXchange",
    ),
    (
        "imotion",
        "a motion of iClone",
        "export FBX or BVH from iClone or 3DXchange",
    ),
    (
        "imotionplus",
        "a motion of iClone",
        "export FBX or BVH from iClone or 3DXchange",
    ),
    ("mdd", "a cache of a mesh's points (MDD)", SCENE),
    ("qca", "a Qualisys calibration", "it holds no motion"),
    ("motion", "a motion of an application", SCENE),
    ("nmd", "a MikuMikuMoving motion", SCENE),
    ("usd", "USD", BLENDER),
    ("abc", "Alembic", BLENDER),
    (
        "anim",
        "an animation of Unity or Maya",
        "export FBX from it",
    ),
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

const PICKLE: &str = "it can run programs when it is opened; save poses as AMASS does, in an .npz";
const FLAT: &str = "a direction in space needs three: triangulate several views (Pose2Sim, FreeMoCap) and give TRC, C3D or a table";
const TABLE: &str = "export the positions of joints as a table";

/// A header that ends in `endheader`, or has its keys.
pub(super) fn is_opensim(head: &Head) -> bool {
    let bare = |line: &[u8]| {
        let end = line
            .iter()
            .rposition(|b| !matches!(b, b',' | b';' | b'\t' | b' '));
        line[..end.map_or(0, |end| end + 1)].to_ascii_lowercase()
    };
    let mut keys = 0;
    for line in head.lines().take(200) {
        let line = bare(line);
        keys += usize::from(
            line.starts_with(b"nrows")
                || line.starts_with(b"ncolumns")
                || line.starts_with(b"datacolumns"),
        );
        if line == b"endheader" || keys == 2 {
            return !head.is_binary();
        }
    }
    false
}

/// True if such a table holds places of several markers, `R.ASIS_tx`, and no orientations: those of bodies are of their centres of
/// mass, which are no joints.
pub(super) fn has_markers(head: &Head) -> bool {
    const LEAST: usize = 5;
    let mut lines = head
        .lines()
        .skip_while(|line| !line.eq_ignore_ascii_case(b"endheader"));
    let names = lines.nth(1).unwrap_or_default().to_ascii_lowercase();
    let ends = |end: &[u8]| {
        let columns = names.split(|b| matches!(b, b'\t' | b',' | b' '));
        columns.filter(|name| name.ends_with(end)).count()
    };
    ends(b"_tx").max(ends(b"_x")) >= LEAST && ends(b"_ox") == 0
}

/// True if an empty list follows `field` wherever it stands.
fn is_empty_list(head: &Head, field: &[u8]) -> bool {
    let mut places = head.bytes.windows(field.len()).enumerate();
    places.all(|(at, window)| {
        let rest = head.bytes[at + field.len()..].trim_ascii_start();
        let list = rest.strip_prefix(b":").map(<[u8]>::trim_ascii_start);
        let list = list
            .and_then(|list| list.strip_prefix(b"["))
            .map(<[u8]>::trim_ascii_start);
        window != field || list.is_some_and(|list| list.starts_with(b"]"))
    })
}
