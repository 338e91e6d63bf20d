//! Faults of which a run has one: known motions, tables of faults by requirements, draws, and what does not fit.

use flexsc_core::metrics::{MetricValue, MetricsCollector};
use flexsc_core::{Scenario, Simulation};

use crate::util::Dir;

/// A body of 100 kg m² at rest, which a fault turns: by 10 N m for 1 s to 0.1 rad/s, so that it is at 0.05 + 0.1 (t - 6) rad.
const REST: &str = r#"
name = "rest"
duration = 12.0

[body.planar]
inertia = 100.0

[sensor.sampled]
period = 1.0

[law.open]

[actuator.ideal]
faults = [{ scaled = { from = 0.0, factor = 1.0 } }]

[[fault]]
name = "push"
actuator = { part = "ideal", faults = [{ added = { from = 5.0, to = 6.0, constant = 10.0 } }] }

[[fault]]
name = "shove and silence"
sensor = { part = "sampled", faults = [{ silent = { from = "5 s" } }] }
actuator = [{ part = "ideal", faults = [{ added = { from = "5 s", to = "6 s", constant = 30.0 } }] }]

[[requirement]]
name = "stays near"
holds = "when fault(push) or fault(shove and silence): for 4 s: pointing_error < 0.5"

[[requirement]]
name = "turns slowly"
holds = "truth.rate < 0.2"
"#;

fn scenario(text: &str) -> Scenario {
    Scenario::parse("rest.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn values(scenario: &Scenario) -> Vec<f64> {
    let mut metrics = MetricsCollector::new(scenario);
    Simulation::new(scenario, 0).run(&mut metrics).expect("a run");
    let all = metrics.finish(scenario);
    all.get("requirement_values").map_or_else(Vec::new, MetricValue::numbers)
}

#[test]
fn a_run_has_the_failures_of_its_fault_alone() {
    let active = |name: &str| format!("active_fault = \"{name}\"\n{REST}");
    // 4 s after its start, the push has brought it to 0.05 + 0.1 (9 - 6) rad, the shove to three times as much.
    for (name, near, rate) in [("none", f64::NAN, 0.0), ("push", 0.35, 0.1), ("shove and silence", 1.05, 0.3)]
    {
        let found = values(&scenario(&active(name)));
        for (found, known) in found.iter().zip([near, rate]) {
            assert!((found - known).abs() < 1e-12 || found.is_nan() && known.is_nan(), "{name}: {found}");
        }
        // A written scenario has the failures once, wherever its fault is read again.
        let written = scenario(&active(name)).to_toml();
        assert_eq!(written.matches("added").count(), 2, "{written}");
        assert_eq!(scenario(&written).to_toml(), written);
    }
    let changed = scenario(&active("push")).with(|spec| spec.active_fault = Some("none".to_owned()));
    assert_eq!(changed.expect("no fault").failures().len(), 1);
}

#[test]
fn a_sweep_over_faults_has_a_table_by_requirements_and_saves_the_least_robust_run() {
    let dir = Dir::new();
    dir.write("rest.toml", REST);
    let screen = dir.run("sweep rest.toml --vary active_fault -o out").exits(3);
    screen.says(&[
        "fault              stays near",
        "none               -",
        "push               ✓ 30 %",
        "weakest     shove and silence: stays near",
    ]);
    let json = dir.run("sweep rest.toml --vary active_fault --json").exits(3).prints(&[]);
    let answer = json.lines().last().expect("an answer");
    let answer: serde_json::Value = serde_json::from_str(answer).expect("JSON");
    let shove = &answer["answer"]["by_fault"][2];
    assert_eq!(shove["fault"], "shove and silence");
    assert_eq!(shove["requirements"][0]["decision"], "missed");
    let margin = shove["requirements"][0]["margin"].as_f64().expect("a margin");
    assert!((margin + 1.1).abs() < 1e-12, "{margin}");
    // The saved run is the same again.
    dir.run("simulate out/least-robust.toml --log none").exits(3).says(&["60.2 deg", "2.10 × limit"]);
    dir.run("sweep rest.toml --vary active_fault=push,none").exits(0).says(&["2 runs"]);
    dir.run("sweep rest.toml --vary active_fault=pull").exits(2).says(&["`push`", "got `pull`"]);
}

#[test]
fn which_fault_occurs_and_how_is_drawn() {
    let dir = Dir::new();
    let drawn = "[uncertain]\nactive_fault = { choice = [\"push\", \"none\"] }
                 \"fault[0].actuator.faults[0].added.constant\" = { uniform = [10.0, 20.0] }\n";
    dir.write("drawn.toml", format!("{REST}{drawn}"));
    // Pushes of up to 20 N m turn it by at most 0.2 rad/s, but 0.7 rad in 4 s: the limit is at 14.3 N m.
    let ran = dir.run("simulate drawn.toml --runs 40 --json").exits(3).prints(&[]);
    assert_eq!(ran, dir.run("simulate drawn.toml --runs 40 --json --jobs 3").exits(3).prints(&[]));
    let rows: Vec<serde_json::Value> =
        ran.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let (mut none, mut missed) = (0, 0);
    for row in &rows[..40] {
        let met = row["requirements"][0]["verdict"].as_str().expect("a verdict");
        let push = row["drawn"]["fault[0].actuator.faults[0].added.constant"].as_f64().expect("a number");
        let expected = match row["drawn"]["active_fault"].as_str() {
            Some("none") => "not exercised",
            _ if 0.035 * push < 0.5 => "met",
            _ => "missed",
        };
        assert_eq!(met, expected, "{row}");
        none += usize::from(expected == "not exercised");
        missed += usize::from(expected == "missed");
    }
    assert!(none > 10 && missed > 5, "{none} {missed}");
    let faults = &rows[40]["answer"]["by_fault"];
    assert_eq!(faults[0]["runs"], none);
    assert_eq!(faults[1]["requirements"][0]["runs_met"], 40 - none - missed);
    // The worst case keeps the fault that is written.
    let push = dir.run("worst drawn.toml --set active_fault=push --points 20 --json").exits(3).json();
    let worst = push["cases"][0]["worst"].as_f64().expect("a number");
    assert!((worst - 0.7).abs() < 1e-12, "{worst}");
}

#[test]
fn what_does_not_fit_is_refused_at_its_place() {
    for (old, new, expected, key) in [
        ("name = \"push\"", "name = \"none\"", "must be a name of its own", "fault[0].name"),
        // A comma separates the values of `--vary`.
        ("name = \"push\"", "name = \"push, pull\"", "without brackets and commas", "fault[0].name"),
        (
            "part = \"sampled\"",
            "part = \"gyro\"",
            "must name one of the parts, `sampled`",
            "fault[1].sensor.part",
        ),
        (
            "from = \"5 s\" }",
            "from = \"5 s\", to = \"4 s\" }",
            "must have `from` before `to`",
            "fault[1].sensor.faults[0]",
        ),
        (
            "constant = 10.0",
            "constant = 10.0, wheel = 2",
            "applies only to `[actuator.wheels]`",
            "fault[0].actuator.faults[0].added.wheel",
        ),
        ("fault(push) or", "fault(pull) or", "must name one of the faults, `push`", "requirement[0].holds"),
        (
            "name = \"rest\"",
            "active_fault = \"pull\"",
            "must be `none` or the name of a `[[fault]]`",
            "active_fault",
        ),
        (
            "duration = 12.0",
            "duration = 12.0\nuncertain.active_fault = { choice = [\"push\", 2] }",
            "has a text among its values",
            "uncertain",
        ),
        (
            "period = 1.0",
            "period = 1.0\n[uncertain]\n\"body.planar.inertia\" = { choice = [\"big\"] }",
            "holds a float",
            "uncertain",
        ),
    ] {
        let text = REST.replacen(old, new, 1);
        assert_ne!(text, REST, "{old}");
        let error = Scenario::parse("rest.toml", &text).expect_err(new).to_string();
        assert!(error.contains(expected) && error.contains(key), "{new}: {error}");
    }
    let silent =
        REST.replace("[sensor.sampled]\nperiod = 1.0\n", "").replace("\"sampled\"", "\"continuous\"");
    let silent = format!("active_fault = \"shove and silence\"\nsensor = \"continuous\"\n{silent}");
    let error = Scenario::parse("rest.toml", &silent).expect_err("no faults");
    assert!(error.to_string().contains("has no `faults`"), "{error}");
}
