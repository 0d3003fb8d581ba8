//! Live sources by their address.

use morec::live::Source;

/// Opens the source at an address.
///
/// # Errors
/// Why it cannot be opened, in a sentence.
pub fn open(address: &str) -> Result<Box<dyn Source>, String> {
    Err(format!(
        "{address}: this build plays clips only; `morec live --listen {address}` listens to devices"
    ))
}
