//! Every key of a scenario is in docs/scenario, in the section that it belongs to: a line ``Keys: `flexsc schema sensor.gyro` ``
//! stands for the table of these keys, any other key is named in the text.

use std::collections::{BTreeMap, BTreeSet};

use flexsc_core::Scenario;
use serde_json::Value as Json;

use crate::util::Dir;

const PAGES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scenario");

/// Beginning of a line that stands for the keys of a table.
const TABLE: &str = "Keys: `flexsc schema ";

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

/// Returns the paths of the tables whose keys a page has.
fn tables(page: &str) -> Vec<&str> {
    let rests = page.lines().filter_map(|line| line.strip_prefix(TABLE));
    rests.filter_map(|rest| rest.split('`').next()).map(|path| path.trim_matches('.')).collect()
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

/// Returns true if one of these tables has a key.
fn is_in(tables: &[&str], path: &str) -> bool {
    let is_below = |table: &str| path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'));
    tables.iter().any(|table| is_below(table) || (table.is_empty() && !path.contains('.')))
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
    page: (&[Section], &[&str]),
    keys: &mut BTreeMap<(String, String), (bool, String)>,
) {
    if let Some(name) = node["$ref"].as_str().and_then(|reference| reference.rsplit('/').next())
        && !within.contains(&name)
    {
        let within = [within, &[name]].concat();
        walk((schema, &schema["$defs"][name]), (path, name), &within, page, keys);
    }
    let branches = ["oneOf", "anyOf", "allOf"].into_iter().filter_map(|key| node[key].as_array()).flatten();
    for branch in branches.chain(node.get("items")) {
        walk((schema, branch), (path, owner), within, page, keys);
    }
    for (name, inner) in node["properties"].as_object().into_iter().flatten() {
        let full = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let known = keys.entry((owner.to_owned(), name.clone())).or_insert_with(|| (false, full.clone()));
        known.0 |= is_in(page.1, &full) || has(page.0, &full);
        walk((schema, inner), (&full, owner), within, page, keys);
    }
}

#[test]
fn every_key_is_documented() {
    let page = pages();
    let (schema, mut keys) = (Scenario::schema(), BTreeMap::new());
    let (sections, tables) = (sections(&page), tables(&page));
    walk((&schema, &schema), ("", "Scenario"), &[], (&sections, &tables), &mut keys);
    let missing: Vec<&String> = keys.values().filter(|(known, _)| !known).map(|(_, path)| path).collect();
    assert!(missing.is_empty(), "docs/scenario does not have {missing:?}");
    // A table that is removed from its page is reported.
    let others: Vec<&str> = tables.iter().copied().filter(|table| *table != "sensor.gyro").collect();
    assert!(is_in(&tables, "sensor.gyro.noise") && !is_in(&others, "sensor.gyro.noise"));
    assert!(!has(&sections, "sensor.gyro.bias") && keys.len() > 250, "{}", keys.len());
}

#[test]
fn every_table_of_the_pages_exists() {
    let page = pages();
    let tables = tables(&page);
    assert!(tables.len() > 40, "{tables:?}");
    let dir = Dir::new();
    for table in tables {
        let table = if table.is_empty() { "." } else { table };
        let keys = dir.run(&format!("schema {table} --json")).exits(0).json();
        let keys = keys.as_array().expect("a list");
        assert!(!keys.is_empty() && keys.iter().all(|key| key["meaning"] != ""), "{table}: {keys:?}");
    }
}
