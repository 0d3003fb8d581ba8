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

/// Number of the group that has a stem.
pub(super) fn group_of(stem: &str) -> Option<usize> {
    GROUPS
        .iter()
        .position(|group| group.split(' ').any(|word| stems(word) == [stem]))
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
                assert_eq!(group_of(&stem[0]), Some(number), "{word}");
            }
        }
        assert_eq!(group_of("xylophone"), None);
    }
}
