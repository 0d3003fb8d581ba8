//! Checks for tables that were probably misread: seconds in columns of frames, misspelt names.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use super::names::{near, some_of};

/// Labels of which half are shorter are no motions, seconds.
const SHORTEST_SECS: f64 = 0.2;
/// A class of so few labels may be another one misspelled.
const FEW: usize = 2;
/// The other one has this many times its labels.
const TIMES_MORE: usize = 5;
/// Likewise if two letters are swapped, which seldom makes another word.
const TIMES_MORE_SWAPPED: usize = 2;
/// Near names are looked for among this many clips.
const HINTED: usize = 5;

/// Reason why the times of a table are probably not in the unit that its columns say; `None` if they may be. `secs` are the lengths of
/// the labels that lie in their clips, whole clips aside, `beyond` the number of labels that were cut or left out at the
/// end of theirs, `left_out` the number of the latter.
pub fn doubtful_unit(
    secs: impl IntoIterator<Item = f64>,
    beyond: usize,
    left_out: usize,
) -> Option<String> {
    let mut secs: Vec<f64> = secs.into_iter().collect();
    secs.sort_by(f64::total_cmp);
    let all = secs.len() + left_out;
    if 2 * beyond > all {
        return Some(format!(
            "{beyond} of {all} labels end after their clips do, so their times are probably in another unit: frames belong in \
             the columns `start` and `stop`, seconds in `start_secs` and `stop_secs`"
        ));
    }
    let median = *secs.get(secs.len() / 2)?;
    (median < SHORTEST_SECS).then(|| {
        format!(
            "half of {} labels last {median:.2} s or less, too short for motions, so their times are probably in another unit: \
             seconds belong in the columns `start_secs` and `stop_secs`, frames in `start` and `stop`",
            secs.len()
        )
    })
}

/// Labels of clips that are not there, in a sentence, with the clips of `known` that may be meant.
pub fn said_absent(absent: &BTreeMap<String, usize>, known: &[String]) -> String {
    let rows: usize = absent.values().sum();
    let near = absent.keys().take(HINTED).filter_map(|name| {
        let near = near(name, known);
        Some(format!("for `{name}` did you mean `{}`?", near.first()?))
    });
    let near: Vec<String> = near.collect();
    let asked = match near.is_empty() {
        true => String::new(),
        false => format!("; {}", near.join(" ")),
    };
    let names = some_of(absent.keys());
    format!("{rows} labels are of unknown clips: {names}{asked}")
}

/// Questions about classes that are probably other ones misspelled, given the number of labels of each: names that differ only in case
/// or in spaces, hyphens and underscores, and classes of few labels whose names are one slip away from those of classes of many.
pub fn misspelled(counts: &BTreeMap<&str, usize>) -> Vec<String> {
    let folded: Vec<(String, &str, usize)> = counts
        .iter()
        .map(|(name, count)| (folded(name), *name, *count))
        .collect();
    let rank = |name: &str, count: usize| (Reverse(count), name.to_owned());
    let asked = folded.iter().filter_map(|(key, name, count)| {
        let mut others = folded.iter().filter(|(_, other, _)| other != name);
        let meant = others.find(|(other_key, other, more)| {
            if key == other_key {
                return rank(other, *more) < rank(name, *count);
            }
            (1..=FEW).contains(count)
                && *more >= times_more(key, other_key) * count
                && is_slip(key, other_key)
        })?;
        let labels = if *count == 1 { "label" } else { "labels" };
        let meant = meant.1;
        Some(format!(
            "the class {name} has {count} {labels}; did you mean `{meant}`?"
        ))
    });
    asked.collect()
}

/// A name in lower case, with underscores between its words.
fn folded(name: &str) -> String {
    let lower = name.to_lowercase();
    lower.replace([' ', '-'], "_")
}

/// The least ratio of labels, of the class that is meant to the misspelled one.
fn times_more(name: &str, other: &str) -> usize {
    match are_swapped(name, other) {
        true => TIMES_MORE_SWAPPED,
        false => TIMES_MORE,
    }
}

/// True if the letters are the same in another order.
fn are_swapped(name: &str, other: &str) -> bool {
    let letters = |text: &str| {
        let mut letters: Vec<char> = text.chars().collect();
        letters.sort_unstable();
        letters
    };
    name.len() == other.len() && letters(name) == letters(other)
}

/// True if one letter is missing, too many, another or swapped with its neighbour; numbers and endings such as `_l` and `_r`
/// are what distinguishes classes.
fn is_slip(name: &str, other: &str) -> bool {
    let digits = |text: &str| {
        text.chars()
            .filter(char::is_ascii_digit)
            .collect::<String>()
    };
    let stem = |text: &str| {
        let last = text.char_indices().next_back();
        last.map_or(String::new(), |(at, _)| text[..at].to_owned())
    };
    let same_length = name.chars().count() == other.chars().count();
    let ending = same_length && stem(name) == stem(other);
    name.chars().count() > 2
        && digits(name) == digits(other)
        && !(ending && name != other)
        && strsim::damerau_levenshtein(name, other) <= 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_in_columns_of_frames_are_doubted_and_so_are_frames_in_columns_of_seconds() {
        let short = doubtful_unit([0.07, 0.03, 0.1], 0, 0).unwrap();
        assert!(short.contains("0.07 s or less"));
        assert!(doubtful_unit([1.0, 0.1, 0.9], 0, 0).is_none());
        let late = doubtful_unit([2.0], 5, 5).unwrap();
        assert!(late.contains("5 of 6 labels end after"));
        assert!(doubtful_unit([2.0, 1.0, 3.0], 1, 0).is_none());
        assert!(doubtful_unit([2.0; 6], 4, 4).is_none(), "4 of 10");
        assert!(doubtful_unit([], 0, 0).is_none());
    }

    #[test]
    fn a_rare_class_that_is_nearly_a_frequent_one_is_asked_about() {
        let counts = [
            ("clap", 40),
            ("calp", 1),
            ("wave_l", 1),
            ("wave_r", 9),
            ("kick 1", 1),
            ("kick 2", 9),
        ];
        let asked = misspelled(&counts.into());
        assert_eq!(asked, ["the class calp has 1 label; did you mean `clap`?"]);
        assert!(misspelled(&[("Clap", 1), ("clap", 5)].into())[0].contains("`clap`"));
        assert!(misspelled(&[("clap", 3), ("calp", 3)].into()).is_empty());
        let few = misspelled(&[("throw", 4), ("thorw", 1), ("thrown", 1)].into());
        assert_eq!(few, ["the class thorw has 1 label; did you mean `throw`?"]);
    }

    #[test]
    fn names_that_differ_in_case_or_separators_are_asked_about_however_many_labels_they_have() {
        let asked = misspelled(&[("Kick_left", 9), ("kick left", 12)].into());
        let said = "the class Kick_left has 9 labels; did you mean `kick left`?";
        assert_eq!(asked, [said]);
        assert_eq!(misspelled(&[("Kick", 3), ("kick", 3)].into()).len(), 1);
    }

    #[test]
    fn a_clip_that_is_not_there_is_asked_about() {
        let known = ["take_1", "take_2", "walk"].map(str::to_owned);
        let said = said_absent(&[("takee_1".to_owned(), 3)].into(), &known);
        assert_eq!(
            said,
            "3 labels are of unknown clips: takee_1; for `takee_1` did you mean `take_1`?"
        );
        assert!(!said_absent(&[("elsewhere".to_owned(), 1)].into(), &known).contains('?'));
    }
}
