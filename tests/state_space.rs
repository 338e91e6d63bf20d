//! Compensators by their matrices: a regulator on a filter, discretised controllers, three axes, and what is refused.
//!
//! Golden numbers: tests/golden/state_space_oracle.py, NumPy and SciPy.

use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::plants::golden;
use crate::study::pairs;
use crate::traces::nested;

const BODY: &str = "duration = 120.0
[body.planar]
inertia = 120.0
angle = 0.02
rate = -1e-3
modes = [
    { frequency = 0.9, gain = 0.5, damping = 0.005, displacement = 1e-3, rate = 2e-3 },
    { frequency = 2.3, gain = 0.2, displacement = -4e-4, rate = 1e-3 },
]
[sensor.sampled]
period = 0.5
[[disturbance]]
torque = 0.05
from = 20.0
to = 50.0
[actuator.hold]
period = 0.5
";

/// k_p + k_d s/(1 + s t): 4 N m/rad, 40 N m s/rad, 0.8 s.
const LAG: &str = "a = [[-1.25]]\nb = [[1.25]]\nc = [[-50.0]]\nd = [[54.0]]\n";

fn parse(law: &str) -> Result<Scenario, String> {
    let text = format!("{BODY}[law.state_space]\nperiod = 0.5\n{law}");
    Scenario::parse("design.toml", &text).map_err(|error| error.to_string())
}

#[test]
fn loops_are_those_of_scipy() {
    let table = golden("../state_space");
    assert_eq!(table.len(), 3 * 4);
    for rows in table.chunks(4) {
        let law = match rows[0][0].as_str() {
            "regulator" => include_str!("golden/state_space.toml").to_owned(),
            of => format!("of = \"{of}\"\n{LAG}"),
        };
        let scenario = parse(&law).expect("valid");
        let mut simulation = Simulation::new(&scenario, 0);
        for row in rows {
            let [time, angle] = [1, 2].map(|at| row[at].parse::<f64>().expect("a number"));
            simulation.run_until(Instant::START + Span::from_seconds(time), &mut ()).expect("a run");
            let error = simulation.state().expect("one angle").angle() - angle;
            assert!(error.abs() < 1e-12, "{row:?}: {error:e}");
        }
    }
}

/// A PD law is a matrix of two gains: the same motion, to rounding, with and without a slew that is tracked.
#[test]
fn a_pd_law_is_a_matrix() {
    let turn = "[manoeuvre]\nangle = 0.5\ntime = 40.0\ncommand.sine = { suppress = 1 }\n";
    for (slew, track) in [("", ""), (turn, ""), (turn, "track = true\n")] {
        let end = |law: &str| {
            let resting = BODY.replace(", displacement = 1e-3, rate = 2e-3", "");
            let resting =
                resting.replace(", displacement = -4e-4, rate = 1e-3", "").replace("rate = -1e-3\n", "");
            let text = format!("{resting}[law.{law}\nperiod = 0.5\n{track}{slew}");
            let scenario = Scenario::parse("design.toml", &text).expect("valid");
            let mut trace = Trace::new(Detail::Full);
            Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
            trace.topic("/attitude").and_then(|rows| rows.numbers("angle_rad")).expect("angles").to_vec()
        };
        let (pd, matrix) = (end("pd]\nk_p = 4.0\nk_d = 40.0"), end("state_space]\nd = [[4.0, 40.0]]"));
        assert!(pd.len() > 100 && pd.iter().any(|angle| angle.abs() > 1e-2));
        for (pd, matrix) in pairs(&pd, &matrix) {
            assert!((pd - matrix).abs() < 1e-13, "{slew} {track}: {pd} {matrix}");
        }
    }
}

/// The attitude law's bandwidth and damping as a matrix of accelerations: the Earth observer turns as it did.
#[test]
fn three_axes_turn_by_accelerations() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/earth-observer.toml");
    let text =
        std::fs::read_to_string(path).expect("the scenario").replace("duration = 300.0", "duration = 60.0");
    let text = text.replace("assess = [60.0, 300.0]", "assess = [10.0, 60.0]");
    let law = "[law.attitude]\nperiod = 0.25           # s\nbandwidth = 0.1         # rad/s\ndamping = 0.8\n";
    let plain: String = text.lines().map(|line| line.trim_end().to_owned() + "\n").collect();
    let start = plain.find("[law.attitude]").expect("the law");
    let end = start + plain[start..].find("\n\n").expect("its end");
    let with = |law: &str| {
        let text = format!("{}{law}{}", &plain[..start], &plain[end..]);
        let scenario = Scenario::parse(path, &text).expect("valid");
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
        trace.topic("/pointing").and_then(|rows| rows.numbers("roll_rad")).expect("angles").to_vec()
    };
    let matrix = "[law.state_space]\nperiod = 0.25\ncommand = \"acceleration\"\nd = [[0.01, 0.16]]";
    let (attitude, matrix) = (with(law.trim_end()), with(matrix));
    assert!(attitude.iter().any(|angle| *angle > 0.02));
    for (attitude, matrix) in pairs(&attitude, &matrix) {
        assert!((attitude - matrix).abs() < 1e-11, "{attitude} {matrix}");
    }
}

#[test]
fn matrices_that_do_not_fit_are_refused() {
    for (law, key, why) in [
        ("", "law.state_space.d", "must be given if there are no states"),
        ("d = [[1.0, 2.0, 3.0]]", "law.state_space.d[0]", "angle and rate, got 3"),
        ("d = [[1.0], [2.0]]", "law.state_space.d", "must be one row, got 2"),
        ("a = [[1.0, 2.0]]\nb = [[1.0]]\nc = [[1.0]]", "law.state_space.a[0]", "must have 1 column, got 2"),
        ("a = [[0.5]]\nb = [[1.0], [1.0]]\nc = [[1.0]]", "law.state_space.b", "each of 1 state, got 2"),
        ("a = [[0.5]]\nb = [[1.0]]", "law.state_space.c", "states have no effect"),
        (
            "a = [[4.0]]\nb = [[1.0]]\nc = [[1.0]]\nof = \"tustin\"",
            "law.state_space.a",
            "eigenvalue at 2/period = 4",
        ),
        ("a = [[4e3]]\nb = [[1.0]]\nc = [[1.0]]\nof = \"held\"", "law.state_space.a", "overflows within"),
        ("d = [[nan]]", "law.state_space.d", "finite"),
    ] {
        let error = parse(law).expect_err(law);
        assert!(error.contains(key) && error.contains(why), "{law}: {error}");
    }
    let states = 65;
    let zeros = vec!["0.0"; states].join(", ");
    let rows = vec![format!("[{zeros}]"); states].join(", ");
    let error = parse(&format!("a = [{rows}]\nb = [[1.0]]\nc = [[1.0]]")).expect_err("too many");
    assert!(error.contains("at most 64 states, got 65"), "{error}");
}

/// Body of three axes, turned by (0.3, -0.4, 1.1) rad, without modes, under a law about all axes together.
const TURNED: &str = "duration = 20.0
log.period = 0.5
[body.spatial]
inertia = [[100.0, 3.0, -2.0], [3.0, 80.0, 1.0], [-2.0, 1.0, 60.0]]
attitude = [0.8229839424136313, 0.14104009132653114, -0.18805345510204152, 0.5171470015306142]
rate = [1e-3, -2e-3, 3e-3]
points = [{ name = \"hub\" }]
";
const ALL: &str = "inputs = [\"roll\", \"pitch\", \"yaw\", \"roll_rate\", \"pitch_rate\", \"yaw_rate\"]\n";

fn three_axes(law: &str, rest: &str) -> Result<Scenario, String> {
    let text = format!("{TURNED}[law.state_space]\nperiod = 0.5\n{law}\n{rest}");
    Scenario::parse("axes.toml", &text).map_err(|error| error.to_string())
}

/// Runs a scenario and returns the columns of its log, with the run.
fn traced(scenario: &Scenario) -> Trace {
    let mut trace = Trace::new(Detail::Full);
    Simulation::new(scenario, 0).run(&mut trace).expect("a run");
    trace
}

fn column(trace: &Trace, topic: &str, name: &str) -> Vec<f64> {
    let rows = trace.topic(topic).unwrap_or_else(|| panic!("no topic {topic}"));
    rows.numbers(name).unwrap_or_else(|| panic!("no column {name}")).to_vec()
}

/// Matrices that do not couple the axes are a law about each axis, with states and without: to the bit.
#[test]
fn uncoupled_axes_are_a_law_about_each() {
    let each = "a = [[0.5]]\nb = [[-3.0, 0.2]]\nc = [[1.0]]\nd = [[0.9, 12.0]]\nlimit = 6.0\n";
    let together = format!(
        "{ALL}a = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]]
b = [[-3.0, 0.0, 0.0, 0.2, 0.0, 0.0], [0.0, -3.0, 0.0, 0.0, 0.2, 0.0], [0.0, 0.0, -3.0, 0.0, 0.0, 0.2]]
c = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
d = [[0.9, 0.0, 0.0, 12.0, 0.0, 0.0], [0.0, 0.9, 0.0, 0.0, 12.0, 0.0], [0.0, 0.0, 0.9, 0.0, 0.0, 12.0]]
limit = 6.0\n"
    );
    for command in ["torque", "acceleration"] {
        let command = format!("command = \"{command}\"\n");
        let [each, together] = [each, together.as_str()]
            .map(|law| traced(&three_axes(&format!("{law}{command}"), "").expect("valid")));
        for name in ["roll_rad", "pitch_rad", "yaw_rad"] {
            let [each, together] = [&each, &together].map(|trace| column(trace, "/pointing", name));
            assert!(each.len() > 30 && each.iter().any(|angle| angle.abs() > 0.1));
            assert_eq!(each, together, "{command} {name}");
        }
    }
}

/// The first torque is D times the error; the vector part of the quaternion is sin(a/2) times the axis; the order of
/// inputs and outputs is that of their names; the state is in the log.
#[test]
fn named_inputs_and_outputs_are_those_of_the_matrices() {
    let law = "inputs = [\"yaw_rate\", \"quaternion_z\", \"roll\"]\noutputs = [\"pitch\", \"roll\"]\n\
               a = [[0.5]]\nb = [[1.0, 10.0, 100.0]]\nc = [[0.0], [0.0]]\n\
               d = [[1.0, 20.0, 300.0], [4.0, 50.0, 600.0]]\n";
    let scenario = three_axes(law, "").expect("valid");
    let trace = traced(&scenario);
    let turned: [f64; 3] = [0.3, -0.4, 1.1];
    let angle = turned.iter().map(|part| part * part).sum::<f64>().sqrt();
    let error = [-3e-3, -(0.5 * angle).sin() * turned[2] / angle, -turned[0]];
    let torques = [0, 1, 2].map(|axis| nested(&trace, "/torques", ["axes", "applied_nm"], (axis, 3))[0]);
    let exact = [
        4.0 * error[0] + 50.0 * error[1] + 600.0 * error[2],
        error[0] + 20.0 * error[1] + 300.0 * error[2],
        0.0,
    ];
    for (found, exact) in torques.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-12, "{torques:?}, {exact}");
    }
    let state = column(&trace, "/law_states", "x0");
    let exact = error[0] + 10.0 * error[1] + 100.0 * error[2];
    assert!((state[0] - exact).abs() < 1e-12, "{} {exact}", state[0]);
    assert!(state.iter().any(|x| (x - state[0]).abs() > 1.0));
}

/// The speeds of wheels are those that the drives have.
#[test]
fn speeds_of_wheels_are_inputs() {
    let wheels = "[actuator.wheels]\narrangement = \"pyramid\"\ninertia = 0.05\ntorque = 1.0\n\
                  speeds = [100.0, -50.0, 70.0, -20.0]\n";
    let law = |input: &str| format!("inputs = [\"{input}\"]\noutputs = [\"yaw\"]\nd = [[1e-3]]\n");
    for (wheel, speed) in [100.0, -50.0, 70.0, -20.0].into_iter().enumerate() {
        let scenario = three_axes(&law(&format!("wheel{wheel}_speed")), wheels).expect("valid");
        let yaw = nested(&traced(&scenario), "/torques", ["axes", "applied_nm"], (2, 3))[0];
        assert!((yaw - 1e-3 * speed).abs() < 1e-12, "{wheel}: {yaw}");
    }
    let error = three_axes(&law("wheel4_speed"), wheels).expect_err("no such wheel");
    assert!(error.contains("law.state_space.inputs[0]") && error.contains("4 wheels is `wheel3`"), "{error}");
    let error = three_axes(&law("wheel0_speed"), "").expect_err("no wheels");
    assert!(error.contains("there is no `[actuator.wheels]`"), "{error}");
}

#[test]
fn names_that_do_not_fit_are_refused() {
    let one = "d = [[1.0], [1.0], [1.0]]\n";
    for (law, key, why) in [
        (format!("inputs = [\"role\"]\n{one}"), "inputs[0]", "`roll`, `pitch`, `yaw`, `quaternion_x`"),
        (format!("inputs = [\"wheel01_speed\"]\n{one}"), "inputs[0]", "got `wheel01_speed`"),
        (
            "inputs = [\"roll\", \"roll\"]\nd = [[1.0, 1.0]]\n".to_owned(),
            "inputs[1]",
            "is given twice: `roll`",
        ),
        (format!("outputs = [\"roll\"]\n{one}"), "inputs", "must name the columns of B and D"),
        (
            format!("inputs = [\"roll\"]\noutputs = [\"x\"]\n{one}"),
            "outputs[0]",
            "`roll`, `pitch` or `yaw`, got `x`",
        ),
        (
            format!("inputs = [\"roll\"]\noutputs = [\"yaw\", \"yaw\"]\n{one}"),
            "outputs[1]",
            "is given twice: `yaw`",
        ),
        (format!("inputs = [\"roll\", \"yaw\"]\n{one}"), "d[0]", "must have 2 columns, got 1"),
        ("inputs = [\"roll\"]\nd = [[1.0]]\n".to_owned(), "d", "a row for each of 3 outputs, got 1"),
        ("inputs = [\"roll\"]\n".to_owned(), "d", "must be given if there are no states"),
        (
            "d = [[1.0], [0.0], [0.0]]\n".to_owned(),
            "d",
            "got 3: a law about three axes together names its `inputs`",
        ),
    ] {
        let error = three_axes(&law, "").expect_err(&law);
        assert!(error.contains(&format!("law.state_space.{key}")) && error.contains(why), "{law}: {error}");
    }
    let error = parse("inputs = [\"roll\"]\nd = [[1.0], [1.0], [1.0]]\n").expect_err("one axis");
    assert!(error.contains("law.state_space.inputs") && error.contains("three axes"), "{error}");
    let law = format!("{{ state_space = {{ period = 0.5, inputs = [\"roll\"], {} }} }}", one.trim_end());
    for (place, text) in [
        (
            "law.per_axis.roll.state_space.inputs",
            format!("law.per_axis = {{ roll = {law}, pitch.open = {{}}, yaw.open = {{}} }}"),
        ),
        ("law.stages[0].law.state_space", format!("law.stages = [{{ law = {law} }}]")),
    ] {
        let text = format!("{text}\n{TURNED}");
        let error = Scenario::parse("axes.toml", &text).expect_err(place).to_string();
        assert!(error.contains(place) && error.contains("three axes together"), "{error}");
    }
}

/// The shipped LQG law ends at its goal, and its states are in the log.
#[test]
fn the_shipped_law_meets_its_goal() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/earth-observer-lqg.toml");
    let scenario = Scenario::load(path.as_ref()).expect("the scenario");
    let trace = traced(&scenario);
    for (name, goal) in [("roll_rad", 0.6), ("pitch_rad", 0.7), ("yaw_rad", 0.55)] {
        let angles = column(&trace, "/pointing", name);
        let last = &angles[angles.len() - 100..];
        assert!(last.iter().all(|angle| (angle - goal).abs() < 1e-4), "{name}: {last:?}");
    }
    let states = column(&trace, "/law_states", "x7");
    assert!(states.iter().all(|x| x.is_finite()) && states.iter().any(|x| x.abs() > 1e-6));
}
