//! The planet's shadow as a cone with a penumbra, and orbits about an oblate planet, in whole scenarios.

use flexsc_core::Scenario;
use flexsc_core::record::Trace;

use crate::traces::{column, times, traced, within};
use crate::util::Dir;

/// A body on a spring in the Sun's plane at 500 km, with the shadow some seconds ahead.
fn snap(frequency: f64, shadow: &str, rest: &str) -> Trace {
    let text = format!(
        "duration = 120.0\nlaw = {{ open = {{}} }}\nlog = {{ period = 0.05 }}\n\
         [spacecraft]\nmass = 90.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
         [[appendage]]\nname = \"mass\"\nmass = 10.0\nmodes = [{{ frequency = {frequency}, translation = [0, 0, 2] }}]\n\
         thermal = {{ deflection = [0.05], time_constant = 0.3 }}\n\
         [environment]\norbit = {{ semi_major_axis = 6.878137e6, anomaly = 1.93 }}\nsun = [1, 0, 0]\nshadow = \"{shadow}\"\n{rest}"
    );
    traced(&Scenario::parse("snap.toml", &text).expect("a scenario"))
}

/// Returns the amplitude of an oscillation about a constant, by least squares over the rows.
fn amplitude(times: &[f64], values: &[f64], w: f64) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let part = |wave: fn(f64) -> f64| {
        let sum: f64 = times.iter().zip(values).map(|(t, value)| (value - mean) * wave(w * t)).sum();
        2.0 * sum / values.len() as f64
    };
    part(f64::cos).hypot(part(f64::sin))
}

/// A penumbra excites a mode by |2 J1(x)/x|, x = W T/2, of what the edge of a cylinder does: a quadrature of the exact part
/// in view has these factors at 500 km.
#[test]
fn a_penumbra_snaps_appendages_by_its_spectrum() {
    for (hertz, factor, tolerance) in
        [(0.1, 0.348_06, 1e-3), (0.2, 0.130_94, 5e-4), (0.5, 0.004_089_4, 5e-5), (1.0, 0.005_607_8, 5e-5)]
    {
        let w = std::f64::consts::TAU * hertz;
        // One free mode: E = 1 - t²/m, W = O/sqrt(E).
        let clamped = w * (1.0_f64 - 4.0 / 100.0).sqrt();
        let residual = |shadow: &str| {
            let trace = snap(clamped, shadow, "");
            let times = times(&trace, "/vibrations");
            // After the shadow has begun, before 35 s, whole periods of all modes.
            let rows = times.iter().position(|t| *t >= 50.0).expect("rows");
            let values = &within(&trace, "/vibrations", "modes", "displacement")[rows..rows + 1200];
            amplitude(&times[rows..rows + 1200], values, w)
        };
        let [cone, cylinder] = ["cone", "cylinder"].map(residual);
        assert!((cone / cylinder - factor).abs() < tolerance, "{hertz}: {} {factor}", cone / cylinder);
    }
}

/// The log has the part in view, which scales the torque of sunlight, and the edges are those of 30 digits.
#[test]
fn the_part_in_view_scales_sunlight() {
    let pressure = "solar_pressure = { force = [-1e-4, 0, 0], at = [0, 0.5, 0] }\n";
    let begins = 1_761.636_144_309 - 1.93 * (6_878_137.0_f64.powi(3) / 3.986_004_418e14).sqrt();
    for (shadow, edges) in [("cone", [begins, begins + 8.403_602_4]), ("cylinder", [begins + 4.240_323_4; 2])]
    {
        let trace = snap(1.0, shadow, pressure);
        let light = column(&trace, "/orbit", "sunlight");
        let torques = within(&trace, "/torques", "axes", "disturbance_nm");
        let full = torques[2];
        assert!(full.abs() > 4e-5, "{full}");
        let mut before = 1.0;
        for ((t, light), torque) in times(&trace, "/orbit").iter().zip(light).zip(torques.chunks(3)) {
            assert!(*light <= before, "{t}");
            before = *light;
            assert_eq!([*light < 1.0, *light > 0.0], [*t > edges[0], *t < edges[1]], "{shadow} {t}: {light}");
            // The body turns by little in two minutes.
            assert!((torque[2] - full * light).abs() < 1e-3 * full.abs(), "{shadow} {t}");
        }
        assert!((light[0], before) == (1.0, 0.0));
    }
}

/// A rigid body turns by the double integral of the part in view: the steps resolve a penumbra.
#[test]
fn steps_resolve_a_penumbra() {
    let text = "duration = 60.0\nlaw = { open = {} }\nlog = { period = 0.02 }\n\
         [spacecraft]\nmass = 90.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
         [environment]\norbit = { semi_major_axis = 6.878137e6, anomaly = 1.93 }\nsun = [1, 0, 0]\n\
         solar_pressure = { force = [-1e-4, 0, 0], at = [0, 0.5, 0] }\n";
    let trace = traced(&Scenario::parse("turn.toml", text).expect("a scenario"));
    let (light, yaw) = (column(&trace, "/orbit", "sunlight"), column(&trace, "/pointing", "yaw_rad"));
    let (h, acceleration) = (0.02, 5e-5 / 35.0);
    let (mut angle, mut rate) = (0.0, 0.0);
    for (row, pair) in light.windows(2).enumerate() {
        // Parabola through the rows, but for the kinks of the light.
        angle += h * rate + h * h * (pair[0] / 3.0 + pair[1] / 6.0) * acceleration;
        rate += 0.5 * h * (pair[0] + pair[1]) * acceleration;
        let off = (yaw[row + 1] - angle).abs();
        // The trapezoids are within 1e-5 s of the integral of the light.
        assert!(off < 1e-5 * acceleration * 60.0 + 1e-6 * angle, "{row}: {off:e} of {angle:e}");
    }
    assert!(light[0] == 1.0 && light[light.len() - 1] == 0.0);
}

/// Rows of the log within penumbrae change no bit of the motion.
#[test]
fn looking_into_a_penumbra_changes_no_bit() {
    let pressure = "solar_pressure = { force = [-1e-4, 0, 0], at = [0, 0.5, 0] }\n";
    let dense = snap(1.3, "cone", pressure);
    let text = |period: f64| {
        format!(
            "duration = 120.0\nlaw = {{ open = {{}} }}\nlog = {{ period = {period} }}\n\
             [spacecraft]\nmass = 90.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
             [[appendage]]\nname = \"mass\"\nmass = 10.0\nmodes = [{{ frequency = 1.3, translation = [0, 0, 2] }}]\n\
             thermal = {{ deflection = [0.05], time_constant = 0.3 }}\n\
             [environment]\norbit = {{ semi_major_axis = 6.878137e6, anomaly = 1.93 }}\nsun = [1, 0, 0]\nshadow = \"cone\"\n{pressure}"
        )
    };
    let thin = traced(&Scenario::parse("thin.toml", &text(0.5)).expect("a scenario"));
    for (topic, name) in [("/pointing", "q_z"), ("/energy", "elastic_j")] {
        let (a, b) = (column(&thin, topic, name), column(&dense, topic, name));
        assert_eq!((a.len(), b.len()), (241, 2401));
        assert!(a.iter().zip(b.iter().step_by(10)).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
}

/// A rigid body stays at a target in the local axes of an orbit that drifts, as the reference has the rates of the drift.
#[test]
fn references_follow_an_orbit_that_drifts() {
    let worst = |j2: &str| {
        let text = format!(
            "duration = 20000.0\nlog = {{ period = 10.0 }}\nlaw = {{ attitude = {{ period = 0.5, bandwidth = 0.05 }} }}\n\
             target = [{{ from = 0, frame = \"nadir\" }}]\n\
             [spacecraft]\nmass = 100.0\ninertia = [[30, 1, 0], [1, 40, 2], [0, 2, 35]]\nattitude = \"target\"\nrate = \"target\"\n\
             [environment]\norbit = {{ semi_major_axis = 6.878137e6, inclination = 1.7, node = 0.3, j2 = {j2} }}\n"
        );
        let trace = traced(&Scenario::parse("drift.toml", &text).expect("a scenario"));
        let errors = ["roll", "pitch", "yaw"]
            .map(|axis| column(&trace, "/pointing", &format!("{axis}_error_rad")).to_vec());
        let last = within(&trace, "/orbit", "axes", "position_m");
        let last = [last[last.len() - 3], last[last.len() - 2], last[last.len() - 1]];
        (errors.iter().flatten().fold(0.0_f64, |most, error| most.max(error.abs())), last)
    };
    let ((still, first), (drifts, second)) = (worst("0"), worst("true"));
    assert!(still < 1e-5 && (drifts - still).abs() < 1e-7, "{still} {drifts}");
    let apart: f64 = first.iter().zip(second).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    assert!(apart > 1e5, "{apart}");
}

#[test]
fn shadows_and_drifts_that_do_not_fit_are_refused() {
    let refused = |around: &str, words: &[&str]| {
        let text = format!(
            "duration = 100.0\nlaw = {{ open = {{}} }}\n[spacecraft]\nmass = 100.0\ninertia = [[30, 0, 0], [0, 40, 0], [0, 0, 35]]\n\
             [environment]\n{around}\n"
        );
        let error = Scenario::parse("bad.toml", &text).expect_err(around).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let orbit = "orbit = { semi_major_axis = 7e6 }";
    refused("shadow = \"cone\"", &["`environment.shadow`", "environment.orbit"]);
    refused(&format!("{orbit}\nshadow = \"cylinder\""), &["`environment.shadow`", "environment.sun"]);
    refused(
        &format!("{orbit}\nsun = [1, 0, 0]\nshadow = \"sphere\""),
        &["environment.shadow", "cone", "cylinder"],
    );
    refused(
        "orbit = { semi_major_axis = 2e10 }\nsun = [1, 0, 0]",
        &["`environment.orbit.semi_major_axis`", "for a conical shadow", "cylinder"],
    );
    refused(
        "orbit = { semi_major_axis = 7e6, j2 = -1e-3 }",
        &["environment.orbit.j2", "true for the Earth's"],
    );
}

/// The study of the shipped scenario: the penumbra meets a requirement that the edge of a cylinder misses.
#[test]
fn a_satellite_enters_the_shadow_without_a_thermal_snap() {
    let dir = Dir::with(&["eclipse-snap"]);
    dir.run("simulate eclipse-snap.toml").exits(0).says(&["1 of 1 requirement met", "✓ eclipse"]);
    dir.run("simulate eclipse-snap.toml --set environment.shadow=cylinder --force")
        .exits(3)
        .says(&["MISSED: 1 of 1 requirement", "✗ eclipse"]);
}
