//! Numbers with units in scenarios: they are those in SI, whatever key they stand at.

use std::collections::BTreeSet;

use flexsc_core::{Document, Scenario};
use toml::Value;

use crate::util::{Dir, SCENARIOS, UNCERTAIN};

const PLAIN: &str = r#"
duration = 120.0

[spacecraft]
mass = 600.0
inertia = [[120.0, 0.0, 0.0], [0.0, 90.0, 0.0], [0.0, 0.0, 100.0]]
attitude = [0.0, 0.0, 0.0, 1.0]
rate = [0.017453292519943295, 0.0, 0.0]

[[appendage]]
name = "panel"
mass = 20.0
centre = [0.0, 1.5, 0.0]
inertia = [[20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 20.0]]
at = [0.5, 0.0, 0.0]
modes = [{ frequency = 3.141592653589793, damping = 0.002, translation = [0.0, 0.0, 2.0], rotation = [3.5, 0.0, 0.0] }]

[law.attitude]
period = 0.25
bandwidth = 0.1
damping = 0.7
"#;

#[test]
fn numbers_with_units_are_those_in_si() {
    let plain = Scenario::parse("x", PLAIN).unwrap_or_else(|error| panic!("{error}"));
    let mut text = PLAIN.to_owned();
    for (number, unit) in [
        ("120.0\n", "\"2 min\"\n"),
        ("600.0", "\"0.6e3 kg\""),
        ("[[120.0, 0.0, 0.0]", "[[\"120 kg m^2\", 0.0, \"0 g cm\u{b2}\"]"),
        ("0.017453292519943295", "\"1 deg/s\""),
        ("[0.5, 0.0, 0.0]", "[\"50cm\", 0.0, 0.0]"),
        ("frequency = 3.141592653589793", "frequency = \"0.5 Hz\""),
        ("bandwidth = 0.1", "bandwidth = \"100 mrad/s\""),
    ] {
        assert!(text.contains(number), "{number}");
        text = text.replacen(number, unit, 1);
    }
    let read = Scenario::parse("x", &text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.to_toml(), plain.to_toml());
}

#[test]
fn wrong_units_are_reported_all_at_once_with_their_places() {
    let text = PLAIN
        .replace("duration = 120.0", "duration = '2 kg'")
        .replace("frequency = 3.141592653589793", "frequency = '3 fortnights'")
        .replace("damping = 0.7", "damping = '70 deg'");
    let reported = Scenario::parse("x", &text).expect_err("refused").to_string();
    for words in [
        "x:2:12: `duration` has the unit `kg`, expected a unit such as `s`",
        "`appendage[0].modes[0].frequency` has the unit `fortnights`, which is not known; expected a unit such as `rad/s`",
        "`law.attitude.damping` has the unit `deg`, but takes a number without a unit",
    ] {
        assert!(reported.contains(words), "no `{words}` in\n{reported}");
    }
    assert_eq!(reported.matches('^').count(), 6 + 14 + 8, "{reported}");
}

#[test]
fn the_units_of_keys_are_known() {
    let reduced = Scenario::parse("x", UNCERTAIN).unwrap_or_else(|error| panic!("{error}"));
    let spacecraft = Scenario::parse("x", PLAIN).unwrap_or_else(|error| panic!("{error}"));
    for (key, unit) in [
        ("duration", Some("s")),
        ("body.planar.modes[0].frequency", Some("rad/s")),
        ("body.planar.rate", Some("rad/s")),
        ("law.relay.weak", Some("rad/s\u{b2}")),
        ("law.relay.k_t", None),
        ("seed", None),
        ("no.such", None),
    ] {
        assert_eq!(reduced.unit_of(key), unit, "{key}");
    }
    assert_eq!(spacecraft.unit_of("appendage[0].modes[0].frequency"), Some("rad/s"));
    assert_eq!(spacecraft.unit_of("spacecraft.inertia[0][0]"), Some("kg m\u{b2}"));
}

/// Every number of the shipped scenarios, with one of these units, is what it was or is refused for its unit. Elements of
/// a list have one unit: the first one stands for all, and so does a key of one scenario for the same key with the same
/// unit in others.
#[test]
fn every_key_with_a_unit_takes_it() {
    let schema: &'static _ = Box::leak(Box::new(Scenario::schema()));
    let (mut seen, mut taken, mut without) = (BTreeSet::new(), 0, Vec::new());
    for entry in std::fs::read_dir(SCENARIOS).expect("shipped").flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let scenario = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let plain = scenario.to_table();
        let mut keys = Vec::new();
        numbers(&Value::Table(plain.clone()), String::new(), &mut keys);
        let later_element = |key: &str| key.split('[').skip(1).any(|index| !index.starts_with("0]"));
        for (key, number) in keys.into_iter().filter(|(key, _)| !later_element(key)) {
            if !seen.insert((key.clone(), scenario.unit_of(&key))) {
                continue;
            }
            let mut fits = 0;
            for unit in ["s", "rad", "rad/s", "m", "kg", "N", "N m", "kg m^2", "rad/s^2", "N m s", "1/s", "T"]
            {
                let mut document = Document::from_table("x", plain.clone());
                document.set(&key, Value::String(format!("{number:e} {unit}"))).expect("a key");
                match document.in_si::<toml::Table>(|| schema) {
                    Ok(read) => {
                        assert_eq!(*read.table(), plain, "{key} {unit}");
                        fits += 1;
                    }
                    Err(error) => assert!(error.to_string().contains("has the unit"), "{error}"),
                }
            }
            taken += usize::from(fits > 0);
            if fits == 0 {
                without.push(key);
            }
        }
    }
    assert!(taken > 240, "{taken} with a unit, {} without: {without:#?}", without.len());
}

#[test]
fn the_command_and_its_options_take_units() {
    let dir = Dir::with(&["attitude-hold"]);
    dir.run("simulate attitude-hold.toml --set duration=2min --set name=short").exits(0).says(&["120 s"]);
    dir.run("simulate attitude-hold.toml --set duration=2kg").exits(2).says(&["`duration`", "unit `kg`"]);
}

/// The paths and values of the floating-point numbers within a value.
fn numbers(value: &Value, path: String, all: &mut Vec<(String, f64)>) {
    match value {
        Value::Float(number) if number.is_finite() => all.push((path, *number)),
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                numbers(value, format!("{path}[{index}]"), all);
            }
        }
        Value::Table(table) => {
            for (key, value) in table {
                let plain = key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
                let step = if plain { key.clone() } else { format!("\"{key}\"") };
                let path = if path.is_empty() { step } else { format!("{path}.{step}") };
                numbers(value, path, all);
            }
        }
        _ => {}
    }
}

#[test]
fn units_of_others_are_suggested() {
    for (from, to, meant) in [
        ("120.0\n", "\"120 secs\"\n", "s"),
        ("frequency = 3.141592653589793", "frequency = \"0.5 hz\"", "Hz"),
        ("0.017453292519943295", "\"10 RPM\"", "rpm"),
        ("0.017453292519943295", "\"10 deg/hrs\"", "deg/h"),
    ] {
        let reported = Scenario::parse("x", &PLAIN.replacen(from, to, 1)).expect_err("refused").to_string();
        assert!(reported.contains(&format!("did you mean `{meant}`?")), "{reported}");
    }
    let reported =
        Scenario::parse("x", &PLAIN.replace("120.0\n", "'3 fortnights'\n")).expect_err("refused").to_string();
    assert!(reported.contains("known are m, g, s, A"), "{reported}");
}

#[test]
fn a_percent_is_a_hundredth_and_nothing_else() {
    let plain = Scenario::parse("x", PLAIN).unwrap_or_else(|error| panic!("{error}"));
    let read =
        Scenario::parse("x", &PLAIN.replace("damping = 0.002", "damping = \"0.2 %\"")).expect("a scenario");
    assert_eq!(read.to_toml(), plain.to_toml());
    let reported =
        Scenario::parse("x", &PLAIN.replace("bandwidth = 0.1", "bandwidth = '10 %'")).expect_err("refused");
    assert!(reported.to_string().contains("expected a unit such as `rad/s`"), "{reported}");
}

#[test]
fn distributions_take_the_units_of_their_key() {
    let with = |distribution: &str| {
        let text = format!("{PLAIN}[uncertain]\n\"appendage[0].modes[0].frequency\" = {distribution}\n");
        Scenario::parse("x", &text).map(|scenario| scenario.to_toml()).map_err(|error| error.to_string())
    };
    let turn = std::f64::consts::TAU;
    for (units, plain) in [
        (
            "{ normal = { mean = \"1.5 Hz\", sd = \"0.25 Hz\" } }",
            format!("{{ normal = {{ mean = {}, sd = {} }} }}", 1.5 * turn, 0.25 * turn),
        ),
        ("{ uniform = [\"0.5 Hz\", 4.0] }", format!("{{ uniform = [{}, 4.0] }}", 0.5 * turn)),
        ("{ relative_normal = \"10 %\" }", "{ relative_normal = 0.1 }".to_owned()),
    ] {
        assert_eq!(with(units).expect("units"), with(&plain).expect("numbers"));
    }
    assert!(
        with("{ uniform = [\"1 m\", \"2 m\"] }")
            .expect_err("metres")
            .contains("expected a unit such as `rad/s`")
    );
}

#[test]
fn degrees_and_impossible_bodies_are_refused() {
    let target = "[[target]]\nfrom = 1.0\nyaw = 30\n";
    let reported = Scenario::parse("x", &format!("{PLAIN}{target}")).expect_err("degrees").to_string();
    assert!(reported.contains("in rad, or such as \"30 deg\", got 30"), "{reported}");
    Scenario::parse("x", &format!("{PLAIN}{}", target.replace("30", "\"30 deg\""))).expect("an angle");
    // Principal moments 300, 40 and 35 of no body, in its axes and turned by 30 degrees about z.
    for inertia in
        ["[[300, 0, 0], [0, 40, 0], [0, 0, 35]]", "[[235.0, 112.5833, 0], [112.5833, 105.0, 0], [0, 0, 35]]"]
    {
        let text = PLAIN.replace("[[120.0, 0.0, 0.0], [0.0, 90.0, 0.0], [0.0, 0.0, 100.0]]", inertia);
        let reported = Scenario::parse("x", &text).expect_err("no body").to_string();
        assert!(reported.contains("no principal moment exceeds the sum of the other two"), "{reported}");
    }
}
