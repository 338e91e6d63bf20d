//! The shipped Earth observer: spacecraft from parts, wheels, gyro, star tracker, attitude filter, law and turn
//! together.

use flexsc_core::metrics::MetricValue;
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::scenario::Scenario;

use crate::traces::{column, flown, traced};
use crate::util::SCENARIOS;

/// Returns the scenario with some of its words changed.
fn observer(change: &[(&str, &str)]) -> Scenario {
    let mut text = std::fs::read_to_string(format!("{SCENARIOS}/earth-observer.toml")).expect("a file");
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse("observer.toml", &text).expect("a scenario")
}

/// Returns the largest error of an axis between two times (rad).
fn worst(trace: &Trace, from: f64, to: f64) -> f64 {
    // Rows have the period of the log.
    let times: Vec<f64> = (0..=1200).map(|row| 0.25 * f64::from(row)).collect();
    let errors =
        ["roll", "pitch", "yaw"].map(|axis| column(trace, "/pointing", &format!("{axis}_error_rad")));
    let within = times.iter().enumerate().filter(|(_, t)| (from..=to).contains(*t));
    within.flat_map(|(row, _)| errors.map(|error| error[row].abs())).fold(0.0, f64::max)
}

/// The turn lasts from 30 s to 200.9 s: 1.0472 rad at 8e-3 rad/s and 2e-4 rad/s².
#[test]
fn it_does_what_its_comment_says() {
    let scenario = observer(&[]);
    for run in 0..5 {
        let (metrics, trace) = flown(&scenario, run, Detail::Full);
        assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")), "run {run}");
        let (turning, pointing) = (worst(&trace, 30.0, 200.9), worst(&trace, 240.9, 300.0));
        assert!(turning < 5e-4 && pointing < 1e-4, "run {run}: {turning} {pointing}");
        let Some(Column::Rows(_, wheels)) = trace.topic("/wheels").and_then(|rows| rows.get("wheels")) else {
            panic!("wheels")
        };
        let most = |name: &str| {
            wheels.numbers(name).expect("rows").iter().fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        assert!(most("speed_rad_s") < 600.0 && most("torque_nm") <= 0.4, "run {run}");
    }
    let silent = observer(&[
        (
            "angle_random_walk = 3e-6, rate_random_walk = 1e-8",
            "angle_random_walk = 1e-12, rate_random_walk = 1e-16",
        ),
        ("noise = [2.4e-5, 2.4e-5, 1.5e-4]", "noise = [1e-10, 1e-10, 1e-10]"),
        ("initial = { angle = 1e-3, bias = 1e-5 }", "initial = { angle = 1e-9, bias = 1e-12 }"),
    ]);
    let trace = traced(&silent);
    let (turning, pointing) = (worst(&trace, 30.0, 300.0), worst(&trace, 280.0, 300.0));
    assert!(turning < 3e-4 && pointing < 1e-6, "{turning} {pointing}");
}

/// The innovations of a filter with the true noise have the variance that it predicts, over many runs.
#[test]
fn its_filter_is_as_good_as_it_says() {
    let scenario = observer(&[]);
    let runs = 12;
    let mean = |name: &str| {
        (0..runs)
            .map(|run| flown(&scenario, run, Detail::Full).0.number(name).expect("a number"))
            .sum::<f64>()
            / runs as f64
    };
    // 480 innovations a run of three numbers: 0.03 is 2.8 standard errors, sqrt(2/(3 480 12)) = 0.011. Errors
    // of a run are hardly independent, of runs they are: 0.4 is 2.4 standard errors of 12 errors of six
    // numbers, sqrt(2/(12 6)) = 0.17.
    let (nis, nees) = (mean("nis_mean"), mean("nees_mean"));
    assert!((nis - 1.0).abs() < 0.03, "NIS {nis}");
    assert!((0.6..1.4).contains(&nees), "NEES {nees}");
}

/// Without external torques the momentum of body, panels and wheels together is constant, whatever the wheels do.
#[test]
fn wheels_and_panels_change_no_momentum() {
    let trace = traced(&observer(&[("speeds = [200, -200, 200, -200]", "speeds = [200, -150, 120, -90]")]));
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    let first = momentum[0];
    assert!(first > 1.0, "{first}");
    let off = momentum.iter().map(|h| (h / first - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off}");
}
