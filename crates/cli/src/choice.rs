//! Command-line options that accept the names of an enum's variants.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use schemars::{JsonSchema, schema_for};

/// Returns a parser of the word of a variant.
pub fn choice<T: Copy + JsonSchema + Send + Sync + 'static>(
    all: &'static [T],
    word: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let schema = schema_for!(T).to_value();
    let meaning = |word: &str| {
        let own = schema["oneOf"].as_array()?.iter().find(|own| own["const"] == word)?;
        own["description"].as_str().map(|text| text.trim_end_matches('.').to_owned())
    };
    let value = |of: &T| PossibleValue::new(word(*of)).help(meaning(word(*of)).unwrap_or_default());
    let values: Vec<PossibleValue> = all.iter().map(value).collect();
    let variant = move |given: String| all.iter().copied().find(|of| word(*of) == given);
    PossibleValuesParser::new(values).try_map(move |given| variant(given).ok_or("is no variant"))
}
