//! Search by words: captions beside the database, and what was found.

use std::path::PathBuf;
use std::sync::Arc;

use morec_db::exchange::Caption;

use crate::jobs::words::{FoundWords, SearchedState};

/// What is known of words.
#[derive(Default)]
pub struct WordSearch {
    /// Captions of files that are searched beside the database, and the files.
    pub captions: Arc<Vec<Caption>>,
    pub caption_files: Vec<PathBuf>,
    /// What was found last.
    pub found: Option<FoundWords>,
    /// The search that was begun last.
    pub(super) asked: Option<(SearchedState, String)>,
}

impl WordSearch {
    /// What was found of a text; nothing of another one.
    pub fn of(&self, text: &str) -> Option<&FoundWords> {
        let found = self.found.as_ref()?;
        (found.text == text && !text.is_empty()).then_some(found)
    }

    /// Captions of clips that the database does not have.
    pub fn absent(&self) -> usize {
        let found = self.found.as_ref();
        found.map_or(0, |found| found.words.1.absent())
    }
}
