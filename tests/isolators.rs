//! Lines of wheels through isolators and at aliases, against numbers in physical coordinates and fine steps of the speed.

use std::f64::consts::TAU;

use flexsc_core::Scenario;
use flexsc_core::analysis::linear_model::LinearModel;
use flexsc_core::analysis::noise::{NoiseReport, NoiseRequest};

use crate::open_loops::scenario;
use crate::util::Dir;

const ISOLATOR: &str = include_str!("golden/isolator.toml");

/// Returns the amplitudes of the line of sight about x and y under the imbalance at a speed (Hz).
fn lines(text: &str, hertz: f64) -> [f64; 2] {
    let scenario = Scenario::parse("isolator.toml", text).expect("valid");
    let signals = vec!["line_of_sight0_x".to_owned(), "line_of_sight0_y".to_owned()];
    let request = NoiseRequest { signals, speeds: Some(vec![TAU * hertz]), ..NoiseRequest::default() };
    let wheels = NoiseReport::from_scenario(&scenario, &request).expect("linear").wheels.expect("imbalance");
    let strongest = |output: usize| {
        wheels.lines.iter().map(|line| line.outputs[output].direct.amplitude).fold(0.0, f64::max)
    };
    [strongest(0), strongest(1)]
}

/// Complex solves with the matrices as they are written: `tests/golden/isolator_oracle.py`. The diagonal of the free damping has
/// 4.7381e-9 rad about y at 100 Hz, 44 % less.
#[test]
fn a_wheel_shakes_the_line_of_sight_through_its_isolator() {
    let force = ISOLATOR.replace("dynamic = [0, 1.2e-7, 0]", "dynamic = [0, 0, 0]");
    for (text, hertz, expected) in [
        (ISOLATOR, 50.0, [1.431_869_180_579e-8, 4.118_379_175_822e-8]),
        (&force, 100.0, [1.036_029_002_331e-8, 8.399_108_343_269e-9]),
        (&force, 150.0, [1.469_843_503_810e-9, 8.473_592_528_885e-9]),
    ] {
        // Linear tools have the whole damping matrix with and without it in runs.
        for key in ["", "whole_damping = false\n", "whole_damping = true\n"] {
            let text = text.replace("[spacecraft]\n", &format!("[spacecraft]\n{key}"));
            for (found, expected) in lines(&text, hertz).into_iter().zip(expected) {
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-7, "{hertz} Hz, {key}: {found:.12e}, expected {expected:.12e}");
            }
        }
    }
}

/// Runs have the whole matrix too where the damping ratios of the clamped modes are far apart.
#[test]
fn runs_keep_the_damping_of_isolators() {
    let dir = Dir::new();
    let run = |name: &str, key: &str| {
        let text = ISOLATOR.replace("[spacecraft]\n", &format!("[spacecraft]\nrate = [1e-3, 0, 0]\n{key}"));
        let text = text.replace("duration = 10.0", "duration = 1.0");
        std::fs::write(dir.path(name), text).expect("a file");
        dir.run(&format!("simulate {name} --json")).exits(0).json()["metrics"].to_string()
    };
    let own = run("own.toml", "");
    assert_eq!(own, run("whole.toml", "whole_damping = true\n"));
    assert_ne!(own, run("diagonal.toml", "whole_damping = false\n"));
    dir.run("modes diagonal.toml").exits(0).says(&["left out in runs"]);
    dir.run("modes own.toml").exits(0).says(&["off-diagonal damping", ": kept"]);
    let alike = ISOLATOR.replace("damping = 0.06", "damping = 0.03");
    let scenario = Scenario::parse("alike.toml", &alike).expect("valid");
    let coupling = scenario.model.three_axis().and_then(|body| body.coupling.clone()).expect("modes");
    assert!(!coupling.couples_by_damping);
    let model = LinearModel::from_scenario(&scenario, 0.0).expect("linear");
    assert!(model.a[7][9] != 0.0, "{:?}", model.a[7]);
}

/// A multiple of the frequency of the gyro's samples: by default the speeds include the peaks beside it, which steps pass by.
#[test]
fn the_default_speeds_include_peaks_of_aliases() {
    let scenario = scenario("wheel-run-up");
    let wheels = |speeds: Option<Vec<f64>>| {
        let request = NoiseRequest { signals: vec!["yaw".to_owned()], speeds, ..NoiseRequest::default() };
        NoiseReport::from_scenario(&scenario, &request).expect("linear").wheels.expect("imbalance")
    };
    let found = wheels(None);
    assert!(found.speed_rad_s.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!(found.lines.len(), 8 * found.speed_rad_s.len());
    let highest = |speed: &[f64], rms: &[f64], near: f64| {
        let near = speed.iter().zip(rms).filter(|(speed, _)| (*speed - near).abs() < 0.5);
        near.map(|(_, rms)| *rms).fold(0.0, f64::max)
    };
    for turns in [3.0, 4.0] {
        let near = turns * TAU / 0.25;
        let fine: Vec<f64> = (0..401).map(|k| near - 0.5 + 0.0025 * f64::from(k)).collect();
        let fine = wheels(Some(fine));
        let expected = highest(&fine.speed_rad_s, &fine.rms[0], near);
        let found = highest(&found.speed_rad_s, &found.rms[0], near);
        assert!(found > 0.9 * expected, "{near}: {found:e}, expected {expected:e}");
    }
}
