//! Control systems in single precision: a study, and exported code with its bits and its accuracy.

use crate::flight_exports::{hashes, is_installed, make, text};
use crate::util::Dir;

/// Exports a scenario in single precision, and returns the directory.
fn exported(name: &str, options: &str) -> Dir {
    let dir = Dir::with(&[name]);
    dir.run(&format!("export-c {name}.toml -o out --precision single --calls 2000 {options}")).exits(0);
    dir
}

/// Modes of CubeSats with B-dot laws, attitude laws, unloading and vector sensors.
#[test]
fn code_in_single_precision_has_the_bits_of_its_study() {
    if !is_installed("make") || !is_installed("gcc") {
        return;
    }
    let dir = exported("cubesat-day", "--complete");
    let code = dir.text("out/cubesat_day.c");
    assert!(!code.contains("double ") && code.contains("float "), "doubles are left");
    let known = hashes(&dir, "out");
    let variables = [
        "LEVELS=-O3".to_owned(),
        "CYCLES=20000".to_owned(),
        format!("HASH={}", known[&20_000]),
        "BOARD_CYCLES=1000".to_owned(),
        format!("BOARD_HASH={}", known[&1000]),
    ];
    let targets = ["check-gcc", "check-m4", "lint"];
    let arguments: Vec<&str> = targets.into_iter().chain(variables.iter().map(String::as_str)).collect();
    let output = make(&dir, "out", &arguments);
    let said = text(&output);
    assert!(output.status.success(), "{said}");
    said.lines().filter(|line| line.contains("skipped")).for_each(|line| eprintln!("{line}"));
}

/// Returns the largest difference from double precision of an output in the description.
fn difference(readme: &str, row: &str) -> f64 {
    let line =
        readme.lines().find(|line| line.starts_with(row)).unwrap_or_else(|| panic!("no {row}: {readme}"));
    let cell = line.trim_end_matches(" |").rsplit("| ").next().expect("a difference");
    cell.split(' ').next().and_then(|number| number.parse().ok()).expect("a number")
}

/// The review of flight code found, by a mechanical conversion of the C and all calls of the run, 1.6e-6 rad, 5e-8 rad/s and
/// 1.2e-5 N m.
#[test]
fn the_accuracy_is_that_of_an_independent_conversion() {
    let readme = exported("earth-observer", "").text("out/README.md");
    for (row, found) in [
        ("| `sample` | `attitude` |", 1.6e-6),
        ("| `sample` | `rate` |", 5e-8),
        ("| `step` | `wheel_torque` |", 1.2e-5),
    ] {
        let difference = difference(&readme, row);
        assert!(difference > found / 30.0 && difference < 3.0 * found, "{row} {difference:e}, {found:e}");
    }
}

#[test]
fn a_study_in_single_precision_points_as_well_and_has_other_bits() {
    let dir = Dir::with(&["earth-observer"]);
    let run =
        |set: &str| dir.run(&format!("simulate earth-observer.toml {set} --log none --json")).exits(0).json();
    let [double, single] = ["", "--set flight_precision=single"].map(run);
    let error = |run: &serde_json::Value| {
        run["metrics"]["pointing_error_end_rad"].as_f64().expect("a pointing error")
    };
    let (double, single) = (error(&double), error(&single));
    // A requirement of the scenario is 1e-4 rad.
    assert!(double != single && (double - single).abs() < 1e-5, "{double:e} {single:e}");
}

#[test]
fn parts_in_double_precision_only_are_refused_by_name() {
    let dir = Dir::with(&["relay-sampled", "flexible-boom", "earth-observer", "wheels-and-jets"]);
    for (command, words) in [
        (
            "export-c relay-sampled.toml -o out --precision single",
            ["`flight_precision`", "`law.relay`", "must be `double`"],
        ),
        (
            "check flexible-boom.toml --set flight_precision=single",
            ["`flight_precision`", "`estimator.attitude`", "must be `double`"],
        ),
        (
            "check wheels-and-jets.toml --set flight_precision=single",
            ["`flight_precision`", "actuator", "must be `double`"],
        ),
        (
            "export-c earth-observer.toml -o out --precision single --guest cfs",
            ["`flight_precision`", "`--guest`", "doubles"],
        ),
        ("export-c earth-observer.toml -o out --precision half", ["--precision", "half", "single"]),
    ] {
        dir.run(command).exits(2).says(&words);
        assert!(!dir.has("out"), "{command}");
    }
}
