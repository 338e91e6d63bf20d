//! Elastic modes in an attitude filter: against an oracle with equal readings, refused settings, and the shipped
//! scenario.

use std::sync::Arc;

use flexsc_core::control::estimator::attitude::{
    AttitudeFilterState, AttitudeMeasurement, DelayedMeasurement, ElasticFilterStates, FilterHistory,
    FilterMode, FilterModes, FrequencyIdentification, GyroNoise,
};
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::numerics::attitude::{Vector, rotation};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::scenario::Scenario;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight_precision::Precision;
use nalgebra::{Matrix3, Quaternion};

use crate::traces::{flown, within};
use crate::util::SCENARIOS;

/// Readings of an artificial run, and the results of an independent filter for them: `golden/swinging_oracle.py`.
const READ: &str = include_str!("golden/swinging-in.csv");
const GIVEN: &str = include_str!("golden/swinging-out.csv");
const IDENTIFIED: &str = include_str!("golden/swinging-identified.csv");

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect()
}

fn known() -> FilterModes {
    let mode = |frequency: f64, damping: f64, [hub, gyro, mount]: [[f64; 3]; 3], rate: f64| FilterMode {
        frequency,
        true_frequency: frequency,
        damping,
        hub: hub.into(),
        gyro: gyro.into(),
        mounts: vec![gyro.into(), mount.into()],
        initial: [2e-3, rate],
    };
    let first = [[0.03, -0.01, 0.004], [0.01, 0.02, -0.005], [-0.04, 0.01, 0.02]];
    let second = [[0.002, 0.05, -0.02], [0.0, 0.015, 0.01], [0.03, -0.02, 0.05]];
    FilterModes {
        each: vec![mode(1.7, 0.005, first, 1e-3), mode(5.1, 0.01, second, 1e-3)],
        noise: 2e-4,
        ..FilterModes::default()
    }
}

#[test]
fn modes_in_the_filter_are_those_of_the_oracle() {
    follows_the_oracle(known(), GIVEN, 1e-12);
}

/// Initial frequencies 20 % too high and 10 % too low.
#[test]
fn identified_frequencies_are_those_of_the_oracle() {
    let mut known = known();
    known.identified = Some(FrequencyIdentification { deviation: 0.15, walk: 1e-4 });
    for (mode, off) in known.each.iter_mut().zip([1.2, 0.9]) {
        mode.frequency *= off;
    }
    follows_the_oracle(known, IDENTIFIED, 1e-11);
}

/// Checks that a filter that knows or identifies these modes has the states of the oracle within a tolerance, and its
/// deviations.
fn follows_the_oracle(known: FilterModes, given: &str, tolerance: f64) {
    let (read, noise) = (rows(READ), GyroNoise { angle_random_walk: 3e-6, rate_random_walk: 1e-8 });
    let off = Vector::new(1e-3, -5e-4, 8e-4);
    let prior = Quaternion::new(0.8, 0.36, -0.48, 0.0) * rotation(&off);
    let filter = AttitudeFilterState::new(Precision::Double, prior, Vector::zeros(), [1e-3, 1e-5]);
    let modes = ElasticFilterStates::new(Arc::new(known), &filter.covariance);
    let gate = AttitudeGate { most_rate: 1.0, ..AttitudeGate::default() };
    let mut history = FilterHistory::new(
        Instant::START,
        filter,
        Some(modes),
        noise,
        Span::from_seconds(0.5),
        gate,
        Precision::Double,
    );
    let at = |k: usize, more: f64| Instant::START + Span::from_seconds(0.25 * k as f64 + more);
    let three = |of: &[f64]| Vector::new(of[0], of[1], of[2]);
    let tracker = Matrix3::from_diagonal(&Vector::new(2.4e-5, 2.4e-5, 1.5e-4).map(|noise| noise * noise));
    let (mut given, mut nis) = (rows(given).into_iter().peekable(), 0.0);
    for k in 1..read.len() {
        history.set_torque(at(k - 1, 0.1), three(&read[k - 1][1..4]));
        history.add_gyro(at(k, 0.0), three(&read[k][4..7]));
        if k % 4 == 2 && k > 2 {
            let z = &read[k - 2][7..11];
            let fix = DelayedMeasurement {
                exposed: at(k - 2, 0.0),
                measured: AttitudeMeasurement::Attitude(Quaternion::new(z[0], z[1], z[2], z[3])),
                noise: tracker,
                gain: None,
                sensor: 1,
            };
            nis = history.add_measurement(&fix).expect("a correction").nis;
        }
        let Some(row) = given.next_if(|row| row[0] as usize == k) else { continue };
        let filter = history.latest();
        let swinging = history.modes().expect("modes");
        let q = Quaternion::new(row[1], row[2], row[3], row[4]);
        assert!((filter.attitude - q).norm() < tolerance, "{k} {:e}", (filter.attitude - q).norm());
        assert!((filter.bias - three(&row[5..8])).norm() < 0.1 * tolerance, "{k} {}", filter.bias);
        for (mode, [x, y]) in swinging.state.iter().enumerate() {
            let gap = (x - row[8 + 2 * mode]).abs().max((y - row[9 + 2 * mode]).abs());
            assert!(gap < tolerance, "{k} {mode} {gap:e}");
        }
        let states = swinging.covariance.nrows();
        for state in 0..states {
            let deviation = swinging.covariance[(state, state)].sqrt();
            assert!((deviation / row[12 + state] - 1.0).abs() < 1e-9, "{k} {state} {deviation}");
        }
        let (last, frequencies) = (row[12 + states], &row[13 + states..]);
        assert!((nis - last).abs() < 1e-8 * (1.0 + nis), "{k} {nis} {last}");
        // Ten states are those of the attitude, the bias and two modes; others are identified frequencies.
        assert_eq!(frequencies.len(), states - 10, "{k}");
        for (index, given) in frequencies.iter().enumerate() {
            let frequency = swinging.frequencies[index];
            assert!((frequency / given - 1.0).abs() < 1e-9, "{k} {frequency} {given}");
        }
    }
    assert!(given.peek().is_none());
}

fn text() -> String {
    std::fs::read_to_string(format!("{SCENARIOS}/flexible-boom.toml")).expect("a file")
}

fn changed(change: &[(&str, &str)]) -> Result<Scenario, String> {
    let mut text = text();
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse("boom.toml", &text).map_err(|error| error.to_string())
}

const NONE: (&str, &str) = (
    "elastic = { modes = [0], noise = 1e-5, displacement = 1e-3, feeds = \"hub\" }\n",
    "gate = { deviations = 1e6 }\n",
);

/// Returns the largest error from the reference about any axis while the body turns and settles (rad).
fn worst(trace: &Trace) -> f64 {
    let errors = ["roll", "pitch", "yaw"].map(|axis| {
        let rows = trace.topic("/pointing").and_then(|rows| rows.numbers(&format!("{axis}_error_rad")));
        rows.expect("errors").iter().skip(120).fold(0.0_f64, |most, error| most.max(error.abs()))
    });
    errors.into_iter().fold(0.0, f64::max)
}

/// The comment of the scenario: what the filter knows with the mode, and without.
#[test]
fn a_filter_that_knows_the_mode_is_consistent_and_points_better() {
    let [with, without] =
        [&[][..], &[NONE]].map(|change| flown(&changed(change).expect("it"), 0, Detail::Full));
    let number = |(metrics, _): &(Metrics, Trace), name: &str| metrics.number(name).expect(name);
    // Three standard errors of 760 innovations of three numbers, 3 sqrt(2/(3 760)) = 0.09; errors of one run
    // are few numbers.
    assert!((number(&with, "nis_mean") - 1.0).abs() < 0.09, "{}", number(&with, "nis_mean"));
    assert!((0.5..1.5).contains(&number(&with, "nees_mean")), "{}", number(&with, "nees_mean"));
    assert!((32.0..34.0).contains(&number(&without, "nis_mean")), "{}", number(&without, "nis_mean"));
    let [known, unknown] = [&with, &without].map(|run| number(run, "attitude_estimate_error_rms_rad"));
    assert!(
        (2.4e-5..2.6e-5).contains(&known) && (1.4e-4..1.5e-4).contains(&unknown),
        "{known:e} {unknown:e}"
    );
    let [held, shaken] = [&with, &without].map(|(_, trace)| worst(trace));
    assert!(held < 8e-4 && (1.1e-3..1.3e-3).contains(&shaken), "{held:e} {shaken:e}");
    assert_eq!(with.0.get("goal"), Some(&MetricValue::Word("met")));
    // A filter that takes the mode for a tenth slower shows it.
    let wrong = ("modes = [0], noise", "modes = [0], factor = 0.9, noise");
    assert!(number(&flown(&changed(&[wrong]).expect("it"), 0, Detail::Full), "nis_mean") > 2.0);
    // What laws read without the mode does not answer to it.
    let rigid = flown(&changed(&[("feeds = \"hub\"", "feeds = \"rigid\"")]).expect("it"), 0, Detail::Full);
    let rings = |run| number(run, "elastic_energy_end_j");
    assert!(rings(&rigid) > 3.0 * rings(&with), "{} {}", rings(&rigid), rings(&with));
}

/// A number of the one mode in the filter, at each sample.
fn column<'a>(trace: &'a Trace, field: &str) -> &'a [f64] {
    within(trace, "/attitude_filter_modes", "modes", field)
}

/// With errors from -15 % to 15 % and different noise, the slew identifies the frequency, and the deviations are
/// consistent.
#[test]
fn frequencies_are_identified_from_the_slew() {
    let mut squares = 0.0;
    let cases = [(0.85, 0.15), (0.93, 0.15), (1.0, 0.15), (1.15, 0.15)];
    for (factor, deviation) in cases {
        let keys = format!("modes = [0], factor = {factor}, frequency_deviation = {deviation}, noise");
        let boom = changed(&[("modes = [0], noise", &keys)]).expect("it");
        for run in 0..5 {
            let (metrics, trace) = flown(&boom, run, Detail::Full);
            let Some(MetricValue::Numbers(errors)) = metrics.get("frequency_estimate_errors") else {
                panic!("no errors of frequencies")
            };
            assert!(errors.len() == 1 && errors[0].abs() < 2e-3, "{factor} {run} {errors:?}");
            assert!(metrics.number("nis_mean").expect("it") < 1.6, "{factor} {run}");
            let last = |field: &str| *column(&trace, field).last().expect("a row");
            let error = last("frequency_rad_s") - last("true_frequency_rad_s");
            assert!((error / last("true_frequency_rad_s") - errors[0]).abs() < 1e-12);
            squares += (error / last("frequency_sd_rad_s")).powi(2);
        }
    }
    let mean = squares / (5 * cases.len()) as f64;
    assert!((0.5..4.0).contains(&mean), "{mean}");
    // Of one that is taken as known, the frequency stays, without a deviation.
    let (metrics, trace) = flown(&changed(&[]).expect("it"), 0, Detail::Full);
    assert!(metrics.get("frequency_estimate_errors").is_none());
    assert_eq!(column(&trace, "frequency_rad_s"), column(&trace, "true_frequency_rad_s"));
    assert!(column(&trace, "frequency_sd_rad_s").iter().all(|deviation| *deviation == 0.0));
}

#[test]
fn what_no_filter_with_modes_can_be_is_refused() {
    for (change, words) in [
        (("modes = [0], noise", "modes = [7], noise"), "`estimator.attitude.elastic.modes[0]` must be below"),
        (("modes = [0], noise", "modes = [0, 0], noise"), "names mode 0 again"),
        (("modes = [0], noise", "modes = [], noise"), "must name at least one mode"),
        (("feeds = \"hub\"", "feeds = \"modes\""), "must be `rigid` or `hub`"),
        (("modes = [0], noise", "modes = [0], frequency_walk = 1e-4, noise"), "needs `frequency_deviation`"),
        (
            ("modes = [0], noise", "modes = [0], frequency_deviation = 0, noise"),
            "frequency_deviation`: must be a positive number",
        ),
        (
            ("modes = [0], noise", "modes = [0], frequencies = [1, 2], noise"),
            "must be one for each of 1 mode, got 2",
        ),
        (
            ("[estimator.attitude]\n", "[estimator.attitude]\nform = \"steady\"\n"),
            "constant gains cannot estimate modes",
        ),
    ] {
        let error = changed(&[change]).expect_err("refused");
        assert!(error.contains(words), "{error}");
    }
}
