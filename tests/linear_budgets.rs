//! Sources of pointing budgets by the linear loop, against the ends of runs.

use flexsc_core::metrics::IndexRecord;
use flexsc_core::{Scenario, Simulation};
use nalgebra::{DMatrix, DVector};

use crate::util::Dir;

/// A spacecraft with a panel and without noise, under a steady torque and two sines about pitch.
const DISTURBED: &str = r#"
name = "disturbed"
duration = 600.0

[spacecraft]
mass = 600.0
centre = [0.05, -0.02, 0.10]
inertia = [[250, 6, -4], [6, 300, 5], [-4, 5, 220]]
points = [{ name = "bus" }]

[[appendage]]
name = "panel"
mass = 30.0
centre = [0.0, 2.5, 0.0]
inertia = [[62.5, 0, 0], [0, 5.625, 0], [0, 0, 68.125]]
at = [0.0, 1.0, 0.2]
modes = [{ frequency = 1.10, damping = 0.05, translation = [0, 0, 3.5], rotation = [11.0, 1.0, 0] }]

[law.attitude]
period = 0.25
bandwidth = 0.1

[actuator.wheels]
arrangement = "orthogonal"
inertia = 0.02
torque = 0.5
momentum = 50.0

[[disturbance]]
about = "pitch"
torque = 1e-4
sines = [{ amplitude = 2e-4, frequency = 0.3 }, { amplitude = 4e-4, frequency = 1.3, phase = 0.4 }]

[[requirement]]
name = "error"
quantity = "pointing_error"
axis = "y"
from = 400
period = 0.25
limit = 1e-3

[[requirement]]
name = "mean"
quantity = "pointing_error"
axis = "y"
index = "MPE"
window = 5
from = 400
period = 0.25
limit = 1e-3

[[requirement]]
name = "late"
quantity = "pointing_error"
axis = "y"
index = "RPE"
convention = "end"
window = 5
from = 400
period = 0.05
limit = 1e-3
"#;

/// Returns the constant and the amplitudes of the sines of 0.3 and 1.3 rad/s, fitted to values that are `apart` (s).
fn fitted(values: &[f64], apart: f64) -> [f64; 3] {
    let functions = |row: usize, column: usize| {
        let t = apart * row as f64;
        match column {
            0 => 1.0,
            1 => (0.3 * t).cos(),
            2 => (0.3 * t).sin(),
            3 => (1.3 * t).cos(),
            _ => (1.3 * t).sin(),
        }
    };
    let matrix = DMatrix::from_fn(values.len(), 5, functions);
    let fit = matrix.svd(true, true).solve(&DVector::from_column_slice(values), 1e-12).expect("full rank");
    [fit[0].abs(), fit[1].hypot(fit[2]), fit[3].hypot(fit[4])]
}

#[test]
fn deviation_and_sines_are_those_of_a_run() {
    let dir = Dir::with(&[]);
    std::fs::write(dir.path("disturbed.toml"), DISTURBED).expect("a file");
    let scenario = Scenario::load(&dir.path("disturbed.toml")).expect("valid");
    let mut record = IndexRecord::new(&scenario);
    Simulation::new(&scenario, 0).run(&mut record).expect("a run");
    let runs = record.finish();
    let budget = dir.run("budget disturbed.toml --runs 1 --json").exits(0).json();
    for (index, values) in runs.iter().enumerate() {
        let linear = &budget["budgets"][index]["linear_sources"];
        let amplitudes = linear["amplitudes"].as_array().expect("a list");
        let found: Vec<f64> = [&linear["bias"]]
            .into_iter()
            .chain(amplitudes)
            .map(|value| value.as_f64().expect("finite"))
            .collect();
        let [constant, slow, fast] = fitted(values, if index == 2 { 0.05 } else { 0.25 });
        let largest = slow.max(fast).max(constant);
        for (found, run) in found.iter().zip([constant, slow, fast]) {
            // Gyroscopic and finite-angle terms are of second order.
            assert!((found - run).abs() < 2e-3 * largest, "{index}: linear {found}, run {run}");
        }
        assert_eq!(found.len(), 3);
        assert_eq!(linear["noise"].as_f64(), Some(0.0));
    }
    // The steady torque over the stiffness J w_n².
    let deviation = budget["budgets"][0]["linear_sources"]["bias"].as_f64().expect("finite");
    assert!((deviation / (1e-4 / (0.01 * 306.0)) - 1.0).abs() < 0.02, "{deviation}");
    let (first, _) = DISTURBED.split_once("[[requirement]]\nname = \"mean\"").expect("a second requirement");
    dir.write("first.toml", first);
    let told = dir.run("budget first.toml --runs 1").exits(0);
    told.says(&["linear loop under its disturbances: bias"]);
}
