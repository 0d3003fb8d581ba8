//! Mirrored copies of samples: used as samples of the other side, or as negative examples.

use crate::classes::ClassId;
use crate::features::{BoneSet, mirrored_rows};

use super::set::{LabelledSpan, StreamKind, TrainSet, TrainStream};

/// Use of mirrored copies of samples in training.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mirror {
    /// Between classes that are named as the two sides of one motion (`wave_left`, `wave_right`): each also teaches the
    /// other.
    #[default]
    Auto,
    /// Those, and every other class is the same on both sides of the body; but a class that is named after a side, or
    /// said to be one-sided, uses its mirror image as a negative.
    Yes,
    /// Not at all.
    No,
}

/// Content of a mirrored copy of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Image {
    Class(ClassId),
    /// None of the classes.
    NoClass,
    /// It is not known: no copy is made.
    Unknown,
}

/// Adds mirrored copies of the samples of `set`, whose rows hold `bones`, as streams of their own, as
/// [`train_clips`](super::train_clips) does. Returns how many.
pub(super) fn add_mirrored(
    set: &mut TrainSet,
    bones: BoneSet,
    mirror: Mirror,
    one_sided: &[String],
) -> usize {
    let classes = 0..set.classes.len();
    let images: Vec<Image> = classes
        .map(|class| image_of(class, &set.classes, mirror, one_sided))
        .collect();
    let samples = set.samples();
    let copies = samples.iter().filter_map(|sample| {
        let (source, class) = match images[sample.class.index()] {
            Image::Class(class) => (StreamKind::Labelled, Some(class)),
            Image::NoClass => (StreamKind::Background, None),
            Image::Unknown => return None,
        };
        let of = &set.streams[sample.stream];
        let rows = mirrored_rows(&sample.rows, bones)?;
        let known = class.map(|class| LabelledSpan {
            ticks: 0..rows.len(),
            class: Some(class),
        });
        Some(TrainStream {
            name: format!("{} (mirrored)", of.name),
            group: of.group.clone(),
            person: of.person.clone(),
            source,
            rest_is_background: class.is_none(),
            is_copy: true,
            rows,
            known: known.into_iter().collect(),
        })
    });
    let copies: Vec<TrainStream> = copies.collect();
    let count = copies.len();
    set.streams.extend(copies);
    count
}

fn image_of(class: usize, classes: &[String], mirror: Mirror, one_sided: &[String]) -> Image {
    if mirror == Mirror::No {
        return Image::Unknown;
    }
    let name = &classes[class];
    let other = with_sides_exchanged(name);
    let counterpart = other
        .as_ref()
        .and_then(|other| classes.iter().position(|c| c == other));
    match counterpart {
        Some(other) => Image::Class(ClassId(other as u16)),
        None if mirror == Mirror::Auto => Image::Unknown,
        None if other.is_some() || one_sided.contains(name) => Image::NoClass,
        None => Image::Class(ClassId(class as u16)),
    }
}

/// `name` with the word left for right or right for left, written as it was; `None` if it has neither. A word is set off
/// by anything that is no letter, or by a capital (`waveLeft`).
fn with_sides_exchanged(name: &str) -> Option<String> {
    const WORDS: [[&str; 2]; 3] = [["left", "right"], ["Left", "Right"], ["LEFT", "RIGHT"]];
    WORDS.iter().find_map(|[left, right]| {
        let exchanged = |from: &str, to: &str| {
            let at = word_at(name, from)?;
            let (before, after) = (&name[..at], &name[at + from.len()..]);
            Some(format!("{before}{to}{after}"))
        };
        exchanged(left, right).or_else(|| exchanged(right, left))
    })
}

/// Byte offset of `word` in `name` as a word of its own.
fn word_at(name: &str, word: &str) -> Option<usize> {
    let starts_small = word.starts_with(char::is_lowercase);
    let ends_small = word.ends_with(char::is_lowercase);
    name.match_indices(word).map(|(at, _)| at).find(|&at| {
        let before = name[..at].chars().next_back();
        let after = name[at + word.len()..].chars().next();
        let begins = before.is_none_or(|c| {
            !c.is_alphabetic() || (!starts_small && ends_small && c.is_lowercase())
        });
        let ends = after.is_none_or(|c| !c.is_alphabetic() || (ends_small && c.is_uppercase()));
        begins && ends
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_exchanged_where_they_are_words() {
        let exchanged = |name: &str| with_sides_exchanged(name);
        assert_eq!(exchanged("wave_left").as_deref(), Some("wave_right"));
        assert_eq!(exchanged("RIGHT kick").as_deref(), Some("LEFT kick"));
        assert_eq!(exchanged("waveLeft").as_deref(), Some("waveRight"));
        assert_eq!(exchanged("leftWave").as_deref(), Some("rightWave"));
        for none in ["cleft", "bright", "wave", "leftover", "Leftover"] {
            assert_eq!(exchanged(none), None, "{none}");
        }
    }

    #[test]
    fn what_a_mirrored_copy_teaches() {
        let classes: Vec<String> = ["wave_left", "wave_right", "sweep_left", "bow", "salute"]
            .map(str::to_owned)
            .into();
        let one_sided = ["salute".to_owned()];
        let images = |mirror| -> Vec<Image> {
            (0..classes.len())
                .map(|class| image_of(class, &classes, mirror, &one_sided))
                .collect()
        };
        let class = |i| Image::Class(ClassId(i));
        use Image::{NoClass, Unknown};
        assert_eq!(
            images(Mirror::Auto),
            [class(1), class(0), Unknown, Unknown, Unknown]
        );
        assert_eq!(
            images(Mirror::Yes),
            [class(1), class(0), NoClass, class(3), NoClass]
        );
        assert_eq!(images(Mirror::No), [Unknown; 5]);
    }
}
