//! Broadband forces that are correlated, against an independent computation, in linear loops and in runs.

use crate::machines::{agree, bench, number};
use crate::util::Dir;

/// Densities of the three forces.
const DENSITY: &str = r#"
[[disturbance]]
point = "rotor"
density = { force = [1e-6, 4e-6, 2.5e-7], lower = "5 Hz", upper = "120 Hz" }
"#;
/// A correlation of all three.
const SOME: &str = "correlation = [[1, 0.6, -0.3], [0.6, 1, 0.2], [-0.3, 0.2, 1]]";

/// Returns the bench with a correlation of its forces.
fn study(period: f64, correlation: &str) -> String {
    bench(period, &DENSITY.replace("lower =", &format!("{correlation}, lower =")))
}

/// Source: `tests/golden/correlated.py`, by mixed noise and covariances.
#[test]
fn correlated_forces_move_the_line_of_sight_as_covariances_say() {
    let dir = Dir::new();
    let command = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --window 0.02 --json";
    #[rustfmt::skip]
    let golden = [
        (SOME, [1.131_295_367_160e-7, 5.574_530_986_525e-8], [1.131_295_367_259e-7, 5.574_530_987_763e-8], [1.115_233_322_072e-7, 5.472_030_650_646e-8]),
        ("correlation = [[1, 1, 1], [1, 1, 1], [1, 1, 1]]", [1.096_843_838_621e-7, 6.887_120_519_494e-8], [1.096_843_838_694e-7, 6.887_120_522_013e-8], [1.081_461_611_758e-7, 6.735_230_083_617e-8]),
        ("correlation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", [1.138_488_750_021e-7, 5.908_227_888_926e-8], [1.138_488_750_128e-7, 5.908_227_890_475e-8], [1.122_267_905_212e-7, 5.793_072_853_382e-8]),
    ];
    for (correlation, at_samples, over_time, means) in golden {
        dir.write("bench.toml", study(0.001, correlation));
        let report = dir.run(command).exits(0).json();
        for about in 0..2 {
            let output = &report["outputs"][about];
            agree(correlation, number(&output["rms"]), over_time[about], 1e-7);
            agree(correlation, number(&output["sample_rms"]), at_samples[about], 1e-7);
            agree(correlation, number(&output["window"]["mpe"]), means[about], 1e-7);
        }
    }
}

/// A run draws loads of one correlation: one load along all axes has the rms of linear loops, and so do three.
#[test]
fn runs_have_correlated_forces() {
    let dir = Dir::new();
    dir.write("bench.toml", study(0.01, "correlation = [[1, -0.95, 0], [-0.95, 1, 0], [0, 0, 1]]"));
    let linear = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
    let report = dir.run(linear).exits(0).json();
    let expected = number(&report["outputs"][0]["rms"]).hypot(number(&report["outputs"][1]["rms"]));
    let set = "--set duration=160 --set line_of_sight[0].window=[80,160]";
    let run = dir.run(&format!("simulate bench.toml {set} --log none --json")).exits(0).json();
    agree("run", number(&run["metrics"]["line_of_sight_rms_rad"][0]), expected, 0.12);
}

#[test]
fn correlations_that_are_none_are_refused() {
    let dir = Dir::new();
    for (correlation, why) in [
        (
            "correlation = [[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]",
            "must be positive semidefinite, or no components have it: its least eigenvalue is -0.8000",
        ),
        (
            "correlation = [[1, 0.5, 0], [0.4, 1, 0], [0, 0, 1]]",
            "must be symmetric, got 0.5 and 0.4 in rows 1 and 2",
        ),
        ("correlation = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]", "must have 1 on the diagonal, got 2 in row 1"),
        ("correlation = [[1, 0], [0, 1]]", "must have three rows of three numbers, or six of six"),
        (
            "correlation = [[1, 0, 0], [0, 1], [0, 0, 1]]",
            "must have three rows of three numbers, or six of six",
        ),
    ] {
        dir.write("bench.toml", study(0.001, correlation));
        dir.run("check bench.toml").exits(2).says(&["disturbance[0].density.correlation", why]);
    }
}
