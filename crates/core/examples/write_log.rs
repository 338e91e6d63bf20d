//! Log of a run as an MCAP file: written while the run is simulated, then read back.

#![allow(clippy::print_stdout, reason = "it prints topics")]

use std::error::Error;
use std::{env, fs, process};

use flexsc_core::Scenario;
use flexsc_core::campaign::Campaign;
use flexsc_core::record::{Detail, Log, LogFile, RunEnd};

/// Scenario as TOML.
const SCENARIO: &str = include_str!("../../../scenarios/attitude-hold.toml");

/// Detail of the log: all events, and the motion at each period of the scenario's log.
const DETAIL: Detail = Detail::Full;

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("attitude-hold.toml", SCENARIO)?;
    let run = Campaign::new(scenario, "attitude-hold.toml", None)?.run(0)?;

    // The log holds the scenario and the seed, from which the run can be repeated.
    let path = env::temp_dir().join(format!("flexsc-attitude-hold-{}.mcap", process::id()));
    let mut file = LogFile::create(&path, &Campaign::provenance(&run), DETAIL)?;
    let metrics = Campaign::simulate(&run, &mut file)?;
    let bytes = file.finish(&metrics, RunEnd::Complete)?;

    let log = Log::open(&path)?;
    for topic in log.topics() {
        println!("{topic:20} {:6} rows", log.columns(topic)?.len());
    }
    let pointing = log.columns("/pointing")?;
    let times = pointing.numbers("time_s").ok_or("no times")?;
    let last = times.last().ok_or("no rows")?;
    println!("{}: {bytes} bytes, the last motion at {last} s", path.display());
    fs::remove_file(&path)?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
