//! Tracked points: a headset and controllers, or points of a custom skeleton by the names of their roles.

use super::names::words;
use crate::roles::Role;

/// Points of a custom skeleton that are enough: the root and something else.
const LEAST_CUSTOM: usize = 2;

/// The points of a head and two hands (and `face`), or of a custom skeleton, among points of these names, with their set's name: names of
/// roles, or of a headset and its controllers. `None` unless the head and both hands are there, or the skeleton's root, and at least half of
/// the points are known. O(points²).
pub fn recognise_tracked(names: &[&str]) -> Option<(&'static str, Vec<(Role, usize)>)> {
    let mut roles: Vec<(Role, usize)> = Vec::new();
    // A name that is a role's own goes before one that only means it.
    for meaning in [Role::from_name, of_device] {
        for (at, name) in names.iter().enumerate() {
            let Some(role) = meaning(name) else { continue };
            if !roles.iter().any(|(known, of)| *known == role || *of == at) {
                roles.push((role, at));
            }
        }
    }
    roles.sort_by_key(|(_, at)| *at);
    let has = |role| roles.iter().any(|(known, _)| *known == role);
    let tracked = [Role::Head, Role::LeftHand, Role::RightHand];
    let set = match has(Role::Point1) {
        true if roles.len() >= LEAST_CUSTOM => "points of a custom skeleton",
        false if tracked.into_iter().all(has) => "a head and two hands",
        _ => return None,
    };
    (2 * roles.len() >= names.len()).then_some((set, roles))
}

/// `HMD`, `LeftController`, `controller_right`, `wrist.l`.
fn of_device(name: &str) -> Option<Role> {
    let words = words(name);
    let has = |known: &[&str]| words.iter().any(|word| known.contains(&word.as_str()));
    if words.len() > 2 {
        return None;
    }
    if has(&["head", "hmd", "headset"]) {
        return Some(Role::Head);
    }
    if !has(&["hand", "wrist", "controller"]) {
        return None;
    }
    match (has(&["left", "l"]), has(&["right", "r"])) {
        (true, false) => Some(Role::LeftHand),
        (false, true) => Some(Role::RightHand),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headsets_and_controllers_are_known_by_their_names() {
        let expected = [(Role::Head, 0), (Role::LeftHand, 1), (Role::RightHand, 2)];
        for names in [
            ["head", "left_hand", "right_hand"],
            ["HMD", "LeftController", "RightController"],
            ["headset", "controller_left", "controller_right"],
            ["XR Head", "wrist.l", "wrist.r"],
        ] {
            let (set, roles) = recognise_tracked(&names).unwrap();
            assert_eq!((set, &roles[..]), ("a head and two hands", &expected[..]));
        }
        let (_, roles) = recognise_tracked(&["hmd", "left_hand", "right_hand", "face"]).unwrap();
        assert_eq!(roles[3], (Role::Face, 3));
        for names in [["head", "left_hand", "ball"], ["hand", "controller", "hmd"]] {
            assert_eq!(recognise_tracked(&names), None, "{names:?}");
        }
    }

    #[test]
    fn points_of_a_custom_skeleton_are_known_by_their_names() {
        let names = ["point_1", "left_point_1", "right_point_1", "base"];
        let (_, roles) = recognise_tracked(&names).unwrap();
        assert_eq!(roles[0], (Role::Point1, 0));
        assert_eq!(roles.len(), 3);
    }
}
