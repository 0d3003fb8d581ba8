//! Search by words in the field that filters the list of clips.

use std::path::PathBuf;
use std::sync::Arc;

use morec_db::ClipId;
use morec_db::exchange::Caption;

use super::lines::ShownCommand;
use crate::jobs::JobOutcome;
use crate::jobs::words::{self, FoundWords};
use crate::state::State;

/// Name of the job that searches.
pub(in crate::state) const SEARCHING_WORDS: &str = "Searching by words";

impl State {
    /// Begins to search for the text of the field, unless that is done or under way.
    pub(super) fn search_words(&mut self) {
        let Some(store) = &self.store else { return };
        let known = &mut self.library.words;
        let text = self.library.filter.trim().to_owned();
        if text.is_empty() {
            known.asked = None;
            return;
        }
        let state = (store.version, known.captions.len());
        let wanted = Some((state, text.clone()));
        if known.asked == wanted {
            return;
        }
        known.asked = wanted;
        let (snapshot, captions) = (store.snapshot.clone(), known.captions.clone());
        let index = known.found.as_ref().map(|found| found.words.clone());
        let outcome = JobOutcome::Words;
        self.jobs
            .start(SEARCHING_WORDS, false, &self.wake, outcome, move |_| {
                Ok(words::find(text, state, index, (&snapshot, &captions)))
            });
    }

    /// Shows what was found, unless something else is searched for by now.
    pub(super) fn found_words(&mut self, found: FoundWords) {
        if found.text != self.library.filter.trim() {
            return;
        }
        let is_news = self.library.words.of(&found.text).is_none();
        self.library.words.found = Some(found);
        if is_news {
            self.show_words_line();
        }
    }

    /// The command that finds the same.
    fn show_words_line(&mut self) {
        let Some(store) = &self.store else { return };
        let line = ShownCommand::new("morec db search").word(store.path());
        let line = line.with("--words", self.library.filter.trim());
        let files = &self.library.words.caption_files;
        let line = files
            .iter()
            .fold(line, |line, file| line.with("--captions", file));
        self.show_line(line);
    }

    /// Reads captions, which are searched from then on.
    pub(super) fn read_captions(&mut self, paths: Vec<PathBuf>) {
        self.library.words.caption_files = paths.clone();
        self.show_words_line();
        self.jobs.start(
            "Reading captions",
            true,
            &self.wake,
            JobOutcome::Captions,
            move |_| words::read_captions(&paths),
        );
    }

    pub(super) fn captions_read(&mut self, captions: Vec<Caption>) {
        self.say(crate::format::count(captions.len(), "caption"));
        self.library.words.captions = Arc::new(captions);
    }

    /// Shows a clip of the list, where its words were found.
    pub(super) fn open_found(&mut self, clip: ClipId) {
        let found = self.library.words.of(self.library.filter.trim());
        let stretch = found.and_then(|found| found.stretch(clip));
        self.open_clip(clip, stretch);
    }
}
