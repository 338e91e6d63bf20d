//! Jets that unload wheels: the shipped scenario does what its comment says, and impossible settings are refused.

use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::Detail;
use flexsc_core::scenario::Scenario;

use crate::traces::within;
use crate::util::SCENARIOS;

fn text() -> String {
    std::fs::read_to_string(format!("{SCENARIOS}/momentum-unloading.toml")).expect("a file")
}

/// Returns metrics, times (s) and momenta of the three wheels (N m s).
fn flown(text: &str) -> (Metrics, Vec<f64>, Vec<[f64; 3]>) {
    let scenario = Scenario::parse("unloading.toml", text).expect("a scenario");
    let (metrics, trace) = crate::traces::flown(&scenario, 0, Detail::Full);
    let momenta = within(&trace, "/wheels", "wheels", "momentum_nm_s").chunks_exact(3);
    let momenta: Vec<_> = momenta.map(|row| [row[0], row[1], row[2]]).collect();
    let period = scenario.log_period().seconds();
    let times = (0..momenta.len()).map(|row| period * row as f64).collect();
    (metrics, times, momenta)
}

fn norm(of: &[f64; 3]) -> f64 {
    of.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn jets_take_what_a_steady_torque_gives() {
    let (metrics, times, momenta) = flown(&text());
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
    let most = momenta.iter().map(norm).fold(0.0, f64::max);
    assert!((1.5..1.6).contains(&most), "{most}");
    assert!(metrics.number("pointing_error_end_rad").expect("an error") < 1e-8);
    // It ends near `below`, more than once.
    let emptied = momenta.windows(2).filter(|pair| norm(&pair[0]) > 0.1 && norm(&pair[1]) <= 0.1).count();
    assert!(emptied >= 2, "{emptied}");
    // What the torque gave about roll, 1.2e-3 N m, less what is left, is what the jets took: 0.5 N at 0.5 m less the
    // offset of the centre of mass, 8 (0.4 + 1)/188 m.
    let number = |name: &str| metrics.number(name).expect(name);
    let arm = 0.5 - 8.0 * 1.4 / 188.0;
    let taken = number("fuel_kg") * 220.0 * 9.80665 * arm;
    let given = 1.2e-3 * times.last().expect("rows") - momenta.last().expect("rows")[0];
    assert!((taken / given - 1.0).abs() < 1e-9, "{taken} {given}");
    // Each takes 0.02 N m over 2 s.
    let Some(MetricValue::Count(pulses)) = metrics.get("firings") else { panic!("pulses") };
    assert!((*pulses as f64 - taken / 0.04).abs() < 1e-9, "{pulses} {taken}");
}

#[test]
fn without_them_a_wheel_is_full_and_the_body_turns_away() {
    let text = text();
    let (before, rest) = text.split_once("[actuator.wheels.unloading]").expect("the table");
    let (_, after) = rest.split_once("[reference]").expect("the band");
    let (metrics, times, momenta) = flown(&format!("{before}[reference]{after}"));
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("missed")));
    let full = momenta.iter().position(|row| row[0] >= 2.2 - 1e-9).expect("full");
    // 2.2 N m s at 1.2e-3 N m, to the next row.
    assert!((0.0..1.0).contains(&(times[full] - 2.2 / 1.2e-3)), "{}", times[full]);
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |from: &str, to: &str, words: &[&str]| {
        let text = text();
        assert!(text.contains(from), "{from}");
        let error = Scenario::parse("bad.toml", &text.replace(from, to)).expect_err(to).to_string();
        for word in words {
            assert!(error.contains(word), "{word}: {error}");
        }
    };
    refused("below = 0.1", "below = 1.5", &["`actuator.wheels.unloading.below`", "less than `above`"]);
    refused("period = 2.0  ", "delay = 0  ", &["`actuator.wheels.unloading.jets.period`", "must be given"]);
    refused("minimum_on = 0.01", "delay = 1", &["`actuator.wheels.unloading.jets.delay`"]);
    refused(
        "minimum_on = 0.01",
        "minimum_on = 3.0",
        &["`actuator.wheels.unloading.jets.minimum_on`", "period of 2 s"],
    );
    refused(
        "point = \"bus\", offset = [0.0, 0.5, 0.3]",
        "point = \"boom\", offset = [0.0, 0.5, 0.3]",
        &["unloading.jets.thrusters[0].point"],
    );
    refused("plus = [\"a\"]", "plus = [\"b\"]", &["unloading.jets.groups.roll.plus"]);
}
