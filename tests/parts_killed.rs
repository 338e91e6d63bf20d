//! Campaigns that are stopped at any moment, by a kill, Ctrl-C or a second process, and continued.

use std::time::{Duration, Instant};

use flexsc_core::numerics::random::Seed;

use crate::parts::rows;
use crate::util::{Dir, UNCERTAIN};

const CAMPAIGN: &str = "simulate u.toml --runs 6000 --set duration=400 --jobs 2 -o";

/// Killed at ten random moments, the campaign ends with the rows of an undisturbed one.
#[test]
fn a_campaign_killed_ten_times_has_the_same_rows() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let began = Instant::now();
    dir.run(&format!("{CAMPAIGN} whole")).exits(0);
    let took = began.elapsed().as_secs_f64();
    let mut stream = Seed { scenario: 15, run: 0 }.stream("kill");
    let (mut killed, mut between) = (0, 0);
    for _ in 0..10 {
        let run = dir.start(&format!("{CAMPAIGN} out"));
        std::thread::sleep(Duration::from_secs_f64(0.3 * took * stream.uniform()));
        killed += u32::from(run.signal("KILL").code.is_none());
        let parts = dir.names("out/runs").iter().filter(|name| name.ends_with(".parquet")).count();
        between += usize::from((1..24).contains(&parts));
    }
    assert!(killed > 1 && between > 0, "{killed} kills, {between} amid the parts");
    dir.run(&format!("{CAMPAIGN} out")).exits(0).says(&["6000 runs"]);
    assert!(rows(&dir.path("out")) == rows(&dir.path("whole")), "the rows are others");
    assert_eq!(dir.names("out/runs"), dir.names("whole/runs"));
    assert_eq!(dir.text("out/statistics.csv"), dir.text("whole/statistics.csv"));
}

#[test]
fn ctrl_c_keeps_whole_parts_and_one_process_is_at_work() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let command = "simulate u.toml --runs 100000 --jobs 2 -o out";
    let run = dir.start(command);
    let began = Instant::now();
    while !dir.names("out/runs").iter().any(|name| name.ends_with(".parquet")) {
        assert!(began.elapsed() < Duration::from_secs(120), "no part is written");
        std::thread::sleep(Duration::from_millis(20));
    }
    for force in ["", " --force"] {
        dir.run(&format!("{command}{force}")).exits(2).says(&["another process is", "hint: "]);
    }
    run.signal("INT")
        .exits(130)
        .says(&["interrupted at run ", "of 100000 runs, and the same command continues"]);
    assert!(
        dir.names("out/runs").iter().all(|name| name.ends_with(".parquet")),
        "{:?}",
        dir.names("out/runs")
    );
    dir.run("top out").exits(0).prints(&["of 100000 runs, 0 failed"]);
    dir.run("plot out -o figures --what distribution --metric duty").exits(0);
}
