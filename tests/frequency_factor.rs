//! One factor on all natural frequencies of an appendage, or of all appendages.

use flexsc_core::Scenario;

use crate::traces::traced;
use crate::util::Dir;

const START: &str =
    "duration = 30.0\n[spacecraft]\nmass = 11.0\ninertia = [[0.09, 0, 0], [0, 0.13, 0], [0, 0, 0.16]]\n";
const END: &str =
    "\n[law.pd]\nk_p = 0.01\nk_d = 0.06\nperiod = 0.5\n[[target]]\nfrom = 2.0\nroll = \"1 deg\"\n";
const PANEL: &str = "[[appendage]]\nname = \"panel\"\nmass = 0.35\nat = [0.0, 0.1, 0.0]\n";
const MODES: &str =
    "centre = [0, 0.15, 0]\ninertia = [[0.003, 0, 0], [0, 0.0012, 0], [0, 0, 0.0042]]\nplate = \"y\"\n";

fn read(panel: &str, factor: &str) -> Scenario {
    let text = format!("{START}{factor}{PANEL}{panel}{END}");
    Scenario::parse("panel.toml", &text).expect(&text)
}

/// Returns all rows of a run, in full.
fn rows(scenario: &Scenario) -> String {
    let topics = ["/pointing", "/rates", "/energy", "/torques", "/vibrations"];
    let trace = traced(scenario);
    topics.map(|topic| format!("{:?}", trace.topic(topic))).concat()
}

/// Returns the rows with a factor of its own and with one for all, and asserts that they are those without it and other
/// frequencies.
fn scales(plain: &str, scaled: &str) {
    let expected = rows(&read(scaled, ""));
    assert!(expected.contains("roll_error_rad") && rows(&read(plain, "")) != expected);
    assert!(rows(&read(&format!("frequency_factor = 1.2\n{plain}"), "")) == expected, "its own: {plain}");
    assert!(rows(&read(plain, "frequency_factor = 1.2\n")) == expected, "of all: {plain}");
    let both = read(&format!("frequency_factor = 1.5\n{plain}"), "frequency_factor = 0.8\n");
    let once = read(&format!("frequency_factor = {}\n{plain}", 1.5 * 0.8), "");
    assert!(rows(&both) == rows(&once), "both: {plain}");
}

#[test]
fn a_factor_is_that_of_each_frequency() {
    let modes = |frequencies: [f64; 2]| {
        let [first, second] = frequencies;
        format!(
            "{MODES}modes = [{{ frequency = {first:?}, damping = 0.005, translation = [0, 0, 0.46], rotation = [0.1, 0, 0] }}, \
             {{ frequency = {second:?}, damping = 0.002, rotation = [0, 0.02, 0] }}]"
        )
    };
    scales(&modes([14.5, 31.0]), &modes([14.5 * 1.2, 31.0 * 1.2]));
    let plate = |frequency: f64| {
        format!("plate = {{ length = 0.3, width = 0.2, frequency = {frequency:?}, damping = 0.005 }}")
    };
    scales(&plate(14.5), &plate(14.5 * 1.2));
}

/// Modes of a CSV file, beside the same with other frequencies in the scenario.
#[test]
fn a_factor_is_that_of_each_frequency_in_a_file() {
    let dir = Dir::new();
    dir.write("panel.csv", "frequency,damping,tz,rx\n14.5,0.005,0.46,0.1\n40.5,0.005,0.2,0.02\n");
    let path = dir.path("panel.csv");
    let file = format!("{MODES}modes = {path:?}");
    let mode = |frequency: f64, t: f64, r: f64| {
        format!(
            "{{ frequency = {frequency:?}, damping = 0.005, translation = [0, 0, {t}], rotation = [{r}, 0, 0] }}"
        )
    };
    let scaled = format!("{MODES}modes = [{}, {}]", mode(14.5 * 1.2, 0.46, 0.1), mode(40.5 * 1.2, 0.2, 0.02));
    scales(&file, &scaled);
}

#[test]
fn factors_are_drawn_varied_tuned_and_searched() {
    let dir = Dir::with(&["earth-observer"]);
    let drawn = "[uncertain]\n\"appendage[0].frequency_factor\" = { relative_uniform = 0.2 }\n\
                 \"spacecraft.frequency_factor\" = { uniform = [0.9, 1.1] }\n";
    let text = String::from_utf8(dir.read("earth-observer.toml")).expect("text");
    dir.write("drawn.toml", format!("{text}{drawn}"));
    dir.run("simulate drawn.toml --runs 2 --set duration=5 -o drawn").exits(0);
    dir.run(
        "sweep earth-observer.toml --set duration=5 --vary appendage[0].frequency_factor=0.8:1.2:3 -o swept",
    )
    .exits(0);
    dir.run("margins earth-observer.toml --set spacecraft.frequency_factor=1.2").exits(0);
    dir.run("tune earth-observer.toml --vary law.attitude.damping=0.5:1.2 --vary spacecraft.frequency_factor=0.9:1.1").exits(0);
    dir.run("worst drawn.toml --set duration=5 --metric elastic_energy_end_j --points 4").exits(0);
    dir.run("check earth-observer.toml --set appendage[0].frequency_factor=0")
        .exits(2)
        .says(&["`appendage[0].frequency_factor`", "must be a positive number, got 0"]);
    dir.run("check earth-observer.toml --set spacecraft.frequency_factor=300")
        .exits(2)
        .says(&["`spacecraft.frequency_factor` must leave natural frequencies of 0.0001 to 10000 rad/s, got one of 14400 rad/s"]);
}
