//! The command: exit codes, what it prints and writes, and what it leaves behind when something fails.

use std::collections::BTreeMap;
use std::path::Path;

use flexsc_core::campaign::{Campaign, Run};
use flexsc_core::record::{Detail, LogFile, Record, RecordError, Sample, recover};
use flexsc_core::time::Instant;
use flexsc_core::{Document, Scenario};
use serde_json::Value as Json;

use crate::util::{Dir, Ran, SCENARIOS};

/// A short scenario with an uncertain gain and rate.
const UNCERTAIN: &str = r#"seed = 7
duration = 800.0

[body.planar]
angle = 4.5e-4
rate = 2.2e-5

[[body.planar.modes]]
frequency = 0.44
gain = 0.0213
displacement = 2.75e-6

[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
k_t = 0.31

[estimator.envelope]
window = 100.0

[uncertain]
"law.relay.k_t" = { uniform = [0.3, 0.32] }
"body.planar.rate" = { relative_normal = 0.1 }
"#;

#[test]
fn help_and_version_are_no_failure() {
    let dir = Dir::new();
    dir.run("--help").exits(0).prints(&["simulate", "sweep", "log", "Usage"]);
    dir.run("--version").exits(0).prints(&[env!("CARGO_PKG_VERSION")]);
    for verb in ["simulate", "sweep", "modes", "cycle", "export", "log", "check", "schema", "completions"] {
        dir.run(&format!("{verb} --help")).exits(0).prints(&["Usage: flexsc", verb]);
    }
}

#[test]
fn what_is_unknown_is_bad_input() {
    let dir = Dir::with(&["relay-fixed"]);
    for arguments in [
        "",
        "simulat relay-fixed.toml",
        "simulate relay-fixed.toml --verbose",
        "simulate",
        "simulate relay-fixed.toml --log most",
        "simulate relay-fixed.toml --jobs 0",
        "simulate relay-fixed.toml --runs 0",
        "simulate relay-fixed.toml --runs 4:4",
        "simulate relay-fixed.toml --runs x",
        "simulate relay-fixed.toml --seed -1",
        "simulate relay-fixed.toml --seed 9223372036854775808",
        "sweep relay-fixed.toml --vary law.relay.k_t=0.3:0.4",
        "sweep relay-fixed.toml --vary law.relay.k_t=0.3:inf:3",
        "completions basic",
    ] {
        let ran = dir.run(arguments).exits(2);
        assert!(ran.out.is_empty(), "{arguments}: {}", ran.out);
    }
    assert_eq!(dir.names(""), ["relay-fixed.toml"]);
}

#[test]
fn check_accepts_the_good_and_refuses_the_bad() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("check relay-fixed.toml").exits(0).says(&["relay-fixed.toml: accepted", "20000 s", "2 modes"]);
    dir.write("bad.toml", UNCERTAIN.replace("k_t = 0.31", "k_t = 31"));
    dir.run("check relay-fixed.toml bad.toml").exits(2).says(&["bad.toml:18:7", "got 31"]);
    for name in scenarios() {
        dir.run(&format!("check {SCENARIOS}/{name}")).exits(0);
    }
}

fn has_extension(name: &str, extension: &str) -> bool {
    Path::new(name).extension().is_some_and(|e| e == extension)
}

/// The files of the shipped scenarios.
fn scenarios() -> Vec<String> {
    let entries = std::fs::read_dir(SCENARIOS).expect("shipped").flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let names: Vec<_> = names.filter(|name| has_extension(name, "toml")).collect();
    assert!(names.len() >= 3);
    names
}

#[test]
fn the_schema_knows_every_shipped_key() {
    let schema = Dir::new().run("schema").exits(0).json();
    assert!(schema["$schema"].as_str().expect("a dialect").contains("json-schema.org"));
    for reference in references(&schema) {
        assert!(schema.pointer(reference.trim_start_matches('#')).is_some(), "{reference} leads nowhere");
    }
    for name in scenarios() {
        let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}")).expect("readable");
        let known = knows(&schema, &schema, &toml::Value::Table(text.parse().expect("TOML")), "");
        assert_eq!(known, Ok(()), "{name}");
    }
    let wrong: toml::Table = UNCERTAIN.replace("hysteresis", "hystersis").parse().expect("TOML");
    let refused = knows(&schema, &schema, &toml::Value::Table(wrong), "").expect_err("misspelt");
    assert!(refused.contains("law"), "{refused}");
    let right: toml::Table = UNCERTAIN.parse().expect("TOML");
    assert_eq!(knows(&schema, &schema, &toml::Value::Table(right), ""), Ok(()));
}

/// Every `$ref` of a schema.
fn references(schema: &Json) -> Vec<String> {
    match schema {
        Json::Object(map) => map
            .iter()
            .flat_map(|(key, value)| match value.as_str().filter(|_| key == "$ref") {
                Some(reference) => vec![reference.to_owned()],
                None => references(value),
            })
            .collect(),
        Json::Array(values) => values.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}

/// Whether a schema knows all keys of a value, and accepts the types of its numbers and strings.
fn knows(root: &Json, schema: &Json, value: &toml::Value, path: &str) -> Result<(), String> {
    if let Some(reference) = schema["$ref"].as_str() {
        let target = root.pointer(reference.trim_start_matches('#')).expect("checked before");
        return knows(root, target, value, path);
    }
    if let Some(choices) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
        let refusals: Vec<_> = choices.iter().map_while(|one| knows(root, one, value, path).err()).collect();
        return if refusals.len() < choices.len() { Ok(()) } else { Err(refusals.join("; ")) };
    }
    match value {
        toml::Value::Table(table) => table.iter().try_for_each(|(key, value)| {
            let path = format!("{path}.{key}");
            let known = [&schema["properties"][key], &schema["additionalProperties"]];
            let known = known.into_iter().find(|schema| schema.is_object());
            knows(root, known.ok_or_else(|| format!("{path} is unknown"))?, value, &path)
        }),
        toml::Value::Array(array) => {
            array.iter().try_for_each(|value| knows(root, &schema["items"], value, &format!("{path}[]")))
        }
        _ => {
            let accepted: &[&str] = match value {
                toml::Value::Integer(_) => &["integer", "number"],
                toml::Value::Float(_) => &["number"],
                toml::Value::Boolean(_) => &["boolean"],
                _ => &["string"],
            };
            let types = &schema["type"];
            let is = |name: &Json| name.as_str().is_some_and(|name| accepted.contains(&name));
            let word = schema["const"].is_string() && value.is_str();
            let right = is(types) || types.as_array().is_some_and(|types| types.iter().any(is)) || word;
            if right { Ok(()) } else { Err(format!("{path} is no {types}")) }
        }
    }
}

#[test]
fn every_metric_is_explained() {
    let dir = Dir::with(&["relay-fixed", "relay-adaptive"]);
    let meanings = dir.run("schema --metrics").exits(0).json();
    let meanings: BTreeMap<&str, &Json> = meanings
        .as_array()
        .expect("a list")
        .iter()
        .map(|m| (m["name"].as_str().expect("a name"), m))
        .collect();
    for scenario in ["relay-fixed", "relay-adaptive"] {
        let line = dir.run(&format!("simulate {scenario}.toml --json --log none")).exits(0).json();
        let metrics = line["metrics"].as_object().expect("metrics");
        assert!(metrics.len() > 15 && metrics.contains_key("cycle_period_s"));
        for name in metrics.keys() {
            let meaning = meanings.get(name.as_str()).unwrap_or_else(|| panic!("{name} is not explained"));
            assert!(meaning["unit"].is_string() && meaning["doc"].as_str().is_some_and(|doc| doc.len() > 10));
            let is_united = name.ends_with("_s") || name.ends_with("_rad");
            assert!(!is_united || meaning["unit"] != "", "{name} has no unit");
        }
    }
}

#[test]
fn completions_are_printed() {
    for shell in ["bash", "zsh", "fish"] {
        Dir::new().run(&format!("completions {shell}")).exits(0).prints(&["flexsc", "simulate", "recover"]);
    }
}

#[test]
fn modes_and_cycles_are_told_as_json() {
    let dir = Dir::with(&["relay-fixed"]);
    let modes = dir.run("modes relay-fixed.toml --json").exits(0).json();
    assert_eq!(modes["frequencies_rad_s"], serde_json::json!([0.44, 0.755]));
    let excitability = modes["excitabilities_s2"][0].as_f64().expect("a number");
    assert!((excitability - 0.0213 / (0.44 * 0.44)).abs() < 1e-15);
    let cycle = dir.run("cycle relay-fixed.toml --json --set law.relay.k_t=0.32").exits(0).json();
    assert_eq!(cycle["k_t"], 0.32);
    assert!(cycle["cycles"][0]["period_s"].as_f64().expect("a number") > 10.0);
    dir.run("modes relay-fixed.toml").exits(0).says(&["0.44", "rad/s"]);
    dir.run("cycle relay-fixed.toml").exits(0).says(&["two-sided cycle", "period"]);
}

#[test]
fn scenarios_side_by_side_have_logs_of_their_own() {
    let dir = Dir::with(&["relay-fixed", "relay-quiet"]);
    dir.run("simulate relay-fixed.toml relay-quiet.toml -o out").exits(0);
    assert_eq!(dir.names("out"), ["relay-fixed.mcap", "relay-quiet.mcap"]);
    dir.run("simulate relay-fixed.toml relay-quiet.toml --runs 2 -o both").exits(0);
    let tables = ["relay-fixed-runs.csv", "relay-fixed-statistics.csv", "relay-quiet-runs.csv"];
    assert_eq!(dir.names("both")[..3], tables);
    std::fs::create_dir(dir.path("other")).expect("a directory");
    dir.write("other/relay-fixed.toml", dir.read("relay-quiet.toml"));
    dir.run("simulate relay-fixed.toml other/relay-fixed.toml -o none").exits(2).says(&[
        "other/relay-fixed.toml",
        "`relay-fixed`",
        "hint",
    ]);
    assert!(!dir.has("none"));
}

#[test]
fn keys_and_seeds_are_set() {
    let dir = Dir::with(&["relay-adaptive"]);
    let run = |set: &str| dir.run(&format!("simulate relay-adaptive.toml --log none --json {set}"));
    let gain = |set: &str| run(set).exits(0).json()["metrics"]["gain_final"].as_f64().expect("a number");
    let short = "--set duration=4000";
    assert_eq!(
        run("--set law.relay.k_t=0.34 --set duration=100").exits(0).json()["metrics"]["gain_initial"],
        0.34
    );
    assert_eq!(run("--set name=else --set duration=100").exits(0).json()["scenario"], "else");
    assert_eq!(run("--seed 9223372036854775807 --set duration=100").json()["seed"], i64::MAX);
    assert_ne!(gain(short), gain(&format!("{short} --seed 3")));
    assert_eq!(gain(&format!("{short} --seed 3")), gain(&format!("{short} --set seed=3")));
    run("--set law.relay.k_tt=0.3").exits(2).says(&[
        "unknown key `k_tt`",
        "`k_t`",
        "with law.relay.k_tt set",
    ]);
    run("--set law.relay.k_t=much")
        .exits(2)
        .says(&["`law.relay.k_t`: found string \"much\", expected a number"]);
    run("--set law.relay.k_t=2").exits(2).says(&["`law.relay.k_t`: must be a number between 0 and 1, got 2"]);
    run("--set law.relay.k_t=0.9").exits(2).says(&["`law.relay.k_t` must lie within", "got 0.9"]);
    run("--set law..k_t=0.3").exits(2).says(&["law..k_t", "not the path of a key"]);
    run("--set body.planar.modes[2].gain=1").exits(2).says(&["no element 2", "the array has 2"]);
    run("--set law.relay.k_t").exits(2).says(&["not a KEY=VALUE"]);
    assert_eq!(dir.names(""), ["relay-adaptive.toml"]);
}

/// The rows of a table, each by the names of its columns.
fn table(dir: &Dir, name: &str) -> Vec<BTreeMap<String, String>> {
    let bytes = dir.read(name);
    csv::Reader::from_reader(&*bytes).deserialize().map(|row| row.expect("a whole row")).collect()
}

#[test]
fn a_campaign_writes_tables_and_logs() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 6 -o out --log events").exits(0).says(&["6 runs", "runs.csv"]);
    let logs = (0..6).map(|run| format!("u-{run}.mcap"));
    let all: Vec<_> = ["runs.csv".to_owned(), "statistics.csv".to_owned()].into_iter().chain(logs).collect();
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
fn a_run_alone_is_the_run_of_the_campaign() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 6 -o out").exits(0);
    let before = (dir.read("out/runs.csv"), dir.read("out/statistics.csv"));
    dir.run("simulate u.toml --runs 3:4 -o out --log full").exits(0);
    assert_eq!((dir.read("out/runs.csv"), dir.read("out/statistics.csv")), before);
    let names = ["runs-3-4.csv", "runs.csv", "statistics-3-4.csv", "statistics.csv", "u-3.mcap"];
    assert_eq!(dir.names("out"), names);
    assert_eq!(table(&dir, "out/runs-3-4.csv"), table(&dir, "out/runs.csv")[3..4]);
    // The log's own scenario, with what was drawn, makes the same run.
    let toml = dir.run("log scenario out/u-3.mcap").exits(0).out;
    dir.write("three.toml", &toml);
    let row = &table(&dir, "out/runs.csv")[3];
    let duty = format!("\"duty\":{},", row["duty"].parse::<f64>().expect("a number"));
    let switchings = format!("\"switchings\":{},", row["switchings"]);
    dir.run("simulate three.toml --json --log none").exits(0).prints(&[&duty, &switchings]);
}

#[test]
fn threads_change_nothing() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 12 -o one --log full --jobs 1").exits(0);
    dir.run("simulate u.toml --runs 12 -o eight --log full --jobs 8").exits(0);
    let names = dir.names("one");
    assert_eq!((names.len(), &names), (14, &dir.names("eight")));
    for name in names {
        let same = dir.read(&format!("one/{name}")) == dir.read(&format!("eight/{name}"));
        assert!(same, "{name} differs");
    }
    let lines = dir.run("simulate u.toml --runs 12 --json --jobs 1").exits(0).out;
    assert_eq!(lines.lines().count(), 12);
    assert_eq!(lines, dir.run("simulate u.toml --runs 12 --json --jobs 8").exits(0).out);
}

#[test]
fn invalid_draws_fail_alone() {
    let wide = UNCERTAIN.replace("{ uniform = [0.3, 0.32] }", "{ normal = { mean = 0.31, sd = 0.3 } }");
    let dir = Dir::holding("u.toml", wide);
    let ran = dir.run("simulate u.toml --runs 20 -o out --log events").exits(1);
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
    dir.run("simulate u.toml --runs 3 -o out").exits(1).says(&["3 of 3 runs failed"]);
    let rows = table(&dir, "out/runs.csv");
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row["error"].contains("law.relay.k_t") && row["seed"] == "7"));
}

#[test]
fn a_sweep_varies_one_key() {
    let dir = Dir::with(&["relay-fixed"]);
    let vary = "sweep relay-fixed.toml --set duration=1000 -o out --vary law.relay.k_t";
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
fn a_directory_that_cannot_be_made_is_named() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("file", "");
    for arguments in ["", "--runs 2", "--runs 2 --log events"] {
        let ran = dir.run(&format!("simulate relay-fixed.toml -o file/sub {arguments}")).exits(1);
        ran.says(&["error: cannot write file/sub: "]);
    }
    dir.run("sweep relay-fixed.toml --vary law.relay.k_t=0.3:0.4:5 -o file/sub").exits(1).says(&["file/sub"]);
    std::fs::create_dir(dir.path("relay-fixed.mcap")).expect("a directory");
    dir.run("simulate relay-fixed.toml --set duration=10")
        .exits(1)
        .says(&["cannot write relay-fixed.mcap: "]);
    assert_eq!(dir.names(""), ["file", "relay-fixed.mcap", "relay-fixed.toml"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_nothing() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("u.toml", UNCERTAIN);
    let fill = |name: &str| {
        std::fs::create_dir_all(dir.path("out")).expect("a directory");
        std::os::unix::fs::symlink("/dev/full", dir.path(&format!("out/{name}.partial"))).expect("a link");
    };
    let full = |name: &str, arguments: &str| {
        fill(name);
        dir.run(arguments).exits(1).says(&["error: cannot write ", "No space left on device"]);
        assert!(!dir.has(&format!("out/{name}")) && !dir.has(&format!("out/{name}.partial")), "{name}");
        let left: Vec<_> = dir.names("out").into_iter().filter(|n| n.ends_with(".partial")).collect();
        assert!(left.is_empty(), "{left:?}");
    };
    // Full before the first chunk, amid the run, and only at its end.
    full("relay-fixed.mcap", "simulate relay-fixed.toml -o out --log full");
    full("relay-fixed.mcap", "simulate relay-fixed.toml -o out");
    full("relay-fixed.mcap", "simulate relay-fixed.toml -o out --set duration=10");
    assert!(dir.names("out").is_empty());
    full("u-1.mcap", "simulate u.toml --runs 3 -o out --log events");
    assert!(!dir.has("out/runs.csv"));
    full("runs.csv", "simulate u.toml --runs 3 -o out");
    full("runs.csv", "simulate u.toml --runs 2000 --set duration=1 -o out");
    assert!(!dir.has("out/statistics.csv"));
    full("statistics.csv", "simulate u.toml --runs 3 -o out");
    assert!(dir.has("out/runs.csv"));
    dir.run("simulate relay-fixed.toml -o whole").exits(0);
    dir.run("log recover whole/relay-fixed.mcap -o /dev/full").exits(1).says(&["cannot write /dev/full"]);
    assert!(Path::new("/dev/full").exists());
}

/// What the file's summary says of how the run ended.
fn end(dir: &Dir, log: &str) -> BTreeMap<String, String> {
    let bytes = dir.read(log);
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let index = summary.metadata_indexes.iter().find(|m| m.name == "flexsc.end").expect("an end");
    mcap::read::metadata(&bytes, index).expect("whole").metadata
}

const LONG: &str = "simulate relay-fixed.toml -o out --log events --set duration=5e8";

#[cfg(unix)]
#[test]
fn an_interrupted_run_has_a_whole_log() {
    let dir = Dir::with(&["relay-fixed"]);
    for signal in ["INT", "TERM"] {
        let run = dir.start(LONG);
        dir.wait_for("out/relay-fixed.mcap.partial", 200_000);
        run.signal(signal).exits(130).says(&["interrupted", "out/relay-fixed.mcap"]);
        assert_eq!(dir.names("out"), ["relay-fixed.mcap"]);
        let end = end(&dir, "out/relay-fixed.mcap");
        assert_eq!(end["end"], "interrupted");
        let rows = command_rows(&dir, "out/relay-fixed.mcap");
        assert!(rows.len() > 2000);
        // The log ends with what was told last, a switching or the mean of a window.
        let (last, end) = (seconds(rows.last().expect("rows")), seconds(&end["time_s"]));
        assert!((0.0..100.0).contains(&(end - last)), "{last} {end}");
        std::fs::remove_dir_all(dir.path("out")).expect("removed");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_campaign_keeps_whole_files_only() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let run = dir.start("simulate u.toml --runs 100000 -o out --log events");
    dir.wait_for("out/u-300.mcap", 1);
    run.signal("INT").exits(130).says(&["interrupted at run "]);
    let names = dir.names("out");
    assert!(names.iter().all(|name| !name.ends_with(".partial")), "{names:?}");
    assert!(!names.contains(&"statistics.csv".to_owned()));
    let rows = table(&dir, "out/runs.csv").len();
    assert!((256..100_000).contains(&rows));
    // Only the runs that were under way when the signal came have logs that stop early.
    let early = names.iter().filter(|name| has_extension(name, "mcap"));
    let early = early.filter(|name| end(&dir, &format!("out/{name}"))["end"] != "complete").count();
    assert!(early <= 64, "{early} logs of runs that never were");
}

/// The rows of `/command` without their header.
fn command_rows(dir: &Dir, log: &str) -> Vec<String> {
    let text = dir.run(&format!("export {log} --topic /command")).exits(0).out;
    text.lines().skip(1).map(str::to_owned).collect()
}

/// The time with which a row begins.
fn seconds(row: &str) -> f64 {
    row.split(',').next().expect("a time").parse().expect("a number")
}

#[cfg(unix)]
#[test]
fn a_killed_run_is_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    let run = dir.start(LONG);
    dir.wait_for("out/relay-fixed.mcap.partial", 1_000_000);
    assert_eq!(run.signal("KILL").code, None);
    assert_eq!(dir.names("out"), ["relay-fixed.mcap.partial"]);
    let torn = "out/relay-fixed.mcap.partial";
    let hint = format!("`flexsc log recover {torn}`");
    dir.run(&format!("export {torn} --topic /command")).exits(2).says(&["torn", &hint]);
    dir.run(&format!("log scenario {torn}")).exits(2).says(&["torn", &hint]);
    dir.run(&format!("log recover {torn}"))
        .exits(0)
        .says(&["messages saved", "out/relay-fixed-recovered.mcap"]);
    let saved = command_rows(&dir, "out/relay-fixed-recovered.mcap");
    assert!(saved.len() > 5000, "{} rows", saved.len());
    let last = seconds(saved.last().expect("rows"));
    dir.run(&format!("simulate relay-fixed.toml -o whole --set duration={}", last + 1.0)).exits(0);
    assert_eq!(command_rows(&dir, "whole/relay-fixed.mcap")[..saved.len()], saved);
    dir.run("log scenario out/relay-fixed-recovered.mcap").exits(0).prints(&["duration = 500000000.0"]);
}

/// Looks now and then at what a run's log would be if the run were killed there.
struct Killer<'a> {
    dir: &'a Dir,
    /// Messages written so far, that of `/params` among them.
    written: u64,
    looks: u64,
}

impl Record for Killer<'_> {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.written += 1;
        if self.written.is_multiple_of(1777) {
            self.looks += 1;
            let saved = recover(&self.dir.path("x.mcap.partial"), &self.dir.path("saved.mcap"));
            let saved = saved.expect("recovered");
            assert!(saved <= self.written && saved + 2000 >= self.written, "{saved} of {}", self.written);
        }
        Ok(())
    }
}

#[test]
fn a_killed_run_loses_at_most_2000_messages() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut document = Document::load(&dir.path("relay-fixed.toml")).expect("a scenario");
    document.set_text("duration", "1e5").expect("a key");
    let scenario = Scenario::from_document(&document).expect("a scenario");
    let run = Run { number: 0, scenario, drawn: Vec::new() };
    let provenance = Campaign::provenance(&run);
    let mut log = LogFile::create(&dir.path("x.mcap"), &provenance, Detail::Events).expect("created");
    let mut killer = Killer { dir: &dir, written: 1, looks: 0 };
    Campaign::simulate(&run, (&mut log, &mut killer)).expect("a run");
    assert!(killer.looks > 5);
    log.discard();
    assert_eq!(dir.names(""), ["relay-fixed.toml", "saved.mcap"]);
}

/// Wherever a log is torn, all chunks before are saved, and no chunk has more than 2000 messages.
#[test]
fn a_log_torn_anywhere_is_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml -o out --log full --set duration=2000").exits(0);
    let bytes = dir.read("out/relay-fixed.mcap");
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let chunks = &summary.chunk_indexes;
    let messages: Vec<_> =
        mcap::MessageStream::new(&bytes).expect("a log").map(|m| m.expect("whole")).collect();
    for part in [0.0, 0.1, 0.5, 0.77, 0.999] {
        let cut = 8 + ((bytes.len() - 8) as f64 * part) as usize;
        dir.write("torn.mcap.partial", &bytes[..cut]);
        let ran = dir.run("log recover torn.mcap.partial -o saved.mcap").exits(0);
        let saved: usize = ran.err.split_whitespace().next().expect("a count").parse().expect("a count");
        let before = chunks.iter().filter(|c| c.chunk_start_offset + c.chunk_length <= cut as u64);
        let indexes = before.map(|c| summary.read_message_indexes(&bytes, c).expect("indexes"));
        let whole: usize = indexes.flat_map(|indexes| indexes.into_values().map(|of| of.len())).sum();
        assert!(saved >= whole && saved <= whole + 2000, "{saved} messages of {whole} at {part}");
        let saved_bytes = dir.read("saved.mcap");
        let stream = mcap::MessageStream::new(&saved_bytes).expect("a log").map(|m| m.expect("whole"));
        let same = stream.zip(&messages).take_while(|(a, b)| {
            (&*a.channel.topic, a.log_time, &a.data) == (&*b.channel.topic, b.log_time, &b.data)
        });
        assert_eq!(same.count(), saved);
    }
}

#[test]
fn what_is_no_log_is_not_recovered() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("log recover relay-fixed.toml -o saved.mcap")
        .exits(2)
        .says(&["relay-fixed.toml: not a readable MCAP log"]);
    dir.run("log recover relay-fixed.toml").exits(2);
    dir.run("log recover missing.mcap").exits(2).says(&["missing.mcap", "No such file"]);
    dir.run("log recover relay-fixed.toml -o relay-fixed.toml").exits(2).says(&["into itself"]);
    dir.run("export relay-fixed.toml").exits(2).says(&["relay-fixed.toml: not a readable MCAP log"]);
    dir.run("export missing.mcap").exits(2).says(&["missing.mcap", "No such file"]);
    assert_eq!(dir.names(""), ["relay-fixed.toml"]);
    dir.run("simulate relay-fixed.toml").exits(0);
    dir.run("log recover relay-fixed.mcap -o missing/saved.mcap")
        .exits(1)
        .says(&["cannot write missing/saved.mcap"]);
}

#[test]
fn topics_are_exported() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml").exits(0);
    let topics = dir.run("export relay-fixed.mcap").exits(0).out;
    let topics: Vec<_> = topics.lines().collect();
    assert_eq!(topics, ["/command", "/envelope_mean", "/law", "/metrics", "/params"]);
    let ran = dir
        .run("export relay-fixed.mcap --topic /comand")
        .exits(2)
        .says(&["no topic `/comand`"])
        .says(&topics);
    assert!(ran.out.is_empty());

    let csv = dir.run("export relay-fixed.mcap --topic /command").exits(0).out;
    let (header, rows) = csv.split_once('\n').expect("lines");
    assert_eq!(header, "time_s,state,cause,torque_nm,angle_rad,rate_rad_s,gain");
    assert_eq!(rows.lines().count(), 2719);
    for row in rows.lines() {
        let (whole, part) = row.split(',').next().and_then(|time| time.split_once('.')).expect("a time");
        assert!(whole.parse::<u64>().is_ok() && part.len() == 15 && part.parse::<u64>().is_ok(), "{row}");
    }
    dir.run("export relay-fixed.mcap --topic /command -o command.csv").exits(0);
    assert_eq!(dir.text("command.csv"), csv);

    let lines = dir.run("export relay-fixed.mcap --topic /command --format jsonl").exits(0).out;
    let rows: Vec<Json> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(rows.len(), 2719);
    assert!(rows.iter().all(|row| row["time_s"].is_f64() && row["state"].is_string()));
    dir.run("export relay-fixed.mcap --topic /command -o missing/x.csv").exits(1).says(&["missing/x.csv"]);
}

/// A log is made anew from the scenario that it holds.
#[test]
fn a_log_makes_itself_again() {
    let dir = Dir::with(&["relay-fixed", "relay-adaptive"]);
    for name in ["relay-fixed", "relay-adaptive"] {
        let set = "--set duration=3000 --set epoch=2026-03-20T14:46:00Z --seed 5 --log full";
        dir.run(&format!("simulate {name}.toml -o first {set}")).exits(0);
        let toml = dir.run(&format!("log scenario first/{name}.mcap")).exits(0).out;
        dir.write("again.toml", &toml);
        dir.run("simulate again.toml -o second --log full").exits(0);
        let (first, second) = (format!("first/{name}.mcap"), format!("second/{name}.mcap"));
        assert!(dir.read(&first) == dir.read(&second), "{name} differs");
    }
}

#[test]
fn logs_are_good_mcap() {
    let dir = Dir::with(&["relay-fixed"]);
    let events = ["/command", "/envelope_mean", "/law", "/metrics", "/params"];
    let motion = ["/attitude", "/envelope", "/modes", "/rate"];
    dir.run("simulate relay-fixed.toml -o events --set epoch=2026-03-20T14:46:00Z").exits(0);
    inspect(&dir, "events/relay-fixed.mcap", &events, 1_774_017_960_000_000_000);
    dir.run("simulate relay-fixed.toml -o full --log full --set duration=2000").exits(0);
    inspect(&dir, "full/relay-fixed.mcap", &[&events[..], &motion[..]].concat(), 0);
}

fn inspect(dir: &Dir, log: &str, topics: &[&str], epoch_ns: u64) {
    let bytes = dir.read(log);
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let statistics = summary.stats.as_ref().expect("statistics");
    assert_eq!(statistics.message_start_time, epoch_ns);
    assert!(summary.chunk_indexes.len() > 1);
    for chunk in &summary.chunk_indexes {
        assert!(!chunk.message_index_offsets.is_empty(), "a chunk without a message index");
        assert!(chunk.message_start_time >= statistics.message_start_time);
        assert!(chunk.message_end_time <= statistics.message_end_time);
        let indexed = summary.read_message_indexes(&bytes, chunk).expect("indexes");
        let count: usize = indexed.values().map(Vec::len).sum();
        assert!((1..=2000).contains(&count), "{count} messages in a chunk");
    }
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&bytes).expect("a log") {
        let message = message.expect("whole");
        assert!(message.log_time >= last && message.publish_time == message.log_time, "time runs back");
        last = message.log_time;
        *counts.entry(message.channel.topic.clone()).or_default() += 1;
    }
    assert_eq!(counts.values().sum::<usize>() as u64, statistics.message_count);
    let mut topics = topics.to_vec();
    topics.sort_unstable();
    assert_eq!(counts.keys().collect::<Vec<_>>(), topics);
    // What is exported was decoded by the schema that the file carries.
    for (topic, count) in counts {
        let rows = dir.run(&format!("export {log} --topic {topic} --format jsonl")).exits(0).out;
        assert_eq!(rows.lines().count(), count, "{topic}");
        assert!(rows.starts_with("{\"time_s\":"), "{topic}");
    }
    let attachment = |name: &str| {
        let index = summary.attachment_indexes.iter().find(|a| a.name == name).expect("attached");
        String::from_utf8(mcap::read::attachment(&bytes, index).expect("whole").data.into_owned())
            .expect("text")
    };
    assert_eq!(attachment("scenario.toml"), dir.run(&format!("log scenario {log}")).exits(0).out);
    serde_json::from_str::<Json>(&attachment("layout.json")).expect("a layout");
    assert_eq!(end(dir, log)["end"], "complete");
}

#[test]
fn logs_are_small() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml -o events").exits(0);
    dir.run("simulate relay-fixed.toml -o full --log full").exits(0);
    let (events, full) = (dir.read("events/relay-fixed.mcap").len(), dir.read("full/relay-fixed.mcap").len());
    assert!(events < 300_000, "{events} bytes of events");
    assert!(full < 40_000_000, "{full} bytes of motion");
}

/// Data goes to stdout, text to stderr.
#[test]
fn stdout_holds_data_only() {
    let dir = Dir::with(&["relay-fixed"]);
    let quiet = |arguments: &str| -> Ran {
        let ran = dir.run(arguments).exits(0);
        assert!(ran.out.is_empty(), "{arguments}: {}", ran.out);
        ran
    };
    quiet("simulate relay-fixed.toml").says(&["2719 switchings", "relay-fixed.mcap"]);
    quiet("simulate relay-fixed.toml --runs 2");
    quiet("modes relay-fixed.toml");
    quiet("check relay-fixed.toml");
    quiet("log recover relay-fixed.mcap");
    let ran = dir.run("simulate relay-fixed.toml --json --log none").exits(0);
    assert!(ran.err.is_empty() && ran.out.lines().count() == 1, "{}", ran.err);
}
