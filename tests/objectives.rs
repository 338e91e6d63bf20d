//! Objectives of adaptations: against independent quadrature, against logs, and for every law with a gain to tune.

use std::fmt::Write as _;
use std::sync::Arc;

use flexsc_core::control::adaptation::{Adaptation, AdaptationSpec, Decision, Objective, SearchStep};
use flexsc_core::control::custom::Custom;
use flexsc_core::control::part::Part;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::Trace;
use flexsc_core::scenario::CustomParts;
use flexsc_core::{Scenario, Simulation};

use crate::study::{metrics, pairs, scenario};
use crate::traces::{column, nested, traced};

/// Adaptation that adds a constant after each window.
#[derive(Clone, Debug)]
struct Stairs {
    tunes: &'static str,
    objective: Objective,
    window: f64,
    step: f64,
}

/// Run-time state of the stairs, with the value.
#[derive(Clone, Debug)]
struct Climbing(Stairs, f64);

impl AdaptationSpec for Stairs {
    fn tunes(&self) -> &str {
        self.tunes
    }

    fn objective(&self) -> Objective {
        self.objective
    }

    fn window(&self) -> Option<Span> {
        Some(Span::from_seconds(self.window))
    }

    fn start(&self, value: f64, _: Seed) -> Box<dyn Adaptation> {
        Box::new(Climbing(self.clone(), value))
    }
}

impl Part for Climbing {}

impl Adaptation for Climbing {
    fn learn(&mut self, _: Instant, _: f64) -> Option<SearchStep> {
        self.1 += self.0.step;
        Some(SearchStep { decision: Decision::Keep, change: 0.0, draw: 1.0, gain: self.1, settled: 0 })
    }

    fn copy(&self) -> Box<dyn Adaptation> {
        Box::new(self.clone())
    }
}

/// Returns the objective over each window, for a scenario whose gain climbs by these stairs.
fn measured(plain: &Scenario, stairs: Stairs) -> (Vec<f64>, Trace) {
    let own: Custom<dyn AdaptationSpec> = Custom::new(Arc::new(stairs));
    let study = plain
        .with_custom_parts(CustomParts { adaptation: Some(own), ..CustomParts::default() })
        .expect("it fits");
    let trace = traced(&study);
    (column(&trace, "/objective", "value").to_vec(), trace)
}

const ONE_ANGLE: &str = "duration = 29.5
[body.planar]
inertia = 10.0
angle = 0.01
modes = [{ frequency = 0.8, gain = 0.5, damping = 0.01 }]
[law.pd]
k_p = 0.8
k_d = 1.5
period = 0.5
[actuator.wheel]
gain = 1.5
rotor = { inertia = 0.05, speed = 3.0 }
";

#[test]
fn objectives_about_one_axis_are_those_of_the_exact_motion() {
    let golden = include_str!("golden/objective.csv");
    let plain = Scenario::parse("objective.toml", ONE_ANGLE).expect("a scenario");
    let mut checked = 0;
    for objective in Objective::ALL {
        let exact: Vec<f64> = golden
            .lines()
            .filter_map(|line| line.split(',').skip(1).collect::<Vec<_>>().try_into().ok())
            .filter(|[name, _]: &[&str; 2]| *name == objective.key())
            .map(|[_, value]| value.parse().expect("a number"))
            .collect();
        if exact.is_empty() {
            continue;
        }
        checked += 1;
        let stairs = Stairs { tunes: "k_p", objective, window: 7.3, step: 0.1 };
        let (found, trace) = measured(&plain, stairs);
        // The peak of the golden numbers is the largest of samples.
        let within = if objective == Objective::PointingErrorPeak { 1e-6 } else { 1e-11 };
        assert_eq!(found.len(), exact.len(), "{objective:?}");
        for (found, exact) in pairs(&found, &exact) {
            assert!((found / exact - 1.0).abs() < within, "{objective:?}: {found} {exact}");
        }
        let gains = column(&trace, "/objective", "gain");
        assert!(pairs(gains, [0.8, 0.9, 1.0, 1.1]).all(|(found, exact)| (found - exact).abs() < 1e-12));
    }
    assert_eq!(checked, 7, "objectives in the golden file");
}

#[test]
fn objectives_about_three_axes_are_those_of_the_log() {
    // The cycles of the law are those of the log.
    let plain = scenario("flexible-boom", &[("duration", "90.0")]);
    let of = |objective| measured(&plain, Stairs { tunes: "damping", objective, window: 40.0, step: 0.0 });
    let mean = |values: &[f64], square: bool| -> Vec<f64> {
        let window = |window: &[f64]| {
            let sum: f64 = window.iter().map(|v| if square { v * v } else { *v }).sum();
            let mean = sum / window.len() as f64;
            if square { mean.sqrt() } else { mean }
        };
        values.chunks_exact(160).map(window).collect()
    };
    let lengths = |[x, y, z]: [Vec<f64>; 3]| -> Vec<f64> {
        x.iter().zip(&y).zip(&z).map(|((x, y), z)| (x * x + y * y + z * z).sqrt()).collect()
    };
    let norm = |trace: &Trace, topic: &str, names: [&str; 3]| -> Vec<f64> {
        lengths(names.map(|name| column(trace, topic, name).to_vec()))
    };
    let close = |found: &[f64], exact: &[f64], objective: Objective| {
        assert!(found.len() == 2 && exact.len() == 2, "{objective:?}: {found:?} {exact:?}");
        for (found, exact) in found.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-9, "{objective:?}: {found} {exact}");
        }
    };
    let errors = ["roll_error_rad", "pitch_error_rad", "yaw_error_rad"];
    for (objective, square) in [(Objective::PointingErrorMean, false), (Objective::PointingErrorRms, true)] {
        let (found, trace) = of(objective);
        close(&found, &mean(&norm(&trace, "/pointing", errors), square), objective);
    }
    let (found, trace) = of(Objective::TorqueMean);
    let axis = |axis: usize| nested(&trace, "/torques", ["axes", "applied_nm"], (axis, 3));
    let applied = lengths([axis(0), axis(1), axis(2)]);
    close(&found, &mean(&applied, false), Objective::TorqueMean);
    let (found, trace) = of(Objective::WheelPowerMean);
    let power: Vec<Vec<f64>> = (0..4)
        .map(|wheel| {
            let [speed, torque] = ["speed_rad_s", "torque_nm"]
                .map(|name| nested(&trace, "/wheels", ["wheels", name], (wheel, 4)));
            speed.iter().zip(&torque).map(|(speed, torque)| (speed * torque).abs()).collect()
        })
        .collect();
    let all: Vec<f64> = (0..power[0].len()).map(|row| power.iter().map(|of| of[row]).sum()).collect();
    let exact = mean(&all, false);
    assert_eq!(exact.len(), 2);
    close(&found, &exact, Objective::WheelPowerMean);
}

#[test]
fn counts_over_windows_add_up_to_those_of_the_run() {
    let relay = scenario("relay-fixed", &[("duration", "5000.0")]);
    let (found, _) = measured(
        &relay,
        Stairs { tunes: "k_t", objective: Objective::Switchings, window: 1000.0, step: 0.0 },
    );
    let all = metrics(relay).number("switchings").expect("a count");
    assert_eq!(found.iter().sum::<f64>(), all);
    assert!(found.len() == 5 && found[0] > 10.0, "{found:?}");
    let jets = scenario("thruster-phase-plane", &[("duration", "400.0")]);
    let (found, _) =
        measured(&jets, Stairs { tunes: "slope", objective: Objective::Firings, window: 100.0, step: 0.0 });
    assert!(found.len() == 4 && found.iter().sum::<f64>() > 3.0, "{found:?}");
}

const LAWS: [&str; 8] = [
    "relay = { dead_zone = 5e-4, hysteresis = 1e-4, strong = 4e-3, weak = 1e-4, k_t = 0.3 }",
    "pd = { k_p = 0.4, k_d = 6.0, period = 0.2, limit = 1.0 }",
    "attitude = { period = 0.2, bandwidth = 0.06, rate_limit = 0.01, integral = { time = 50.0, limit = 0.1 }, filters = [{ notch = { frequency = 1.0, depth = 0.1 } }, { low_pass = { frequency = 4.0 } }] }",
    "state_space = { period = 0.2, d = [[0.4, 6.0]] }",
    "open = {}",
    "phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5 }",
    "per_axis = { roll.pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }, pitch.attitude = { period = 0.2, bandwidth = 0.06 }, yaw.phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5 } }",
    "stages = [{ law.pd = { k_p = 0.4, k_d = 6.0, period = 0.2 } }, { from = 10.0, law.attitude = { period = 0.2, bandwidth = 0.06 } }]",
];

/// Bodies with actuators of which much can be measured.
const BODIES: [&str; 3] = [
    "sensor = { sampled = { period = 0.2, noise = 1e-5 } }
[actuator.thrusters]
torque = 0.05
period = 0.2
[body.planar]
inertia = 100.0
angle = 1e-3
modes = [{ frequency = 1.0, gain = 0.3, damping = 0.01, displacement = 1e-5 }]
",
    "sensor = { sampled = { period = 0.2, noise = 1e-5 } }
[actuator.wheel]
gain = 1.0
limit = 0.05
rotor = { inertia = 0.01 }
[body.planar]
inertia = 100.0
angle = 1e-3
modes = [{ frequency = 1.0, gain = 0.3, damping = 0.01, displacement = 1e-5 }]
",
    "sensor = { sampled = { period = 0.2, noise = 1e-5 } }
[actuator.wheels]
arrangement = \"pyramid\"
inertia = 0.01
torque = 0.05
[spacecraft]
mass = 200.0
inertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]
rate = [1e-5, -2e-5, 1e-5]
[[appendage]]
name = \"panel\"
mass = 10.0
centre = [0.0, 1.5, 0.0]
inertia = [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 10.0]]
at = [0.0, 0.5, 0.0]
modes = [{ frequency = 1.0, damping = 0.01, translation = [0.0, 0.0, 2.0], rotation = [4.0, 0.0, 0.0], displacement = 1e-4 }]
",
];

#[test]
fn every_number_of_every_law_is_tuned_by_every_objective_or_refused_with_a_reason() {
    let mut accepted = [0; BODIES.len()];
    for (body, count) in BODIES.iter().zip(&mut accepted) {
        for law in LAWS {
            let text = format!("duration = 31.0\nseed = 3\nlaw = {{ {law} }}\n{body}");
            let Ok(plain) = Scenario::parse("plain.toml", &text) else { continue };
            for number in plain.law.tunable() {
                for objective in Objective::ALL {
                    let (low, high) = (0.95 * number.value, 1.05 * number.value);
                    let mut adapted = text.clone();
                    let objective = objective.key();
                    write!(
                        adapted,
                        "[adaptation.random_search]\ntunes = \"{}\"\nobjective = \"{objective}\"\nwindow = 10.0\n\
                         step = {}\nbounds = [{low}, {high}]\n",
                        number.key,
                        0.1 * number.value
                    )
                    .expect("a text");
                    let study = match Scenario::parse("adapted.toml", &adapted) {
                        Ok(study) => study,
                        Err(error) => {
                            let text = error.to_string();
                            assert!(text.contains("`adaptation.random_search"), "{text}");
                            continue;
                        }
                    };
                    *count += 1;
                    let trace = traced(&study);
                    let name = format!("{law}: {} by {objective}", number.key);
                    let gains = column(&trace, "/adaptation", "gain");
                    assert_eq!(gains.len(), 3, "{name}");
                    assert!(gains.iter().all(|gain| (low..=high).contains(gain)), "{name}: {gains:?}");
                    let values = column(&trace, "/objective", "value");
                    assert!(
                        values.iter().all(|value| value.is_finite() && *value >= 0.0),
                        "{name}: {values:?}"
                    );
                }
            }
        }
    }
    // Numbers: PD 3, attitude 6, state-space 1 and stages 4, each by 7 objectives; relay 5, phase-plane 6 and, on three
    // axes, per axis 10, by their switchings too.
    assert_eq!(accepted, [186, 186, 266], "accepted combinations");
}

#[test]
fn a_number_that_is_tuned_is_the_number_that_acts() {
    // A run in which a number climbs once is one run to the window's end, and then another.
    let cases = [
        ("k_d", "pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }", 6.0),
        ("bandwidth", "attitude = { period = 0.2, bandwidth = 0.06 }", 0.06),
        ("gain", "state_space = { period = 0.2, d = [[0.4, 6.0]] }", 1.0),
        (
            "filters[0].notch.frequency",
            "attitude = { period = 0.2, bandwidth = 0.06, filters = [{ notch = { frequency = 1.0, depth = 0.1 } }] }",
            1.0,
        ),
    ];
    for (tunes, law, value) in cases {
        let body = BODIES[1];
        let text = format!("duration = 20.0\nseed = 3\nlaw = {{ {law} }}\n{body}");
        let plain = Scenario::parse("plain.toml", &text).expect("a scenario");
        let stairs = Stairs { tunes, objective: Objective::TorqueMean, window: 9.9, step: 0.3 * value };
        let own: Custom<dyn AdaptationSpec> = Custom::new(Arc::new(stairs));
        let study = plain
            .with_custom_parts(CustomParts { adaptation: Some(own), ..CustomParts::default() })
            .expect("it fits");
        let (mut adapted, mut tuned) = (Simulation::new(&study, 0), Simulation::new(&plain, 0));
        let mut constant = Simulation::new(&plain, 0);
        adapted.run(&mut ()).expect("a run");
        tuned.run_until(Instant::START + Span::from_seconds(9.9), &mut ()).expect("a run");
        tuned.set_parameter(tunes, 1.3 * value);
        tuned.run_until(Instant::START + Span::from_seconds(19.7), &mut ()).expect("a run");
        tuned.run(&mut ()).expect("a run");
        constant.run(&mut ()).expect("a run");
        // The second window ends at 19.8 s: the number climbs again, for one sample.
        let angle = |run: &Simulation| run.state().expect("one angle").rigid_angle;
        let moved = (angle(&tuned) - angle(&constant)).abs();
        assert!(moved > 1e-9, "{tunes}: {moved}");
        // A sample of 0.2 s near the end of 10 s moves the angle by a thousandth of that.
        assert!((angle(&adapted) - angle(&tuned)).abs() < 2e-3 * moved, "{tunes}");
    }
}

#[test]
fn what_cannot_be_measured_or_tuned_is_refused_with_its_reason() {
    let pd = "pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }";
    let refused = |law: &str, body: &str, adaptation: &str| {
        let text = format!(
            "duration = 31.0\nlaw = {{ {law} }}\n{body}[adaptation.random_search]\nstep = 0.01\n{adaptation}"
        );
        Scenario::parse("refused.toml", &text).expect_err("a fault").to_string()
    };
    for (law, body, adaptation, reason) in [
        (
            pd,
            BODIES[0],
            "tunes = \"k_p\"\nbounds = [0.3, 0.5]",
            "needs the window means of an `[estimator.envelope]`",
        ),
        (
            pd,
            BODIES[0],
            "tunes = \"k_p\"\nobjective = \"torque_mean\"\nbounds = [0.3, 0.5]",
            "`adaptation.random_search.window` must be given for the objective `torque_mean`",
        ),
        (
            pd,
            BODIES[0],
            "tunes = \"k_p\"\nobjective = \"wheel_power_mean\"\nwindow = 5.0\nbounds = [0.3, 0.5]",
            "needs wheels whose speed is known",
        ),
        (
            pd,
            BODIES[0],
            "tunes = \"k_p\"\nobjective = \"switchings\"\nwindow = 5.0\nbounds = [0.3, 0.5]",
            "counts the switchings of a law `relay` or `phase_plane`",
        ),
        (
            pd,
            BODIES[1],
            "tunes = \"k_p\"\nobjective = \"firings\"\nwindow = 5.0\nbounds = [0.3, 0.5]",
            "counts pulses of thrusters or jets",
        ),
        (
            pd,
            BODIES[1],
            "tunes = \"k_i\"\nobjective = \"torque_mean\"\nwindow = 5.0\nbounds = [0.3, 0.5]",
            "must name a number of the law `pd`, `k_p` or `k_d`, got `k_i`",
        ),
        (
            LAWS[0],
            BODIES[1],
            "tunes = \"dead_zone\"\nobjective = \"torque_mean\"\nwindow = 5.0\nbounds = [1e-5, 1e-3]",
            "must be above 0.00005, as dead_zone itself",
        ),
    ] {
        let text = refused(law, body, adaptation);
        assert!(text.contains(reason), "{text}");
    }
}
