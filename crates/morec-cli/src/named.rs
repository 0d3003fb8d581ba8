//! Enums of the libraries as arguments, by the libraries' own names.

use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A parser of the `name`s of `all`; help lists them in that order.
pub fn by_name<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = PossibleValuesParser::new(all.iter().map(|value| name(*value)));
    names.try_map(move |chosen| {
        let named = all.iter().find(|value| name(**value) == chosen);
        named.copied().ok_or("no such name")
    })
}
