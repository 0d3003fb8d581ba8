//! Words of a command line for the enumerations of libraries, which know nothing of it.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A parser of the words of an enumeration, with help for each.
pub(crate) fn choices<T: DeserializeOwned + Clone + Send + Sync + 'static>(
    words: impl IntoIterator<Item = (&'static str, &'static str)>,
) -> impl TypedValueParser<Value = T> {
    let word = |(word, help)| PossibleValue::new(word).help(help);
    let words: Vec<PossibleValue> = words.into_iter().map(word).collect();
    PossibleValuesParser::new(words)
        .try_map(|word| serde_json::from_value::<T>(Value::String(word)))
}
