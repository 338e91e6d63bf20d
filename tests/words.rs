//! STYLE.md, as far as a program can check it: doc lines, words of comments, names, and paths that the documentation names.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::rooms::{ENGINE, sources};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Openings of a doc line that leave its noun to another line.
const OPENINGS: [&str; 8] = ["What", "Who", "The same", "Those", "That", "Its", "Nothing", "None of"];

/// Words and phrases that the field does not use for what the code does.
const PRIVATE: [&str; 24] = [
    "at work", "come to", "comes to", "told", "tell", "tells", "so many", "so long", "so far", "so much",
    "whoever", "nobody", "feel", "feels", "felt", "lent", "borne", "abreast", "crew", "shall", "sight",
    "believes", "believed", "belief",
];

/// Parts of a name, between underscores or capitals, that the field does not use.
const PRIVATE_PARTS: [&str; 10] =
    ["tell", "told", "felt", "feel", "lent", "borne", "abreast", "crew", "sight", "belief"];

/// Returns the Rust sources of all crates and of the tests, without this file.
fn all_sources() -> Vec<(String, String)> {
    let mut files = Vec::new();
    sources(&Path::new(ROOT).join("crates"), &mut files);
    sources(&Path::new(ROOT).join("tests"), &mut files);
    files.retain(|(name, _)| !name.ends_with("tests/words.rs"));
    assert!(files.len() > 600, "{}", files.len());
    files
}

/// Returns the text of a doc line.
fn doc(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).map(str::trim_start)
}

/// Returns the comment of a line: after `//`, unless a quote comes before it.
fn comment(line: &str) -> Option<&str> {
    let (code, comment) = line.split_once("//")?;
    (!code.contains('"') && !code.ends_with(':')).then(|| comment.trim_start_matches(['/', '!']))
}

/// True if a text starts with a word or phrase.
fn starts_with_word(text: &str, word: &str) -> bool {
    text.strip_prefix(word).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
}

/// True if a text holds a word or phrase, in small letters, apart from code in backticks.
fn has_word(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '`')
            && !text[at + word.len()..]
                .starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '`' || c == '(')
    })
}

#[test]
fn doc_lines_name_their_subject() {
    let mut wrong = Vec::new();
    for (name, text) in all_sources() {
        let mut within = false;
        for (number, line) in text.lines().enumerate() {
            let doc = doc(line);
            if let Some(doc) = doc.filter(|_| !within)
                && OPENINGS.iter().any(|opening| starts_with_word(doc, opening))
            {
                wrong.push(format!("{name}:{}: {doc}", number + 1));
            }
            if line.trim_start().starts_with("/// ||") {
                wrong.push(format!("{name}:{}: {line}", number + 1));
            }
            within = doc.is_some();
        }
    }
    assert!(wrong.is_empty(), "{} doc lines: {wrong:#?}", wrong.len());
}

#[test]
fn comments_use_the_words_of_the_field() {
    let mut wrong = Vec::new();
    for (name, text) in all_sources() {
        for (number, line) in text.lines().enumerate() {
            let Some(comment) = comment(line) else { continue };
            // The line of sight of an instrument is a word of the field.
            let small =
                comment.to_lowercase().replace("lines of sight", "line").replace("line of sight", "line");
            for word in PRIVATE.iter().filter(|word| has_word(&small, word)) {
                wrong.push(format!("{name}:{}: `{word}` in{comment}", number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{} comments: {wrong:#?}", wrong.len());
}

/// Returns the kind and name of each item that is defined in a text: public or not.
fn items(text: &str) -> impl Iterator<Item = (bool, &str, &str)> {
    text.lines().filter_map(|line| {
        let rest = line.trim_start();
        let (public, rest) = match rest.strip_prefix("pub ") {
            Some(rest) => (true, rest),
            None if rest.starts_with("pub(") => (false, rest.split_once(") ")?.1),
            None => (false, rest),
        };
        let rest = rest.strip_prefix("const ").filter(|rest| rest.starts_with("fn ")).unwrap_or(rest);
        let (kind, rest) = rest.split_once(' ')?;
        if !["fn", "struct", "enum", "trait", "type", "mod"].contains(&kind) {
            return None;
        }
        let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()?;
        (!name.is_empty()).then_some((public, kind, name))
    })
}

/// Returns the words of a name, in small letters.
fn parts(name: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    for letter in name.chars() {
        if letter == '_' || letter.is_uppercase() {
            parts.push(String::new());
        }
        if letter != '_' {
            parts.last_mut().expect("one").extend(letter.to_lowercase());
        }
    }
    parts
}

#[test]
fn names_use_the_words_of_the_field() {
    let mut wrong = Vec::new();
    for (name, text) in all_sources() {
        for (_, kind, item) in items(&text) {
            let plain =
                item.replace("LineOfSight", "Line").replace("LinesOfSight", "Lines").replace("_of_sight", "");
            if item == "of" || parts(&plain).iter().any(|part| PRIVATE_PARTS.contains(&part.as_str())) {
                wrong.push(format!("{name}: {kind} {item}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn public_types_of_the_engine_have_names_of_their_own() {
    let mut types: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for part in ENGINE {
        let mut files = Vec::new();
        sources(&Path::new(ROOT).join("crates").join(part).join("src"), &mut files);
        // A stand-in for a feature that is left out has the names of what it stands for, and a twin in single precision those of its
        // original.
        files.retain(|(name, _)| !name.ends_with("/unavailable.rs") && !name.contains("/src/single/"));
        for (name, text) in files {
            for (_, _, item) in items(&text).filter(|(public, kind, item)| {
                *public
                    && ["struct", "enum", "trait", "type"].contains(kind)
                    && !["Output", "Target"].contains(item)
            }) {
                types.entry(item.to_owned()).or_default().push(name.clone());
            }
        }
    }
    types.retain(|_, files| files.len() > 1);
    assert!(types.is_empty(), "{types:#?}");
}

#[test]
fn paths_in_the_documentation_exist() {
    let mut files = Vec::new();
    for folder in ["crates", "tests", "scenarios", "docs", "benches", "site", "release"] {
        paths(&Path::new(ROOT).join(folder), &mut files);
    }
    let mut texts: Vec<(String, String)> = files
        .iter()
        .filter(|name| name.starts_with("docs/") && Path::new(name).extension().is_some_and(|e| e == "md"))
        .map(|name| (name.clone(), fs::read_to_string(Path::new(ROOT).join(name)).expect("text")))
        .collect();
    for name in ["README.md", "CONTRIBUTING.md", "STYLE.md", "SECURITY.md"] {
        texts.push((name.to_owned(), fs::read_to_string(Path::new(ROOT).join(name)).expect("text")));
    }
    for (name, text) in all_sources() {
        let docs = text.lines().filter_map(doc).collect::<Vec<_>>().join("\n");
        texts.push((name, docs));
    }
    let mut missing = Vec::new();
    for (name, text) in &texts {
        for word in text.split('`').skip(1).step_by(2).flat_map(str::split_whitespace) {
            let is_path = word.contains('/')
                && [".rs", ".py"].iter().any(|ending| word.ends_with(ending))
                && word.chars().all(|c| c.is_ascii_alphanumeric() || "_/.-".contains(c));
            if is_path
                && !files.iter().any(|file| {
                    *file == word || file.ends_with(&format!("/{word}")) || within_a_crate(file, word)
                })
            {
                missing.push(format!("{name}: {word}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

/// True if a file is the one that a path names below `crates`, with or without its `src`.
fn within_a_crate(file: &str, path: &str) -> bool {
    let Some((part, rest)) = file.strip_prefix("crates/").and_then(|file| file.split_once("/src/")) else {
        return false;
    };
    path == rest || path.strip_prefix(part).and_then(|path| path.strip_prefix('/')) == Some(rest)
}

/// Appends the paths of all files below a folder, from the repository's root on.
fn paths(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            paths(&path, found);
        } else {
            found.push(path.strip_prefix(ROOT).expect("within").to_string_lossy().replace('\\', "/"));
        }
    }
}

#[test]
fn the_policy_counts_the_unsafe_blocks() {
    let sources = all_sources();
    let crates = sources.iter().filter(|(name, _)| name.contains("crates/") && name.contains("/src/"));
    let blocks: usize = crates.map(|(_, text)| text.matches("unsafe {").count()).sum();
    let policy = std::fs::read_to_string(Path::new(ROOT).join("SECURITY.md")).expect("a text");
    assert!(blocks == 14 && policy.contains("The code has fourteen `unsafe` blocks"), "{blocks}");
}
