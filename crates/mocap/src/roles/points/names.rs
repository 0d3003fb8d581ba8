//! Normalises the names of points to one spelling.

use crate::roles::languages::{in_english, words_in_english};
use crate::roles::words::words_of;

/// Names without subject and marks, in lower case, a side in front: `lshoulder` for `LEFT_SHOULDER`, `ShoulderLeft`,
/// `L.Shoulder`, `Anna:LShoulder`. A first word that all names share is dropped, and a last one that says what all are.
pub(super) fn normalised(names: &[&str]) -> Vec<String> {
    let mut words: Vec<Vec<String>> = names.iter().map(|name| words(name)).collect();
    let shared = words.first().and_then(|w| w.first()).cloned();
    let is_shared = |w: &Vec<String>| w.len() > 1 && w.first() == shared.as_ref();
    if words.len() > 3 && words.iter().all(is_shared) {
        for name in &mut words {
            name.remove(0);
        }
    }
    // ARKit calls all of them joints, `left_leg_joint`.
    let says_kind = |w: &Vec<String>| {
        let last = w.last().map_or("", String::as_str);
        w.len() > 1 && ["joint", "jnt", "bone", "marker"].contains(&last)
    };
    if words.len() > 3 && words.iter().all(says_kind) {
        for name in &mut words {
            name.pop();
        }
    }
    words.into_iter().map(joined).collect()
}

/// One name in that spelling.
pub(super) fn normalised_one(name: &str) -> String {
    joined(words(name))
}

/// Lower-case words, cut at marks and where the case changes; digits stay with the word before them.
pub(super) fn words(name: &str) -> Vec<String> {
    let bare = name.rsplit(':').next().unwrap_or(name);
    if bare.is_ascii() {
        return words_in_english(words_of(bare, char::is_alphanumeric));
    }
    let words = words_of(&in_english(bare), char::is_alphanumeric);
    // In Japanese a point between waist and knee is called the leg, and the root the waist.
    let of_point = |word: String| match word.as_str() {
        "leg" if bare.contains('足') => "thigh".to_owned(),
        "waist" if bare.contains('腰') => "hips".to_owned(),
        _ => word,
    };
    words_in_english(words).into_iter().map(of_point).collect()
}

/// The side first, then the rest.
fn joined(mut words: Vec<String>) -> String {
    // OpenCap marks its study's markers.
    words.retain(|word| word != "study");
    let says_nothing =
        ["body", "pose", "skeleton"].contains(&words.first().map_or("", String::as_str));
    if says_nothing && words.len() > 1 {
        words.remove(0);
    }
    let is_side = |word: &str| match word {
        "left" | "l" | "links" => Some("l"),
        "right" | "r" | "rechts" => Some("r"),
        _ => None,
    };
    let spelt = words.iter().position(|word| is_side(word).is_some());
    if let Some(at) = spelt.filter(|_| words.len() > 1) {
        let side = is_side(&words.remove(at)).unwrap_or_default();
        return format!("{side}{}", words.concat());
    }
    let whole = words.concat();
    for (start, side) in [("left", "l"), ("right", "r")] {
        if let Some(rest) = whole.strip_prefix(start).filter(|rest| !rest.is_empty()) {
            return format!("{side}{rest}");
        }
        if let Some(rest) = whole.strip_suffix(start).filter(|rest| !rest.is_empty()) {
            return format!("{side}{rest}");
        }
    }
    whole
}

/// The number of each point, from 0, if names are numbers behind one word at most, each once.
pub(super) fn numbers(names: &[&str]) -> Option<Vec<usize>> {
    let split = |name: &&str| {
        let bare = name.rsplit(':').next().unwrap_or(name);
        let digits = bare.len() - bare.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let (word, number) = bare.split_at(bare.len() - digits);
        Some((word.to_owned(), number.parse::<usize>().ok()?))
    };
    let split: Vec<(String, usize)> = names.iter().map(split).collect::<Option<_>>()?;
    let first = split.first()?;
    let least = split.iter().map(|(_, number)| *number).min()?;
    let mut order: Vec<usize> = split.iter().map(|(_, number)| number - least).collect();
    let result = order.clone();
    order.sort_unstable();
    let each_once = order.iter().enumerate().all(|(i, &number)| i == number);
    (least <= 1 && each_once && split.iter().all(|(word, _)| *word == first.0)).then_some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_spelling() {
        for (name, expected) in [
            ("LEFT_SHOULDER", "lshoulder"),
            ("ShoulderLeft", "lshoulder"),
            ("shoulder_l", "lshoulder"),
            ("L.Shoulder", "lshoulder"),
            ("leftshoulder", "lshoulder"),
            ("Anna:LShoulder", "lshoulder"),
            ("Reed:LFHD", "lfhd"),
            ("R.ASIS", "rasis"),
            ("LUArm", "luarm"),
            ("RBigToe", "rbigtoe"),
            ("LeftUpLeg", "lupleg"),
            ("C7", "c7"),
            ("r_lelbow_study", "rlelbow"),
            ("body_left_hip", "lhip"),
            ("Spine1", "spine1"),
            ("Right", "right"),
            ("Schulter_links", "lshoulder"),
            ("Handgelenk rechts", "rwrist"),
            ("Knöchel_links", "lankle"),
            ("左ひじ", "lelbow"),
            ("右足", "rthigh"),
            ("右足首", "rankle"),
            ("腰", "hips"),
            ("rodilla_izq", "lknee"),
        ] {
            assert_eq!(normalised_one(name), expected, "{name}");
        }
        let kinds = [
            "root_joint",
            "left_upLeg_joint",
            "head_joint",
            "neck_1_joint",
        ];
        assert_eq!(normalised(&kinds), ["root", "lupleg", "head", "neck1"]);
        let shared = ["Bip01 L Thigh", "Bip01 R Thigh", "Bip01 Head", "Bip01 Neck"];
        assert_eq!(normalised(&shared), ["lthigh", "rthigh", "head", "neck"]);
    }

    #[test]
    fn numbers_from_0_or_1() {
        assert_eq!(numbers(&["2", "0", "1"]), Some(vec![2, 0, 1]));
        assert_eq!(numbers(&["kp_1", "kp_2"]), Some(vec![0, 1]));
        for none in [
            vec!["0", "2"],
            vec!["a1", "b2"],
            vec!["LFHD", "C7"],
            vec![],
            vec!["7", "8"],
        ] {
            assert_eq!(numbers(&none), None, "{none:?}");
        }
    }
}
