//! Options of reading: from keyword arguments of Python to those of the library.

use morec::files::FileReader;
use morec::formats::bvh::PositionChannels;
use morec::import::ImportOptions;
use morec::roles::mapping::Mapping;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::value_error;

/// Options of reading, as the keyword arguments of `morec.read` say.
///
/// # Errors
/// An invalid value: another word for `positions`, an unknown axis, unknown roles.
pub fn reader(options: &Bound<'_, PyDict>) -> PyResult<FileReader> {
    let mut reader = FileReader::default();
    let (mut up, mut unit, mut roles) = (None::<String>, None, None);
    for (key, value) in options.iter() {
        match key.extract::<String>()?.as_str() {
            "skeleton" => reader.skeleton = Some(value.extract()?),
            "file_rate" => reader.rate_hz = Some(rate("file_rate", value.extract()?)?),
            "positions" => reader.positions = Some(channels(&value.extract::<String>()?)?),
            "up" => up = Some(value.extract()?),
            "unit" => unit = Some(value.extract()?),
            "roles" => roles = Some(value),
            other => return Err(value_error(format!("no option is called {other}"))),
        }
    }
    reader.import = import_options(up.as_deref(), unit, roles.as_ref())?;
    Ok(reader)
}

fn rate(name: &str, rate_hz: f64) -> PyResult<f64> {
    match rate_hz.is_finite() && rate_hz > 0.0 && rate_hz <= 100_000.0 {
        true => Ok(rate_hz),
        false => Err(value_error(format!(
            "{name}: expected a rate in Hz, above 0 and at most 100000, found {rate_hz}"
        ))),
    }
}

fn channels(word: &str) -> PyResult<PositionChannels> {
    match word {
        "replace" => Ok(PositionChannels::Replace),
        "add" => Ok(PositionChannels::Add),
        _ => Err(value_error(format!(
            "positions: expected \"replace\" or \"add\", found {word:?}"
        ))),
    }
}

/// Options of the import from Python's arguments: the axis that is up, metres in a unit, and roles, as the text of a mapping
/// file or a dictionary of role to joint (`"LKNE+LKNM"` for the middle of two, `None` for nobody).
///
/// # Errors
/// An invalid axis or unit, an unknown role.
pub fn import_options(
    up: Option<&str>,
    unit: Option<f64>,
    roles: Option<&Bound<'_, PyAny>>,
) -> PyResult<ImportOptions> {
    if let Some(unit) = unit.filter(|unit| !(unit.is_finite() && *unit > 0.0)) {
        return Err(value_error(format!(
            "unit: expected metres above 0, found {unit}"
        )));
    }
    Ok(ImportOptions {
        up: up
            .map(|axis| axis.parse().map_err(|e| value_error(format!("up: {e}"))))
            .transpose()?,
        metres_per_unit: unit,
        mapping: roles.map(mapping).transpose()?,
        ..ImportOptions::default()
    })
}

/// Roles as a dictionary or as the text of a mapping file.
pub fn mapping(roles: &Bound<'_, PyAny>) -> PyResult<Mapping> {
    let text = match roles.cast::<PyDict>() {
        Ok(dict) => {
            let mut text = String::new();
            for (role, joint) in dict.iter() {
                let joint: Option<String> = joint.extract()?;
                let role: String = role.extract()?;
                text += &format!("{role}\t{}\n", joint.as_deref().unwrap_or("-"));
            }
            text
        }
        Err(_) => roles.extract()?,
    };
    Mapping::read(text.as_bytes()).map_err(|error| value_error(format!("roles: {error}")))
}
