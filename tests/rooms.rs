//! Structure of the sources: no circle of imports between the modules of a crate, a comment at the top of each file that
//! says its job, and examples in the documentation that are run.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The crates of the engine, each above those before it.
pub const ENGINE: [&str; 16] = [
    "flight",
    "flight-precision",
    "numerics",
    "dynamics",
    "formats",
    "relay-kernel",
    "spacecraft",
    "record",
    "control",
    "scenario",
    "sim",
    "analysis",
    "core",
    "view",
    "handover",
    "cosim",
];

/// Crates around the engine whose rooms form no circle either.
const AROUND: [&str; 6] = ["cli", "export-c", "figure", "fmi", "py", "web"];

/// The Rust files under a directory: their paths below the repository, and their texts.
pub fn sources(directory: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(directory).expect("a directory").flatten() {
        let path = entry.path();
        if path.is_dir() {
            if path.file_name().is_some_and(|name| name != "target") {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(ROOT).expect("within").to_string_lossy().replace('\\', "/");
            found.push((name, fs::read_to_string(&path).expect("text")));
        }
    }
}

/// The modules that a text names after `crate::`, say, alone or in braces.
fn named(text: &str, from: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        text.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
    };
    let mut rooms = BTreeSet::new();
    for (at, path) in text.match_indices(from) {
        let line = text[..at].rsplit('\n').next().unwrap_or_default();
        let rest = &text[at + path.len()..];
        if line.contains("//") || line.ends_with('$') || line.ends_with("super::") {
            continue;
        }
        if let Some(braced) = rest.strip_prefix('{') {
            let inside = &braced[..braced.find("};").unwrap_or(braced.len())];
            let mut depth = 0_usize;
            for part in inside.split_inclusive([',', '{', '}']) {
                if depth == 0 {
                    rooms.insert(word(part.trim_start()));
                }
                match part.chars().last() {
                    Some('{') => depth += 1,
                    Some('}') => depth = depth.saturating_sub(1),
                    _ => {}
                }
            }
        } else {
            rooms.insert(word(rest));
        }
    }
    rooms
}

/// The crate of a file of the engine, and its room: the first part of its path below `src`.
fn room(name: &str) -> (&str, &str) {
    let (root, name) = name.split_once("/src/").expect("of the engine");
    (root, name.split('/').next().map_or(name, |first| first.trim_end_matches(".rs")))
}

#[test]
fn no_arrow_runs_in_a_circle() {
    let mut files = Vec::new();
    for part in ENGINE.into_iter().chain(AROUND) {
        sources(&Path::new(ROOT).join("crates").join(part).join("src"), &mut files);
    }
    // Cargo allows no circle of crates; within each, `crate::` names the rooms.
    let rooms: BTreeSet<String> =
        files.iter().map(|(name, _)| room(name)).map(|(part, room)| format!("{part}/{room}")).collect();
    let mut arrows: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for (name, text) in &files {
        // Tests may import from anywhere.
        if name.ends_with("tests.rs") || name.ends_with("src/lib.rs") {
            continue;
        }
        let (part, own) = room(name);
        let own = format!("{part}/{own}");
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let named: BTreeSet<String> =
            named(text, "crate::").iter().map(|to| format!("{part}/{to}")).collect();
        for to in named.intersection(&rooms).filter(|to| **to != own) {
            arrows.entry(own.clone()).or_default().insert(to.clone(), name.clone());
        }
    }
    assert!(arrows.len() > 15, "{arrows:?}");
    let circle = circles(&arrows);
    assert!(circle.is_empty(), "rooms in circles: {circle:#?}");
}

#[test]
fn no_two_files_of_a_folder_import_each_other() {
    let mut files = Vec::new();
    sources(&Path::new(ROOT).join("crates"), &mut files);
    let paths: BTreeSet<String> = files.iter().map(|(name, _)| name.clone()).collect();
    let mut arrows: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for (name, text) in &files {
        let (folder, file) = name.rsplit_once('/').expect("a path");
        // A grammar is a circle of expressions and statements, and so are the files that translate it.
        if file == "mod.rs" || name.ends_with("tests.rs") || folder.ends_with("export-c/src/translate") {
            continue;
        }
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        for to in named(text, "super::") {
            let beside = [format!("{folder}/{to}.rs"), format!("{folder}/{to}/mod.rs")];
            if let Some(to) = beside.into_iter().find(|to| paths.contains(to) && to != name) {
                arrows.entry(name.clone()).or_default().insert(to, "by name".to_owned());
            }
        }
    }
    assert!(arrows.len() > 200, "{}", arrows.len());
    let circle = circles(&arrows);
    assert!(circle.is_empty(), "files in circles: {circle:#?}");
}

/// Returns the imports that form circles, each with the file where it is.
fn circles(arrows: &BTreeMap<String, BTreeMap<String, String>>) -> Vec<String> {
    // Rooms without an import in or out are removed, until none is left or all are in circles.
    let mut left: BTreeSet<&String> = arrows.keys().collect();
    let is_free = |left: &BTreeSet<&String>, room: &String| {
        arrows[room].keys().all(|to| !left.contains(to))
            || left.iter().all(|from| !arrows[*from].contains_key(room))
    };
    while let Some(free) = left.iter().copied().find(|room| is_free(&left, room)) {
        left.remove(free);
    }
    left.iter()
        .flat_map(|from| {
            arrows[*from]
                .iter()
                .filter(|(to, _)| left.contains(to))
                .map(move |(to, file)| format!("{from} -> {to} ({file})"))
        })
        .collect()
}

#[test]
fn files_say_their_job() {
    let mut files = Vec::new();
    for part in ["crates", "tests", "benches"] {
        sources(&Path::new(ROOT).join(part), &mut files);
    }
    assert!(files.len() > 400, "{}", files.len());
    for (name, text) in files {
        assert!(text.starts_with("//!"), "{name} does not begin with its job");
    }
}

/// First words of code blocks that rustdoc compiles; one without a word is compiled as well.
const COMPILED: [&str; 6] = ["rust", "no_run", "should_panic", "compile_fail", "ignore", "edition"];

/// Returns how many examples in Rust the documentation comments of a text have.
fn documented_examples(text: &str) -> usize {
    let comments = text.lines().filter_map(|line| {
        let line = line.trim_start();
        line.strip_prefix("///").or_else(|| line.strip_prefix("//!"))
    });
    // Every second fence ends a block.
    let fences = comments.filter_map(|comment| comment.trim_start().strip_prefix("```"));
    let is_compiled = |word: &&str| word.is_empty() || COMPILED.iter().any(|known| word.starts_with(known));
    fences.step_by(2).filter(is_compiled).count()
}

/// The documentation of a crate without examples is not compiled as tests, and that of a crate with examples is.
#[test]
fn examples_in_the_documentation_are_run() {
    let (mut run, mut files) = (0, Vec::new());
    sources(&Path::new(ROOT).join("crates"), &mut files);
    for entry in fs::read_dir(Path::new(ROOT).join("crates")).expect("the crates").flatten() {
        let name = entry.file_name().into_string().expect("text");
        let manifest = fs::read_to_string(entry.path().join("Cargo.toml")).expect("a manifest");
        let within = format!("crates/{name}/src/");
        let own = files.iter().filter(|(path, _)| path.starts_with(&within));
        let examples: usize = own.map(|(_, text)| documented_examples(text)).sum();
        let is_left_out = manifest.contains("\ndoctest = false\n");
        assert_eq!(
            examples == 0,
            is_left_out,
            "crates/{name} has {examples} examples: `doctest = false` is for crates without any"
        );
        run += examples;
    }
    assert!(run >= 4, "{run}");
}
