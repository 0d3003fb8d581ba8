//! Search by words: names of classes, captions, tags, file names, sources and people.

mod synonyms;
mod tokens;

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::names_of_clip;

use crate::exchange::Caption;
use crate::labels::{DbSample, SampleFilter, SampleState};
use crate::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb};
use synonyms::synonyms_of;
use tokens::stems;

/// Where a word was found, in the order of weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WordPlace {
    /// The name of a class.
    Class,
    /// A caption.
    Caption,
    /// A tag of the clip.
    Tag,
    /// The clip's name or that of its file.
    Name,
    /// The clip's source or person.
    Source,
}

impl WordPlace {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Class => "class",
            Self::Caption => "caption",
            Self::Tag => "tag",
            Self::Name => "name",
            Self::Source => "source",
        }
    }

    fn weight(self) -> f64 {
        match self {
            Self::Class | Self::Caption => 1.0,
            Self::Tag => 0.9,
            Self::Name => 0.7,
            Self::Source => 0.5,
        }
    }
}

/// Weight of a synonym, and of a word that begins with the wanted one; the word itself has 1.
const SYNONYM: f64 = 0.8;
const BEGINNING: f64 = 0.6;
/// The fewest letters that are a beginning.
const LEAST_BEGINNING: usize = 3;
/// Weight of the clip's own words for a stretch of it.
const OF_THE_CLIP: f64 = 0.5;

/// A clip, or a stretch of one, that words describe.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct WordHit {
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Its name.
    #[serde(rename = "clip")]
    pub clip_name: String,
    /// The stretch; of a clip as a whole, all of it.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Share of the query that was found, 0 to 1: rare words count more, and so do classes and captions.
    pub score: f64,
    /// The class or the caption; of a clip as a whole, its tags.
    pub text: String,
    /// Where words of the query were found.
    pub places: BTreeSet<WordPlace>,
    /// True if every word of the query was found.
    #[serde(skip)]
    pub has_all: bool,
}

/// What was found of a query.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct WordHits {
    /// The best first.
    pub hits: Vec<WordHit>,
    /// Words of the query that nothing has, as they were typed.
    pub unknown: Vec<String>,
}

/// A clip, or a stretch of one, with its words.
#[derive(Debug)]
struct Described {
    clip: usize,
    /// The clip as a whole, not a stretch.
    whole: bool,
    span: TimeSpan,
    text: String,
    /// Stems with the weight that they have here.
    stems: BTreeMap<String, (f64, WordPlace)>,
}

/// The words of all clips and labels of a database, and of captions.
#[derive(Debug)]
pub struct WordIndex {
    clips: Vec<ClipInfo>,
    described: Vec<Described>,
    absent: usize,
}

impl WordIndex {
    /// Of a database and of captions beside it.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn of(db: &MotionDb, captions: &[Caption]) -> Result<Self, DbError> {
        let clips = db.clips(&ClipFilter::default())?;
        let samples = db.samples(&SampleFilter::default())?;
        Ok(Self::new(clips, &samples, captions))
    }

    /// Of clips, their samples and captions; samples that are rejected say nothing. O(words).
    pub fn new<'s>(
        clips: Vec<ClipInfo>,
        samples: impl IntoIterator<Item = &'s DbSample>,
        captions: &[Caption],
    ) -> Self {
        let mut index = Self {
            described: clips.iter().enumerate().map(of_clip).collect(),
            clips,
            absent: 0,
        };
        let by_id: BTreeMap<ClipId, usize> = index.clips.iter().map(|c| c.id).zip(0..).collect();
        for sample in samples {
            let known = by_id.get(&sample.clip);
            if let Some(clip) = known.filter(|_| sample.state != SampleState::Rejected) {
                index.add(*clip, sample.span(), &sample.class, WordPlace::Class);
            }
        }
        let by_name: BTreeMap<String, usize> = index
            .clips
            .iter()
            .map(|c| c.name.clone())
            .zip(0..)
            .collect();
        for caption in captions {
            match names_of_clip(&caption.clip).find_map(|name| by_name.get(name)) {
                Some(clip) => index.add_caption(*clip, caption),
                None => index.absent += 1,
            }
        }
        index
    }

    /// Captions of clips that the database does not have.
    pub fn absent(&self) -> usize {
        self.absent
    }

    fn add_caption(&mut self, clip: usize, caption: &Caption) {
        let whole = TimeSpan::new(0.0, self.clips[clip].duration_secs());
        let span = caption.span.unwrap_or(whole);
        self.add(clip, span, &caption.text, WordPlace::Caption);
    }

    /// A stretch with its own words, and with those of its clip.
    fn add(&mut self, clip: usize, span: TimeSpan, text: &str, place: WordPlace) {
        let mut described = Described {
            clip,
            whole: false,
            span,
            stems: BTreeMap::new(),
            text: text.to_owned(),
        };
        // Clips come first, in their order.
        for (stem, (weight, place)) in &self.described[clip].stems {
            let weight = OF_THE_CLIP * weight;
            described.stems.insert(stem.clone(), (weight, *place));
        }
        described.say(text, place);
        self.described.push(described);
    }

    /// What the words of `query` describe, `limit` hits at most. A word is found in its other forms, in synonyms, and where it begins
    /// another. O(stretches · words).
    pub fn find(&self, query: &str, limit: usize) -> WordHits {
        let wanted: BTreeSet<String> = stems(query).into_iter().collect();
        let wanted: Vec<WantedWord> = wanted.into_iter().map(WantedWord::new).collect();
        // Weights by stretch and word.
        let found: Vec<Vec<Option<(f64, WordPlace)>>> = (self.described.iter())
            .map(|d| wanted.iter().map(|word| word.weight_in(d)).collect())
            .collect();
        let rarity = |word: usize| {
            let having = found.iter().filter(|row| row[word].is_some()).count();
            (1.0 + self.described.len() as f64 / having.max(1) as f64).ln()
        };
        let rarities: Vec<f64> = (0..wanted.len()).map(rarity).collect();
        let sum: f64 = rarities.iter().sum();
        let mut hits: Vec<(bool, WordHit)> = (self.described.iter().zip(&found))
            .filter(|(_, row)| row.iter().any(Option::is_some))
            .map(|(described, row)| {
                let words = row.iter().zip(&rarities);
                let score = words.filter_map(|(found, rarity)| Some(found.as_ref()?.0 * rarity));
                let clip = &self.clips[described.clip];
                let hit = WordHit {
                    clip: clip.id,
                    clip_name: clip.name.clone(),
                    span: described.span,
                    score: score.sum::<f64>() / sum,
                    text: described.text.clone(),
                    places: row.iter().flatten().map(|(_, place)| *place).collect(),
                    has_all: row.iter().all(Option::is_some),
                };
                (described.whole, hit)
            })
            .collect();
        hits.sort_by(|(_, a), (_, b)| {
            let scores = b.score.total_cmp(&a.score);
            let names = scores.then_with(|| a.clip_name.cmp(&b.clip_name));
            names.then(a.span.start_secs.total_cmp(&b.span.start_secs))
        });
        let hits = self.without_repeats(hits).take(limit).collect();
        let is_known = |word: usize| found.iter().any(|row| row[word].is_some());
        let unknown = query.split_whitespace().filter(|typed| {
            let stems = stems(typed);
            let known = (0..).zip(&wanted).filter(|(_, w)| stems.contains(&w.stem));
            known.into_iter().any(|(word, _)| !is_known(word))
        });
        WordHits {
            hits,
            unknown: unknown.map(str::to_owned).collect(),
        }
    }

    /// Stretches whose own words were found, and clips of which no stretch is as good.
    fn without_repeats(&self, hits: Vec<(bool, WordHit)>) -> impl Iterator<Item = WordHit> {
        let own = |hit: &WordHit| {
            let mut places = hit.places.iter();
            places.any(|place| matches!(place, WordPlace::Class | WordPlace::Caption))
        };
        let mut best = BTreeMap::<ClipId, f64>::new();
        for (_, hit) in hits.iter().filter(|(whole, hit)| !whole && own(hit)) {
            let best = best.entry(hit.clip).or_default();
            *best = best.max(hit.score);
        }
        let kept = move |(whole, hit): (bool, WordHit)| {
            let is_kept = match whole {
                true => best.get(&hit.clip).is_none_or(|best| *best < hit.score),
                false => own(&hit),
            };
            is_kept.then_some(hit)
        };
        hits.into_iter().filter_map(kept)
    }
}

impl Described {
    /// Adds the words of `text`.
    fn say(&mut self, text: &str, place: WordPlace) {
        for stem in stems(text) {
            let said = self.stems.entry(stem).or_insert((0.0, place));
            if place.weight() > said.0 {
                *said = (place.weight(), place);
            }
        }
    }
}

/// A clip as a whole, with its tags, names, source and person.
fn of_clip((number, clip): (usize, &ClipInfo)) -> Described {
    let mut described = Described {
        clip: number,
        whole: true,
        span: TimeSpan::new(0.0, clip.duration_secs()),
        text: clip.tags.join(", "),
        stems: BTreeMap::new(),
    };
    let file = names_of_clip(&clip.path).last().unwrap_or_default();
    described.say(&clip.tags.join(" "), WordPlace::Tag);
    described.say(&format!("{} {file}", clip.name), WordPlace::Name);
    for text in [&clip.source, &clip.subject].into_iter().flatten() {
        described.say(text, WordPlace::Source);
    }
    described
}

/// A word of a query.
struct WantedWord {
    stem: String,
    /// Stems of the words that mean about the same.
    synonyms: Vec<String>,
}

impl WantedWord {
    fn new(stem: String) -> Self {
        Self {
            synonyms: synonyms_of(&stem),
            stem,
        }
    }

    /// The greatest weight that the word has in `described`, and the place of that word.
    fn weight_in(&self, described: &Described) -> Option<(f64, WordPlace)> {
        let said = described
            .stems
            .iter()
            .filter_map(|(stem, (weight, place))| {
                let is_beginning =
                    self.stem.len() >= LEAST_BEGINNING && stem.starts_with(self.stem.as_str());
                let share = if *stem == self.stem {
                    1.0
                } else if self.synonyms.contains(stem) {
                    SYNONYM
                } else if is_beginning {
                    BEGINNING
                } else {
                    return None;
                };
                Some((share * weight, *place))
            });
        said.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests;
