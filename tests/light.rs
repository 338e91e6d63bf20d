//! A light build names the missing feature, and the command that has it.

use std::fmt::Write as _;

use crate::structure::RELAY;
use crate::util::Dir;

const HINT: &str = "cargo build --release --features full";

#[cfg(not(feature = "papers"))]
#[test]
fn papers_are_left_out() {
    for arguments in ["reproduce", "reproduce relay -o page", "reproduce --help"] {
        Dir::new().run(arguments).exits(2).says(&["the feature `papers`", HINT]);
    }
}

#[cfg(not(feature = "fmu"))]
#[test]
fn fmus_are_left_out() {
    for arguments in ["export-fmu", "export-fmu relay-quiet.toml -o relay.fmu", "export-fmu --help"] {
        Dir::new().run(arguments).exits(2).says(&["the feature `fmu`", HINT]);
    }
}

#[cfg(not(feature = "flight-code"))]
#[test]
fn flight_code_is_left_out() {
    for arguments in ["export-c", "export-c relay-quiet.toml -o flight", "vectors --help"] {
        Dir::new().run(arguments).exits(2).says(&["the feature `flight-code`", HINT]);
    }
}

#[cfg(not(feature = "handover"))]
#[test]
fn formats_of_whole_runs_are_left_out() {
    let dir = Dir::with(&["relay-quiet"]);
    dir.run("simulate relay-quiet.toml --set duration=300").exits(0);
    for options in ["--format aem", "-o run.glb", "-o run.bin --epoch 2026-03-20T14:46:00Z"] {
        dir.run(&format!("export relay-quiet.mcap {options}"))
            .exits(2)
            .says(&["the feature `handover`", HINT]);
    }
    assert!(!dir.has("run.glb") && !dir.has("run.bin"));
}

#[cfg(not(feature = "live"))]
#[test]
fn live_runs_are_left_out() {
    let dir = Dir::with(&["relay-quiet"]);
    for options in
        ["--live", "--live=127.0.0.1:0 --speed 20 --wait", "--live --paused --allow-origin https://a.example"]
    {
        let run = dir.run(&format!("simulate relay-quiet.toml {options}"));
        run.exits(2).says(&["the feature `live`", HINT]);
    }
    dir.run("simulate relay-quiet.toml --speed 20").exits(2).says(&["--live"]);
    assert_eq!(dir.names("."), ["relay-quiet.toml"]);
}

#[cfg(not(feature = "png"))]
#[test]
fn figures_are_svg_alone() {
    let dir = Dir::with(&["relay-quiet"]);
    dir.run("simulate relay-quiet.toml --set duration=300").exits(0);
    dir.run("plot relay-quiet.mcap -o figures --what torque").exits(0);
    assert_eq!(dir.names("figures"), ["relay-quiet-torque.svg"]);
    for options in ["-o torque.png", "-o other --format png", "-o other --format both"] {
        dir.run(&format!("plot relay-quiet.mcap --what torque {options}")).exits(1).says(&[
            "cannot draw",
            "the feature `png`",
            HINT,
        ]);
    }
    assert!(!dir.has("torque.png") && dir.names("other").is_empty());
}

#[cfg(not(feature = "matrices"))]
#[test]
fn large_matrices_and_archives_are_left_out() {
    let dir = Dir::new();
    let words = ["the feature `matrices`", HINT];
    let scenario = |mass: &str, stiffness: &str| {
        dir.write(
            "matrices.toml",
            format!("{RELAY}[body.matrices]\nmass = {mass}\nstiffness = {stiffness}\n"),
        );
        dir.run("check matrices.toml")
    };
    scenario("\"m.npz\"", "\"k.npz\"").exits(2).says(&words);
    // A diagonal structure of an order that is as large as a light build solves, and one that is larger.
    for (order, light) in [(101, true), (102, false)] {
        let diagonal = |hub: f64, other: f64| {
            let mut rows = String::from("[");
            for row in 0..order {
                let element = |column| match (row, column) {
                    (i, j) if i != j => 0.0,
                    (0, _) => hub,
                    _ => other,
                };
                let row: Vec<String> = (0..order).map(|column| format!("{:?}", element(column))).collect();
                let _ = write!(rows, "[{}],", row.join(","));
            }
            rows + "]"
        };
        let checked = scenario(&diagonal(5.0, 1.0), &diagonal(0.0, 4.0));
        if light {
            checked.exits(0)
        } else {
            checked.exits(2).says(&words)
        };
    }
}

#[cfg(not(feature = "parquet"))]
#[test]
fn parquet_files_are_left_out() {
    use crate::util::UNCERTAIN;
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 2 --table parquet -o out")
        .exits(2)
        .says(&["the feature `parquet`", HINT]);
    dir.run("simulate u.toml --runs 2 -o out").exits(0).says(&["runs.csv"]);
}
