//! The programs that play and decode videos, by programs that act as they do.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::process::Command as Process;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use morec_db::ClipVideo;
use serde_json::{Value, json};

use super::offset;
use crate::state::{Command, Panel, PlayCommand};
use crate::store::Edit;
use crate::tests::{Person, made};

/// Until something is so; time passes in the window meanwhile.
fn waits(person: &mut Person, what: &str, is_so: impl Fn(&Person) -> bool) {
    let begun = Instant::now();
    while !is_so(person) {
        assert!(begun.elapsed() < Duration::from_secs(60), "never: {what}");
        person.frames(1);
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Makes a shell script. Another process writes it, as a file that this process has open for writing cannot be executed.
fn program(folder: &Path, name: &str, lines: &str) -> PathBuf {
    let (text, program) = (folder.join(format!("{name}.txt")), folder.join(name));
    std::fs::write(&text, format!("#!/bin/sh\n{lines}\n")).unwrap();
    let copy = Process::new("sh")
        .args(["-c", "cp \"$0\" \"$1\" && chmod +x \"$1\""])
        .args([&text, &program])
        .status();
    assert!(copy.unwrap().success());
    program
}

/// A program that takes mpv's arguments, and a thread that answers at its socket; what it was told.
fn false_player(folder: &Path) -> (PathBuf, Arc<Mutex<Vec<Value>>>) {
    let arguments = folder.join("arguments");
    let lines = format!(
        "printf '%s\\n' \"$@\" > '{0}.part'; mv '{0}.part' '{0}'; while [ ! -e '{0}.end' ]; do sleep 0.02; done",
        arguments.display()
    );
    let told = Arc::new(Mutex::new(Vec::new()));
    let theirs = told.clone();
    let serve = move || {
        let given = loop {
            match std::fs::read_to_string(&arguments) {
                Ok(given) => break given,
                Err(_) => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        let mut given = given.lines();
        let socket = given.next().unwrap().strip_prefix("--input-ipc-server=");
        let listener = UnixListener::bind(socket.unwrap()).unwrap();
        assert!(given.last().unwrap().ends_with("film 1.webm"));
        let (mut stream, _) = listener.accept().unwrap();
        let (mut place, mut asked) = (0.0, 0);
        let lines = BufReader::new(stream.try_clone().unwrap()).lines();
        for line in lines.map_while(Result::ok) {
            let said: Value = serde_json::from_str(&line).unwrap();
            let command = &said["command"];
            let mut answer = json!({"error": "success", "request_id": said["request_id"]});
            match command[0].as_str().unwrap() {
                "get_property" => asked += 1,
                "seek" => place = command[1].as_f64().unwrap(),
                _ => {}
            }
            match asked {
                // The file is not open yet.
                1 => answer["error"] = "property unavailable".into(),
                _ => answer["data"] = place.into(),
            }
            if command[0] != "get_property" {
                theirs.lock().unwrap().push(command.clone());
            }
            let event = r#"{"event":"property-change"}"#;
            let ends = command[0] == "seek" && command[1] == 9.0;
            if ends {
                std::fs::write(arguments.with_extension("end"), "").unwrap();
                return;
            }
            if write!(stream, "{event}\n{answer}\n").is_err() {
                return;
            }
        }
    };
    std::thread::spawn(serve);
    (program(folder, "player", &lines), told)
}

/// The window before a clip with a video that began 1.5 s before it.
fn with_video(folder: &Path) -> Person {
    let film = folder.join("film 1.webm");
    std::fs::write(&film, b"frames").unwrap();
    let mut person = Person::before(&[made(folder, 1)]);
    person.window.state_mut().state.video.decoder = folder.join("no decoder");
    let clip = person.state().shown_clip().unwrap().name.clone();
    let video = Some(ClipVideo {
        path: film.display().to_string(),
        offset_secs: 1.5,
    });
    person.command(Command::Edit(Edit::Video { clip, video }));
    person
}

#[test]
fn a_player_follows_the_playhead_until_it_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = with_video(folder.path());
    let (player, told) = false_player(folder.path());
    person.window.state_mut().state.video.player = player;
    let was_told = |command: Value| {
        let told = told.clone();
        move |_: &Person| told.lock().unwrap().contains(&command)
    };
    let was_put = |at: f64| {
        let told = told.clone();
        let is_there =
            move |c: &Value| c[0] == "seek" && (c[1].as_f64().unwrap() - at).abs() < 1e-9;
        move |_: &Person| told.lock().unwrap().iter().any(&is_there)
    };
    person.click("Play video along");
    waits(
        &mut person,
        "how it is put",
        was_told(json!(["seek", 1.5, "absolute+exact"])),
    );
    person.command(Command::Play(PlayCommand::Seek(0.5)));
    waits(&mut person, "the playhead", was_put(2.0));
    assert!(!was_told(json!(["set_property", "pause", false]))(&person));
    person.command(Command::Play(PlayCommand::Speed(0.05)));
    person.command(Command::Play(PlayCommand::Toggle));
    let plays = json!(["set_property", "pause", false]);
    waits(&mut person, "that it plays", was_told(plays));
    assert!(was_told(json!(["set_property", "speed", 0.05]))(&person));
    told.lock().unwrap().clear();
    person.command(Command::Play(PlayCommand::Pause));
    let stands = json!(["set_property", "pause", true]);
    waits(&mut person, "that it stands", was_told(stands));
    let at = 1.5 + person.state().player.at_secs;
    waits(&mut person, "the place where it stands", was_put(at));
    // A video that has not begun yet shows its beginning.
    let clip = person.state().shown_clip().unwrap().name.clone();
    let mut video = person.state().shown_video().unwrap().clone();
    video.offset_secs = -30.0;
    let video = Some(video);
    person.command(Command::Edit(Edit::Video { clip, video }));
    waits(&mut person, "its beginning", was_put(0.0));
    person.undo();
    assert!(person.offers("Close the video"));
    // At this place the other closes its window.
    person.command(Command::Play(PlayCommand::Seek(7.5)));
    let closed = |person: &Person| person.state().video.along.is_none();
    waits(&mut person, "that it is closed", closed);
    assert_eq!(person.state().said, "the video is closed");
    assert!(person.state().notices.is_empty() && person.offers("Play video along"));
}

#[test]
fn a_player_that_is_missing_or_fails_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = with_video(folder.path());
    let fails = program(folder.path(), "player", "exit 2");
    for (player, said) in [
        (folder.path().join("mpv"), "mpv is not installed"),
        (fails, "mpv cannot play"),
    ] {
        person.window.state_mut().state.video.player = player;
        person.click("Play video along");
        let closed = |person: &Person| person.state().video.along.is_none();
        waits(&mut person, said, closed);
        person.frames(1);
        assert!(person.sees_part(said), "{:?}", person.state().notices);
    }
    std::fs::remove_file(folder.path().join("film 1.webm")).unwrap();
    person.click("Play video along");
    let closed = |person: &Person| person.state().video.along.is_none();
    waits(&mut person, "no file", closed);
    assert!(person.sees_part("film 1.webm: "));
}

#[test]
fn the_sound_is_drawn_and_its_clap_proposes_the_offset() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = with_video(folder.path());
    person.click("Offset from a clap");
    person.settle();
    assert!(person.sees_part("ffmpeg is not installed"));
    person.goes_to(Panel::Label);
    assert!(person.sees_part("Sound: ffmpeg is not installed"));
    // Twenty seconds of a hum with a bang at 12 s, 8000 samples a second.
    let sample = |n: usize| match n as f64 / 8000.0 - 12.0 {
        since if since >= 0.0 => 0.1 + 0.8 * (-20.0 * since).exp(),
        _ => 0.1,
    };
    let sample = |n| ((sample(n) * 32767.0) as i16).to_le_bytes();
    let samples: Vec<u8> = (0..160_000).flat_map(sample).collect();
    let file = folder.path().join("samples");
    std::fs::write(&file, samples).unwrap();
    let line = format!("cat '{}'", file.display());
    let state = &mut person.window.state_mut().state;
    state.video.decoder = program(folder.path(), "decoder", &line);
    // Another file, so that it is read anew.
    std::fs::copy(
        folder.path().join("film 1.webm"),
        folder.path().join("b.webm"),
    )
    .unwrap();
    let clip = person.state().shown_clip().unwrap().name.clone();
    let video = ClipVideo {
        path: folder.path().join("b.webm").display().to_string(),
        offset_secs: 1.5,
    };
    let video = Some(video);
    person.command(Command::Edit(Edit::Video { clip, video }));
    person.settle();
    assert!(person.sees("Track Sound") && !person.sees_part("ffmpeg"));
    assert_eq!(
        person
            .state()
            .shown_sound()
            .unwrap()
            .envelope
            .as_ref()
            .unwrap()
            .peaks
            .len(),
        4000
    );
    person.goes_to(Panel::Library);
    person.click("Offset from a clap");
    person.settle();
    let hands = person.state().player.at_secs;
    let samples = person.state().shown_samples();
    let clap = samples
        .iter()
        .find(|s| s.class == "clap" && s.span().contains(hands));
    assert!(clap.is_some(), "{hands}");
    assert!(person.sees_part("the loudest onset is at 12.00 s of the video"));
    person.click("Leave the offset");
    person.settle();
    assert_eq!(offset(&person), Some(1.5));
    person.click("Offset from a clap");
    person.settle();
    person.click("Use this offset");
    person.settle();
    assert!((offset(&person).unwrap() - (12.0 - hands)).abs() < 0.006);
    assert!(person.state().command_line.contains("--video-offset"));
    assert!(!person.offers("Use this offset"));
    person.undo();
    assert_eq!(offset(&person), Some(1.5));
}
