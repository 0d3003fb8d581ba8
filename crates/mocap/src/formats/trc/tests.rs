use super::*;
use crate::clip::{Clip, Gap, Points};

const TEXT: &str = "PathFileType\t4\t(X/Y/Z)\tx.trc\r\n\
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\r\n\
60.00\t60.00\t3\t2\tmm\t60.00\t1\t3\r\n\
Frame#\tTime\tR.ASIS\t\t\tL.ASIS\t\t\t\r\n\
\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n\
\r\n\
1\t0.000\t1\t2\t3\t4\t5\t6\r\n\
2\t0.017\t1.5\t2\t3\t\t\t\r\n\
3\t0.033\t2\t2\t3\t4\t5\t6\r\n";

fn load(text: &str) -> (Clip, String) {
    let mut loaded = read(text.as_bytes(), "x", None, &Limits::default()).unwrap();
    let said: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    (loaded.clips.remove(0), said.join("\n"))
}

fn fail(text: &str) -> String {
    read(text.as_bytes(), "x", None, &Limits::default())
        .unwrap_err()
        .to_string()
}

fn check(clip: &Clip) {
    let names: Vec<&str> = clip.skeleton.names().collect();
    assert_eq!(names, ["R.ASIS", "L.ASIS"]);
    assert_eq!((clip.frames, clip.rate_hz), (3, 60.0));
    assert_eq!(clip.tracks[0].positions[1], Vec3::new(1.5, 2.0, 3.0));
    assert_eq!(clip.tracks[1].positions[1], Vec3::new(4.0, 5.0, 6.0));
    assert_eq!(clip.points.as_ref().unwrap().metres_per_unit, Some(0.001));
}

#[test]
fn a_usual_file() {
    let (clip, said) = load(TEXT);
    check(&clip);
    assert_eq!(clip.repaired, [1..2]);
    assert!(said.contains("1 gaps") && !said.contains('\n'), "{said}");
}

#[test]
fn headers_of_every_habit() {
    for (from, to) in [
        ("\r\n", "\n"),
        ("\r\n\r\n", "\r\n"),
        // No tabs behind the last point seen, nor behind the names.
        ("3\t\t\t\r\n3", "3\r\n3"),
        ("L.ASIS\t\t\t\r\n", "L.ASIS\r\n"),
        ("R.ASIS\t\t\tL.ASIS\t\t\t", "R.ASIS\tL.ASIS"),
        ("Frame#\tTime", "Frame\ttime"),
        ("60.00\t60.00", "60\t120"),
        ("PathFileType\t4\t(X/Y/Z)\tx.trc\r\n", ""),
        ("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n", ""),
        ("\t", ","),
        ("\t", ";"),
        ("\tmm\t", "\tMillimeters\t"),
    ] {
        let text = TEXT.replace(from, to);
        assert_ne!(text, TEXT);
        check(&load(&text).0);
    }
}

#[test]
fn disagreements_are_said() {
    let (clip, said) = load(&TEXT.replace("60.00\t3\t2\tmm", "60.00\t7\t5\tfurlong"));
    assert_eq!(clip.frames, 3);
    for part in [
        "2 points are named, the header states 5",
        "found 3 frames, the header states 7",
        "no known unit",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let (clip, said) = load(&TEXT.replace("60.00\t60.00\t3", "100\t100\t3"));
    assert!(
        clip.rate_hz > 58.0 && clip.rate_hz < 62.0 && said.contains("100 Hz is stated"),
        "{said}"
    );
}

#[test]
fn what_cannot_be_read_is_said_plainly() {
    assert!(fail("").contains("an empty file"));
    assert!(fail("PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate").contains("Frame#"));
    let none = "PathFileType\t4\nDataRate\tUnits\n60\tmm\nFrame#\tTime\n\n1\t0.0\n2\t0.1\n";
    assert!(fail(none).contains("no points"), "{}", fail(none));
    let end = TEXT.find("1\t0.000").unwrap();
    assert!(fail(&TEXT[..end]).contains("frames below"));
}

#[test]
fn cut_or_altered_files_never_panic() {
    for end in 0..TEXT.len() {
        let _ = read(&TEXT.as_bytes()[..end], "x", None, &Limits::default());
        for value in [b'\t', b'\n', b'9', b'x', 0, 0xFF] {
            let mut bytes = TEXT.as_bytes().to_vec();
            bytes[end] = value;
            let _ = read(&bytes, "x", None, &Limits::default());
        }
    }
}

#[test]
fn written_files_are_read_again() {
    let track = |p: f64| {
        (0..20)
            .map(|f| Vec3::new(p, f as f64 / 8.0, -1.5))
            .collect()
    };
    let gaps = vec![Gap {
        joint: 1,
        frames: 12..20,
    }];
    let known = Points {
        gaps: gaps.clone(),
        metres_per_unit: Some(1.0),
    };
    let points = [
        ("Hips".to_owned(), track(1.0)),
        ("L Hand".to_owned(), track(2.0)),
    ];
    let clip = Clip::of_points("take".into(), 24.0, points, known);
    let mut bytes = Vec::new();
    write(&clip, &mut bytes).unwrap();
    let (again, _) = load(std::str::from_utf8(&bytes).unwrap());
    assert_eq!((again.rate_hz, again.frames), (24.0, 20));
    assert_eq!(again.points.unwrap().gaps, gaps);
    assert_eq!(again.tracks[0], clip.tracks[0]);
    assert_eq!(
        again.tracks[1].positions[..12],
        clip.tracks[1].positions[..12]
    );
}

/// A name above each column, as Pose2Sim's documentation and spreadsheets have it.
#[test]
fn names_above_each_column() {
    for names in [
        "R.ASIS_x\tR.ASIS_y\tR.ASIS_z\tL.ASIS_x\tL.ASIS_y\tL.ASIS_z",
        "R.ASIS X\tR.ASIS Y\tR.ASIS Z\tL.ASIS X\tL.ASIS Y\tL.ASIS Z",
        "R.ASIS\tR.ASIS\tR.ASIS\tL.ASIS\tL.ASIS\tL.ASIS",
    ] {
        let text = TEXT.replace("R.ASIS\t\t\tL.ASIS\t\t\t", names);
        check(&load(&text).0);
    }
    // Three points whose names look so by chance are three points.
    let text = TEXT.replace("R.ASIS\t\t\tL.ASIS\t\t\t", "Px\tQy");
    assert_eq!(load(&text).0.skeleton.len(), 2);
}
