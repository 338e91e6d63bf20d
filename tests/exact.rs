//! Metrics are those of the motion, not of a log: equal bits with any record, and the numbers of independent
//! computations.

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Metrics;
use flexsc_core::record::{Column, Detail, Record, Trace};

use crate::study::{close, metrics, numbers, pairs, scenario};
use crate::util::{Dir, SCENARIOS};

fn number(metrics: &Metrics, name: &str) -> f64 {
    metrics.number(name).unwrap_or_else(|| panic!("no metric {name}"))
}

fn word(metrics: &Metrics, name: &str) -> String {
    metrics.to_json()[name].as_str().unwrap_or_else(|| panic!("no metric {name}")).to_owned()
}

fn beside(scenario: &Scenario, record: impl Record) -> Metrics {
    let run = CampaignRun::new(scenario.clone(), 0);
    Campaign::simulate(&run, record).expect("a run")
}

#[test]
fn no_log_has_a_part_in_the_metrics() {
    let files = std::fs::read_dir(SCENARIOS).expect("the scenarios");
    let mut seen = 0;
    for file in files.map(|file| file.expect("a file").path()) {
        if file.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        let duration = match name.split('-').next() {
            Some("iss") => "20",
            Some("wheel") => "65.3",
            Some("relay") => "620",
            // Bearings, a pump and a fine mirror at 200 Hz: as long as it is shipped.
            Some("solar") => "1.0",
            _ => "20.7",
        };
        let at = |period: &str| scenario(&name, &[("duration", duration), ("log.period", period)]);
        let alone = beside(&at("0.1"), ());
        for (period, detail) in [("0.01", Detail::Full), ("0.37", Detail::Events), ("0.37", Detail::Full)] {
            let logged = beside(&at(period), Trace::new(detail));
            // Compared as text, with digits for all bits, because NaN does not equal NaN.
            assert_eq!(alone.to_json().to_string(), logged.to_json().to_string(), "{name}, {period} s");
        }
        seen += 1;
    }
    assert!(seen >= 26, "{seen} scenarios");
}

#[test]
fn a_planned_torque_has_the_peak_of_its_plan() {
    for name in ["rotation-sine", "rotation-cosine", "rotation-spin-up", "rotation-kinematic"] {
        let scenario = scenario(name, &[("log.period", "10.0")]);
        let planned = scenario.plan.as_ref().expect("a plan").peak().value;
        close(number(&metrics(scenario), "peak_torque_nm"), planned, 1e-13);
    }
    let thrusters = metrics(scenario("rotation-thrusters", &[("log.period", "10.0")]));
    assert_eq!(number(&thrusters, "peak_torque_nm"), 600.0);
}

/// The body and law of golden/metrics_oracle.py.
const ROTATION: &str = r#"
duration = 40.0
[body.planar]
inertia = 500.0
angle = 0.02
rate = -0.001
modes = [
    { frequency = 0.7, gain = 0.3, damping = 0.004, displacement = 1e-3 },
    { frequency = 2.3, gain = 0.12, damping = 0.01, rate = 2e-3 },
]
outputs = [{ name = "tip", unit = "m", rigid = 1.5, modes = [4.0, -2.5] }]
[law.pd]
k_p = 40.0
k_d = 260.0
period = 0.5
[[disturbance]]
torque = 1.5
from = 20.0
to = 21.3
[reference]
band = 2e-3
"#;

#[test]
fn metrics_of_a_rotation_are_those_of_a_dense_search() {
    let reported = metrics(Scenario::parse("pd", ROTATION).expect("valid"));
    let golden = [
        ("peak_torque_nm", 1.1),
        ("angle_error_peak_rad", 2.111_241_263_071_022e-2),
        ("angle_error_late_rad", 7.527_601_929_265_571e-4),
        ("output_peaks", 3.4e-2),
        ("output_swings", 1.759_963_709_587_864e-2),
        ("output_swings_late", 1.559_424_288_921_89e-3),
        ("itae", 1.839_608_873_120_832e0),
        ("time_outside_s", 2.154_040_577_086_445e1),
        ("settling_time_s", 3.150_509_190_981_662e1),
    ];
    for (name, exact) in golden {
        let value = reported.number(name).unwrap_or_else(|| numbers(&reported, name)[0]);
        close(value, exact, 2e-12);
    }
    assert_eq!(word(&reported, "goal"), "met");
    let row = reported.to_row();
    let unit = |name: &str| row.metrics.iter().find(|metric| metric.name == name).expect("it").unit.clone();
    assert_eq!((unit("output_peaks"), unit("peak_torque_nm")), ("m".to_owned(), "N m".to_owned()));
}

#[test]
fn a_coast_under_back_emf_has_the_metrics_of_sixty_digits() {
    // Arc 1 of the table of metrics for coupled plants: two undamped modes, a wheel with back-EMF on the whole rate.
    let text = r"
duration = 19.0
[body.planar]
angle = 5e-4
rate = 4e-5
modes = [
    { frequency = 0.44, gain = 0.0213, displacement = 4e-6, rate = 1e-6 },
    { frequency = 0.755, gain = 0.0216, displacement = -2e-6, rate = 1e-6 },
]
[actuator.wheel]
gain = 1.0
back_emf = 2e-4
[law.open]
[[disturbance]]
torque = -1e-6
[reference]
band = 4e-4
";
    let reported = metrics(Scenario::parse("arc", text).expect("valid"));
    close(number(&reported, "angle_error_peak_rad"), 1.079_838_841_452_594_3e-3, 1e-13);
    close(number(&reported, "itae"), 0.165_419_965_418_987_1, 1e-13);
    assert_eq!(number(&reported, "time_outside_s"), 19.0);
    assert_eq!(word(&reported, "goal"), "missed");
}

/// Returns the largest value in a full log, for observed coordinates that of each.
fn largest_logged(scenario: &Scenario, topic: &str) -> Vec<f64> {
    let mut trace = Trace::new(Detail::Full);
    beside(scenario, &mut trace);
    let columns = trace.topic(topic).expect("a topic");
    let (values, count) = match columns.get("outputs") {
        Some(Column::Rows(counts, rows)) => (rows.numbers("value"), counts[0] as usize),
        _ => (columns.numbers("angle_rad"), 1),
    };
    let mut largest = vec![0.0_f64; count];
    for row in values.expect("a column").chunks_exact(count) {
        largest.iter_mut().zip(row).for_each(|(most, value)| *most = most.max(value.abs()));
    }
    largest
}

#[test]
fn where_nothing_is_in_closed_form_no_sample_is_larger() {
    // The chain is integrated by extrapolation, and its metrics by Taylor series: they agree as the tolerance says.
    let chain = scenario("rotation-nonlinear", &[("log.period", "0.001"), ("duration", "14")]);
    let reported = numbers(&metrics(chain.clone()), "output_peaks");
    let logged = largest_logged(&chain, "/outputs");
    assert_eq!(logged.len(), 4);
    for (told, logged) in pairs(reported, logged) {
        // A crest between two samples is a part (40 rad/s 0.5 ms)²/2 higher at most.
        assert!(told >= logged * (1.0 - 1e-9) && told <= logged * (1.0 + 3e-4), "{told} {logged}");
    }
    let drifting = scenario(
        "wheel-fixed-gain",
        &[("log.period", "0.01"), ("duration", "90"), ("reference.band", "1.0")],
    );
    let reported = number(&metrics(drifting.clone()), "angle_error_peak_rad");
    let logged = largest_logged(&drifting, "/attitude")[0];
    assert!(reported >= logged * (1.0 - 1e-13) && reported <= logged * (1.0 + 2e-4), "{reported} {logged}");
}

#[test]
fn worst_residuals_are_the_largest_of_a_much_finer_grid() {
    let scenario = scenario("rotation-cosine", &[]);
    let (plan, body) = (scenario.plan.as_ref().expect("a plan"), scenario.one_angle().expect("one angle"));
    let report = flexsc_core::spacecraft::manoeuvre::PlanReport::new(plan, body, 0.1);
    for (index, residual) in report.residuals.iter().enumerate() {
        let finest = (0..=40_000).map(|i| 0.9 + 0.2 * f64::from(i) / 4e4);
        let largest = finest.map(|factor| plan.residual_at(body, factor)[index]).fold(0.0, f64::max);
        // Between the points of the finer grid a crest is 1e-8 higher at most; 401 points were 1e-6 and more off.
        assert!(residual.worst >= largest * (1.0 - 1e-13), "{} {largest}", residual.worst);
        assert!(residual.worst <= largest * (1.0 + 1e-7), "{} {largest}", residual.worst);
    }
}

#[test]
fn every_run_says_whether_it_meets_its_goal() {
    // Their comments say the same.
    for (name, expected) in [
        ("rotation-robust", "met"),
        ("rotation-thrusters", "missed"),
        ("rotation-nonlinear", "missed"),
        ("relay-quiet", "met"),
        ("relay-one-sided", "missed"),
        ("wheel-scheduled-gain", "met"),
        ("wheel-slow-mode", "met"),
        ("wheel-unstable-band", "missed"),
    ] {
        assert_eq!(word(&metrics(scenario(name, &[])), "goal"), expected, "{name}");
    }
    let dir = Dir::with(&["rotation-robust"]);
    // A goal that the program made up is no verdict.
    dir.run("simulate rotation-robust.toml --log none").exits(0).says(&["rotation-robust   no requirement"]);
    let own = "simulate rotation-robust.toml --log none --set reference.band";
    dir.run(&format!("{own}=0.01")).exits(0).says(&["rotation-robust   goal met: within 0.573 deg from "]);
    dir.run(&format!("{own}=1e-9")).exits(0).says(&["goal missed: not within 0.206 mas"]);
    dir.run("simulate rotation-robust.toml --set duration=20 --runs 3 -o some").exits(0);
    let statistics = dir.text("some/statistics.csv");
    // At 20 s they are still outside, after the disturbance: a fraction of 0.
    assert!(statistics.lines().any(|line| line.starts_with("goal,,3,0e0,")), "{statistics}");
}

#[test]
fn a_body_without_inertia_is_accelerated() {
    let dir = Dir::with(&["wheel-fast-mode", "relay-fixed", "rotation-kinematic", "rotation-sine"]);
    let said = |name: &str| dir.run(&format!("simulate {name}.toml --log none --set duration=20")).exits(0);
    let wheel = said("wheel-fast-mode").says(&["acceleration   at most", "arcsec/s²"]).err;
    assert!(!wheel.contains("N m") && !wheel.contains("torque"), "{wheel}");
    said("rotation-kinematic").says(&["acceleration   at most", "deg/s²"]);
    said("rotation-sine").says(&["torque      at most", "N m"]);
    dir.run("cycle relay-fixed.toml --units si").exits(0).says(&["rad/s per hour"]);
    let units = |name: &str, metric: &str| {
        let row = metrics(scenario(name, &[("duration", "20")])).to_row();
        row.metrics.into_iter().find(|of| of.name == metric).expect("a metric").unit
    };
    assert_eq!(units("wheel-fast-mode", "peak_torque_nm"), "rad/s²");
    assert_eq!(units("rotation-kinematic", "peak_torque_nm"), "rad/s²");
    assert_eq!(units("rotation-sine", "peak_torque_nm"), "N m");
    assert_eq!(units("relay-fixed", "torque_impulse_per_hour_nm_s"), "rad/s");
    assert_eq!(units("relay-sampled", "torque_impulse_per_hour_nm_s"), "N m s");
    // What the law asks of a wheel is a torque: its gain times the command.
    let wheel = metrics(scenario("wheel-fast-mode", &[("duration", "20")]));
    let asked = number(&wheel, "peak_feedback_torque_nm");
    close(asked, 3.3e-5 * 7.5 * 0.06, 1e-12);
    assert!((number(&wheel, "peak_torque_nm") / asked - 1.0).abs() < 0.01);
}
