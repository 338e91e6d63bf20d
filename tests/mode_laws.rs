//! Laws in modes of operation: each law in a mode is that law alone, on every body and with all other parts, and two laws in
//! turn keep the invariants of a run.

use flexsc_core::record::{Column, Trace};
use flexsc_core::{Scenario, ScenarioError};

use crate::combinations::{self, Body, Parts, is_accepted, readers};
use crate::kinds::{ACTUATORS, Kind, LAWS};
use crate::study::pairs;
use crate::traces::{self, column, traced};

/// Law that acts from given times of the run on, and not in a mode.
const SEQUENCE: &str = "stages";

fn scenario(text: &str) -> Scenario {
    Scenario::parse("modes.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    match Scenario::parse("modes.toml", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

/// Returns a combination with a law in a mode.
fn in_a_mode(body: &str, parts: Parts) -> Result<Scenario, ScenarioError> {
    combinations::scenario(body, parts, |law| format!("mode = [{{ name = \"a\", law = {{ {law} }} }}]"))
}

/// Returns a combination with two laws in turn, each of which acts for some time. An estimator is read if one of them reads it.
fn in_turn(body: &str, parts: Parts, second: Kind) -> Result<Scenario, ScenarioError> {
    let reader = if parts.law.0 == "open" { second } else { parts.law };
    combinations::scenario(body, Parts { law: reader, ..parts }, |_| {
        format!(
            "mode = [{{ name = \"a\", law = {{ {} }}, leave = [{{ to = \"b\", when = \"truth.time >= 1.3\" }}] }}, \
             {{ name = \"b\", law = {{ {} }}, leave = [{{ to = \"a\", when = \"truth.time >= 1.2\" }}] }}]",
            parts.law.2, second.2
        )
    })
}

/// Every row of every topic is, but of `/mode` and of `/log`, which names the mode, equal to the bit.
fn agree(alone: &Trace, moded: &Trace) -> Result<(), String> {
    let [alone, moded] = [alone, moded].map(|trace| {
        trace.clone().into_columns().filter(|(name, _)| !["log", "mode"].contains(&name.as_str()))
    });
    let [alone, moded] = [alone.collect::<Vec<_>>(), moded.collect::<Vec<_>>()];
    let names = |all: &[(String, _)]| all.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    if names(&alone) != names(&moded) {
        return Err(format!("{:?} {:?}", names(&alone), names(&moded)));
    }
    for ((name, one), (_, other)) in alone.iter().zip(&moded) {
        if format!("{one:?}") != format!("{other:?}") {
            return Err(format!("{name} differs"));
        }
    }
    Ok(())
}

/// Compares the laws of a body in a mode with those alone; returns how many are accepted and run, and the differences.
fn alone_and_in_a_mode(body: &Body) -> (usize, usize, Vec<String>) {
    let (mut accepted, mut run, mut wrong) = (0, 0, Vec::new());
    for law in LAWS.into_iter().filter(|law| law.0 != SEQUENCE) {
        for actuator in ACTUATORS {
            let mut first = true;
            for (estimator, sensor) in readers() {
                let parts = Parts { law, sensor, estimator, actuator };
                match (is_accepted(body, parts), in_a_mode(body.text, parts)) {
                    (true, Ok(moded)) => {
                        accepted += 1;
                        // A relay has rows of its own in place of those of torques.
                        if std::mem::take(&mut first) && law.0 != "relay" {
                            run += 1;
                            let alone = combinations::combined(body.text, parts).expect("accepted");
                            if let Err(why) = agree(&traced(&alone), &traced(&moded)) {
                                wrong.push(format!("{parts:?}: {why}"));
                            }
                        }
                    }
                    (false, Err(moded)) => {
                        let moded = moded.to_string();
                        if !moded.contains('`') {
                            wrong.push(format!("{parts:?}: {moded}"));
                        }
                    }
                    (true, Err(why)) => wrong.push(format!("{parts:?}: only alone: {why}")),
                    (false, Ok(_)) => wrong.push(format!("{parts:?}: only in a mode")),
                }
            }
        }
    }
    (accepted, run, wrong)
}

#[test]
fn a_law_in_a_mode_is_the_law_alone() {
    let all = combinations::on_all(|body| {
        let (accepted, run, wrong) = alone_and_in_a_mode(body);
        assert!(wrong.is_empty(), "{}: {} {:#?}", body.name, wrong.len(), &wrong[..wrong.len().min(8)]);
        [accepted, run]
    });
    for (found, least) in pairs(&all, LEAST) {
        assert!(found[0] >= least[0] && found[1] >= least[1], "{all:?}");
    }
}

/// Accepted combinations on each body, and those that are run, at least.
const LEAST: [[usize; 2]; 5] = [[768, 34], [3917, 94], [4176, 100], [3845, 100], [3040, 71]];

/// Runs two laws in turn on a body; returns how many pairs are run and refused.
fn two_in_turn(body: &Body) -> [usize; 2] {
    let (mut run, mut refused, mut wrong) = (0, 0, Vec::new());
    let laws = || LAWS.into_iter().filter(|law| law.0 != SEQUENCE);
    for actuator in ACTUATORS {
        // Each pair once: the first law follows the second again.
        for (law, second) in
            laws().enumerate().flat_map(|(place, law)| laws().skip(place).map(move |second| (law, second)))
        {
            let on =
                |law: Kind, (estimator, sensor): (Kind, Kind)| Parts { law, sensor, estimator, actuator };
            let both = readers().find(|of| [law, second].iter().all(|law| is_accepted(body, on(*law, *of))));
            let Some(of) = both else { continue };
            match in_turn(body.text, on(law, of), second) {
                Ok(scenario) => {
                    run += 1;
                    if let Err(why) = combinations::run(&scenario, body, &[law.0, second.0], actuator.0) {
                        wrong.push(format!("{} {} {} {}: {why}", law.0, second.0, actuator.0, of.1.0));
                    }
                }
                Err(error) => {
                    refused += 1;
                    let why = error.to_string();
                    let has_reason =
                        why.contains("must be given where the laws of the axes have periods that differ");
                    if !has_reason {
                        wrong.push(format!("{} {} {}: {why}", law.0, second.0, actuator.0));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}: {} {:#?}", body.name, wrong.len(), &wrong[..wrong.len().min(8)]);
    [run, refused]
}

#[test]
fn two_laws_in_turn_keep_the_invariants() {
    let all = combinations::on_all(two_in_turn);
    for (found, least) in pairs(&all, PAIRS) {
        assert!(found[0] >= least, "{all:?}");
    }
}

/// Pairs of laws that are run on each body, at least.
const PAIRS: [usize; 5] = [156, 500, 528, 528, 373];

/// A body with one angle, from this angle and rate on.
fn one_angle([angle, rate]: [f64; 2], duration: f64) -> String {
    format!(
        "duration = {duration:?}\n[body.planar]\ninertia = 100.0\nangle = {angle:e}\nrate = {rate:e}\n[log]\nperiod = 0.25\n"
    )
}

const RELAY: &str =
    "law.relay = { dead_zone = 5e-4, hysteresis = 1e-4, strong = 4e-2, weak = 1e-3, k_t = 0.3 }";
const PLANE: &str = "law.phase_plane = { period = 0.5, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5 }";
const PD: &str = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.25 }";
const WHEEL: &str = "[actuator.wheel]\ngain = 1.0\nlimit = 0.5\n";
const PULSES: &str = "[actuator.thrusters]\ntorque = 0.5\nperiod = 0.5\n";

/// Returns angle (rad) and rate (rad/s) every 0.25 s.
fn motion(trace: &Trace) -> Vec<[f64; 2]> {
    let sampled = |topic: &str, name: &str| {
        let rows = pairs(traces::times(trace, topic), column(trace, topic, name));
        let mut rows: Vec<(f64, f64)> = rows.map(|(time, value)| (time, *value)).collect();
        rows.retain(|(time, _)| (time / 0.25).fract() == 0.0);
        rows.dedup_by_key(|(time, _)| *time);
        rows.into_iter().map(|(_, value)| value).collect::<Vec<_>>()
    };
    let [angles, rates] = [sampled("/attitude", "angle_rad"), sampled("/rate", "rate_rad_s")];
    pairs(angles, rates).map(|(angle, rate)| [angle, rate]).collect()
}

/// A relay and a phase-plane law move the body in their modes as they do alone from its state on.
#[test]
fn each_mode_moves_the_body_as_its_law_alone() {
    for (first, second, actuator) in [
        (PD, RELAY, ""),
        (RELAY, PD, ""),
        (PD, PLANE, PULSES),
        (PLANE, PD, PULSES),
        (PD, PLANE, WHEEL),
        (PLANE, PD, WHEEL),
    ] {
        let moded = format!(
            "{}{actuator}[[mode]]\nname = \"a\"\n{first}\nleave = [{{ to = \"b\", when = \"truth.time >= 7.0\" }}]\n\
             [[mode]]\nname = \"b\"\n{second}\n",
            one_angle([2e-3, 1e-4], 20.0)
        );
        let found = motion(&traced(&scenario(&moded)));
        let alone = |start, duration, law: &str| {
            motion(&traced(&scenario(&format!("{law}\n{}{actuator}", one_angle(start, duration)))))
        };
        let (before, after) = (alone([2e-3, 1e-4], 7.0, first), alone(found[28], 13.0, second));
        for (found, alone) in pairs(&found[..28], &before[..28]).chain(pairs(&found[28..], &after)) {
            let off = (found[0] - alone[0]).abs().max((found[1] - alone[1]).abs());
            assert!(off < 1e-15, "{first} {second}: {found:?} {alone:?}");
        }
    }
}

const THREE: &str = "duration = 4.0\n[body.spatial]\ninertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]\n\
                     rate = [1e-4, -2e-4, 1e-4]\n[log]\nperiod = 0.25\n\
                     [actuator.wheels]\narrangement = \"pyramid\"\ninertia = 0.01\ntorque = 0.05\n\
                     [sensor.sampled]\nperiod = 0.25\n";

/// Compensators of several orders about three axes have one topic of states, those of the smaller one ending with NaN.
#[test]
fn compensators_share_a_topic_of_states() {
    let law = |states: usize| {
        let row = |width: usize, value: f64| format!("[{}]", vec![format!("{value:?}"); width].join(", "));
        let rows = |count: usize, row: String| format!("[{}]", vec![row; count].join(", "));
        format!(
            "law.state_space = {{ period = 0.25, inputs = [\"roll\", \"yaw_rate\"], outputs = [\"roll\", \"yaw\"], a = {}, b = {}, \
             c = {}, d = [[0.4, 0.0], [0.0, 6.0]] }}",
            rows(states, row(states, 0.2)),
            rows(states, row(2, 0.3)),
            rows(2, row(states, 0.1))
        )
    };
    let moded = format!(
        "{THREE}[[mode]]\nname = \"a\"\n{}\nleave = [{{ to = \"b\", when = \"time >= 2\" }}]\n[[mode]]\nname = \"b\"\n{}\n",
        law(1),
        law(3)
    );
    let trace = traced(&scenario(&moded));
    let states: Vec<_> = ["x0", "x1", "x2"].map(|name| column(&trace, "/law_states", name)).into();
    let times = traces::times(&trace, "/law_states");
    for (row, time) in times.iter().enumerate() {
        let known = states.iter().filter(|column| column[row].is_finite()).count();
        assert_eq!(known, if *time < 2.0 { 1 } else { 3 }, "{time}");
    }
    // The law of the first mode alone has the same states.
    let alone =
        traced(&scenario(&format!("{}\n{THREE}", law(1)).replace("duration = 4.0", "duration = 1.9")));
    for (found, alone) in states[0].iter().zip(column(&alone, "/law_states", "x0")) {
        assert!(found.to_bits() == alone.to_bits());
    }
}

/// A relay has samples of a sensor at which conditions are tested.
#[test]
fn conditions_of_relays_are_tested_at_the_samples() {
    let text = format!(
        "{}[sensor.sampled]\nperiod = 0.5\n[[mode]]\nname = \"a\"\n{RELAY}\nleave = [{{ to = \"b\", when = \"time > 3.2\" }}]\n\
         [[mode]]\nname = \"b\"\n{RELAY}\n",
        one_angle([2e-3, 0.0], 10.0)
    );
    let trace = traced(&scenario(&text));
    assert_eq!(traces::times(&trace, "/mode"), [0.0, 3.5]);
    let Some(Column::Texts(names)) = trace.topic("/mode").and_then(|rows| rows.get("mode")) else { panic!() };
    assert_eq!(names, &["a", "b"]);
    let continuous = text.replace("[sensor.sampled]\nperiod = 0.5\n", "");
    let why = refused(&continuous);
    assert!(
        why.contains("`mode[0].leave[0].when` is tested at the samples of a law or of a sensor"),
        "{why}"
    );
}

#[test]
fn laws_that_do_not_fit_in_a_mode_are_refused() {
    let one = one_angle([0.0; 2], 10.0);
    let mode = |law: &str| format!("[[mode]]\nname = \"a\"\n{law}\n");
    for (text, words) in [
        (
            format!("{one}{}", mode("law.stages = [{ law.open = {} }]")),
            "`mode[0].law.stages` acts from given times of the run on",
        ),
        (
            format!(
                "{THREE}{}",
                mode("law.per_axis = { roll.stages = [{ law.open = {} }], pitch.open = {}, yaw.open = {} }")
            ),
            "`mode[0].law.per_axis.roll.stages` acts from given times of the run on",
        ),
        (
            format!("{one}{}", mode("law.per_axis = { roll.open = {}, pitch.open = {}, yaw.open = {} }")),
            "`mode[0].law.per_axis` is for a body with three axes",
        ),
        (
            format!(
                "{THREE}{}",
                mode(&PLANE.replace("switch_off = 3e-5", "switch_off = 3e-5, targets = [{ from = 0.0 }]"))
            ),
            "`mode[0].law.phase_plane.targets` are those of a whole run",
        ),
        (format!("{one}{}", mode(PLANE)), "`mode[0].law.phase_plane` needs the largest torque"),
        (
            format!(
                "{one}{}",
                mode("law.pd = { k_p = 0.4, k_d = 6.0, period = 0.2, extra = { gain = 0.1 } }")
            ),
            "`mode[0].law.pd.extra` feeds back the dominant mode",
        ),
        (
            format!("{}{}", THREE.replace("[sensor.sampled]\nperiod = 0.25\n", ""), mode(RELAY)),
            "`mode[0].law.relay` finds its crossings in closed form",
        ),
        (
            format!(
                "{THREE}{}{}",
                mode(PLANE),
                mode(&PLANE.replace("period = 0.5", "period = 0.25")).replace("\"a\"", "\"b\"")
            ),
            "`mode[1].law.phase_plane.period` must be that of `mode[0].law.phase_plane`, 0.5 s",
        ),
    ] {
        let found = refused(&text);
        assert!(found.contains(words), "{words}: {found}");
    }
}
