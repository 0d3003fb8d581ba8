//! Points written in a row, without brackets between them: x, y, z, or these and how sure the tracker was.

use serde_json::Value;

use crate::roles::points::numbered_counts;

/// Brackets the points of all rows of numbers in fields that say that they are in space (`pose_keypoints_3d`), whether a
/// field holds one row or lists of them: `[51 numbers]` becomes a list of 17 points. `named` is the number of points for
/// which the document has names. Rows of other lengths than known sets of points have stay as they are. O(document).
pub(super) fn into_points(value: &mut Value, named: Option<usize>) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|child| into_points(child, named)),
        Value::Object(fields) => {
            for (key, child) in fields {
                match counts_of(key, named) {
                    Some(counts) => bracket(child, &counts),
                    None => into_points(child, named),
                }
            }
        }
        _ => {}
    }
}

/// The length of a row in a field that says that it is in space and whose points are not bracketed, if there is one.
pub(super) fn unknown(value: &Value) -> Option<usize> {
    match value {
        Value::Array(list) => list.iter().find_map(unknown),
        Value::Object(fields) => fields.iter().find_map(|(key, child)| {
            let here = counts_of(key, None).and_then(|_| row_in(child));
            here.or_else(|| unknown(child))
        }),
        _ => None,
    }
}

/// The numbers of points that a row in this field may have; `None` if it does not say that it is in space.
fn counts_of(key: &str, named: Option<usize>) -> Option<Vec<usize>> {
    let key = key.to_lowercase();
    // The Panoptic Studio's `joints19` has four numbers for each of 19.
    let stated = key.strip_prefix("joints").and_then(|n| n.parse().ok());
    let in_space = ["3d", "world"].iter().any(|word| key.contains(word)) && !is_no_place(&key);
    match stated {
        Some(count) => Some(vec![count]),
        None => in_space.then(|| numbered_counts().chain(named).collect()),
    }
}

/// Brackets the points of a row, or of all rows in a list.
fn bracket(value: &mut Value, counts: &[usize]) {
    let Value::Array(list) = value else { return };
    if list.is_empty() || !list.iter().all(Value::is_number) {
        list.iter_mut().for_each(|child| match child {
            Value::Array(_) => bracket(child, counts),
            child => into_points(child, None),
        });
        return;
    }
    let fits = |width: &usize| counts.iter().any(|count| count * width == list.len());
    let Some(width) = [3, 4].into_iter().find(fits) else {
        return;
    };
    let points = list.chunks_exact(width).map(<[Value]>::to_vec);
    *list = points.map(Value::Array).collect();
}

/// The length of the first row of numbers in lists.
fn row_in(value: &Value) -> Option<usize> {
    // Shorter ones are points.
    const LEAST: usize = 6;
    let list = value.as_array()?;
    match list.len() >= LEAST && list.iter().all(Value::is_number) {
        true => Some(list.len()),
        false => list.iter().find_map(row_in),
    }
}

/// True if a field of this name in lower case holds something else than places in space.
pub(super) fn is_no_place(key: &str) -> bool {
    const OTHERS: [&str; 8] = [
        "orient", "rotation", "quat", "euler", "angle", "velocit", "accel", "2d",
    ];
    OTHERS.iter().any(|word| key.contains(word))
}
