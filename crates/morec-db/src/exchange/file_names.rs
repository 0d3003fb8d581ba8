//! Clips' names as names of files, and back.
//!
//! Characters that file names cannot hold on some system are written as `%` and two hexadecimal digits for each byte, as
//! in addresses: `x/y` becomes `x%2Fy`. No two clips get one file.

use std::collections::BTreeSet;

/// Windows takes these for devices, whatever their ending.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// The name of a clip's file, without an ending.
pub fn file_name(clip: &str) -> String {
    let mut name = String::with_capacity(clip.len());
    let last = clip.chars().count().saturating_sub(1);
    for (at, sign) in clip.chars().enumerate() {
        let edge = (at == 0 || at == last) && matches!(sign, '.' | ' ');
        let refused = "/\\%<>:\"|?*".contains(sign) || sign.is_control();
        match edge || refused {
            true => push_escaped(&mut name, sign),
            false => name.push(sign),
        }
    }
    let device = DEVICES
        .iter()
        .any(|device| name.eq_ignore_ascii_case(device));
    match name.chars().next().filter(|_| device) {
        Some(first) => {
            let mut escaped = String::new();
            push_escaped(&mut escaped, first);
            escaped + &name[first.len_utf8()..]
        }
        None => name,
    }
}

/// The names of several clips' files, in their order, also different where upper and lower case are one.
pub fn file_names<'a>(clips: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let mut names = Vec::new();
    for clip in clips {
        let mut name = file_name(clip);
        if !taken.insert(name.to_lowercase()) {
            // Capitals escaped, then everything: one of these is free, as the clips' names differ.
            name = with_escaped(clip, char::is_uppercase);
            if !taken.insert(name.to_lowercase()) {
                name = with_escaped(clip, |_| true);
                taken.insert(name.to_lowercase());
            }
        }
        names.push(name);
    }
    names
}

fn with_escaped(clip: &str, escape: impl Fn(char) -> bool) -> String {
    let mut name = String::new();
    for sign in clip.chars() {
        match escape(sign) || file_name(&sign.to_string()).len() > sign.len_utf8() {
            true => push_escaped(&mut name, sign),
            false => name.push(sign),
        }
    }
    name
}

fn push_escaped(name: &mut String, sign: char) {
    let mut bytes = [0; 4];
    for byte in sign.encode_utf8(&mut bytes).bytes() {
        name.push_str(&format!("%{byte:02X}"));
    }
}

/// The clip whose file has this name, without its ending; `%` that begins no escape stays.
pub fn clip_of_file_name(name: &str) -> String {
    let bytes = name.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|b| char::from(*b).to_digit(16));
    let (mut out, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        match (bytes[at], digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| name.to_owned())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn names_come_back_and_no_two_share_a_file(
            clips in prop::collection::btree_set("[a-cA-C/\\\\%. _~ß1:]{1,5}|\\PC{1,4}", 1..12)
        ) {
            let names = file_names(clips.iter().map(String::as_str));
            for (clip, name) in clips.iter().zip(&names) {
                prop_assert_eq!(&clip_of_file_name(name), clip);
                prop_assert!(!name.contains(['/', '\\', ':']) && name != "." && name != "..");
            }
            let different: BTreeSet<String> = names.iter().map(|n| n.to_lowercase()).collect();
            prop_assert_eq!(different.len(), clips.len(), "{:?}", names);
        }
    }

    #[test]
    fn names_that_fall_together_are_told_apart() {
        let names = file_names(["x/y", "x_y", "x\\y", "X_Y", "nul", "take 1"]);
        assert_eq!(
            names,
            ["x%2Fy", "x_y", "x%5Cy", "%58_%59", "%6Eul", "take 1"]
        );
    }
}
