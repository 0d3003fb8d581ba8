//! Writing HTML and SVG: names come from files and may hold anything.

use std::fmt::{self, Display, Write};

/// Text made safe for element content and for attributes in double quotes.
pub(super) struct Text<'a>(pub &'a str);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                // Control characters are not allowed in HTML at all.
                c if c.is_control() => f.write_str(" ")?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// A figure with three decimals, or a dash.
pub(super) struct Figure(pub Option<f64>);

impl Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(value) => write!(f, "{value:.3}"),
            None => f.write_str("–"),
        }
    }
}

/// A time in seconds with two decimals, or a dash; `signed` shows a plus, too.
pub(super) fn secs(value: Option<f64>, signed: bool) -> String {
    match value {
        // No minus on what rounds to nothing.
        Some(value) if value.abs() < 0.005 => "0.00 s".to_owned(),
        Some(value) if signed => format!("{value:+.2} s"),
        Some(value) => format!("{value:.2} s"),
        None => "–".to_owned(),
    }
}
