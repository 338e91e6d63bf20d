//! Opened loops against Python's assembly with NumPy: `tests/golden/open_loop_reference.py`, and for the wheel study
//! `tests/golden/wheel_loop_reference.py`.

use std::fs;
use std::path::PathBuf;

use flexsc_core::Scenario;
use flexsc_core::analysis::eigenvalues::eigenvalues;
use flexsc_core::analysis::margins::FrequencyResponse;
use flexsc_core::analysis::open_loop::{LoopBreak, OpenLoop};
use nalgebra::{Complex, DMatrix};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Returns a scenario that is shipped, or one of the golden ones.
pub fn scenario(name: &str) -> Scenario {
    let paths = ["scenarios", "tests/golden/open_loops"].map(|folder| format!("{ROOT}/{folder}/{name}.toml"));
    let path = paths.iter().map(PathBuf::from).find(|path| path.exists()).expect("a scenario");
    Scenario::load(&path).expect("valid")
}

fn loop_break(name: &str) -> LoopBreak {
    match name {
        "command" => LoopBreak::Command,
        "torque" => LoopBreak::Torque,
        "measurement" => LoopBreak::Measurement,
        other => panic!("{other}"),
    }
}

/// Returns the spectral radius of the closed loop.
fn closed_radius(opened: &OpenLoop) -> f64 {
    let values = eigenvalues(&opened.transfer.sensitivity().expect("exists").a).expect("converges");
    values.iter().map(|value| value.re.hypot(value.im)).fold(0.0, f64::max)
}

#[test]
fn loops_are_those_that_numpy_assembles() {
    let text = fs::read_to_string(format!("{ROOT}/tests/golden/open_loops.csv")).expect("golden");
    let (mut checked, mut refused) = (0, 0);
    let mut last: Option<(String, OpenLoop)> = None;
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let case = format!("{} {}", cells[0], cells[1]);
        if cells[2] == "refused" {
            let fault = OpenLoop::from_scenario(&scenario(cells[0]), loop_break(cells[1])).expect_err(&case);
            assert!(!fault.key.is_empty() && !fault.why.is_empty(), "{case}: {fault}");
            refused += 1;
            continue;
        }
        if last.as_ref().is_none_or(|(name, _)| *name != case) {
            let opened = OpenLoop::from_scenario(&scenario(cells[0]), loop_break(cells[1]));
            last = Some((case.clone(), opened.expect(&case)));
        }
        let (_, opened) = last.as_ref().expect("assembled");
        let number = |text: &str| text.parse::<f64>().expect("a number");
        assert_eq!(opened.transfer.a.nrows().to_string(), cells[2], "{case}: states");
        assert_eq!(opened.states.len(), opened.transfer.a.nrows(), "{case}: names");
        assert_eq!(opened.transfer.b.ncols(), opened.signals.len() * opened.samples, "{case}: signals");
        assert_eq!(opened.period, number(cells[3]), "{case}: period");
        let radius = closed_radius(opened);
        // Poles that coincide have fewer digits.
        assert!((radius - number(cells[4])).abs() < 1e-10 * radius, "{case}: radius {radius} {}", cells[4]);
        let angle = number(cells[5]) * std::f64::consts::PI;
        let value = FrequencyResponse::new(&opened.transfer).at(Complex::new(angle.cos(), angle.sin()));
        let inputs = DMatrix::from_fn(opened.transfer.b.ncols(), 1, |row, _| {
            Complex::new(1.0 / (1.0 + row as f64), 0.0)
        });
        let shown = value.expect("no pole") * inputs;
        let expected: Vec<f64> = cells[6].split(' ').map(number).collect();
        assert_eq!(expected.len(), 2 * shown.nrows());
        let size = expected.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        for (row, part) in shown.iter().enumerate() {
            let off = (part.re - expected[2 * row]).hypot(part.im - expected[2 * row + 1]);
            // Two integrators lose digits at low frequencies; the gains of NumPy's filters are from a recursion that ends at
            // changes of 1e-13.
            let bound = 2e-11 * (1.0 + 1e-4 / (angle * angle));
            assert!(off < bound * size, "{case} at {}: output {row} is off by {:e}", cells[5], off / size);
        }
        checked += 1;
    }
    assert!(checked > 180 && refused > 90, "{checked} {refused}");
}

/// Returns the key and the reason of the refusal of a shipped scenario.
fn refusal(name: &str, opened: LoopBreak) -> String {
    OpenLoop::from_scenario(&scenario(name), opened).expect_err(name).to_string()
}

#[test]
fn a_part_that_is_not_linear_is_named_with_its_key() {
    let command = LoopBreak::Command;
    for (name, expected) in [
        ("relay-fixed", "`law.relay` is not linear: a loop has `pd`, `attitude` or `state_space`"),
        ("canted-jets", "`actuator.jets` is not linear: a loop has `ideal`, `wheel` or `wheels`"),
        ("wheel-fixed-gain", "`law.pd.extra` is not supported in linear loops: leave it out"),
    ] {
        assert_eq!(refusal(name, command), expected);
    }
    assert!(refusal("sun-tracking", command).starts_with("`appendage` has drives"));
    assert!(refusal("wheel-ekf", command).starts_with("`estimator.extended_kalman` is no linear system"));
    assert!(refusal("earth-observer", LoopBreak::Measurement).starts_with("`estimator.attitude` reads gyro"));
}

#[test]
fn signals_of_a_wheel_have_the_unit_of_its_command() {
    let opened = |at| OpenLoop::from_scenario(&scenario("wheel-fast-mode"), at).expect("linear");
    let signals = |at| {
        let signals = opened(at).signals;
        signals.iter().map(|signal| format!("{} {}", signal.name, signal.unit)).collect::<Vec<_>>()
    };
    assert_eq!(signals(LoopBreak::Command), ["command rad/s²/3.3e-5"]);
    assert_eq!(signals(LoopBreak::Torque), ["torque rad/s²"]);
    assert_eq!(signals(LoopBreak::Measurement), ["angle rad", "rate rad/s"]);
}
