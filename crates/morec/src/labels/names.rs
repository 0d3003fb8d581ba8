//! Suggestions for unknown names, and lists of many names in a sentence.

use std::cmp::Reverse;

/// Most names listed when none is similar.
const LISTED: usize = 8;

/// Most similar names offered.
const OFFERED: usize = 3;

/// Most of many names that a sentence says.
const NAMED: usize = 5;

/// Hint for a name that is not among `known`, to be put behind a sentence: the nearest ones, or some of them and how
/// many more there are.
pub fn hint(name: &str, known: &[String]) -> String {
    if known.is_empty() {
        return "; there is none".to_owned();
    }
    let near = near(name, known);
    if near.is_empty() {
        let shown: Vec<&str> = known.iter().take(LISTED).map(String::as_str).collect();
        let more = match known.len().saturating_sub(LISTED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        return format!("; there are {}{more}", shown.join(", "));
    }
    let offered: Vec<String> = near
        .iter()
        .take(OFFERED)
        .map(|name| format!("`{name}`"))
        .collect();
    format!("; did you mean {}?", offered.join(" or "))
}

/// The names of `known` that are nearly `name`, the nearest first.
pub(super) fn near<'k>(name: &str, known: &'k [String]) -> Vec<&'k String> {
    let wanted = name.to_lowercase();
    let mut near: Vec<(usize, bool, &String)> = known
        .iter()
        .map(|other| {
            let other_lower = other.to_lowercase();
            let apart = strsim::damerau_levenshtein(&wanted, &other_lower);
            let part = !wanted.is_empty() && other_lower.contains(&wanted);
            (apart, part, other)
        })
        .filter(|(apart, part, _)| *part || *apart <= (wanted.chars().count() / 3).max(1))
        .collect();
    near.sort_by_key(|(apart, part, name)| (Reverse(*part && *apart < 2), *apart, *name));
    near.into_iter().map(|(_, _, name)| name).collect()
}

/// The first few of many names, and how many more there are.
pub fn some_of<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<N> = names.by_ref().take(NAMED).collect();
    let shown: Vec<&str> = shown.iter().map(AsRef::as_ref).collect();
    match names.count() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::{hint, some_of};

    fn known(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn the_nearest_names_are_offered() {
        let names = known(&["signals_1", "signals_2", "signals_3", "walk", "Jump"]);
        assert_eq!(
            hint("signal_3", &names),
            "; did you mean `signals_3` or `signals_1` or `signals_2`?"
        );
        assert_eq!(hint("jmup", &names), "; did you mean `Jump`?");
        assert_eq!(hint("wlak", &names), "; did you mean `walk`?");
        assert!(hint("crouch", &names).starts_with("; there are signals_1, "));
        assert_eq!(hint("x", &[]), "; there is none");
    }

    #[test]
    fn a_long_list_says_how_long_it_is() {
        let names: Vec<String> = (0..30).map(|n| format!("class number {n}")).collect();
        let hint = hint("zzzzzz", &names);
        assert!(hint.ends_with("and 22 more"), "{hint}");
    }

    #[test]
    fn a_part_of_a_name_is_near() {
        let names = known(&["hands_up_slow", "walk"]);
        assert_eq!(hint("hands", &names), "; did you mean `hands_up_slow`?");
    }

    #[test]
    fn many_names_are_a_few_and_a_number() {
        assert_eq!(some_of(["a", "b"]), "a, b");
        assert_eq!(some_of(["a"; 7]), "a, a, a, a, a and 2 more");
    }
}
