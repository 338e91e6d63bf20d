//! Kalman filters against a body that they do not know: many runs with drifting frequencies, and in the loop.

use flexsc_core::Scenario;
use flexsc_core::body::Coupled;
use flexsc_core::estimator::Estimator;
use flexsc_core::estimator::kalman::{Filter, Prediction, Setting};
use flexsc_core::random::{Seed, Stream};
use flexsc_core::record::{Column, Log};

use crate::study::metrics;
use crate::util::Dir;

/// The spacecraft of the third seed paper: modal gains, and frequencies that fall to a third in 200 s.
const GAINS: [f64; 4] = [1.44, 0.21, 0.165, 0.72];
const BODY: &str = "modes = [{ frequency = 0.3, gain = 1.44 }, { frequency = 0.8, gain = 0.21 }, \
                    { frequency = 1.0, gain = 0.165 }, { frequency = 2.0, gain = 0.72 }]";
const PERIOD: f64 = 0.3;
const SAMPLES: usize = 667;
/// Gain and back-EMF of the wheel (rad/s², 1/s), and the density of what else moves the body.
const WHEEL: f64 = 5e-4;
const BACK_EMF: f64 = 1e-4;
const KICKS: f64 = 1e-13;

fn ratio(t: f64) -> f64 {
    1.0 - t.min(200.0) / 300.0
}

fn scenario(noise: f64, angle: f64, estimator: &str) -> Scenario {
    let text = format!(
        "duration = 200.0\n[law.open]\n[body.planar]\nangle = {angle}\n{BODY}\n[sensor.sampled]\nperiod = {PERIOD}\n\
         noise = {noise}\n[estimator.{estimator}"
    );
    Scenario::parse("filters", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn filter(scenario: &Scenario, draws: &mut Stream) -> Filter {
    let setting = Setting {
        body: &scenario.model,
        back_emf: (BACK_EMF, true),
        period: PERIOD,
        angle_noise: scenario.sensor.angle_noise(),
        rate_noise: None,
    };
    match &scenario.estimator {
        Some(Estimator::ExtendedKalman(spec)) => spec.filter(&setting, Prediction::Extended, draws),
        Some(Estimator::UnscentedKalman(spec)) => spec.filter(&setting, Prediction::Unscented, draws),
        other => panic!("{other:?}"),
    }
}

/// What many runs come to, from 30 s on.
#[derive(Debug)]
struct Tally {
    /// Root mean square error of the dominant frequency (rad/s), and the median and largest of the runs' largest errors.
    rms: f64,
    median: f64,
    worst: f64,
    nees: f64,
    nis: f64,
    lost: u32,
    /// Root mean square error at the end, and the standard deviation that the filter claims.
    end: (f64, f64),
}

/// Runs of a filter beside a body with drifting frequencies under a sampled PD law.
fn monte_carlo(runs: u64, noise: f64, angle: f64, estimator: &str) -> Tally {
    let scenario = scenario(noise, angle, estimator);
    // The exponential at the middle of each half period: off by 4e-8 rad, where the sensor is off by 1e-5 rad.
    let half = |k: usize| {
        let middle = (k as f64 + 0.5) * 0.5 * PERIOD;
        Coupled::new(&scenario.model, BACK_EMF, true, &[ratio(middle); 4]).discrete(0.5 * PERIOD)
    };
    let path: Vec<_> = (0..2 * SAMPLES).map(half).collect();
    let mut tally =
        Tally { rms: 0.0, median: 0.0, worst: 0.0, nees: 0.0, nis: 0.0, lost: 0, end: (0.0, 0.0) };
    let (mut count, mut largest) = (0.0, Vec::new());
    for run in 0..runs {
        let seed = Seed { scenario: 1, run };
        let (mut sensor, mut kicks) = (seed.stream("sensor"), seed.stream("kicks"));
        let mut filter = filter(&scenario, &mut seed.stream("prior"));
        let mut z = scenario.model.start().to_vector(&[0.3, 0.8, 1.0, 2.0]);
        let (mut before, mut moment, mut worst) = (None, 0.0, 0.0_f64);
        for k in 0..=SAMPLES {
            let t = k as f64 * PERIOD;
            let angle = z.iter().step_by(2).sum::<f64>() + noise * sensor.normal();
            if k > 0 {
                filter.predict(moment);
            }
            let told = filter.update(Some((angle, 0.0)));
            moment = -WHEEL * (7.5 * angle + 275.0 * (angle - before.unwrap_or(angle)));
            before = Some(angle);
            if t > 30.0 {
                let error = filter.frequency(0).0 - 0.3 * ratio(t);
                let mut truth = z.as_slice().to_vec();
                truth.extend([ratio(t), if t < 200.0 { -1.0 / 300.0 } else { 0.0 }]);
                count += 1.0;
                tally.rms += error * error;
                tally.nees += filter.nees(&truth) / 12.0;
                tally.nis += told.nis.expect("a measurement");
                worst = worst.max(error.abs());
            }
            if k == SAMPLES {
                let (w, sd) = filter.frequency(0);
                tally.end.0 += (w - 0.1) * (w - 0.1) / runs as f64;
                tally.end.1 += sd * sd / runs as f64;
                break;
            }
            for (transition, push) in &path[2 * k..2 * k + 2] {
                z = transition * &z + push * moment;
            }
            // A quiet body has nothing but the noise of its sensor.
            let kick = if scenario.model.angle.get() == 0.0 {
                0.0
            } else {
                (KICKS * PERIOD).sqrt() * kicks.normal()
            };
            z[1] += kick;
            GAINS.iter().enumerate().for_each(|(mode, gain)| z[3 + 2 * mode] += gain * kick);
        }
        tally.lost += u32::from(filter.is_lost());
        largest.push(worst);
    }
    largest.sort_by(f64::total_cmp);
    Tally {
        rms: (tally.rms / count).sqrt(),
        median: largest[largest.len() / 2],
        worst: largest[largest.len() - 1],
        nees: tally.nees / count,
        nis: tally.nis / count,
        lost: tally.lost,
        end: (tally.end.0.sqrt(), tally.end.1.sqrt()),
    }
}

#[test]
fn extended_filter_follows_the_drift() {
    // An independent implementation over 200 runs: rms 0.00111, median of the largest 0.0034, worst 0.0068, NEES/n 1.01,
    // NIS 1.012, no loss. Runs scatter by about a third of their rms, so that 100 of them are within 10 %.
    let tally = monte_carlo(100, 1e-5, 0.06, "extended_kalman]\nprior = 'drawn'");
    assert!((tally.rms / 1.11e-3 - 1.0).abs() < 0.15, "{tally:?}");
    assert!((tally.median / 3.4e-3 - 1.0).abs() < 0.15 && tally.worst < 0.01, "{tally:?}");
    assert!((tally.nees - 1.01).abs() < 0.15, "{tally:?}");
    assert!((tally.nis - 1.012).abs() < 0.03, "{tally:?}");
    assert_eq!(tally.lost, 0, "{tally:?}");
    // The filter's claim is honest where the ramp ends.
    assert!(tally.end.0 < 1.3 * tally.end.1, "{tally:?}");
}

#[test]
fn unscented_filter_follows_it_and_is_less_sure() {
    let tally = monte_carlo(40, 1e-5, 0.06, "unscented_kalman]\nprior = 'drawn'");
    assert!((tally.rms / 1.11e-3 - 1.0).abs() < 0.2, "{tally:?}");
    assert!((0.75..1.0).contains(&tally.nees) && tally.lost == 0, "{tally:?}");
}

#[test]
fn bad_priors_lose_the_body_and_the_filter_says_so() {
    // The independent one lost 3 of 200 with the extended filter and 2 of 200 with the unscented one.
    let spec = "prior = 'drawn'\nratio_sd = 0.1";
    let extended = monte_carlo(200, 1e-5, 0.06, &format!("extended_kalman]\n{spec}"));
    assert!((1..=14).contains(&extended.lost) && extended.worst > 0.1, "{extended:?}");
}

#[test]
fn quiet_body_teaches_nothing() {
    // Without the gate the filter claims a hundredth of a rad/s while it is off by more than a tenth.
    let open = monte_carlo(30, 1e-5, 0.0, "extended_kalman]\nprior = 'drawn'\ngate = 0.0");
    assert!(open.end.0 > 0.08 && open.end.1 < 0.03, "{open:?}");
    let gated = monte_carlo(30, 1e-5, 0.0, "extended_kalman]\nprior = 'drawn'");
    assert!(gated.end.0 < 1.5 * gated.end.1, "{gated:?}");
}

/// A body in a loop of a PD law, with a filter that knows its frequencies or not.
fn looped(estimator: &str) -> Scenario {
    let text = format!(
        "duration = 120.0\n[law.pd]\nk_p = 3.75e-3\nk_d = 0.0413\nperiod = {PERIOD}\n[body.planar]\nangle = 0.06\n{BODY}\n\
         [sensor.sampled]\nperiod = {PERIOD}\nnoise = 1e-5\n[estimator.{estimator}"
    );
    Scenario::parse("looped", &text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn filters_in_the_loop_are_honest() {
    // No noise in the moment: the filter that knows that, and the frequencies, is optimal.
    let linear = metrics(looped("kalman]\nprior = 'drawn'\nmoment_noise = 0.0"));
    let number = |name: &str| linear.number(name).expect("a metric");
    assert!((number("nis_mean") - 1.0).abs() < 0.2, "{linear:?}");
    assert!((number("nis_inside_95") - 0.95).abs() < 0.04, "{linear:?}");
    assert!((0.2..2.0).contains(&number("nees_mean")), "{linear:?}");
    assert_eq!(number("frequency_error_max_rad_s"), 0.0);
    for kind in ["extended_kalman", "unscented_kalman"] {
        let filter = metrics(looped(&format!("{kind}]\nprior = 'drawn'\nassess = [30, 120]")));
        let number = |name: &str| filter.number(name).expect("a metric");
        assert!(number("frequency_error_rms_rad_s") < 3e-3, "{filter:?}");
        assert!(number("nees_mean") < 2.0 && number("lock_lost") == 0.0, "{filter:?}");
        assert!(number("lock_lost_at_s").is_nan());
    }
    // Frequencies that are wrong by half: the filter without ratios cannot follow, and says when it was lost.
    let wrong = BODY.replace("frequency = 0.3", "frequency = 0.45");
    let lost = metrics(looped(&format!("kalman]\n{wrong}")));
    assert_eq!(lost.number("lock_lost"), Some(1.0), "{lost:?}");
    assert!(lost.number("lock_lost_at_s").expect("a metric") < 40.0, "{lost:?}");
}

#[test]
fn gyro_sharpens_the_estimate() {
    let spec = "extended_kalman]\nprior = 'drawn'\nmoment_noise = 1e-15\nassess = [30, 120]";
    let error = |gyro: &str| {
        let text = looped(spec).to_toml().replace("[sensor.sampled]\n", &format!("[sensor.sampled]\n{gyro}"));
        let metrics = metrics(Scenario::parse("gyro", &text).expect("valid"));
        assert!((metrics.number("nis_mean").expect("a metric") - 1.0).abs() < 0.2, "{metrics:?}");
        metrics.number("frequency_error_rms_rad_s").expect("a metric")
    };
    let (without, with) = (error(""), error("rate_noise = 1e-6\n"));
    assert!(with < 0.8 * without, "{with} {without}");
}

#[test]
fn estimates_are_in_a_full_log() {
    let dir = Dir::new();
    dir.write("loop.toml", looped("extended_kalman]\nprior = 'drawn'").to_toml());
    dir.run("simulate loop.toml --log full --set duration=3").exits(0);
    let log = Log::open(&dir.path("looped.mcap")).expect("a log");
    let estimates = log.columns("/estimator").expect("a topic");
    assert_eq!(estimates.len(), 11);
    let Some(Column::Rows(counts, modes)) = estimates.get("modes") else { panic!("no modes") };
    assert!(counts.iter().all(|count| *count == 4) && modes.numbers("amplitude_sd_rad").is_some());
    let truth = estimates.numbers("true_frequency_rad_s").expect("a column");
    assert!(truth.iter().all(|w| *w == 0.3), "{truth:?}");
    dir.run("simulate loop.toml --log events --set duration=3").exits(0);
    let log = Log::open(&dir.path("looped.mcap")).expect("a log");
    assert!(log.columns("/estimator").is_err());
}

#[test]
fn filters_that_cannot_work_are_refused() {
    let bad = [
        (
            "[sensor.sampled]\nperiod = 0.3\nnoise = 1e-5\n",
            "",
            "estimator.extended_kalman",
            "acts at each sample",
        ),
        ("noise = 1e-5\n", "", "angle_noise", "must be given"),
        ("modes = [", "modes = []\n#", "estimator.extended_kalman", "has no modes"),
        (
            "kalman]",
            "kalman]\nmodes = [{ frequency = 0.3, gain = 1.0 }]",
            "modes",
            "must be as many as the body's, 4, got 1",
        ),
        ("kalman]", "kalman]\nbounds = [1.0, 0.5]", "bounds", "must be [low, high] in this order"),
        ("kalman]", "kalman]\nratio = 4.0", "ratio", "must lie within the bounds [0.1, 3], got 4"),
        ("kalman]", "kalman]\nassess = [100, 30]", "assess", "must be [from, to] in this order"),
        ("kalman]", "kalman]\nsubsteps = 0", "substeps", "must be 1 to 100 steps, got 0"),
    ];
    let good = format!(
        "duration = 10.0\n[law.open]\n[body.planar]\nangle = 0.06\n{BODY}\n[sensor.sampled]\nperiod = 0.3\nnoise = 1e-5\n\
         [estimator.extended_kalman]\n"
    );
    assert!(Scenario::parse("good", &good).is_ok());
    for (what, instead, key, why) in bad {
        let error = Scenario::parse("bad", &good.replace(what, instead)).expect_err(instead).to_string();
        assert!(error.contains(key) && error.contains(why), "{error}");
    }
}
