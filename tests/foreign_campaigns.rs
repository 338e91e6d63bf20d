//! Directories of campaigns that come from somebody else, or that were damaged: nothing in them leads elsewhere, is waited for
//! or is trusted.
#![cfg(unix)]

use std::os::unix::fs::symlink;
use std::process::Command;

use crate::util::{Dir, UNCERTAIN};

const CAMPAIGN: &str = "simulate u.toml --set duration=50 --runs 40 -o out";

fn campaign() -> Dir {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.write("victim", "mine");
    dir.run(CAMPAIGN).exits(0);
    dir
}

fn part(dir: &Dir) -> String {
    format!("out/runs/{}", dir.names("out/runs")[0])
}

fn pipe(dir: &Dir, name: &str) {
    let made = Command::new("mkfifo").arg(dir.path(name)).status().expect("mkfifo starts");
    assert!(made.success());
}

#[test]
fn links_are_not_followed() {
    for (name, commands) in [
        ("statistics.csv", &[CAMPAIGN, "simulate u.toml --set duration=50 --runs 40 -o out --force"][..]),
        ("u-distribution-duty.svg", &["plot out --metric duty --what distribution --format svg"]),
        (".lock", &[CAMPAIGN]),
        ("manifest.toml", &[CAMPAIGN, "top out", "plot out"]),
    ] {
        let dir = campaign();
        let _ = std::fs::remove_file(dir.path(&format!("out/{name}")));
        symlink("../victim", dir.path(&format!("out/{name}"))).expect("linked");
        for command in commands {
            let ran = dir.run(command);
            assert!(matches!(ran.code, Some(1 | 2)), "{command} {name}: {:?} {}", ran.code, ran.err);
            assert_eq!(dir.text("victim"), "mine", "{command} {name}");
        }
    }
    let dir = campaign();
    std::fs::rename(dir.path("out/runs"), dir.path("elsewhere")).expect("moved");
    symlink("../elsewhere", dir.path("out/runs")).expect("linked");
    for command in [CAMPAIGN, "top out"] {
        dir.run(command).exits(2).says(&["out/runs", "in the way"]);
    }
    let dir = campaign();
    let part = part(&dir);
    std::fs::rename(dir.path(&part), dir.path("elsewhere")).expect("moved");
    symlink(dir.path("elsewhere"), dir.path(&part)).expect("linked");
    dir.run("top out").exits(2).says(&[&part, "is not a file"]);
    // Tables of the other form.
    for name in ["runs.csv", "scenario.toml", "statistics.csv"] {
        let dir = Dir::holding("u.toml", UNCERTAIN);
        dir.write("victim", "mine");
        std::fs::create_dir(dir.path("out")).expect("made");
        symlink("../victim", dir.path(&format!("out/{name}"))).expect("linked");
        let ran = dir.run(&format!("{CAMPAIGN} --table csv --force"));
        // The link itself may be replaced.
        let gone = dir.path(&format!("out/{name}")).symlink_metadata().is_ok_and(|there| there.is_file());
        assert!(matches!(ran.code, Some(1 | 2)) || gone, "{name}: {:?} {}", ran.code, ran.err);
        assert_eq!(dir.text("victim"), "mine", "{name}");
    }
}

#[test]
fn pipes_are_not_waited_for() {
    for name in ["part", ".lock", "statistics.csv", "manifest.toml"] {
        let dir = campaign();
        let place = if name == "part" { part(&dir) } else { format!("out/{name}") };
        std::fs::remove_file(dir.path(&place)).expect("there");
        pipe(&dir, &place);
        let ran = dir.start(CAMPAIGN);
        let began = std::time::Instant::now();
        let ran = {
            let mut ran = ran;
            while ran.is_alive() {
                assert!(began.elapsed().as_secs() < 20, "{name} is waited for");
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
            ran.wait()
        };
        assert!(matches!(ran.code, Some(1 | 2)), "{name}: {:?} {}", ran.code, ran.err);
    }
}

#[test]
fn a_table_of_the_user_is_not_replaced() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    std::fs::create_dir(dir.path("out")).expect("made");
    dir.write("out/statistics.csv", "mine");
    dir.run(CAMPAIGN).exits(2).says(&["out/statistics.csv", "exists"]);
    assert_eq!(
        (dir.names("out"), dir.text("out/statistics.csv")),
        (vec!["statistics.csv".to_owned()], "mine".to_owned())
    );
    dir.run(&format!("{CAMPAIGN} --force")).exits(0);
    assert!(dir.text("out/statistics.csv").starts_with("metric,unit,"));
    dir.run(CAMPAIGN).exits(0);
    dir.write("out/statistics.csv", "mine");
    dir.run(CAMPAIGN).exits(2).says(&["flexsc did not write it"]);
}

/// Bytes of a part that the library for Parquet files panicked on, and bits all over a part.
#[test]
fn damage_is_named_with_the_way_on() {
    let dir = campaign();
    let part = part(&dir);
    let whole = dir.read(&part);
    let refused = |why: &str| {
        for command in ["top out", "plot out", "simulate --from out --row 3 --log none", CAMPAIGN] {
            if command.contains("--from") {
                continue;
            }
            let ran = dir.run(command).exits(2).says(&[
                &part,
                "is damaged",
                "delete this file and repeat the command",
            ]);
            assert!(!ran.err.contains("panicked"), "{why}: {}", ran.err);
        }
    };
    let mut step = 0;
    while step < 8 * whole.len() {
        let mut bytes = whole.clone();
        bytes[step / 8] ^= 1 << (step % 8);
        dir.write(&part, &bytes);
        dir.run("top out --json").exits(2).says(&[&part, "is damaged"]);
        step += 8 * whole.len() / 40 + 1;
    }
    refused("a bit");
    for cut in [0, 3, whole.len() / 2, whole.len() - 1] {
        dir.write(&part, &whole[..cut]);
        refused("cut");
    }
    dir.write(&part, include_bytes!("golden/damaged-part.parquet"));
    refused("panic");
    // The way on.
    let statistics = dir.text("out/statistics.csv");
    std::fs::remove_file(dir.path(&part)).expect("there");
    dir.run(CAMPAIGN).exits(0);
    assert_eq!(dir.text("out/statistics.csv"), statistics);
}

#[test]
fn runs_of_several_directories_are_taken_once() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let simulate = |runs: &str, out: &str| {
        dir.run(&format!("simulate u.toml --set duration=50 --runs {runs} -o {out}")).exits(0);
    };
    for (runs, out) in [("0:300", "a"), ("200:400", "b"), ("500:600", "c"), ("0:400", "all")] {
        simulate(runs, out);
    }
    dir.run("merge a b -o ab").exits(0).says(&["a: 300 runs", "b: 100 runs", "400 runs, 0 missing"]);
    assert_eq!(dir.text("ab/statistics.csv"), dir.text("all/statistics.csv"));
    // Again, and into itself.
    dir.run("merge b a -o ab").exits(0).says(&["b: 0 runs", "a: 0 runs", "400 runs, 0 missing"]);
    // Holes are a failure that names them, and what is there is kept.
    dir.run("merge a b c -o holes").exits(1).says(&["runs 400:500 are missing"]);
    let top = dir.run("top holes").printed();
    assert!(top.contains("500 of 600 runs") && !top.contains("left"), "{top}");
    dir.run("merge a b c -o holes.csv").exits(1).says(&["runs 400:500 are missing"]);
    assert!(!dir.has("holes.csv"));
    simulate("0:600", "holes");
    dir.run("merge holes -o whole").exits(0).says(&["600 runs, 0 missing"]);
    // A refused merge leaves nothing.
    dir.run("simulate u.toml --set duration=60 --runs 300:400 -o other").exits(0);
    let other = format!("other/runs/{}", dir.names("other/runs")[0]);
    std::fs::copy(dir.path(&other), dir.path("b/runs/part-0000000400-0000000500.parquet")).expect("copied");
    dir.run("merge a b -o new").exits(2).says(&["b/runs/part-0000000400"]);
    assert!(!dir.has("new"));
}
