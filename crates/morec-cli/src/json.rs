//! JSON output: indented, with the version of its form in every object.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};

pub use morec_ops::FORMAT_VERSION;

/// Writes a value as JSON, indented, with a line ending. The object, or each object of a list, begins with the
/// `format_version`. A closed pipe is an [`io::Error`].
pub fn write_json(out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    value.serialize(&mut Serializer::with_formatter(
        &mut *out,
        Versioned::default(),
    ))?;
    writeln!(out)
}

/// Indents, and puts the version first into the outermost objects.
#[derive(Default)]
struct Versioned {
    pretty: PrettyFormatter<'static>,
    depth: usize,
    /// The value as a whole is a list.
    is_list: bool,
    /// The version has just been written: the next key is not the first.
    written: bool,
}

impl Formatter for Versioned {
    fn begin_array<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.is_list |= self.depth == 0;
        self.depth += 1;
        self.pretty.begin_array(out)
    }

    fn end_array<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.pretty.end_array(out)
    }

    fn begin_array_value<W: Write + ?Sized>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.pretty.begin_array_value(out, first)
    }

    fn end_array_value<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.end_array_value(out)
    }

    fn begin_object<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.begin_object(out)?;
        self.depth += 1;
        if self.depth == 1 || self.is_list && self.depth == 2 {
            self.pretty.begin_object_key(out, true)?;
            out.write_all(b"\"format_version\"")?;
            self.pretty.end_object_key(out)?;
            self.pretty.begin_object_value(out)?;
            write!(out, "{FORMAT_VERSION}")?;
            self.pretty.end_object_value(out)?;
            self.written = true;
        }
        Ok(())
    }

    fn end_object<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.written = false;
        self.pretty.end_object(out)
    }

    fn begin_object_key<W: Write + ?Sized>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        let first = first && !std::mem::take(&mut self.written);
        self.pretty.begin_object_key(out, first)
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.begin_object_value(out)
    }

    fn end_object_value<W: Write + ?Sized>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.end_object_value(out)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn written(value: &Value) -> (String, Value) {
        let mut bytes = Vec::new();
        write_json(&mut bytes, value).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let read = serde_json::from_str(&text).unwrap();
        (text, read)
    }

    #[test]
    fn outermost_objects_say_their_version() {
        let (text, read) = written(&json!({ "a": { "b": [1, {}] }, "c": {} }));
        assert!(text.starts_with("{\n  \"format_version\": 1,\n  \"a\": {"));
        assert_eq!(
            read,
            json!({ "format_version": 1, "a": { "b": [1, {}] }, "c": {} })
        );
        let (text, read) = written(&json!([{ "a": [{ "b": 1 }] }, {}, 3]));
        assert!(text.starts_with("[\n  {\n    \"format_version\": 1,\n    \"a\": ["));
        assert_eq!(
            read,
            json!([{ "format_version": 1, "a": [{ "b": 1 }] }, { "format_version": 1 }, 3])
        );
        assert_eq!(written(&json!({})).1, json!({ "format_version": 1 }));
        assert_eq!(written(&json!([[{}], 1])).1, json!([[{}], 1]));
        assert_eq!(written(&json!("x")).0, "\"x\"\n");
    }
}
