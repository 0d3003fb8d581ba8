//! The table of clips: what is searched, sorted, selected.

use std::collections::BTreeSet;

use morec::roles::Role;
use morec_db::{ClipId, ClipInfo};

use super::Column;
use super::words::WordSearch;
use crate::jobs::words::SearchedState;

/// Key of the list of shown clips: snapshot, filter, order, the search by words that it shows.
type Order = (u64, String, Option<(Column, bool)>, Option<SearchedState>);

/// The library's own state.
#[derive(Default)]
pub struct Library {
    pub filter: String,
    /// What is known of the words of the filter.
    pub words: WordSearch,
    pub sort: Option<(Column, bool)>,
    /// The clips that are selected, all of them in the list.
    pub selected: Vec<ClipId>,
    /// True if somebody selected them in the list: keys act on no others. The clip that is shown is selected without that.
    pub chosen: bool,
    /// The pattern of names, once it was typed.
    pub pattern: Option<String>,
    /// Clips as strips of poses instead of a table.
    pub strips: bool,
    /// The part of the body whose joint is to be clicked.
    pub role: Option<Role>,
    /// Roles are given in the shown clip alone, not in all of its rig.
    pub roles_of_one: bool,
    /// Places of the clips that are shown, in the snapshot; computed when something changes.
    shown: Vec<usize>,
    computed_for: Option<Order>,
}

impl Library {
    /// The clips that somebody has selected: those that keys act on.
    pub fn chosen(&self) -> &[ClipId] {
        match self.chosen {
            true => &self.selected,
            false => &[],
        }
    }

    pub fn shown(&self) -> &[usize] {
        &self.shown
    }

    /// Filters and sorts anew if the clips, the filter or the order have changed.
    pub(super) fn refresh(&mut self, clips: &[ClipInfo], version: u64) {
        let found = self.words.of(self.filter.trim());
        let searched = found.map(|found| found.words.0);
        let wanted = (version, self.filter.clone(), self.sort, searched);
        if self.computed_for.as_ref() == Some(&wanted) {
            return;
        }
        let words: Vec<String> = self
            .filter
            .split_whitespace()
            .map(str::to_lowercase)
            .collect();
        let rank = |at: &usize| Some(*found?.ranks.get(&clips[*at].id)?);
        let is_wanted =
            |at: &usize| words.iter().all(|word| matches(&clips[*at], word)) || rank(at).is_some();
        self.shown = (0..clips.len()).filter(is_wanted).collect();
        if found.is_some() {
            self.shown.sort_by_key(|at| rank(at).unwrap_or(usize::MAX));
        }
        if let Some((column, down)) = self.sort {
            let key = |at: &usize| &clips[*at];
            match column {
                Column::Name => self.shown.sort_by(|a, b| key(a).name.cmp(&key(b).name)),
                Column::Length => self
                    .shown
                    .sort_by(|a, b| key(a).duration_secs().total_cmp(&key(b).duration_secs())),
                Column::Subject => self
                    .shown
                    .sort_by(|a, b| key(a).subject.cmp(&key(b).subject)),
                Column::Labels => self
                    .shown
                    .sort_by_key(|a| (key(a).samples, key(a).is_background())),
                Column::Found => {}
                Column::Format => self.shown.sort_by(|a, b| key(a).format.cmp(&key(b).format)),
            }
            if down {
                self.shown.reverse();
            }
        }
        // What is done to the selection is done to what is seen: clips that leave the list leave it, too.
        let shown: BTreeSet<ClipId> = self.shown.iter().map(|&at| clips[at].id).collect();
        self.selected.retain(|id| shown.contains(id));
        self.chosen &= !self.selected.is_empty();
        self.computed_for = Some(wanted);
    }
}

/// True if a word is in the clip's name, subject, format, source or tags.
fn matches(clip: &ClipInfo, word: &str) -> bool {
    let has = |text: &str| text.to_lowercase().contains(word);
    has(&clip.name)
        || has(&clip.format)
        || clip.subject.as_deref().is_some_and(has)
        || clip.source.as_deref().is_some_and(has)
        || clip.tags.iter().any(|tag| has(tag))
}
