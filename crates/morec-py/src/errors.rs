//! Exceptions and warnings of Python for the errors of the libraries.

use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;

use morec::files::{FileError, FileErrorKind};
use morec_db::DbError;
use morec_ops::OperationError;
use pyo3::create_exception;
use pyo3::exceptions::{
    PyException, PyFileExistsError, PyFileNotFoundError, PyKeyError, PyOSError, PyPermissionError,
    PyUserWarning, PyValueError,
};
use pyo3::prelude::*;

create_exception!(
    morec,
    MorecError,
    PyException,
    "An unusable file, label, motion or setting; the message says where and what was expected."
);
create_exception!(
    morec,
    MorecWarning,
    PyUserWarning,
    "Input was repaired, left out or is doubtful; the result is returned nevertheless."
);

/// Adds the types to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("MorecError", module.py().get_type::<MorecError>())?;
    module.add("MorecWarning", module.py().get_type::<MorecWarning>())
}

/// A `MorecError` with this text.
pub fn morec_error(error: impl Display) -> PyErr {
    MorecError::new_err(error.to_string())
}

/// A `ValueError` with this text.
pub fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An error of the system about a file, as the exception that Python itself would raise.
pub fn io_error(path: &Path, error: &std::io::Error) -> PyErr {
    let text = format!("{}: {error}", path.display());
    match error.kind() {
        ErrorKind::NotFound => PyFileNotFoundError::new_err(text),
        ErrorKind::PermissionDenied => PyPermissionError::new_err(text),
        ErrorKind::AlreadyExists => PyFileExistsError::new_err(text),
        _ => PyOSError::new_err(text),
    }
}

/// Why a file cannot be used: what the system said as Python's own exception, all else as a `MorecError`.
pub fn file_error(error: &FileError) -> PyErr {
    match &*error.kind {
        FileErrorKind::Io(why) => io_error(&error.path, why),
        _ => morec_error(error),
    }
}

/// Any error of the library.
pub fn library_error(error: morec::Error) -> PyErr {
    match error {
        morec::Error::File(error) => file_error(&error),
        morec::Error::Sensitivity(error) => value_error(format!("sensitivity: {error}")),
        morec::Error::Performer(error) => value_error(format!("performer: {error}")),
        error => morec_error(error),
    }
}

/// An error of the database, as the usual exception of Python.
pub fn db_error(error: DbError) -> PyErr {
    let text = error.to_string();
    match error {
        DbError::Missing(_) => PyFileNotFoundError::new_err(text),
        DbError::Exists(_) => PyFileExistsError::new_err(text),
        DbError::ReadOnly | DbError::ReadOnlyDisk => PyPermissionError::new_err(text),
        DbError::Unknown { .. } => PyKeyError::new_err(text),
        DbError::Invalid(_) => value_error(text),
        _ => MorecError::new_err(text),
    }
}

/// An error of an operation: of settings as a `ValueError`, of the database as [`db_error`], of anything else as a
/// `MorecError`.
pub fn operation_error(error: OperationError) -> PyErr {
    match error {
        OperationError::Param(_) | OperationError::Settings(_) => value_error(error),
        OperationError::Database(error) => db_error(error),
        error => morec_error(error),
    }
}

/// Warns once for each of `texts`, at the place in the user's program that called the package.
pub fn warn<T: Display>(py: Python<'_>, texts: impl IntoIterator<Item = T>) -> PyResult<()> {
    let category = py.get_type::<MorecWarning>();
    for text in texts {
        let text = std::ffi::CString::new(text.to_string().replace('\0', " "))?;
        PyErr::warn(py, category.as_any(), &text, 1)?;
    }
    Ok(())
}
