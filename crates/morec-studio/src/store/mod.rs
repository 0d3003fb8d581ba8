//! The database behind the window: one thread owns it, edits go there, snapshots come back.
//!
//! The window waits for the disk only when it closes the database: an edit is a value that is sent away; what the database
//! then holds arrives with a later frame. What another program changes arrives likewise, within a second.

mod edit;
mod message;
mod place;
mod snapshot;
#[cfg(test)]
mod tests;
mod worker;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use morec_db::DbError;

pub use edit::{BY, Edit, background};
pub use message::{StoreMessage, Wake};
pub use place::DbPlace;
pub use snapshot::{Snapshot, UNLIKELY};
pub use worker::{NewReport, sentence};
use worker::{Reply, Request};

/// An open database.
pub struct Store {
    place: DbPlace,
    /// True if it lies in a temporary folder, to be saved elsewhere.
    pub temporary: bool,
    requests: Sender<Request>,
    replies: Receiver<Reply>,
    /// The thread that owns the database; `None` where only drawing is measured.
    thread: Option<JoinHandle<()>>,
    pub snapshot: Arc<Snapshot>,
    /// Counts up with every new snapshot.
    pub version: u64,
    /// Edits that are under way.
    pending: usize,
}

impl Store {
    /// Opens a database, or makes one where there is none.
    pub fn open(place: DbPlace, temporary: bool, wake: Wake) -> Result<Self, DbError> {
        let (db, snapshot) = worker::open(&place)?;
        let worker = worker::start(db, snapshot.clone(), wake)?;
        Ok(Self {
            place,
            temporary,
            requests: worker.requests,
            replies: worker.replies,
            thread: Some(worker.thread),
            snapshot,
            version: 1,
            pending: 0,
        })
    }

    /// A database that is never written, for measuring how long drawing takes.
    #[cfg(feature = "measure")]
    pub fn of(snapshot: Snapshot) -> Self {
        let (requests, _) = channel();
        let (_, replies) = channel();
        Self {
            place: DbPlace {
                path: Path::new("measured.mdb").to_owned(),
                signature: String::new(),
            },
            temporary: false,
            requests,
            replies,
            thread: None,
            snapshot: Arc::new(snapshot),
            version: 1,
            pending: 0,
        }
    }

    pub fn path(&self) -> &Path {
        &self.place.path
    }

    /// For jobs that write.
    pub fn place(&self) -> DbPlace {
        self.place.clone()
    }

    /// Sends an edit to the database; `annotator` is who says what is new.
    pub fn edit(&mut self, edit: Edit, annotator: Option<String>) {
        let request = Request::Edit(edit, annotator);
        self.pending += usize::from(self.requests.send(request).is_ok());
    }

    /// Asks for a new snapshot: a job changed the database.
    pub fn reload(&mut self) {
        self.pending += usize::from(self.requests.send(Request::Reload).is_ok());
    }

    /// Keeps places of classes, which is no step of the history.
    pub fn place_classes(&mut self, places: BTreeMap<String, usize>) {
        self.pending += usize::from(self.requests.send(Request::Places(places)).is_ok());
    }

    /// Keeps the index that was trained last, which is no step of the history either.
    pub fn keep_last_index(&mut self, bytes: Vec<u8>) {
        self.pending += usize::from(self.requests.send(Request::LastIndex(bytes)).is_ok());
    }

    /// Keeps a report, which is no step of the history.
    pub fn keep_report(&mut self, new: NewReport) {
        self.pending += usize::from(self.requests.send(Request::Report(Box::new(new))).is_ok());
    }

    /// From now on the disk is full.
    #[cfg(test)]
    pub fn fill(&mut self) {
        self.pending += usize::from(self.requests.send(Request::Fill).is_ok());
    }

    /// Takes what has arrived.
    pub fn poll(&mut self) -> Vec<StoreMessage> {
        let mut said = Vec::new();
        while let Ok(reply) = self.replies.try_recv() {
            self.pending -= usize::from(reply.answers).min(self.pending);
            if let Some(snapshot) = reply.snapshot {
                self.snapshot = snapshot;
                self.version += 1;
            }
            said.extend(reply.said);
        }
        said
    }

    /// True while edits are under way.
    pub fn is_busy(&self) -> bool {
        self.pending > 0
    }
}

impl Drop for Store {
    /// Waits until the last edits are written: a program that ends takes its threads with it.
    fn drop(&mut self) {
        drop(std::mem::replace(&mut self.requests, channel().0));
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has said so.
            let _ = thread.join();
        }
    }
}
