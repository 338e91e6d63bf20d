//! `flexsc check`: validation of scenario files.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::formats::count::counted;
use flexsc_core::{Scenario, ScenarioError};
use serde_json::json;

use crate::error::CliError;
use crate::human::seconds;
use crate::{print, say, scenario};

#[derive(clap::Args)]
pub struct CheckArgs {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Print one JSON object for each scenario on stdout, with the mistakes of one that is not accepted
    #[arg(long)]
    json: bool,
}

pub fn run(args: &CheckArgs) -> Result<(), CliError> {
    let mut all = true;
    for path in &args.scenarios {
        match scenario::load(path, &[], None) {
            Ok(scenario) => accepted(path, &scenario, args.json)?,
            Err(CliError::Scenario(error)) => {
                if args.json {
                    refused(path, &error)?;
                } else {
                    CliError::Scenario(error).print();
                }
                all = false;
            }
            Err(other) => return Err(other),
        }
    }
    if all { Ok(()) } else { Err(CliError::Told) }
}

fn accepted(path: &Path, scenario: &Scenario, json: bool) -> Result<(), CliError> {
    let (modes, duration) = (scenario.mode_count(), scenario.duration.seconds());
    let cost = scenario.cost(None, false);
    let costly = cost.limit_exceeded();
    if json {
        let object = json!({
            "file": path.display().to_string(), "scenario": scenario.name, "duration_s": duration, "modes": modes,
            "accepted": true, "estimate_s": cost.seconds, "needs_yes": costly.is_some(),
            "remarks": scenario.remarks().iter().map(|of| json!({"key": of.key, "message": of.to_string()})).collect::<Vec<_>>(),
        });
        return print(format!("{object}\n").as_bytes());
    }
    let running_time = seconds(cost.seconds);
    say!(
        "{}: accepted: {duration} s, {}; a run takes about {running_time} on one core",
        path.display(),
        counted(modes, "mode")
    );
    if let Some(why) = costly {
        say!("  {why}");
    }
    for remark in scenario.remarks() {
        say!("  remark: {remark}");
    }
    Ok(())
}

/// Prints each error with its position, in the format that editors and other programs parse.
fn refused(path: &Path, error: &ScenarioError) -> Result<(), CliError> {
    let mistakes = error.mistakes().into_iter().map(|mistake| {
        json!({
            "line": mistake.place.as_ref().map(|place| place.line),
            "column": mistake.place.as_ref().map(|place| place.column),
            "key": mistake.key,
            "message": mistake.message,
            "suggestion": mistake.suggestion,
        })
    });
    let mistakes: Vec<_> = mistakes.collect();
    let object = json!({"file": path.display().to_string(), "accepted": false, "mistakes": mistakes});
    print(format!("{object}\n").as_bytes())
}
