//! Campaign of 100 runs: residual vibration of a panel rotation whose hinge stiffnesses are uncertain by 20 %.

#![allow(clippy::print_stdout, reason = "it prints statistics")]

use std::error::Error;
use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, RunError};
use flexsc_core::metrics::Selection;
use flexsc_core::statistics::MetricColumns;

/// Scenario as TOML; its table `[uncertain]` names the keys that are drawn for each run.
const SCENARIO: &str = include_str!("../../../scenarios/rotation-robust.toml");

/// Number of runs.
const RUNS: u64 = 100;
/// Number of threads: 0 is one for each core. The results do not depend on it.
const THREADS: usize = 0;
/// Metrics that are printed.
const PRINTED: [&str; 3] = ["arrival_angle_error_rad", "angle_residual_rad", "residual_energy_j"];

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("rotation-robust.toml", SCENARIO)?;
    let campaign = Arc::new(Campaign::new(scenario, "rotation-robust.toml", None)?);
    let mut columns = MetricColumns::default();
    campaign.for_each_run_in_batches::<RunError>(
        0..RUNS,
        THREADS,
        &Selection::ALL,
        |run| Ok(Campaign::simulate(run, ())?),
        |outcome| {
            // While no run ends, this is called without an outcome, so that a program can show progress or stop.
            if let Some(outcome) = outcome {
                columns.add(&outcome.metrics?);
            }
            Ok(())
        },
    )?;

    println!("{} runs", columns.runs());
    for metric in columns.finish().iter().filter(|metric| PRINTED.contains(&metric.name.as_str())) {
        let [low, _, median, _, high] = metric.quantiles;
        println!(
            "{:24} median {median:10.3e}, 5 % to 95 % {low:10.3e} to {high:10.3e} {}",
            metric.name, metric.unit
        );
    }
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
