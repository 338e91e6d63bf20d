//! Actuators that change with the stage of the law: each stage moves the body as its actuators alone would.

use flexsc_core::Scenario;
use flexsc_core::metrics::MetricValue;
use flexsc_core::record::Detail;

use crate::study::pairs;
use crate::traces::{self, traced};
use crate::util::SCENARIOS;

const PULSES: &str = "thrusters = { torque = 0.5, period = 0.5 }";
const HELD: &str = "hold = { period = 0.25 }";

fn scenario(text: &str) -> Scenario {
    Scenario::parse("stages.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    match Scenario::parse("stages.toml", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

/// A rigid body with one angle, from this angle and rate on, with these root keys.
fn body([angle, rate]: [f64; 2], duration: f64, keys: &str) -> String {
    format!(
        "duration = {duration:?}\n{keys}\n[body.planar]\ninertia = 100.0\nangle = {angle:e}\nrate = {rate:e}\n\
         [log]\nperiod = 0.5\n"
    )
}

/// Returns the angle (rad) and the rate (rad/s) every 0.5 s; a full log also has rows where pulses begin and end.
fn angles(text: &str) -> [Vec<f64>; 2] {
    let trace = traced(&scenario(text));
    [("/attitude", "angle_rad"), ("/rate", "rate_rad_s")].map(|(topic, name)| {
        let rows = pairs(traces::times(&trace, topic), traces::column(&trace, topic, name));
        let mut sampled: Vec<(f64, f64)> = rows.map(|(time, value)| (time, *value)).collect();
        sampled.retain(|(time, _)| (time / 0.5).fract() == 0.0);
        sampled.dedup_by_key(|(time, _)| *time);
        sampled.into_iter().map(|(_, value)| value).collect()
    })
}

#[test]
fn each_stage_moves_the_body_as_its_actuators_alone() {
    let law = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.5 }";
    let staged = format!(
        "{}[[law.stages]]\n{law}\nactuators = [\"thrusters\"]\n\
         [[law.stages]]\nfrom = 10.0\n{law}\nactuators = [\"hold\"]\n[[actuator]]\n{PULSES}\n[[actuator]]\n{HELD}\n",
        body([2e-3, 1e-4], 30.0, "")
    );
    let alone = |start, duration, actuator: &str| {
        angles(&body(start, duration, &format!("{law}\nactuator.{actuator}")))
    };
    let found = angles(&staged);
    let first = alone([2e-3, 1e-4], 10.0, PULSES);
    let off =
        |found: &[f64], alone: &[f64]| pairs(found, alone).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    for (found, alone) in pairs(&found, &first) {
        let off = off(&found[..20], &alone[..20]);
        assert!(off < 1e-18, "the first stage, before the second begins: {off:e}");
    }
    let second = alone([first[0][20], first[1][20]], 20.0, HELD);
    for (found, alone) in pairs(&found, &second) {
        let off = off(&found[20..], alone);
        assert!(off < 1e-17, "{off:e}");
    }
    // Without `actuators` both act, each with its share, throughout.
    let both = staged.replace("\nactuators = [\"thrusters\"]", "").replace("\nactuators = [\"hold\"]", "");
    let why = refused(&both);
    assert!(why.contains("must sum to 1"), "{why}");
}

/// The shipped scenario does what its comment says; its wheels rest in the burn, and each stage plans with its actuators.
#[test]
fn wheels_hold_the_quiet_phases_and_thrusters_the_burn() {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/orbit-correction.toml")).expect("a file");
    let shipped = scenario(&text);
    let (metrics, trace) = traces::flown(&shipped, 0, Detail::Full);
    assert_eq!(metrics.get("requirement"), Some(&MetricValue::Word("met")));
    assert!(metrics.number("time_outside_s") == Some(0.0));
    let impulse = metrics.number("burn_impulse_n_s").expect("a burn");
    assert!((impulse / 3600.0 - 1.0).abs() < 1e-3, "{impulse}");
    let momenta = traces::within(&trace, "/wheels", "wheels", "momentum_nm_s");
    let times = traces::times(&trace, "/wheels");
    let at = |time: f64| {
        let row = times.iter().position(|t| *t >= time).expect("a row");
        momenta[4 * row..4 * row + 4].to_vec()
    };
    assert_eq!(at(301.0), at(449.0));
    assert_ne!(at(1.0), at(299.0));
    assert_ne!(at(451.0), at(890.0));
    // The torque of the pyramid about x and y is 2 sqrt(2) cos(cant), and about z 4 sin(cant), times that of a wheel.
    let cant = 0.615_479_708_670_387_3_f64;
    let wheels = [2.0 * 2f64.sqrt() * cant.cos(), 2.0 * 2f64.sqrt() * cant.cos(), 4.0 * cant.sin()];
    for (axis, most) in wheels.into_iter().enumerate() {
        let stages = &shipped.study.stage_authorities[axis];
        let inertia = shipped.study.axes[axis].inertia.get();
        let found = stages[0].accelerations[0] * inertia;
        assert!((found / (0.2 * most) - 1.0).abs() < 1e-12, "{axis}: {found} {}", 0.2 * most);
        assert_eq!(stages[0], stages[2]);
        assert!(stages[1].accelerations[0] > 2.0 * stages[0].accelerations[0]);
    }
    let lost = text.replacen("actuators = [\"jets\"]", "actuators = [\"wheels\"]", 1);
    let (metrics, _) = traces::flown(&scenario(&lost), 0, Detail::Full);
    assert_eq!(metrics.get("requirement"), Some(&MetricValue::Word("missed")));
}

#[test]
fn selections_that_do_not_fit_are_refused() {
    let pd = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.5 }";
    let with = |first: &str, rest: &str| {
        format!(
            "{}[[law.stages]]\n{first}\n[[law.stages]]\nfrom = 5.0\n{pd}\nactuators = [\"hold\"]\n\
             [[actuator]]\n{PULSES}\n[[actuator]]\n{HELD}\n{rest}",
            body([0.0, 0.0], 10.0, "")
        )
    };
    let cases = [
        (
            with(&format!("{pd}\nactuators = [\"wheels\"]"), ""),
            "law.stages[0].actuators[0]",
            "must be one of the actuators, `thrusters`, `hold`, got `wheels`",
        ),
        (
            with(&format!("{pd}\nactuators = [\"hold\", \"thrusters\"]"), ""),
            "law.stages[0].actuators",
            "must have shares that sum to 1, got 2",
        ),
        (
            with(&format!("{pd}\nactuators = []"), ""),
            "law.stages[0].actuators",
            "must have shares that sum to 1, got 0 (no actuator)",
        ),
        (with(pd, ""), "law.stages[0].actuators", "got 2"),
        (
            with(
                &format!("{pd}\nactuators = [\"hold\"]"),
                "[manoeuvre]\nangle = 0.1\ntime = 5.0\ncommand = { minimum_energy = {} }\n",
            ),
            "law.stages[0].actuators",
            "must be left out with a `[manoeuvre]`",
        ),
        (with(&format!("{pd}\nactuators = [\"rockets\"]"), ""), "law.stages[0].actuators[0]", "`rockets`"),
    ];
    for (text, key, why) in cases {
        let found = refused(&text);
        assert!(found.contains(key) && found.contains(why), "{key}: {why}\n{found}");
    }
    // A stage without control needs no actuator.
    scenario(&with("law.open = {}\nactuators = []", ""));
}
