//! The thread that owns the database.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use morec_db::{DbError, MotionDb, ReportKind};

use super::{DbPlace, Edit, Snapshot, StoreMessage, Wake};

/// Interval between looks at whether another program changed the database.
const LOOK: Duration = Duration::from_secs(1);

/// Name in the database of the index that was trained last.
const LAST_INDEX: &str = "last";

pub enum Request {
    /// An edit, and who says what is new.
    Edit(Edit, Option<String>),
    Reload,
    Places(BTreeMap<String, usize>),
    LastIndex(Vec<u8>),
    Report(Box<NewReport>),
    /// The file grows no further: what a full disk looks like.
    #[cfg(test)]
    Fill,
}

/// A report to keep.
pub struct NewReport {
    pub kind: ReportKind,
    pub title: String,
    pub report: serde_json::Value,
}

pub struct Reply {
    pub snapshot: Option<Arc<Snapshot>>,
    pub said: Option<StoreMessage>,
    /// True if it answers a request.
    pub answers: bool,
}

pub fn open(place: &DbPlace) -> Result<(MotionDb, Arc<Snapshot>), DbError> {
    let mut db = match place.path.exists() {
        true => MotionDb::open(&place.path)?,
        false => MotionDb::create(&place.path)?,
    };
    db.set_program(&place.signature);
    let snapshot = Arc::new(Snapshot::read(&db)?);
    Ok((db, snapshot))
}

/// The running thread, with the channels to and from it.
pub struct Running {
    pub requests: Sender<Request>,
    pub replies: Receiver<Reply>,
    pub thread: JoinHandle<()>,
}

/// Starts the thread. It ends when `requests` is dropped and everything that was sent is written.
pub fn start(db: MotionDb, last: Arc<Snapshot>, wake: Wake) -> Result<Running, DbError> {
    let (requests, incoming) = channel();
    let (outgoing, replies) = channel();
    let mut worker = StoreWorker {
        seen: mark(&db),
        db,
        last,
        outgoing,
        wake,
    };
    let job = move || worker.run(&incoming);
    let thread = std::thread::Builder::new()
        .name("database".to_owned())
        .spawn(job)
        .map_err(|error| DbError::Disk(format!("no thread can be started: {error}")))?;
    Ok(Running {
        requests,
        replies,
        thread,
    })
}

struct StoreWorker {
    db: MotionDb,
    /// The database after the last request; empty if it could not be read.
    last: Arc<Snapshot>,
    /// The last step and how many were taken back, by which changes from elsewhere are noticed.
    seen: Option<(i64, i64)>,
    outgoing: Sender<Reply>,
    wake: Wake,
}

fn mark(db: &MotionDb) -> Option<(i64, i64)> {
    let step = db.last_step().ok()??;
    Some((step.id, step.set_secs))
}

impl StoreWorker {
    fn run(&mut self, incoming: &Receiver<Request>) {
        loop {
            let (said, answers) = match incoming.recv_timeout(LOOK) {
                Ok(Request::Edit(edit, annotator)) => {
                    let said = match edit.apply(&mut self.db, annotator.as_deref()) {
                        Ok(done) => StoreMessage::Done(done),
                        Err(error) => StoreMessage::Failed(sentence(&error.to_string())),
                    };
                    (Some(said), true)
                }
                Ok(Request::Reload) => (None, true),
                Ok(Request::Places(places)) => (failure(self.db.place_classes(&places)), true),
                Ok(Request::LastIndex(bytes)) => {
                    let kept = self.db.store_last_index(LAST_INDEX, &bytes);
                    // No step of the history says what to read.
                    self.last = Arc::default();
                    (failure(kept), true)
                }
                Ok(Request::Report(new)) => {
                    let kept = self.db.keep_report(new.kind, &new.title, &new.report);
                    (failure(kept.map(|_| ())), true)
                }
                #[cfg(test)]
                Ok(Request::Fill) => (failure(self.db.limit_bytes(0)), true),
                Err(RecvTimeoutError::Timeout) => {
                    if mark(&self.db) == self.seen {
                        continue;
                    }
                    (None, false)
                }
                Err(RecvTimeoutError::Disconnected) => return,
            };
            self.reply(said, answers);
        }
    }

    /// Sends a new snapshot.
    fn reply(&mut self, mut said: Option<StoreMessage>, answers: bool) {
        self.seen = mark(&self.db);
        let next = self.last.follow(&self.db).map(Arc::new);
        self.last = next.as_ref().map(Arc::clone).unwrap_or_default();
        let snapshot = match next {
            Ok(snapshot) => Some(snapshot),
            Err(error) => {
                said = Some(StoreMessage::Failed(sentence(&error.to_string())));
                None
            }
        };
        let reply = Reply {
            snapshot,
            said,
            answers,
        };
        // The window may be closed while its last edits are still written.
        let _ = self.outgoing.send(reply);
        (self.wake)();
    }
}

/// The message of what is only reported if it fails.
fn failure(done: Result<(), DbError>) -> Option<StoreMessage> {
    let error = done.err()?;
    Some(StoreMessage::Failed(sentence(&error.to_string())))
}

/// An error as a sentence: with a capital, without a full stop. A name that it begins with (`moves.mdb: …`) stays as it is.
pub fn sentence(text: &str) -> String {
    let first = text.split(' ').next().unwrap_or_default();
    if first.ends_with(':') {
        return text.to_owned();
    }
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
