//! A span of time is one type, `mocap::TimeSpan`: no struct has a start and a stop in seconds of its own.

use std::collections::BTreeSet;
use std::path::Path;

use syn::visit::{self, Visit};
use syn::{Fields, ItemMod, ItemStruct, Variant};

use crate::circles::is_test;
use crate::sources;

/// Structs and variants that have a start and a stop side by side, and why.
const APART: &[(&str, &str)] = &[
    ("TimeSpan", "the type itself"),
    ("MorecEvent", "C reads it"),
    ("MotionSeg", "C reads it"),
    (
        "SampleRow",
        "JavaScript gives both times or neither, and unknown fields are refused",
    ),
    (
        "JsonRow",
        "a row of JSON has seconds, or frames, or neither",
    ),
    ("DbSample", "a row of the database"),
    ("NewSample", "a row of the database"),
    ("ChangedLabel", "rows of the database, before and after"),
    ("Move", "a row of the database that is given other times"),
];

#[derive(Default)]
struct Found(Vec<String>);

impl Found {
    fn look(&mut self, name: &syn::Ident, fields: &Fields) {
        let has = |name: &str| {
            let mut names = fields.iter().filter_map(|field| field.ident.as_ref());
            names.any(|ident| ident == name)
        };
        if has("start_secs") && has("stop_secs") {
            self.0.push(name.to_string());
        }
    }
}

impl<'a> Visit<'a> for Found {
    fn visit_item_struct(&mut self, item: &'a ItemStruct) {
        self.look(&item.ident, &item.fields);
    }

    fn visit_variant(&mut self, variant: &'a Variant) {
        self.look(&variant.ident, &variant.fields);
    }

    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }
}

/// Names of the structs and variants of `text` that have both.
fn found(path: &Path, text: &str) -> Vec<String> {
    let mut found = Found::default();
    let file = syn::parse_file(text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    found.visit_file(&file);
    found.0
}

#[test]
fn spans_are_found_wherever_they_stand() {
    let text = "struct A { pub start_secs: f64, class: u8, stop_secs: Option<f64> } struct B { start_secs: f64 } \
                enum C { D { stop_secs: f64, start_secs: f64 }, E(TimeSpan) } mod inner { struct F { span: TimeSpan } } \
                #[cfg(test)] mod tests { struct G { start_secs: f64, stop_secs: f64 } }";
    assert_eq!(found(Path::new("a.rs"), text), ["A", "D"]);
}

#[test]
fn a_span_of_time_is_one_type() {
    let mut places = vec![];
    for (folder, files) in sources::by_crate() {
        for (path, text) in &files {
            let names = found(path, text).into_iter();
            places.extend(names.map(|name| (name, format!("{folder}: {}", path.display()))));
        }
    }
    let names: BTreeSet<&str> = places.iter().map(|(name, _)| name.as_str()).collect();
    let allowed: BTreeSet<&str> = APART.iter().map(|(name, _)| *name).collect();
    let unused: Vec<_> = allowed.difference(&names).collect();
    assert!(
        unused.is_empty(),
        "no such fields any more, to be taken from the list: {unused:?}"
    );
    places.retain(|(name, _)| !allowed.contains(name.as_str()));
    assert!(
        places.is_empty(),
        "a field `span: TimeSpan` in place of two: {places:#?}"
    );
}
