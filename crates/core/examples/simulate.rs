//! Simulation of a shipped scenario, and its metrics: a relay law excites two elastic modes and ends in a limit cycle.

#![allow(clippy::print_stdout, reason = "it prints metrics")]

use std::error::Error;

use flexsc_core::metrics::MetricsCollector;
use flexsc_core::prelude::*;

/// Scenario as TOML; `Scenario::load` reads one from a file.
const SCENARIO: &str = include_str!("../../../scenarios/relay-fixed.toml");

/// Number of the run, which selects the random numbers of noise and of uncertain keys.
const RUN: u64 = 0;

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("relay-fixed.toml", SCENARIO)?;
    let mut collector = MetricsCollector::new(&scenario);
    Simulation::new(&scenario, RUN).run(&mut collector)?;
    let metrics = collector.finish(&scenario);

    // Some metrics are words or lists; a number is NaN where the run has no value of it.
    for (metric, _) in &metrics.0 {
        if let Some(value) = metrics.number(metric.name).filter(|value| value.is_finite()) {
            println!("{:30} {value:12.5e} {}", metric.name, metric.unit);
        }
    }
    let period = metrics.number("cycle_period_s").ok_or("no metric of limit cycles")?;
    println!("The limit cycle has a period of {period:.2} s.");
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
