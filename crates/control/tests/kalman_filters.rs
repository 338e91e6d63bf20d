//! Tests of the Kalman filters against each other, and with invalid measurements.

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::estimator::kalman::{FilterContext, KalmanFilter, MeasurementFilter};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::from_text;
use flexsc_numerics::random::Seed;
use flexsc_spacecraft::body::Planar;

const BODY: &str = "angle = 0.06\nmodes = [{ frequency = 0.3, gain = 1.44 }, { frequency = 0.8, gain = 0.21 }, \
                    { frequency = 1.0, gain = 0.165 }, { frequency = 2.0, gain = 0.72 }]";

/// Returns a filter with a back-EMF of 1e-4/s; with a gyro if `rate_noise` is given.
fn filter(estimator: &str, rate_noise: Option<f64>) -> KalmanFilter {
    drawn(estimator, rate_noise, 3)
}

/// Returns a filter with a prior drawn with its own seed.
fn drawn(estimator: &str, rate_noise: Option<f64>, scenario_seed: u64) -> KalmanFilter {
    let body: Planar = from_text(BODY).unwrap_or_else(|error| panic!("{error}"));
    let body = &AxisModel::from(&body);
    let estimator: EstimatorKind =
        from_text(&format!("[{estimator}")).unwrap_or_else(|error| panic!("{error}"));
    let setting = FilterContext { body, back_emf: (1e-4, true), period: 0.3, angle_noise: 1e-5, rate_noise };
    let draws = &mut Seed { scenario: scenario_seed, run: 0 }.stream("prior");
    match &estimator {
        EstimatorKind::Kalman(spec) => spec.filter(&setting, draws),
        EstimatorKind::ExtendedKalman(spec) => spec.filter(&setting, draws),
        EstimatorKind::UnscentedKalman(spec) => spec.filter(&setting, draws),
        other => panic!("{other:?}"),
    }
}

/// Reading of a sensor at a sample.
type Measured = fn(u32) -> f64;

/// Returns moment (rad/s²) and angle (rad) of a synthetic run at a sample.
fn reference_motion(sample: u32) -> (f64, f64) {
    let t = 0.3 * f64::from(sample);
    (3e-5 * libm::sin(0.1 * t), 0.06 * libm::exp(-0.02 * t) + 3e-3 * libm::sin(0.3 * t))
}

#[test]
fn extended_filter_of_known_ratios_is_the_linear_one() {
    let known =
        "ratio_sd = 0.0\nratio_rate_sd = 0.0\nratio_noise = 0.0\nratio_rate_noise = 0.0\nsubsteps = 50\n";
    let mut linear = filter("kalman]", None);
    for kind in ["extended_kalman]", "unscented_kalman]"] {
        // A zero covariance has no Cholesky factor: a very small one is used.
        let known = if kind.starts_with('u') {
            known.replace("noise = 0.0", "noise = 1e-24").replace("0.0", "1e-12")
        } else {
            known.to_owned()
        };
        let mut other = filter(&format!("{kind}\n{known}"), None);
        let mut linear = linear.clone();
        for sample in 0..200 {
            let (moment, angle) = reference_motion(sample);
            linear.predict(moment);
            other.predict(moment);
            let (a, b) = (linear.update(Some((angle, 0.0))), other.update(Some((angle, 0.0))));
            assert!((a.innovation - b.innovation).abs() < 1e-9, "{kind} {sample}: {a:?} {b:?}");
        }
        let difference = (linear.mean() - other.mean().rows(0, 10)).amax();
        assert!(difference < 1e-8, "{kind}: {difference}");
        let covariance = other.covariance().view((0, 0), (10, 10)) - linear.covariance();
        assert!(covariance.amax() < 1e-6 * linear.covariance().amax(), "{kind}: {covariance}");
    }
    // The estimate is that of the nominal frequency.
    linear.predict(1e-5);
    assert!(linear.frequency(0) == (0.3, 0.0));
}

#[test]
fn unscented_and_extended_filter_agree_where_little_is_unknown() {
    let spec = "ratio_sd = 1e-5\nratio_rate_sd = 1e-6\nratio_noise = 1e-14\nratio_rate_noise = 1e-14\n\
                initial = { angle = 1e-6, rate = 1e-6, displacement = 1e-5, mode_rate = 3e-6 }\n";
    let mut extended = filter(&format!("extended_kalman]\n{spec}"), Some(1e-6));
    let mut unscented = filter(&format!("unscented_kalman]\n{spec}"), Some(1e-6));
    for sample in 0..100 {
        let (moment, _) = reference_motion(sample);
        extended.predict(moment);
        unscented.predict(moment);
        // Measurements are the filters' prediction plus a small innovation.
        let elastic_angle =
            |first: usize| extended.mean().iter().take(10).skip(first).step_by(2).sum::<f64>();
        let (angle, rate) = (elastic_angle(0) + 1e-6, elastic_angle(1) - 1e-7);
        let (a, b) = (extended.update(Some((angle, rate))), unscented.update(Some((angle, rate))));
        assert!((a.innovation - b.innovation).abs() < 1e-10, "{sample}: {a:?} {b:?}");
    }
    let spread = extended.covariance().diagonal().map(f64::sqrt);
    let difference = (extended.mean() - unscented.mean()).component_div(&spread).amax();
    assert!(difference < 1e-2, "{difference}");
    for i in 0..12 {
        let ratio = unscented.covariance()[(i, i)] / extended.covariance()[(i, i)];
        assert!((ratio - 1.0).abs() < 1e-3, "{i}: {ratio}");
    }
}

#[test]
fn nonsense_is_never_passed_on() {
    let nonsense: [(&str, Measured); 7] = [
        ("NaN", |_| f64::NAN),
        ("infinite", |_| f64::INFINITY),
        ("huge", |_| 1e300),
        ("large", |sample| if sample % 2 == 0 { 1e6 } else { -1e6 }),
        ("stuck", |_| 0.06),
        ("now and then", |sample| if sample % 7 == 0 { f64::NAN } else { reference_motion(sample).1 }),
        ("jumps", |sample| if sample > 50 { 3.0 } else { reference_motion(sample).1 }),
    ];
    for kind in [
        "kalman]",
        "extended_kalman]",
        "unscented_kalman]",
        "extended_kalman]\nratios = 'each'",
        "extended_kalman]\nratio = 1.5",
    ] {
        for rate_noise in [None, Some(1e-6)] {
            for (name, angle) in nonsense {
                let mut filter = filter(kind, rate_noise);
                for sample in 0..400 {
                    filter.predict(if sample == 9 { f64::NAN } else { reference_motion(sample).0 });
                    let reported = filter.update(Some((angle(sample), angle(sample + 1))));
                    assert!(reported.nis.is_none_or(f64::is_finite), "{kind} {name} {sample}");
                    let (state_estimate, mode) = (filter.dominant(), filter.mode());
                    let numbers = [
                        state_estimate.displacement,
                        state_estimate.frequency,
                        filter.amplitude(mode).0,
                        filter.frequency(mode).1,
                    ];
                    let all = numbers.iter().chain(filter.mean()).chain(filter.covariance());
                    assert!(all.into_iter().all(|n| n.is_finite()), "{kind} {name} {sample}: {numbers:?}");
                }
                let (lost, state_estimate) = (filter.lock_lost(), filter.dominant());
                assert!(lost || name == "now and then", "{kind} {name} {rate_noise:?}");
                assert!(!lost || state_estimate.displacement == 0.0, "{kind} {name}");
                assert!(
                    (0.03..=0.9).contains(&state_estimate.frequency),
                    "{kind} {name}: {state_estimate:?}"
                );
            }
        }
    }
}

/// Checks that a filter of a stuck sensor, which fits frequencies under which the moments would not move the body,
/// loses lock: its innovations are small but correlated.
#[test]
fn a_sensor_that_sticks_is_no_body_of_other_frequencies() {
    let cases: [(&str, Measured); 2] =
        [("stuck", |_| 0.06), ("jumps", |sample| if sample > 50 { 3.0 } else { reference_motion(sample).1 })];
    for kind in ["extended_kalman]", "unscented_kalman]"] {
        for spec in ["", "ratios = 'each'", "ratio = 1.5"] {
            for (name, angle) in cases {
                let lost = (0..40).filter(|seed| {
                    let mut filter = drawn(&format!("{kind}\n{spec}"), None, *seed);
                    for sample in 0..400 {
                        filter.predict(reference_motion(sample).0);
                        filter.update(Some((angle(sample), 0.0)));
                    }
                    filter.lock_lost()
                });
                assert_eq!(lost.count(), 40, "{kind} {spec} {name}");
            }
        }
    }
}

/// Checks that lock lost by a silent sensor is regained afterwards, nearly always within two windows.
#[test]
fn a_body_is_followed_again_after_a_silence() {
    for kind in ["kalman]", "extended_kalman]", "unscented_kalman]"] {
        // Runs without lock at the end of the silence, two windows after it, and at the end.
        let mut lost = [0; 3];
        for seed in 0..40 {
            let mut filter = drawn(kind, None, seed);
            // The true motion is the linear filter's prediction from the truth.
            let mut truth = drawn("kalman]\nprior = 'true'", None, seed);
            let mut noise = Seed { scenario: seed, run: 0 }.stream("sensor");
            for sample in 0..400 {
                let moment = reference_motion(sample).0;
                truth.predict(moment);
                filter.predict(moment);
                let angle: f64 = truth.mean().iter().take(10).step_by(2).sum();
                let silent = (100..160).contains(&sample);
                filter.update((!silent).then(|| (angle + 1e-5 * noise.normal(), 0.0)));
                if let Some(place) = [159, 260, 399].iter().position(|known| *known == sample) {
                    lost[place] += u32::from(filter.lock_lost());
                }
            }
        }
        assert!(lost[0] == 40 && lost[1] <= 2 && lost[2] == 0, "{kind} {lost:?}");
    }
}

#[test]
fn a_still_mode_teaches_no_frequency() {
    let run = |gate: &str| {
        let mut filter = filter(
            &format!(
                "extended_kalman]\nprior = 'drawn'\ngate = {gate}\n\
            initial = {{ angle = 1e-6, rate = 1e-7, displacement = 1e-6, mode_rate = 1e-7 }}"
            ),
            None,
        );
        let mut noise = Seed { scenario: 4, run: 0 }.stream("sensor");
        for _ in 0..600 {
            filter.predict(0.0);
            filter.update(Some((0.06 + 1e-5 * noise.normal(), 0.0)));
        }
        filter
    };
    // The truth is at rest: any reduction of the frequency's deviation is noise.
    let (gated, open) = (run("10.0"), run("0.0"));
    assert!(gated.is_gated() && !open.is_gated());
    assert!(gated.frequency(0).1 > 0.15, "{:?}", gated.frequency(0));
    assert!(open.frequency(0).1 < 0.05, "{:?}", open.frequency(0));
    // The law receives the frequency of the prior.
    let prior = filter(
        "extended_kalman]\nprior = 'drawn'\n\
        initial = { angle = 1e-6, rate = 1e-7, displacement = 1e-6, mode_rate = 1e-7 }",
        None,
    );
    assert_eq!(gated.dominant().frequency, prior.dominant().frequency);
}

#[test]
fn dominant_mode_is_the_most_excitable_or_the_largest() {
    // The second mode oscillates alone.
    for (ranking, mode) in [("excitability", 0), ("amplitude", 1)] {
        let mut filter = filter(
            &format!("kalman]\ninitial = {{ displacement = 0.1, mode_rate = 0.1 }}\ndominant = '{ranking}'"),
            None,
        );
        for sample in 0..300 {
            let t = 0.3 * f64::from(sample);
            filter.predict(0.0);
            filter.update(Some((0.06 + 2e-3 * libm::sin(0.8 * t), 0.0)));
        }
        assert_eq!(filter.mode(), mode, "{ranking}");
        let (amplitude, sd) = filter.amplitude(1);
        assert!((amplitude - 2e-3).abs() < 5.0 * sd && sd < 2e-4, "{amplitude} {sd}");
    }
}
