//! Campaigns and sweeps: tables, logs, parts, failures, and threads that change nothing.

use std::collections::BTreeMap;

use crate::util::{Dir, UNCERTAIN, table};

#[test]
fn a_campaign_writes_tables_and_logs() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 6 --table csv -o out --log events")
        .exits(0)
        .says(&["6 runs", "runs.csv"]);
    let logs = (0..6).map(|run| format!("u-{run}.mcap"));
    let all: Vec<_> =
        ["runs.csv", "scenario.toml", "statistics.csv"].map(str::to_owned).into_iter().chain(logs).collect();
    assert_eq!(dir.names("out"), all);
    let rows = table(&dir, "out/runs.csv");
    assert_eq!(rows.len(), 6);
    for (number, row) in rows.iter().enumerate() {
        assert_eq!((&*row["run"], &*row["seed"], &*row["error"]), (&*number.to_string(), "7", ""));
        let k_t: f64 = row["law.relay.k_t"].parse().expect("a number");
        assert!((0.3..0.32).contains(&k_t));
        assert_eq!(row["gain_initial"].parse(), Ok(k_t));
    }
    assert_ne!(rows[0]["body.planar.rate"], rows[1]["body.planar.rate"]);
    let statistics = table(&dir, "out/statistics.csv");
    let gain = statistics.iter().find(|row| row["metric"] == "gain_initial").expect("a row");
    assert_eq!(gain["runs"], "6");
    let mean: f64 =
        rows.iter().map(|row| row["gain_initial"].parse::<f64>().expect("a number")).sum::<f64>() / 6.0;
    assert!((gain["mean"].parse::<f64>().expect("a number") - mean).abs() < 1e-12);
}

#[test]
fn the_runs_of_a_dated_scenario_have_its_date() {
    let dir = Dir::holding("u.toml", format!("epoch = 2026-03-20T14:46:00+01:00\n{UNCERTAIN}"));
    dir.run("simulate u.toml --runs 2 -o out --log events").exits(0).says(&["2 runs"]);
    let toml = dir.run("log scenario out/u-1.mcap").printed();
    assert!(toml.contains("\nepoch = 2026-03-20T14:46:00+01:00\n"), "{toml}");
    dir.run("sweep u.toml --vary law.relay.k_t=0.3:0.32:2 -o swept").exits(0).says(&["2 runs"]);
}

#[test]
fn a_run_alone_is_the_run_of_the_campaign() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 6 --table csv -o out").exits(0);
    let before = (dir.read("out/runs.csv"), dir.read("out/statistics.csv"));
    dir.run("simulate u.toml --runs 3:4 --table csv -o out --log full").exits(0);
    assert_eq!((dir.read("out/runs.csv"), dir.read("out/statistics.csv")), before);
    let names =
        ["runs-3-4.csv", "runs.csv", "scenario.toml", "statistics-3-4.csv", "statistics.csv", "u-3.mcap"];
    assert_eq!(dir.names("out"), names);
    assert_eq!(table(&dir, "out/runs-3-4.csv"), table(&dir, "out/runs.csv")[3..4]);
    // The log's own scenario, with what was drawn, makes the same run.
    let toml = dir.run("log scenario out/u-3.mcap").printed();
    dir.write("three.toml", &toml);
    let row = &table(&dir, "out/runs.csv")[3];
    let duty = format!("\"duty\":{},", row["duty"].parse::<f64>().expect("a number"));
    let switchings = format!("\"switchings\":{},", row["switchings"]);
    let alone = dir.run("simulate three.toml --json --log none").exits(0).prints(&[&duty, &switchings]);
    // A run alone has the keys of one of a campaign.
    assert!(alone.contains("\"drawn\":{},\"metrics\""), "{alone}");
}

#[test]
fn threads_change_nothing() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 12 --table csv -o one --log full --jobs 1").exits(0);
    dir.run("simulate u.toml --runs 12 --table csv -o eight --log full --jobs 8").exits(0);
    let names = dir.names("one");
    assert_eq!((names.len(), &names), (15, &dir.names("eight")));
    for name in names {
        let same = dir.read(&format!("one/{name}")) == dir.read(&format!("eight/{name}"));
        assert!(same, "{name} differs");
    }
    let lines = dir.run("simulate u.toml --runs 12 --json --jobs 1").printed();
    // The last line is the answer.
    assert_eq!(lines.lines().count(), 13);
    assert_eq!(lines, dir.run("simulate u.toml --runs 12 --json --jobs 8").printed());
}

#[test]
fn invalid_draws_fail_alone() {
    let wide = UNCERTAIN.replace("{ uniform = [0.3, 0.32] }", "{ normal = { mean = 0.31, sd = 0.3 } }");
    let dir = Dir::holding("u.toml", wide);
    let ran = dir.run("simulate u.toml --runs 20 --table csv -o out --log events").exits(1);
    let rows = table(&dir, "out/runs.csv");
    let (failed, done): (Vec<_>, Vec<_>) = rows.iter().partition(|row| !row["error"].is_empty());
    assert!(rows.len() == 20 && failed.len() > 1 && done.len() > 1, "{} of {}", failed.len(), rows.len());
    let first = format!("{} of 20 runs failed; the first: run {}:", failed.len(), failed[0]["run"]);
    ran.says(&[&first, "`law.relay.k_t`", "between 0 and 1"]);
    for row in &failed {
        assert!(row["error"].contains("`law.relay.k_t`: must be a number between 0 and 1, got "), "{row:?}");
        assert!(row["switchings"].is_empty() && !row["law.relay.k_t"].is_empty());
        assert!(!dir.has(&format!("out/u-{}.mcap", row["run"])));
    }
    for row in &done {
        assert!(!row["switchings"].is_empty() && dir.has(&format!("out/u-{}.mcap", row["run"])));
    }
    let statistics = table(&dir, "out/statistics.csv");
    assert_eq!(statistics[0]["runs"], done.len().to_string());
}

/// Rows without any metrics have a header all the same.
#[test]
fn a_campaign_of_failures_has_a_table() {
    let dir = Dir::holding("u.toml", UNCERTAIN.replace("[0.3, 0.32]", "[2.0, 3.0]"));
    dir.run("simulate u.toml --runs 3 --table csv -o out").exits(1).says(&["3 of 3 runs failed"]);
    let rows = table(&dir, "out/runs.csv");
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row["error"].contains("law.relay.k_t") && row["seed"] == "7"));
}

#[test]
fn a_sweep_varies_one_key() {
    let dir = Dir::with(&["relay-fixed"]);
    let vary = "sweep relay-fixed.toml --set duration=1000 --table csv -o out --vary law.relay.k_t";
    dir.run(&format!("{vary}=0.3:0.4:5")).exits(0);
    let rows = table(&dir, "out/runs.csv");
    assert_eq!(rows.len(), 5);
    for (row, gain) in rows.iter().zip([0.3, 0.325, 0.35, 0.375, 0.4]) {
        let k_t: f64 = row["law.relay.k_t"].parse().expect("a number");
        assert!((k_t - gain).abs() < 1e-15, "{k_t}");
        assert_eq!(row["gain_initial"].parse(), Ok(k_t));
    }
    dir.run(&format!("{vary}=0.3:1.4:5")).exits(2).says(&["`law.relay.k_t`", "between 0 and 1, got 1.4"]);
    dir.run(&format!("{vary}t=0.3:0.4:5")).exits(2).says(&["unknown key `k_tt`"]);
}

#[test]
fn sweeps_over_two_keys_combine_all_values() {
    let dir = Dir::with(&["relay-fixed"]);
    let sweep = "sweep relay-fixed.toml --set duration=500 --table csv -o out --vary law.relay.k_t=0.3:0.4:3";
    dir.run(&format!("{sweep} --vary law.relay.weak=1e-6:2e-6:2")).exits(0);
    let rows = table(&dir, "out/runs.csv");
    let number = |row: &std::collections::BTreeMap<String, String>, key: &str| {
        row[key].parse::<f64>().expect("a number")
    };
    let found: Vec<_> =
        rows.iter().map(|row| (number(row, "law.relay.k_t"), number(row, "law.relay.weak"))).collect();
    let all = [(0.3, 1e-6), (0.3, 2e-6), (0.35, 1e-6), (0.35, 2e-6), (0.4, 1e-6), (0.4, 2e-6)];
    assert_eq!(found.len(), all.len());
    for (found, exact) in found.iter().zip(all) {
        assert!((found.0 - exact.0).abs() < 1e-12 && (found.1 - exact.1).abs() < 1e-18, "{found:?}");
    }
    assert!(dir.text("out/runs.csv").starts_with("run,seed,law.relay.k_t,law.relay.weak,"));
    dir.run(&format!("{sweep} --vary law.relay.k_t=0.1:0.2:2")).exits(2).says(&["can be varied once"]);
    dir.run(&format!("{sweep} --vary law.relay.weak=1e-6:2e-6:9000000")).exits(2).says(&["at most 10000000"]);
    dir.run(&format!("{sweep} --vary law.relay.weak=-1:2e-6:2")).exits(2).says(&["`law.relay.weak`"]);
}

#[test]
fn the_scenario_beside_the_tables_is_that_of_the_runs() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 4 --seed 9 --set law.relay.weak=2e-6 --table csv -o out").exits(0);
    dir.run("simulate out/scenario.toml --runs 4 --table csv -o again").exits(0);
    assert_eq!(dir.text("again/runs.csv"), dir.text("out/runs.csv"));
    assert_eq!(dir.text("again/scenario.toml"), dir.text("out/scenario.toml"));
    // Neither another campaign nor a part of one takes its place, unless that is asked for.
    let before = (dir.text("out/runs.csv"), dir.text("out/statistics.csv"), dir.text("out/scenario.toml"));
    for other in ["--runs 2:4 --seed 9", "--runs 4 --seed 9", "--runs 4 --set law.relay.weak=2e-6"] {
        let ran = dir.run(&format!("simulate u.toml --table csv -o out {other}")).exits(2);
        ran.says(&["out/scenario.toml", "another campaign (`", "another directory", "--force"]);
    }
    let after = (dir.text("out/runs.csv"), dir.text("out/statistics.csv"), dir.text("out/scenario.toml"));
    assert_eq!(after, before);
    dir.run("simulate u.toml --runs 2:4 --seed 9 --set law.relay.weak=2e-6 --table csv -o out").exits(0);
    // The same again, and more of it; but not less.
    dir.run("simulate u.toml --runs 4 --seed 9 --set law.relay.weak=2e-6 --table csv -o out").exits(0);
    dir.run("simulate u.toml --runs 6 --seed 9 --set law.relay.weak=2e-6 --table csv -o out").exits(0);
    let fewer = "simulate u.toml --runs 5 --seed 9 --set law.relay.weak=2e-6 --table csv -o out";
    dir.run(fewer).exits(2).says(&["out/runs.csv", "holds 6 runs of this campaign, and 5 would", "--force"]);
    assert_eq!(table(&dir, "out/runs.csv").len(), 6);
    dir.run(&format!("{fewer} --force")).exits(0);
    assert_eq!(table(&dir, "out/runs.csv").len(), 5);
    // Replaced, nothing of the other campaign is left beside the new tables.
    dir.run("simulate u.toml --runs 4 --table csv -o out --force").exits(0);
    assert_eq!(dir.names("out"), ["runs.csv", "scenario.toml", "statistics.csv"]);
    // What somebody wrote is never lost.
    dir.write("scenario.toml", UNCERTAIN);
    for force in ["", "--force"] {
        dir.run(&format!("simulate scenario.toml --runs 4 --table csv -o . {force}"))
            .exits(2)
            .says(&["./scenario.toml"]);
    }
    assert_eq!(dir.text("scenario.toml"), UNCERTAIN);
    assert!(!dir.has("runs.csv"));
}

#[test]
fn a_sweep_of_other_values_is_another_one() {
    let dir = Dir::with(&["relay-fixed"]);
    let vary = "sweep relay-fixed.toml --set duration=100 --table csv -o out --vary law.relay.k_t";
    dir.run(&format!("{vary}=0.3:0.4:5")).exits(0);
    dir.run(&format!("{vary}=0.3:0.4:5")).exits(0);
    for other in [
        format!("{vary}=0.3:0.39:5"),
        "simulate relay-fixed.toml --set duration=100 --runs 9 --table csv -o out".to_owned(),
    ] {
        let ran = dir.run(&other).exits(2);
        ran.says(&["out/scenario.toml", "another campaign (law.relay.k_t = 0.3 to 0.4, 5 values before"]);
    }
    assert_eq!(table(&dir, "out/runs.csv").len(), 5);
    dir.run(&format!("{vary}=0.3:0.39:7 --force")).exits(0);
    assert_eq!(table(&dir, "out/runs.csv").len(), 7);
    // A table of which nothing is known stays, too.
    std::fs::remove_file(dir.path("out/scenario.toml")).expect("there");
    dir.run(&format!("{vary}=0.3:0.4:5"))
        .exits(2)
        .says(&["out/runs.csv", "exists, but its campaign is unknown"]);
}

#[test]
fn a_log_of_other_settings_is_not_replaced() {
    let dir = Dir::with(&["relay-fixed"]);
    let run = "simulate relay-fixed.toml --set duration=100";
    dir.run(run).exits(0);
    let before = dir.read("relay-fixed.mcap");
    for (other, why) in [
        ("--set law.relay.k_t=0.32", "(`law.relay.k_t`: 0.31 before, 0.32 now)"),
        ("--seed 5", "(`seed`: "),
        ("--set law.relay.k_t=0.32 --log full", "`law.relay.k_t`"),
    ] {
        let ran = dir.run(&format!("{run} {other}")).exits(2);
        ran.says(&["error: relay-fixed.mcap: holds a run with other settings", why, "-o", "--force"]);
        assert_eq!(dir.names("."), ["relay-fixed.mcap", "relay-fixed.toml"]);
        assert_eq!(dir.read("relay-fixed.mcap"), before, "{other}");
    }
    // The same run again, with more in its log, elsewhere, and where it is asked for.
    dir.run(run).exits(0);
    dir.run(&format!("{run} --log full")).exits(0);
    dir.run(&format!("{run} --set law.relay.k_t=0.32 -o out")).exits(0);
    dir.run(&format!("{run} --set law.relay.k_t=0.32 --force")).exits(0);
    dir.write("relay-fixed.mcap", "notes");
    dir.run(run).exits(2).says(&["relay-fixed.mcap: is not a log of flexsc"]);
    assert_eq!(dir.text("relay-fixed.mcap"), "notes");
    // Logs of a campaign, too.
    dir.write("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 2 --log events").exits(0);
    dir.run("simulate u.toml --runs 2 --log events").exits(0);
    dir.run("simulate u.toml --runs 2 --log events --seed 8").exits(2).says(&["u-0.mcap: holds", "--force"]);
}

/// Two processes in one directory: one of them does all, the other says why it does nothing.
#[cfg(unix)]
#[test]
fn two_processes_do_not_share_a_table() {
    // Long runs, so that the table is short when the first process is interrupted.
    let dir = Dir::holding("u.toml", UNCERTAIN.replace("duration = 800.0", "duration = 80000.0"));
    let one = dir.start("simulate u.toml --runs 1000000 --table csv -o out");
    dir.wait_for("out/runs.csv.partial", 1000);
    let scenario = dir.text("out/scenario.toml");
    for (other, why) in [
        ("simulate u.toml --runs 3 --table csv -o out", "another process is writing it"),
        ("simulate u.toml --runs 3 --table csv -o out --force", "another process is writing it"),
        (
            "simulate u.toml --runs 3 --seed 8 --table csv -o out",
            "another campaign (`seed`: 7 before, 8 now)",
        ),
        ("simulate u.toml --runs 3:5 --seed 8 --table csv -o out", "another campaign"),
        ("sweep u.toml --vary duration=1:2:3 --table csv -o out", "another campaign"),
        ("sweep u.toml --vary duration=1:2:3 --table csv -o out --force", "another process is writing it"),
    ] {
        dir.run(other).exits(2).says(&["error: ", why, "hint: "]);
        assert_eq!(dir.names("out"), ["runs.csv.partial", "scenario.toml"], "{other}");
        assert_eq!(dir.text("out/scenario.toml"), scenario);
    }
    // A part of the same campaign has its own table.
    dir.run("simulate u.toml --runs 3:5 --table csv -o out").exits(0);
    one.signal("INT").exits(130).says(&["interrupted at run ", "out/runs-interrupted.csv holds"]);
    let rows = table(&dir, "out/runs-interrupted.csv");
    assert!(rows.iter().enumerate().all(|(number, row)| row["run"] == number.to_string()));
    assert_eq!(
        dir.names("out"),
        ["runs-3-5.csv", "runs-interrupted.csv", "scenario.toml", "statistics-3-5.csv"]
    );
    dir.run("plot out -o figures").exits(0);
    // The whole campaign takes the place of what was interrupted.
    dir.run("simulate u.toml --runs 5 --table csv -o out").exits(0);
    assert!(dir.has("out/runs.csv") && !dir.has("out/runs-interrupted.csv"));
}

/// Finished rows are on disk within a second, also while other runs take long and where the campaign is killed.
#[cfg(unix)]
#[test]
fn a_killed_campaign_keeps_its_rows() {
    let dir = Dir::with(&["relay-fixed"]);
    // The runs become longer, the last ones by far.
    let run =
        dir.start("sweep relay-fixed.toml --vary duration=1e3:1e10:12 --jobs 2 --table csv -o out --yes");
    let few = dir.start(
        "simulate relay-fixed.toml --set duration=2e6 --runs 100000 --table csv -o few --jobs 1 --yes",
    );
    dir.wait_for("out/runs.csv.partial", 100);
    dir.wait_for("few/runs.csv.partial", 100);
    run.signal("KILL");
    few.signal("KILL");
    let rows = |name: &str| dir.text(name).lines().count();
    assert!(rows("out/runs.csv.partial") >= 2 && rows("few/runs.csv.partial") >= 2);
    // And they do not hinder the next one.
    dir.run("simulate relay-fixed.toml --set duration=2e6 --runs 2 --table csv -o few").exits(0);
    assert_eq!(dir.names("few"), ["runs.csv", "scenario.toml", "statistics.csv"]);
}

#[test]
fn statistics_are_finite_and_count_what_they_leave_out() {
    let dir = Dir::new();
    // An unstable loop of a huge body: the torque grows to some 1e196 N m, whose square is beyond every double.
    let unstable = "duration = 36.0\n[body.planar]\ninertia = 1e190\nangle = 0.1\n[law.pd]\nk_p = 1e190\nk_d = 0.0\n\
                    period = 1.0\n[uncertain]\n\"law.pd.k_p\" = { choice = [1e190, 3e190] }\n";
    dir.write("unstable.toml", unstable);
    let ran = dir.run("simulate unstable.toml --runs 12 --table csv -o out").exits(0);
    let statistics = table(&dir, "out/statistics.csv");
    for row in &statistics {
        for cell in ["mean", "sd", "q05", "q25", "q50", "q75", "q95"] {
            let finite = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
            assert!(row[cell].is_empty() || finite(&row[cell]), "{row:?}");
        }
    }
    let rows = table(&dir, "out/runs.csv");
    let infinite = |name: &str| rows.iter().filter(|row| row[name] == "inf").count();
    let counted = |name: &str| {
        let row = statistics.iter().find(|row| row["metric"] == name).expect("a metric");
        row["runs"].parse::<usize>().expect("a count")
    };
    for row in &statistics {
        let name = &row["metric"];
        if rows.iter().all(|row| !row[name].is_empty()) {
            assert_eq!(counted(name) + infinite(name), 12, "{name}");
        }
        let said = ran.err.contains(&format!("{name}: too large for a number in"));
        assert_eq!(said, infinite(name) > 0, "{name}: {}", ran.err);
    }
    let large = |row: &BTreeMap<String, String>| row["sd"].parse::<f64>().is_ok_and(|sd| sd > 1e180);
    assert!(statistics.iter().any(large), "{statistics:?}");
}

/// A sweep varies only the keys of `--vary`, unless the uncertain keys are to be drawn too.
#[test]
fn a_sweep_draws_only_if_it_is_asked_to() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let sweep = "sweep u.toml --set duration=100 --table csv --vary law.relay.weak=1e-6:2e-6:3";
    dir.run(&format!("{sweep} -o kept")).exits(0).says(&["note: the [uncertain] keys keep their values"]);
    let columns =
        |name: &str| dir.text(&format!("{name}/runs.csv")).lines().next().expect("a header").to_owned();
    assert!(columns("kept").starts_with("run,seed,law.relay.weak,switchings"), "{}", columns("kept"));
    dir.run(&format!("{sweep} -o drawn --uncertain")).exits(0);
    assert!(columns("drawn").starts_with("run,seed,law.relay.weak,body.planar.rate,law.relay.k_t,"));
    let rates: std::collections::BTreeSet<String> =
        table(&dir, "drawn/runs.csv").iter().map(|row| row["body.planar.rate"].clone()).collect();
    assert_eq!(rates.len(), 3);
    // The value of a swept key is what the sweep says, whether or not it is uncertain.
    let gains =
        "sweep u.toml --set duration=100 --table csv --vary law.relay.k_t=0.2,0.25 --uncertain -o gains";
    dir.run(gains).exits(0);
    let gains: Vec<String> =
        table(&dir, "gains/runs.csv").iter().map(|row| row["law.relay.k_t"].clone()).collect();
    assert_eq!(gains, ["0.2", "0.25"]);
    dir.write("plain.toml", UNCERTAIN.split("[uncertain]").next().expect("a scenario"));
    dir.run("sweep plain.toml --vary law.relay.k_t=0.2,0.25 --uncertain")
        .exits(2)
        .says(&["no [uncertain] keys"]);
}

/// One key has a curve and two have a map, drawn keys or not; the terminal has the metrics point by point.
#[test]
fn a_sweep_is_shown_over_its_keys() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let sweep = "sweep u.toml --set duration=200 --uncertain --vary law.relay.weak=1e-6:2e-6:30";
    let ran = dir.run(&format!("{sweep} -o one")).exits(0).says(&[
        "law.relay.weak",
        "... 14 more points",
        "0.000001",
    ]);
    assert!(!ran.err.contains(" sd ") && !ran.err.contains("95 %"), "{}", ran.err);
    let rows = ran.err.lines().skip_while(|line| !line.contains("law.relay.weak")).count();
    assert!(rows > 17, "{}", ran.err);
    dir.run("plot one --format svg -o figures").exits(0);
    assert!(dir.has("figures/u-curve.svg"), "{:?}", dir.names("figures"));
    dir.run(&format!("{sweep} --vary law.relay.k_t=0.3,0.31 -o two")).exits(0).says(&["law.relay.k_t"]);
    dir.run("plot two --format svg -o maps").exits(0);
    assert!(dir.names("maps").iter().all(|name| name.starts_with("u-region-")), "{:?}", dir.names("maps"));
}

/// A campaign counts what meets its goal, with the interval of Wilson's score.
#[test]
fn a_campaign_counts_what_meets_its_goal() {
    let dir = Dir::with(&["attitude-hold"]);
    let line = "simulate attitude-hold.toml --set duration=60 --runs 8";
    dir.run(&format!("{line} --set reference.band=1e-3")).exits(0).says(&[" of 8 runs meet the goal, "]);
    // A goal that the program made up is no verdict.
    dir.run(line).exits(0).says(&["attitude-hold   no requirement   8 runs in "]);
}
