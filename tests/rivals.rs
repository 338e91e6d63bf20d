//! The field of commands: the comparison at a common time and at a common peak torque, and the optimal commands.
//!
//! The tables come from direct quadrature of each command's spectrum in NumPy, with Gramians and a dual Newton method
//! of their own; a linear programme confirms the peaks.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use flexsc_core::dynamics::waveform::TermShape;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_core::spacecraft::manoeuvre::{CommandCost, ComparisonBasis, compare};

use crate::spacecraft::{INERTIA, body, plan, quarter_turn, report, scenario, text};
use crate::study::close;
use crate::util::Dir;

/// Line of the comparison: name, peak, root mean square, torque at the start, residual in the last section's angle,
/// nominal and worst with frequencies off by 5 % and by 10 %, residual in the hub's angle, nominal and worst with 10 %.
type Line = (&'static str, f64, f64, f64, f64, f64, f64, f64, f64);

#[rustfmt::skip] // One row a command.
const FIELD: &[Line] = &[
    ("sine p=0", 316.42, 223.74, 0.00, 3.645e-02, 3.857e-02, 4.301e-02, 1.800e-02, 2.255e-02),
    ("sine p=1", 521.08, 320.50, 0.00, 2.175e-05, 3.375e-04, 1.189e-03, 8.285e-05, 7.363e-04),
    ("sine p=2", 718.27, 405.91, 0.00, 2.174e-07, 5.891e-05, 3.537e-04, 3.829e-08, 1.677e-04),
    ("sine p=3", 904.81, 481.71, 0.00, 6.731e-10, 3.061e-05, 3.210e-04, 7.604e-11, 1.507e-04),
    ("sine p=4", 1079.87, 549.54, 0.00, 2.373e-15, 5.266e-05, 1.015e-03, 1.352e-15, 4.760e-04),
    ("cosine p=0", 248.52, 175.73, 248.52, 9.534e-02, 2.214e-01, 2.320e-01, 6.646e-02, 1.343e-01),
    ("cosine p=1", 414.51, 271.03, 13.82, 5.860e-04, 1.678e-03, 2.926e-03, 1.235e-03, 2.568e-03),
    ("cosine p=2", 618.50, 363.43, 0.43, 8.470e-06, 2.384e-04, 4.461e-04, 1.621e-06, 2.163e-04),
    ("cosine p=3", 811.65, 444.36, 0.01, 4.344e-09, 1.118e-04, 2.480e-04, 4.907e-10, 1.167e-04),
    ("cosine p=4", 992.89, 516.19, 0.00, 2.210e-15, 1.365e-04, 3.925e-04, 1.395e-15, 1.842e-04),
    ("sine w1²", 678.48, 388.69, 0.00, 4.218e-06, 1.646e-05, 9.496e-05, 1.543e-05, 7.572e-05),
    ("sine w1² w2", 830.34, 451.50, 0.00, 8.346e-08, 3.687e-06, 6.443e-05, 1.467e-08, 3.079e-05),
    ("sine w1² w2²", 956.66, 501.69, 0.00, 8.242e-09, 3.560e-06, 1.719e-04, 1.426e-09, 8.062e-05),
    ("sine w1³", 776.08, 429.10, 0.00, 1.501e-06, 5.208e-06, 1.983e-05, 5.299e-06, 1.945e-05),
    ("sine w1 (1 ± 7.07 %)", 676.87, 388.01, 0.00, 2.718e-05, 3.422e-05, 5.540e-05, 2.628e-05, 5.729e-05),
    ("cosine w1²", 589.46, 350.26, 2.14, 8.193e-05, 8.367e-05, 1.704e-04, 1.585e-04, 2.229e-04),
    ("cosine w1² w2²", 888.58, 474.78, 0.01, 1.892e-07, 1.179e-05, 6.656e-05, 3.602e-08, 3.123e-05),
    ("cosine w1 (1 ± 7.07 %)", 588.29, 349.74, 2.16, 1.007e-04, 1.060e-04, 1.116e-04, 1.680e-04, 1.960e-04),
    ("bang-bang, rigid", 201.44, 201.44, 201.44, 1.026e-01, 2.309e-01, 2.744e-01, 4.661e-02, 1.583e-01),
    ("minimum energy, rigid", 302.16, 174.45, 302.16, 1.045e-01, 2.656e-01, 2.835e-01, 7.512e-02, 1.646e-01),
    ("minimum energy, p=1", 313.47, 174.65, 313.47, 1.490e-02, 2.052e-01, 2.552e-01, 3.423e-02, 1.415e-01),
    ("minimum energy, p=2", 320.03, 174.89, 320.04, 8.938e-03, 2.064e-01, 2.550e-01, 1.716e-03, 1.431e-01),
    ("minimum energy, p=3", 321.75, 174.97, 321.77, 3.953e-04, 2.047e-01, 2.551e-01, 4.465e-05, 1.435e-01),
    ("minimum energy, p=4", 319.48, 174.98, 319.50, 4.490e-16, 2.048e-01, 2.553e-01, 6.288e-16, 1.436e-01),
    ("minimum energy, w1²", 314.88, 178.12, 291.10, 1.311e-02, 4.514e-02, 1.942e-01, 2.865e-02, 1.187e-01),
    ("minimum energy, w1² w2²", 331.08, 178.51, 278.00, 7.402e-03, 5.486e-02, 2.010e-01, 1.418e-03, 1.163e-01),
    ("minimum energy, w1² to w4²", 334.81, 178.63, 278.77, 7.245e-14, 5.395e-02, 2.043e-01, 4.185e-14, 1.166e-01),
    ("minimum peak, p=1", 202.05, 202.05, 202.05, 2.079e-02, 1.481e-01, 1.947e-01, 5.333e-02, 1.175e-01),
    ("minimum peak, p=2", 202.26, 202.26, 202.26, 1.624e-02, 1.463e-01, 1.908e-01, 3.137e-03, 1.229e-01),
    ("minimum peak, p=3", 202.30, 202.30, 202.30, 5.238e-04, 1.515e-01, 1.979e-01, 5.917e-05, 1.209e-01),
    ("minimum peak, p=4", 202.31, 202.31, 202.31, 1.230e-15, 1.501e-01, 1.961e-01, 7.851e-16, 1.204e-01),
    ("ZV(w1) on bang-bang", 237.28, 212.69, 118.64, 2.162e-02, 2.165e-02, 6.858e-02, 5.299e-02, 5.357e-02),
    ("ZVD(w1) on bang-bang", 283.62, 231.44, 70.90, 1.203e-02, 1.763e-02, 4.182e-02, 3.485e-03, 8.298e-02),
    ("EI(w1) on bang-bang", 283.62, 230.43, 74.45, 2.778e-02, 3.566e-02, 5.108e-02, 1.089e-02, 8.729e-02),
    ("ZVDD(w1) on bang-bang", 344.98, 254.22, 43.12, 2.231e-02, 2.404e-02, 2.404e-02, 6.095e-02, 6.253e-02),
    ("ZV(w1, w2) on bang-bang", 256.61, 220.98, 64.15, 3.026e-05, 3.275e-02, 6.932e-02, 5.814e-06, 3.948e-02),
    ("ZVD(w1, w2) on bang-bang", 338.00, 254.12, 21.13, 1.479e-02, 1.488e-02, 2.160e-02, 2.893e-03, 5.260e-03),
    ("EI(w1, w2) on bang-bang", 338.00, 252.82, 23.29, 2.975e-02, 2.979e-02, 2.979e-02, 1.295e-02, 1.296e-02),
    ("ZV(w1) on sine p=0", 359.41, 244.47, 0.00, 1.276e-04, 5.681e-03, 9.633e-03, 2.020e-04, 7.545e-03),
    ("ZVD(w1) on sine p=0", 408.32, 267.33, 0.00, 4.690e-04, 1.454e-03, 2.773e-03, 1.128e-03, 5.264e-03),
    ("EI(w1) on sine p=0", 406.47, 266.28, 0.00, 3.520e-03, 3.796e-03, 3.796e-03, 2.553e-03, 5.388e-03),
    ("polynomial of degree 3", 302.16, 174.45, 302.16, 1.045e-01, 2.656e-01, 2.835e-01, 7.512e-02, 1.646e-01),
    ("polynomial of degree 5", 290.75, 208.51, 0.00, 5.749e-02, 5.852e-02, 5.852e-02, 2.855e-02, 3.016e-02),
    ("polynomial of degree 7", 378.36, 254.08, 0.00, 3.043e-03, 2.322e-02, 2.928e-02, 1.893e-03, 1.451e-02),
    ("polynomial of degree 9", 471.97, 298.97, 0.00, 9.475e-03, 9.967e-03, 9.967e-03, 4.510e-03, 4.694e-03),
    ("polynomial of degree 11", 567.39, 342.34, 0.00, 1.630e-03, 4.302e-03, 9.937e-03, 7.851e-04, 4.706e-03),
    ("polynomial of degree 13", 663.58, 384.22, 0.00, 2.807e-03, 4.696e-03, 4.704e-03, 1.323e-03, 2.218e-03),
];

/// Lines: name, time, root mean square, residual in the last section's angle, nominal and worst with 5 % and 10 %.
#[rustfmt::skip] // One row a command.
const AT_521_NM: &[(&str, f64, f64, f64, f64, f64)] = &[
    ("sine p=0", 9.3511, 368.46, 1.206e-02, 8.121e-02, 1.186e-01),
    ("sine p=1", 12.0000, 320.50, 2.175e-05, 3.375e-04, 1.189e-03),
    ("sine p=2", 14.2784, 292.58, 1.752e-07, 2.230e-05, 6.573e-05),
    ("sine w1²", 13.9563, 295.75, 4.698e-06, 4.716e-06, 3.243e-05),
    ("cosine p=1", 10.6471, 341.39, 6.607e-04, 2.308e-03, 5.996e-03),
    ("cosine p=2", 13.1575, 305.27, 2.669e-06, 5.743e-05, 2.411e-04),
    ("bang-bang, rigid", 7.4611, 521.08, 5.146e-02, 1.348e-01, 4.455e-01),
    ("ZV(w1) on bang-bang", 8.4045, 441.96, 4.334e-02, 4.505e-02, 9.711e-02),
    ("ZVD(w1) on bang-bang", 9.3479, 393.78, 4.002e-02, 4.083e-02, 4.163e-02),
    ("EI(w1) on bang-bang", 9.3479, 391.23, 3.987e-02, 4.044e-02, 4.145e-02),
    ("ZVD(w1, w2) on bang-bang", 10.1971, 364.16, 2.175e-02, 2.224e-02, 3.195e-02),
    ("ZVD(w1) on sine p=0", 10.7160, 338.84, 1.228e-03, 1.588e-03, 4.120e-03),
    ("minimum energy, p=2", 8.8846, 320.13, 1.434e-02, 3.094e-01, 5.964e-01),
    ("polynomial of degree 5", 8.9638, 373.69, 8.119e-02, 1.631e-01, 1.844e-01),
    ("polynomial of degree 7", 10.2255, 349.92, 4.263e-03, 3.283e-02, 6.124e-02),
];

/// Checks four digits of a value; a zero must be zero.
#[track_caller]
fn digits(name: &str, value: f64, exact: f64) {
    let unit = 10.0_f64.powf(exact.abs().log10().floor() - 3.0);
    let fits = if exact < 1e-12 { value < 1e-12 } else { (value - exact).abs() <= 0.6 * unit };
    assert!(fits, "{name}: {value:e} instead of {exact:e}");
}

fn find<'a>(
    rows: &'a [CommandCost],
    name: &str,
) -> &'a flexsc_core::spacecraft::manoeuvre::AlternativeOutcome {
    let row = rows.iter().find(|row| row.name == name).unwrap_or_else(|| panic!("no row {name}"));
    row.outcome.as_ref().unwrap_or_else(|why| panic!("{name}: {why:?}"))
}

#[test]
fn the_field_in_12_seconds() {
    let scenario = quarter_turn("sine = {}");
    let manoeuvre = scenario.manoeuvre.as_ref().expect("a manoeuvre");
    let rows = compare(manoeuvre, ComparisonBasis::Time(Span::from_seconds(12.0)), body(&scenario), 0.1);
    assert_eq!(rows.len(), FIELD.len());
    for &(name, peak, rms, initial, phi4, near, worst, angle, angle_worst) in FIELD {
        let row = find(&rows, name);
        let torque = row.torque;
        // Peaks of the reference are those of its nodes, none of which is at an end.
        assert!((torque.peak.value - peak).abs() < 0.0051 + 8e-5 * peak, "{name}: {}", torque.peak.value);
        assert!((torque.rms - rms).abs() < 0.0051, "{name}: {}", torque.rms);
        assert!((torque.initial.abs() - initial).abs() < 0.0051, "{name}: {}", torque.initial);
        digits(name, row.residuals[1].nominal, phi4);
        digits(name, row.residuals[1].near, near);
        digits(name, row.residuals[1].worst, worst);
        digits(name, row.residuals[0].nominal, angle);
        digits(name, row.residuals[0].worst, angle_worst);
        let end = row.plan.waveform.end();
        assert!(end <= 12.0 + 1e-12, "{name} ends at {end}");
    }
}

#[test]
fn the_field_at_one_peak_torque() {
    let scenario = quarter_turn("sine = {}");
    let manoeuvre = scenario.manoeuvre.as_ref().expect("a manoeuvre");
    let peak = 521.080_754_063;
    let common = ComparisonBasis::PeakTorque(Positive::new(peak).expect("positive"));
    let rows = compare(manoeuvre, common, body(&scenario), 0.1);
    for &(name, time, rms, phi4, near, worst) in AT_521_NM {
        let row = find(&rows, name);
        assert!((row.plan.time - time).abs() < 1e-4, "{name}: {}", row.plan.time);
        close(row.torque.peak.value, peak, 1e-11);
        assert!((row.torque.rms - rms).abs() < 0.011, "{name}: {}", row.torque.rms);
        // The reference has its times to four decimals.
        close(row.residuals[1].nominal, phi4, 6e-3);
        close(row.residuals[1].near, near, 2e-3);
        close(row.residuals[1].worst, worst, 2e-3);
    }
}

#[test]
fn the_least_energy() {
    let scenario = quarter_turn("minimum_energy = { suppress = 4 }");
    let w = crate::spacecraft::FREQUENCIES;
    let weights = [-50.66394888, -12.57021827, -13.18960864, 7.50166788, 2.80515192];
    for i in 0..60 {
        let t = 0.1 + 0.2 * f64::from(i);
        let tau = t - 6.0;
        let sum: f64 = (0..4).map(|n| weights[n + 1] * (w[n] * tau).sin()).sum();
        let gap = plan(&scenario).waveform.at(t) - weights[0] * tau - sum;
        assert!(gap.abs() < 1e-7, "{gap:e} at {t}");
    }
    close(report(&scenario).torque.rms, 174.977_920_146_5, 1e-12);
    let rigid = report(&quarter_turn("minimum_energy = {}"));
    close(rigid.torque.rms, 2.0 * 3.0_f64.sqrt() * INERTIA * std::f64::consts::FRAC_PI_2 / 144.0, 1e-14);
}

#[test]
fn the_least_peak() {
    let peaks = [202.0515959162, 202.2631587638, 202.2986898187, 202.3131057928];
    for (p, exact) in (1..).zip(peaks) {
        let scenario = quarter_turn(&format!("minimum_peak = {{ suppress = {p} }}"));
        let report = report(&scenario);
        close(report.torque.peak.value, exact, 1e-12);
        close(report.torque.rms, exact, 1e-12);
        assert!(report.residuals[1].nominal < 3e-2);
    }
    let scenario = quarter_turn("minimum_peak = { suppress = 4 }");
    let exact = [5.46108043, 5.49716871, 5.55850991, 5.59647785, 5.91065642, 6.0];
    let breaks = plan(&scenario).waveform.breaks();
    assert_eq!(breaks.len(), 13);
    for (i, exact) in exact.into_iter().enumerate() {
        assert!((breaks[i + 1] - exact).abs() < 6e-9, "{breaks:?}");
        assert!((breaks[i + 1] + breaks[11 - i] - 12.0).abs() < 1e-11, "{breaks:?}");
    }
    assert!(report(&scenario).residuals[1].nominal < 1e-13);
    let rigid = report(&quarter_turn("bang_bang = {}"));
    close(rigid.torque.peak.value, 4.0 * INERTIA * std::f64::consts::FRAC_PI_2 / 144.0, 1e-14);
    let same = report(&quarter_turn("minimum_peak = {}"));
    close(same.torque.peak.value, rigid.torque.peak.value, 1e-13);
}

#[test]
fn every_command_keeps_the_rates_before_and_after() {
    let commands = [
        "sine = { suppress = 2 }",
        "cosine = { suppress = 2, zeros = [{ mode = 0 }] }",
        "bang_bang = {}",
        "minimum_energy = { suppress = 4, zeros = [{ mode = 0, times = 2 }] }",
        "minimum_peak = { suppress = 2 }",
        "polynomial = { degree = 3 }",
        "polynomial = { degree = 9 }",
    ];
    let shapers = ["", "[manoeuvre.shaper]\nzvd = { modes = [0, 1] }", "[manoeuvre.shaper]\nei = {}"];
    for command in commands {
        for shaper in shapers {
            for (start, end, angle) in
                [(0.1, -0.05, 1.0), (0.0, 0.2, -0.4), (0.03, 0.03, 1.0), (-0.1, 0.1, 0.0)]
            {
                let text = text(
                    "torque",
                    start,
                    &format!(
                        "angle = {angle}\ntime = 12.0\nstart_rate = {start}\nend_rate = {end}\n\
                         [manoeuvre.command]\n{command}\n{shaper}"
                    ),
                );
                let scenario = scenario(&text);
                let mut rigid = body(&scenario).clone();
                rigid.modes.clear();
                rigid.outputs.clear();
                let report =
                    flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&scenario), &rigid, 0.1);
                let errors = (report.angle_error, report.rate_error);
                assert!(errors.0.abs() < 1e-12 && errors.1.abs() < 1e-12, "{command} {shaper}: {errors:?}");
                if command.contains("bang") && shaper.is_empty() {
                    let amplitude = |term: &flexsc_core::dynamics::waveform::Term| match &term.shape {
                        TermShape::Polynomial(c) => c[0].abs(),
                        _ => f64::NAN,
                    };
                    let terms = &plan(&scenario).waveform.terms;
                    assert!(terms.iter().all(|term| amplitude(term) == amplitude(&terms[0])));
                }
            }
        }
    }
}

#[test]
fn the_command_compares_too() {
    let quarter = text(
        "torque",
        0.0,
        "angle = 1.5707963267948966\ntime = 12.0\n[manoeuvre.command]\nsine = { suppress = 1 }",
    );
    let dir = Dir::holding("turn.toml", quarter);
    let lines = dir.run("plan turn.toml --compare --json").exits(0).prints(&["\"command\":\"sine p=2\""]);
    assert_eq!(lines.lines().count(), FIELD.len());
    dir.run("plan turn.toml --compare --coordinate angle --units si").exits(0).says(&["sine w1³", "776.1"]);
    let lines = dir.run("plan turn.toml --compare --json --peak-torque 521.080754063").printed();
    assert_eq!(lines.lines().filter(|line| line.contains("refused")).count(), 0, "{lines}");
    dir.run("plan turn.toml --compare --coordinate tip")
        .exits(2)
        .says(&["--coordinate must be one of angle, phi4"]);
    dir.run("plan turn.toml --band 1.5").exits(2).says(&["--band must be between 0 and 1, got 1.5"]);
    dir.run("plan turn.toml --peak-torque -1").exits(2);
}
