//! Fine mirrors behind lines of sight: linear loops against an independent computation, runs against linear loops, and what is
//! refused. Numbers of the mirror by `tests/golden/fine_mirror.py`.

use std::f64::consts::TAU;

use flexsc_core::Scenario;
use flexsc_core::analysis::fine_mirror::MirrorLoop;
use flexsc_core::analysis::noise::{LineLoop, LoadedLoop, NoisyLoop, OutputLines, SamplePlace};
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::{Column, Detail, Trace};
use nalgebra::{Complex, DMatrix, DVector};

use crate::optics::BENCH;
use crate::traces::flown;
use crate::util::Dir;

/// Mirror of 300 Hz with a loop of 1 kHz.
pub const MIRROR: &str = "
[line_of_sight.mirror]
frequency = \"300 Hz\"
damping = 0.6
period = \"1 ms\"
gain = 0.25
noise = 2e-8
";

/// Returns the bench with a mirror, whose keys may be followed by others.
fn bench(more: &str) -> String {
    BENCH.replacen("[[sensor]]", &format!("{MIRROR}{more}[[sensor]]"), 1)
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse("bench.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn spectrum(dir: &Dir, options: &str) -> serde_json::Value {
    let text = dir.run(&format!("spectrum bench.toml --json {options}")).exits(0).printed();
    serde_json::from_str(&text).expect("an object")
}

#[test]
fn the_noise_of_the_guidance_sensor_and_the_crossing_are_those_of_the_reference() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(""));
    let found = spectrum(&dir, "");
    let sources = found["sources"].as_array().expect("sources");
    let own = sources.iter().position(|source| source == "line_of_sight[0].mirror.noise").expect("a source");
    for name in ["line_of_sight0_x", "line_of_sight0_y"] {
        let output = found["outputs"].as_array().and_then(|all| all.iter().find(|one| one["output"] == name));
        let rms = output.expect("an output")["rms_by_source"][own].as_f64().expect("a number");
        assert!((rms / 9.291_481_474_972e-9 - 1.0).abs() < 1e-9, "{name}: {rms}");
        let before = format!("{name}_before_mirror");
        let output =
            found["outputs"].as_array().and_then(|all| all.iter().find(|one| one["output"] == *before));
        assert_eq!(output.expect("an output")["rms_by_source"][own], 0.0);
    }
    let mirror = &found["mirrors"][0];
    let number = |key: &str| mirror[key].as_f64().expect("a number");
    assert!((number("crossing_hz") - 39.395_544_783).abs() < 1e-8 && number("peak") > 1.64);
    assert!((number("spectral_radius") - 0.702_175_186_800_46).abs() < 1e-12);
    let windows = spectrum(&dir, "--window 0.01 --pixel 1e-6");
    assert!(windows["outputs"][0]["mtf"].as_f64().is_some_and(|mtf| (0.9..1.0).contains(&mtf)));
    dir.run("spectrum bench.toml -o figures")
        .exits(0)
        .says(&["fine mirror of detector", "worse above 39.4 Hz"]);
    assert!(dir.size("figures/bench-mirror_0.svg") > 3_000);
}

/// Lines of a torque before and behind the mirror, by closed form; and the same motion period by period.
#[test]
fn lines_and_periodic_motion_behind_the_mirror_are_those_of_the_closed_form() {
    let scenario = parsed(&bench(""));
    let noisy = NoisyLoop::from_scenario(&scenario).expect("a loop");
    let lines = LineLoop::from_scenario(&scenario).expect("a loop");
    let mirror = MirrorLoop::new(scenario.line_of_sight[0].mirror.expect("a mirror"));
    let output = |name: &str| noisy.output(name).expect("an output");
    let outputs = ["line_of_sight0_x", "line_of_sight0_x_before_mirror", "mirror0_x"].map(output);
    for (hertz, left) in [(22.0, 0.557_250_440_111_785_6), (98.112_21, 1.641_212_396_499_938_6)] {
        let load = lines.torque(0);
        let loaded = LoadedLoop::new(&lines, &outputs, std::slice::from_ref(&load)).expect("loads");
        let found = loaded.lines(TAU * hertz).expect("lines").remove(0);
        let found: Vec<_> = found.into_iter().map(|lines| OutputLines::new(lines, 1.0)).collect();
        let [behind, before] = [0, 1].map(|place| found[place].direct.amplitude);
        assert!((behind / before / left - 1.0).abs() < 1e-9, "{hertz} Hz: {}", behind / before);
        // Of all lines, with those that the law makes at 10 Hz and the mirror at 1 kHz.
        let all = (found[0].mean_square() / found[1].mean_square()).sqrt();
        let exact = mirror.answer(TAU * hertz).mirror(0).norm();
        assert!((found[2].direct.amplitude / before / exact - 1.0).abs() < 1e-9, "{hertz} Hz");
        let motion = lines.motion(TAU * hertz, &load).expect("a motion");
        let places = |output: usize| {
            let time = |k: i64| SamplePlace { period: 0, time: motion.period / 4000 * k };
            motion.values(output, (0..4000).map(time)).iter().map(Complex::norm_sqr).sum::<f64>()
        };
        let ratio = (places(outputs[0]) / places(outputs[1])).sqrt();
        assert!((ratio / all - 1.0).abs() < 1e-5, "{hertz} Hz: {ratio} {all}");
    }
}

/// Body without a control loop under a torque of one frequency, beside which its vibration soon vanishes.
fn free(hertz: f64, torque: f64, more: &str) -> String {
    let sensors = BENCH.find("[[sensor]]").expect("sensors");
    let line = format!("{}{MIRROR}{more}", &BENCH[..sensors])
        .replace("noise = 2e-8", "")
        .replace("period = 0.01", "period = 0.0005")
        .replace("damping = 0.004", "damping = 0.06")
        .replace("damping = 0.005", "damping = 0.06");
    let sine = format!("sines = [{{ amplitude = {torque}, frequency = {} }}]", TAU * hertz);
    format!("{line}\n[law.open]\n[[disturbance]]\nabout = \"roll\"\n{sine}\n")
}

/// Returns a number of each row about x of the only line.
fn about_x(trace: &Trace, topic: &str, field: &str) -> Vec<f64> {
    let rows = trace.topic(topic).expect("rows");
    let Some(Column::Rows(_, axes)) = rows.get("axes") else { panic!("axes") };
    axes.numbers(field).expect("numbers").iter().step_by(3).copied().collect()
}

/// Returns the amplitude of a sine in values that are 0.5 ms apart, beside a straight line.
fn amplitude(values: &[f64], hertz: f64) -> f64 {
    let row = |k: usize| {
        let t = 5e-4 * k as f64;
        [(TAU * hertz * t).cos(), (TAU * hertz * t).sin(), 1.0, t]
    };
    let matrix = DMatrix::from_fn(values.len(), 4, |k, column| row(k)[column]);
    let fit = matrix.svd(true, true).solve(&DVector::from_column_slice(values), 1e-14).expect("a fit");
    fit[0].hypot(fit[1])
}

#[test]
fn a_run_leaves_of_a_sine_what_the_linear_loop_says() {
    for (hertz, left) in [(22.0, 0.557_250_440_112), (50.0, 1.249_749_242_517), (150.0, 1.281_665_656_719)] {
        let scenario = parsed(&free(hertz, 1e-3, ""));
        let (_, trace) = flown(&scenario, 0, Detail::Full);
        let part = |topic: &str, field: &str| about_x(&trace, topic, field).split_off(2000);
        let before = amplitude(&part("/fine_mirror", "before_rad"), hertz);
        let behind = amplitude(&part("/line_of_sight", "error_rad"), hertz);
        assert!((behind / before / left - 1.0).abs() < 2e-3, "{hertz} Hz: {} {left}", behind / before);
        let angle = amplitude(&part("/fine_mirror", "angle_rad"), hertz);
        let mirror = scenario.line_of_sight[0].mirror.expect("a mirror");
        let exact = MirrorLoop::new(mirror).answer(TAU * hertz).mirror(0).norm();
        assert!((angle / before / exact - 1.0).abs() < 2e-3, "{hertz} Hz: {} {exact}", angle / before);
    }
}

fn numbers(metrics: &Metrics, name: &str) -> Vec<f64> {
    let Some(MetricValue::Numbers(values)) = metrics.get(name) else { panic!("no {name}") };
    values.clone()
}

#[test]
fn stroke_and_rate_limit_commands() {
    let run = |more: &str| flown(&parsed(&free(5.0, 1e-2, more)), 0, Detail::Full);
    let commands = |trace: &Trace| about_x(trace, "/fine_mirror", "command_rad");
    let (metrics, trace) = run("");
    let peak = commands(&trace).into_iter().map(f64::abs).fold(0.0, f64::max);
    assert_eq!(numbers(&metrics, "fine_mirror_limited_s"), [0.0]);
    let (metrics, trace) = run(&format!("stroke = {}\n", 0.5 * peak));
    let found = commands(&trace).into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!((found / peak - 0.5).abs() < 1e-12, "{found} {peak}");
    let limited = numbers(&metrics, "fine_mirror_limited_s")[0];
    assert!(limited > 0.1 && limited < 2.0, "{limited}");
    // In a window of a quarter of the run.
    let windowed = free(5.0, 1e-2, &format!("stroke = {}\n", 0.5 * peak))
        .replace("period = 0.0005\n", "period = 0.0005\nwindow = [1.5, 2.0]\n");
    let own = numbers(&flown(&parsed(&windowed), 0, Detail::Full).0, "fine_mirror_limited_s")[0];
    assert!(own > 0.1 && own <= 0.5 && limited > 0.6, "{own} {limited}");
    let rate = 0.2 * peak;
    let (metrics, trace) = run(&format!("rate = {rate}\n"));
    // Two samples of the line in a period of the mirror.
    let steps = commands(&trace).windows(3).map(|values| (values[2] - values[0]).abs()).fold(0.0, f64::max);
    assert!((steps / (1e-3 * rate) - 1.0).abs() < 1e-9, "{steps}");
    assert!(numbers(&metrics, "fine_mirror_limited_s")[0] > 0.1);
}

#[test]
fn a_mirror_has_a_figure_margins_a_worst_gain_and_a_requirement() {
    let dir = Dir::new();
    let required = "\n[[requirement]]\nname = \"jitter\"\nquantity = \"line_of_sight\"\npoint = \"detector\"\nindex = \"RPE\"\nwindow = 0.1\n\
                    convention = \"uniform\"\nlimit = 1e-6\nlevel = 0.95\ninterpretation = \"temporal\"\n\
                    [uncertain]\n\"line_of_sight[0].mirror.gain\" = { uniform = [0.2, 0.5] }\n";
    dir.write("bench.toml", bench("") + required);
    dir.run("simulate bench.toml --log full -o bench.mcap").says(&["behind its mirror", "turns at most"]);
    dir.run("plot bench.mcap --what fine-mirror -o figures").exits(0);
    assert!(dir.size("figures/bench-fine-mirror.svg") > 5_000);
    dir.run("margins bench.toml").exits(0).says(&["mirror0"]);
    let margins: serde_json::Value =
        serde_json::from_str(&dir.run("margins bench.toml --json").exits(0).printed()).expect("an object");
    let above = margins["mirrors"][0]["gain_above"].as_f64().expect("a margin");
    let worst: serde_json::Value =
        serde_json::from_str(&dir.run("worst bench.toml --margin gain --json").printed()).expect("an object");
    let least = worst["cases"][0]["worst"].as_f64().expect("a margin");
    // The gain of the mirror is the only uncertain key, and its margin the least.
    assert!((least / (above * 0.25 / 0.5) - 1.0).abs() < 1e-3, "{least} {above} {worst}");
    dir.run("budget bench.toml").says(&["jitter"]);
}

#[test]
fn what_a_mirror_cannot_be_is_refused() {
    let holds = "[[requirement]]\nname = \"a\"\nholds = \"line_of_sight(detector) < 1e-6\"\n";
    for (text, words) in [
        (
            bench("computing_periods = 9\n"),
            &["line_of_sight[0].mirror.computing_periods", "at most 8, got 9"][..],
        ),
        (bench("stroke = 0.0\n"), &["line_of_sight[0].mirror.stroke", "positive"]),
        (bench("") + holds, &["requirement[0].holds", "`mirror`"]),
        (bench("").replace("damping = 0.6\n", ""), &["damping"]),
    ] {
        let error = Scenario::parse("bench.toml", &text).expect_err("refused").to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    let dir = Dir::new();
    for (from, to, words) in [
        ("gain = 0.25", "gain = 1.5", "mirror0"),
        ("period = \"1 ms\"", "period = \"1.3 ms\"", "line_of_sight[0].mirror.period"),
    ] {
        dir.write("bench.toml", bench("").replacen(from, to, 1));
        dir.run("spectrum bench.toml").exits(2).says(&[words]);
    }
    dir.write("bench.toml", bench("").replacen("gain = 0.25", "gain = 1.5", 1));
    dir.run("margins bench.toml").exits(2).says(&["mirror0"]);
}
