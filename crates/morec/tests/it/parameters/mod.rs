//! `docs/parameters.md` is generated from the code: values from the defaults, meanings from the fields' documentation,
//! reasons from [`notes`]. `MOREC_WRITE_DOCS=1 cargo test -p morec --test it parameters` writes it again.

mod groups;
mod notes;

use std::fmt::{Debug, Write};
use std::path::Path;

use serde_json::Value;

use notes::NOTES;

/// A struct of parameters with the values of its fields.
pub struct Group {
    /// The text above its table.
    pub intro: &'static str,
    /// The source file of the struct.
    pub source: &'static str,
    /// The name of the struct.
    pub name: &'static str,
    /// The beginning of its fields' paths.
    pub prefix: &'static str,
    /// Sets of values, each with the title of its column. Where a later set equals the first, its cell is empty.
    pub values: Vec<(&'static str, Fields)>,
}

/// Names and values of a struct's fields, in their order.
pub type Fields = Vec<(String, String)>;

/// The fields of a struct that can be serialised, named as `--param` names them.
pub fn serialised(params: &impl serde::Serialize) -> Fields {
    // Through text, so that single-precision values keep their short form.
    let text = serde_json::to_string(params).unwrap();
    let Value::Object(fields) = serde_json::from_str(&text).unwrap() else {
        panic!("not a struct: {text}")
    };
    let shown = |value: &Value| match value {
        Value::Number(number) => shown_number(number.as_f64().unwrap()),
        Value::String(word) => word.clone(),
        other => other.to_string(),
    };
    fields
        .iter()
        .map(|(name, value)| (name.clone(), shown(value)))
        .collect()
}

/// The fields of a struct that can only be printed.
pub fn printed(params: &impl Debug) -> Fields {
    let text = format!("{params:#?}");
    let mut fields = Fields::new();
    for line in text.lines() {
        let depth = line.len() - line.trim_start().len();
        let Some((name, value)) = line.trim().trim_end_matches(',').split_once(": ") else {
            continue;
        };
        if depth == 4 {
            let number = value
                .parse()
                .map_or_else(|_| value.to_owned(), shown_number);
            fields.push((name.to_owned(), number));
        }
    }
    fields
}

/// A number with four significant digits.
fn shown_number(value: f64) -> String {
    if value >= f64::from(f32::MAX) || value == usize::MAX as f64 {
        return "no limit".to_owned();
    }
    if value != 0.0 && value.abs() < 1e-3 {
        return format!("{value:e}");
    }
    let digits = match value {
        0.0 => 0,
        value => 3 - value.abs().log10().floor() as i32,
    };
    let scale = 10f64.powi(digits.max(0));
    format!("{}", (value * scale).round() / scale)
}

/// The documentation of each field of the struct `name` in `source`, as one line.
fn documentation(source: &str, name: &str) -> Fields {
    let body = source
        .split_once(&format!("pub struct {name} {{"))
        .unwrap_or_else(|| panic!("no struct {name}"))
        .1;
    let mut fields = Fields::new();
    let mut text = String::new();
    for line in body.lines().take_while(|line| *line != "}").map(str::trim) {
        if let Some(more) = line.strip_prefix("///") {
            write!(text, " {}", more.trim()).unwrap();
        } else if let Some((field, _)) = line
            .strip_prefix("pub ")
            .and_then(|rest| rest.split_once(':'))
        {
            let text = std::mem::take(&mut text);
            fields.push((field.to_owned(), without_links(text.trim())));
        }
    }
    fields
}

/// Documentation without rustdoc's links, fit for a cell of a table.
fn without_links(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("[`") {
        out.push_str(&rest[..at]);
        let (label, after) = rest[at + 1..].split_once(']').unwrap();
        out.push_str(label);
        rest = match after.strip_prefix('(') {
            Some(target) => target.split_once(')').unwrap().1,
            None => after,
        };
    }
    out.push_str(rest);
    out.replace('|', "\\|")
}

/// The table of one group; `is_group` says that a path has a table of its own.
fn table(group: &Group, is_group: impl Fn(&str) -> bool) -> String {
    let meanings = documentation(group.source, group.name);
    let titles: Vec<&str> = group.values.iter().map(|(title, _)| *title).collect();
    let mut text = format!(
        "{}\n\n| name | {} | meaning | reason for the value |\n|---|{}---|---|\n",
        group.intro,
        titles.join(" | "),
        "---|".repeat(titles.len())
    );
    // In the order of the declaration, which serialised fields lose.
    for (field, meaning) in &meanings {
        let path = format!("{}{field}", group.prefix);
        if is_group(&format!("{path}.")) {
            continue;
        }
        let values = values_of(group, field);
        let [first, others @ ..] = &values[..] else {
            panic!("{path} has no value")
        };
        let others: Vec<&str> = others
            .iter()
            .map(|value| if value == first { "" } else { *value })
            .collect();
        let cells: String = others.iter().map(|value| format!(" {value} |")).collect();
        let reason = NOTES.iter().find(|(name, _)| *name == path);
        let reason = match reason {
            Some((_, reason)) => *reason,
            None if titles.contains(&"prototype") && others.iter().all(|o| o.is_empty()) => {
                "prototype"
            }
            None => "",
        };
        writeln!(text, "| `{path}` | {first} |{cells} {meaning} | {reason} |").unwrap();
    }
    text
}

/// The values of a field in all sets of a group.
fn values_of<'a>(group: &'a Group, field: &str) -> Vec<&'a str> {
    let of = |fields: &'a Fields| fields.iter().find(|(name, _)| name == field);
    let sets = group.values.iter();
    sets.filter_map(|(_, fields)| of(fields).map(|(_, value)| value.as_str()))
        .collect()
}

fn page(groups: &[Group]) -> String {
    let is_group = |prefix: &str| groups.iter().any(|g| g.prefix == prefix);
    let tables: Vec<String> = groups.iter().map(|g| table(g, is_group)).collect();
    format!("{}\n{}", include_str!("head.md"), tables.join("\n"))
}

#[test]
fn the_page_of_parameters_is_that_of_the_code() {
    let groups = groups::all();
    let page = page(&groups);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/parameters.md");
    if std::env::var_os("MOREC_WRITE_DOCS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = kept.lines().zip(page.lines()).find(|(a, b)| a != b);
    assert!(
        kept == page,
        "docs/parameters.md is out of date, first at {differs:?}; write it again with \
         MOREC_WRITE_DOCS=1 cargo test -p morec --test it parameters"
    );
}

#[test]
fn every_reason_is_for_a_parameter() {
    let groups = groups::all();
    for (path, _) in NOTES {
        let known = groups.iter().any(|g| {
            let fields = &g.values[0].1;
            fields
                .iter()
                .any(|(name, _)| format!("{}{name}", g.prefix) == *path)
        });
        assert!(
            known,
            "notes.rs gives a reason for {path}, which is no parameter"
        );
    }
}

#[test]
fn numbers_are_short() {
    for (value, shown) in [
        (120.0, "120"),
        (10.0 / 120.0, "0.08333"),
        (6.25, "6.25"),
        (0.5f64.to_radians(), "0.008727"),
        (1e-10, "1e-10"),
        (0.0, "0"),
        (1234.5, "1235"),
        (usize::MAX as f64, "no limit"),
    ] {
        assert_eq!(shown_number(value), shown);
    }
}

#[test]
fn links_become_their_labels() {
    let text = "Of [`compress`](super::compress) and [`Rule::Verify`]; a|b.";
    assert_eq!(
        without_links(text),
        "Of `compress` and `Rule::Verify`; a\\|b."
    );
}
