//! A video in a program of its own, mpv, that follows the playhead: a thread tells it over JSON IPC where to be.

use std::fs::File;
use std::io::{BufRead, BufReader, Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::store::Wake;

/// The program answers its first call within this time.
const START: Duration = Duration::from_secs(15);
/// Polling intervals: while the program starts, opens a file or seeks, and while it is at the right place.
const SOON: Duration = Duration::from_millis(50);
const LATER: Duration = Duration::from_millis(500);
/// A video that plays may be this far from the playhead, seconds, before it is put there, which takes a moment.
const TOLERANCE_SECS: f64 = 0.1;
const BETWEEN_SEEKS: Duration = Duration::from_millis(300);
/// A video that lags by less after it was put somewhere lags because that takes so long: it is put ahead by this, seconds.
const MOST_LAG_SECS: f64 = 1.0;
/// A program that closes its connection has ended after this time.
const ENDING: Duration = Duration::from_secs(3);

/// Where a video should be.
#[derive(Debug, Clone, PartialEq)]
pub struct VideoMoment {
    pub file: String,
    /// Time of the video, seconds; below 0 before it begins.
    pub at_secs: f64,
    pub playing: bool,
    /// Below 0 backwards.
    pub speed: f64,
}

/// The program, which ends with this.
pub struct VideoPlayer {
    wanted: Sender<VideoMoment>,
    last: Option<VideoMoment>,
    ended: Receiver<Option<String>>,
    program: Arc<Mutex<Option<Child>>>,
}

impl VideoPlayer {
    /// Starts `program`, which is mpv, with a video. Returns at once; `wake` is called when the program has ended.
    pub fn start(program: &Path, first: VideoMoment, wake: Wake) -> Self {
        let (wanted, moments) = channel();
        let (ending, ended) = channel();
        let child = Arc::new(Mutex::new(None));
        let (theirs, program) = (child.clone(), program.to_owned());
        let file = first.file.clone();
        let work = move || {
            let socket = socket();
            let why = match local(&file) {
                Ok(path) => run(&program, &path, &socket, &theirs, |link| {
                    follow(link, &file, &moments)
                }),
                Err(why) => Some(format!("{file}: {why}")),
            };
            let _ = std::fs::remove_file(&socket);
            // The window may be gone by now.
            let _ = ending.send(why);
            wake();
        };
        // Without a thread the sender is dropped, which is an end like any other.
        let _ = std::thread::Builder::new()
            .name("video".to_owned())
            .spawn(work);
        let mut player = Self {
            wanted,
            last: None,
            ended,
            program: child,
        };
        player.follow(first);
        player
    }

    /// Brings the video to a moment.
    pub fn follow(&mut self, moment: VideoMoment) {
        if self.last.as_ref() != Some(&moment) {
            self.last = Some(moment.clone());
            // A program that has ended is noticed by `ended`.
            let _ = self.wanted.send(moment);
        }
    }

    /// Holds the video where it is.
    pub fn hold(&mut self) {
        if let Some(last) = self.last.clone().filter(|last| last.playing) {
            let playing = false;
            self.follow(VideoMoment { playing, ..last });
        }
    }

    /// Whether the program has ended: `Some(None)` if it was closed, else the reason in a sentence.
    pub fn ended(&self) -> Option<Option<String>> {
        match self.ended.try_recv() {
            Ok(why) => Some(why),
            Err(std::sync::mpsc::TryRecvError::Empty) => None,
            Err(_) => Some(Some("the video cannot be played: no thread".to_owned())),
        }
    }
}

impl Drop for VideoPlayer {
    fn drop(&mut self) {
        end(&self.program);
    }
}

fn end(program: &Mutex<Option<Child>>) {
    let child = program
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    if let Some(mut child) = child {
        // It may have ended by itself.
        let _ = child.kill();
        let _ = child.wait();
    }
}

/// A name for a socket that no other run has.
fn socket() -> PathBuf {
    static SOCKETS: AtomicU32 = AtomicU32::new(0);
    let number = SOCKETS.fetch_add(1, Ordering::Relaxed);
    let name = format!("morec-video-{}-{number}", std::process::id());
    match cfg!(windows) {
        true => PathBuf::from(format!(r"\\.\pipe\{name}")),
        false => std::env::temp_dir().join(name),
    }
}

/// The whole path of a file that is there: no name is taken for an address on the net.
fn local(file: &str) -> Result<PathBuf> {
    std::fs::metadata(file)?;
    std::path::absolute(file)
}

/// Runs the program until it ends or its [`VideoPlayer`] is dropped. Returns the reason if it failed.
fn run(
    program: &Path,
    file: &Path,
    socket: &Path,
    child: &Mutex<Option<Child>>,
    follow: impl FnOnce(PlayerLink) -> Result<()>,
) -> Option<String> {
    let mut option = std::ffi::OsString::from("--input-ipc-server=");
    option.push(socket);
    let started = Command::new(program)
        .arg(option)
        .args([
            "--pause",
            "--keep-open",
            "--keep-open-pause=no",
            "--force-window",
            "--no-terminal",
            "--",
        ])
        .arg(file)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    match started {
        Ok(started) => *child.lock().unwrap_or_else(PoisonError::into_inner) = Some(started),
        Err(why) if why.kind() == ErrorKind::NotFound => {
            return Some(
                "mpv is not installed: it plays videos beside clips (https://mpv.io)".to_owned(),
            );
        }
        Err(why) => return Some(format!("{}: {why}", program.display())),
    }
    // How it ended is said by the program.
    let _ = connect(socket, child).and_then(follow);
    let mut ended = child
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take()?;
    let begun = Instant::now();
    while begun.elapsed() < ENDING {
        match ended.try_wait() {
            Ok(None) => std::thread::sleep(SOON),
            Ok(Some(status)) if status.success() => return None,
            Ok(Some(status)) => {
                let file = file.display();
                return Some(format!("mpv cannot play {file}: it ended with {status}"));
            }
            Err(_) => break,
        }
    }
    let _ = ended.kill();
    let _ = ended.wait();
    Some("mpv does not answer: it was ended".to_owned())
}

/// Waits until the program listens.
fn connect(socket: &Path, child: &Mutex<Option<Child>>) -> Result<PlayerLink> {
    let begun = Instant::now();
    loop {
        match open(socket) {
            Ok(link) => return Ok(link),
            Err(why) if begun.elapsed() > START => return Err(why),
            Err(_) => std::thread::sleep(SOON),
        }
        let mut child = child.lock().unwrap_or_else(PoisonError::into_inner);
        let running = child.as_mut().map(Child::try_wait).transpose()?;
        if running.is_none_or(|status| status.is_some()) {
            return Err(ErrorKind::BrokenPipe.into());
        }
    }
}

#[cfg(unix)]
fn open(socket: &Path) -> Result<PlayerLink> {
    use std::os::fd::OwnedFd;
    let stream = std::os::unix::net::UnixStream::connect(socket)?;
    stream.set_read_timeout(Some(START))?;
    let reader = File::from(OwnedFd::from(stream.try_clone()?));
    Ok(PlayerLink::new(reader, File::from(OwnedFd::from(stream))))
}

#[cfg(not(unix))]
fn open(socket: &Path) -> Result<PlayerLink> {
    let pipe = File::options().read(true).write(true).open(socket)?;
    Ok(PlayerLink::new(pipe.try_clone()?, pipe))
}

/// The connection to the program. One thread writes a request and then reads its answer: on Windows, a pipe cannot be written to while
/// another thread reads from it.
struct PlayerLink {
    reader: BufReader<File>,
    writer: File,
    asked: u64,
}

impl PlayerLink {
    fn new(reader: File, writer: File) -> Self {
        Self {
            reader: BufReader::new(reader),
            writer,
            asked: 0,
        }
    }

    /// Sends a command; gives its data, `None` if the program refuses it.
    fn ask(&mut self, command: Value) -> Result<Option<Value>> {
        self.asked += 1;
        let line = format!(
            "{}\n",
            json!({"command": command, "request_id": self.asked})
        );
        self.writer.write_all(line.as_bytes())?;
        let mut line = Vec::new();
        loop {
            line.clear();
            if self.reader.read_until(b'\n', &mut line)? == 0 {
                return Err(Error::from(ErrorKind::UnexpectedEof));
            }
            // Events come in between.
            let mut said: Value = serde_json::from_slice(&line).unwrap_or_default();
            if said["request_id"] == self.asked {
                let data = said["data"].take();
                return Ok((said["error"] == "success").then_some(data));
            }
        }
    }
}

/// What the program was told.
struct LastTold {
    file: String,
    speed: f64,
    /// Whether it plays; `None` before it was told.
    playing: Option<bool>,
    /// The place of a video that stands still.
    still_secs: Option<f64>,
    /// When it was put somewhere last, and how far ahead of the playhead that is done, seconds.
    seek: Instant,
    ahead_secs: f64,
}

/// Brings the program to each moment. Returns when its [`VideoPlayer`] is dropped; an error means that the program has ended.
fn follow(mut link: PlayerLink, file: &str, moments: &Receiver<VideoMoment>) -> Result<()> {
    let mut told = LastTold {
        file: file.to_owned(),
        speed: 1.0,
        playing: None,
        still_secs: None,
        seek: Instant::now(),
        ahead_secs: 0.0,
    };
    let mut wanted: Option<VideoMoment> = None;
    let mut wait = SOON;
    loop {
        match moments.recv_timeout(wait) {
            // The last that has come counts.
            Ok(moment) => wanted = Some(moments.try_iter().last().unwrap_or(moment)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if let Some(moment) = &wanted {
            wait = match bring(&mut link, &mut told, moment)? {
                true => LATER,
                false => SOON,
            };
        }
    }
}

/// Brings the program to a moment; false while it cannot be.
fn bring(link: &mut PlayerLink, told: &mut LastTold, moment: &VideoMoment) -> Result<bool> {
    if told.file != moment.file {
        if let Ok(path) = local(&moment.file) {
            link.ask(json!(["loadfile", path.to_string_lossy()]))?;
        }
        told.file.clone_from(&moment.file);
        told.still_secs = None;
        return Ok(false);
    }
    // A file that is not open yet has no place.
    let place = link.ask(json!(["get_property", "time-pos"]))?;
    let Some(place) = place.and_then(|place| place.as_f64()) else {
        return Ok(false);
    };
    // Backwards, and before its beginning, a video is put from place to place.
    let playing = moment.playing && moment.speed > 0.0 && moment.at_secs >= 0.0;
    if playing && told.speed != moment.speed {
        link.ask(json!(["set_property", "speed", moment.speed]))?;
        told.speed = moment.speed;
    }
    if told.playing != Some(playing) {
        link.ask(json!(["set_property", "pause", !playing]))?;
        told.playing = Some(playing);
    }
    let at = moment.at_secs.max(0.0);
    let behind = at - place;
    let is_there = match playing {
        true => behind.abs() <= TOLERANCE_SECS * moment.speed.max(1.0),
        false => told.still_secs == Some(at),
    };
    if is_there || (playing && told.seek.elapsed() < BETWEEN_SEEKS) {
        return Ok(true);
    }
    let mut goal = at;
    if playing {
        if behind.abs() < MOST_LAG_SECS * moment.speed {
            let ahead = told.ahead_secs + behind / moment.speed;
            told.ahead_secs = ahead.clamp(0.0, MOST_LAG_SECS);
        }
        goal += told.ahead_secs * moment.speed;
    }
    let sought = link.ask(json!(["seek", goal, "absolute+exact"]))?.is_some();
    told.seek = Instant::now();
    told.still_secs = (!playing && sought).then_some(at);
    Ok(sought)
}
