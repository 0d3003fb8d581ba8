//! Words of names and descriptions.

/// Words that distinguish no motion.
const LEFT_OUT: [&str; 28] = [
    "a", "an", "and", "are", "at", "by", "her", "his", "in", "is", "it", "its", "of", "on", "or",
    "person", "somebody", "someone", "that", "the", "their", "then", "they", "this", "to", "while",
    "who", "with",
];

/// Stems of the words of `text`, in its order: parts of names (`waveLeft_01`) are words, and words that distinguish no motion are left out.
pub(super) fn stems(text: &str) -> Vec<String> {
    let words = words(text).into_iter();
    let kept = words.filter(|word| !LEFT_OUT.contains(&word.as_str()));
    kept.map(|word| stem(&word)).collect()
}

/// Words in small letters: they end at other signs, at a capital after a small letter, and between letters and digits.
fn words(text: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for sign in text.chars() {
        let ends = (before.is_lowercase() && sign.is_uppercase())
            || (before.is_alphanumeric() && before.is_numeric() != sign.is_numeric());
        if ends || !sign.is_alphanumeric() {
            words.push(String::new());
        }
        if let (true, Some(word)) = (sign.is_alphanumeric(), words.last_mut()) {
            word.extend(sign.to_lowercase());
        }
        before = sign;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// A word without the endings of English verbs and plurals: `waves`, `waving` and `waved` are `wav`, `running` is `run`.
fn stem(word: &str) -> String {
    if !word.is_ascii() || word.starts_with(|c: char| c.is_ascii_digit()) {
        // Numbers are the same with and without zeros before them.
        let short = word.trim_start_matches('0');
        return if short.is_empty() { word } else { short }.to_owned();
    }
    let shorter = |ending: &str| word.strip_suffix(ending).filter(|rest| rest.len() >= 3);
    let cut = ["ing", "ed", "es", "s"].into_iter().find_map(shorter);
    let mut stem = cut.unwrap_or(word).to_owned();
    let signs = stem.as_bytes();
    if let [.., a, b] = signs
        && a == b
        && stem.len() > 3
    {
        stem.pop();
    }
    if stem.len() > 3 && stem.ends_with('e') {
        stem.pop();
    }
    // `carries` and `carry`.
    if stem.len() > 2 && stem.ends_with('y') {
        stem.pop();
        stem.push('i');
    }
    stem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_of_a_word_have_one_stem() {
        for forms in [
            "wave waves waving waved",
            "run running runs",
            "jump jumps jumped jumping",
            "dance dancing dances danced",
            "sit sitting sits",
            "carry carries carrying carried",
            "kick kicks kicked",
            "press presses pressing",
        ] {
            let found = stems(forms);
            assert!(found.iter().all(|s| *s == found[0]), "{forms}: {found:?}");
        }
        assert_ne!(stems("walk"), stems("wave"));
    }

    #[test]
    fn parts_of_names_are_words() {
        let expected = stems("wave left hand 1");
        assert_eq!(stems("waveLeft-Hand_01"), expected);
        assert_eq!(stems("WAVE LEFT_HAND1"), expected);
        assert_eq!(stems("a person is waving with the left hand, 1"), expected);
        assert_eq!(stems("…"), [""; 0]);
        assert_eq!(stems("Gehen 001 für"), ["gehen", "1", "für"]);
    }
}
