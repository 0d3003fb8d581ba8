//! Archives take no more memory than their size allows. Peaks are of the whole process: these tests have one to themselves.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;
use std::io::{Cursor, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use mocap::files::{ClipFile, FileError, FileReader};
use zip::write::SimpleFileOptions;

/// What any small archive may take.
const SMALL: u64 = 200 << 20;

fn gz(bytes: &[u8]) -> Vec<u8> {
    let mut out = GzEncoder::new(Vec::new(), Compression::best());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

fn zip_of(files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        out.start_file(name, SimpleFileOptions::default()).unwrap();
        out.write_all(&bytes).unwrap();
    }
    out.finish().unwrap().into_inner()
}

/// A thousand joints, one channel, a thousand frames: a few kilobytes when packed, 32 MB as a clip.
fn many_joints() -> Vec<u8> {
    let mut text = String::from("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\n");
    for joint in 0..1000 {
        write!(
            text,
            "JOINT b{joint}\n{{\nOFFSET 0 1 0\nCHANNELS 0\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n"
        )
        .unwrap();
    }
    text += "}\nMOTION\nFrames: 1000\nFrame Time: 0.01\n";
    text += &"0\n".repeat(1000);
    text.into_bytes()
}

/// This many megabytes of blanks, never held as a whole.
fn blanks(megabytes: usize) -> Vec<u8> {
    let mut out = GzEncoder::new(Vec::new(), Compression::best());
    for _ in 0..megabytes {
        out.write_all(&[b' '; 1 << 20]).unwrap();
    }
    out.finish().unwrap()
}

/// An ordinary recording: text that packs to a quarter or so.
fn recording(seed: u32) -> Vec<u8> {
    let mut text = String::from(
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
         JOINT Spine\n{\nOFFSET 0 10 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\n}\n\
         MOTION\nFrames: 20000\nFrame Time: 0.01\n",
    );
    let mut state = seed;
    for _ in 0..20_000 {
        for _ in 0..9 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            write!(text, "{:.4} ", f64::from(state >> 16) * 0.001).unwrap();
        }
        text.push('\n');
    }
    text.into_bytes()
}

fn read(name: &str, bytes: &[u8]) -> Result<ClipFile, FileError> {
    FileReader::default().parse(Path::new(name), bytes)
}

/// The most memory that the process ever had, where the system tells (Linux).
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}

#[test]
fn small_archives_take_little_and_real_ones_are_read() {
    let clips = || (0..120).map(|n| (format!("{n}.bvh"), many_joints()));
    let zip = zip_of(clips());
    let inner = zip_of(clips().take(10));
    let twice = zip_of((0..4).map(|n| (format!("{n}.zip"), inner.clone())));
    let list = format!("[{}[0,0,0]]", "[[0,0,0],[0,0,0]],".repeat(1 << 20));
    let scene = format!(
        "{{\"asset\":{{}},\"nodes\":[{}{{}}]}}",
        "{\"a\":0},".repeat(1 << 20)
    );
    let rows = format!("frame,a_x,a_y,a_z\n{}", "1,2,3,4\n".repeat(1 << 22));
    let bombs = [
        ("a.zip", zip.clone()),
        ("a.zip.gz", gz(&zip)),
        ("b.zip.gz", gz(&twice)),
        ("a.bvh.gz", blanks(300)),
        ("a.json.gz", gz(list.as_bytes())),
        ("a.gltf.gz", gz(scene.as_bytes())),
        ("a.csv.gz", gz(rows.as_bytes())),
    ];
    let real = [
        ("walk.bvh.gz", gz(&recording(1)), 1),
        (
            "walks.zip",
            zip_of((1..4).map(|n| (format!("{n}.bvh"), recording(n)))),
            3,
        ),
    ];
    drop((list, scene, rows));
    let before = peak_bytes();
    for (name, bytes) in &bombs {
        let error = read(name, bytes).map(drop).unwrap_err();
        assert!(
            error.kind.is_of_memory(),
            "{name}, {} bytes: {error}",
            bytes.len()
        );
        assert!(error.to_string().contains("unpack it"), "{error}");
    }
    for (name, bytes, clips) in &real {
        let read = read(name, bytes).unwrap();
        assert_eq!(read.clips.len(), *clips, "{name}");
    }
    if let (Some(before), Some(after)) = (before, peak_bytes()) {
        let largest = bombs
            .iter()
            .map(|(_, bytes)| bytes.len() as u64)
            .max()
            .unwrap_or(0);
        let most = before + SMALL + 3 * largest;
        assert!(after <= most, "{} MB, of {} MB", after >> 20, most >> 20);
    }
}
