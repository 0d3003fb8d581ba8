//! Places in matrices of four by four, as augmented reality and engines write joints: ARKit's columns, or rows.

use serde_json::Value;

use crate::math::Vec3;

/// Fields that hold a joint's matrix in the world or in the body; those in the parent's frame place nothing.
pub(super) const FIELDS: [&str; 6] = [
    "transform",
    "matrix",
    "modelTransform",
    "worldTransform",
    "anchorFromJointTransform",
    "world_matrix",
];

/// Where a matrix moves the origin: 16 numbers or four lists of four, columns first or rows first, by where 0 0 0 1 stands.
pub(super) fn place(value: &Value) -> Option<Vec3> {
    // Deeper lists are no matrices, and a field may wrap one: `{"columns": […]}`.
    let value = value.get("columns").unwrap_or(value);
    let list = value.as_array()?;
    let numbers: Vec<f64> = match list.len() {
        16 => list.iter().map(Value::as_f64).collect::<Option<_>>()?,
        4 => {
            let row = |row: &Value| row.as_array().filter(|row| row.len() == 4).cloned();
            let rows: Option<Vec<Vec<Value>>> = list.iter().map(row).collect();
            let numbers = rows?.concat();
            numbers.iter().map(Value::as_f64).collect::<Option<_>>()?
        }
        _ => return None,
    };
    let is_last = |at: [usize; 4]| at.map(|at| numbers[at]) == [0.0, 0.0, 0.0, 1.0];
    let [x, y, z] = match () {
        () if is_last([3, 7, 11, 15]) => [12, 13, 14],
        () if is_last([12, 13, 14, 15]) => [3, 7, 11],
        () => return None,
    };
    Some(Vec3::new(numbers[x], numbers[y], numbers[z]))
}
