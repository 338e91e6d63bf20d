//! Frames of a camera from a run, against means of the samples and the spectrum of the frames.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::machines::{agree, bench};
use crate::util::{Dir, table};

/// Cooler at 51 Hz on the wheel unit.
const COOLER: &str = r#"
[[disturbance]]
point = "rotor"
[disturbance.lines]
frequency = "51 Hz"
harmonics = [{ order = 1, force = [1, 0, 2] }]
"#;

/// The samples of the log are the reference: their means, and their spectrum.
#[test]
fn frames_are_means_over_exposures_and_name_their_aliases() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(0.001, COOLER).replace("period = 0.01\noptics", "period = 0.001\noptics"));
    dir.run("simulate bench.toml --set duration=8 --log full").exits(0);
    dir.run("export bench.mcap --topic line_of_sight -o samples.csv").exits(0);
    let text = dir.run("export bench.mcap --frames 20Hz --exposure 5ms -o frames.csv").exits(0);
    text.says(&["exposures of 5 ms", "disturbance[0].lines.harmonics[0]", "51", "9", "mode 1"]);
    let number = |row: &BTreeMap<String, String>, name: &str| -> f64 { row[name].parse().expect("a number") };
    let samples = table(&dir, "samples.csv");
    let frames = table(&dir, "frames.csv");
    assert_eq!(frames.len(), 160);
    for place in [0, 37, 159] {
        let frame = &frames[place];
        let start = number(frame, "time_s");
        assert!((start - 0.05 * place as f64).abs() < 1e-9, "{start}");
        let own: Vec<f64> = samples
            .iter()
            .filter(|row| (-1e-6..0.005 + 1e-6).contains(&(number(row, "time_s") - start)))
            .map(|row| number(row, "axes[0].error_rad"))
            .collect();
        assert_eq!(own.len(), 6);
        let mean = (own.iter().sum::<f64>() - 0.5 * (own[0] + own[5])) / 5.0;
        assert!((number(frame, "mean_x_rad") - mean).abs() < 1e-9 * mean.abs() + 1e-18, "{place}");
    }
    // The line at 51 Hz is at 9 Hz, smaller by the mean over the exposure; the square of Hann's window leaves slow motion out.
    let amplitude = |rows: &[BTreeMap<String, String>], name: &str, hertz: f64| {
        let late: Vec<_> = rows.iter().filter(|row| number(row, "time_s") >= 4.0 - 1e-9).collect();
        let [re, im, weights] = late.iter().enumerate().fold([0.0; 3], |[re, im, weights], (place, row)| {
            let (sine, cosine) = (TAU * hertz * number(row, "time_s")).sin_cos();
            let weight = (1.0 - (TAU * (place as f64 + 0.5) / late.len() as f64).cos()).powi(2);
            let value = weight * number(row, name);
            [re + value * cosine, im + value * sine, weights + weight]
        });
        2.0 * re.hypot(im) / weights
    };
    let turn = TAU / 2.0 * 51.0 * 0.005;
    let factor = turn.sin() / turn;
    for (axis, name) in ["mean_x_rad", "mean_y_rad"].into_iter().enumerate() {
        // A straight line between samples has 0.9 % less than the sine.
        let sampled = amplitude(&samples, &format!("axes[{axis}].error_rad"), 51.0);
        agree(name, amplitude(&frames, name, 9.0), sampled * factor * 0.9914, 2e-3);
    }
    // What cannot be is refused.
    for (options, why) in [
        ("--frames 0", "--frames must be a positive rate"),
        ("--frames 20 --exposure 0.06", "--exposure must be positive and at most a frame"),
        (
            "--frames 20 --exposure 0.001",
            "--exposure must have two samples of line_of_sight[0], 2 ms, got 1 ms",
        ),
        ("--frames 1e9", "--frames: each frame must have two samples of line_of_sight[0], 2 ms, got"),
        ("--frames 0.01", "--frames must be from 1 to 1000000 in the run, got 0"),
    ] {
        dir.run(&format!("export bench.mcap {options} -o wrong.csv")).exits(2).says(&[why]);
        assert!(!dir.has("wrong.csv"));
    }
}
