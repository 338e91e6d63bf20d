//! `flexsc check`: is a scenario file accepted?

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::Scenario;

use crate::failure::Failure;
use crate::say;

#[derive(clap::Args)]
pub struct Args {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    for path in &args.scenarios {
        let scenario = Scenario::load(path)?;
        let modes = scenario.mode_count();
        say!("{}: accepted: {} s, {modes} modes", path.display(), scenario.duration.seconds());
    }
    Ok(())
}
