//! Wrong keys and values: each gets the right suggestion, or a reason why there is none; all of a file come in one go.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use crate::bad_scenarios::GOOD;
use crate::frozen::is_frozen;
use crate::util::{Dir, FLEXSC, SCENARIOS};

/// Mistakes: text that is replaced, and its replacement. The snapshot `typos` has the suggestion or the
/// reason of each.
#[rustfmt::skip] // One case a line.
const TYPOS: &[(&str, &str)] = &[
    ("k_t = 0.31", "kt = 0.31"),
    ("k_t = 0.31", "K_T = 0.31"),
    ("dead_zone", "deadzone"),
    ("dead_zone", "deadband"),
    ("dead_zone", "dead-zone"),
    ("hysteresis", "hysterisis"),
    ("strong", "stong"),
    ("weak", "week"),
    ("duration", "durations"),
    ("duration", "Duration"),
    ("duration", "t_end"),
    ("duration", "stop_time"),
    ("[law.relay]", "[law.rely]"),
    ("[law.relay]", "[law.bang_bang]"),
    ("[law.relay]", "[law.pid]"),
    ("[law.relay]", "[law.lqg]"),
    ("[law.relay]", "[law.mpc]"),
    ("[law.relay]", "[law.sliding_mode]"),
    ("[law.relay]", "[laws.relay]"),
    ("[law.relay]", "[controller.relay]"),
    ("[estimator.envelope]", "[estimator.ekf]"),
    ("[estimator.envelope]", "[estimator.ukf]"),
    ("[estimator.envelope]", "[estimator.envelop]"),
    ("[estimator.envelope]", "[estimator.mekf]"),
    ("[estimator.envelope]", "[observer.envelope]"),
    ("[sensor.sampled]", "[sensor.sample]"),
    ("[sensor.sampled]", "[sensor.imu]"),
    ("[sensor.sampled]", "[sensor.star_sensor]"),
    ("[sensor.sampled]", "[sensor.lidar]"),
    ("[sensor.sampled]", "[sensors.sampled]"),
    ("[sensor.sampled]", "[actuator.reaction_wheels]\n[sensor.sampled]"),
    ("[sensor.sampled]", "[actuator.cmg]\n[sensor.sampled]"),
    ("[sensor.sampled]", "[actuator.thruster]\n[sensor.sampled]"),
    ("period = 0.1\n\n[log]", "sample_time = 0.1\n\n[log]"),
    ("frequency", "omega"),
    ("frequency", "freq"),
    ("gain = 0.0213", "zeta = 0.01\ngain = 0.0213"),
    ("displacement", "displacment"),
    ("[reference]", "[refrence]"),
    ("[uncertain]", "[uncertainty]"),
    ("uniform =", "unifrm ="),
    ("window = 50.0", "windw = 50.0"),
    ("window = 50.0", "window = 50.0\nform = \"dynamics\""),
    ("random_search", "randomsearch"),
];

#[test]
fn each_typo_gets_its_suggestion() {
    let dir = Dir::new();
    let mut text = String::new();
    for (from, to) in TYPOS {
        assert!(GOOD.contains(from), "{from}");
        dir.write("typo.toml", GOOD.replacen(from, to, 1));
        let ran = dir.run("check typo.toml").exits(2);
        assert!(ran.err.contains("did you mean") || ran.err.contains("there is no"), "{to}: {}", ran.err);
        writeln!(text, "### {from:?} -> {to:?}\n{}", ran.err).expect("memory");
    }
    // All mistakes of a file come at once.
    let bad =
        GOOD.replace("k_t =", "kt =").replace("weak = 1e-6", "weak = \"x\"").replace("[sensor.", "[sensors.");
    dir.write("bad.toml", bad);
    writeln!(text, "### three mistakes\n{}", dir.run("check bad.toml").exits(2).err).expect("memory");
    is_frozen("typos", &text);
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
fn keys_verbs_signs_and_topics_are_those_that_are_meant() {
    let dir = Dir::with(&["earth-observer", "relay-fixed"]);
    for (command, words) in [
        (
            "simulate earth-observer.toml --log none --set wheels.torque=1",
            "there is no key `wheels.torque`; did you mean `actuator.wheels.torque`?",
        ),
        (
            "simulate earth-observer.toml --log none --set star_tracker.noise=1e-5",
            "did you mean `sensor[1].star_tracker.noise`?",
        ),
        ("tune earth-observer.toml --vary law.attitude.bandwith=0.1:0.4", "did you mean `bandwidth`?"),
        ("tune earth-observer.toml --vary wheels.torque=0.1:0.4", "did you mean `actuator.wheels.torque`?"),
        ("run earth-observer.toml", "a similar subcommand exists: 'simulate'"),
        ("validate earth-observer.toml", "a similar subcommand exists: 'check'"),
        ("bode earth-observer.toml", "a similar subcommand exists: 'margins'"),
    ] {
        dir.run(command).exits(2).says(&[words]);
    }
    let text = dir.text("earth-observer.toml").replacen("bandwidth = 0.1 ", "bandwidth = '18\"' ", 1);
    dir.write("signs.toml", text);
    dir.run("check signs.toml").exits(2).says(&["has the unit `\"`", "did you mean `arcsec`?"]);
    dir.run("simulate relay-fixed.toml --set duration=50 -o run.mcap").exits(0);
    let topic = |name: &str| dir.run(&format!("export run.mcap --topic {name}")).exits(0).printed();
    assert_eq!(topic("command"), topic("/command"));
    dir.run("export run.mcap --topic comand").exits(2);
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
    let quiet = dir.run("check earth-observer.toml").exits(0).err;
    assert_eq!(
        quiet.matches("remark").count(),
        quiet.matches("remark: `law.attitude.period`").count(),
        "{quiet}"
    );
    dir.write("d.toml", text.replacen("damping = 0.005", "damping = 5", 1));
    dir.run("check d.toml").exits(0).says(&["remark: `appendage[0].modes[0].damping`", "\"5 %\""]);
    let json = dir.run("check d.toml --json").printed();
    assert!(json.contains("\"key\":\"appendage[0].modes[0].damping\""), "{json}");
    let remark = "note: `appendage[0].modes[0].damping`";
    for command in
        ["simulate d.toml --log none --set duration=1", "sweep d.toml --set duration=1 --vary seed=1,2"]
    {
        dir.run(command).exits(0).says(&[remark, "\"5 %\""]);
    }
    let quiet = dir.run("simulate earth-observer.toml --log none --set duration=1").exits(0);
    assert!(!quiet.err.contains("note:"), "{}", quiet.err);
    assert!(text.contains("latency = "), "{text}");
    let late =
        text.split("latency = ").nth(1).and_then(|rest| rest.split([',', ' ']).next()).unwrap_or_default();
    dir.write("l.toml", text.replacen(&format!("latency = {late}"), "latency = 3.3", 1));
    dir.run("check l.toml").exits(0).says(&["remark: `sensor", "latency` is longer than the period"]);
    let known = "[uncertain]\n\"spacecraft.inertia[0][0]\" = { relative_normal = 0.1 }\n";
    dir.write("i.toml", format!("{text}\n{known}"));
    dir.run("check i.toml").exits(0).says(&["remark: `uncertain", "the law knows that of each run"]);
    // An inertia that one entry makes unsymmetric.
    let alone = "[uncertain]\n\"spacecraft.inertia[0][1]\" = { uniform = [-1.0, 1.0] }\n";
    dir.write("u.toml", format!("{text}\n{alone}"));
    let told = [
        "remark: `uncertain`",
        "16 of the first 16 runs of a campaign are not accepted; run 0: ",
        "symmetric",
    ];
    dir.run("check u.toml").exits(0).says(&told);
}
