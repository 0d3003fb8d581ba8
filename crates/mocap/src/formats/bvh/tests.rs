use std::path::Path;

use super::*;

/// In pieces of any size a file gives what it gives as a whole: clips, warnings and errors, line numbers among them.
#[test]
fn pieces_read_as_the_whole() {
    let (options, limits) = (BvhOptions::default(), Limits::default());
    let mut files = 0;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/bvh");
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        let whole = read(&bytes, "clip", &options, &limits);
        for piece in [1, 2, 3, 50, 1000] {
            let file = std::io::Cursor::new(&bytes);
            let pieces = read_in_pieces(file, piece, "clip", &options, &limits);
            assert_eq!(pieces, whole, "in pieces of {piece} bytes");
        }
        files += 1;
    }
    assert!(files > 20);
}

#[test]
fn a_line_without_end_is_refused_in_pieces_too() {
    let limits = Limits {
        line_bytes: 100,
        ..Limits::default()
    };
    let head = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n";
    let bytes = format!("{head}{}", "1 ".repeat(10_000));
    let options = BvhOptions::default();
    let whole = read(bytes.as_bytes(), "clip", &options, &limits).unwrap_err();
    let file = std::io::Cursor::new(&bytes);
    let pieces = read_in_pieces(file, 64, "clip", &options, &limits).unwrap_err();
    assert_eq!((whole.at, &whole.expected), (pieces.at, &pieces.expected));
}

/// A skeleton of many joints and rows of one number: what a frame takes must not grow with both.
#[test]
fn memory_follows_the_size_of_the_file() {
    let joints = 4000;
    let mut text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n".to_owned();
    for joint in 1..joints {
        text += &format!("JOINT j{joint}\n{{\nOFFSET 0 1 0\n}}\n");
    }
    text += "}\nMOTION\nFrames: 40000\nFrame Time: 0.01\n";
    text += &"0\n".repeat(40_000);
    let error = read(
        text.as_bytes(),
        "clip",
        &BvhOptions::default(),
        &Limits::default(),
    )
    .unwrap_err();
    let most: usize = error.expected.split(' ').nth(2).unwrap().parse().unwrap();
    let taken = most * joints * size_of::<crate::math::Quat>();
    let allowed = 130 * text.len() + (32 << 20);
    assert!(taken <= allowed, "{taken} bytes of {}", text.len());
}
