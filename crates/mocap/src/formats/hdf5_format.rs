//! The descriptor of HDF5, present even if its reader is not built.

use super::descriptor::{FormatDescriptor, FormatInput};
use super::{Loaded, ParseError};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "hdf5",
    title: "poses (HDF5)",
    noun: "an HDF5 file",
    endings: &["h5", "hdf5", "hdf", "nwb", "slp"],
    looks_so: |h| h.bytes.starts_with(b"\x89HDF\r\n\x1A\n"),
    up: None,
    read,
};

#[cfg(feature = "hdf5")]
fn read(file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    super::hdf5::read_as(file)
}

#[cfg(not(feature = "hdf5"))]
fn read(_: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    Err(ParseError::new(
        super::Place::File,
        "a format that this build reads",
        "HDF5, which needs the feature `hdf5`: save positions as a table (`pandas.read_hdf(FILE).to_csv(\"poses.csv\")`) or in an .npz",
    ))
}
