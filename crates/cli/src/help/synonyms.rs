//! Verbs of other programs, with those that are meant.

use clap::error::{ContextKind, ContextValue, Error, ErrorKind};

/// Verbs of other programs, each with the verb that is meant.
pub const SYNONYMS: [(&str, &str); 20] = [
    ("bode", "margins"),
    ("campaign", "simulate"),
    ("create", "new"),
    ("draw", "plot"),
    ("figure", "plot"),
    ("init", "new"),
    ("lint", "check"),
    ("list", "examples"),
    ("nichols", "margins"),
    ("noise", "spectrum"),
    ("nyquist", "margins"),
    ("optimise", "tune"),
    ("optimize", "tune"),
    ("psd", "spectrum"),
    ("run", "simulate"),
    ("show", "plot"),
    ("start", "simulate"),
    ("validate", "check"),
    ("verify", "check"),
    ("view", "plot"),
];

/// Suggests the verb that is meant by one of another program, in place of one that is only spelt alike.
pub fn suggest(error: &mut Error) {
    if error.kind() != ErrorKind::InvalidSubcommand {
        return;
    }
    let Some(ContextValue::String(verb)) = error.get(ContextKind::InvalidSubcommand) else { return };
    if let Some((_, meant)) = SYNONYMS.iter().find(|(other, _)| *other == verb.as_str()) {
        let suggestion = ContextValue::Strings(vec![(*meant).to_owned()]);
        error.insert(ContextKind::SuggestedSubcommand, suggestion);
    }
}
