//! `--scheduler`: what ends the command where the Python process that hands out the runs fails.

use std::os::unix::fs::PermissionsExt;

use crate::util::{Dir, Ran, UNCERTAIN};

/// Runs a campaign into `out` with a program in the place of Python.
fn handed(dir: &Dir, python: &str) -> Ran {
    dir.write("python", format!("#!/bin/sh\n{python}\n"));
    let program = dir.path("python");
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).expect("set");
    let before = format!("export FLEXSC_PYTHON={}", program.display());
    dir.start_by(&before, "simulate u.toml --runs 5 --set duration=50 -o out --scheduler tcp://x:1").wait()
}

#[test]
fn a_scheduler_that_is_lost_fails_the_run_and_leaves_no_empty_directory() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    // Python has what it needs (`-c`), and ends with the code of a lost scheduler.
    let lost = "[ \"$1\" = -c ] || exit 1";
    let ran = handed(&dir, lost).exits(1).says(&["--scheduler tcp://x:1: ", "exit status: 1"]);
    assert!(!ran.err.contains("hint"), "{}", ran.err);
    assert!(!dir.has("out"));
    handed(&dir, "[ \"$1\" = -c ] || exit 2").exits(2).says(&["--scheduler tcp://x:1: "]);
    assert!(!dir.has("out"));
    // Without the package there is a hint.
    handed(&dir, "exit 1").exits(2).says(&["has no `flexsc[dask]`", "hint: it needs Python"]);
    assert!(!dir.has("out"));
    // What was there before stays.
    std::fs::create_dir(dir.path("out")).expect("made");
    dir.write("out/notes.txt", "mine");
    handed(&dir, lost).exits(1);
    assert_eq!(dir.names("out"), ["notes.txt"]);
    // Runs stay, too.
    dir.run("simulate u.toml --runs 5 --set duration=50 -o out").exits(0);
    handed(&dir, lost).exits(1);
    assert!(dir.has("out/manifest.toml") && !dir.names("out/runs").is_empty());
}
