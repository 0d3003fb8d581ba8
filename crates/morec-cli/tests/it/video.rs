//! Videos beside clips of a database: `morec db clips --set-video`, and the offset from a clap.

use std::path::Path;
use std::process::Command;

use morec::formats::bvh;
use morec::synth::{DatabaseSpec, database};
use morec_db::MotionDb;

use crate::kit::Folder;

/// Where the clip begins in its video, as the database has it.
fn offset(folder: &Folder, clip: &str) -> Option<f64> {
    let db = MotionDb::open_read_only(&folder.path().join("m.mdb")).unwrap();
    let videos = db.videos().unwrap();
    Some(videos.get(&db.find_clip(clip).unwrap().id)?.offset_secs)
}

/// Sets the video with programs of this folder alone; what was said.
fn set(folder: &Folder, clip: &str, programs: &Path) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_morec"))
        .args(["db", "clips", "m.mdb", "--clip", clip])
        .args(["--set-video", "film.mp4", "--video-offset", "clap"])
        .current_dir(folder.path())
        .env("PATH", programs)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.success(), said)
}

#[test]
fn an_offset_is_seconds_or_found_by_a_clap() {
    let spec = DatabaseSpec {
        people: 1,
        repetitions: 1,
        classes: vec!["wave", "clap"],
        ..DatabaseSpec::default()
    };
    let take = database(3, &spec).remove(0);
    let clip = take.clip.name.as_str();
    let folder = Folder::with(&[]);
    let mut bytes = Vec::new();
    bvh::write(&take.clip, &mut bytes).unwrap();
    std::fs::write(folder.path().join(format!("{clip}.bvh")), bytes).unwrap();
    folder.morec(&["db", "init", "m.mdb"]).ok();
    folder.morec(&["db", "import", "m.mdb", "."]).ok();
    std::fs::write(folder.path().join("film.mp4"), "frames").unwrap();
    let clips = [
        "db",
        "clips",
        "m.mdb",
        "--clip",
        clip,
        "--set-video",
        "film.mp4",
    ];
    folder.morec(&clips).ok();
    assert_eq!(offset(&folder, clip), Some(0.0));
    let by_number = [&clips[..], &["--video-offset", "-1.5"]].concat();
    folder.morec(&by_number).ok();
    assert_eq!(offset(&folder, clip), Some(-1.5));
    let odd = [&clips[..], &["--video-offset", "soon"]].concat();
    assert_eq!(folder.morec(&odd).code, Some(2));
    let programs = tempfile::tempdir().unwrap();
    let (done, said) = set(&folder, clip, programs.path());
    assert!(!done && said.contains("ffmpeg is not installed"), "{said}");
    assert_eq!(offset(&folder, clip), Some(-1.5), "unchanged");
    #[cfg(unix)]
    {
        // A bang at 30 s of silence, from a program in place of ffmpeg.
        let bang = [vec![0u8; 2 * 8000 * 30], vec![0x55; 2 * 400]].concat();
        std::fs::write(programs.path().join("bang"), bang).unwrap();
        let text = programs.path().join("text");
        let line = format!(
            "#!/bin/sh\n/bin/cat '{}'\n",
            programs.path().join("bang").display()
        );
        std::fs::write(&text, line).unwrap();
        // Another process writes the program, as a file that this process has open for writing cannot be executed.
        let copy = Command::new("/bin/sh")
            .args(["-c", "cp text ffmpeg && chmod +x ffmpeg"])
            .current_dir(programs.path())
            .status();
        assert!(copy.unwrap().success());
        let (done, said) = set(&folder, clip, programs.path());
        assert!(done && said.contains("30.00 s of the video"), "{said}");
        let hands = 30.0 - offset(&folder, clip).unwrap();
        let clap = take.labels.iter().find(|label| label.class == "clap");
        assert!(clap.unwrap().span.contains(hands), "{hands} {clap:?}");
    }
}
