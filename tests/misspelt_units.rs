//! Misspelt keys whose values have units: the name is the one mistake, and no value is refused for its unit.

use flexsc_core::{Document, Scenario};
use toml::{Table, Value};

use crate::util::{Dir, SCENARIOS};

/// Replacements in `cubesat-day`: a text, the text in its place, and the key that is suggested.
#[rustfmt::skip] // One case a line.
const MISSPELT: &[(&str, &str, &str)] = &[
    ("node = 5.9", "raan = \"90 deg\"", "node"),
    ("angle_random_walk = 3e-5", "arw = \"0.15 deg/sqrt(h)\"", "angle_random_walk"),
    // Its unit is that of the drift, and not of the random walk that is suggested.
    ("rate_random_walk = 1e-7", "rrw = \"3 deg/h\"", "rate_random_walk"),
    ("latitude = 0.85", "lat = \"48 deg\"", "latitude"),
    ("longitude = 0.15", "lon = \"11 deg\"", "longitude"),
    ("limb = 0.3", "earth = \"20 deg\"", "limb"),
    ("moment = 1.5", "momnt = \"1.5 A m^2\"", "moment"),
    ("momentum = 0.04", "momentm = \"40 mN m s\"", "momentum"),
    ("noise = [5e-5, 5e-5, 3e-4]", "nois = [\"10 arcsec\", \"10 arcsec\", \"1 arcmin\"]", "noise"),
    ("[environment]\norbit = { semi_major_axis = 6.928e6,", "[enviroment]\norbit = { semi_major_axis = \"6928 km\",", "environment"),
    ("wheels = { arrangement = \"orthogonal\", inertia = 4e-5", "wheells = { arrangement = \"orthogonal\", inertia = \"40 kg mm^2\"", "wheels"),
];

#[test]
fn the_name_is_the_one_mistake() {
    let dir = Dir::with(&["cubesat-day"]);
    let text = dir.text("cubesat-day.toml");
    for (from, to, meant) in MISSPELT {
        assert!(text.contains(from), "{from}");
        dir.write("bad.toml", text.replacen(from, to, 1));
        let ran = dir.run("check bad.toml").exits(2).says(&[&format!("did you mean `{meant}`?")]);
        assert_eq!(ran.err.matches("bad.toml:").count(), 1, "{to}: {}", ran.err);
    }
    let uncertain =
        "[uncertain]\n\"environment.orbit.noed\" = { normal = { mean = \"3 deg\", sd = \"1 deg\" } }\n";
    assert!(text.contains("[uncertain]\n"), "drawn keys");
    dir.write("bad.toml", text.replacen("[uncertain]\n", uncertain, 1));
    let ran = dir.run("check bad.toml").exits(2).says(&["environment.orbit.noed"]);
    assert!(!ran.err.contains("expected a number"), "{}", ran.err);
}

#[test]
fn every_key_with_a_unit_may_be_misspelt() {
    let mut tried = 0;
    for name in ["cubesat-day", "site-pass", "relay-adaptive", "slew-wheel-lqg", "wheel-run-up"] {
        let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a scenario");
        let scenario = Scenario::parse(name, &text).expect("a scenario");
        let table: Table = text.parse().expect("TOML");
        for (path, number) in numbers(&table) {
            let Some(unit) = scenario.unit_of(&path) else { continue };
            let (above, key) = path.rsplit_once('.').unwrap_or(("", &path));
            let mut misspelt = table.clone();
            let inner = table_at(&mut misspelt, above);
            let place = inner.remove(key).is_some();
            assert!(place, "{path}");
            inner.insert(format!("{key}zz"), Value::String(format!("{number} {unit}")));
            let error = Scenario::from_document(&Document::from_table(name, misspelt)).expect_err(&path);
            let mistakes = error.mistakes();
            assert!(mistakes[0].message.contains(&format!("unknown key `{key}zz`")), "{path}: {error}");
            let others = mistakes.iter().filter(|mistake| mistake.message.contains("expected a number"));
            assert_eq!(others.count(), 0, "{path}: {error}");
            tried += 1;
        }
    }
    assert!(tried > 60, "{tried}");
}

/// Returns the numbers of a table by their paths, beside those of `[uncertain]`.
fn numbers(table: &Table) -> Vec<(String, f64)> {
    fn search(value: &Value, path: String, found: &mut Vec<(String, f64)>) {
        match value {
            Value::Table(table) => {
                for (key, value) in table {
                    search(value, format!("{path}.{key}"), found);
                }
            }
            Value::Array(values) => {
                for (index, value) in values.iter().enumerate().filter(|(_, value)| value.is_table()) {
                    search(value, format!("{path}[{index}]"), found);
                }
            }
            Value::Float(number) => found.push((path, *number)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    for (key, value) in table.iter().filter(|(key, _)| *key != "uncertain") {
        search(value, key.clone(), &mut found);
    }
    found
}

/// Returns the table at a path of keys and places in arrays.
fn table_at<'a>(table: &'a mut Table, path: &str) -> &'a mut Table {
    let mut inner = table;
    for step in path.split('.').filter(|step| !step.is_empty()) {
        let (key, places) = step.split_once('[').unwrap_or((step, ""));
        let mut value = inner.get_mut(key).expect("a key");
        for place in places.split('[').filter(|place| !place.is_empty()) {
            let place: usize = place.trim_end_matches(']').parse().expect("a place");
            value = value.get_mut(place).expect("an element");
        }
        inner = value.as_table_mut().expect("a table");
    }
    inner
}
