//! Files in which a verb with text, JSON, CSV and a Python class appears, as docs/extending.md lists them, counted in
//! the code for existing verbs.

use std::path::Path;

use crate::rooms::sources;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Largest number of files that name the arguments or the result of a verb: its analysis, the verb, the list of the
/// verbs, and the analyses of Python.
const MOST: usize = 4;

/// Verbs with the types of their arguments and of their results.
const VERBS: [(&str, [&str; 2]); 5] = [
    ("bound", ["BoundArgs", "OutputBound"]),
    ("damping", ["DampingArgs", "DampedMode"]),
    ("identify", ["IdentifyArgs", "IdentificationRow"]),
    ("margins", ["MarginsArgs", "ScenarioMargins"]),
    ("worst", ["WorstArgs", "WorstCaseReport"]),
];

fn names(text: &str, word: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word)
        .any(|(at, _)| !text[..at].ends_with(is_letter) && !text[at + word.len()..].starts_with(is_letter))
}

#[test]
fn a_verb_is_named_by_its_analysis_itself_and_two_lists() {
    let mut all = Vec::new();
    for crate_of in ["analysis", "core", "cli", "py", "papers", "view", "figure"] {
        sources(Path::new(&format!("{ROOT}/crates/{crate_of}/src")), &mut all);
    }
    for (verb, types) in VERBS {
        // A figure has a file of its own.
        let figures = format!("crates/cli/src/{verb}/figures.rs");
        let is_one = |(name, text): &&(String, String)| {
            !name.ends_with("tests.rs")
                && !figures.ends_with(name.as_str())
                && types.iter().any(|word| names(text, word))
        };
        let found: Vec<&str> = all.iter().filter(is_one).map(|(name, _)| name.as_str()).collect();
        assert!(found.len() <= MOST, "{verb} is named in {found:?}");
        for own in [format!("cli/src/{verb}/mod.rs"), "cli/src/lib.rs".to_owned()] {
            assert!(found.iter().any(|name| name.ends_with(&own)), "{verb} is not named in {own}: {found:?}");
        }
    }
}
