//! `flexsc check`: is a scenario file accepted?

use std::io::Write;
use std::path::PathBuf;

use serde_json::json;

use crate::failure::Failure;
use crate::{print, say, scenario};

#[derive(clap::Args)]
pub struct Args {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Print one JSON object for each scenario on stdout
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    for path in &args.scenarios {
        let scenario = scenario::load(path, &[], None)?;
        let modes = scenario.mode_count();
        let costly = scenario.cost(None, false).excess();
        if args.json {
            let (file, duration) = (path.display().to_string(), scenario.duration.seconds());
            let object = json!({
                "file": file, "scenario": scenario.name, "duration_s": duration, "modes": modes, "accepted": true,
                "needs_yes": costly.is_some(),
            });
            print(format!("{object}\n").as_bytes())?;
            continue;
        }
        say!("{}: accepted: {} s, {modes} modes", path.display(), scenario.duration.seconds());
        if let Some(why) = costly {
            say!("  {why}");
        }
    }
    Ok(())
}
