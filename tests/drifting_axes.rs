//! Modes of three axes whose frequencies drift: against SciPy, in the log, and with filters.

use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{Scenario, Simulation};

use crate::traces::{nested, traced};

const BODY: &str = "[body.spatial]
inertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]
points = [{ name = \"hub\" }]
modes = [
    { frequency = 1.0, damping = 0.01, displacement = 2e-4, rate = -1e-5, shapes.hub = { rotation = [0.03, 0.0, 0.04] } },
    { frequency = 2.5, damping = 0.004, rate = 3e-4, shapes.hub = { rotation = [0.01, 0.04, -0.03] } },
]
";

const DRIFT: &str = "[drift]
each = [{ sinusoid = { amplitude = 0.3, period = 50.0 } }, { ramp = { from = 10.0, time = 20.0, to = 0.6 } }]
";

fn scenario(law: &str, rest: &str) -> Scenario {
    let text = format!("duration = 60.0\nlaw = {{ {law} }}\n{rest}\n{BODY}{DRIFT}");
    Scenario::parse("drifting.toml", &text).expect("a scenario")
}

#[test]
fn modes_that_drift_move_as_a_general_integrator_finds() {
    let pushed =
        "[[disturbance]]\nabout = \"pitch\"\ntorque = 0.01\n[[disturbance]]\nabout = \"yaw\"\ntorque = 0.02";
    let study = scenario("open = {}", pushed);
    let golden: Vec<[f64; 4]> = include_str!("golden/drifting_axes.csv")
        .lines()
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            numbers.try_into().expect("four")
        })
        .collect();
    assert_eq!(golden.len(), 8);
    let frequencies = [1.0, 2.5];
    for [time, mode, displacement, rate] in golden {
        let mut simulation = Simulation::new(&study, 0);
        simulation.run_until(Instant::START + Span::from_seconds(time), &mut ()).expect("a run");
        let mode = mode as usize;
        let found = simulation.three_axis_state().expect("three axes").modes[mode];
        assert!((found.displacement - displacement).abs() < 3e-15, "{time} {mode}: {found:?}");
        assert!((frequencies[mode] * found.quadrature - rate).abs() < 3e-15, "{time} {mode}: {found:?}");
    }
}

#[test]
fn energies_and_filters_know_the_drift() {
    let law = "pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }";
    let sensors = "sensor = { sampled = { period = 0.2, noise = 1e-6 } }\n\
                   estimator = { extended_kalman = { angle_noise = 1e-6 } }\nlog.period = 0.2";
    let trace = traced(&scenario(law, sensors));
    let last = |topic: &str, names: [&str; 2], place: (usize, usize)| {
        *nested(&trace, topic, names, place).last().expect("a row")
    };
    // At the end the second mode has 0.6 of its frequency.
    let (q, rate) = (
        last("/vibrations", ["modes", "displacement"], (1, 2)),
        last("/vibrations", ["modes", "rate"], (1, 2)),
    );
    let energy = 0.5 * (rate * rate + 1.5 * 1.5 * q * q);
    assert!((last("/vibrations", ["modes", "energy_j"], (1, 2)) / energy - 1.0).abs() < 1e-12);
    let dominant = last("/estimators", ["axes", "true_frequency_rad_s"], (1, 3));
    assert!((dominant - 1.5).abs() < 1e-12, "{dominant}");
}

#[test]
fn a_drift_of_a_spacecraft_is_refused_with_its_reason() {
    let text = format!(
        "duration = 60.0\nlaw.open = {{}}\n[spacecraft]\nmass = 200.0\n\
         inertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]\n{DRIFT}"
    );
    let error = Scenario::parse("refused.toml", &text).expect_err("a fault").to_string();
    assert!(error.contains("follow from its appendages"), "{error}");
    let few = format!(
        "duration = 60.0\nlaw.open = {{}}\n{BODY}[drift]\neach = [{{ ramp = {{ time = 1.0, to = 2.0 }} }}]\n"
    );
    let error = Scenario::parse("refused.toml", &few).expect_err("a fault").to_string();
    assert!(error.contains("a profile for each of 2 modes, got 1"), "{error}");
}
