//! NumPy arrays in and out.

use morec::math::Vec3;
use numpy::{
    Element, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::errors::value_error;

/// An array of `shape` that owns `values`; nothing is copied.
pub fn owned<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    PyArray1::from_vec(py, values).reshape(shape.to_vec())
}

/// The same, and it cannot be written to: several hold it.
pub fn shared<T: Element>(py: Python<'_>, values: Vec<T>, shape: &[usize]) -> PyResult<Py<PyAny>> {
    let array = owned(py, values, shape)?.into_any();
    let flags = pyo3::types::PyDict::new(py);
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array.unbind())
}

/// Numbers of any kind as an array of doubles; arrays of doubles are taken as they are.
///
/// # Errors
/// A value that NumPy cannot make numbers of.
pub fn doubles<'py>(value: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    static ASARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if let Ok(array) = value.cast::<PyArrayDyn<f64>>() {
        return Ok(array.try_readonly()?);
    }
    let py = value.py();
    let array = ASARRAY
        .import(py, "numpy", "asarray")?
        .call1((value, "float64"))?;
    Ok(array.cast_into::<PyArrayDyn<f64>>()?.try_readonly()?)
}

/// Positions of one instant, of shape (joints, 3), written to `out`. Doubles and singles in one piece are read in place.
///
/// # Errors
/// Another shape.
pub fn pose(value: &Bound<'_, PyAny>, joints: usize, out: &mut Vec<Vec3>) -> PyResult<()> {
    out.clear();
    if let Ok(array) = value.cast::<PyArrayDyn<f64>>() {
        return copy(&array.try_readonly()?, joints, |v| v, out);
    }
    if let Ok(array) = value.cast::<PyArrayDyn<f32>>() {
        return copy(&array.try_readonly()?, joints, f64::from, out);
    }
    copy(&doubles(value)?, joints, |v| v, out)
}

fn copy<T: Element + Copy>(
    array: &PyReadonlyArrayDyn<'_, T>,
    joints: usize,
    wide: impl Fn(T) -> f64,
    out: &mut Vec<Vec3>,
) -> PyResult<()> {
    if array.shape() != [joints, 3] {
        return Err(wrong_shape(&format!("({joints}, 3)"), array.shape()));
    }
    match array.as_slice() {
        Ok(values) => out.extend(
            values
                .chunks_exact(3)
                .map(|p| Vec3::new(wide(p[0]), wide(p[1]), wide(p[2]))),
        ),
        // In pieces: transposed, or every other joint of a larger array.
        Err(_) => {
            let view = array.as_array();
            out.extend(
                (0..joints)
                    .map(|j| Vec3::new(wide(view[[j, 0]]), wide(view[[j, 1]]), wide(view[[j, 2]]))),
            );
        }
    }
    Ok(())
}

/// Positions over time, of shape (frames, joints, 3), with the number of frames and of joints.
///
/// # Errors
/// Another shape.
pub fn motion(value: &Bound<'_, PyAny>) -> PyResult<(Vec<Vec3>, usize, usize)> {
    let array = doubles(value)?;
    let &[frames, joints, 3] = array.shape() else {
        return Err(wrong_shape("(frames, joints, 3)", array.shape()));
    };
    let view = array.as_array();
    let values: Vec<f64> = view.iter().copied().collect();
    let positions = values
        .chunks_exact(3)
        .map(|p| Vec3::new(p[0], p[1], p[2]))
        .collect();
    Ok((positions, frames, joints))
}

/// The error that an array has another shape.
pub fn wrong_shape(expected: &str, found: &[usize]) -> PyErr {
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    value_error(format!(
        "expected an array of shape {expected}, found ({})",
        found.join(", ")
    ))
}
