//! `morec live` and `morec send` with each other, over the loopback network.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

use morec::formats::bvh;
use morec::synth::{Person, Script};
use serde_json::Value;

use crate::kit::Folder;

/// An index of an old release: what it recognises does not matter here.
const INDEX: &[u8] = include_bytes!("../../../morec/testdata/index/v1.index");

/// A folder with an index and a person who moves for some seconds.
fn folder() -> Folder {
    folder_of_waves(1)
}

/// The same, of a person who waves this often.
fn folder_of_waves(count: usize) -> Folder {
    let folder = Folder::with(&[]);
    std::fs::write(folder.path().join("v1.index"), INDEX).unwrap();
    let script = Script::new(5, Person::draw(5, 0)).rest(1.0);
    let script = (0..count).fold(script, |script, _| script.play("wave").rest(0.5));
    let take = script.film("person", 60.0).unwrap();
    let mut bytes = Vec::new();
    bvh::write(&take.clip, &mut bytes).unwrap();
    std::fs::write(folder.path().join("person.bvh"), bytes).unwrap();
    folder
}

/// `morec live`, running.
struct Live {
    child: Child,
    err: BufReader<ChildStderr>,
    /// Host and port at which it listens.
    at: String,
}

impl Live {
    fn start(folder: &Folder, listen: &str, more: &[&str]) -> Self {
        Self::of(folder, &["live", "v1.index"], listen, more)
    }

    /// Another command that listens.
    fn of(folder: &Folder, command: &[&str], listen: &str, more: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_morec"))
            .args(command)
            .args(["--listen", listen])
            .args(more)
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut err = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        while !line.contains("listening to") {
            line.clear();
            assert!(
                err.read_line(&mut line).unwrap() > 0,
                "it ended before it listened"
            );
        }
        let at = line.trim().rsplit("//").next().unwrap().to_owned();
        Self { child, err, at }
    }

    /// Interrupts it as Ctrl-C would; returns what it said in the end.
    fn interrupt(mut self) -> String {
        let done = Command::new("kill")
            .args(["-INT", &self.child.id().to_string()])
            .status()
            .unwrap();
        assert!(done.success());
        let mut said = String::new();
        self.err.read_to_string(&mut said).unwrap();
        assert_eq!(self.child.wait().unwrap().code(), Some(0), "{said}");
        said
    }
}

/// The number before `what` in a summary.
fn count(summary: &str, what: &str) -> u64 {
    let before = summary.split(what).next().unwrap().trim_end();
    before
        .rsplit([' ', ','])
        .next()
        .unwrap()
        .parse()
        .unwrap_or_else(|_| panic!("{what} in {summary}"))
}

#[test]
#[cfg(unix)]
fn what_send_sends_live_hears_and_rubbish_does_not_end_it() {
    let folder = folder();
    let live = Live::start(
        &folder,
        "vmc://127.0.0.1:0",
        &["--emit", "json:events.jsonl"],
    );
    let rubbish = UdpSocket::bind("127.0.0.1:0").unwrap();
    for bytes in [
        &b""[..],
        b"#bundle\0",
        b"/VMC/Ext/Bone/Pos\0\0\0,s\0\0",
        &[0xff; 60_000],
    ] {
        rubbish.send_to(bytes, &live.at).unwrap();
    }
    let to = format!("vmc://{}", live.at);
    let sent = folder.morec(&[
        "send",
        "person.bvh",
        "--to",
        &to,
        "--bundle",
        "300",
        "--loss",
        "0.02",
    ]);
    assert!(sent.err.contains("sent "), "{sent:?}");
    let summary = live.interrupt();
    // Most of some three seconds at 60 Hz; a loaded machine may lose some on the way.
    assert!(count(&summary, " frames,") > 30, "{summary}");
    assert!(count(&summary, " malformed packets") >= 2, "{summary}");
}

#[test]
#[cfg(unix)]
fn lines_over_tcp_are_poses_and_connections_come_and_go() {
    let folder = folder();
    let live = Live::start(&folder, "json+tcp://127.0.0.1:0", &["--emit", "json:-"]);
    for _ in 0..2 {
        let mut stream = TcpStream::connect(&live.at).unwrap();
        for i in 0..50 {
            let turned = f64::from(i) * 0.01;
            writeln!(
                stream,
                r#"{{"t": {turned}, "rotations": {{"hips": [0,0,0,1], "left_arm": [0,0,{turned},1]}}}}"#
            )
            .unwrap();
        }
        writeln!(stream, "hello?").unwrap();
    }
    // Until everything has arrived; if it never does, the counts below say so.
    std::thread::sleep(Duration::from_secs(3));
    let summary = live.interrupt();
    assert_eq!(
        (
            count(&summary, " frames,"),
            count(&summary, " malformed packets")
        ),
        (100, 2),
        "{summary}"
    );
}

/// A WebSocket without a library: says hello.
#[cfg(unix)]
fn connected(at: &str, path: &str) -> TcpStream {
    let mut stream = TcpStream::connect(at).unwrap();
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: {at}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
        Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    .unwrap();
    let mut answer = Vec::new();
    while !answer.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        answer.extend(byte);
    }
    stream
}

/// Sends short text messages.
#[cfg(unix)]
fn send_texts(mut stream: &TcpStream, texts: &[&str]) {
    for text in texts {
        // A whole text, its length in two bytes, under a mask of zeros.
        let [high, low] = u16::try_from(text.len()).unwrap().to_be_bytes();
        let head = [0x81, 0x80 | 126, high, low, 0, 0, 0, 0];
        stream
            .write_all(&[&head, text.as_bytes()].concat())
            .unwrap();
    }
}

/// Text messages as they come, until one `is_last`, or none comes for a minute.
#[cfg(unix)]
fn heard(mut stream: &TcpStream, is_last: impl Fn(&Value) -> bool) -> Vec<Value> {
    let patience = Some(Duration::from_secs(60));
    stream.set_read_timeout(patience).unwrap();
    let mut messages = Vec::new();
    let mut head = [0; 2];
    while !messages.last().is_some_and(&is_last) && stream.read_exact(&mut head).is_ok() {
        let mut length = usize::from(head[1]);
        if length == 126 {
            stream.read_exact(&mut head).unwrap();
            length = u16::from_be_bytes(head).into();
        }
        let mut text = vec![0; length];
        stream.read_exact(&mut text).unwrap();
        messages.push(serde_json::from_slice(&text).unwrap());
    }
    messages
}

/// Lines of JSON with the poses of the folder's person, and what MediaPipe's folder is known by.
#[cfg(unix)]
fn camera_lines(folder: &Folder) -> String {
    let to_lines = "record --listen clip://person.bvh?speed=0 -o take.jsonl --count-down 0";
    let recorded = folder.morec(&to_lines.split(' ').collect::<Vec<_>>());
    assert_eq!(recorded.code, Some(0), "{recorded:?}");
    std::fs::write(folder.path().join("pose.js"), "").unwrap();
    std::fs::read_to_string(folder.path().join("take.jsonl")).unwrap()
}

#[test]
#[cfg(unix)]
#[cfg_attr(
    debug_assertions,
    ignore = "while it trains unoptimised the page's connection ends: .ci/nightly runs it"
)]
fn the_cameras_page_shows_the_countdown_the_classes_and_what_is_recognised() {
    let folder = folder_of_waves(6);
    let lines = camera_lines(&folder);
    let lines: Vec<&str> = lines.lines().collect();
    let take = ["--name", "wave", "--secs", "4", "--count-down", "1"];
    let camera = ["--mediapipe", ".", "--no-bell"];
    let teach = Live::of(
        &folder,
        &["teach", "new.index"],
        "webcam://127.0.0.1:0",
        &[&take[..], &camera[..]].concat(),
    );
    let page = connected(&teach.at, "/poses");
    let sender = page.try_clone().unwrap();
    let is_wave = |told: &Value| told["class"] == "wave" && told["phase"] == "end";
    let told = std::thread::scope(|scope| {
        scope.spawn(|| send_texts(&sender, &lines));
        heard(&page, is_wave)
    });
    let texts: Vec<&str> = told.iter().filter_map(|t| t["text"].as_str()).collect();
    let said = |text: &str| texts.iter().position(|t| *t == text);
    // The seconds that are left, then what to perform.
    let in_order = ["1", "wave, 1 of 3", "wave, 3 of 3"].map(said);
    assert!(in_order.is_sorted() && in_order[0].is_some(), "{texts:?}");
    assert_eq!(texts.last(), Some(&""), "{texts:?}");
    let classes = told.iter().find(|t| t["type"] == "classes");
    assert_eq!(classes.unwrap()["names"], serde_json::json!(["wave"]));
    assert!(told.last().is_some_and(is_wave), "{told:?}");
    // Bars grow before the end.
    assert!(told.iter().any(|t| t["phase"] == "start"), "{told:?}");
    teach.interrupt();
}

#[test]
#[cfg(unix)]
fn recorded_poses_from_the_cameras_page_are_a_stream_like_any_other() {
    let folder = folder();
    let lines = camera_lines(&folder);
    let lines: Vec<&str> = lines.lines().collect();
    let live = Live::start(&folder, "webcam://127.0.0.1:0", &["--mediapipe", "."]);
    let page = connected(&live.at, "/poses");
    send_texts(&page, &lines);
    // Until everything has arrived; if it never does, the counts below say so.
    std::thread::sleep(Duration::from_secs(3));
    let summary = live.interrupt();
    let poses = lines.iter().filter(|l| l.contains("positions")).count();
    assert!(poses > 100);
    assert_eq!(count(&summary, " frames,"), poses as u64, "{summary}");
}

#[test]
fn a_clip_ends_by_itself_and_what_cannot_be_opened_says_why() {
    let folder = folder();
    let ran = folder.morec(&["live", "v1.index", "--listen", "clip://person.bvh?speed=0"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(count(&ran.err, " frames,") > 100, "{}", ran.err);
    for (listen, emit, said) in [
        ("midi://x", "terminal:-", "no source is called midi"),
        ("vmc://nowhere", "terminal:-", "HOST:PORT"),
        ("clip://absent.bvh", "terminal:-", "absent.bvh"),
        ("clip://person.bvh?sped=2", "terminal:-", "no option sped"),
        ("webcam", "terminal:-", "npm pack @mediapipe/pose"),
        ("clip://person.bvh", "midi:1", "no sink is called midi"),
    ] {
        let ran = folder.morec(&["live", "v1.index", "--listen", listen, "--emit", emit]);
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(ran.err.contains(said), "{}", ran.err);
    }
    assert_eq!(folder.morec(&["live", "v1.index"]).code, Some(2));
    assert_eq!(
        folder.morec(&["live", "v1.index", "--listen", "vmc"]).code,
        Some(2)
    );
}

#[test]
#[cfg(unix)]
fn a_motion_runs_the_command_of_its_class_and_no_shell() {
    let (folder, takes) = crate::db::studio(3);
    folder.train("i.index", &[]).ok();
    let listen = format!("clip://clips/{}.bvh?speed=0", takes[0].clip.name);
    let live = ["live", "i.index", "--listen", &listen];
    let events = folder.morec(&[&live[..], &["--emit", "json:-"]].concat());
    let waves = events.out.matches("\"class\":\"wave\"").count();
    assert!(waves > 0, "{events:?}");
    // Programs that end before they can be waited for are seen by what they leave.
    let on = [
        "--on",
        "wave=mkdir -p 'a b' $HOME;x",
        "--on",
        "wave=absent-program",
    ];
    let ran = folder.morec(&[&live[..], &on[..]].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(
        ran.err.matches("absent-program: ").count(),
        waves,
        "{}",
        ran.err
    );
    let made = |name: &str| folder.path().join(name).is_dir();
    let deadline = std::time::Instant::now() + Duration::from_secs(60);
    while !(made("a b") && made("$HOME;x")) && std::time::Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(made("a b") && made("$HOME;x"), "a shell had it, or nobody");
    let wrong = folder.morec(&[&live[..], &["--on", "wafe=true"]].concat());
    assert_eq!(wrong.code, Some(1), "{wrong:?}");
    assert!(
        wrong.err.contains("no class wafe") && wrong.err.contains("wave"),
        "{}",
        wrong.err
    );
}

#[test]
fn progress_is_lines_of_every_class_and_no_lines_in_the_terminal() {
    let (folder, takes) = crate::db::studio(3);
    folder.train("i.index", &[]).ok();
    let listen = format!("clip://clips/{}.bvh?speed=0", takes[0].clip.name);
    let live = ["live", "i.index", "--listen", &listen];
    let plain = folder.morec(&live).ok();
    let follow = [&live[..], &["--progress"]].concat();
    let lines = folder.morec(&[&follow[..], &["--emit", "json:-"]].concat());
    let of_wave: Vec<serde_json::Value> = (lines.ok().lines())
        .map(|line| serde_json::from_str(line).unwrap())
        .filter(|line: &serde_json::Value| line["phase"] == "progress" && line["class"] == "wave")
        .collect();
    assert!(of_wave.len() > 60, "{}", of_wave.len());
    let most = of_wave
        .iter()
        .map(|line| line["progress"].as_f64().unwrap());
    assert!(most.fold(0.0, f64::max) > 0.9);
    assert!(
        of_wave
            .iter()
            .all(|line| line["pace"].is_number() && line["motion"] == 0)
    );
    assert_eq!(folder.morec(&follow).ok(), plain);
}

/// Whoever reads the record later cannot know what it lacks.
#[test]
#[cfg(target_os = "linux")]
fn a_record_that_lacks_events_ends_with_a_code() {
    let (folder, takes) = crate::db::studio(3);
    folder.train("i.index", &[]).ok();
    let listen = format!("clip://clips/{}.bvh?speed=0", takes[0].clip.name);
    let live = |emit| folder.morec(&["live", "i.index", "--listen", &listen, "--emit", emit]);
    let whole = live("json:events.jsonl");
    assert_eq!(whole.code, Some(0), "{whole:?}");
    let events = std::fs::read_to_string(folder.path().join("events.jsonl")).unwrap();
    let events = events.lines().count();
    assert!(events > 0, "{whole:?}");
    let lost = live("json:/dev/full");
    assert_eq!(lost.code, Some(1), "{lost:?}");
    let said = format!("json:/dev/full: {events} events could not be delivered");
    assert!(lost.err.contains("No space left"), "{}", lost.err);
    assert!(lost.err.contains(&said), "{}", lost.err);
}

/// `morec send` as a broadcast, waiting for somebody to listen; and where it is.
fn broadcast(folder: &Folder, at: &str) -> (Child, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_morec"))
        .args([
            "send",
            "person.bvh",
            "--to",
            &format!("axis://{at}"),
            "--speed",
            "4",
        ])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("axis://") {
        line.clear();
        assert!(
            err.read_line(&mut line).unwrap() > 0,
            "it ended before it listened"
        );
    }
    let at = line.trim().rsplit("//").next().unwrap().to_owned();
    // Whatever else it says must not make it wait.
    std::thread::spawn(move || std::io::copy(&mut err, &mut std::io::sink()));
    (child, at)
}

#[test]
#[cfg(unix)]
fn an_axis_broadcast_is_heard_and_waited_for_when_it_ends() {
    let folder = folder();
    let (mut first, at) = broadcast(&folder, "127.0.0.1:0");
    let live = Live::start(&folder, &format!("axis://{at}"), &["--emit", "json:-"]);
    assert!(first.wait().unwrap().success());
    // Another at the same place, which the listener must find by itself.
    let (mut second, _) = broadcast(&folder, &at);
    assert!(second.wait().unwrap().success());
    let summary = live.interrupt();
    // Twice some three seconds at 60 Hz; a loaded machine may lose some on the way.
    assert!(count(&summary, " packets") > 200, "{summary}");
    assert!(count(&summary, " frames,") > 60, "{summary}");
    assert_eq!(count(&summary, " interruptions"), 1, "{summary}");
    assert!(!summary.contains("malformed"), "{summary}");
}

#[test]
fn a_skeleton_that_is_not_the_broadcasts_is_refused() {
    let folder = folder();
    let args = [
        "live",
        "v1.index",
        "--listen",
        "axis://127.0.0.1:7001",
        "--skeleton",
        "person.bvh",
    ];
    let ran = folder.morec(&args);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(
        ran.err.contains("person.bvh") && ran.err.contains("expected 59 joints"),
        "{}",
        ran.err
    );
}

#[test]
fn both_layouts_recognise_the_same() {
    let folder = folder();
    let svrdm = include_bytes!("../../../morec/testdata/index/svrdm_v1.index");
    std::fs::write(folder.path().join("svrdm.index"), svrdm).unwrap();
    let inline = folder
        .morec(&["recognize", "svrdm.index", "person.bvh"])
        .ok();
    let staged = folder
        .morec(&[
            "recognize",
            "svrdm.index",
            "person.bvh",
            "--layout",
            "stages",
        ])
        .ok();
    assert_eq!(staged, inline);
}
