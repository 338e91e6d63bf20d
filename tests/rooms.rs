//! The house: no circle of imports between the rooms of the engine, no file above 400 lines, each says its job first.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
const LONGEST: usize = 400;

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

/// The rooms that a text names after `crate::`, alone or in braces.
fn named(text: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        text.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
    };
    let mut rooms = BTreeSet::new();
    for (at, path) in text.match_indices("crate::") {
        let line = text[..at].rsplit('\n').next().unwrap_or_default();
        let rest = &text[at + path.len()..];
        if line.contains("//") || line.ends_with('$') {
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

/// The room of a file of the engine.
fn room(name: &str) -> &str {
    let name = name.split_once("/src/").expect("of the engine").1;
    together(name.split('/').next().map_or(name, |first| first.trim_end_matches(".rs")))
}

/// The flows and the search of the crate `motion` are one room: `crate::motion` in the engine.
fn together(name: &str) -> &str {
    let motion = ["crossing", "guess", "linear", "state", "stretch", "turning"];
    if motion.contains(&name) { "motion" } else { name }
}

#[test]
fn no_arrow_runs_in_a_circle() {
    let mut files = Vec::new();
    for part in ["motion", "formats", "core"] {
        sources(&Path::new(ROOT).join("crates").join(part).join("src"), &mut files);
    }
    let rooms: BTreeSet<String> = files.iter().map(|(name, _)| room(name).to_owned()).collect();
    let mut arrows: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for (name, text) in &files {
        // Tests may look from anywhere.
        if name.ends_with("tests.rs") || name.ends_with("src/lib.rs") {
            continue;
        }
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let named: BTreeSet<String> = named(text).iter().map(|to| together(to).to_owned()).collect();
        for to in named.intersection(&rooms).filter(|to| *to != room(name)) {
            arrows.entry(room(name).to_owned()).or_default().insert(to.clone(), name.clone());
        }
    }
    assert!(arrows.len() > 15, "{arrows:?}");
    // Rooms without an arrow to a room that is left are taken away, until none is left or all are in circles.
    let mut left = rooms;
    while let Some(free) =
        left.iter().find(|from| arrows.get(*from).is_none_or(|to| to.keys().all(|to| !left.contains(to))))
    {
        let free = free.clone();
        left.remove(&free);
    }
    let circle: Vec<String> = left
        .iter()
        .flat_map(|from| {
            arrows[from]
                .iter()
                .filter(|(to, _)| left.contains(*to))
                .map(move |(to, file)| format!("{from} -> {to} ({file})"))
        })
        .collect();
    assert!(circle.is_empty(), "rooms in circles: {circle:#?}");
}

#[test]
fn files_are_short_and_say_their_job() {
    let mut files = Vec::new();
    for part in ["crates", "tests", "benches"] {
        sources(&Path::new(ROOT).join(part), &mut files);
    }
    assert!(files.len() > 400, "{}", files.len());
    for (name, text) in files {
        assert!(text.starts_with("//!"), "{name} does not begin with its job");
        let lines = text.lines().count();
        assert!(lines <= LONGEST, "{name} has {lines} lines");
    }
}
