//! Lines of sight of several optics: their rows against an independent computation, in runs and in linear loops.

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::Vector;
use nalgebra::{Complex, DMatrix, DVector};

use crate::util::Dir;

/// Telescope of two mirrors and a detector on a hub, with a wheel unit that is bolted to it. Source: the bench of micro-vibration
/// of `tests/golden/optics.py`.
pub const BENCH: &str = r#"
duration = 2.0
seed = 1
[spacecraft]
mass = 62.0
inertia = [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]
[[appendage]]
name = "telescope"
mass = 18.0
centre = [0.0, 0.0, 0.30]
inertia = [[0.92, 0, 0], [0, 0.92, 0], [0, 0, 0.31]]
at = [0.0, 0.0, 0.35]
points = [
  { name = "m1", position = [0.0, 0.0, 0.05] },
  { name = "m2", position = [0.0, 0.0, 0.60] },
  { name = "detector", position = [0.04, 0.0, -0.08] },
]
[[appendage.modes]]
frequency = "62 Hz"
damping = 0.004
translation = [3.1, 0, 0]
rotation = [0, 1.10, 0]
shapes.m1 = { translation = [0.020, 0, 0], rotation = [0, 0.12, 0] }
shapes.m2 = { translation = [0.31, 0, 0], rotation = [0, 0.74, 0] }
shapes.detector = { translation = [0.005, 0, 0], rotation = [0, 0.02, 0] }
[[appendage.modes]]
frequency = "88 Hz"
damping = 0.004
translation = [0, 2.9, 0.2]
rotation = [-1.02, 0, 0.03]
shapes.m1 = { translation = [0, 0.018, 0.002], rotation = [-0.11, 0, 0] }
shapes.m2 = { translation = [0, 0.29, 0.01], rotation = [-0.68, 0, 0.01] }
shapes.detector = { translation = [0, 0.004, 0], rotation = [-0.02, 0, 0] }
[[appendage.modes]]
frequency = "140 Hz"
damping = 0.005
translation = [0.2, -0.1, 2.6]
rotation = [0.04, 0.01, 0.15]
shapes.m1 = { translation = [0.002, 0, 0.04], rotation = [0, 0.02, 0.005] }
shapes.m2 = { translation = [-0.03, 0.02, 0.28], rotation = [0.03, -0.1, 0.01] }
shapes.detector = { translation = [0, 0, 0.006], rotation = [0.01, 0, 0] }
[[appendage]]
name = "wheel unit"
mass = 0.95
centre = [0, 0, 0]
inertia = [[9.0e-4, 0, 0], [0, 1.6e-3, 0], [0, 0, 9.0e-4]]
at = [0.12, -0.05, -0.18]
points = [{ name = "rotor", position = [0, 0, 0] }]
[[line_of_sight]]
point = "detector"
period = 0.01
optics = [
  { point = "m1", rotation = [[2, 0, 0], [0, 2, 0]], translation = [[0, -1.9, 0], [1.9, 0, 0]] },
  { point = "m2", rotation = [[-0.35, 0, 0], [0, -0.35, 0]], translation = [[0, 1.6, 0], [-1.6, 0, 0]] },
  { point = "detector", translation = [[0, 0.3, 0], [-0.3, 0, 0]] },
]
[[sensor]]
gyro = { period = 0.1, angle_random_walk = 1e-6 }
[[sensor]]
star_tracker = { period = 0.1, noise = [1e-5, 1e-5, 1e-5] }
[estimator.attitude]
[law.attitude]
period = 0.1
bandwidth = 1.0
[actuator.wheels]
arrangement = "orthogonal"
inertia = 1e-7
torque = 0.01
"#;

/// Sizes of the line of sight (rad) about x and y at 100 Hz for forces (N) along x and z and torques (N m) about x and z on the
/// wheel unit. Source: a complex solution in physical coordinates, equal to a state space to 1e-12.
const AT_100_HZ: [[f64; 4]; 2] = [
    [3.548_266_139_007e-9, 1.137_351_953_440e-7, 1.625_645_714_079e-6, 8.330_838_135_167e-8],
    [1.578_041_547_866e-7, 1.531_543_045_110e-7, 1.018_633_335_282e-9, 6.802_892_118_234e-9],
];

#[test]
fn optics_see_what_an_independent_computation_sees() {
    let scenario = Scenario::parse("bench.toml", BENCH).expect("a scenario");
    let body = scenario.model.three_axis().expect("three axes");
    let sight = scenario.line_of_sight[0].sensitivity(body);
    // A rigid rotation by 1 rad: these optics are numbers, and no telescope.
    assert!((sight.rigid[(0, 0)] - 0.809).abs() < 1e-12, "{}", sight.rigid);
    let omega = std::f64::consts::TAU * 100.0;
    let (place, shapes) = (body.point("rotor").expect("a point"), body.shapes("rotor"));
    let inverse = body.inertia.try_inverse().expect("an inertia");
    let count = body.modes.len();
    let damping = &body.coupling.as_ref().expect("modes that act on the rotation").damping;
    let stiffness = DMatrix::from_fn(count, count, |row, column| {
        let w = body.modes[row].frequency.get();
        let own = if row == column { w * w - omega * omega } else { 0.0 };
        Complex::new(own, omega * damping[(row, column)])
    });
    let answer = |force: Vector, torque: Vector| -> [f64; 2] {
        let rigid = sight.rigid * (inverse * (place.cross(&force) + torque)) / -(omega * omega);
        let driven = shapes.iter().map(|(shift, turn)| Complex::from(shift.dot(&force) + turn.dot(&torque)));
        let found = stiffness.clone().lu().solve(&DVector::from_iterator(count, driven)).expect("a solution");
        [0, 1].map(|about| {
            let seen = sight.modes.iter().zip(found.iter());
            (seen.map(|(mode, found)| found * mode[about]).sum::<Complex<f64>>() + rigid[about]).norm()
        })
    };
    let none = Vector::zeros();
    let loads = [(Vector::x(), none), (Vector::z(), none), (none, Vector::x()), (none, Vector::z())];
    for (load, (force, torque)) in loads.into_iter().enumerate() {
        for (about, found) in answer(force, torque).into_iter().enumerate() {
            let exact = AT_100_HZ[about][load];
            // The loop of the reference is closed at 0.05 Hz, and its wheel turns.
            assert!((found / exact - 1.0).abs() < 1e-4, "{about} {load}: {found:e} {exact:e}");
        }
    }
}

/// The rms of a run is that of the linear loop, and differs from that of an instrument at the detector.
#[test]
fn runs_and_linear_loops_agree() {
    let dir = Dir::new();
    dir.write("bench.toml", BENCH);
    dir.run("check bench.toml").exits(0).says(&["line_of_sight[0].optics", "0.809", "is a sign wrong?"]);
    let run = dir.run("simulate bench.toml --set duration=5000 --set line_of_sight[0].window=[100,5000] --log none --json").exits(0).json();
    let rms = run["metrics"]["line_of_sight_rms_rad"][0].as_f64().expect("a number");
    let linear =
        dir.run("spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json").exits(0).json();
    let outputs = linear["outputs"].as_array().expect("outputs");
    let expected =
        outputs.iter().map(|own| own["rms"].as_f64().expect("a number").powi(2)).sum::<f64>().sqrt();
    assert!((rms / expected - 1.0).abs() < 0.05, "{rms:e} {expected:e}");
}

#[test]
fn optics_that_do_not_hold_are_refused() {
    let dir = Dir::new();
    for (from, to, why) in [
        (
            "translation = [[0, 0.3, 0], [-0.3, 0, 0]]",
            "translation = [[0, 0.2, 0], [-0.3, 0, 0]]",
            "must have `translation` that sums to zero over all optics, got [0, -0.0999",
        ),
        (
            "{ point = \"m1\", rotation",
            "{ point = \"m3\", rotation",
            "`line_of_sight[0].optics[0].point` must be one of the body's points",
        ),
        (
            "period = 0.01\noptics",
            "period = 0.01\naxis = [0, 1, 1]\noptics",
            "must be along x, y or z of the body with `optics`",
        ),
        ("rotation = [[2, 0, 0], [0, 2, 0]]", "rotation = [[2, 0], [0, 2]]", "rotation"),
    ] {
        assert!(BENCH.contains(from), "{from}");
        dir.write("bench.toml", BENCH.replace(from, to));
        dir.run("check bench.toml").exits(2).says(&[why]);
    }
}
