//! Losses of a target while an actuator is at a limit: warnings, journal and metrics, against the exact errors of a body that
//! cannot follow its reference.

use serde_json::Value as Json;

use crate::util::Dir;

/// A rigid body whose wheels store 0.3 N m s each: about yaw, of 60 kg m², they turn it by 5 mrad/s at most.
const BODY: &str = "[spacecraft]\nmass = 100.0\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\n\
                    points = [{ name = \"bus\" }]\n\
                    [[sensor]]\ngyro = { period = 0.25 }\n";
const WHEELS: &str =
    "[actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.02\ntorque = 0.2\nmomentum = 0.3\n";
const LAW: &str = "law.attitude = { period = 0.25, bandwidth = 0.3 }\n";

/// A turn by 1 rad that needs 10 mrad/s: the reference has 5 mrad/s after 5 s, and again 5 s before its end after 110 s. Its lead is
/// largest there: (10 - 5) mrad/s for 90 s, and twice half of 1 mrad/s² for 5 s.
const LEAD: f64 = 5e-3 * 90.0 + 1e-3 * 25.0;

fn turn(from: f64) -> String {
    format!("[[target]]\nfrom = {from}\nyaw = 1.0\nacceleration = 1e-3\nrate_limit = 1e-2\n")
}

/// Two modes: `turn` is too fast for the wheels, `back` is not.
const MODES: &str = "[[mode]]\nname = \"back\"\nlaw.attitude = { period = 0.25, bandwidth = 0.3 }\n\
    target = { yaw = 0.0, acceleration = 1e-3, rate_limit = 4e-3 }\nleave = [{ to = \"turn\", when = \"time > 300\" }]\n\
    [[mode]]\nname = \"turn\"\nlaw.attitude = { period = 0.25, bandwidth = 0.3 }\n\
    target = { yaw = 1.0, acceleration = 1e-3, rate_limit = 1e-2 }\nleave = [{ to = \"back\", when = \"time > 300\" }]\n";

fn numbers(metrics: &Json, name: &str) -> Vec<f64> {
    let list = metrics[name].as_array().unwrap_or_else(|| panic!("{name}: {metrics}"));
    list.iter().map(|number| number.as_f64().unwrap_or(f64::NAN)).collect()
}

#[track_caller]
fn is_near(value: f64, exact: f64, tolerance: f64) {
    assert!((value - exact).abs() <= tolerance, "{value}, and not {exact}");
}

fn object(dir: &Dir) -> Json {
    dir.run("simulate a.toml --log none --json").exits(0).json()
}

#[test]
fn a_target_that_a_full_wheel_loses_is_a_warning() {
    let dir = Dir::holding("a.toml", format!("duration = 500.0\n{LAW}{BODY}{WHEELS}{}", turn(100.0)));
    let said = dir.run("simulate a.toml").exits(0).err;
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, line) =
        said.split_once("! the target is lost, error up to 27.2").unwrap_or_else(|| panic!("{said}"));
    assert!(
        line.contains("wheel 3 at its momentum limit for ") && line.contains(" s, first at 105 s"),
        "{line}"
    );
    let object = object(&dir);
    let metrics = &object["metrics"];
    assert_eq!(metrics["target_losses"], 1);
    assert_eq!(metrics["target_loss_limits"][0], "wheel 3 at its momentum limit");
    is_near(numbers(metrics, "target_loss_starts_s")[0], 105.0, 0.5);
    is_near(numbers(metrics, "target_loss_errors_rad")[0], LEAD, 2e-3);
    assert!(numbers(metrics, "target_loss_errors_before_rad")[0] < 1e-3);
    // The wheel is full until the body stops, which the law begins before the body has arrived.
    let time = numbers(metrics, "target_loss_times_s")[0];
    assert!(time > 105.0 && time < 105.0 + 95.0, "{time}");
    is_near(numbers(metrics, "wheel_momentum_limit_starts_s")[0], 105.0, 0.5);
    is_near(numbers(metrics, "wheel_momentum_limit_times_s")[0], time, 1e-9);
    let share = metrics["wheel_momentum_limit_share"].as_f64().expect("a share");
    is_near(share, time / 500.0, 1e-3);
    let warning = &object["answer"]["warnings"][0];
    assert_eq!((&warning["kind"], &object["warnings"][0]), (&"target_lost".into(), &warning["text"]));
    assert!(warning["text"].as_str().is_some_and(|text| said.contains(text)), "{warning}");
    assert_eq!(object["answer"]["events"][0]["part"], "wheel 3 at its momentum limit");
    dir.run("export a.mcap --topic /log")
        .exits(0)
        .prints(&["the target is lost: wheel 3 at its momentum limit"]);
}

#[test]
fn visits_of_a_mode_are_one_warning() {
    let dir = Dir::holding("a.toml", format!("duration = 1300.0\n{MODES}{BODY}{WHEELS}"));
    let object = object(&dir);
    let warnings = object["warnings"].as_array().expect("warnings");
    let text = warnings[0].as_str().expect("a text");
    let head = "turn: target lost in 2 of 2 visits, error up to ";
    assert!(text.starts_with(head) && text.contains(" s, first at 305 s"), "{text}");
    assert_eq!(
        warnings.iter().filter(|text| text.as_str().is_some_and(|text| text.contains("lost"))).count(),
        1
    );
    let metrics = &object["metrics"];
    assert_eq!(
        (&metrics["target_losses"], &metrics["target_loss_modes"]),
        (&2.into(), &serde_json::json!([1.0, 1.0]))
    );
    assert_eq!(numbers(metrics, "mode_visits"), [3.0, 2.0]);
    for error in numbers(metrics, "target_loss_errors_rad") {
        is_near(error, LEAD, 2e-3);
    }
    let starts = numbers(metrics, "wheel_momentum_limit_starts_s");
    assert!(starts[0].is_nan(), "{starts:?}");
    is_near(starts[1], 305.0, 1.0);
    let times = numbers(metrics, "wheel_momentum_limit_times_s");
    is_near(times[0], 0.0, 0.0);
    is_near(times[1], numbers(metrics, "target_loss_times_s").iter().sum(), 1e-6);
    dir.run("simulate a.toml").exits(0);
    let journal = dir.run("export a.mcap --topic /log").exits(0).out;
    assert_eq!(journal.matches("the target is lost in mode turn").count(), 2, "{journal}");
    // Each run of a campaign has them.
    let rows = dir.run("simulate a.toml --runs 2 --json").exits(0).out;
    assert_eq!(rows.matches(head).count(), 3, "two runs and the answer: {rows}");
    dir.run("simulate a.toml --runs 2 --table csv -o b").exits(0).says(&["target_losses"]);
    let table = dir.text("b/runs.csv");
    assert!(table.contains("wheel 3 at its momentum limit; wheel 3 at its momentum limit"), "{table}");
}

/// A campaign says which runs lose a target, what the worst one says of it, and how each mode fares.
#[test]
fn a_campaign_has_the_losses_and_the_modes_of_its_runs() {
    let drawn = "[uncertain]\n\"actuator.wheels.momentum\" = { uniform = [0.28, 0.34] }\n";
    let dir = Dir::holding("a.toml", format!("duration = 1300.0\n{MODES}{BODY}{WHEELS}{drawn}"));
    let lines = dir.run("simulate a.toml --runs 6 --json").exits(0).out;
    let mut runs: Vec<Json> =
        lines.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    let answer = runs.pop().expect("an answer")["answer"].clone();
    let errors: Vec<f64> =
        runs.iter().map(|run| numbers(&run["metrics"], "target_loss_errors_rad")[0]).collect();
    let largest = errors.iter().copied().fold(0.0, f64::max);
    let worst = errors.iter().position(|error| *error == largest).expect("a run");
    let own = &answer["warnings"][0];
    assert_eq!((&own["kind"], &own["mode"]), (&"target_lost".into(), &"turn".into()));
    assert_eq!((own["runs"].as_u64(), own["worst_run"].as_u64()), (Some(6), Some(worst as u64)));
    let said = runs[worst]["warnings"][0].as_str().expect("a text");
    assert_eq!(own["text"], format!("6 of 6 runs, worst run {worst}: {said}"));
    let times = |name: &str| -> Vec<f64> {
        let mut all: Vec<f64> = runs.iter().map(|run| numbers(&run["metrics"], name)[1]).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let turn = &answer["by_mode"][1];
    let [limits, stays] = ["wheel_momentum_limit_times_s", "mode_times_s"].map(times);
    assert_eq!((&turn["runs"], &turn["runs_lost"]), (&6.into(), &6.into()));
    assert_eq!(turn["at_limit_s"]["largest"].as_f64(), Some(limits[5]));
    is_near(
        turn["at_limit_s"]["median"].as_f64().expect("a time"),
        f64::midpoint(limits[2], limits[3]),
        1e-9,
    );
    is_near(turn["time_s"]["median"].as_f64().expect("a time"), f64::midpoint(stays[2], stays[3]), 1e-9);
    dir.run("simulate a.toml --runs 6 --all").exits(0).says(&["! 6 of 6 runs, worst run", "target lost\n"]);
}

/// A 6U CubeSat in its first ground pass, whose turn takes more momentum than wheel 3 stores. The figures are those that a separate
/// program found in the rows of a log of every cycle: 254 rows of 0.5 s from 12 618.5 s on, up to 9.2808 deg, after 0.051 deg in 30 s.
#[test]
fn a_ground_pass_that_a_wheel_loses_is_said() {
    let text = include_str!("golden/cube6u.toml").replace("30000 s", "12800 s");
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("imbalance")).collect();
    let balanced = lines.join("\n");
    let dir = Dir::holding("a.toml", balanced);
    let said = dir.run("simulate a.toml --log none").err.split_whitespace().collect::<Vec<_>>().join(" ");
    let warning = "! pass: target lost in 1 of 1 visits, error up to 9.28 deg, before it 0.0361; \
                   wheel 3 at its speed limit for 127 s, first at 12 618 s";
    assert!(said.contains(warning), "{said}");
    assert!(
        said.contains("MISSED: 1 of 2 requirements") && said.matches("target lost").count() == 1,
        "{said}"
    );
    assert!(!said.contains("goal"), "{said}");
}

/// Jets of 0.03 N m give 0.5 mrad/s², half of what the slew needs: the reference leads by half of the rest times the square of the
/// time, 0.25 mrad/s² for 10 s squared, and on by the rate until the jets have caught up with it.
#[test]
fn jets_that_are_too_weak_lose_the_target() {
    let pair = |axis: &str, offset: &str, [plus, minus]: [&str; 2]| {
        [("+", plus), ("-", minus)].map(|(sign, direction)| {
            format!(
                "{{ name = \"{axis}{sign}\", point = \"bus\", offset = {offset}, direction = {direction}, thrust = 0.03 }},\n"
            )
        })
    };
    let pairs = [
        pair("roll", "[0, 1, 0]", ["[0, 0, 1]", "[0, 0, -1]"]),
        pair("pitch", "[0, 0, 1]", ["[1, 0, 0]", "[-1, 0, 0]"]),
        pair("yaw", "[1, 0, 0]", ["[0, 1, 0]", "[0, -1, 0]"]),
    ];
    let groups = ["roll", "pitch", "yaw"]
        .map(|axis| format!("groups.{axis} = {{ plus = [\"{axis}+\"], minus = [\"{axis}-\"] }}\n"));
    let (pairs, groups) = (pairs.concat().concat(), groups.concat());
    let thrusters = format!("[actuator.jets]\nspecific_impulse = 200.0\nthrusters = [\n{pairs}]\n{groups}");
    let text = format!(
        "duration = 400.0\nlaw.attitude = {{ period = 0.25, bandwidth = 0.3 }}\n{BODY}{thrusters}{}",
        turn(100.0)
    );
    let dir = Dir::holding("a.toml", text);
    let object = object(&dir);
    let metrics = &object["metrics"];
    assert_eq!(metrics["target_loss_limits"][0], "jets about yaw on all the time", "{object}");
    is_near(numbers(metrics, "jet_limit_starts_s")[0], 100.0, 0.5);
    // At 120 s the body has the rate of the reference, 10 mrad/s.
    is_near(numbers(metrics, "target_loss_errors_rad")[0], 0.5 * 5e-4 * 100.0 + 0.5 * 5e-4 * 100.0, 3e-3);
}

/// A step of the target, or a start far from it, saturates wheels as well, and the error falls meanwhile; so does noise.
#[test]
fn acquisition_loses_no_target() {
    let step = "[[target]]\nfrom = 100.0\nyaw = 1.0\n";
    let wheels = WHEELS.replace("momentum = 0.3", "momentum = 30");
    let weak = wheels.replace("torque = 0.2", "torque = 0.02");
    let noisy = BODY.replace("{ period = 0.25 }", "{ period = 0.25, angle_random_walk = 3e-3 }");
    for (text, limited) in [
        (format!("duration = 500.0\n{LAW}{BODY}{weak}{step}"), true),
        (format!("duration = 500.0\n{LAW}{noisy}{weak}"), true),
        (format!("duration = 500.0\n{LAW}{BODY}{wheels}{}", turn(100.0)), false),
    ] {
        let dir = Dir::holding("a.toml", &text);
        let object = object(&dir);
        let metrics = &object["metrics"];
        assert_eq!(metrics["target_losses"], 0, "{text}\n{object}");
        assert_eq!(numbers(metrics, "wheel_torque_limit_times_s")[0] > 0.0, limited, "{object}");
    }
}
