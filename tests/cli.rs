//! The command: its verbs, its messages and its exit codes.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::util::{Dir, Ran, SCENARIOS, UNCERTAIN, has_extension};
use crate::wheel::FITTED_OPTIONS;

#[test]
fn help_and_version_are_no_failure() {
    let dir = Dir::new();
    dir.run("--help").exits(0).prints(&["simulate", "sweep", "log", "Usage"]);
    dir.run("--version").exits(0).prints(&[env!("CARGO_PKG_VERSION")]);
    for verb in
        ["simulate", "sweep", "modes", "cycle", "plan", "export", "log", "check", "schema", "completions"]
    {
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
    // Every file is checked, also after a bad one.
    dir.run("check bad.toml relay-fixed.toml")
        .exits(2)
        .says(&["bad.toml:18:7", "relay-fixed.toml: accepted"]);
    for name in scenarios() {
        dir.run(&format!("check {SCENARIOS}/{name}")).exits(0);
    }
}

#[test]
fn check_tells_mistakes_to_programs() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write(
        "bad.toml",
        UNCERTAIN.replace("dead_zone", "deadzone").replace("window = 100.0", "window = 'x'"),
    );
    let ran = dir.run("check bad.toml relay-fixed.toml none.toml --json").exits(2);
    assert!(ran.err.is_empty(), "{}", ran.err);
    let reported: Vec<Json> = ran.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(reported.len(), 3);
    assert_eq!(reported[0]["accepted"], false);
    let mistakes = reported[0]["mistakes"].as_array().expect("a list");
    assert_eq!(mistakes.len(), 2, "{mistakes:?}");
    let first = &mistakes[0];
    assert_eq!((&first["line"], &first["column"]), (&Json::from(14), &Json::from(1)));
    assert_eq!((&first["key"], &first["suggestion"]), (&"law.relay.deadzone".into(), &"dead_zone".into()));
    assert_eq!(
        (&mistakes[1]["line"], &mistakes[1]["key"]),
        (&Json::from(21), &"estimator.envelope.window".into())
    );
    assert_eq!(reported[1]["accepted"], true);
    assert_eq!(
        (&reported[2]["accepted"], &reported[2]["mistakes"][0]["line"]),
        (&Json::from(false), &Json::Null)
    );
}

#[test]
fn a_scenario_is_no_log() {
    let dir = Dir::with(&["relay-fixed"]);
    for verb in ["plot", "export"] {
        dir.run(&format!("{verb} relay-fixed.toml"))
            .exits(2)
            .says(&["not a log", "flexsc simulate relay-fixed.toml"]);
    }
    dir.run("simulate relay-fixed.toml --set duration=100").exits(0);
    dir.run("export relay-fixed.mcap --topic /modes").exits(2).says(&["no topic `/modes`", "--log full"]);
    assert!(!dir.run("export relay-fixed.mcap --topic /nothing").exits(2).err.contains("--log full"));
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

/// Checks that a schema has all keys of a value, and accepts the types of its numbers and strings.
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
fn modes_and_cycles_have_json_output() {
    let dir = Dir::with(&["relay-fixed"]);
    let modes = dir.run("modes relay-fixed.toml --json").exits(0).json();
    assert_eq!(modes["frequencies_rad_s"], serde_json::json!([0.44, 0.755]));
    let excitability = modes["excitabilities_s2"][0].as_f64().expect("a number");
    assert!((excitability - 0.0213 / (0.44 * 0.44)).abs() < 1e-15);
    let cycle = dir.run("cycle relay-fixed.toml --json --set law.relay.k_t=0.32").exits(0).json();
    assert_eq!(cycle["k_t"], 0.32);
    assert!(cycle["cycles"][0]["period_s"].as_f64().expect("a number") > 10.0);
    dir.run("modes relay-fixed.toml --units si").exits(0).says(&["0.44", "rad/s"]);
    dir.run("cycle relay-fixed.toml").exits(0).says(&["two-sided cycle", "period"]);
}

#[test]
fn noise_of_a_loop() {
    let dir = Dir::with(&["slew-wheel-lqg", "relay-fixed", "wheel-unstable-band", "wheel-fast-mode"]);
    let verb = "spectrum slew-wheel-lqg.toml";
    let noise = dir.run(&format!("{verb} --window 1 --separation 5 --json")).exits(0).json();
    let angle = &noise["outputs"][0];
    // By SciPy: tests/golden/noise.csv.
    assert!((angle["sample_rms"].as_f64().expect("a number") / 1.523_989_711_307_738e-6 - 1.0).abs() < 1e-9);
    assert_eq!(noise["sources"][0], "sensor.sampled.noise");
    assert!(angle["window"]["pde"].as_f64() > angle["window"]["smear"].as_f64());
    dir.run(verb).exits(0).says(&["1 source of noise", "sensor.sampled.noise", "100.0 %", "arcsec"]);
    dir.run(&format!("{verb} -o noise.csv")).exits(0);
    assert!(
        dir.text("noise.csv").starts_with("frequency_hz,angle_density,angle_cumulative_rms,angle_density ")
    );
    dir.run(&format!("{verb} -o figures --format svg")).exits(0);
    assert!(dir.has("figures/slew-wheel-lqg-density_angle.svg"));
    let set = "--set manoeuvre.angle=1e-9 --set duration=600";
    dir.run(&format!("simulate slew-wheel-lqg.toml {set} --log full")).exits(0);
    let compared = dir.run(&format!("{verb} --log slew-wheel-lqg.mcap --from 100")).exits(0);
    compared.says(&["by Welch's method", "/attitude angle_rad", "too wide for the narrowest peak"]);
    dir.run(&format!("{verb} --log slew-wheel-lqg.mcap --segment 4")).exits(2).says(&["--segment must be"]);
    dir.run(&format!("{verb} --signal roll")).exits(2).says(&["--signal must be", "mode0_displacement"]);
    dir.run(&format!("{verb} --window -1")).exits(2).says(&["--window must be positive"]);
    dir.run(&format!("{verb} --speeds 1:2:3")).exits(2).says(&["actuator.wheels.imbalance"]);
    dir.run("spectrum relay-fixed.toml").exits(2).says(&["law.relay", "is not linear"]);
    dir.run("spectrum wheel-fast-mode.toml").exits(2).says(&["has no noise"]);
    dir.run("spectrum wheel-unstable-band.toml").exits(2).says(&["not stable and has no spectrum"]);
}

#[test]
fn margins_of_a_loop() {
    let dir = Dir::with(&["wheel-fast-mode", "wheel-unstable-band", "relay-fixed"]);
    let margins = dir.run(&format!("margins wheel-fast-mode.toml {FITTED_OPTIONS} --json")).exits(0).json();
    let one = &margins["loops"][0];
    assert_eq!((&margins["loop"], &one["signal"]), (&"command".into(), &"command".into()));
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    // By the poles of loops that are off: tests/golden/margins.csv.
    assert!((number(&one["gain_above"]) - 43.754_409).abs() < 1e-4);
    assert!((number(&one["phase_rad"]) - 0.587_070).abs() < 1e-4);
    assert_eq!(one["gain"].as_array().map(Vec::len), Some(9));
    dir.run(&format!("margins wheel-fast-mode.toml {FITTED_OPTIONS} --units si --loop torque"))
        .exits(0)
        .says(&["at the torque", "43.75"]);
    let measured = dir.run("margins wheel-fast-mode.toml --loop measurement").exits(0);
    measured.says(&["2 loops cut open at the measurement", "all together", "crossings"]);
    dir.run("margins wheel-fast-mode.toml -o figures --format svg").exits(0);
    assert_eq!(
        dir.names("figures"),
        ["bode", "nichols", "nyquist", "root-locus", "singular-values"]
            .map(|name| format!("wheel-fast-mode-{name}.svg"))
    );
    let unstable = ["not stable and has no margins", "magnitude 1.0476992", "0.0174 Hz", "`command`"];
    dir.run("margins wheel-unstable-band.toml").exits(2).says(&unstable);
    dir.run("margins relay-fixed.toml").exits(2).says(&["law.relay", "is not linear"]);
    dir.run("margins wheel-fast-mode.toml --loop wheel").exits(2).says(&["command, torque, measurement"]);
}

#[test]
fn scenarios_side_by_side_have_logs_of_their_own() {
    let dir = Dir::with(&["relay-fixed", "relay-quiet"]);
    dir.run("simulate relay-fixed.toml relay-quiet.toml -o out").exits(0);
    assert_eq!(dir.names("out"), ["relay-fixed.mcap", "relay-quiet.mcap"]);
    dir.run("simulate relay-fixed.toml relay-quiet.toml --runs 2 --table csv -o both").exits(0);
    let tables = ["relay-fixed-runs.csv", "relay-fixed-scenario.toml", "relay-fixed-statistics.csv"];
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

#[test]
fn a_run_that_fails_does_not_stop_the_others() {
    let dir = Dir::with(&["relay-fixed"]);
    let short =
        UNCERTAIN.replace("k_t = 0.31", "k_t = 1e-3").replace("hysteresis = 1e-4", "hysteresis = 1e-300");
    dir.write("chatter.toml", short);
    let failed = dir.run("simulate chatter.toml relay-fixed.toml").exits(1);
    failed.says(&["chatter: the law decided", "relay-fixed   no requirement"]);
    assert!(dir.has("relay-fixed.mcap"));
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
