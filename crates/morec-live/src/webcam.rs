//! The camera of this machine: a page in the browser finds poses in its picture and sends them as lines of JSON over a WebSocket.
//!
//! The page is served here, and so are MediaPipe's files, from a folder that the user names. Nobody but this machine is answered.
//! What the performer should know goes back to the page ([`WebcamPage`]).

mod told;

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::{Duration, Instant};

use tungstenite::Message;

use crate::json::JsonSource;
use crate::lines::{Came, LONGEST, Lines, SILENCE};
use crate::websocket::greet::{Manners, PATIENCE, greet};
use crate::{Address, LiveError, Notices};
pub use told::WebcamPage;

/// The page's own files: path, type, content.
const PAGE: [(&str, &str, &str); 8] = [
    ("/", "text/html", include_str!("webcam/index.html")),
    (
        "/page.js",
        "text/javascript",
        include_str!("webcam/page.js"),
    ),
    (
        "/camera.js",
        "text/javascript",
        include_str!("webcam/camera.js"),
    ),
    (
        "/mediapipe.js",
        "text/javascript",
        include_str!("webcam/mediapipe.js"),
    ),
    (
        "/nearness.js",
        "text/javascript",
        include_str!("webcam/nearness.js"),
    ),
    ("/stage.css", "text/css", include_str!("webcam/stage.css")),
    (
        "/stage.js",
        "text/javascript",
        include_str!("webcam/stage.js"),
    ),
    (
        "/words.js",
        "text/javascript",
        include_str!("webcam/words.js"),
    ),
];
/// Where the page finds MediaPipe's files.
const MEDIAPIPE: &str = "/mediapipe/";
/// The files by which a folder is known to have them: for bodies, for hands, for either by a model beside them.
const KNOWN_BY: [&str; 3] = ["pose.js", "hands.js", "vision_bundle.mjs"];
/// What the page tracks, as its list says; the first, unless the folder has nothing but hands.
const TRACKED: [&str; 3] = ["body", "hand", "hands"];
/// Requests of browsers are shorter.
const LARGEST_HEAD: usize = 1 << 13;

/// Opens `webcam` (a free port of this machine) or `webcam://HOST:PORT`. Returns where the page is, and what it is told by, too.
///
/// # Errors
/// No folder with MediaPipe's files, another machine's address, a port that is taken.
pub fn webcam(
    address: &Address,
    mediapipe: Option<&Path>,
) -> Result<(JsonSource, SocketAddr, WebcamPage), LiveError> {
    address.allow(&["mediapipe", "track"])?;
    let at = address.socket()?;
    if !at.ip().is_loopback() {
        return Err(LiveError::Address(format!(
            "{address}: browsers allow the camera only for pages from this machine: use an address such as \
             webcam://127.0.0.1:8000"
        )));
    }
    let named = address.text("mediapipe").map(Path::new);
    let folder = with_mediapipe(named.or(mediapipe))?;
    let tracked = tracked(address, &folder)?;
    let (notices, page) = (Notices::default(), WebcamPage::default());
    let told = page.clone();
    let attend = move |number, stream, sender: &SyncSender<Came>| {
        // A connection that is closed in the middle is no fault.
        let _ = answer(number, stream, sender, &folder, tracked, &told);
    };
    let (lines, at) = Lines::serve(at, &notices, Arc::new(attend))?;
    Ok((JsonSource::of_connections(lines, notices), at, page))
}

fn with_mediapipe(folder: Option<&Path>) -> Result<PathBuf, LiveError> {
    const HOW: &str = "the page needs MediaPipe's files, which are not part of morec: download mediapipe-pose-….tgz with `npm \
        pack @mediapipe/pose` (or `@mediapipe/hands`), unpack it with `tar xzf` into the folder `package`, and give `--mediapipe \
        package` or webcam?mediapipe=package";
    match folder {
        Some(folder) if KNOWN_BY.iter().any(|name| folder.join(name).is_file()) => {
            Ok(folder.to_owned())
        }
        Some(folder) => Err(LiveError::Address(format!(
            "{} has no {}: {HOW}",
            folder.display(),
            KNOWN_BY.join(", no ")
        ))),
        None => Err(LiveError::Address(format!("webcam: {HOW}"))),
    }
}

/// What the page tracks: what the address says, or what the folder has the files of.
fn tracked(address: &Address, folder: &Path) -> Result<&'static str, LiveError> {
    if let Some(asked) = address.text("track") {
        let known = TRACKED.into_iter().find(|known| *known == asked);
        return known.ok_or_else(|| {
            LiveError::Address(format!(
                "{address}: track is {}, not `{asked}`",
                TRACKED.join(", ")
            ))
        });
    }
    let has = |name: &str| folder.join(name).is_file();
    let models = ["full", "heavy", "lite"].map(|size| format!("pose_landmarker_{size}.task"));
    let body = has(KNOWN_BY[0]) || models.iter().any(|model| has(model));
    let hands = has(KNOWN_BY[1]) || has("hand_landmarker.task");
    Ok(TRACKED[usize::from(hands && !body)])
}

/// Serves one connection: a file, or lines over a WebSocket until it ends.
fn answer(
    number: u64,
    mut stream: TcpStream,
    sender: &SyncSender<Came>,
    folder: &Path,
    tracked: &str,
    page: &WebcamPage,
) -> std::io::Result<()> {
    let Some(head) = head_of(&stream)? else {
        return Ok(());
    };
    if head.to_ascii_lowercase().contains("\nupgrade: websocket") {
        take_lines(number, stream, sender, page);
        return Ok(());
    }
    // What is left unread would reset the connection and what was written on it.
    stream.read_exact(&mut vec![0; head.len()])?;
    let asked = head.strip_prefix("GET ").unwrap_or_default();
    let path = asked.split([' ', '?']).next().unwrap_or_default();
    let (status, kind, content) = match file_at(path, folder, tracked) {
        Some((kind, content)) => ("200 OK", kind, content),
        None => ("404 Not Found", "text/plain", b"no such file".to_vec()),
    };
    let length = content.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    )?;
    stream.write_all(&content)
}

/// The head of a request, which stays unread: a WebSocket's handshake begins with it. `None` if it does not come whole in time.
fn head_of(stream: &TcpStream) -> std::io::Result<Option<String>> {
    let until = Instant::now() + PATIENCE;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut bytes = vec![0; LARGEST_HEAD];
    loop {
        let count = stream.peek(&mut bytes)?;
        let head = String::from_utf8_lossy(&bytes[..count]);
        if let Some(end) = head.find("\r\n\r\n") {
            return Ok(head.is_ascii().then(|| head[..end + 4].to_owned()));
        }
        if count == 0 || count == LARGEST_HEAD || Instant::now() > until {
            return Ok(None);
        }
        // The rest is on its way.
        thread::sleep(Duration::from_millis(5));
    }
}

/// Type and content of a file of the page or of MediaPipe.
fn file_at(path: &str, folder: &Path, tracked: &str) -> Option<(&'static str, Vec<u8>)> {
    if let Some((_, kind, content)) = PAGE.iter().find(|(known, ..)| *known == path) {
        let content = content.replace("data-track=\"body\"", &format!("data-track=\"{tracked}\""));
        return Some((kind, content.into_bytes()));
    }
    let name = path.strip_prefix(MEDIAPIPE)?;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    // `wasm` is the one folder within MediaPipe's.
    let file = name.strip_prefix("wasm/").unwrap_or(name);
    if file.starts_with('.') || !file.chars().all(is_plain) {
        return None;
    }
    let kind = match name.rsplit('.').next() {
        Some("js" | "mjs") => "text/javascript",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    };
    Some((kind, std::fs::read(folder.join(name)).ok()?))
}

/// Lines from a page of this machine, each a text message.
fn take_lines(number: u64, stream: TcpStream, sender: &SyncSender<Came>, page: &WebcamPage) {
    let manners = Manners {
        largest: LONGEST as usize,
        wait: SILENCE,
    };
    let Ok(back) = stream.try_clone() else {
        return;
    };
    let Some(mut socket) = greet(stream, None, manners) else {
        return;
    };
    page.add(number, back);
    let mut lines = 0;
    while let Ok(message) = socket.read() {
        let Message::Text(text) = message else {
            continue;
        };
        lines += 1;
        let came = Came::Line {
            connection: number,
            number: lines,
            text: Some(text.as_str().to_owned()),
        };
        if sender.send(came).is_err() {
            break;
        }
    }
    page.remove(number);
    // A dropped receiver is no fault.
    let _ = sender.send(Came::Closed(number));
}

#[cfg(test)]
mod tests;
