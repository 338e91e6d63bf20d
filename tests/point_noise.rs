//! Noise of the points of a sweep: that of one run at all of them, unless it is to be new.

use std::collections::BTreeMap;
use std::path::Path;

use crate::util::{Dir, table};

const SWEEP: &str = "sweep relay-sampled.toml --set duration=2000";
const GAINS: &str = "--vary law.relay.k_t=0.30,0.33,0.30";

/// Returns the metrics of a table, without the number of the run and the key.
fn metrics(dir: &Dir, file: &str) -> Vec<BTreeMap<String, String>> {
    let mut rows = table(dir, file);
    for row in &mut rows {
        row.retain(|name, _| !["run", "law.relay.k_t"].contains(&name.as_str()));
    }
    rows
}

#[test]
fn points_differ_by_their_keys_alone() {
    let dir = Dir::with(&["relay-sampled"]);
    dir.run(&format!("{SWEEP} {GAINS} --table csv -o same")).exits(0);
    let same = metrics(&dir, "same/runs.csv");
    assert_eq!(same[0], same[2]);
    assert_ne!(same[0], same[1]);
    // Each is the run of the scenario with this key.
    for (gain, row) in [("0.30", &same[0]), ("0.33", &same[1])] {
        let run = "simulate relay-sampled.toml --log none --json --set duration=2000 --set law.relay.k_t";
        let duty = format!("\"duty\":{},", row["duty"].parse::<f64>().expect("a number"));
        dir.run(&format!("{run}={gain}")).exits(0).prints(&[&duty]);
    }
    // Order, parts, threads, logs and batches change nothing.
    dir.run(&format!("{SWEEP} --vary law.relay.k_t=0.33,0.30 --jobs 1 --table csv -o turned")).exits(0);
    let turned = metrics(&dir, "turned/runs.csv");
    assert_eq!((&turned[0], &turned[1]), (&same[1], &same[0]));
    dir.run(&format!("{SWEEP} {GAINS} --runs 1:3 --table csv -o part")).exits(0);
    assert_eq!(metrics(&dir, "part/runs-1-3.csv"), same[1..]);
    dir.run(&format!("{SWEEP} {GAINS} --log events --table csv -o logged")).exits(0);
    assert_eq!(metrics(&dir, "logged/runs.csv"), same);
    let logs = dir
        .names("logged")
        .into_iter()
        .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "mcap"))
        .collect::<Vec<_>>();
    assert_eq!(logs, (0..3).map(|run| format!("relay-sampled-{run}.mcap")).collect::<Vec<_>>());
    // What the directory holds is repeated, and another noise is another campaign.
    dir.run(&format!("{SWEEP} {GAINS} --noise new --table csv -o same"))
        .exits(2)
        .says(&["another campaign", "each point with the noise from run 0 before"]);
    dir.run(&format!("{SWEEP} {GAINS} --noise new --table csv -o new")).exits(0);
    let new = metrics(&dir, "new/runs.csv");
    assert_eq!(new[0], same[0]);
    assert_ne!(new[0], new[2]);
}

#[test]
fn replicas_have_the_noise_of_their_number_at_every_point() {
    let dir = Dir::with(&["relay-sampled"]);
    dir.run(&format!("{SWEEP} {GAINS} --replicas 2 --table csv -o two")).exits(0);
    let two = metrics(&dir, "two/runs.csv");
    assert_eq!((&two[0], &two[1]), (&two[4], &two[5]));
    assert_ne!(two[0], two[1]);
    // The command that repeats a worst run has its noise.
    let listed = dir.run("plot two -o two.svg --metric duty --worst 6 --json").exits(0).printed();
    let worst = |run: u64| -> String {
        let lines = listed.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
        let mut found = lines.filter_map(|line| Some(line.get("worst")?.clone()));
        let found = found.find(|found| found["run"].as_u64() == Some(run)).expect("a worst run");
        found["command"].as_str().expect("a command").replace('\'', "")
    };
    for run in [1, 2, 3] {
        dir.run(worst(run).strip_prefix("flexsc ").expect("of flexsc")).exits(0);
        let noise = run % 2;
        let own = metrics(&dir, &format!("two/run-{run}/runs-{noise}-{}.csv", noise + 1));
        assert_eq!(own[0], two[run as usize], "{run}");
    }
}

#[test]
fn drawn_keys_have_new_noise_unless_it_is_to_be_the_same() {
    let dir = Dir::with(&["relay-sampled"]);
    let duties = |options: &str| -> Vec<String> {
        let rows = dir.run(&format!("{SWEEP} --json {options}")).exits(0).printed();
        rows.lines().map(|row| row.split("\"duty\":").nth(1).expect("a duty").to_owned()).collect()
    };
    let points = "--uncertain --vary log.period=1,1,1";
    assert_eq!(duties(points), duties(&format!("{points} --noise new")));
    assert_ne!(duties(points), duties(&format!("{points} --noise same")));
    // The first has run 0 both ways.
    assert_eq!(duties(points)[0], duties(&format!("{points} --noise same"))[0]);
    dir.run(&format!("{SWEEP} {points} --noise same --table csv -o out"))
        .exits(2)
        .says(&["--noise same need --table parquet where [uncertain] keys are drawn"]);
}
