//! Live sources by their address: VMC, Axis, lines of JSON.

use morec::live::Source;
use morec_live::{Address, Notices, SourceOptions, open_source};

/// A source that listens.
pub struct Opened {
    pub source: Box<dyn Source>,
    /// Its address, with the port that was free if any was asked for.
    pub name: String,
    /// Faults of the data that it is sent.
    pub notices: Notices,
}

/// Opens the source at an address.
///
/// # Errors
/// Why it cannot be opened, in a sentence.
pub fn open(address: &str) -> Result<Opened, String> {
    let parsed: Address = address.parse()?;
    if parsed.kind == "json" {
        return Err(format!(
            "{address}: the studio has no standard input; use json+tcp://127.0.0.1:9000"
        ));
    }
    let opened =
        open_source(&parsed, &SourceOptions::default()).map_err(|error| error.to_string())?;
    Ok(Opened {
        source: opened.source,
        name: opened.name,
        notices: opened.notices,
    })
}
