use super::*;
use crate::formats::mangle;
use std::io;
use std::io::Write;

const BVH: &str = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.02\n1 2 3\n4 5 6\n";
const ASF: &[u8] = include_bytes!("../../../testdata/acclaim/arm.asf");
const AMC: &[u8] = include_bytes!("../../../testdata/acclaim/wave.amc");

fn gz(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

fn zip_of(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
    for (name, bytes) in files {
        let options = zip::write::SimpleFileOptions::default();
        out.start_file(*name, options).unwrap();
        out.write_all(bytes).unwrap();
    }
    out.finish().unwrap().into_inner()
}

fn open(path: &str, bytes: &[u8]) -> Result<ClipFile, FileError> {
    FileReader::default().parse(Path::new(path), bytes)
}

#[test]
fn packed_and_recoded_files_are_the_files() {
    let plain = open("walk.bvh", BVH.as_bytes()).unwrap();
    let wide: Vec<u8> = format!("\u{feff}{BVH}")
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for (path, bytes) in [
        ("walk.bvh.gz", gz(BVH.as_bytes())),
        ("walk.bvh", wide.clone()),
        ("a.zip", zip_of(&[("takes/walk.bvh", BVH.as_bytes())])),
        (
            "a.zip",
            zip_of(&[("readme.md", b"x"), ("walk.bvh.gz", &gz(&wide))]),
        ),
    ] {
        let opened = open(path, &bytes).unwrap();
        assert_eq!(
            (opened.format, &opened.clips),
            (Format::Bvh, &plain.clips),
            "{path}"
        );
    }
}

#[test]
fn an_archive_holds_several_clips_and_says_what_is_left_out() {
    let files: [(&str, &[u8]); 5] = [
        ("a.bvh", BVH.as_bytes()),
        ("13.asf", ASF),
        ("13_29.amc", AMC),
        ("broken.bvh", b"nothing"),
        ("__MACOSX/._a.bvh", b"x"),
    ];
    let opened = open("all.zip", &zip_of(&files)).unwrap();
    let names: Vec<&str> = opened.clips.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["all#a", "all#13_29"]);
    let left: Vec<_> = opened
        .warnings
        .iter()
        .filter(|w| w.text.contains("left out"))
        .collect();
    assert_eq!(left.len(), 1);
    assert!(left[0].text.contains("broken.bvh"));
    let error = open("none.zip", &zip_of(&[("a.png", b"x")]))
        .unwrap_err()
        .to_string();
    assert!(error.contains("a.png"), "{error}");
}

#[test]
fn a_clip_is_chosen_by_number_or_name() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("all.zip");
    let bytes = zip_of(&[("a.bvh", BVH.as_bytes()), ("b.bvh", BVH.as_bytes())]);
    std::fs::write(&path, &bytes).unwrap();
    let open = |choice: &str| {
        let path = format!("{}#{choice}", path.display());
        FileReader::default().parse(Path::new(&path), &bytes)
    };
    for choice in ["2", "b", "all#b"] {
        let opened = open(choice).unwrap();
        assert_eq!(opened.clips.len(), 1);
        assert_eq!(opened.clips[0].name, "all#b");
    }
    let error = open("c").unwrap_err().to_string();
    assert!(error.contains("2 clips: all#a, all#b"), "{error}");
    let odd = folder.path().join("odd#2");
    std::fs::write(&odd, b"x").unwrap();
    assert_eq!(split_choice(&odd), (odd, None));
}

/// Motions with their skeletons, buffers and frames, cut and altered: whatever is wrong with one is said.
#[test]
fn altered_neighbours_never_panic() {
    let frame: &[u8] = br#"{"version": 1.3, "people": []}"#;
    let scene: &[u8] = br#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "keys.bin"}, {"uri": "./keys.bin"}],
        "bufferViews": [{"buffer": 1}], "nodes": [{"children": [1]}, {}], "skins": [{"joints": [0, 1]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
            "samplers": [{"input": 0, "output": 0}]}]}"#;
    let of = |changed: &str, bytes: &[u8]| {
        let files: [(&str, &[u8]); 8] = [
            ("13.asf", ASF),
            ("13_29.amc", AMC),
            ("a.gltf", scene),
            ("keys.bin", &[0; 8]),
            ("f_1.json", frame),
            ("f_2.json", frame),
            ("f_3.json", frame),
            ("a.bvh", BVH.as_bytes()),
        ];
        zip_of(&files.map(|(name, own)| (name, if name == changed { bytes } else { own })))
    };
    for (name, own) in [
        ("13.asf", ASF),
        ("13_29.amc", AMC),
        ("a.gltf", scene),
        ("f_2.json", frame),
    ] {
        mangle::each(own, 60, |bytes| {
            let read = open("all.zip", &of(name, bytes)).unwrap();
            assert!(read.clips.iter().any(|clip| clip.name.ends_with('a')));
        });
    }
}
