//! Exported control systems as crates of Rust: they compile without warnings, and replay the calls of their runs.

use std::path::Path;
use std::process::{Command, Output};

use crate::util::Dir;

/// Tests a crate in `out` of a directory, with the files of the compiler in a directory that crates share.
pub fn cargo_test(dir: &Dir, target: &Path) -> Output {
    Command::new(env!("CARGO"))
        .args(["test", "--offline", "--quiet"])
        .current_dir(dir.path("out"))
        .env("CARGO_TARGET_DIR", target)
        .env("RUSTFLAGS", "-D warnings")
        .env_remove("RUSTC_WRAPPER")
        .env_remove("RUSTC_WORKSPACE_WRAPPER")
        .output()
        .expect("cargo runs")
}

/// Exports a scenario as a crate.
fn exported(scenario: &str) -> Dir {
    let name = scenario.split(' ').next().expect("a name");
    let dir = Dir::with(&[name]);
    let arguments = scenario.replacen(name, &format!("{name}.toml"), 1);
    dir.run(&format!("export-c {arguments} --as rust -o out --calls 1000")).exits(0).says(&[
        "calls of the run as vectors",
        "`cargo test --manifest-path out/Cargo.toml` compares them by bits",
    ]);
    dir
}

/// Relays, PD laws with a gain schedule, phase planes with active damping, compensators on an attitude filter, Kalman filters, filters
/// of rates with jets, attitude laws with wheels that are unloaded, and modes in both precisions.
#[test]
fn crates_replay_the_calls_of_their_runs() {
    let target = Dir::new();
    for scenario in [
        "relay-sampled",
        "wheel-scheduled-gain",
        "iss-ringdown",
        "earth-observer-lqg",
        "attitude-hold",
        "thruster-phase-plane",
        "momentum-unloading",
        "cubesat-day",
        "cubesat-day --precision single --name cubesat_single",
    ] {
        let output = cargo_test(&exported(scenario), &target.path("."));
        let said =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && said.contains("2 passed"), "{scenario}: {said}");
    }
}

#[test]
fn a_changed_line_is_found() {
    let (dir, target) = (exported("earth-observer"), Dir::new());
    let (path, line) = ("out/src/control_system.rs", "rate: input.reference_rate[1]");
    let text = dir.text(path);
    assert_eq!(text.matches(line).count(), 1);
    dir.write(path, text.replace(line, "rate: input.reference_rate[0]"));
    let output = cargo_test(&dir, &target.path("."));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(!output.status.success() && said.contains("0 passed; 2 failed"), "{said}");
    assert!(said.contains("acceleration is "), "{said}");
}

#[test]
fn a_crate_has_the_parts_of_flexsc_that_it_needs_and_their_licence() {
    let dir = exported("relay-sampled");
    let library = dir.text("out/src/lib.rs");
    for line in ["#![no_std]", "#![forbid(unsafe_code)]", "pub mod relay;", "pub mod control_system;"] {
        assert!(library.lines().any(|own| own == line), "{line}: {library}");
    }
    assert!(!library.contains("pub mod kalman;"), "{library}");
    let licence = "// SPDX-License-Identifier: MIT OR Apache-2.0\n// crates/flight/src/relay.rs of flexsc ";
    assert!(dir.text("out/src/relay.rs").starts_with(licence));
    assert!(!dir.text("out/Cargo.toml").contains("dependencies"));
    assert!(dir.text("out/README.md").contains("`relay_sampled::control_system::poll`"));
}

#[test]
fn guests_and_other_languages_are_refused() {
    let dir = Dir::with(&["relay-sampled"]);
    let run = |options: &str| dir.run(&format!("export-c relay-sampled.toml -o out {options}")).exits(2);
    run("--as rust --guest cfs").says(&["--guest: must be left out with `--as rust`"]);
    run("--as rust --name match").says(&["--name match: is a word of Rust or Cargo"]);
    run("--as ada").says(&["invalid value 'ada' for '--as <LANGUAGE>'"]);
    assert!(!dir.path("out").exists());
}
