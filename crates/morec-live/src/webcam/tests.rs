use morec::live::{Frame, Source, SourceEvent};
use morec::roles::Role;
use tungstenite::client::IntoClientRequest;

use super::*;

/// A folder as if MediaPipe were in it, removed in the end.
struct UnpackedFiles(PathBuf);

impl UnpackedFiles {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("morec-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(KNOWN_BY[0]), "let pose;").unwrap();
        Self(folder)
    }
}

impl Drop for UnpackedFiles {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn opened(folder: &UnpackedFiles) -> (JsonSource, SocketAddr, WebcamPage) {
    webcam(&"webcam".parse().unwrap(), Some(&folder.0)).unwrap()
}

fn get(at: SocketAddr, path: &str) -> String {
    let mut stream = TcpStream::connect(at).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {at}\r\n\r\n").unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    text
}

#[test]
fn the_page_and_mediapipe_are_served_and_nothing_else_is() {
    let folder = UnpackedFiles::new("served");
    let (_source, at, _page) = opened(&folder);
    for (path, holds) in [
        ("/", "page.js"),
        ("/page.js", "camera.js"),
        ("/camera.js?1", "landmarks"),
        ("/mediapipe.js", "Handedness"),
        ("/nearness.js", "nearly"),
        ("/stage.css", "#large"),
        ("/stage.js", "class Stage"),
        ("/words.js", "NotAllowedError"),
        ("/mediapipe/pose.js", "let pose;"),
    ] {
        let text = get(at, path);
        assert!(
            text.starts_with("HTTP/1.1 200 ") && text.contains(holds),
            "{path}: {text}"
        );
    }
    std::fs::write(folder.0.join(".hidden"), "secret").unwrap();
    for path in [
        "/no",
        "/mediapipe/",
        "/mediapipe/../pose.js",
        "/mediapipe/.hidden",
        "/mediapipe/absent.js",
        "pose.js",
    ] {
        assert!(get(at, path).starts_with("HTTP/1.1 404 "), "{path}");
    }
    // What is no request ends the connection.
    let mut stream = TcpStream::connect(at).unwrap();
    stream.write_all(b"\xff\xff\r\n\r\n").unwrap();
    let mut rest = Vec::new();
    let _ = stream.read_to_end(&mut rest);
    assert!(rest.is_empty());
}

#[test]
fn poses_come_over_a_websocket_from_pages_of_this_machine_only() {
    let folder = UnpackedFiles::new("poses");
    let (mut source, at, _page) = opened(&folder);
    let of_page = |origin: &str| {
        let mut request = format!("ws://{at}/poses").into_client_request().unwrap();
        request
            .headers_mut()
            .insert("Origin", origin.parse().unwrap());
        tungstenite::connect(request)
    };
    assert!(of_page("https://example.org").is_err());
    let (mut socket, _) = of_page(&format!("http://{at}")).unwrap();
    socket.send(Message::text("hello?")).unwrap();
    for t in 0..5 {
        let line = format!("{{\"t\": {t}, \"positions\": {{\"left_hand\": [{t}, 1, 0]}}}}");
        socket.send(Message::text(line)).unwrap();
    }
    socket.close(None).unwrap();
    let (mut frame, mut seen) = (Frame::default(), Vec::new());
    loop {
        match source.next(&mut frame) {
            SourceEvent::Frame => {
                seen.push((
                    frame.time_secs,
                    frame.pose.positions[Role::LeftHand.index()].x,
                ));
            }
            SourceEvent::Gone(_) => break,
            _ => {}
        }
    }
    assert_eq!(seen, [0.0, 1.0, 2.0, 3.0, 4.0].map(|t| (t, t)));
    assert_eq!(source.counts().malformed, 1);
}

#[test]
fn a_tab_is_told_what_lasts_and_then_what_is_new() {
    let folder = UnpackedFiles::new("told");
    let (mut source, at, page) = opened(&folder);
    page.classes(["wave", "bow"]);
    page.say("3");
    page.say("2");
    let (mut socket, _) = tungstenite::connect(format!("ws://{at}/poses")).unwrap();
    let mut heard = || {
        let text = socket.read().unwrap().into_text().unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    };
    assert_eq!(heard()["names"], serde_json::json!(["wave", "bow"]));
    assert_eq!(heard()["text"], "2");
    // Between these two it is added, and nothing is said twice.
    let problem = ["The hips are never seen.".to_owned()];
    page.problems(&problem);
    page.problems(&problem);
    page.say("");
    assert_eq!(heard()["sentences"][0], "The hips are never seen.");
    assert_eq!(heard(), serde_json::json!({"type": "say", "text": ""}));
    socket.close(None).unwrap();
    let mut frame = Frame::default();
    while socket.read().is_ok() {}
    // A tab that was closed is forgotten, and no fault.
    assert!(matches!(source.next(&mut frame), SourceEvent::Quiet));
    page.say("1");
}

#[test]
fn what_is_missing_is_said() {
    let said = |address: &str, folder: Option<&Path>| {
        webcam(&address.parse().unwrap(), folder)
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    assert!(said("webcam", None).contains("--mediapipe package"));
    let empty = std::env::temp_dir().join("morec-no-such-folder");
    assert!(said("webcam", Some(&empty)).contains("has no pose.js"));
    let folder = UnpackedFiles::new("missing");
    let elsewhere = said("webcam://192.0.2.1:80", Some(&folder.0));
    assert!(elsewhere.contains("pages from this machine"), "{elsewhere}");
    assert!(said("webcam://127.0.0.1:0?loop", Some(&folder.0)).contains("no option loop"));
    let named = format!("webcam?mediapipe={}", folder.0.display());
    assert!(webcam(&named.parse().unwrap(), None).is_ok());
}

#[test]
fn the_page_tracks_what_is_asked_for_or_what_the_folder_has_files_of() {
    let folder = UnpackedFiles::new("tracked");
    let page_of = |address: &str| {
        let (_source, at, _page) = webcam(&address.parse().unwrap(), Some(&folder.0)).unwrap();
        get(at, "/")
    };
    assert!(page_of("webcam").contains("<body data-track=\"body\">"));
    assert!(page_of("webcam?track=hands").contains("<body data-track=\"hands\">"));
    std::fs::rename(folder.0.join("pose.js"), folder.0.join("hands.js")).unwrap();
    assert!(page_of("webcam").contains("<body data-track=\"hand\">"));
    std::fs::write(folder.0.join("pose_landmarker_lite.task"), "model").unwrap();
    assert!(page_of("webcam").contains("<body data-track=\"body\">"));
    let wrong = webcam(&"webcam?track=feet".parse().unwrap(), Some(&folder.0)).map(|_| ());
    assert!(wrong.unwrap_err().to_string().contains("body, hand, hands"));
}
