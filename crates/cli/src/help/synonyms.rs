//! Verbs of other programs, with those that are meant.

use clap::error::{ContextKind, ContextValue, Error, ErrorKind};

/// Verbs of other programs, each with the verb that is meant, and its option.
pub const SYNONYMS: [(&str, &str); 27] = [
    ("animate", "export"),
    ("bode", "margins"),
    ("campaign", "simulate"),
    ("create", "new"),
    ("diff", "compare"),
    ("draw", "plot"),
    ("figure", "plot"),
    ("gui", "simulate --live"),
    ("init", "new"),
    ("lint", "check"),
    ("list", "examples"),
    ("monte-carlo", "simulate --runs"),
    ("nichols", "margins"),
    ("noise", "spectrum"),
    ("nyquist", "margins"),
    ("optimise", "tune"),
    ("optimize", "tune"),
    ("poles", "margins"),
    ("psd", "spectrum"),
    ("run", "simulate"),
    ("root-locus", "margins"),
    ("show", "plot"),
    ("sim", "simulate"),
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
