//! The attitude filter in the loop: gyro, star tracker, law and wheels on a three-axis body.

use flexsc_core::metrics::MetricsCollector;
use flexsc_core::{Scenario, Simulation};

/// A turn of 0.3 rad along a profile, with a late tracker.
const TURN: &str = "duration = 300.0
[body.spatial]
inertia = [[900.0, 20.0, 0.0], [20.0, 800.0, -10.0], [0.0, -10.0, 600.0]]
attitude = [0.8, 0.36, -0.48, 0.0]
points = [{ name = \"hub\" }]
[[sensor]]
gyro = { period = 0.25, angle_random_walk = 3e-6, rate_random_walk = 1e-8, bias = [1e-5, -2e-5, 5e-6] }
[[sensor]]
star_tracker = { period = 1.0, noise = [2.4e-5, 2.4e-5, 1.5e-4], axes = [0.8944271909999159, 0.0, 0.4472135954999579, 0.0], latency = 0.6 }
[estimator.attitude]
initial = { angle = 1e-3, bias = 1e-5 }
ASSESS
[law.attitude]
period = 0.25
bandwidth = 0.08
damping = 0.8
[actuator.wheels]
arrangement = \"pyramid\"
inertia = 0.04
torque = 0.4
[[target]]
from = 0.0
roll = 0.9
pitch = -0.8
yaw = 0.1
[[target]]
from = 120.0
roll = 0.9
pitch = -0.8
yaw = 0.4
acceleration = 2e-4
rate_limit = 8e-3
";

fn scenario(change: &[(&str, &str)]) -> Result<Scenario, String> {
    let mut text = TURN.to_owned();
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse("turn.toml", &text.replace("ASSESS", "")).map_err(|error| error.to_string())
}

fn metric(scenario: &Scenario, run: u64, names: &[&str]) -> Vec<f64> {
    let mut gather = MetricsCollector::new(scenario);
    Simulation::new(scenario, run).run(&mut gather).expect("valid");
    let metrics = gather.finish(scenario);
    names.iter().map(|name| metrics.number(name).unwrap_or_else(|| panic!("{name} {metrics:?}"))).collect()
}

#[test]
fn the_filter_is_as_good_as_it_says() {
    let scenario = scenario(&[]).expect("valid");
    let runs = 40;
    let mut sums = [0.0; 3];
    for run in 0..runs {
        let names = ["nees_mean", "nis_mean", "pointing_error_end_rad"];
        let found = metric(&scenario, run, &names);
        sums.iter_mut().zip(found).for_each(|(sum, found)| *sum += found / runs as f64);
    }
    let [nees, nis, pointing] = sums;
    // 299 innovations a run, three numbers each: 4 standard errors of a chi-square over its freedom are 4 sqrt(2/(40
    // 897)).
    assert!((nis - 1.0).abs() < 0.03, "{nis}");
    // Errors of one run are correlated: a few independent ones of six numbers a run, 4 sqrt(2/(40 6)).
    assert!((nees - 1.0).abs() < 0.37, "{nees}");
    assert!(pointing < 2e-4, "{pointing:e}");
}

/// A tracker with an exposure measures the mean attitude, which is that of its middle to 5e-6 rad while the turn
/// accelerates.
#[test]
fn a_mean_over_an_exposure_is_an_attitude_of_its_middle() {
    let exposed = scenario(&[("latency = 0.6", "latency = 0.6, exposure = 0.8")]).expect("valid");
    let names = ["nis_mean", "nees_mean", "attitude_estimate_error_rms_rad"];
    let [nis, nees, error] = means(&exposed, 40, names);
    // Four standard errors each, as above.
    assert!((nis - 1.0).abs() < 0.03 && (nees - 1.0).abs() < 0.37, "{nis} {nees}");
    // A standard error of a root mean square of 40 independent errors of six numbers: 1/sqrt(2 40 6) = 0.046.
    let [_, _, instant] = means(&scenario(&[]).expect("valid"), 40, names);
    assert!((error / instant - 1.0).abs() < 0.05 && error != instant, "{error:e} {instant:e}");
}

/// Returns the means of these metrics over runs.
fn means<const N: usize>(scenario: &Scenario, runs: u64, names: [&str; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for run in 0..runs {
        let found = metric(scenario, run, &names);
        sums.iter_mut().zip(found).for_each(|(sum, found)| *sum += found / runs as f64);
    }
    sums
}

/// A bias that wanders with a correlation time of 1000 s is, to a filter over 300 s, one that walks.
#[test]
fn a_bias_that_wanders_is_tracked() {
    let keys = "rate_random_walk = 1e-8, bias_instability = 2e-6, correlation_time = 1000";
    let wandering = scenario(&[("rate_random_walk = 1e-8", keys)]).expect("valid");
    let names = ["nees_mean", "nis_mean", "bias_estimate_error_rms_rad_s"];
    let [nees, nis, bias] = means(&wandering, 40, names);
    // Four standard errors each, as above.
    assert!((nis - 1.0).abs() < 0.03 && (nees - 1.0).abs() < 0.37, "{nis} {nees}");
    // A filter that does not model the wander trusts its bias too long.
    let deaf = scenario(&[
        ("rate_random_walk = 1e-8", keys),
        ("[estimator.attitude]\n", "[estimator.attitude]\nrate_random_walk = 1e-8\n"),
    ]);
    let [nees, _, worse] = means(&deaf.expect("valid"), 40, names);
    assert!(nees > 1.5 && worse > bias, "{nees} {worse:e} {bias:e}");
}

/// The filter uses the time stamps of late rates, and predicts from there. At rest a late gyro costs only its noise; a
/// filter that took the rates for current ones would show it in NIS during the turn.
#[test]
fn rates_of_a_late_gyro_are_of_when_they_were_measured() {
    let late = |periods: f64, assess: &str| {
        let keys = format!("gyro = {{ period = 0.25, latency = {},", 0.25 * periods);
        scenario(&[("gyro = { period = 0.25,", &keys), ("ASSESS", assess)]).expect("valid")
    };
    let names = ["nis_mean", "attitude_estimate_error_rms_rad", "pointing_error_end_rad"];
    let [nis, _, pointing] = means(&late(3.0, ""), 20, names);
    // Four standard errors of 20 runs: 4 sqrt(2/(20 897)) = 0.042.
    assert!((nis - 1.0).abs() < 0.042 && pointing < 2e-4, "{nis} {pointing:e}");
    let [[_, prompt, _], [_, delayed, _]] =
        [0.0, 3.0].map(|periods| means(&late(periods, "assess = [220.0, 300.0]"), 20, names));
    // A standard error and a half of a root mean square of 20 independent errors of six numbers: 1.5/sqrt(2
    // 20 6) = 0.097.
    assert!(delayed < 1.1 * prompt, "{prompt:e} {delayed:e}");
    // Samples without latency are reported at once.
    let error = ["attitude_estimate_error_rms_rad"];
    assert_eq!(metric(&late(0.0, ""), 3, &error), metric(&scenario(&[]).expect("valid"), 3, &error));
}

#[test]
fn what_no_gyro_can_be_is_refused() {
    for (keys, words) in [
        ("latency = 0.3", "`sensor[0].gyro.latency` must be a whole number of periods of 0.25 s, got 0.3 s"),
        ("latency = 2501", "must be at most 10000 periods, got 2501 s"),
        ("bias_instability = 1e-6", "correlation_time` must be given with `bias_instability`"),
        ("correlation_time = 100", "correlation_time` is that of `bias_instability`"),
        ("bias_instability = 1e-6, correlation_time = 0", "must be a positive number"),
    ] {
        let error = scenario(&[("rate_random_walk = 1e-8", keys)]).expect_err("refused");
        assert!(error.contains(words), "{error}");
    }
}

/// A loop whose analysis has no late rates has no spectral radius.
#[test]
fn loops_with_late_rates_are_not_analysed() {
    let text = |latency: &str| {
        format!(
            "duration = 10.0\n[body.planar]\ninertia = 100.0\nangle = 0.05\nmodes = [{{ frequency = 2.0, gain = 0.02 }}]\n\
             [sensor.gyro]\nperiod = 0.1\n{latency}\n[law.pd]\nperiod = 0.1\nk_p = 0.04\nk_d = 0.4\n"
        )
    };
    let radius = |latency: &str| {
        let scenario = Scenario::parse("loop.toml", &text(latency)).expect("valid");
        metric(&scenario, 0, &["spectral_radius"])[0]
    };
    assert!(radius("").is_finite());
    assert!(radius("latency = 0.2").is_nan());
}
