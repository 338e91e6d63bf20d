//! Control with the estimate of a Kalman filter: a PD law that holds the body, or follows a slew, through a hold and
//! through wheels.
//!
//! Golden numbers: tests/golden/lqg_oracle.py, NumPy and SciPy.

use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::plants::golden;
use crate::study::pairs;

/// The body and the loop around it, without actuator, slew, and what the filter feeds.
const LOOP: &str = r#"duration = 120.0
[body.planar]
inertia = 120.0
angle = 0.02
[sensor.sampled]
period = 0.5
[estimator.kalman]
modes = [{ frequency = 0.95, gain = 0.45, damping = 0.01 }, { frequency = 2.2, gain = 0.25 }]
angle_noise = 1e-4
moment_noise = 1e-8
initial = { angle = 1e-3, rate = 1e-3, displacement = 2e-3, mode_rate = 6e-4 }
prior = "true"
[law.pd]
k_p = 4.0
k_d = 40.0
period = 0.5
[[disturbance]]
torque = 0.05
from = 20.0
to = 50.0
[log]
period = 0.5
"#;

const MOVING: &str = "rate = -1e-3\nmodes = [\
    { frequency = 0.9, gain = 0.5, damping = 0.005, displacement = 1e-3, rate = 2e-3 },\
    { frequency = 2.3, gain = 0.2, displacement = -4e-4, rate = 1e-3 }]";
const RESTING: &str =
    "modes = [{ frequency = 0.9, gain = 0.5, damping = 0.005 }, { frequency = 2.3, gain = 0.2 }]";
const HOLD: &str = "[actuator.hold]\nperiod = 0.5\n";
const WHEEL: &str = "[actuator.wheel]\ngain = 0.8\nback_emf = 0.6\n";
const TURN: &str = "[manoeuvre]\nangle = 0.5\n";
const SPIN: &str = "[manoeuvre]\nangle = 0.9\nstart_rate = 0.01\nend_rate = 0.01\n";

/// A slew that takes the body's modes for undamped, and so has odd harmonics alone.
fn planned(slew: &str, inertia: f64) -> String {
    format!(
        "{slew}time = 40.0\ncommand.sine = {{ suppress = 1 }}\n[manoeuvre.model]\ninertia = {inertia:?}\n\
         modes = [{{ frequency = 0.9, gain = 0.5 }}, {{ frequency = 2.3, gain = 0.2 }}]\n"
    )
}

/// A loop of the golden numbers.
pub fn lqg(name: &str, feeds: &str) -> Scenario {
    let (start, slew) = match name.split(' ').next_back() {
        Some("turn") => (RESTING.to_owned(), planned(TURN, 120.0)),
        Some("planned") => (RESTING.to_owned(), planned(TURN, 100.0)),
        Some("spin") => (format!("rate = 0.01\n{RESTING}"), planned(SPIN, 120.0)),
        _ => (MOVING.to_owned(), String::new()),
    };
    let actuator = match name {
        "hold" | "hold turn" => HOLD.to_owned(),
        "rigid wheel" => format!("{WHEEL}opposes = \"rigid_rate\"\n"),
        late if late.starts_with("late") => format!("{WHEEL}delay = 0.2\n"),
        _ => WHEEL.to_owned(),
    };
    let mut text = LOOP.replace("angle = 0.02\n", &format!("angle = 0.02\n{start}\n"));
    text = text.replace("prior =", &format!("feeds = \"{feeds}\"\nprior ="));
    if !slew.is_empty() && !name.starts_with("waiting") {
        text = text.replace("k_p =", "track = true\nk_p =");
    }
    Scenario::parse("lqg.toml", &format!("{text}{actuator}{slew}")).expect("valid")
}

#[test]
fn loops_over_a_filter_are_those_of_scipy() {
    let table = golden("../lqg");
    assert_eq!(table.len(), 10 * 2 * 4);
    for rows in table.chunks(4) {
        let scenario = lqg(&rows[0][0], &rows[0][1]);
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
        let estimates = trace.topic("/estimator").expect("estimates");
        let innovations = estimates.numbers("innovation_rad").expect("a column");
        let mut simulation = Simulation::new(&scenario, 0);
        for row in rows {
            let [time, angle, innovation] = [2, 3, 4].map(|at| row[at].parse::<f64>().expect("a number"));
            let until = Instant::START + Span::from_seconds(time);
            simulation.run_until(until, &mut ()).expect("a run");
            let state = simulation.state().expect("one angle");
            let error = state.angle() - angle;
            assert!(error.abs() < 1e-12, "{row:?}: {error:e}");
            let error = innovations[(2.0 * time) as usize] - innovation;
            assert!(error.abs() < 1e-12, "{row:?}: innovation {error:e}");
        }
    }
}

/// A wheel whose law waits for the end of a slew gives the body all of the slew, also if it ends within a sample.
#[test]
fn a_wheel_gives_a_slew_whole() {
    for time in ["40.0", "40.2", "0.3"] {
        let text = format!(
            "duration = 60.0\n[body.planar]\ninertia = 120.0\n{RESTING}\n[law.pd]\nk_p = 4.0\nk_d = 40.0\nperiod = 0.5\n\
             [actuator.wheel]\ngain = 0.8\n{}",
            planned(TURN, 120.0).replace("40.0", time).replace("suppress = 1", "suppress = 0"),
        );
        let scenario = Scenario::parse("slew.toml", &text).expect("valid");
        let mut simulation = Simulation::new(&scenario, 0);
        let end = Instant::START + Span::from_seconds(time.parse().expect("a number"));
        simulation.run_until(end, &mut ()).expect("a run");
        let rate = simulation.state().expect("one angle").rigid_rate;
        assert!(rate.abs() < 1e-14, "{time} s: {rate:e}");
    }
}

/// The momentum that the body gains its wheel loses, whatever body the slew is planned for.
#[test]
fn wheel_and_body_keep_their_momentum() {
    let rotor = "rotor = { inertia = 0.1, speed = 3.0 }\nopposes = \"rigid_rate\"\n[manoeuvre]";
    let text = format!("{LOOP}{WHEEL}{}", planned(TURN, 100.0))
        .replace("angle = 0.02\n[sensor", &format!("angle = 0.02\n{RESTING}\n[sensor"))
        .replace("torque = 0.05", "torque = 0.0")
        .replace("k_p =", "track = true\nk_p =")
        .replace("[manoeuvre]", rotor);
    let mut trace = Trace::new(Detail::Full);
    let scenario = Scenario::parse("slew.toml", &text).expect("valid");
    Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
    let column = |topic: &str, name: &str| {
        trace.topic(topic).and_then(|columns| columns.numbers(name)).expect("a column").to_vec()
    };
    let (rates, momenta) = (column("/rate", "rigid_rad_s"), column("/wheel", "momentum_nm_s"));
    assert!(rates.iter().any(|rate| *rate > 0.01));
    for (rate, momentum) in pairs(&rates, &momenta) {
        let sum = 120.0 * rate + momentum;
        assert!((sum - 0.3).abs() < 1e-13, "{sum}");
    }
}
