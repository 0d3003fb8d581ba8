//! Serialised nearest matches of the classes in a stream: the result of one part of a divided index.

use crate::decode::{ClassDistance, FAR};

/// First bytes of [`ClassMatches::to_bytes`]: the name and the version.
const MAGIC: [u8; 4] = *b"MCM1";
/// Bytes of what stands before the ticks.
const HEADER_BYTES: usize = 12;
const MATCH_BYTES: usize = 18;
/// Rows of a template at most: nine hours of ticks.
const MAX_LONGEST: u32 = 1 << 20;

/// Nearest match of each class and nearest negative at each tick of a stream. Matches too far to matter to any
/// decision are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClassMatches {
    /// Rows of the longest template that was matched.
    longest: u32,
    /// Nearest negative at each tick.
    negatives: Vec<f32>,
    /// In order of ticks, then of classes.
    matches: Vec<ClassMatch>,
}

/// A class's nearest match at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ClassMatch {
    tick: u32,
    class: u16,
    found: ClassDistance,
}

/// Bytes that are no matches.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ClassMatchesError {
    /// The first bytes are others, or the length does not fit them.
    #[error("not matches of this version: {0}")]
    Format(&'static str),
    /// The parts are of streams of different lengths.
    #[error("matches of {first} ticks and of {other}: the parts belong to different streams")]
    Ticks {
        /// Of the first part.
        first: usize,
        /// Of another.
        other: usize,
    },
}

impl ClassMatches {
    /// No ticks, of templates of up to `longest` rows.
    pub fn new(longest: usize) -> Self {
        Self {
            longest: longest as u32,
            ..Self::default()
        }
    }

    /// Rows of the longest template that was matched.
    pub fn longest(&self) -> usize {
        self.longest as usize
    }

    /// Adds a tick.
    pub fn push(&mut self, near: &[ClassDistance], negative: f32, reach: f32) {
        let tick = self.negatives.len() as u32;
        self.negatives.push(negative);
        let kept = near
            .iter()
            .enumerate()
            .filter(|(_, n)| n.distance <= reach)
            .map(|(class, found)| ClassMatch {
                tick,
                class: class as u16,
                // Only the wider gate asks for it, and that one needs every match.
                found: ClassDistance {
                    rest_share: 0.0,
                    ..*found
                },
            });
        self.matches.extend(kept);
    }

    /// Number of ticks.
    pub fn ticks(&self) -> usize {
        self.negatives.len()
    }

    /// The matches of all parts of an index on the same stream. The nearest is taken where parts share a class.
    ///
    /// # Errors
    /// Parts of streams of different lengths.
    pub fn merge(parts: impl IntoIterator<Item = Self>) -> Result<Self, ClassMatchesError> {
        let mut parts = parts.into_iter();
        let mut all = parts.next().unwrap_or_default();
        for part in parts {
            if part.ticks() != all.ticks() {
                return Err(ClassMatchesError::Ticks {
                    first: all.ticks(),
                    other: part.ticks(),
                });
            }
            all.longest = all.longest.max(part.longest);
            for (mine, other) in all.negatives.iter_mut().zip(&part.negatives) {
                *mine = mine.min(*other);
            }
            all.matches.extend(part.matches);
        }
        all.matches.sort_by(|a, b| {
            let place = |m: &ClassMatch| (m.tick, m.class);
            place(a)
                .cmp(&place(b))
                .then(a.found.distance.total_cmp(&b.found.distance))
        });
        all.matches.dedup_by_key(|m| (m.tick, m.class));
        Ok(all)
    }

    /// For another machine: little-endian, 4 bytes a tick and 18 a match.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(self.longest.to_le_bytes());
        bytes.extend((self.negatives.len() as u32).to_le_bytes());
        bytes.extend(self.negatives.iter().flat_map(|n| n.to_le_bytes()));
        for ClassMatch { tick, class, found } in &self.matches {
            bytes.extend(tick.to_le_bytes());
            bytes.extend(class.to_le_bytes());
            bytes.extend(found.distance.to_le_bytes());
            bytes.extend((found.age as u32).to_le_bytes());
            bytes.extend(found.spread.to_le_bytes());
        }
        bytes
    }

    /// Matches from the bytes of [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// Bytes that are not those of `to_bytes`.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ClassMatchesError> {
        let (header, rest) = bytes
            .split_first_chunk::<HEADER_BYTES>()
            .filter(|(header, _)| header.starts_with(&MAGIC))
            .ok_or(ClassMatchesError::Format("other first bytes"))?;
        let number = |from: usize| u32::from_le_bytes([0, 1, 2, 3].map(|i| header[from + i]));
        let (longest, ticks) = (number(4), number(8));
        if longest > MAX_LONGEST {
            return Err(ClassMatchesError::Format("a template that is too long"));
        }
        let (negatives, matches) = (ticks as usize)
            .checked_mul(4)
            .and_then(|len| rest.split_at_checked(len))
            .ok_or(ClassMatchesError::Format("fewer ticks than stated"))?;
        let negatives = negatives.as_chunks().0;
        let (matches, over) = matches.as_chunks::<MATCH_BYTES>();
        if !over.is_empty() {
            return Err(ClassMatchesError::Format("an incomplete match"));
        }
        let matches: Vec<ClassMatch> = matches.iter().map(read_match).collect();
        let ordered = matches.is_sorted_by(|a, b| (a.tick, a.class) < (b.tick, b.class));
        if !ordered || matches.last().is_some_and(|m| m.tick >= ticks) {
            return Err(ClassMatchesError::Format("matches out of order"));
        }
        Ok(Self {
            longest,
            negatives: negatives.iter().map(|n| f32::from_le_bytes(*n)).collect(),
            matches,
        })
    }
}

fn read_match(bytes: &[u8; MATCH_BYTES]) -> ClassMatch {
    let four = |from: usize| [0, 1, 2, 3].map(|i| bytes[from + i]);
    ClassMatch {
        tick: u32::from_le_bytes(four(0)),
        class: u16::from_le_bytes([bytes[4], bytes[5]]),
        found: ClassDistance {
            distance: f32::from_le_bytes(four(6)),
            age: u32::from_le_bytes(four(10)) as usize,
            spread: f32::from_le_bytes(four(14)),
            ..ClassDistance::NONE
        },
    }
}

/// [`ClassMatches`] given out tick by tick.
#[derive(Debug, Clone)]
pub struct MatchReplay {
    matches: ClassMatches,
    /// Ticks given out, over all stretches.
    tick: usize,
    next: usize,
    near: Vec<ClassDistance>,
}

impl MatchReplay {
    /// Over `classes` classes.
    pub fn new(matches: ClassMatches, classes: usize) -> Self {
        Self {
            matches,
            tick: 0,
            next: 0,
            near: vec![ClassDistance::NONE; classes],
        }
    }

    /// The next tick's nearest match of each class, and nearest negative. Nothing is near after the last tick.
    pub fn step(&mut self) -> (&[ClassDistance], f32) {
        self.near.fill(ClassDistance::NONE);
        while let Some(found) = self.matches.matches.get(self.next)
            && found.tick as usize == self.tick
        {
            if let Some(near) = self.near.get_mut(usize::from(found.class)) {
                *near = found.found;
            }
            self.next += 1;
        }
        let negative = self.matches.negatives.get(self.tick).copied();
        self.tick += 1;
        (&self.near, negative.unwrap_or(FAR))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(distance: f32, age: usize) -> ClassDistance {
        ClassDistance {
            distance,
            age,
            spread: 0.5,
            rest_share: 0.0,
        }
    }

    fn kept() -> ClassMatches {
        let mut kept = ClassMatches::new(30);
        kept.push(&[near(1.0, 4), ClassDistance::NONE], 2.0, 9.5);
        kept.push(&[near(20.0, 5), near(0.5, 7)], FAR, 9.5);
        kept
    }

    #[test]
    fn bytes_hold_everything_and_broken_ones_are_refused() {
        let (kept, bytes) = (kept(), kept().to_bytes());
        assert_eq!(ClassMatches::from_bytes(&bytes).as_ref(), Ok(&kept));
        for cut in 0..bytes.len() {
            let read = ClassMatches::from_bytes(&bytes[..cut]);
            // A cut between matches leaves fewer of them.
            assert!(
                read.is_err() || (bytes.len() - cut) % MATCH_BYTES == 0,
                "{cut}"
            );
        }
        let mut late = bytes.clone();
        let last = bytes.len() - MATCH_BYTES;
        late[last] = 2;
        assert!(ClassMatches::from_bytes(&late).is_err());
    }

    #[test]
    fn parts_are_merged_by_the_nearest_and_far_ones_are_left_out() {
        let mut other = ClassMatches::new(40);
        other.push(&[near(0.75, 6), near(3.0, 9)], 1.5, 9.5);
        other.push(&[ClassDistance::NONE; 2], 4.0, 9.5);
        let merged = ClassMatches::merge([kept(), other.clone()]).unwrap();
        assert_eq!(merged.longest(), 40);
        let mut replay = MatchReplay::new(merged, 2);
        assert_eq!(replay.step(), (&[near(0.75, 6), near(3.0, 9)][..], 1.5));
        let far = [ClassDistance::NONE, near(0.5, 7)];
        assert_eq!(replay.step(), (&far[..], 4.0));
        assert_eq!(replay.step(), (&[ClassDistance::NONE; 2][..], FAR));
        other.push(&[ClassDistance::NONE; 2], 4.0, 9.5);
        assert!(ClassMatches::merge([kept(), other]).is_err());
    }
}
