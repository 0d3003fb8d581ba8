//! Messages to the page: countdowns, classes, motions and faults of the stream, shown large over the picture.

use std::net::TcpStream;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde_json::json;
use tungstenite::protocol::Role;
use tungstenite::{Message, WebSocket};

use crate::{NamedEvent, Sink};

/// Sends countdowns, classes, recognised motions and faults of the stream to the browser tabs that show the page of `webcam`.
/// Clones send to the same tabs. As a [`Sink`], it sends recognised motions.
///
/// A tab that accepts no data for two seconds receives no further messages.
#[derive(Clone, Default)]
pub struct WebcamPage(Arc<Mutex<Told>>);

#[derive(Default)]
struct Told {
    /// Tabs by the number of their connection.
    tabs: Vec<(u64, WebSocket<TcpStream>)>,
    /// Messages about what lasts, which a new tab gets: classes, text, problems.
    lasting: [Option<String>; 3],
}

impl Told {
    fn send(&mut self, message: &str) {
        self.tabs
            .retain_mut(|(_, tab)| tab.send(Message::text(message)).is_ok());
    }

    /// Sends the message of the lasting kind `kind`, if it differs from the one before.
    fn keep(&mut self, kind: usize, message: String) {
        if self.lasting[kind].as_ref() != Some(&message) {
            self.send(&message);
            self.lasting[kind] = Some(message);
        }
    }
}

impl WebcamPage {
    fn lock(&self) -> MutexGuard<'_, Told> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows a bar for each of these classes.
    pub fn classes<'a>(&self, names: impl IntoIterator<Item = &'a str>) {
        let names: Vec<&str> = names.into_iter().collect();
        let message = json!({"type": "classes", "names": names}).to_string();
        self.lock().keep(0, message);
    }

    /// Shows this text large, in place of what was recognised, until an empty text.
    pub fn say(&self, text: &str) {
        let message = json!({"type": "say", "text": text}).to_string();
        self.lock().keep(1, message);
    }

    /// Shows what is wrong with the stream, a sentence each, in place of what was shown before.
    pub fn problems(&self, sentences: &[String]) {
        let message = json!({"type": "problems", "sentences": sentences}).to_string();
        self.lock().keep(2, message);
    }

    /// Adds a tab whose WebSocket has been opened over `stream`.
    pub(super) fn add(&self, number: u64, stream: TcpStream) {
        let mut told = self.lock();
        let mut tab = WebSocket::from_raw_socket(stream, Role::Server, None);
        let known = told.lasting.iter().flatten();
        if known
            .cloned()
            .all(|text| tab.send(Message::text(text)).is_ok())
        {
            told.tabs.push((number, tab));
        }
    }

    pub(super) fn remove(&self, number: u64) {
        self.lock().tabs.retain(|(other, _)| *other != number);
    }
}

impl Sink for WebcamPage {
    fn emit(&mut self, event: &NamedEvent<'_>) -> std::io::Result<()> {
        self.lock().send(&event.json());
        Ok(())
    }
}
