//! Kalman filters in the loop, over many runs, and their reaction to nonsense.
//!
//! The reference numbers come from another implementation of the filter, in Python, over 200 runs.

use flexsc_core::campaign::Campaign;
use flexsc_core::metrics::Metrics;
use flexsc_core::record::{Column, Columns, Detail, Log, Trace};
use flexsc_core::{Scenario, Simulation};
use rayon::prelude::*;

use crate::study::{metrics, scenario};
use crate::util::Dir;

const PERIOD: f64 = 0.3;
const BODY: &str = "modes = [{ frequency = 0.3, gain = 1.44 }, { frequency = 0.8, gain = 0.21 }, \
                    { frequency = 1.0, gain = 0.165 }, { frequency = 2.0, gain = 0.72 }]";
/// Base law alone, which does not read the filter.
const WATCHING: (&str, &str) = ("law.pd.extra", "{ gain = 0.0 }");

/// Returns the spacecraft whose frequencies fall to a third in 200 s, with these keys of its filter set.
fn ekf(set: &[(&str, &str)]) -> Scenario {
    let full = |key: &str| key.replace("filter.", "estimator.extended_kalman.");
    let keys: Vec<(String, &str)> = set.iter().map(|(key, value)| (full(key), *value)).collect();
    let keys: Vec<_> = keys.iter().map(|(key, value)| (key.as_str(), *value)).collect();
    scenario("wheel-settling-fit", &keys)
}

/// Returns this spacecraft with an unscented filter.
fn unscented(set: &[(&str, &str)]) -> Scenario {
    let text = ekf(set).to_toml().replace("estimator.extended_kalman", "estimator.unscented_kalman");
    Scenario::parse("unscented", &text).expect("valid")
}

/// Returns the metrics of `count` runs.
fn runs(scenario: &Scenario, count: u64) -> Vec<Metrics> {
    let study = Campaign::new(scenario.clone(), "filters", None).expect("a campaign");
    let run = |number| Campaign::simulate(&study.run(number).expect("a run"), ()).expect("metrics");
    (0..count).into_par_iter().map(run).collect()
}

/// Returns a metric of all runs, the smallest first.
fn sorted(runs: &[Metrics], name: &str) -> Vec<f64> {
    let mut values: Vec<f64> = runs.iter().map(|run| run.number(name).expect("a metric")).collect();
    values.sort_by(f64::total_cmp);
    values
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the root mean square over all samples of all runs.
fn rms(runs: &[Metrics]) -> f64 {
    let squares: Vec<f64> = sorted(runs, "frequency_error_rms_rad_s").iter().map(|rms| rms * rms).collect();
    mean(&squares).sqrt()
}

#[test]
fn extended_filter_follows_the_drift() {
    // Over 200 runs: rms 0.00111, largest error 0.0034 in the median and 0.0068 at most, NEES over the number of states
    // 1.01, NIS 1.012, no loss. A run's rms scatters by a fifth, and over 1200 runs 0.7 % begin with errors so large
    // that their rms is above 0.003.
    let runs = runs(&ekf(&[WATCHING, ("duration", "200")]), 200);
    let follows = |run: &Metrics| run.number("frequency_error_rms_rad_s").expect("a metric") < 3e-3;
    let (runs, astray): (Vec<_>, Vec<_>) = runs.into_iter().partition(follows);
    assert!(astray.len() <= 4, "{astray:?}");
    let largest = sorted(&runs, "frequency_error_max_rad_s");
    // Squares of errors have long tails: the rms of two sets of 200 runs differ by 8 %, and 0.15 is twice
    // that. The median of the largest error, which has none, is that of the other set within 4 %, and 0.1 is
    // two and a half times that.
    assert!((rms(&runs) / 1.11e-3 - 1.0).abs() < 0.15, "{}", rms(&runs));
    assert!(
        (largest[100] / 3.4e-3 - 1.0).abs() < 0.1 && *largest.last().expect("runs") < 0.015,
        "{largest:?}"
    );
    let [nees, nis, inside] =
        ["nees_mean", "nis_mean", "nis_inside_95"].map(|name| mean(&sorted(&runs, name)));
    // Errors of a run are hardly independent: three standard errors of two sets of 200 such runs, if each has
    // 10 independent numbers, are 3 sqrt(2 2/(200 10)) = 0.13. Innovations are, 667 a run: 3 sqrt(2 2/(200
    // 667)) = 0.016; 0.94 has two digits.
    assert!((nees - 1.01).abs() < 0.13, "{nees}");
    assert!((nis - 1.012).abs() < 0.016 && (inside - 0.94).abs() < 0.011, "{nis} {inside}");
    assert_eq!(sorted(&runs, "lock_lost").last(), Some(&0.0));
}

#[test]
fn unscented_filter_follows_it_and_is_less_sure() {
    let runs = runs(&unscented(&[WATCHING, ("duration", "200")]), 60);
    // The same error of the other set of 200, of 60 runs.
    assert!((rms(&runs) / 1.11e-3 - 1.0).abs() < 0.15, "{}", rms(&runs));
    let nees = mean(&sorted(&runs, "nees_mean"));
    assert!((0.75..1.0).contains(&nees) && sorted(&runs, "lock_lost")[59] == 0.0, "{nees}");
}

#[test]
fn scheduled_gain_follows_the_filter() {
    // The Python implementation: median 171.9 s, all between 138 s, where a swing just stays within the band, and 174
    // s. The page that this study comes from says 173.4 s. With the mode known the loop settles in 172.0 s.
    let runs = runs(&ekf(&[]), 60);
    let settling = sorted(&runs, "settling_time_s");
    // A sample of 0.3 s.
    assert!((settling[30] - 172.0).abs() < 0.31, "{settling:?}");
    assert!(settling[0] > 138.0 && settling[59] < 200.0, "{settling:?}");
}

#[test]
fn robust_schedule_beats_the_middle_and_none() {
    // The same draws for all three: in the median a third sooner than none, and more often within 200 s than the middle.
    let robust = scenario("wheel-robust-gain", &[]);
    let middle = scenario("wheel-scheduled-gain", &[]);
    let table = |scenario: &Scenario| scenario.to_toml().parse::<toml::Table>().expect("TOML");
    let with = |extra: toml::Value| {
        let mut table = table(&robust);
        table["law"]["pd"].as_table_mut().expect("a law").insert("extra".to_owned(), extra);
        Scenario::parse("other", &table.to_string()).expect("valid")
    };
    let none = toml::Value::Table("gain = 0.0".parse().expect("TOML"));
    let settling = |scenario: &Scenario| -> Vec<f64> {
        let of = |run: &Metrics| run.number("settling_time_s").expect("a metric");
        runs(scenario, 50).iter().map(of).collect()
    };
    let ours = settling(&robust);
    let middle = settling(&with(table(&middle)["law"]["pd"]["extra"].clone()));
    let none = settling(&with(none));
    let median = |times: &[f64]| {
        let mut times = times.to_vec();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let met = |times: &[f64]| times.iter().filter(|&&time| time <= 200.0).count();
    assert!(median(&ours) < 0.7 * median(&none), "{ours:?} {none:?}");
    assert!(met(&ours) > met(&middle) + 3 && met(&ours) >= 43, "{} {}", met(&ours), met(&middle));
}

#[test]
fn bad_priors_lose_the_body_and_the_filter_says_so() {
    // The other implementation lost 3 of 200 for good.
    let runs = runs(&ekf(&[WATCHING, ("duration", "200"), ("filter.ratio_sd", "0.1")]), 200);
    // Of a rate of 3 in 200 runs 95 % of the counts are 1 to 14, of a rate of 7, which is found here, 99 %.
    let lost = sorted(&runs, "lock_lost").iter().sum::<f64>();
    assert!((1.0..=14.0).contains(&lost), "{lost}");
    // Runs without a loss of lock are as good as with a good prior.
    let kept: Vec<Metrics> = runs.into_iter().filter(|run| run.number("lock_lost") == Some(0.0)).collect();
    let median = sorted(&kept, "frequency_error_rms_rad_s")[kept.len() / 2];
    assert!(median < 1.5e-3, "{median}");
}

#[test]
fn quiet_body_teaches_nothing() {
    // Without the gate the filter claims a hundredth of a rad/s while it is off by more than a tenth.
    let end = |gate: &str| {
        let quiet =
            [("body.planar.angle", "0.0"), ("disturbance", "[]"), ("duration", "200"), ("filter.gate", gate)];
        let study = Campaign::new(open(&quiet), "quiet", None).expect("a campaign");
        let each = |number| {
            let mut trace = Trace::new(Detail::Full);
            Simulation::new(&study.run(number).expect("a run").scenario, number)
                .run(&mut trace)
                .expect("a run");
            let estimates = trace.topic("/estimator").expect("a topic");
            let last = |name: &str| *estimates.numbers(name).and_then(|c| c.last()).expect("a row");
            let error = last("ratio") - 1.0 / 3.0;
            (0.3 * error, 0.3 * last("ratio_sd"))
        };
        let ends: Vec<(f64, f64)> = (0..30).into_par_iter().map(each).collect();
        let rms =
            |of: fn(&(f64, f64)) -> f64| (ends.iter().map(|end| of(end).powi(2)).sum::<f64>() / 30.0).sqrt();
        (rms(|end| end.0), rms(|end| end.1))
    };
    let (error, claim) = end("0.0");
    assert!(error > 0.1 && claim < 0.01, "{error} {claim}");
    let (error, claim) = end("3.0");
    // Three standard errors of a root mean square of 30 errors: 3/sqrt(2 30) = 0.39.
    assert!(error < 1.39 * claim, "{error} {claim}");
}

#[test]
fn a_drifting_body_is_followed_where_its_vibration_is_ten_times_the_noise() {
    // A gate of ten standard deviations shuts the filter off from a body that it could follow: over 200 runs it is
    // 0.0179 rad/s off, without a gate 0.0035.
    let noisy = |gate: &[(&str, &str)]| {
        runs(&ekf(&[&[("duration", "200"), ("sensor.sampled.noise", "1e-4")], gate].concat()), 100)
    };
    let (with, without) = (noisy(&[]), noisy(&[("filter.gate", "0.0")]));
    // With equal draws the gate costs 5 %; one that shuts off costs a factor of five.
    assert!(rms(&with) < 1.1 * rms(&without), "{} {}", rms(&with), rms(&without));
    assert!(mean(&sorted(&with, "nees_mean")) < 3.0);
}

/// Returns the spacecraft without a law.
fn open(set: &[(&str, &str)]) -> Scenario {
    let text = ekf(set).to_toml();
    let mut table: toml::Table = text.parse().expect("TOML");
    table.insert("law".to_owned(), toml::Value::Table("open = {}".parse().expect("TOML")));
    let filter = table["estimator"]["extended_kalman"].as_table_mut().expect("a filter");
    filter.insert("watch_only".to_owned(), true.into());
    Scenario::parse("open", &table.to_string()).expect("valid")
}

/// Returns true if every number in these columns is finite.
fn finite(columns: &Columns) -> bool {
    columns.columns.iter().all(|(_, column)| match column {
        Column::Numbers(numbers) => numbers.iter().all(|number| number.is_finite()),
        Column::Rows(_, rows) => finite(rows),
        _ => true,
    })
}

#[test]
fn nonsense_is_reported_as_a_lost_lock() {
    let fault = |fault: &'static str| ("sensor.sampled.faults", fault);
    let ratio = |ratio: &'static str| ("filter.ratio", ratio);
    let cases = [
        ("silent from the start", fault("[{ silent = { from = 0.0 } }]"), true),
        ("silent", fault("[{ silent = { from = 60.0 } }]"), true),
        ("silent for a while", fault("[{ silent = { from = 60.0, to = 63.0 } }]"), false),
        ("stuck", fault("[{ stuck = { from = 60.0 } }]"), true),
        ("frequencies wrong by a half", ratio("1.5"), true),
        ("frequencies wrong by a half downwards", ratio("0.5"), true),
    ];
    for (what, key, lost) in cases {
        // A wrong ratio with a narrow prior of 3 %.
        let set = &[key];
        for scenario in [ekf(set), unscented(set)] {
            let mut trace = Trace::new(Detail::Full);
            Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
            for topic in ["/estimator", "/attitude", "/torque"] {
                let columns = trace.topic(topic).expect("a topic");
                assert!(finite(columns), "{what}: {topic}");
            }
            let metrics = metrics(scenario);
            let found = metrics.number("lock_lost_at_s").expect("a metric");
            assert_eq!(metrics.number("lock_lost"), Some(f64::from(u8::from(lost))), "{what}: {metrics:?}");
            assert_eq!(found.is_nan(), !lost, "{what}: {found}");
        }
    }
}

/// A body in a loop of a PD law, with a filter that knows its frequencies or not.
fn looped(estimator: &str) -> Scenario {
    let text = format!(
        "duration = 120.0\n[law.pd]\nk_p = 3.75e-3\nk_d = 0.0413\nperiod = {PERIOD}\n[body.planar]\nangle = 0.06\n{BODY}\n\
         [sensor.sampled]\nperiod = {PERIOD}\nnoise = 1e-5\n[estimator.{estimator}\nwatch_only = true\n"
    );
    Scenario::parse("looped", &text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn filters_in_the_loop_are_honest() {
    // Without noise in the moment: a filter with this knowledge, and with the frequencies, is optimal.
    let linear = metrics(looped("kalman]\nprior = 'drawn'\nmoment_noise = 0.0"));
    let number = |name: &str| linear.number(name).expect("a metric");
    // Three standard errors of 400 innovations: 3 sqrt(2/400) = 0.21 and 3 sqrt(0.95 0.05/400) = 0.033. The
    // errors of one run are a few independent numbers.
    assert!((number("nis_mean") - 1.0).abs() < 0.21, "{linear:?}");
    assert!((number("nis_inside_95") - 0.95).abs() < 0.033, "{linear:?}");
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
fn a_filter_that_is_read_does_not_watch_only() {
    let text = ekf(&[]).to_toml();
    let both =
        text.replace("[estimator.extended_kalman]\n", "[estimator.extended_kalman]\nwatch_only = true\n");
    let error = Scenario::parse("both", &both).expect_err("read").to_string();
    assert!(
        error.contains("estimator.extended_kalman.watch_only") && error.contains("law.pd.extra"),
        "{error}"
    );
    // An estimator that no law reads does not change the run, and the summary says so.
    let dir = Dir::new();
    dir.write("loop.toml", looped("extended_kalman]").to_toml());
    dir.run("simulate loop.toml --log none --set duration=3 --all").exits(0).says(&["not used by the law"]);
    let mut alone: toml::Table = looped("extended_kalman]").to_toml().parse().expect("TOML");
    alone.remove("estimator");
    let alone = metrics(Scenario::parse("alone", &alone.to_string()).expect("valid"));
    let watched = metrics(looped("extended_kalman]"));
    let itae = |of: &Metrics| of.number("itae").expect("a metric");
    assert_eq!(itae(&alone).to_bits(), itae(&watched).to_bits());
}

#[test]
fn without_a_prior_the_filter_does_not_start_from_the_truth() {
    // A start from the truth has no error at the first sample: NEES of 0.
    let first = |keys: &str| {
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&looped(&format!("extended_kalman]{keys}")), 0).run(&mut trace).expect("a run");
        trace.topic("/estimator").expect("a topic").numbers("nees").expect("a column")[0]
    };
    assert_eq!(first(""), first("\nprior = 'drawn'"));
    assert!(first("") > 2.0 * first("\nprior = 'true'"), "{} {}", first(""), first("\nprior = 'true'"));
}

#[test]
fn gyro_sharpens_the_estimate() {
    let spec = "extended_kalman]\nprior = 'drawn'\nmoment_noise = 1e-15\nassess = [30, 120]";
    let error = |gyro: &str| {
        let text = looped(spec).to_toml().replace("[sensor.sampled]\n", &format!("[sensor.sampled]\n{gyro}"));
        let metrics = metrics(Scenario::parse("gyro", &text).expect("valid"));
        // Two and a half standard errors of 300 innovations: 2.5 sqrt(2/300) = 0.2.
        assert!((metrics.number("nis_mean").expect("a metric") - 1.0).abs() < 0.2, "{metrics:?}");
        metrics.number("frequency_error_rms_rad_s").expect("a metric")
    };
    let (without, with) = (error(""), error("rate_noise = 1e-6\n"));
    // 0.37 of the error is left.
    assert!(with < 0.5 * without, "{with} {without}");
}

#[test]
fn estimates_are_in_a_full_log() {
    let dir = Dir::new();
    dir.write("loop.toml", looped("extended_kalman]\nprior = 'drawn'").to_toml());
    dir.run("simulate loop.toml --log full --set duration=3").exits(0).says(&[
        "frequency",
        "estimate off by",
        "stable",
    ]);
    dir.run("simulate loop.toml --log none --set duration=3 --set estimator.extended_kalman.assess=[30,120]")
        .exits(0)
        .says(&["not assessed"]);
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
        ("watch_only = true", "", "estimator.extended_kalman", "is not used"),
        ("watch_only = true", "watch_only = false", "`watch_only = true`", "the filter is assessed"),
        ("extended_kalman]\nwatch_only = true", "truth]", "estimator.truth", "is not used"),
        ("kalman]", "kalman]\nsubsteps = 0", "substeps", "must be 1 to 100 steps, got 0"),
    ];
    let good = format!(
        "duration = 10.0\n[law.open]\n[body.planar]\nangle = 0.06\n{BODY}\n[sensor.sampled]\nperiod = 0.3\nnoise = 1e-5\n\
         [estimator.extended_kalman]\nwatch_only = true\n"
    );
    assert!(Scenario::parse("good", &good).is_ok());
    for (what, instead, key, why) in bad {
        let error = Scenario::parse("bad", &good.replace(what, instead)).expect_err(instead).to_string();
        assert!(error.contains(key) && error.contains(why), "{error}");
    }
}

/// After the window of the study the filter is overconfident, as the scenario's comment says.
#[test]
fn the_study_says_what_happens_after_its_window() {
    let dir = Dir::with(&["wheel-settling-fit"]);
    let comment = dir.text("wheel-settling-fit.toml");
    for (window, said) in [("[200,400]", 2.8), ("[400,600]", 5.2)] {
        let set = format!("--set estimator.extended_kalman.assess={window}");
        let found =
            dir.run(&format!("simulate wheel-settling-fit.toml --log none --json {set}")).exits(0).json();
        let mean = found["metrics"]["nees_mean"].as_f64().expect("a number");
        assert!((mean - said).abs() < 0.06 && comment.contains(&said.to_string()), "{window}: {mean}");
    }
}
