//! Search by words: the clips that the text of the search field describes, and why.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use morec_db::exchange::Caption;
use morec_db::{ClipId, WordHit, WordIndex, WordPlace};

use super::progress::JobError;
use crate::store::Snapshot;

/// What a search covered: the version of the database, and the number of captions read from files.
pub type SearchedState = (u64, usize);

/// An index of words, and what it covers.
pub type KnownWords = (SearchedState, Arc<WordIndex>);

/// Results of a search for a text.
pub struct FoundWords {
    pub text: String,
    pub words: KnownWords,
    /// Hits of each clip, the best first.
    pub hits: BTreeMap<ClipId, Vec<WordHit>>,
    /// Rank of each clip, from 0.
    pub ranks: BTreeMap<ClipId, usize>,
    /// True if the hits have every word of the text; if nothing has all of them, hits have some.
    pub has_all: bool,
    /// Words that nothing has.
    pub unknown: Vec<String>,
}

/// Finds what `text` describes; reads the words of the database unless `known` has them.
pub fn find(
    text: String,
    state: SearchedState,
    known: Option<KnownWords>,
    (snapshot, captions): (&Snapshot, &[Caption]),
) -> FoundWords {
    let known = known.filter(|(of, _)| *of == state);
    let words = known.unwrap_or_else(|| {
        let samples = snapshot.samples.iter().map(|s| &**s);
        let index = WordIndex::new(snapshot.clips.to_vec(), samples, captions);
        (state, Arc::new(index))
    });
    let mut found = words.1.find(&text, usize::MAX);
    let has_all = found.hits.iter().any(|hit| hit.has_all);
    found.hits.retain(|hit| hit.has_all || !has_all);
    let (mut hits, mut ranks) = (BTreeMap::<_, Vec<WordHit>>::new(), BTreeMap::new());
    for hit in found.hits {
        let rank = ranks.len();
        ranks.entry(hit.clip).or_insert(rank);
        hits.entry(hit.clip).or_default().push(hit);
    }
    FoundWords {
        text,
        words,
        hits,
        ranks,
        has_all,
        unknown: found.unknown,
    }
}

impl FoundWords {
    /// Why a clip was found: `class wave at 3.20 s, 4 more`.
    pub fn reason(&self, clip: ClipId) -> Option<String> {
        let hits = self.hits.get(&clip)?;
        let best = hits.first()?;
        let more = match hits.len() {
            1 => String::new(),
            n => format!(", {} more", n - 1),
        };
        if let Some(place) = own_place(best) {
            let at = crate::format::secs(best.span.start_secs);
            return Some(format!("{} {} at {at}{more}", place.name(), best.text));
        }
        let name = |place: &WordPlace| match place {
            WordPlace::Tag => format!("tag {}", best.text),
            other => other.name().to_owned(),
        };
        let places: Vec<String> = best.places.iter().map(name).collect();
        Some(format!("{}{more}", places.join(", ")))
    }

    /// The stretch that was found in a clip, seconds; `None` if its clip as a whole was.
    pub fn stretch(&self, clip: ClipId) -> Option<(f64, f64)> {
        let best = self.hits.get(&clip)?.first()?;
        own_place(best)?;
        Some((best.span.start_secs, best.span.stop_secs))
    }
}

/// Where the words of a stretch are: in its class or in a caption. A clip as a whole has neither.
fn own_place(hit: &WordHit) -> Option<WordPlace> {
    let mut places = hit.places.iter();
    let own = places.find(|place| matches!(place, WordPlace::Class | WordPlace::Caption));
    own.copied()
}

/// Reads captions of files.
pub fn read_captions(paths: &[PathBuf]) -> Result<Vec<Caption>, JobError> {
    let read = |path: &Path| {
        let name = crate::format::file_name(path);
        std::fs::read(path).map_err(|why| format!("{name}: {why}"))
    };
    morec_ops::captions_of(paths, &read).map_err(JobError::Failed)
}
