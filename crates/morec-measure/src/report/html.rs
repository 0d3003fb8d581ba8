//! Numbers and times in the form of the report.

use std::fmt::{self, Display};

pub(super) use crate::plot::Text;

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

/// Writes `rows` by `push`; those after the first `shown` unfold.
pub(super) fn unfolding<T>(
    out: &mut String,
    rows: &[T],
    shown: usize,
    push: impl Fn(&mut String, &[T]),
) {
    let (first, rest) = rows.split_at(rows.len().min(shown));
    push(out, first);
    if !rest.is_empty() {
        let summary = format!("<details><summary>{} more</summary>\n", rest.len());
        out.push_str(&summary);
        push(out, rest);
        out.push_str("</details>\n");
    }
}

/// `body` behind a table of its sections, which are named by `<h2>`; `motion`: one that follows it has the clips.
pub(super) fn with_contents(body: &str, motion: bool) -> String {
    let mut sections = body.split("<h2>");
    let mut out = sections.next().unwrap_or_default().to_owned();
    let (mut contents, mut rest) = (String::new(), String::new());
    for (number, section) in (1..).zip(sections) {
        let name = section.split("</h2>").next().unwrap_or_default();
        contents.push_str(&format!("<a href=\"#s{number}\">{name}</a>\n"));
        rest.push_str(&format!("<h2 id=\"s{number}\">{section}"));
    }
    if motion {
        contents.push_str("<a href=\"#motion\">Motion</a>\n");
    }
    out.push_str(&format!(
        "<nav class=\"contents\" aria-label=\"Contents\">\n{contents}</nav>\n{rest}"
    ));
    out
}
