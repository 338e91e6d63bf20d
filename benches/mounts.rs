//! Wall time of the linear tools for a wheel on a mount: lines over 100 speeds of 20 orders with 50 modes, and the worst case of seven
//! uncertain keys.
//!
//! `cargo bench -p flexsc-bench --bench mounts` prints both, the least of some passes.

#![allow(clippy::print_stdout, reason = "it prints a table")]

use std::fmt::Write;
use std::time::Instant;

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::{LineLoop, LineSource, WheelOutput, WheelSpectrum};
use flexsc_core::worst_case::LineSearch;

/// Number of passes.
const PASSES: usize = 3;
/// Modes of the structure, beside the five of the mount.
const MODES: usize = 45;
/// Keys that are uncertain, with their ranges.
const UNCERTAIN: &str = r#"
[uncertain]
"appendage[1].mount.translation" = { uniform = ["20 Hz", "24 Hz"] }
"appendage[1].mount.rocking" = { uniform = ["26 Hz", "34 Hz"] }
"appendage[1].mount.damping" = { uniform = [0.03, 0.09] }
"appendage[1].mass" = { uniform = [0.9, 1.0] }
"appendage[0].frequency_factor" = { uniform = [0.9, 1.1] }
"spacecraft.mass" = { uniform = [58, 66] }
"actuator.wheels.inertia" = { uniform = [1.5e-3, 1.6e-3] }
"#;

/// Returns a spacecraft with a number of modes, and a wheel on a mount with so many harmonics.
fn scenario(modes: usize, orders: usize, uncertain: &str) -> Scenario {
    let mut text = String::from(
        "duration = 1.0\n[spacecraft]\nmass = 62.0\ninertia = [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]\n\
         [[appendage]]\nname = \"structure\"\nmass = 18.0\ncentre = [0, 0, 0.3]\nat = [0, 0, 0.35]\n\
         frequency_factor = 1.0\ninertia = [[0.92, 0, 0], [0, 0.92, 0], [0, 0, 0.31]]\npoints = [{ name = \"mirror\", position = [0, 0, 0.6] }]\n",
    );
    for mode in 0..modes {
        let (sign, size) = (if mode % 2 == 0 { 1.0 } else { -1.0 }, 2.0 / (1.0 + mode as f64));
        let _ = write!(
            text,
            "[[appendage.modes]]\nfrequency = \"{} Hz\"\ndamping = 0.004\ntranslation = [{}, {}, 0]\nrotation = [{}, {}, 0]\n\
             shapes.mirror = {{ rotation = [{}, {}, 0] }}\n",
            62.0 + 11.0 * mode as f64,
            size,
            0.5 * sign * size,
            -0.2 * sign * size,
            0.4 * size,
            0.7 * size,
            -0.3 * sign * size,
        );
    }
    text += "[[appendage]]\nname = \"wheel unit\"\nmass = 0.95\ninertia = [[9e-4, 0, 0], [0, 1.6e-3, 0], [0, 0, 9e-4]]\n\
             at = [0.12, -0.05, -0.18]\npoints = [{ name = \"rotor\" }]\n\
             mount = { translation = \"22 Hz\", rocking = \"30 Hz\", damping = 0.06, axis = [0, 1, 0] }\n\
             [[line_of_sight]]\npoint = \"mirror\"\nperiod = 0.01\n[law.attitude]\nperiod = 0.1\nbandwidth = 0.5\n\
             [actuator.wheels]\naxes = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]\ninertia = 1.6e-3\npoints = [\"rotor\", \"hub\", \"hub\"]\n\
             speeds = [\"3000 rpm\", 0, 0]\nspeed_limit = \"6000 rpm\"\nimbalance = { static = [3.6e-6, 0, 0], harmonics = [";
    for order in 1..orders {
        let _ = write!(text, "{{ order = {}, torque = 1e-8 }},", 0.6 + 0.37 * order as f64);
    }
    text += "] }\n";
    Scenario::parse("mounts.toml", &(text + uncertain)).expect("a valid scenario")
}

/// Prints the least wall time of some passes.
fn measure(name: &str, mut pass: impl FnMut() -> f64) {
    let (mut least, mut value) = (f64::INFINITY, 0.0);
    for _ in 0..PASSES {
        let since = Instant::now();
        value = pass();
        least = least.min(since.elapsed().as_secs_f64());
    }
    println!("{name:<60} {least:8.3} s   ({value:e})");
}

fn main() {
    let wide = scenario(MODES, 20, "");
    let speeds: Vec<f64> = (1..=100).map(|step| std::f64::consts::TAU * f64::from(step)).collect();
    measure("100 speeds, 20 orders, 50 modes, 2 lines of sight", || {
        let source = LineSource::of_wheels(&wide).expect("wheels").expect("imbalance");
        let lines = LineLoop::from_scenario(&wide).expect("a loop");
        let outputs =
            ["line_of_sight0_x", "line_of_sight0_y"].map(|name| lines.output(name).expect("an output"));
        WheelSpectrum::new(&source, &lines, &speeds, &outputs).expect("lines").rms[0][50]
    });
    let uncertain = scenario(3, 3, UNCERTAIN);
    measure("worst case of seven keys, 200 points, 8 modes", || {
        let output = WheelOutput { name: "line_of_sight0_x".to_owned(), window: None };
        LineSearch { output, most_loops: 200 }.run(&uncertain, || false).expect("a worst case").value()
    });
}
