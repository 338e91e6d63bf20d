//! Simulated rotations: effects of the planned torque, the law after it, disturbances, actuators and large angles.
//!
//! The exact numbers come from an independent integration of the generalised coordinates (SciPy's DOP853, rtol 1e-12)
//! and, for the PD law and the exact chain, of the closed loop and of Lagrange's equations in absolute angles.

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Metrics;
use flexsc_core::record::Trace;

use crate::study::{close, metrics, numbers, pairs, scenario};
use crate::traces::{column, traced};
use crate::util::{Dir, table};

fn number(metrics: &Metrics, name: &str) -> f64 {
    metrics.number(name).unwrap_or_else(|| panic!("no metric {name}"))
}

/// Returns a rotation that suppresses `modes` modes.
fn suppressing(name: &str, kind: &str, modes: usize, more: &[(&str, &str)]) -> Scenario {
    let key = format!("manoeuvre.command.{kind}.suppress");
    let modes = modes.to_string();
    scenario(name, &[&[(key.as_str(), modes.as_str())], more].concat())
}

#[test]
fn rotations_end_where_they_should() {
    // (suppressed modes, angle error at the end, elastic energy left, vibration left of the outermost section).
    let sine = [
        (0, -8.170e-3, 0.7926, 3.645_463_981e-2),
        (1, -7.590e-5, 5.903e-5, 2.174_721_671e-5),
        (2, -2.893e-8, 3.399e-10, 2.173_571_533e-7),
        (3, 4.13e-11, 2.44e-14, 6.731_123_153e-10),
    ];
    let cosine = [
        (0, -4.180e-2, 10.42, 9.534_075_415e-2),
        (1, -1.137e-3, 1.283e-2, 5.860_165_861e-4),
        (2, -1.576e-6, 4.763e-7, 8.470_314_715e-6),
        (3, -2.67e-10, 1.02e-12, 4.343_993_409e-9),
    ];
    for (kind, cases) in [("sine", sine), ("cosine", cosine)] {
        for (modes, angle, energy, residual) in cases {
            let metrics = metrics(suppressing(&format!("rotation-{kind}"), kind, modes, &[]));
            let tolerance = if modes < 3 { 5e-4 } else { 5e-3 };
            close(number(&metrics, "arrival_angle_error_rad"), angle, tolerance);
            close(number(&metrics, "residual_energy_j"), energy, tolerance);
            let residuals = numbers(&metrics, "output_residuals");
            close(residuals[3], residual, if modes < 3 { 1e-6 } else { 1e-4 });
            // The residual oscillates on: its largest value is that of the modes' amplitudes, or a little less.
            let swings = numbers(&metrics, "output_swings");
            assert!(
                swings[3] <= residual * 1.0001 && swings[3] > 0.9 * residual,
                "{kind} {modes}: {swings:?}"
            );
        }
        let metrics = metrics(suppressing(&format!("rotation-{kind}"), kind, 4, &[]));
        assert!(numbers(&metrics, "output_residuals").iter().all(|residual| *residual < 1e-12));
        assert!(number(&metrics, "arrival_angle_error_rad").abs() < 1e-12);
    }
}

#[test]
fn a_pd_law_takes_over_at_the_end() {
    let set = [("body.panels.damping", "0.0"), ("manoeuvre.peak_torque", "1e4"), ("uncertain", "{}")];
    let with = |more: &[(&str, &str)]| {
        metrics(scenario(
            "rotation-robust",
            &[&[("manoeuvre.command.sine", "{ suppress = 1 }")], &set[..], more].concat(),
        ))
    };
    let fast = with(&[("law.pd.period", "0.002"), ("log.period", "0.01")]);
    close(number(&fast, "angle_error_peak_rad"), 0.0175, 5e-3);
    close(number(&fast, "peak_feedback_torque_nm"), 81.7, 5e-3);
    // Two digits are known of a law that acts at every instant; this one acts each 2 ms.
    close(number(&fast, "angle_error_late_rad"), 1.1e-6, 0.1);
    close(numbers(&fast, "output_swings_late")[3], 1.4e-5, 0.1);
    // Without the law the pulse makes the body drift, and its panels ring.
    let open = with(&[("law", "{ open = {} }")]);
    close(number(&open, "angle_error_peak_rad"), 1.20, 5e-3);
    close(numbers(&open, "output_swings_late")[3], 0.080, 2e-2);
    // A limit holds.
    let weak = with(&[("law.pd.limit", "20.0")]);
    assert_eq!(number(&weak, "peak_feedback_torque_nm"), 20.0);
}

#[test]
fn on_the_exact_chain_more_suppressed_modes_leave_more_vibration() {
    // (kind, suppressed modes, mean angle error after the end, vibration left of the outermost section).
    let exact = [
        ("sine", 1, 2.6e-3, 9.7e-5),
        ("sine", 2, 5.2e-3, 3.2e-3),
        ("sine", 3, 8.7e-3, 1.5e-2),
        ("sine", 4, 1.28e-2, 3.5e-2),
        ("cosine", 1, 1.6e-3, 5.9e-4),
        ("cosine", 4, 1.06e-2, 2.4e-2),
    ];
    for (kind, modes, angle, vibration) in exact {
        let command = format!("{{ {kind} = {{ suppress = {modes} }} }}");
        let chain = scenario("rotation-nonlinear", &[("manoeuvre.command", &command)]);
        let end = std::f64::consts::FRAC_PI_2;
        let trace = traced(&chain);
        let after = column(&trace, "/attitude", "angle_rad").iter().skip(12 * 50).map(|angle| angle - end);
        let (low, high) =
            after.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        // Two digits are known: 1.5 and 1.6 to half a unit of the second, 3.3 %.
        assert!((0.5 * (low + high) - angle).abs() < 0.033 * angle, "{kind} {modes}: {low} {high}");
        let swing = numbers(&metrics(chain), "output_swings")[3];
        assert!((swing - vibration).abs() < 0.033 * vibration, "{kind} {modes}: {swing}");
    }
}

#[test]
fn small_rotations_of_the_exact_chain_are_linear() {
    let set = [("manoeuvre.angle", "1e-4"), ("body.panels.damping", "0.01"), ("duration", "20")];
    let linear = traced(&scenario("rotation-sine", &set));
    let exact = traced(&scenario("rotation-nonlinear", &set));
    let columns = [
        ("/attitude", "angle_rad"),
        ("/attitude", "rigid_rad"),
        ("/rate", "rate_rad_s"),
        ("/modes", "elastic_rad"),
    ];
    for (topic, name) in columns {
        let (a, b) = (column(&linear, topic, name), column(&exact, topic, name));
        let worst = pairs(a, b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // What is not linear is of third order; the integration errs by 1e-12 in each step.
        assert!(worst < 5e-11, "{topic} {name}: {worst:e}");
    }
}

#[test]
fn looking_at_the_exact_chain_does_not_change_it() {
    let ends: Vec<Metrics> = ["0.02", "0.5", "0.037"]
        .into_iter()
        .map(|period| metrics(scenario("rotation-nonlinear", &[("log.period", period), ("duration", "13")])))
        .collect();
    let angle = |metrics: &Metrics| number(metrics, "arrival_angle_error_rad").to_bits();
    assert!(ends.iter().all(|end| angle(end) == angle(&ends[0])));
}

#[test]
fn a_zero_order_hold_of_a_short_period_is_ideal() {
    let residual = |actuator: &str| {
        let metrics = metrics(suppressing("rotation-sine", "sine", 1, &[("actuator", actuator)]));
        (numbers(&metrics, "output_residuals")[3], number(&metrics, "arrival_rate_error_rad_s"))
    };
    let (ideal, rate) = residual("ideal");
    let (fine, fine_rate) = residual("{ hold = { period = 0.001 } }");
    close(fine, ideal, 1e-3);
    // The impulse of each period is that of the plan: the hold does not change the rigid rate at the end.
    assert!((fine_rate - rate).abs() < 1e-7);
    let (coarse, _) = residual("{ hold = { period = 0.5 } }");
    assert!(coarse > 3.0 * ideal, "{coarse:e} {ideal:e}");
}

/// The times of the rows of a topic (s).
fn times(trace: &Trace, topic: &str) -> Vec<f64> {
    let rows = trace.clone().into_columns().find(|(name, _)| *name == topic);
    rows.and_then(|(_, rows)| rows.numbers("time_s").map(<[f64]>::to_vec)).expect("times")
}

/// A log with the period of the thrusters has rows at the edges of their pulses: those of a fine one.
#[test]
fn no_pulse_is_missing_in_a_coarse_log() {
    let edges = |period: &str| -> Vec<(f64, f64)> {
        let trace = traced(&scenario("rotation-thrusters", &[("log.period", period), ("duration", "14")]));
        let (times, applied) = (times(&trace, "torque"), column(&trace, "/torque", "applied_nm"));
        assert!(times.windows(2).all(|row| row[0] < row[1]), "each instant has one row");
        assert_eq!(times.len(), column(&trace, "/attitude", "angle_rad").len());
        let changes = times.iter().zip(applied).zip(&applied[1..]).zip(&times[1..]);
        changes.filter(|(((_, a), b), _)| a != b).map(|(((_, _), b), at)| (*at, *b)).collect()
    };
    let (coarse, fine) = (edges("0.25"), edges("0.005"));
    assert_eq!(coarse, fine);
    let pulses: Vec<_> = coarse.iter().filter(|(_, torque)| *torque != 0.0).collect();
    assert!(pulses.len() > 20, "{coarse:?}");
    for pair in coarse.chunks_exact(2) {
        // Whole multiples of 10 ms.
        let on = 100.0 * (pair[1].0 - pair[0].0);
        assert!(pair[1].1 == 0.0 && (on - on.round()).abs() < 1e-9, "{pair:?}");
    }
}

#[test]
fn thrusters_give_the_planned_impulse_in_pulses() {
    let set = [("log.period", "0.005"), ("duration", "14")];
    let trace = traced(&scenario("rotation-thrusters", &set));
    let (applied, planned) =
        (column(&trace, "/torque", "applied_nm"), column(&trace, "/torque", "feedforward_nm"));
    assert!(applied.iter().all(|torque| [0.0, 600.0].contains(&torque.abs())));
    // Over the first half, the impulse is that of the plan to the shortest pulse, 0.02 s, and the sampling of
    // this log, 5 ms.
    let times = times(&trace, "torque");
    let half = |torque: &[f64]| -> f64 {
        let rows = times.windows(2).zip(torque).filter(|(row, _)| row[1] <= 6.0);
        rows.map(|(row, torque)| torque * (row[1] - row[0])).sum()
    };
    assert!(
        (half(applied) - half(planned)).abs() < 600.0 * (0.02 + 0.005),
        "{} {}",
        half(applied),
        half(planned)
    );
    // Finer pulses come nearer to the plan.
    let rate = |set: &[(&str, &str)]| {
        let strong = [("manoeuvre.command.cosine.suppress", "2"), ("actuator.thrusters.torque", "800.0")];
        let metrics = metrics(scenario("rotation-thrusters", &[&strong[..], set].concat()));
        number(&metrics, "arrival_rate_error_rad_s").abs()
    };
    let fine = [
        ("actuator.thrusters.period", "0.05"),
        ("actuator.thrusters.minimum_on", "0.0"),
        ("actuator.thrusters.quantum", "0.0"),
    ];
    // A quarter of the period, and pulses of any length.
    assert!(rate(&fine) < 0.05 * rate(&[]));
}

#[test]
fn a_campaign_plans_for_the_body_as_it_is_written() {
    let set = [("log.period", "0.1"), ("duration", "14")];
    let study =
        Campaign::new(scenario("rotation-robust", &set), "rotation-robust", None).expect("a campaign");
    let nominal = study.scenario().plan.as_ref().expect("a plan").coefficients.clone();
    let runs: Vec<CampaignRun> = (0..4).map(|number| study.run(number).expect("a run")).collect();
    for run in &runs {
        assert_eq!(run.scenario.plan.as_ref().expect("a plan").coefficients, nominal);
        assert_ne!(run.scenario.model, study.scenario().model);
        // The scenario that its log holds is the same run.
        let again = Scenario::parse("log", &run.scenario.self_contained().to_toml()).expect("valid");
        let again = CampaignRun::new(again, run.number);
        assert_eq!(
            Campaign::simulate(run, ()).expect("a run").to_json(),
            Campaign::simulate(&again, ()).expect("a run").to_json()
        );
    }
    let residual =
        |run: &CampaignRun| match Campaign::simulate(run, ()).expect("a run").get("output_residuals") {
            Some(residuals) => residuals.numbers()[3],
            other => panic!("{other:?}"),
        };
    let exact = numbers(&metrics(study.scenario().clone()), "output_residuals")[3];
    // Frequencies that are 3 to 10 % off leave more than those that the plan knows.
    assert!(runs.iter().map(residual).sum::<f64>() / 4.0 > 1.2 * exact);
}

#[test]
fn the_command_runs_campaigns_of_rotations() {
    let dir = Dir::with(&["rotation-robust"]);
    let said = "simulate rotation-robust.toml --set duration=20 --runs 12 --table csv -o";
    dir.run(&format!("{said} one --jobs 1")).exits(0);
    dir.run(&format!("{said} two --jobs 8")).exits(0);
    assert_eq!(dir.read("one/runs.csv"), dir.read("two/runs.csv"));
    let rows = table(&dir, "one/runs.csv");
    assert_eq!(rows.len(), 12);
    assert!(rows[3]["output_residuals"].starts_with('['));
    let json = dir.run("simulate rotation-robust.toml --set duration=20 --json").exits(0).json();
    assert!(json["metrics"]["angle_error_peak_rad"].as_f64().expect("a number") > 0.0);
}
