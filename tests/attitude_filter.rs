//! The filter in the loop: gyro, star tracker, law and wheels on a body with three axes.

use flexsc_core::metrics::Gather;
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
    let mut gather = Gather::new(scenario);
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
    // 299 innovations a run, three numbers each: 4 standard errors of a chi-square over its freedom are 4 sqrt(2/(40 897)).
    assert!((nis - 1.0).abs() < 0.03, "{nis}");
    // Errors of one run are correlated: a few independent ones of six numbers a run, 4 sqrt(2/(40 6)).
    assert!((nees - 1.0).abs() < 0.37, "{nees}");
    assert!(pointing < 2e-4, "{pointing:e}");
}
