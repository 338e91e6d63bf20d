//! Every key of a scenario is in docs/scenario, in the section that it belongs to.

use std::collections::{BTreeMap, BTreeSet};

use flexsc_core::Scenario;
use serde_json::Value as Json;

const PAGES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scenario");

/// Section of the reference: the tables of a scenario that its heading names, and the words in its code.
struct Section {
    names: Vec<String>,
    words: BTreeSet<String>,
}

/// Returns the words in a code.
fn words(code: &str) -> impl Iterator<Item = String> + '_ {
    code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').map(str::to_owned)
}

/// Returns the pages of the reference, one after the other.
fn pages() -> String {
    let mut paths: Vec<_> = std::fs::read_dir(PAGES).expect("a folder").flatten().map(|e| e.path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read_to_string(path).expect("a page")).collect()
}

/// Returns the sections of a page.
fn sections(page: &str) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    let mut fenced = false;
    for line in page.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            sections.last_mut().expect("a heading before").words.extend(words(line));
        } else if line.starts_with('#') {
            let code = line.split('`').skip(1).step_by(2);
            let names = code.map(|name| name.trim_matches(['[', ']']).to_owned()).collect();
            sections.push(Section { names, words: BTreeSet::new() });
        } else if let Some(section) = sections.last_mut() {
            line.split('`').skip(1).step_by(2).for_each(|code| section.words.extend(words(code)));
        }
    }
    sections
}

/// Returns true if the page has a key: the sections that name the nearest table above it contain the rest of its path.
fn has(sections: &[Section], path: &str) -> bool {
    let above = |name: &str| path == name || path.starts_with(&format!("{name}."));
    let within = |name: &str| name.starts_with(&format!("{path}."));
    let names = || sections.iter().flat_map(|section| &section.names);
    if names().any(|name| within(name)) {
        return true;
    }
    let nearest = names().filter(|name| above(name)).map(String::len).max();
    let owners = sections.iter().filter(|section| match nearest {
        Some(length) => section.names.iter().any(|name| name.len() == length && above(name)),
        None => section.names.is_empty(),
    });
    let rest = &path[nearest.map_or(0, |length| (length + 1).min(path.len()))..];
    let known: BTreeSet<&String> = owners.flat_map(|section| &section.words).collect();
    words(rest).all(|word| word.is_empty() || known.contains(&word))
}

/// Checks for each key of each type of a schema that the page has it in one of its places.
fn walk(
    (schema, node): (&Json, &Json),
    (path, owner): (&str, &str),
    within: &[&str],
    sections: &[Section],
    keys: &mut BTreeMap<(String, String), (bool, String)>,
) {
    if let Some(name) = node["$ref"].as_str().and_then(|reference| reference.rsplit('/').next())
        && !within.contains(&name)
    {
        let within = [within, &[name]].concat();
        walk((schema, &schema["$defs"][name]), (path, name), &within, sections, keys);
    }
    let branches = ["oneOf", "anyOf", "allOf"].into_iter().filter_map(|key| node[key].as_array()).flatten();
    for branch in branches.chain(node.get("items")) {
        walk((schema, branch), (path, owner), within, sections, keys);
    }
    for (name, inner) in node["properties"].as_object().into_iter().flatten() {
        let full = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let known = keys.entry((owner.to_owned(), name.clone())).or_insert_with(|| (false, full.clone()));
        known.0 |= has(sections, &full);
        walk((schema, inner), (&full, owner), within, sections, keys);
    }
}

#[test]
fn every_key_is_documented() {
    let page = pages();
    let (schema, mut keys) = (Scenario::schema(), BTreeMap::new());
    walk((&schema, &schema), ("", "Scenario"), &[], &sections(&page), &mut keys);
    let missing: Vec<&String> = keys.values().filter(|(known, _)| !known).map(|(_, path)| path).collect();
    assert!(missing.is_empty(), "docs/scenario does not have {missing:?}");
    // A key that is removed from its page is reported.
    let without = page.replace("`noise`", "`noises`");
    assert!(without != page && !has(&sections(&without), "sensor.sampled.noise"));
    assert!(keys.len() > 250 && has(&sections(&page), "sensor.sampled.noise"), "{}", keys.len());
}
