//! An index divided by classes among workers: its parts.

use std::sync::Arc;

use morec::index::{Model, MotionIndex};
use morec::templates::TemplateModel;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pub fn templates(index: &MotionIndex) -> PyResult<&TemplateModel> {
    match &index.model {
        Model::Templates(model) => Ok(model),
        Model::Svrdm(_) => Err(PyValueError::new_err(
            "an index of the method svrdm cannot be divided, because its tree needs all classes; it is small: give parts=1",
        )),
    }
}

/// Part `part` of `of` of an index: the templates of every `of`-th class.
pub fn part_of(index: &MotionIndex, part: usize, of: usize) -> PyResult<MotionIndex> {
    if part >= of {
        let message = format!("part: expected a number below {of}, found {part}");
        return Err(PyValueError::new_err(message));
    }
    Ok(MotionIndex {
        model: Model::Templates(Arc::new(templates(index)?.part(part, of))),
        ..index.clone()
    })
}
