//! Words of the command line for choices of libraries that do not depend on `clap`.

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

/// A share on the command line.
///
/// # Errors
/// No number from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}
