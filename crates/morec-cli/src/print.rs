//! Prints results on standard output: JSON, text, tables, numbers with units.

use std::io::{IsTerminal, Write};

use anyhow::Result;
use serde::Serialize;

use crate::json::write_json;
use crate::table::TextTable;

/// One value as JSON on standard output.
pub fn print_json(value: &impl Serialize) -> Result<()> {
    let mut out = crate::console::stdout();
    write_json(&mut out, value)?;
    out.flush()?;
    Ok(())
}

/// Text on standard output.
pub fn print(text: impl std::fmt::Display) -> Result<()> {
    let mut out = crate::console::stdout();
    write!(out, "{text}")?;
    out.flush()?;
    Ok(())
}

/// A table that fits the terminal, and a last line below it. Whoever reads it through a pipe gets all of it, separated by
/// tabs, and the last line on standard error.
pub fn print_table(table: &TextTable, last: &str) -> Result<()> {
    let mut out = crate::console::stdout();
    if std::io::stdout().is_terminal() {
        let width = terminal_size::terminal_size().map_or(80, |(width, _)| usize::from(width.0));
        write!(out, "{}{last}", table.fitted(width))?;
    } else {
        write!(out, "{}", table.tabbed())?;
        eprint!("{last}");
    }
    out.flush()?;
    Ok(())
}

/// `12 clips`, or `10 of 12 clips` where not all are shown.
pub fn counted(shown: usize, all: usize, what: &str) -> String {
    match shown == all {
        true => format!("{all} {what}\n"),
        false => format!("{shown} of {all} {what}\n"),
    }
}

/// `12.3 MB`.
pub fn megabytes(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        10_000..1_000_000 => format!("{:.0} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
