//! Runs in batches have the results of single runs, to the bit, on every processor, at every width and with any number
//! of threads.

#![allow(clippy::large_stack_arrays, reason = "scenarios side by side")]

use std::convert::Infallible;
use std::sync::Arc;

use flexsc_core::batch::{self, BatchJob};
use flexsc_core::campaign::{Campaign, CampaignRun, Grid, RunOutcome};
use flexsc_core::metrics::Selection;
use flexsc_core::numerics::lanes::Processor;
use flexsc_core::{Scenario, Simulation, SimulationError};

use crate::study::{pairs, scenario};
use crate::wheel::{FITTED, FITTED_SENSOR};

/// Number of runs: some full batches and a remainder.
const RUNS: u64 = 19;
/// Five modes with damping.
const DAMPED: &str = "[{ frequency = 0.44, gain = 0.0213, damping = 0.002, displacement = 2.75e-6 }, \
                      { frequency = 0.755, gain = 0.0216, damping = 0.002 }, \
                      { frequency = 1.3, gain = 0.01, damping = 0.003 }, \
                      { frequency = 2.1, gain = 0.01, damping = 0.004 }, \
                      { frequency = 3.4, gain = 0.01, damping = 0.005 }]";
/// Duration beyond the kink of the ramps (s).
const SHORT: (&str, &str) = ("duration", "260.0");

fn runs(scenario: &Scenario) -> Vec<CampaignRun> {
    let study = Campaign::new(scenario.clone(), "beside", None).expect("a campaign");
    (0..RUNS).map(|number| study.run(number).expect("a run")).collect()
}

/// Compares runs in a batch with single runs; returns the number of runs that the widest lanes did not decline.
fn taken(what: &str, scenario: &Scenario) -> usize {
    let runs = runs(scenario);
    let alone: Vec<String> =
        runs.iter().map(|run| format!("{:?}", Campaign::simulate(run, ()).map_err(|_| "failed"))).collect();
    let jobs: Vec<BatchJob<'_>> = runs
        .iter()
        .map(|run| BatchJob { number: run.number, scenario: &run.scenario, selection: &Selection::ALL })
        .collect();
    let mut widest = None;
    for processor in Processor::all() {
        let beside = batch::simulate_on(processor, &jobs);
        let count = beside.iter().flatten().count();
        widest.get_or_insert(count);
        for (number, (alone, metrics)) in pairs(&alone, beside).enumerate() {
            if let Some(metrics) = metrics {
                let beside = format!("{:?}", Ok::<_, &str>(metrics));
                assert_eq!(&beside, alone, "{what}: run {number} with {}", processor.name());
            }
        }
    }
    widest.unwrap_or(usize::MAX)
}

#[test]
fn sampled_loops_with_drifting_frequencies() {
    let one = usize::from(Processor::best().is_some_and(|processor| RUNS as usize % processor.lanes(1) == 1));
    let all = RUNS as usize - one;
    let with = |name: &str, keys: &[(&str, &str)]| {
        scenario(name, &[&FITTED[..], &[SHORT, FITTED_SENSOR], keys].concat())
    };
    let (fixed, scheduled) = ("wheel-fixed-gain", "wheel-scheduled-gain");
    let uncertain = "{ \"body.planar.angle\" = { uniform = [-0.06, 0.06] }, \
                     \"body.planar.modes[0].damping\" = { uniform = [0.001, 0.2] }, \
                     \"law.pd.k_p\" = { relative_uniform = 0.3 } }";
    let sun = "{ common = { sinusoid = { amplitude = 0.1, period = 90.0, phase = 3.0 } } }";
    let each = "{ each = [{ ramp = { time = 50.0, to = 0.5 } }, { ramp = { from = 7.3, time = 20.0, to = 1.2 } }, \
                { sinusoid = { amplitude = 0.2, period = 70.0 } }, { table = [{ time = 3.0, ratio = 1.0 }, \
                { time = 100.0, ratio = 0.7 }] }] }";
    let damped = ("body.planar.modes[0].damping", "0.01");
    for (what, scenario) in [
        ("a constant gain", with(fixed, &[])),
        ("a schedule", with(scheduled, &[])),
        ("uncertain", with(scheduled, &[damped, ("uncertain", uncertain)])),
        ("uncertain delays", with("wheel-robust-gain", &[])),
        ("a long delay", with(scheduled, &[("actuator.wheel.delay", "0.7")])),
        ("a filter", with("wheel-ekf", &[])),
        ("a filter of each mode", with("wheel-ekf", &[("estimator.extended_kalman.ratios", "\"each\"")])),
        ("a filter without back-EMF", with("wheel-ekf", &[("actuator.wheel.back_emf", "0.0")])),
        ("rigid back-EMF", with("wheel-ekf", &[("actuator.wheel.opposes", "\"rigid_rate\"")])),
        ("the Sun", with(scheduled, &[("drift", sun)])),
        ("each mode", with(scheduled, &[("drift", each)])),
        ("exact", with(fixed, &[("law.pd.differentiation", "\"exact\""), ("law.pd.k_d", "900.0")])),
        ("a slow law", with(fixed, &[("law.pd.period", "0.6"), ("law.pd.limit", "0.3")])),
        (
            "a coarse wheel",
            with(fixed, &[("actuator.wheel.quantum", "0.05"), ("sensor.sampled.bias", "1e-4")]),
        ),
        ("odd noise", with("wheel-ekf", &[("disturbance[0].period", "0.7"), ("duration", "261.1")])),
    ] {
        assert_eq!(taken(what, &scenario), all, "{what}");
    }
}

#[test]
fn sampled_loops_with_constant_frequencies() {
    let one = usize::from(Processor::best().is_some_and(|processor| RUNS as usize % processor.lanes(1) == 1));
    let with = |keys: &[(&str, &str)]| scenario("wheel-slow-mode", &[&FITTED[..], &[SHORT], keys].concat());
    let uncertain = "{ \"body.planar.modes[0].frequency\" = { relative_uniform = 0.2 }, \
                     \"actuator.wheel.delay\" = { uniform = [0.01, 0.29] }, \
                     \"actuator.wheel.gain\" = { relative_uniform = 0.1 } }";
    for (what, scenario) in [
        ("as it is", with(&[])),
        (
            "damped",
            with(&[
                ("body.planar.modes[1].damping", "0.02"),
                ("sensor", "{ sampled = { period = 0.3, noise = 1e-5 } }"),
            ]),
        ),
        (
            "uncertain",
            with(&[("uncertain", uncertain), ("sensor", "{ sampled = { period = 0.3, noise = 1e-5 } }")]),
        ),
        ("rigid back-EMF", with(&[("actuator.wheel.opposes", "\"rigid_rate\"")])),
    ] {
        assert_eq!(taken(what, &scenario), RUNS as usize - one, "{what}");
    }
}

#[test]
fn what_a_batch_declines_is_simulated_alone() {
    let silent = "[{ silent = { from = 60.0, to = 63.0 } }]";
    let lost = scenario("wheel-ekf", &[SHORT, ("sensor.sampled.faults", silent)]);
    assert_eq!(taken("a silent sensor", &lost), 0);
    let text = scenario("wheel-ekf", &[SHORT]).to_toml().replace("extended_kalman", "unscented_kalman");
    assert!(taken("unscented", &Scenario::parse("unscented", &text).expect("valid")) > 0);
    for name in ["relay-sampled", "wheel-slow-mode", "rotation-robust"] {
        let short = scenario(name, &[("duration", "40.0")]);
        taken(name, &short);
    }
}

#[test]
fn rows_depend_on_no_thread_and_no_neighbour() {
    let gains = || Some(Grid::linspace("law.relay.k_t".to_owned(), 0.28, 0.40, 40));
    let (minute, short, long) = (("duration", "60.0"), ("duration", "3000.0"), ("duration", "9000.0"));
    let damped = ("body.planar.modes", DAMPED);
    for (name, changes, grid) in [
        ("wheel-robust-gain", &[minute][..], None),
        ("wheel-ekf", &[minute], None),
        ("relay-fixed", &[short], gains()),
        ("relay-adaptive", &[long], gains()),
        ("relay-no-freeze", &[long], gains()),
        ("relay-fixed", &[short, damped], gains()),
        ("relay-adaptive", &[long, damped], gains()),
    ] {
        let study = Campaign::new(scenario(name, changes), "beside", grid);
        let study = Arc::new(study.expect("a campaign"));
        // A light build has no kernels for damped modes.
        let takes = !changes.contains(&damped) || cfg!(feature = "damped-flights");
        assert_eq!(batch::accepts(study.scenario()), takes, "{name}");
        let rows = |threads: usize, beside: bool| {
            let mut rows = Vec::new();
            let work = |run: &CampaignRun| Ok(Campaign::simulate(run, ())?);
            let report = |outcome: Option<RunOutcome>| -> Result<(), Infallible> {
                // All fields but the duration of the computation.
                rows.extend(outcome.map(|RunOutcome { number, drawn, metrics, .. }| {
                    format!("{number} {drawn:?} {metrics:?}")
                }));
                Ok(())
            };
            let Ok(()) = if beside {
                study.for_each_run_in_batches(3..40, threads, &Selection::ALL, work, report)
            } else {
                study.for_each_run(3..40, threads, work, report)
            };
            rows
        };
        let alone = rows(1, false);
        assert_eq!(alone.len(), 37);
        for threads in [1, 2, 8] {
            assert_eq!(rows(threads, true), alone, "{name} on {threads} threads");
        }
    }
}

/// The first run is that of the study; the others switch faster than any mode.
#[test]
fn a_run_that_chatters_has_the_same_error_in_a_batch_and_alone() {
    let torques = Grid::linspace("law.relay.strong".to_owned(), 4e-5, 1e13, 13);
    let study = Campaign::new(scenario("relay-fixed", &[("duration", "60.0")]), "chatter", Some(torques));
    let study = Arc::new(study.expect("a campaign"));
    assert!(batch::accepts(study.scenario()));
    let work = |run: &CampaignRun| Ok(Campaign::simulate(run, ())?);
    let mut errors = Vec::new();
    let report = |outcome: Option<RunOutcome>| -> Result<(), Infallible> {
        errors.extend(
            outcome.map(|outcome| (outcome.number, outcome.metrics.err().map(|why| why.to_string()))),
        );
        Ok(())
    };
    let Ok(()) = study.for_each_run_in_batches(0..13, 1, &Selection::ALL, work, report);
    assert_eq!(errors.iter().filter(|(_, error)| error.is_some()).count(), 12);
    for (number, error) in errors {
        let run = study.run(number).expect("a run");
        let alone = Simulation::new(&run.scenario, number).run(&mut ()).err();
        assert!(
            alone.as_ref().is_none_or(|why| matches!(why, SimulationError::LawChatter { .. })),
            "{alone:?}"
        );
        assert_eq!(error, alone.map(|why| why.to_string()), "run {number}");
    }
}

#[test]
fn a_metric_does_not_depend_on_which_others_are_wanted() {
    let quarter = ("duration", "3000.0");
    for (name, changes) in [
        ("relay-fixed", &[quarter][..]),
        ("relay-adaptive", &[("duration", "9000.0")]),
        ("relay-sampled", &[quarter]),
        ("wheel-ekf", &[SHORT]),
        ("wheel-slow-mode", &[SHORT]),
        ("rotation-robust", &[]),
        ("rotation-sine", &[]),
        ("iss-manoeuvre", &[("duration", "300.0")]),
        ("earth-observer", &[("duration", "60.0")]),
    ] {
        let study = Campaign::new(scenario(name, changes), "selected", None).expect("a campaign");
        let study = Arc::new(study);
        let reported = |selection: &Selection| -> Vec<Vec<(&'static str, String)>> {
            let wanted = selection.clone();
            let work = move |run: &CampaignRun| Ok(Campaign::simulate_metrics(run, &wanted, ())?);
            let mut rows = Vec::new();
            let report = |outcome: Option<RunOutcome>| -> Result<(), Infallible> {
                rows.extend(outcome.map(|outcome| {
                    let metrics = outcome.metrics.expect("a run").0.into_iter();
                    metrics.map(|(meaning, value)| (meaning.name, format!("{value:?}"))).collect::<Vec<_>>()
                }));
                Ok(())
            };
            let Ok(()) = study.for_each_run_in_batches(0..3, 1, selection, work, report);
            rows
        };
        let all = reported(&Selection::ALL);
        for (at, (metric, _)) in all[0].iter().enumerate() {
            let one = reported(&Selection::from_names([metric]).expect("a metric"));
            for (run, row) in one.iter().enumerate() {
                assert_eq!(row[..], all[run][at..=at], "{name}: {metric} of run {run}");
            }
        }
    }
}

/// The lanes are those of the build and of the processor: the feature `wide-lanes` reaches the crate that has them.
#[cfg(target_arch = "x86_64")]
#[test]
fn lanes_are_as_wide_as_the_build_and_the_processor_allow() {
    let has_wide = std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512bw")
        && std::arch::is_x86_feature_detected!("avx512cd")
        && std::arch::is_x86_feature_detected!("avx512dq")
        && std::arch::is_x86_feature_detected!("avx512vl");
    let best = Processor::best().map(Processor::name);
    assert_eq!(best == Some("AVX-512"), cfg!(feature = "wide-lanes") && has_wide, "{best:?}");
    assert!(best.is_some() || !std::arch::is_x86_feature_detected!("avx2"), "{best:?}");
}
