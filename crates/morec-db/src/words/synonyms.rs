//! Words of movement that mean about the same. Each is in one group only.

use super::tokens::stems;

const GROUPS: [&str; 30] = [
    "walk stroll stride pace march step",
    "run jog sprint",
    "jump hop leap skip",
    "sit seat",
    "kick",
    "punch box strike hit jab",
    "throw toss pitch fling",
    "catch grab grasp",
    "wave greet hello",
    "bow curtsy",
    "dance ballet waltz salsa",
    "turn rotate spin twirl pirouette",
    "crouch squat duck",
    "crawl creep",
    "climb ascend",
    "lift raise",
    "lower drop",
    "push shove",
    "pull drag tug",
    "clap applaud",
    "drink sip",
    "look watch gaze",
    "fall trip stumble tumble",
    "fast quick quickly rapid",
    "slow slowly",
    "backward backwards back",
    "forward forwards",
    "hand palm",
    "foot feet",
    "stand upright",
];

/// Stems of the group that has `stem`, itself among them; empty if no group has it.
pub(super) fn synonyms_of(stem: &str) -> Vec<String> {
    let mut groups = GROUPS.iter().map(|group| stems(group));
    let found = groups.find(|group| group.iter().any(|word| word == stem));
    found.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn each_word_is_in_one_group_only() {
        let mut groups = BTreeMap::new();
        for (number, group) in GROUPS.iter().enumerate() {
            for word in group.split(' ') {
                let stem = stems(word);
                assert_eq!(stem.len(), 1, "{word}");
                let before = groups.insert(stem.concat(), number);
                assert!(before.is_none_or(|before| before == number), "{word}");
                assert_eq!(synonyms_of(&stem[0]), stems(group), "{word}");
            }
        }
        assert!(synonyms_of("xylophone").is_empty());
    }
}
