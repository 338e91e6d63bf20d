//! Magnetic control in whole scenarios: momentum, decay rates, detumbling, filters of vectors, targets of the orbit.

use flexsc_core::metrics::{MetricValue, MetricsCollector};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::traces::{column, flown, traced, within};
use crate::util::SCENARIOS;

/// A column of rows along three axes.
fn along(trace: &Trace, topic: &str, field: &str) -> Vec<[f64; 3]> {
    let list = if topic == "/wheels" { "wheels" } else { "axes" };
    within(trace, topic, list, field).chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect()
}

fn norm(of: &[f64; 3]) -> f64 {
    of.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn shipped(name: &str, change: &[(&str, &str)]) -> Scenario {
    let mut text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file");
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse(&format!("{name}.toml"), &text).expect("a scenario")
}

/// An inertial hold by wheels that torquers unload, in a field without a tilt, which turns at twice the orbit's rate.
const HOLD: &str = "duration = 5828.0\nsensor = { gyro = { period = 0.5 } }\n\
    law = { attitude = { period = 0.5, bandwidth = 0.1 } }\nlog = { period = 20.0 }\n\
    [spacecraft]\nmass = 100.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
    [environment]\norbit = { semi_major_axis = 7e6, inclination = 1.2, node = 0.4 }\n\
    magnetic_field = { coefficients = [0, 0, -3e-5] }\n\
    [actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.002\nspeeds = [200, -150, 100]\n\
    unloading = { above = 1e-3, below = 1e-4, magnetorquers = { moment = 1000.0 }, gain = 2e-4, period = 1.0 }\n";

/// H' = -k (1 - b b') H, with b of the untilted dipole by hand, by steps of the fourth order.
fn decayed(momentum: [f64; 3], gain: f64, until: f64) -> [f64; 3] {
    let rate = (3.986_004_418e14_f64 / 7e6_f64.powi(3)).sqrt();
    let change = |t: f64, h: &[f64; 3]| {
        let u = rate * t;
        // The body is where the orbit has the angle u from its node: its direction, and the dipole's south.
        let (node, inclination) = (0.4_f64, 1.2_f64);
        let [c, s] = [u.cos(), u.sin()];
        let [cn, sn, ci, si] = [node.cos(), node.sin(), inclination.cos(), inclination.sin()];
        let up = [cn * c - sn * ci * s, sn * c + cn * ci * s, si * s];
        let field = [-3.0 * up[2] * up[0], -3.0 * up[2] * up[1], 1.0 - 3.0 * up[2] * up[2]];
        let (length, part) = (norm(&field), dot(&field, h));
        [0, 1, 2].map(|axis| -gain * (h[axis] - field[axis] * part / (length * length)))
    };
    let (mut h, steps) = (momentum, 2000);
    let step = until / f64::from(steps);
    let plus = |h: &[f64; 3], k: &[f64; 3], by: f64| [0, 1, 2].map(|axis| h[axis] + by * k[axis]);
    for index in 0..steps {
        let t = step * f64::from(index);
        let a = change(t, &h);
        let b = change(t + 0.5 * step, &plus(&h, &a, 0.5 * step));
        let c = change(t + 0.5 * step, &plus(&h, &b, 0.5 * step));
        let d = change(t + step, &plus(&h, &c, step));
        h = [0, 1, 2].map(|axis| h[axis] + step / 6.0 * (a[axis] + 2.0 * (b[axis] + c[axis]) + d[axis]));
    }
    h
}

/// Over an orbit the wheels lose what the cross-product law takes of them: the part across the field at the gain.
#[test]
fn wheels_lose_their_momentum_at_the_mean_rate_across_the_field() {
    let scenario = Scenario::parse("hold.toml", HOLD).expect("a scenario");
    let (metrics, trace) = flown(&scenario, 0, Detail::Full);
    let momenta = along(&trace, "/wheels", "momentum_nm_s");
    let (first, last) = (momenta[0], momenta.last().expect("rows"));
    assert!((first[0] - 0.4).abs() < 1e-12 && (first[1] + 0.3).abs() < 1e-12);
    let exact = decayed(first, 2e-4, 20.0 * (momenta.len() - 1) as f64);
    // Commands once a second are of the field then: k T/2 of what is taken.
    for axis in 0..3 {
        assert!((last[axis] - exact[axis]).abs() < 3e-4 * norm(&first), "{last:?} {exact:?}");
    }
    // About two thirds of the gain on the mean.
    let mean = (norm(&first) / norm(last)).ln() / 5828.0 / 2e-4;
    assert!((0.4..0.9).contains(&mean), "{mean}");
    let peak = metrics.number("wheel_momentum_peak_nm_s").expect("a number");
    assert!(
        (peak - norm(&first)).abs() < 1e-9
            && metrics.number("wheel_momentum_end_nm_s").expect("a number") < peak
    );
    // The torque that is logged is moment times field at that instant, and the field is what the body sees of it.
    let (moments, fields) =
        (along(&trace, "/magnetorquers", "moment_am2"), along(&trace, "/orbit", "field_t"));
    let (torques, wheels) = (along(&trace, "/torques", "applied_nm"), along(&trace, "/wheels", "torque_nm"));
    for row in 0..moments.len() {
        let magnetic = cross(&moments[row], &fields[row]);
        for axis in 0..3 {
            assert!((torques[row][axis] + wheels[row][axis] - magnetic[axis]).abs() < 1e-17);
        }
    }
}

/// Magnetorquers alone on a tumbling body: under the B-dot law they never add energy, but for its samples, and the
/// remaining rate is about that of the field.
#[test]
fn the_b_dot_law_takes_the_rotation_away() {
    let text = "duration = 12000.0\nsensor = { magnetometer = { period = 1.0 } }\n\
        law = { b_dot = { period = 1.0, gain = 4e5 } }\nactuator = { magnetorquers = { moment = 3.0 } }\nlog = { period = 20.0 }\n\
        [spacecraft]\nmass = 20.0\ninertia = [[0.4, 0.01, 0], [0.01, 0.45, 0], [0, 0, 0.3]]\nrate = [0.02, -0.03, 0.025]\n\
        [environment]\norbit = { semi_major_axis = 6.928e6, inclination = 1.7 }\nmagnetic_field = {}\n";
    let (metrics, trace) = flown(&Scenario::parse("tumble.toml", text).expect("a scenario"), 0, Detail::Full);
    let energy = column(&trace, "/energy", "rotational_j");
    let first = energy[0];
    let early = energy.windows(2).take(100);
    assert!(early.clone().all(|pair| pair[1] < pair[0]), "{energy:?}");
    let rate = metrics.number("rate_end_rad_s").expect("a number");
    // Twice the rate of the orbit is 2.2e-3 rad/s.
    assert!(rate < 4e-3, "{rate}");
    assert!(energy.last().expect("rows") < &(0.02 * first));
    let moments = along(&trace, "/magnetorquers", "moment_am2");
    assert!(moments.iter().flatten().all(|moment| moment.abs() <= 3.0));
    // The first change of energy is the work of -k B² times the rate across the field, on the mean.
    let field = along(&trace, "/orbit", "field_t");
    let rows = 12;
    let rates = along(&trace, "/rates", "rigid_rad_s");
    let across = |row: usize| norm(&cross(&rates[row], &field[row]));
    let work: f64 = (0..rows).map(|row| 4e5 * across(row).powi(2) * 20.0).sum();
    let lost = first - energy[rows];
    // The rate at the start of each 20 s, in which it falls: 5 % too much work.
    assert!((0.0..0.06).contains(&(work / lost - 1.0)), "{work} {lost}");
}

/// Laws along and across the field: torquers give an attitude law what is across.
#[test]
fn an_attitude_law_points_by_torquers_alone() {
    let text = "duration = 30000.0\nsensor = { gyro = { period = 1.0 } }\n\
        law = { attitude = { period = 1.0, bandwidth = 2e-3, damping = 1.0 } }\nactuator = { magnetorquers = { moment = 3.0 } }\n\
        log = { period = 50.0 }\n[spacecraft]\nmass = 20.0\ninertia = [[0.4, 0, 0], [0, 0.45, 0], [0, 0, 0.3]]\n\
        attitude = [0.995, 0.0998333, 0, 0]\n\
        [environment]\norbit = { semi_major_axis = 6.928e6, inclination = 1.7 }\nmagnetic_field = {}\n";
    let text = text.replace("[0.995, 0.0998333, 0, 0]", "[0.9950041652780258, 0.09983341664682815, 0, 0]");
    let (metrics, _) = flown(&Scenario::parse("torquers.toml", &text).expect("a scenario"), 0, Detail::Full);
    let error = metrics.number("pointing_error_end_rad").expect("a number");
    assert!(error < 1e-6, "{error}");
}

#[test]
fn the_small_satellite_does_what_its_comment_says() {
    let scenario = shipped("detumble-and-point", &[]);
    for run in 0..3 {
        let (metrics, trace) = flown(&scenario, run, Detail::Full);
        assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")), "run {run}");
        let rates = along(&trace, "/rates", "rigid_rad_s");
        // Rows come every 5 s: the end of the detumbling, and that of the run.
        assert!(norm(&rates[0]) > 0.05 && norm(&rates[1199]) < 5e-3, "run {run}: {}", norm(&rates[1199]));
        assert!(metrics.number("pointing_error_end_rad").expect("a number") < 0.01, "run {run}");
        assert!(metrics.number("wheel_momentum_end_nm_s").expect("a number") < 6e-3, "run {run}");
    }
}

/// The estimated covariance of a filter of a gyro, a magnetometer and a Sun sensor is correct, over many runs.
#[test]
fn a_filter_of_vectors_is_as_good_as_it_says() {
    let scenario = shipped(
        "detumble-and-point",
        &[("duration = 12000.0", "duration = 2500.0"), ("[600.0, 12000.0]", "[600.0, 2500.0]")],
    );
    let runs = 50;
    let mut sums = [0.0; 2];
    for run in 0..runs {
        let mut gather = MetricsCollector::new(&scenario);
        Simulation::new(&scenario, run).run(&mut gather).expect("a run");
        let metrics = gather.finish(&scenario);
        for (sum, name) in sums.iter_mut().zip(["nees_mean", "nis_mean"]) {
            *sum += metrics.number(name).expect(name) / runs as f64;
        }
    }
    let [nees, nis] = sums;
    // Errors of a run are hardly independent: 6 numbers and a handful of correlation times a run, 50 runs:
    // 0.15 is four standard errors of five times as many, sqrt(2/(5 6 50)) = 0.037.
    assert!((nees - 1.0).abs() < 0.15, "NEES {nees}");
    assert!((nis - 1.0).abs() < 0.02, "NIS {nis}");
}

/// With constant gains the covariance is that of the errors which they leave, over many runs.
#[test]
fn filters_with_constant_gains_are_as_good_as_they_say() {
    for form in ["\"steady\"", "{ complementary = { bandwidth = 0.02 } }"] {
        let keys = format!("[estimator.attitude]\nform = {form}");
        let scenario = shipped(
            "earth-observer",
            &[("[estimator.attitude]", &keys), ("duration = 300.0", "seed = 9\nduration = 300.0")],
        );
        let runs = 40;
        let mut sums = [0.0; 2];
        for run in 0..runs {
            let mut gather = MetricsCollector::new(&scenario);
            Simulation::new(&scenario, run).run(&mut gather).expect("a run");
            let metrics = gather.finish(&scenario);
            for (sum, name) in sums.iter_mut().zip(["nees_mean", "nis_mean"]) {
                *sum += metrics.number(name).expect(name) / runs as f64;
            }
        }
        // Slow filters: the errors of a run are few numbers, with a standard deviation of 0.45 over the runs.
        // 0.2 is 2.8 standard errors, 0.45/sqrt(40) = 0.071.
        assert!(sums.iter().all(|mean| (mean - 1.0).abs() < 0.2), "{form}: NEES and NIS {sums:?}");
    }
}

#[test]
fn the_observer_keeps_its_wheels_empty_by_torquers() {
    let (metrics, trace) = flown(&shipped("magnetic-unloading", &[]), 0, Detail::Full);
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
    let momenta = along(&trace, "/wheels", "momentum_nm_s");
    let most = momenta.iter().map(norm).fold(0.0, f64::max);
    assert!((0.06..0.12).contains(&most), "{most}");
    let without = shipped("magnetic-unloading", &[("gain = 2e-3  ", "gain = 1e-9  ")]);
    let (metrics, _) = flown(&without, 0, Detail::Full);
    assert!(metrics.number("wheel_momentum_peak_nm_s").expect("a number") > 0.3);
}

/// An appendage that cools at the edge of the shadow: an oscillator under an exponential, in closed form.
#[test]
fn an_appendage_snaps_as_its_closed_form_does() {
    let (m, t, o, eta, tau) = (100.0, 2.0, 1.3, 0.05, 4.0_f64);
    let text = format!(
        "duration = 120.0\nlaw = {{ open = {{}} }}\nlog = {{ period = 0.5 }}\n\
         [spacecraft]\nmass = 90.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
         [[appendage]]\nname = \"mass\"\nmass = 10.0\nmodes = [{{ frequency = {o}, translation = [0, 0, {t}] }}]\n\
         thermal = {{ deflection = [{eta}], time_constant = {tau} }}\n\
         [environment]\norbit = {{ semi_major_axis = 7e6, anomaly = 1.97 }}\nsun = [1, 0, 0]\nshadow = \"cylinder\"\n"
    );
    let trace = traced(&Scenario::parse("snap.toml", &text).expect("a scenario"));
    let found = within(&trace, "/vibrations", "modes", "displacement");
    // One free mode: E = 1 - t²/m, W = O/sqrt(E), Y = 1/sqrt(E); the force is Y O² eta.
    let e = 1.0_f64 - t * t / m;
    let (w, force) = (o / e.sqrt(), o * o * eta / e.sqrt());
    let rate = (3.986_004_418e14_f64 / 7e6_f64.powi(3)).sqrt();
    let edge = (std::f64::consts::PI - (6_378_137.0_f64 / 7e6).asin() - 1.97) / rate;
    assert!((10.0..60.0).contains(&edge), "{edge}");
    let (a, b) = (-force / (w * w), force / (1.0 / (tau * tau) + w * w));
    let mut most = 0.0_f64;
    for (row, found) in found.iter().enumerate() {
        let s = 0.5 * row as f64 - edge;
        let exact = if s < 0.0 {
            0.0
        } else {
            let (sin, cos) = (w * s).sin_cos();
            a + b * (-s / tau).exp() - (a + b) * cos + b / (tau * w) * sin
        };
        assert!((found - exact).abs() < 1e-9, "{s} {found} {exact}");
        most = most.max(exact.abs());
    }
    assert!(most > 0.05, "{most}");
    let error = Scenario::parse("dark.toml", &text.replace("sun = [1, 0, 0]\nshadow = \"cylinder\"", ""))
        .expect_err("no Sun")
        .to_string();
    assert!(error.contains("`appendage[0].thermal`") && error.contains("environment.sun"), "{error}");
    let error =
        Scenario::parse("two.toml", &text.replace("[0.05]", "[0.05, 1]")).expect_err("two").to_string();
    assert!(error.contains("appendage[0].thermal.deflection") && error.contains("1 mode, got 2"), "{error}");
}

/// A table in the axes of an orbit that is no circle: what is left of rate and acceleration fed forward is the hold of
/// a sample, and falls with its period.
#[test]
fn a_table_on_an_orbit_is_followed_to_the_hold_of_a_sample() {
    let worst = |period: f64| {
        let text = format!(
            "duration = 300.0\nlog = {{ period = 0.5 }}\nlaw = {{ attitude = {{ period = {period}, bandwidth = 0.1 }} }}\n\
             target = [{{ from = 0, frame = \"nadir\" }}, {{ from = 180, frame = \"nadir\", table = [{{ time = 0 }}, \
             {{ time = 30, roll = 0.3 }}, {{ time = 60, roll = -0.3, yaw = 0.2 }}, {{ time = 100 }}] }}]\n\
             [spacecraft]\nmass = 100.0\ninertia = [[30, 1, 0], [1, 40, 2], [0, 2, 35]]\nattitude = [0.5, 0.5, 0.5, 0.5]\n\
             [environment]\norbit = {{ semi_major_axis = 7.0e6, inclination = 1.2, node = 0.3, eccentricity = 0.05 }}\n"
        );
        let trace = traced(&Scenario::parse("table.toml", &text).expect("a scenario"));
        let errors = ["roll", "pitch", "yaw"]
            .map(|axis| column(&trace, "/pointing", &format!("{axis}_error_rad"))[360..].to_vec());
        errors.iter().flatten().fold(0.0_f64, |most, error| most.max(error.abs()))
    };
    let [coarse, fine] = [0.25, 0.025].map(worst);
    // Half a period late, the acceleration of the table, at most 0.3 rad in 30 s: 2e-3 rad.
    assert!((1e-3..3e-3).contains(&coarse), "{coarse}");
    assert!((9.5..10.5).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = |changes: &[(&str, &str)], words: &[&str]| {
        let mut text = HOLD.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let error = Scenario::parse("bad.toml", &text).expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let field = "magnetic_field = { coefficients = [0, 0, -3e-5] }";
    refused(&[(field, "")], &["`actuator.wheels.unloading.magnetorquers`", "environment.magnetic_field"]);
    refused(
        &[("orbit = { semi_major_axis = 7e6, inclination = 1.2, node = 0.4 }", "")],
        &["`environment.magnetic_field`", "`orbit`"],
    );
    refused(
        &[("duration = 5828.0", "duration = 1e11"), ("[environment]\n", "[environment]\nsun = [1, 0, 0]\n")],
        &["`environment.orbit`", "shadows are known"],
    );
    refused(&[("7e6", "6e6")], &["`environment.orbit.semi_major_axis`", "above the planet's radius"]);
    refused(&[("gain = 2e-4, ", "")], &["`actuator.wheels.unloading.gain`", "must be given"]);
    refused(&[("gain = 2e-4", "gain = 2e-4, torque = 1.0")], &["unloading.torque", "applies only to `jets`"]);
    let b_dot = ("attitude = { period = 0.5, bandwidth = 0.1 }", "b_dot = { period = 1.0, gain = 1e5 }");
    refused(&[b_dot], &["`law.b_dot`", "[sensor.magnetometer]"]);
    let magnetometer = ("gyro = { period = 0.5 }", "magnetometer = { period = 0.5 }");
    refused(&[magnetometer], &["`sensor.magnetometer`", "neither attitude"]);
    refused(&[magnetometer, (field, "")], &["`sensor.magnetometer`", "there is none"]);
    refused(
        &[("gyro = { period = 0.5 }", "sun_sensor = { period = 0.5 }")],
        &["`sensor.sun_sensor`", "environment.sun"],
    );
    refused(
        &[("orbit = {", "gravity_gradient = { orbit_rate = 1e-3 }\norbit = {")],
        &["`environment.gravity_gradient.orbit_rate`", "leave it out"],
    );
    refused(
        &[("duration = 5828.0", "duration = 5828.0\ntarget = [{ from = 0, frame = \"sun\" }]")],
        &["`target[0].frame`", "`environment.sun`"],
    );
}
