//! Measured paths from loads at a point to a line of sight, against the closed form of the oscillator that was measured.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use nalgebra::Complex;
use serde_json::Value;

use crate::machines::{agree, bench, number};
use crate::util::Dir;

/// Frequency (Hz), damping ratio and gain (rad/N at rest) of the oscillator.
const MODE: (f64, f64, f64) = (47.0, 0.01, 3e-8);
/// Broadband force from 20 to 90 Hz (N²/Hz), and a line at 51 Hz.
const LOADS: &str = r#"
[[disturbance]]
point = "rotor"
density = { table = [[20, 4e-6, 0, 0], [90, 4e-6, 0, 0]] }
[[disturbance]]
point = "rotor"
[disturbance.lines]
frequency = "51 Hz"
harmonics = [{ order = 1, force = [2, 0, 0] }]
"#;

/// Returns the response of the oscillator at a frequency (Hz).
fn response(hertz: f64) -> Complex<f64> {
    let (at, damping, gain) = MODE;
    let ratio = hertz / at;
    Complex::new(gain, 0.0) / Complex::new(1.0 - ratio * ratio, 2.0 * damping * ratio)
}

/// Returns a table of the oscillator from 10 to 200 Hz, with rows by a function of frequency and response.
fn measured(header: &str, row: impl Fn(Complex<f64>) -> [f64; 2]) -> String {
    let mut text = format!("{header}\n");
    for step in 0..=40_000 {
        let hertz = 10.0 * f64::powf(20.0, f64::from(step) / 40_000.0);
        let [one, other] = row(response(hertz));
        let _ = writeln!(text, "{hertz:e},{one:e},{other:e}");
    }
    text
}

/// Returns the bench with a measured path about x.
fn study(path: &str) -> String {
    let paths = format!("measured = [{{ point = \"rotor\", about = \"x\", {path} }}]\nperiod = 0.01\noptics");
    bench(0.001, LOADS).replace("period = 0.01\noptics", &paths)
}

/// Returns the rms of the line of sight about x and y by source.
fn rms(dir: &Dir) -> [[f64; 2]; 2] {
    let command = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
    let report: Value = dir.run(command).exits(0).json();
    [0, 1].map(|output| [0, 1].map(|source| number(&report["outputs"][output]["rms_by_source"][source])))
}

#[test]
fn a_measured_path_takes_the_place_of_the_model() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(0.001, LOADS));
    let model = rms(&dir);
    // The integral of the oscillator over the band, by Simpson's rule.
    let (count, [from, to]) = (200_000, [20.0, 90.0]);
    let step = (to - from) / f64::from(count);
    let value = |place: i32| response(from + step * f64::from(place)).norm_sqr();
    let weight = |place: i32| match place {
        0 => 1.0,
        place if place == count => 1.0,
        place => 2.0 + 2.0 * f64::from(place % 2),
    };
    let square: f64 = (0..=count).map(|place| weight(place) * value(place)).sum::<f64>() * step / 3.0;
    let (broadband, line) = ((4e-6 * square).sqrt(), 2.0 * response(51.0).norm() / f64::sqrt(2.0));
    let polar = |angle: f64| move |value: Complex<f64>| [value.norm(), value.arg() / angle];
    let arcsec = PI / 648_000.0;
    for (path, table) in [
        ("force = \"x\", table = \"h.csv\"", measured("frequency,real,imaginary", |h| [h.re, h.im])),
        (
            "force = \"x\", phase = \"rad\", table = \"h.csv\"",
            measured("frequency,magnitude,phase", polar(1.0)),
        ),
        (
            "force = \"x\", phase = \"deg\", unit = \"arcsec/N\", table = \"h.csv\"",
            measured("# of a shaker", |h| [h.norm() / arcsec, h.arg() * 360.0 / TAU]),
        ),
    ] {
        dir.write("bench.toml", study(path));
        dir.write("h.csv", table);
        let [about_x, about_y] = rms(&dir);
        agree(path, about_x[0], broadband, 3e-6);
        agree(path, about_x[1], line, 1e-6);
        // The other axis is the model's.
        agree(path, about_y[0], model[1][0], 1e-6);
        agree(path, about_y[1], model[1][1], 1e-12);
    }
    // Other components, and frequencies outside the table, are those of the model.
    dir.write("bench.toml", study("force = \"y\", table = \"h.csv\", phase = \"rad\""));
    dir.write("h.csv", "300,1,0\n400,1,0\n");
    agree("model", rms(&dir)[0][1], model[0][1], 1e-12);
    dir.write("bench.toml", study("force = \"x\", table = [[300, 1, 0], [400, 1, 0]]"));
    agree("model", rms(&dir)[0][1], model[0][1], 1e-12);
}

/// A wheel about x whose static imbalance turns from y to z: of a path along y alone, the line is its response times c W².
#[test]
fn wheels_go_by_measured_paths() {
    let dir = Dir::new();
    let path = |force: &str, response: &str| {
        format!(
            "{{ point = \"rotor\", about = \"x\", force = \"{force}\", table = [[10, {response}, 0], [200, {response}, 0]] }}"
        )
    };
    let paths = format!("measured = [{}, {}]\nperiod = 0.01\noptics", path("y", "1e-6"), path("z", "0"));
    let imbalance = "inertia = 1e-7\nimbalance = { static = [2e-6, 0, 0], point = \"rotor\" }\n";
    let text = bench(0.001, "").replace("period = 0.01\noptics", &paths);
    dir.write("bench.toml", text.replace("inertia = 1e-7\n", imbalance));
    let command = "spectrum bench.toml --signal line_of_sight0_x --speeds 300:400:2 --json";
    let report: Value = dir.run(command).exits(0).json();
    for (place, speed) in [300.0_f64, 400.0].into_iter().enumerate() {
        let expected = 1e-6 * 2e-6 * speed * speed / f64::sqrt(2.0);
        agree("line", number(&report["wheels"]["rms"][0][place]), expected, 1e-9);
    }
}

#[test]
fn measured_paths_that_do_not_hold_are_refused() {
    let dir = Dir::new();
    let good = "frequency,real,imaginary\n10,1e-8,0\n20,1e-8,0\n";
    for (path, table, words) in [
        (
            "force = \"x\"",
            "frequency,real\n10,1\n",
            &["measured[0].table", "h.csv", "line 1: must have a frequency (Hz)"][..],
        ),
        (
            "force = \"x\"",
            "frequency,real,imaginary\n10,1,0\n9,1,0\n",
            &["line 3: must have increasing positive frequencies, got 9 Hz"],
        ),
        (
            "force = \"x\", phase = \"grad\"",
            good,
            &["measured[0].phase", "must be `rad` or `deg`, got `grad`"],
        ),
        ("force = \"x\", phase = \"deg\"", good, &["measured[0].phase", "real and imaginary part"]),
        ("force = \"x\"", "frequency,magnitude,phase\n1,1,0\n2,1,0\n", &["measured[0].phase", "is missing"]),
        ("force = \"x\", unit = \"m/N\"", good, &["measured[0].unit", "such as rad/N, got `m/N`"]),
        ("torque = \"x\", unit = \"arcsec/N\"", good, &["measured[0].unit", "rad/(N m)"]),
        ("force = \"x\", torque = \"y\"", good, &["measured[0].force", "must be given, or `torque`"]),
    ] {
        dir.write("bench.toml", study(&format!("{path}, table = \"h.csv\"")));
        dir.write("h.csv", table);
        let refused = dir.run("spectrum bench.toml -o figures").exits(2);
        refused.says(words);
        assert!(!dir.has("figures"));
    }
    dir.write("h.csv", good);
    dir.write(
        "bench.toml",
        study("force = \"x\", table = \"h.csv\"").replace("about = \"x\"", "about = \"z\""),
    );
    dir.run("spectrum bench.toml").exits(2).says(&[
        "bench.toml:",
        "measured[0].about",
        "along the line of sight",
    ]);
    let text = study("force = \"x\", table = \"h.csv\"");
    dir.write("bench.toml", text.replacen("point = \"rotor\", about", "point = \"stator\", about", 1));
    dir.run("spectrum bench.toml").exits(2).says(&["measured[0].point", "must be one of the body's points"]);
    let density = "density = { table = [[20, 4e-6, 0, 0], [90, 4e-6, 0, 0]] }";
    dir.write("bench.toml", text.replace(density, "force = [0, 0, 0]"));
    let run = dir.run("simulate bench.toml").exits(2);
    run.says(&["line_of_sight[0].measured", "has no run: it is a response over frequency"]);
    assert!(!dir.has("bench.mcap"));
}
