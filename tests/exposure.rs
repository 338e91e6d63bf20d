//! Star trackers with an exposure: their samples against the motion itself, evaluated instant by instant.

use nalgebra::Quaternion;

use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{Scenario, Simulation};

use crate::spatial::FREE;
use crate::traces::{column, traced};
use crate::util::SCENARIOS;

/// Returns a shipped scenario with some of its words changed.
fn shipped(name: &str, change: &[(&str, &str)]) -> Scenario {
    let path = format!("{SCENARIOS}/{name}.toml");
    changed(std::fs::read_to_string(&path).expect("a file"), change)
}

fn changed(mut text: String, change: &[(&str, &str)]) -> Scenario {
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse("exposure.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Run whose motion is evaluated at chosen instants.
struct Looked {
    run: Simulation,
    row: Vec<f64>,
    places: [usize; 3],
    /// Rotation of the tracker by each mode, relative to the axes of the attitude.
    turns: Vec<Vector>,
}

impl Looked {
    fn new(scenario: &Scenario, point: &str) -> Self {
        let run = Simulation::new(scenario, 3);
        let fields = run.observation_fields(scenario);
        let place = |name: &str, nth: usize| {
            let of = fields.iter().enumerate().filter(|(_, field)| field.name == name).nth(nth);
            total_width(&fields[..of.expect("a field").0])
        };
        let body = scenario.model.three_axis().expect("three axes");
        // Modes that act back turn the hub too, and the attitude is that of the hub.
        let hub = body.shapes(if scenario.model.is_two_way() { &body.points[0].name } else { "" });
        let beyond = |(there, hub): (&(Vector, Vector), &(Vector, Vector))| there.1 - hub.1;
        Self {
            turns: body.shapes(point).iter().zip(&hub).map(beyond).collect(),
            row: vec![0.0; total_width(&fields)],
            places: [place("attitude", 0), place("error", 0), place("error", 1)],
            run,
        }
    }

    fn go(&mut self, to: Instant) {
        self.run.run_until(to, &mut ()).expect("a run");
        self.run.observe(&mut self.row).expect("numbers");
    }

    fn hub(&self) -> Quaternion<f64> {
        let at = &self.row[self.places[0]..];
        Quaternion::new(at[0], at[1], at[2], at[3])
    }

    /// Returns the true attitude of the tracker.
    fn attitude(&self) -> Quaternion<f64> {
        let modes = &self.run.three_axis_state().expect("three axes").modes;
        let moved = modes.iter().zip(&self.turns).map(|(phase, turns)| turns * phase.displacement);
        self.hub() * rotation(&moved.sum())
    }

    /// Returns the attitude that was reported last.
    fn reading(&self) -> Quaternion<f64> {
        let error = |place: usize| rotation(&Vector::from_row_slice(&self.row[place..place + 3]));
        self.hub() * error(self.places[1]).conjugate() * error(self.places[2])
    }
}

/// Returns the errors (rad) of the attitude from an exposure whose middle is at `at` (s), of a tracker at a point:
/// against the mean over `parts` short intervals, and against the attitude of the middle.
fn off(scenario: &Scenario, point: &str, [at, exposure, latency]: [f64; 3], parts: u32) -> [f64; 2] {
    let instant = |t: f64| Instant::START + Span::from_seconds(t);
    let mut looked = Looked::new(scenario, point);
    let mut seen = Vec::new();
    let part = exposure / f64::from(parts);
    for index in 0..parts {
        for (node, weight) in [(-0.6_f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)]
        {
            let t = at - 0.5 * exposure + part * (f64::from(index) + 0.5 + 0.5 * node);
            looked.go(instant(t));
            seen.push((looked.attitude(), weight / f64::from(parts)));
        }
    }
    // Another run, without evaluations in between.
    let mut run = Looked::new(scenario, point);
    run.go(instant(at));
    let middle = run.attitude();
    run.go(instant(at + latency));
    let mean = seen
        .iter()
        .fold(Vector::zeros(), |sum, (seen, weight)| sum + rotation_vector(&middle, seen) * *weight);
    let described = rotation_vector(&middle, &run.reading());
    [(described - mean).norm(), described.norm()]
}

/// Exposures that contain starts of segments, on every kind of body.
#[test]
fn a_reading_is_the_mean_of_the_motion_over_its_exposure() {
    // Without noise: readings are compared to 1e-12 rad.
    let noise = "noise = [2.4e-5, 2.4e-5, 1.5e-4]";
    let given = format!("[estimator.attitude]\nattitude_{noise}");
    let known = ("[estimator.attitude]", &given[..]);
    let silent = (noise, "exposure = 0.4");
    // A slew of a boom, under a law that decides four times a second.
    let boom = shipped("flexible-boom", &[silent, known]);
    // Wheels that pass through zero, and shake the body.
    let friction = shipped(
        "wheel-friction",
        &[
            silent,
            known,
            ("speeds = [40, -40, 40, -40]", "speeds = [2, -2, 70, -2]"),
            ("friction = {", "imbalance = { static = 1e-5, dynamic = 1e-6 }\nfriction = {"),
            ("from = 30.0 ", "from = 1.0 "),
        ],
    );
    let crossed = column(&traced(&friction), "/wheel_events", "time_s").to_vec();
    let near = |middle: &f64| crossed.iter().any(|t| (t - middle).abs() < 0.15 && (t - middle).abs() > 0.02);
    let crossing = (2..600).map(|k| 0.5 * f64::from(k)).find(near).expect("a wheel that passes through zero");
    // Panels on drives.
    let drives = shipped("sun-tracking", &[(noise, "exposure = 1.0"), known]);
    // Control moment gyros, and panels on hinges.
    let gathers = ("exposure = 0.2, noise = [2.4e-5, 2.4e-5, 1.5e-4]", "exposure = 0.4");
    let gimbals = shipped("agile-observer", &[gathers, known]);
    let hinges = shipped("panel-deployment", &[silent, known]);
    for (scenario, point, of, most) in [
        (&gimbals, "bench", [24.0, 0.4, 0.2], 1e-9),
        (&hinges, "bus", [2.0, 0.4, 0.2], 1e-9),
        (&boom, "head", [31.0, 0.4, 0.2], 1e-9),
        (&boom, "head", [33.5, 0.4, 0.2], 1e-9),
        (&friction, "bench", [3.0, 0.4, 0.2], 1e-9),
        (&friction, "bench", [crossing, 0.4, 0.2], 1e-9),
        (&drives, "hub", [4.0, 1.0, 0.5], 1e-9),
    ] {
        let [apart, smeared] = off(scenario, point, of, 400);
        assert!(apart < 1e-12 && smeared > most, "{point} {of:?}: {apart:e} of {smeared:e}");
    }
}

const CRAFT: &str = include_str!("golden/craft.toml");

const STEPS: &str = "[law.open]
[sensor.star_tracker]
period = 2.0
exposure = 1.5
latency = 0.8
point = \"boom\"
[[disturbance]]
about = \"roll\"
torque = 0.02
from = 3.75
to = 4.5
[[disturbance]]
about = \"yaw\"
torque = -0.03
from = 19.5
to = 20.25
";

/// Bodies whose modes do not act back: they tumble, their motion begins anew after 20 s, and modes drift.
#[test]
fn what_nothing_turns_back_is_averaged_too() {
    let (body, _) = FREE.split_once("[sensor.gyro]").expect("a body");
    let point = "points = [{ name = \"hub\" }, { name = \"boom\" }]";
    let shape = "shapes.boom = { rotation = [0.2, -0.1, 0.3] }\nshapes.hub";
    let moving = "rate = 0.02\ndamping = 0.005";
    let body = body
        .replace("points = [{ name = \"hub\" }]", point)
        .replace("shapes.hub", shape)
        .replace("damping = 0.005", moving);
    let drift = "[drift]\ncommon = { ramp = { from = 3.0, time = 20.0, to = 1.5 } }\n";
    for rest in ["", drift] {
        let scenario = changed(format!("{body}{STEPS}{rest}"), &[]);
        for at in [4.0, 12.0, 20.0, 40.0, 60.0] {
            let [apart, smeared] = off(&scenario, "boom", [at, 1.5, 0.8], 300);
            assert!(apart < 1e-12 && smeared > 1e-6, "{rest} {at}: {apart:e} of {smeared:e}");
        }
    }
}

/// A motion without a law equals that of a run without exposures, to the last bit, wherever the tracker is mounted.
#[test]
fn what_a_tracker_gathers_changes_nothing() {
    let craft = CRAFT.split_once("[law.pd]").expect("a law").0;
    for body in [craft, FREE.split_once("[sensor.gyro]").expect("a body").0] {
        let point = if body == craft { "tip" } else { "hub" };
        let steps = STEPS.replace("boom", point);
        let end = |steps: &str| {
            let scenario = changed(format!("{body}{steps}"), &[]);
            let mut run = Simulation::new(&scenario, 0);
            run.run(&mut ()).expect("a run");
            run.three_axis_state().cloned()
        };
        assert!(end(&steps) == end(&steps.replace("exposure = 1.5\n", "")), "{point}");
        let scenario = changed(format!("{body}{steps}"), &[]);
        let [apart, smeared] = off(&scenario, point, [20.0, 1.5, 0.8], 300);
        assert!(apart < 1e-12 && smeared > 1e-9, "{point}: {apart:e} of {smeared:e}");
    }
}
