//! Compensators by their matrices: a regulator on a filter, discretised controllers, three axes, and what is refused.
//!
//! Golden numbers: tests/golden/state_space_oracle.py, NumPy and SciPy.

use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::plants::golden;
use crate::study::pairs;

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
