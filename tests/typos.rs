//! Wrong keys and values: each gets the right suggestion, or a reason why there is none; all of a file come in one go.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::bad_scenarios::GOOD;
use crate::util::{Dir, FLEXSC, SCENARIOS};

/// Cases: text that is replaced, its replacement, and the suggestion or reason in the error.
#[rustfmt::skip] // One case a line.
const TYPOS: &[(&str, &str, &str)] = &[
    ("k_t = 0.31", "kt = 0.31", "did you mean `k_t`?"),
    ("k_t = 0.31", "K_T = 0.31", "did you mean `k_t`?"),
    ("dead_zone", "deadzone", "did you mean `dead_zone`?"),
    ("dead_zone", "deadband", "did you mean `dead_zone`?"),
    ("dead_zone", "dead-zone", "did you mean `dead_zone`?"),
    ("hysteresis", "hysterisis", "did you mean `hysteresis`?"),
    ("strong", "stong", "did you mean `strong`?"),
    ("weak", "week", "did you mean `weak`?"),
    ("duration", "durations", "did you mean `duration`?"),
    ("duration", "Duration", "did you mean `duration`?"),
    ("duration", "t_end", "did you mean `duration`?"),
    ("duration", "stop_time", "did you mean `duration`?"),
    ("[law.relay]", "[law.rely]", "did you mean `relay`?"),
    ("[law.relay]", "[law.bang_bang]", "did you mean `relay`?"),
    ("[law.relay]", "[law.pid]", "did you mean `attitude`?"),
    ("[law.relay]", "[law.lqg]", "did you mean `state_space`?"),
    ("[law.relay]", "[law.mpc]", "there is no predictive control"),
    ("[law.relay]", "[law.sliding_mode]", "there is no sliding mode"),
    ("[law.relay]", "[laws.relay]", "did you mean `law`?"),
    ("[law.relay]", "[controller.relay]", "did you mean `law`?"),
    ("[estimator.envelope]", "[estimator.ekf]", "did you mean `extended_kalman`?"),
    ("[estimator.envelope]", "[estimator.ukf]", "did you mean `unscented_kalman`?"),
    ("[estimator.envelope]", "[estimator.envelop]", "did you mean `envelope`?"),
    ("[estimator.envelope]", "[estimator.mekf]", "did you mean `attitude`?"),
    ("[estimator.envelope]", "[observer.envelope]", "did you mean `estimator`?"),
    ("[sensor.sampled]", "[sensor.sample]", "did you mean `sampled`?"),
    ("[sensor.sampled]", "[sensor.imu]", "did you mean `gyro`?"),
    ("[sensor.sampled]", "[sensor.star_sensor]", "did you mean `star_tracker`?"),
    ("[sensor.sampled]", "[sensor.lidar]", "there is no lidar"),
    ("[sensor.sampled]", "[sensors.sampled]", "did you mean `sensor`?"),
    ("[sensor.sampled]", "[actuator.reaction_wheels]\n[sensor.sampled]", "did you mean `wheels`?"),
    ("[sensor.sampled]", "[actuator.cmg]\n[sensor.sampled]", "did you mean `control_moment_gyros`?"),
    ("[sensor.sampled]", "[actuator.thruster]\n[sensor.sampled]", "did you mean `thrusters`?"),
    ("period = 0.1\n\n[log]", "sample_time = 0.1\n\n[log]", "did you mean `period`?"),
    ("frequency", "omega", "did you mean `frequency`?"),
    ("frequency", "freq", "did you mean `frequency`?"),
    ("gain = 0.0213", "zeta = 0.01\ngain = 0.0213", "did you mean `damping`?"),
    ("displacement", "displacment", "did you mean `displacement`?"),
    ("[reference]", "[refrence]", "did you mean `reference`?"),
    ("[uncertain]", "[uncertainty]", "did you mean `uncertain`?"),
    ("uniform =", "unifrm =", "did you mean `uniform`?"),
    ("window = 50.0", "windw = 50.0", "did you mean `window`?"),
    ("window = 50.0", "window = 50.0\nform = \"dynamics\"", "did you mean `dynamic`?"),
    ("random_search", "randomsearch", "did you mean `random_search`?"),
];

#[test]
fn each_typo_gets_its_suggestion() {
    let dir = Dir::new();
    let mut wrong = Vec::new();
    for (from, to, words) in TYPOS {
        assert!(GOOD.contains(from), "{from}");
        dir.write("typo.toml", GOOD.replacen(from, to, 1));
        let ran = dir.run("check typo.toml").exits(2);
        if !ran.err.contains(words) {
            wrong.push(format!("\n--- {from} -> {to}: no `{words}` in\n{}", ran.err));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

#[test]
fn all_mistakes_come_at_once() {
    let dir = Dir::new();
    let bad =
        GOOD.replace("k_t =", "kt =").replace("weak = 1e-6", "weak = \"x\"").replace("[sensor.", "[sensors.");
    dir.write("bad.toml", bad);
    dir.run("check bad.toml").exits(2).says(&[
        "bad.toml:16:1:",
        "did you mean `k_t`?",
        "bad.toml:15:8:",
        "found string \"x\"",
        "bad.toml:25:2:",
        "did you mean `sensor`?",
    ]);
}

/// Replacements in a good scenario: a text, the text in its place, and a part of the one error message.
#[rustfmt::skip] // One case a line.
const ALONE: &[(&str, &str, &str)] = &[
    ("[law.relay]", "[law.lqr]", "did you mean `state_space`?"),
    ("k_t = 0.31", "k_t = 0.31 // braking gain", "found `//`; a comment begins with `#`"),
    ("body.planar.modes[0].frequency\" = { uniform = [0.4, 0.5] }", "body.planar.modes[0].frequency\" = { uniform = [0.4 0.5] }", "a comma is missing"),
];

#[test]
fn one_mistake_is_one_error() {
    let dir = Dir::new();
    for (from, to, words) in ALONE {
        if !GOOD.contains(from) {
            continue;
        }
        dir.write("alone.toml", GOOD.replacen(from, to, 1));
        let ran = dir.run("check alone.toml").exits(2);
        assert!(ran.err.contains(words) && ran.err.matches("alone.toml:").count() == 1, "{to}: {}", ran.err);
    }
}

#[test]
fn a_table_that_is_set_under_a_wrong_name_gets_its_whole_path() {
    let dir = Dir::with(&["earth-observer"]);
    let ran = dir.run("simulate earth-observer.toml --log none --set law.atitude.bandwidth=0.3").exits(2);
    assert!(ran.err.contains("did you mean `law.attitude.bandwidth`?"), "{}", ran.err);
}

#[test]
fn keys_and_forms_of_distributions_are_suggested() {
    let dir = Dir::with(&["earth-observer"]);
    let text = dir.text("earth-observer.toml");
    let wrong = |line: &str, words: &str| {
        dir.write("u.toml", format!("{text}\n[uncertain]\n{line}\n"));
        let ran = dir.run("check u.toml").exits(2);
        assert!(ran.err.contains(words), "{line}: {}", ran.err);
    };
    wrong(
        "\"spacecraft.inertia.xx\" = { relative_normal = 0.1 }",
        "did you mean `spacecraft.inertia[0][0]`?",
    );
    wrong(
        "\"law.attitude.bandwidth\" = { normal = [0.25, 0.01] }",
        "{ normal = { mean = 0.25, sd = 0.01 } }",
    );
    wrong("\"law.attitude.bandwidth\" = 0.25", "{ relative_normal = 0.1 }");
}

#[test]
fn american_spellings_are_accepted() {
    let dir = Dir::new();
    dir.run("examples rotation-sine").exits(0);
    let text = std::fs::read_to_string(dir.path("rotation-sine.toml")).expect("copied");
    dir.write("american.toml", text.replace("[manoeuvre", "[maneuver"));
    dir.run("check american.toml").exits(0);
    dir.run("simulate american.toml --log none --set maneuver.angle=1.0").exits(0);
    dir.write("american.toml", text.replace("[manoeuvre", "[maneuver").replace("angle = ", "angel = "));
    dir.run("check american.toml").exits(2).says(&["american.toml:", "did you mean `angle`?"]);
}

#[test]
fn examples_are_all_there_and_a_new_scenario_runs() {
    let dir = Dir::new();
    let shipped = std::fs::read_dir(SCENARIOS).expect("scenarios");
    let count = shipped
        .filter(|file| file.as_ref().is_ok_and(|f| f.path().extension().is_some_and(|e| e == "toml")))
        .count();
    let listed = dir.run("examples").exits(0);
    assert_eq!(listed.out.lines().count(), count);
    dir.run("new mine --like relay-fixed").exits(0);
    dir.run("simulate mine.toml --log none").exits(0);
    dir.run("new mine").exits(2).says(&["already exists", "--force"]);
    dir.run("new other --like relay-fixd").exits(2).says(&["did you mean `relay-fixed`?"]);
}

#[test]
fn a_scenario_is_read_from_stdin() {
    let dir = Dir::new();
    let flexsc = |text: &str| {
        let mut command = Command::new(FLEXSC);
        command.args(["simulate", "-", "--log", "none"]).current_dir(dir.path("."));
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut child = child.expect("starts");
        child.stdin.take().expect("piped").write_all(text.as_bytes()).expect("written");
        let output = child.wait_with_output().expect("ends");
        (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
    };
    let (code, told) = flexsc(GOOD);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.starts_with("stdin "), "{told}");
    let (code, told) = flexsc(&GOOD.replace("k_t", "kt"));
    assert_eq!(code, Some(2));
    assert!(told.contains("stdin:16:1: `law.relay`: unknown key `kt`"), "{told}");
}

#[test]
fn what_is_probably_a_mistake_is_remarked() {
    let dir = Dir::with(&["earth-observer"]);
    let text = dir.text("earth-observer.toml");
    assert!(!dir.run("check earth-observer.toml").exits(0).err.contains("remark"));
    dir.write("d.toml", text.replacen("damping = 0.005", "damping = 5", 1));
    dir.run("check d.toml").exits(0).says(&["remark: `appendage[0].modes[0].damping`", "\"5 %\""]);
    let json = dir.run("check d.toml --json").exits(0).out;
    assert!(json.contains("\"key\":\"appendage[0].modes[0].damping\""), "{json}");
    assert!(text.contains("latency = "), "{text}");
    let late =
        text.split("latency = ").nth(1).and_then(|rest| rest.split([',', ' ']).next()).unwrap_or_default();
    dir.write("l.toml", text.replacen(&format!("latency = {late}"), "latency = 3.3", 1));
    dir.run("check l.toml").exits(0).says(&["remark: `sensor", "latency` is longer than the period"]);
}
