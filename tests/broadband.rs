//! Broadband forces on the bench of micro-vibration, against an independent computation, in linear loops and in runs.

use serde_json::Value;

use crate::optics::BENCH;
use crate::util::Dir;

/// Density of the forces on the wheel unit.
const DENSITY: &str = r#"
[[disturbance]]
point = "rotor"
density = { force = [1e-6, 1e-6, 1e-6], lower = "5 Hz", upper = "120 Hz" }
"#;

/// Returns the bench under a law on the hub's rotation, of 0.05 Hz and with samples of a period (s), and what else acts.
fn bench(period: f64, loads: &str) -> String {
    let start = BENCH.find("[[sensor]]").expect("sensors");
    let end = BENCH.find("[actuator").expect("actuators");
    let law = format!(
        "[law.attitude]\nperiod = {period}\nbandwidth = \"0.05 Hz\"\ndamping = 0.7\n\
         inertia = [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]\n"
    );
    let text = format!("{}{law}{}{loads}", &BENCH[..start], &BENCH[end..]);
    text.replace("seed = 1\n", "seed = 1\nsensor = \"continuous\"\n")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Asserts that two numbers agree to a fraction of the second.
fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.12e}, expected {expected:.12e}");
}

/// Samples at 1 kHz, and at 100 Hz, where the law shakes the second mode through its aliases. Source: `tests/golden/broadband.py`.
/// The continuous loop of `optics.py`, whose wheel turns, has 5.755262772e-8 and 6.211101866e-8.
#[test]
fn broadband_forces_move_the_line_of_sight_as_covariances_say() {
    let dir = Dir::new();
    #[rustfmt::skip]
    let golden = [
        (0.001, [5.755_744_551_780e-8, 6.221_408_938_144e-8], [5.755_744_552_569e-8, 6.221_408_940_798e-8], [5.671_125_102_175e-8, 6.069_332_081_679e-8]),
        (0.01, [6.527_487_413_753e-8, 9.888_027_571_555e-8], [6.527_497_266_220e-8, 9.888_080_345_691e-8], [6.452_866_031_218e-8, 9.792_306_828_005e-8]),
    ];
    for (period, at_samples, over_time, means) in golden {
        dir.write("bench.toml", bench(period, DENSITY));
        let command =
            "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --window 0.02 --json";
        let report = dir.run(command).exits(0).json();
        assert_eq!(report["sources"], serde_json::json!(["disturbance[0].density"]));
        for about in 0..2 {
            let output = &report["outputs"][about];
            agree("rms", number(&output["rms"]), over_time[about], 1e-8);
            agree("source", number(&output["rms_by_source"][0]), over_time[about], 1e-8);
            agree("samples", number(&output["sample_rms"]), at_samples[about], 1e-6);
            agree("mean", number(&output["window"]["mpe"]), means[about], 1e-7);
            let last = output["cumulative_rms"].as_array().and_then(|all| all.last()).expect("numbers");
            agree("cumulative", number(last), over_time[about], 1e-6);
        }
    }
    agree("bench", 5.755_744_552_569e-8, 5.755_262_772e-8, 1e-4);
    agree("bench", 6.221_408_940_798e-8, 6.211_101_866e-8, 2e-3);
}
