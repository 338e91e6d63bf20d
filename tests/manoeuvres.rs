//! Planned rotations: coefficients, costs and what is left, against 50-digit arithmetic and direct integration of the
//! generalised coordinates (DOP853, rtol 1e-12 and better).

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use std::f64::consts::{FRAC_PI_2, PI};

use flexsc_core::spacecraft::manoeuvre::FinalResidual;

use crate::spacecraft::{
    FREQUENCIES, INERTIA, PARTICIPATIONS, body, plan, quarter_turn, report, scenario, text, with,
};
use crate::study::{close, pairs};

/// Row of the paper's example: coefficients, peak, root mean square, integral of the square, peak of the last section's
/// angle and its time, the residual in it by each mode and in total, in the hub's angle, and the largest angle between
/// hub and rigid body.
type Row = (&'static str, usize, &'static [f64], f64, f64, f64, (f64, f64), [f64; 4], f64, f64, f64);

#[rustfmt::skip] // One row a case.
const EXAMPLE: &[Row] = &[
    ("sine", 0, &[316.421573267], 316.421573267, 223.7438401705, 600735.672171, (0.1460523121, 3.270620), [3.619597368e-02, 1.922609146e-04, 5.335397967e-05, 1.305124080e-05], 3.645463981e-02, 1.800307876e-02, 0.088337140),
    ("sine", 1, &[411.465238316, -190.087330099], 521.080754063, 320.4971414899, 1232621.012439, (0.2157570444, 8.003155), [0.0, 1.547055504e-05, 5.011917477e-06, 1.264744191e-06], 2.174721671e-05, 8.285417207e-05, 0.132232747),
    ("sine", 2, &[460.579904113, -335.302232482, 70.4783561841], 718.275171488, 405.9117107637, 1977171.803221, (0.3048027468, 7.615426), [0.0, 0.0, 1.663413384e-07, 5.101581493e-08], 2.173571533e-07, 3.828848560e-08, 0.185782026),
    ("sine", 3, &[490.613989807, -444.626324717, 159.112473737, -19.6669817092], 904.810301599, 481.7147626418, 2784589.350564, (0.3934155290, 4.605085), [0.0, 0.0, 0.0, 6.731122773e-10], 6.731123153e-10, 7.603521506e-11, 0.238659895),
    ("sine", 4, &[510.775719619, -528.154880596, 247.385061595, -54.1507161033, 3.99642886654], 1079.884766075, 549.5393770458, 3623922.323086, (0.4809765643, 4.752349), [0.0; 4], 0.0, 0.0, 0.290396418),
    ("cosine", 0, &[248.516922503], 248.516922503, 175.7280011414, 370563.964622, (0.1939112414, 11.371524), [8.350093674e-02, 4.914548863e-03, 6.642354557e-03, 2.829139965e-04], 9.534075415e-02, 6.645533240e-02, 0.108222411),
    ("cosine", 1, &[277.853568571, -264.029814617], 414.507700192, 271.0298402155, 881486.091447, (0.1695104957, 8.364394), [0.0, 2.204722233e-04, 3.501376509e-04, 1.540671186e-05], 5.860165861e-04, 1.234964634e-03, 0.104529761),
    ("cosine", 2, &[289.068387301, -407.897421191, 119.261772232], 618.504481340, 363.4310175723, 1584985.254403, (0.2592244033, 4.221361), [0.0, 0.0, 8.039400036e-06, 4.309146795e-07], 8.470314715e-06, 1.620667865e-06, 0.158379381),
    ("cosine", 3, &[294.989850048, -498.13825863, 241.41351424, -38.2578628598], 811.656765796, 444.3562114284, 2369429.311620, (0.3486077893, 4.506390), [0.0, 0.0, 0.0, 4.343993323e-09], 4.343993409e-09, 4.907003350e-10, 0.211985059),
    ("cosine", 4, &[298.636237046, -559.713423653, 347.989469242, -96.189057028, 9.27685489842], 992.901644569, 516.1868770741, 3197386.704762, (0.4369172801, 7.315352), [0.0; 4], 0.0, 0.0, 0.264426850),
];

/// Checks a residual to 1e-6 of it, or to 1e-4 where the reference has few digits; it must be zero for suppressed
/// modes.
#[track_caller]
fn left(value: f64, exact: f64, suppressed: usize) {
    match (exact, suppressed) {
        (0.0, _) | (_, 4) => assert!((value - exact).abs() < 1e-12, "{value:e}"),
        (_, 3) => close(value, exact, 1e-4),
        _ => close(value, exact, 1e-6),
    }
}

#[test]
fn the_paper_s_example() {
    for &(kind, p, coefficients, peak, rms, square, deflection, modes, phi4, angle, sag) in EXAMPLE {
        let scenario = quarter_turn(&format!("{kind} = {{ suppress = {p} }}"));
        let (plan, report) = (plan(&scenario), report(&scenario));
        let ours = plan.coefficients.as_ref().expect("a series");
        assert_eq!(ours.odd.len(), p + 1);
        assert!(ours.even.is_empty() && ours.constant == 0.0);
        pairs(&ours.odd, coefficients).for_each(|(ours, exact)| close(*ours, *exact, 1e-9));
        close(report.torque.peak.value, peak, 1e-9);
        close(report.torque.rms, rms, 1e-9);
        close(report.torque.square, square, 1e-9);
        close(report.deflections[1].value, deflection.0, 1e-9);
        // With all modes at rest after it, the deflection is antisymmetric, and both peaks are the same.
        let time = report.deflections[1].time;
        let off =
            (time - deflection.1).abs().min(if p == 4 { (12.0 - time - deflection.1).abs() } else { 1.0 });
        assert!(off < 2e-6, "{:?}", report.deflections[1]);
        // The reference has nine decimals.
        assert!((report.deflections[0].value - sag).abs() < 6e-10, "{:?}", report.deflections[0]);
        left(report.residuals[0].nominal, angle, p);
        left(report.residuals[1].nominal, phi4, p);
        for (n, exact) in modes.into_iter().enumerate() {
            left(amplitude(&scenario, n), exact, p);
        }
    }
}

/// Returns the residual of a mode in the last section's angle, from the body with that mode alone.
fn amplitude(scenario: &flexsc_core::Scenario, mode: usize) -> f64 {
    let mut body = body(scenario).clone();
    body.modes = vec![body.modes[mode]];
    body.outputs[0].modes = vec![body.outputs[0].modes[mode]];
    let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(scenario), &body, 0.1);
    report.residuals[1].nominal
}

#[test]
fn the_hub_s_angle_at_the_end_and_the_energy_after_it() {
    let exact = [
        ("sine", [-8.170e-3, -7.590e-5, -2.893e-8, 4.13e-11], [0.7926, 5.903e-5, 3.399e-10, 2.44e-14]),
        ("cosine", [-4.180e-2, -1.137e-3, -1.576e-6, -2.67e-10], [10.42, 1.283e-2, 4.763e-7, 1.02e-12]),
    ];
    for (kind, errors, energies) in exact {
        for p in 0..4 {
            let report = report(&quarter_turn(&format!("{kind} = {{ suppress = {p} }}")));
            close(report.angle_error, errors[p], 6e-3);
            close(report.energy, energies[p], 6e-3);
        }
    }
    // The direct integration has no more digits than these.
    let report = report(&quarter_turn("sine = { suppress = 4 }"));
    assert!(report.angle_error.abs() < 1e-13 && report.rate_error.abs() < 1e-13);
}

/// A turn with given rates before and after.
fn turn(kind: &str, start: f64, end: f64, angle: f64, p: usize, drive: &str) -> flexsc_core::Scenario {
    scenario(&text(
        drive,
        start,
        &format!(
            "angle = {angle}\ntime = 12.0\nstart_rate = {start}\nend_rate = {end}\n\
             [manoeuvre.command]\n{kind} = {{ suppress = {p} }}"
        ),
    ))
}

/// Kind, rates, angle, constant, odd and even amplitudes; peak, when, and root mean square.
type Turn = (&'static str, f64, f64, f64, f64, &'static [f64], &'static [f64], Option<(f64, f64, f64)>);

#[test]
fn rates_before_and_after() {
    let cases: [Turn; 3] = [
        (
            "sine",
            0.1,
            -0.05,
            1.0,
            -57.708375,
            &[205.24999159932, -149.42202164185, 31.40754054956],
            &[74.66640167452, -16.98660953649],
            Some((427.30388708, 7.48419056, 197.439943703)),
        ),
        (
            "cosine",
            0.1,
            -0.05,
            1.0,
            -57.708375,
            &[128.81865564575, -181.77289439948, 53.14708160355],
            &[74.66640167452, -16.98660953649],
            None,
        ),
        (
            "sine",
            0.0,
            0.2,
            FRAC_PI_2,
            76.9445,
            &[108.72277565673, -79.15019538152, 16.63685809920],
            &[-99.55520223269, 22.64881271532],
            Some((319.810386000, f64::NAN, 142.525961832)),
        ),
    ];
    for (kind, start, end, angle, constant, odd, even, costs) in cases {
        let scenario = turn(kind, start, end, angle, 2, "torque");
        let ours = plan(&scenario).coefficients.as_ref().expect("a series");
        close(ours.constant, constant, 1e-12);
        assert_eq!((ours.odd.len(), ours.even.len()), (odd.len(), even.len()));
        ours.odd.iter().zip(odd).for_each(|(ours, exact)| close(*ours, *exact, 1e-11));
        ours.even.iter().zip(even).for_each(|(ours, exact)| close(*ours, *exact, 1e-11));
        let report = report(&scenario);
        if let Some((peak, time, rms)) = costs {
            close(report.torque.peak.value, peak, 1e-10);
            assert!(time.is_nan() || (report.torque.peak.time - time).abs() < 1e-6);
            close(report.torque.rms, rms, 1e-11);
        }
    }
    for kind in ["sine", "cosine"] {
        for (start, end, angle) in
            [(0.1, -0.05, 1.0), (0.0, 0.2, FRAC_PI_2), (0.03, 0.03, 1.0), (-0.1, 0.1, 0.0)]
        {
            for p in 1..=4 {
                let scenario = turn(kind, start, end, angle, p, "torque");
                let report = report(&scenario);
                (0..p).for_each(|mode| left(amplitude(&scenario, mode), 0.0, p));
                let largest = [1.5e-3, 4e-6, 1e-9, 2e-14][p - 1];
                assert!(report.angle_error.abs() < largest, "{kind} {p}: {:e}", report.angle_error);
                // The rate of what is left is its amplitude times its frequency, of the second mode or a
                // higher one.
                let fastest = FREQUENCIES[1] * largest;
                assert!(report.rate_error.abs() < fastest, "{kind} {p}: {:e}", report.rate_error);
            }
        }
    }
}

#[test]
fn the_first_mode_s_amplitude_rises_with_its_frequency_as_the_series_says() {
    let exact = [7.94436915829e-3, 1.81287223987e-3, 1.12079938977e-3, 1.77338901875e-3];
    for (p, exact) in exact.into_iter().enumerate() {
        let scenario = quarter_turn(&format!("sine = {{ suppress = {} }}", p + 1));
        // The slope of an absolute value at its zero: the mean of both sides is exact to second order.
        let step = 1e-5;
        let at = |factor: f64| {
            let mut body = body(&scenario).clone();
            body.modes = vec![body.modes[0]];
            body.modes[0].frequency =
                flexsc_core::numerics::quantity::Frequency::new(factor * FREQUENCIES[0]).expect("in range");
            let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&scenario), &body, 0.1);
            // The gain stays: the hub's amplitude is k, the last section's the participation.
            report.residuals[0].nominal * PARTICIPATIONS[0].abs() * INERTIA / 9.414_365_255_919_522
        };
        close(0.5 * (at(1.0 + step) + at(1.0 - step)) / step, exact, 1e-7);
    }
}

#[test]
fn a_repeated_zero_takes_the_slope_away() {
    let at = |times: u32, factor: f64| {
        let scenario = quarter_turn(&format!("sine = {{ zeros = [{{ mode = 0, times = {times} }}] }}"));
        let mut body = body(&scenario).clone();
        body.modes[0].frequency =
            flexsc_core::numerics::quantity::Frequency::new(factor * FREQUENCIES[0]).expect("in range");
        body.modes.truncate(1);
        flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&scenario), &body, 0.1).residuals[0].nominal
    };
    // Ten times nearer, the amplitude falls by ten to the number of zeros.
    for (times, fall) in [(1, 10.0), (2, 100.0), (3, 1000.0)] {
        // The nearest amplitude, of three zeros 1e-13, has two digits.
        close(at(times, 1.001) / at(times, 1.0001), fall, 0.03);
    }
    // A shifted zero lies where it says.
    let shifted = quarter_turn("cosine = { zeros = [{ mode = 0, shift = 0.07 }] }");
    let mut body = body(&shifted).clone();
    body.modes[0].frequency =
        flexsc_core::numerics::quantity::Frequency::new(1.07 * FREQUENCIES[0]).expect("in range");
    body.modes.truncate(1);
    let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&shifted), &body, 0.1);
    left(report.residuals[0].nominal, 0.0, 1);
}

#[test]
fn the_hub_s_own_motion() {
    // tests/golden/manoeuvre_oracle.py, on a grid of 6 microseconds.
    let phi4 = [0.2914114464, 0.2180458861, 0.3049044758, 0.3934230090, 0.4809765643];
    let torque = [708.43321251, 525.35361054, 718.49901755, 904.82595826, 1079.88476608];
    for p in 0..5 {
        let scenario = turn("sine", 0.0, 0.0, FRAC_PI_2, p, "motion");
        let report = report(&scenario);
        close(report.deflections[1].value, phi4[p], 5e-10);
        close(report.torque.peak.value, torque[p], 1e-9);
        // The hub follows the command exactly.
        assert!(report.angle_error.abs() < 1e-14 && report.residuals[0].nominal == 0.0);
        if p == 2 {
            let ours = &plan(&scenario).coefficients.as_ref().expect("a series").odd;
            let exact = [0.068_400_329_7, 0.024_769_968_9, -0.036_739_184_1];
            pairs(ours, exact).for_each(|(ours, exact)| close(*ours, exact, 2e-9));
        }
        if p == 0 {
            close(report.residuals[1].nominal, 0.1546, 3e-2);
        }
        (0..p).for_each(|mode| left(amplitude(&scenario, mode), 0.0, p));
    }
}

#[test]
fn damped_modes() {
    let damped = |kind: &str, p: usize, zeta: f64, rates: (f64, f64)| {
        let text = text(
            "torque",
            rates.0,
            &format!(
                "angle = 1.5707963267948966\ntime = 12.0\nstart_rate = {}\nend_rate = {}\n\
                 [manoeuvre.command]\n{kind} = {{ suppress = {p} }}",
                rates.0, rates.1
            ),
        );
        let damping = |n: usize| (format!("body.planar.modes[{n}].damping"), zeta.to_string());
        let set: Vec<_> = (0..4).map(damping).collect();
        let set: Vec<_> = set.iter().map(|(key, value)| (key.as_str(), value.clone())).collect();
        with(&text, &set).expect("a valid scenario")
    };
    for zeta in [0.005, 0.02, 0.05] {
        for p in 1..=4 {
            for rates in [(0.0, 0.0), (0.1, -0.05)] {
                for kind in ["sine", "cosine", "minimum_energy"] {
                    let scenario = damped(kind, p, zeta, rates);
                    for mode in 0..p {
                        let amplitude = amplitude(&scenario, mode);
                        assert!(amplitude < 1e-13, "{kind} {p} {zeta} {rates:?}: {amplitude:e}");
                    }
                    let mut rigid = body(&scenario).clone();
                    rigid.modes.clear();
                    rigid.outputs.clear();
                    let report =
                        flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&scenario), &rigid, 0.1);
                    assert!(report.angle_error.abs() < 1e-13 && report.rate_error.abs() < 1e-13);
                }
            }
        }
        let sine = damped("sine", 2, zeta, (0.0, 0.0));
        assert!(plan(&sine).waveform.at(0.0).abs() < 1e-10, "the torque begins at zero");
        // It tends to the undamped plan.
        let (slight, none) = (damped("sine", 3, 1e-9, (0.1, -0.05)), damped("sine", 3, 0.0, (0.1, -0.05)));
        let gap = |t: f64| plan(&slight).waveform.at(t) - plan(&none).waveform.at(t);
        assert!((0..120).all(|i| gap(f64::from(i) * 0.1).abs() < 1e-4));
    }
    // What the undamped design leaves in the modes that it suppresses: tests/golden/manoeuvre_oracle.py.
    for (p, zeta, exact) in [
        (1, 0.005, 3.616046865e-5),
        (1, 0.02, 1.168176648e-4),
        (1, 0.05, 2.386234209e-4),
        (2, 0.005, 8.258357574e-6),
        (2, 0.02, 2.668901894e-5),
        (2, 0.05, 5.453084808e-5),
    ] {
        let undamped = damped("sine", p, 0.0, (0.0, 0.0));
        let mut body = body(&damped("sine", p, zeta, (0.0, 0.0))).clone();
        body.modes.truncate(p);
        body.outputs[0].modes.truncate(p);
        let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan(&undamped), &body, 0.1);
        close(report.residuals[1].nominal, exact, 1e-8);
    }
}

#[test]
fn twenty_modes_and_forty_lose_no_digits() {
    let golden = include_str!("golden/series-amplitudes.csv");
    for kind in ["sine", "cosine"] {
        for count in [20, 40] {
            let mut set = Vec::new();
            for n in 0..count {
                let frequency = 3.5 + 2.25 * f64::from(n);
                set.push(format!("{{ frequency = {frequency:?}, gain = 0.1 }}"));
            }
            let text = text("torque", 0.0, "angle = 1.5707963267948966\ntime = 12.0\n[manoeuvre.command]");
            let set = [
                ("body.planar.modes", format!("[{}]", set.join(", "))),
                ("body.planar.outputs", "[]".to_owned()),
                ("manoeuvre.command", format!("{{ {kind} = {{ suppress = {count} }} }}")),
            ];
            let scenario = with(&text, &set).expect("a valid scenario");
            let ours = &plan(&scenario).coefficients.as_ref().expect("a series").odd;
            let start = format!("{kind},{count},");
            let exact: Vec<f64> = golden
                .lines()
                .filter_map(|line| line.strip_prefix(&start)?.split(',').nth(1)?.parse().ok())
                .collect();
            assert_eq!((ours.len(), exact.len()), (count as usize + 1, count as usize + 1));
            let gap: f64 = ours.iter().zip(&exact).map(|(a, b)| (a - b) * (a - b)).sum();
            let size: f64 = exact.iter().map(|b| b * b).sum();
            assert!((gap / size).sqrt() < 1e-13, "{kind} {count}: {:e}", (gap / size).sqrt());
            pairs(&exact, ours).for_each(|(exact, ours)| close(*ours, *exact, 1e-12));
        }
    }
}

#[test]
fn a_harmonic_in_resonance_with_a_mode() {
    // w = k sigma to the last bit: within the series that harmonic vanishes, beyond it any amplitude leaves the mode.
    for (kind, half) in [("sine", 0.0), ("cosine", 0.5)] {
        for k in [2, 3, 9] {
            let sigma = 2.0 * PI / 12.0;
            let frequency = (f64::from(k) - half) * sigma;
            let text = text(
                "torque",
                0.0,
                &format!("angle = 1.5\ntime = 12.0\n[manoeuvre.command]\n{kind} = {{ suppress = 4 }}"),
            );
            let set = [("body.planar.modes[0].frequency", format!("{frequency:?}"))];
            let scenario = with(&text, &set).expect("a valid scenario");
            (0..4).for_each(|mode| left(amplitude(&scenario, mode), 0.0, 4));
            if k < 6 {
                let odd = &plan(&scenario).coefficients.as_ref().expect("a series").odd;
                assert!(odd[k as usize - 1].abs() < 1e-10 * odd[0].abs(), "{odd:?}");
            }
        }
    }
}

#[test]
fn a_single_harmonic_of_a_tuned_time() {
    let worst = |residuals: &[FinalResidual]| residuals[0].nominal;
    for kind in ["sine", "cosine"] {
        let scenario = quarter_turn(&format!("{kind} = {{}}"));
        let tuned = report(&scenario).tuned;
        assert_eq!(tuned.len(), 3);
        for tuned in tuned {
            let (below, above) =
                if kind == "sine" { tuned.sine } else { tuned.cosine.expect("rest to rest") };
            for time in [below.expect("not too short"), above] {
                assert!((time - 12.0).abs() < 2.0 * PI / FREQUENCIES[tuned.mode]);
                let text = text(
                    "torque",
                    0.0,
                    &format!("angle = 1.5\ntime = {time:?}\n[manoeuvre.command]\n{kind} = {{}}"),
                );
                let scenario = crate::spacecraft::scenario(&text);
                let mut body = crate::spacecraft::body(&scenario).clone();
                body.modes = vec![body.modes[tuned.mode]];
                body.outputs.clear();
                let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(
                    crate::spacecraft::plan(&scenario),
                    &body,
                    0.1,
                );
                assert!(worst(&report.residuals) < 2e-14, "{kind} mode {}", tuned.mode);
            }
        }
    }
}
