//! Failing calls of the system: each of them, at each of its places, ends a command with a plain error or with a whole result, and
//! the same command then gives the rows and the logs of an undisturbed one.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::parts::rows;
use crate::util::{Dir, UNCERTAIN, has_extension};

/// Calls of the system, and the error number of each: no space, an error of the device, no permission, no file, lock or thread
/// left.
const CALLS: [(&str, i32); 10] = [
    ("write", 28),
    ("read", 5),
    ("fsync", 5),
    ("rename", 13),
    ("unlink", 13),
    ("mkdir", 13),
    ("open", 24),
    ("statx", 5),
    ("flock", 37),
    ("pthread_create", 11),
];
/// Most places of a call that are tried.
const PLACES: usize = 7;
/// Modes of the library: a call fails alone, with all that follow, or writes half of its bytes.
const MODES: [u8; 3] = [0, 1, 2];

/// Compiles the library that lets calls fail; `None` on a machine without a compiler, which is reported.
fn library(dir: &Dir) -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/faults/failing_call.c");
    let library = dir.path("failing_call.so");
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O1", "-shared", "-fPIC", "-o"]).arg(&library);
    let Ok(done) = compiler.arg(source).args(["-ldl", "-lpthread"]).output() else {
        eprintln!("skipped: there is no `cc` on this machine, so no call of the system fails");
        return None;
    };
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    Some(library)
}

/// Places from 1 to a number of calls: all of them, or some with the first and the last.
fn places(calls: usize) -> Vec<usize> {
    let count = calls.min(PLACES);
    (0..count).map(|place| 1 + place * (calls - 1) / (count - 1).max(1)).collect()
}

/// Lets every call fail at its places in a command in `dir`. After each, `judge` gets true if the command reported success, and
/// `finish` is called after it was repeated without a fault.
fn disturb(dir: &Dir, arguments: &str, clear: &dyn Fn(), judge: &dyn Fn(bool, &str), finish: &dyn Fn(&str)) {
    let Some(library) = library(dir) else { return };
    let faulty = |fault: &str| {
        clear();
        let (library, count) = (library.display(), dir.path("calls"));
        let exported =
            format!("export LD_PRELOAD='{library}' FAULT='{fault}' FAULT_COUNT='{}'", count.display());
        dir.start_by(&exported, arguments).wait()
    };
    let mut failed = 0;
    for (call, error) in CALLS {
        faulty(&format!("{call} 0 {error} 0")).exits(0);
        let calls: usize = dir.text("calls").parse().expect("a number");
        for place in places(calls) {
            for mode in MODES.into_iter().filter(|mode| *mode < 2 || call == "write") {
                let fault = format!("{call} {place} of {calls}, mode {mode}");
                let ran = faulty(&format!("{call} {place} {error} {mode}"));
                let code = ran.code.unwrap_or(-1);
                assert!([0, 1, 2].contains(&code), "{fault}: {code}\n{}", ran.err);
                assert!(code == 0 || ran.err.contains("error: "), "{fault}: {code}\n{}", ran.err);
                assert!(!ran.err.contains("panicked"), "{fault}: {}", ran.err);
                judge(code == 0, &fault);
                dir.run(arguments).exits(0);
                finish(&fault);
                failed += usize::from(code != 0);
            }
        }
    }
    assert!(failed > 10, "only {failed} calls that failed were noticed");
}

fn is_partial(names: &[String]) -> bool {
    names.iter().any(|name| name.contains("partial"))
}

#[test]
fn a_campaign_whose_calls_fail_continues_to_the_same_rows() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 12 --jobs 1 -o whole").exits(0);
    let (whole, statistics) = (rows(&dir.path("whole")), dir.text("whole/statistics.csv"));
    let is_whole = |fault: &str| {
        assert!(rows(&dir.path("out")) == whole, "{fault}: other rows");
        assert!(dir.text("out/statistics.csv") == statistics, "{fault}: other statistics");
        assert!(!is_partial(&dir.names("out")) && !is_partial(&dir.names("out/runs")), "{fault}: leavings");
    };
    let clear = || drop(std::fs::remove_dir_all(dir.path("out")));
    let judge = |succeeded: bool, fault: &str| {
        if succeeded {
            is_whole(fault);
        }
    };
    disturb(&dir, "simulate u.toml --runs 12 --jobs 1 -o out", &clear, &judge, &is_whole);
}

#[test]
fn a_log_whose_calls_fail_is_whole_or_not_there() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --log full -o whole.mcap").exits(0);
    let whole = dir.read("whole.mcap");
    let clear = || {
        for name in dir.names("").iter().filter(|name| name.starts_with("out.")) {
            std::fs::remove_file(dir.path(name)).expect("removed");
        }
    };
    let is_whole = |fault: &str| {
        assert!(dir.read("out.mcap") == whole, "{fault}: another log");
        assert!(!is_partial(&dir.names("")), "{fault}: leavings");
    };
    let judge = |succeeded: bool, fault: &str| {
        assert!(succeeded == dir.has("out.mcap") || !succeeded, "{fault}: no log");
        if dir.names("").iter().any(|name| has_extension(name, "mcap") && name.starts_with("out")) {
            is_whole(fault);
        }
    };
    disturb(&dir, "simulate u.toml --log full -o out.mcap", &clear, &judge, &is_whole);
}

#[test]
fn a_table_whose_calls_fail_is_whole_or_not_there() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 12 --jobs 1 -o whole.csv").exits(0);
    let cells = |name: &str| {
        let mut rows = crate::util::table(&dir, name);
        for row in &mut rows {
            row.remove("seconds");
        }
        rows
    };
    let whole = cells("whole.csv");
    let is_whole = |fault: &str| {
        assert!(cells("out.csv") == whole, "{fault}: other rows");
        assert!(!is_partial(&dir.names("")), "{fault}: leavings");
    };
    let clear = || drop(std::fs::remove_file(dir.path("out.csv")));
    let judge = |succeeded: bool, fault: &str| {
        assert!(dir.has("out.csv") || !succeeded, "{fault}: no table");
        if dir.has("out.csv") {
            is_whole(fault);
        }
    };
    disturb(&dir, "simulate u.toml --runs 12 --jobs 1 --force -o out.csv", &clear, &judge, &is_whole);
}
