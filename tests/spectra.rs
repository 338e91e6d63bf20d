//! Noise of closed loops against numbers of SciPy, of integrals and of closed forms, and against a long run.

use std::f64::consts::PI;

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::{
    LineLoop, LoadedLoop, NoiseError, NoiseReport, NoiseRequest, NoisyLoop, OutputLines, SpectralLine,
    Window, WindowRms, WindowVariances, WindowWeights, cumulative_rms,
};

use flexsc_core::record::Detail;

use crate::margins::wheel_loop;
use crate::open_loops::scenario;
use crate::traces::{column, flown};
use crate::util::Dir;

/// Returns the loop over four undamped modes with further keys of its sensor, and disturbances.
fn noisy_wheel(sensor: &str, disturbances: &str) -> NoisyLoop {
    let text = wheel_loop(0.0).replace("[body.planar]", &format!("{sensor}\n[body.planar]")) + disturbances;
    noisy(&Scenario::parse("wheel.toml", &text).expect("valid"))
}

fn noisy(scenario: &Scenario) -> NoisyLoop {
    NoisyLoop::from_scenario(scenario).expect("settles")
}

const SENSOR: &str = "sensor.sampled.noise = 1e-5";
const TORQUE: &str = "[[disturbance]]\nnoise = 1e-12\nperiod = 0.3\n";

/// Asserts that two numbers agree to a fraction of the second.
fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.15e}, expected {expected:.15e}");
}

fn sum(variances: &[f64]) -> f64 {
    variances.iter().sum()
}

/// Returns the standard deviation of an output at the samples of the law.
fn deviation(noisy: &NoisyLoop, name: &str) -> f64 {
    let output = noisy.output(name).expect(name);
    sum(&noisy.sample_variances(&[output])[0]).sqrt()
}

/// Numbers by `scipy.linalg.solve_discrete_lyapunov` for the loop of the papers' wheel.
#[test]
fn covariances_are_those_of_lyapunov_equations() {
    let sensor = noisy_wheel(SENSOR, "");
    assert_eq!(sensor.sources, ["sensor.sampled.noise"]);
    agree("radius", sensor.spectral_radius, 0.998_961_065_569_073, 1e-13);
    agree("angle", deviation(&sensor, "angle"), 1.949_935_526_168_48e-6, 1e-12);
    agree("command", deviation(&sensor, "command"), 3.989_439_609_768e-3, 1e-11);
    agree("mode", deviation(&sensor, "mode0_displacement"), 1.010_277_313_587_15e-6, 1e-11);
    agree("rate", deviation(&sensor, "rate"), 2.214_313_153_295e-6, 1e-11);
    let torque = noisy_wheel("", TORQUE);
    assert_eq!(torque.sources, ["disturbance[0].noise"]);
    agree("angle", deviation(&torque, "angle"), 5.719_332_749_569_22e-5, 1e-12);
    agree("command", deviation(&torque, "command"), 7.120_157_822_421e-4, 1e-11);
    agree("mode", deviation(&torque, "mode0_displacement"), 1.403_395_454_58e-5, 1e-11);
    let rounded = noisy_wheel("sensor.sampled.resolution = 1e-4", "");
    agree("angle", deviation(&rounded, "angle"), 5.628_979_004_679e-6, 1e-11);
    // All together: the variances add.
    let both = noisy_wheel(&format!("{SENSOR}\nsensor.sampled.resolution = 1e-4"), TORQUE);
    let parts = [&sensor, &rounded, &torque].map(|one| deviation(one, "angle"));
    let all = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    agree("all", deviation(&both, "angle"), all, 1e-12);
}

/// Draws that are held for a fiftieth of a sample are white noise: Van Loan's integral of it.
#[test]
fn short_draws_of_a_torque_are_white() {
    let torque = noisy_wheel("", &TORQUE.replace("0.3", "0.006"));
    agree("angle", deviation(&torque, "angle"), 5.719_646_138_22e-5, 5e-8);
}

#[test]
fn the_variance_between_samples_is_that_of_the_motion() {
    let sensor = noisy_wheel(SENSOR, "");
    let angle = sensor.output("angle").expect("exists");
    agree("middle", sum(&sensor.variance_at(angle, 0.15)).sqrt(), 1.951_620_694_515_91e-6, 1e-11);
    let mean = sum(&sensor.mean_variances(&[angle])[0]).sqrt();
    agree("mean", mean, 1.950_833_978_776_72e-6, 1e-11);
}

#[test]
fn the_density_has_its_values_and_its_integral() {
    let sensor = noisy_wheel(SENSOR, "");
    let angle = sensor.output("angle").expect("exists");
    let at = [0.05, 0.3, 1.0].map(|w: f64| w / std::f64::consts::TAU);
    let density = &sensor.densities(&[angle], &at)[0];
    for (found, expected) in
        density.total.iter().zip([2.001_902_954_400e-10, 5.974_526_009_691e-11, 5.973_431_121_050e-11])
    {
        agree("density", *found, expected, 1e-9);
    }
    let grid = sensor.frequency_grid();
    let total = &sensor.densities(&[angle], &grid)[0].total;
    let rms = cumulative_rms(&grid, total);
    agree("integral", *rms.last().expect("a grid"), 1.949_935_526e-6, 2e-4);
    assert!(grid.last().is_some_and(|last| (last * 0.6 - 1.0).abs() < 1e-12));
}

fn rms(each: &[WindowVariances], value: fn(&WindowVariances) -> f64) -> f64 {
    each.iter().map(value).sum::<f64>().sqrt()
}

/// Exposures by projection on polynomials, in Python with NumPy.
#[test]
fn exposures_have_displacement_smear_and_jitter() {
    let (sensor, torque) = (noisy_wheel(SENSOR, ""), noisy_wheel("", TORQUE));
    let cases = [
        (
            &sensor,
            [
                1.950_833_978_777e-6,
                1.691_009_411_275e-6,
                6.756_899_876e-7,
                6.997_738_380e-7,
                9.727_488_801e-7,
            ],
        ),
        (
            &torque,
            [
                5.719_335_413_621e-5,
                5.696_157_715_875e-5,
                4.864_028_010_720e-6,
                1.673_235_323_890e-6,
                5.143_781_190_737e-6,
            ],
        ),
    ];
    for (noisy, expected) in cases {
        let angle = noisy.output("angle").expect("exists");
        let window = Window { length: 3.0, separation: None };
        let each = noisy.window_variances(angle, window).expect("short");
        let found = [
            rms(&each, |index| index.total),
            rms(&each, |index| index.mpe),
            rms(&each, |index| index.smear),
            rms(&each, WindowVariances::beyond_smear),
            rms(&each, |index| index.rpe_uniform),
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            agree("exposure", found, expected, 2e-9);
        }
    }
    let angle = sensor.output("angle").expect("exists");
    let each = sensor.window_variances(angle, Window { length: 0.3, separation: None }).expect("short");
    agree("displacement", rms(&each, |index| index.mpe), 1.943_542_467_214e-6, 1e-11);
    agree("smear", rms(&each, |index| index.smear), 1.664_240_862_711e-7, 1e-9);
    agree("jitter", rms(&each, |index| index.rpe_uniform), 1.685_108_034_654e-7, 1e-9);
    let long = Window { length: 1e9, separation: None };
    assert!(sensor.window_variances(angle, long).is_err_and(|why| why.starts_with("window must be")));
}

#[test]
fn a_sine_has_weights_of_windows() {
    let window = Window { length: 10.0, separation: Some(60.0) };
    let weights = WindowWeights::new(2.0, window);
    agree("MPE", (0.5 * weights.mpe).sqrt(), 0.038_468_101_661_9, 1e-11);
    agree("RPE", (0.5 * weights.rpe_uniform).sqrt(), 0.706_059_632_86, 1e-11);
    agree("PDE", (0.5 * weights.pde).sqrt(), 0.023_450_971_920_3, 1e-11);
    // A slow sine drifts: its line has a mean square of s² T²/12.
    let slow = WindowWeights::new(1e-3, window);
    agree("smear", slow.smear, 1e-6 * 100.0 / 12.0, 1e-4);
}

/// The indices of lines are those of sines by quadrature: tests/golden/sine_indices_oracle.py.
#[test]
fn lines_have_the_indices_of_sines_over_windows() {
    let window = Window { length: 0.01, separation: Some(0.173) };
    #[rustfmt::skip]
    let golden = [
        (50.0 * PI, [0.636_619_772_367_581_3, 0.307_758_453_061_242_4, 0.518_329_009_608_539_8, 0.070_487_008_818_966_18, 0.301_289_712_768_781_2, 0.062_767_622_309_230_91, 1.085_615_174_685_118_7]),
        (30.0, [0.704_458_112_266_237_5, 0.061_145_466_408_304_61, 0.105_801_117_195_955_5, 0.002_648_668_920_310_013, 0.061_099_570_444_550_14, 0.002_368_660_756_748_819, 0.732_325_565_003_317_7]),
        (600.0, [0.033_262_304_886_744_12, 0.706_324_018_474_256_1, 0.740_051_100_010_127_5, 0.673_844_476_299_803_4, 0.423_366_744_989_412_7, 0.565_379_711_619_271_7, 0.066_389_597_425_165_65]),
    ];
    let values = |of: WindowRms| {
        let pde = of.pde.expect("a separation");
        [of.mpe, of.rpe_uniform, of.rpe_end, of.rpe_middle, of.smear, of.beyond_smear, pde]
    };
    let line = |frequency_rad_s: f64, amplitude: f64| SpectralLine { frequency_rad_s, amplitude };
    let mut squares = [0.0; 7];
    for (frequency, expected) in golden {
        let found = values(WindowRms::from_lines([line(frequency, 2.0)].into_iter(), window));
        for ((found, expected), square) in found.into_iter().zip(expected).zip(&mut squares) {
            agree("index", found, 2.0 * expected, 1e-11);
            *square += expected * expected;
        }
    }
    let all = golden.map(|(frequency, _)| line(frequency, 1.0));
    for (found, square) in values(WindowRms::from_lines(all.into_iter(), window)).into_iter().zip(squares) {
        agree("all", found, square.sqrt(), 1e-11);
    }
}

/// Closed loop under a torque that turns, by the sum over aliases and by integration.
#[test]
fn a_torque_that_turns_has_a_line_and_aliases() {
    let text = wheel_loop(0.0);
    let scenario = Scenario::parse("wheel.toml", &text).expect("valid");
    let lines = LineLoop::from_scenario(&scenario).expect("linear");
    let angle = [noisy_wheel(SENSOR, "").output("angle").expect("exists")];
    let loaded = LoadedLoop::new(&lines, &angle, &[lines.torque(0)]).expect("loads");
    let found = OutputLines::new(loaded.lines(22.0).expect("damped").remove(0).remove(0), 1.0);
    agree("direct", found.direct.amplitude, 0.007_317_976_819_283, 1e-11);
    assert_eq!(found.direct.frequency_rad_s, 22.0);
    let alias = found.aliases[0];
    agree("alias", alias.amplitude, 0.001_334_053_428_643, 1e-10);
    agree("at", alias.frequency_rad_s, 1.056_049, 1e-6);
}

#[test]
fn a_loop_without_a_spectrum_is_refused() {
    let fault = |text: &str| {
        let scenario = Scenario::parse("s.toml", text).expect("valid");
        NoisyLoop::from_scenario(&scenario).expect_err("refused").to_string()
    };
    let relay = NoisyLoop::from_scenario(&scenario("relay-fixed")).expect_err("a relay");
    assert!(matches!(&relay, NoiseError::Key(fault) if fault.key == "law.relay"), "{relay}");
    let unstable = NoisyLoop::from_scenario(&scenario("wheel-unstable-band")).expect_err("unstable");
    assert!(unstable.to_string().contains("not stable and has no spectrum"), "{unstable}");
    let gyro = wheel_loop(0.0)
        .replace("sensor.sampled.period = 0.3", "sensor.gyro = { period = 0.3, angle_random_walk = 1e-6 }");
    assert!(fault(&gyro).contains("integrates the rate"), "{}", fault(&gyro));
    let odd = wheel_loop(0.0) + &TORQUE.replace("0.3", "0.1234567");
    assert!(fault(&odd).contains("disturbance[0].noise"), "{}", fault(&odd));
}

#[test]
fn every_shipped_loop_has_a_spectrum_whose_integral_is_its_variance() {
    let mut count = 0;
    for name in ["attitude-hold", "earth-observer", "earth-observer-lqg", "slew-wheel-lqg"] {
        let noisy = noisy(&scenario(name));
        let outputs = noisy.first_outputs();
        let report = NoiseReport::new(&noisy, &outputs, None).expect("no window");
        for output in &report.outputs {
            let last = output.cumulative_rms.last().copied().unwrap_or(0.0);
            agree(&format!("{name} {}", output.output), last, output.sample_rms, 2e-3);
            assert!((output.rms / output.sample_rms - 1.0).abs() < 0.2, "{output:?}");
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
}

/// Expectations of Welch's estimate by sums over the autocovariance, in Python with NumPy.
#[test]
fn a_wide_bin_lowers_the_estimate_of_welch() {
    let sensor = noisy_wheel(SENSOR, "");
    let angle = sensor.output("angle").expect("exists");
    for (length, bin, expected, density) in [
        (2048, 98.0, 3.393_959_374_8e-11, 6.620_669_675_3e-11),
        (8192, 391.0, 5.159_327_095_7e-11, 5.479_778_681_3e-11),
        (512, 49.0, 4.134_100_945_0e-11, 8.150_863_023_3e-11),
    ] {
        let frequency = bin / (f64::from(length) * 0.3);
        let found = sensor.welch_expectation(angle, length as usize, &[frequency])[0];
        agree("expectation", found, expected, 1e-9);
        agree("density", sensor.densities(&[angle], &[frequency])[0].total[0], density, 1e-9);
    }
    let peak = sensor.narrowest_peak().expect("modes");
    agree("decay", peak.width * std::f64::consts::PI * 0.3, -(0.998_961_065_569_073_f64.ln()), 1e-9);
    assert!((17_000.0..20_000.0).contains(&peak.segment), "{peak:?}");
    let variance = sum(&sensor.sample_variances(&[angle])[0]);
    agree("variance", sensor.autocovariance(angle, 3)[0], variance, 1e-12);
}

/// Noise of three axes, and of a loop with a Kalman filter, by SciPy: `tests/golden/noise_reference.py`.
#[test]
fn deviations_are_those_of_scipy() {
    let path = format!("{}/../../tests/golden/noise.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("golden");
    let loops = ["attitude-hold", "slew-wheel-lqg"].map(|name| (name, noisy(&scenario(name))));
    let mut rows = 0;
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, output, source, deviation] = cells[..] else { panic!("{line}") };
        let (_, noisy) = loops.iter().find(|(own, _)| *own == name).expect(name);
        let output = noisy.output(output).expect(output);
        let found = match noisy.sources.iter().position(|key| key == source) {
            Some(source) => noisy.sample_variances(&[output])[0][source].sqrt(),
            None => sum(&noisy.variance_at(output, 0.1)).sqrt(),
        };
        agree(line, found, deviation.parse().expect("a number"), 1e-9);
        rows += 1;
    }
    assert_eq!(rows, 20);
}

/// Asserts that the mean square of the samples of a run is the variance, within three standard errors of its estimate.
fn run_agrees(noisy: &NoisyLoop, name: &str, samples: &[f64]) {
    let output = noisy.output(name).expect(name);
    let lags = samples.len() / 4;
    let covariance = noisy.autocovariance(output, lags);
    let beyond: f64 = covariance[1..].iter().map(|value| value * value).sum();
    let count = samples.len() as f64;
    let error = (2.0 / count * (covariance[0] * covariance[0] + 2.0 * beyond)).sqrt();
    let found = samples.iter().map(|value| value * value).sum::<f64>() / count;
    assert!((found - covariance[0]).abs() < 3.0 * error, "{name}: {found:e} {:e} {error:e}", covariance[0]);
    assert!(error < 0.2 * covariance[0], "{name}: {error:e} of {:e}", covariance[0]);
}

/// Runs of the engine, from 20 times the slowest time constant on.
#[test]
fn long_runs_have_the_variances_within_their_error() {
    let text = wheel_loop(0.0)
        .replace(
            "sensor.sampled.period",
            "sensor.sampled.noise = 1e-5\nlog.period = 0.3\nsensor.sampled.period",
        )
        .replace("angle = 0.06", "angle = 0.0")
        .replace("duration = 600.0", "duration = 9000.0");
    let wheel = Scenario::parse("wheel.toml", &text).expect("valid");
    let (_, trace) = flown(&wheel, 0, Detail::Full);
    run_agrees(&noisy(&wheel), "angle", &column(&trace, "/attitude", "angle_rad")[3000..]);
}

/// A mode of the panels at 92.9 rad/s, which turns the hub about yaw.
#[test]
fn unbalanced_wheels_excite_a_mode_at_its_frequency() {
    let request = NoiseRequest { speeds: Some(vec![46.45, 70.0, 92.9]), ..NoiseRequest::default() };
    let report = NoiseReport::from_scenario(&scenario("wheel-run-up"), &request).expect("linear");
    let wheels = report.wheels.expect("imbalance");
    assert_eq!(wheels.lines.len(), 3 * 8);
    let yaw = report.outputs.iter().position(|output| output.output == "yaw").expect("an axis");
    let rms = &wheels.rms[yaw];
    assert!(rms[2] > 3.0 * rms[1], "{rms:?}");
    let strongest = wheels
        .lines
        .iter()
        .max_by(|a, b| a.outputs[yaw].direct.amplitude.total_cmp(&b.outputs[yaw].direct.amplitude));
    let strongest = strongest.expect("lines");
    assert_eq!((strongest.speed_rad_s, strongest.order, strongest.wheel), (92.9, 1.0, 1));
    // The Nyquist frequency of the law is 12.566 rad/s.
    assert!(strongest.outputs[yaw].aliases[0].frequency_rad_s < 12.567);
}

/// Lines over a window, in every form: the direct line, at 92.9 rad/s, is the largest.
#[test]
fn lines_of_wheels_have_indices_over_speed() {
    let dir = Dir::with(&["wheel-run-up"]);
    let line = "spectrum wheel-run-up.toml --signal yaw --window 0.02 --speeds 46.45:92.9:3";
    let report = dir.run(&format!("{line} --json")).exits(0).json();
    let wheels = &report["wheels"];
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    for speed in 0..3 {
        let mut expected = 0.0;
        for of_wheel in &wheels["lines"].as_array().expect("lines")[8 * speed..8 * (speed + 1)] {
            let output = &of_wheel["outputs"][0];
            for line in output["aliases"].as_array().expect("aliases").iter().chain([&output["direct"]]) {
                let (u, amplitude) = (0.01 * number(&line["frequency_rad_s"]), number(&line["amplitude"]));
                let mean = u.sin() / u;
                expected += 0.5 * amplitude * amplitude * (1.0 - mean * mean);
            }
        }
        agree("RPE", number(&wheels["windows"][0][speed]["rpe_uniform"]), expected.sqrt(), 1e-9);
    }
    let text = dir.run(line).exits(0);
    text.says(&["indices of these lines over windows of 20 ms", "887.1 rpm"]);
    dir.run(&format!("{line} -o lines.csv")).exits(0);
    let table = String::from_utf8(dir.read("lines.csv")).expect("text");
    assert!(table.starts_with("speed_rad_s,yaw_rms,yaw_mpe,yaw_rpe_uniform,yaw_rpe_end"), "{table}");
    assert_eq!(table.lines().count(), 4);
    dir.run(&format!("{line} -o figures")).exits(0);
    let figure = String::from_utf8(dir.read("figures/wheel-run-up-waterfall_yaw.svg")).expect("text");
    for words in
        ["within windows of 20 ms, rms", "all frequencies, rms", "wheel speed (rpm)", "frequency (Hz)"]
    {
        assert!(figure.contains(words), "{words}");
    }
}

/// Of weak motion the contrast loses 2 pi² n² times the variance about the mean of the exposure; lines lose by Bessel functions, here
/// the means of cos(x sin p) over p.
#[test]
fn motion_takes_contrast_from_an_image() {
    let dir = Dir::with(&["earth-observer", "wheel-run-up"]);
    let pixel = 1e-3;
    let loss = 2.0 * (PI * 0.5 / pixel) * (PI * 0.5 / pixel);
    let line = format!("spectrum earth-observer.toml --pixel {pixel}");
    for (window, key) in [("--window 2", Some("rpe_uniform")), ("", None)] {
        let report = dir.run(&format!("{line} {window} --json")).exits(0).json();
        for output in report["outputs"].as_array().expect("outputs") {
            let rms = key.map_or(&output["rms"], |key| &output["window"][key]).as_f64().expect("a number");
            let mtf = output["mtf"].as_f64().expect("a contrast");
            agree("loss", 1.0 - mtf, loss * rms * rms, 2e-3);
        }
    }
    let report =
        dir.run("spectrum wheel-run-up.toml --pixel 1e-4 --speeds 46.45:92.9:3 --json").exits(0).json();
    let wheels = &report["wheels"];
    let bessel =
        |x: f64| (0..400).map(|k| (x * (PI * (f64::from(k) + 0.5) / 400.0).sin()).cos()).sum::<f64>() / 400.0;
    for speed in 0..3 {
        let mut expected = 1.0;
        for of_wheel in &wheels["lines"].as_array().expect("lines")[8 * speed..8 * (speed + 1)] {
            let output = &of_wheel["outputs"][0];
            for line in output["aliases"].as_array().expect("aliases").iter().chain([&output["direct"]]) {
                expected *= bessel(PI / 1e-4 * line["amplitude"].as_f64().expect("a number"));
            }
        }
        let found = wheels["mtf"][0][speed].as_f64().expect("a contrast");
        assert!((found - expected).abs() < 1e-12 && found < 1.0, "{found} {expected}");
    }
    let text = dir.run("spectrum wheel-run-up.toml --window 10ms --pixel 2arcsec").exits(0);
    text.says(&["over exposures of 10 ms, at the Nyquist frequency of pixels of 2 arcsec", "888.1"]);
    dir.run("spectrum wheel-run-up.toml --pixel 0")
        .exits(2)
        .says(&["--pixel must be ", "to 57.3 deg, got 0 deg"]);
    let command = "spectrum wheel-run-up.toml --signal command_roll --pixel 1e-5";
    dir.run(command).exits(2).says(&["--pixel needs an output that is an angle"]);
}

/// The lines of wheels that turn near a multiple of a sampling rate have slow aliases, which the loop follows: narrow peaks. A grid
/// that is dense there has none that the default speeds pass by, and the text lists them.
#[test]
fn peaks_at_aliases_are_among_the_default_speeds() {
    let dir = Dir::with(&["wheel-run-up"]);
    let spectrum = |speeds: &str| -> Vec<(f64, f64)> {
        let line = format!("spectrum wheel-run-up.toml --signal yaw {speeds} --json");
        let wheels = dir.run(&line).exits(0).json()["wheels"].clone();
        let list = |of: &serde_json::Value| -> Vec<f64> {
            of.as_array().expect("a list").iter().map(|value| value.as_f64().expect("finite")).collect()
        };
        list(&wheels["speed_rad_s"]).into_iter().zip(list(&wheels["rms"][0])).collect()
    };
    let own = spectrum("");
    let rate = dir.run("margins wheel-run-up.toml --json").exits(0).json();
    let rate = rate["samples"].as_f64().expect("a number") / rate["period_s"].as_f64().expect("a number");
    let largest = own.iter().map(|(speed, _)| *speed).fold(0.0, f64::max);
    let mut aliases = 0;
    for turn in 1..=3 {
        let centre = std::f64::consts::TAU * rate * f64::from(turn);
        if 1.02 * centre > largest || 0.98 * centre < own[0].0 {
            continue;
        }
        let around = |all: &[(f64, f64)]| {
            let near = all.iter().filter(|(speed, _)| (speed / centre - 1.0).abs() < 0.02);
            near.map(|(_, rms)| *rms).fold(0.0, f64::max)
        };
        let dense = spectrum(&format!("--speeds {}:{}:1999", 0.98 * centre, 1.02 * centre));
        let (found, exact) = (around(&own), around(&dense));
        assert!(found > 0.97 * exact, "{centre} rad/s: {found}, {exact}");
        aliases += 1;
    }
    assert!(aliases > 0, "{rate} Hz, up to {largest} rad/s");
}

/// The pointing errors of a log are those of the mean axes of this body, and not the angles at its sensor, which modes turn.
#[test]
fn a_log_on_three_axes_has_the_density_of_its_own_angle() {
    let dir = Dir::with(&["attitude-hold"]);
    dir.run(
        "simulate attitude-hold.toml --set target=[] --set duration=3000 --set log.period=0.2 --log full",
    )
    .exits(0);
    let line = "spectrum attitude-hold.toml --log attitude-hold.mcap --from 100 --segment 512 --json";
    let compared = dir.run(line).exits(0).json();
    for (axis, name) in ["roll", "pitch", "yaw"].into_iter().enumerate() {
        let estimate = &compared["welch"][axis];
        assert_eq!(estimate["output"], format!("{name}_error"));
        assert_eq!(estimate["column"], format!("/pointing {name}_error_rad"));
        let list = |of: &serde_json::Value| -> Vec<f64> {
            of.as_array().expect("a list").iter().map(|value| value.as_f64().expect("finite")).collect()
        };
        let (density, expected) = (list(&estimate["density"]), list(&estimate["expectation"]));
        let interval = list(&estimate["interval"]);
        let is_within = |(found, exact): (&f64, &f64)| (interval[0]..interval[1]).contains(&(exact / found));
        let within = density.iter().zip(&expected).filter(|pair| is_within(*pair)).count();
        let part = within as f64 / density.len() as f64;
        assert!((0.84..0.96).contains(&part), "{name}: {part}");
    }
    dir.run(&format!("{line} --signal roll"))
        .exits(2)
        .says(&["has no column of these outputs", "roll_error"]);
}
