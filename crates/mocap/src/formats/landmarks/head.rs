//! Recognises documents of landmarks by their first bytes.

/// True if text begins like a document of landmarks.
pub(in crate::formats) fn looks_so(head: &[u8]) -> bool {
    let contains = |word: &[u8]| {
        head.windows(word.len())
            .any(|at| at.eq_ignore_ascii_case(word))
    };
    let words: [&[u8]; 16] = [
        b"pointables",
        b"palmPosition",
        b"palm_position",
        b"\"hips\"",
        b"\"pelvis\"",
        b"left_hip",
        b"lefthip",
        b"left_wrist",
        b"left_hand\"",
        b"landmark",
        b"keypoint",
        b"joints",
        b"joint_",
        b"left_shoulder",
        b"leftShoulder",
        b"nose_x",
    ];
    // Scenes of suits and glTF have words in common with these.
    let others: [&[u8]; 2] = [b"\"asset\"", b"\"actors\""];
    let numbers = contains(b"z\"")
        || contains(b"y\"")
        || head
            .windows(2)
            .any(|at| at[0] == b'[' && matches!(at[1], b'[' | b'-' | b'0'..=b'9'));
    let text = head.trim_ascii_start();
    matches!(text, [b'{' | b'[', ..])
        && (numbers || is_list_of_lists(text))
        && (words.iter().any(|word| contains(word))
            || has_list_of_frames(text)
            || is_list_of_lists(text)
            || has_many_places(head))
        && !others.iter().any(|word| contains(word))
}

/// True of `{…, "frames": [[[0.1, …`.
fn has_list_of_frames(text: &[u8]) -> bool {
    let key = b"\"frames\"";
    let at = text.windows(key.len()).position(|at| at == key);
    let list = at.and_then(|at| text[at + key.len()..].trim_ascii_start().strip_prefix(b":"));
    list.is_some_and(|list| is_list_of_lists(list.trim_ascii_start()))
}

/// True if there are more places `{"x": …, "y": …, "z": …}` than those of a camera or a scene.
fn has_many_places(head: &[u8]) -> bool {
    const LEAST: usize = 15;
    let count = |axis: &[u8; 4]| {
        let found = head
            .windows(axis.len())
            .filter(|at| at.eq_ignore_ascii_case(axis));
        found.count()
    };
    [b"\"x\":", b"\"y\":", b"\"z\":"]
        .into_iter()
        .all(|axis| count(axis) >= LEAST)
}

/// True for a list of frames without field names, `[[[0.1, 0.9, 0.0], …` or `[[{"x": 0.1, …`. Empty frames may precede it.
fn is_list_of_lists(text: &[u8]) -> bool {
    let marks = text.iter().filter(|b| !b.is_ascii_whitespace());
    let marks: Vec<u8> = marks.take(4000).copied().collect();
    let Some(mut rest) = marks.strip_prefix(b"[") else {
        return false;
    };
    let nobody: [&[u8]; 4] = [b"[],", b"{},", b"null,", b"[[]],"];
    while let Some(behind) = nobody.iter().find_map(|frame| rest.strip_prefix(*frame)) {
        rest = behind;
    }
    // One list is a frame; one within it is a body or a point.
    let lists = rest.iter().take_while(|b| **b == b'[').count();
    let point = &rest[lists..];
    let is_number = matches!(point, [b'-' | b'0'..=b'9', ..] | [b'N', b'a', ..]);
    let axes: [&[u8]; 2] = [b"\"x\":", b"\"y\":"];
    let is_place = point.starts_with(b"{")
        && axes.iter().all(|axis| {
            let mut found = point.windows(axis.len());
            found.any(|at| at.eq_ignore_ascii_case(axis))
        });
    lists >= 2 && is_number || lists >= 1 && is_place
}
