//! `flexsc layout`: a viewer layout for a log, or for the future logs of a scenario.

use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::record::{Detail, Log};
use flexsc_view::layout::Layout;

use crate::error::CliError;
use crate::memory_log::logged;
use crate::{files, out, print, scenario};

/// Limits of the time on one core (s) and of the memory (bytes) for making a log; beyond them viewers choose the axes.
const LONGEST: f64 = 120.0;
const LARGEST: f64 = 2e9;

#[derive(clap::Args)]
pub struct LayoutArgs {
    /// A log, or a scenario: then the layout is for a log with a scene, or a live run
    #[arg(value_name = "LOG|SCENARIO")]
    path: PathBuf,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// The file to write, such as layout.json [default: stdout]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace a FILE of other content
    #[arg(long, requires = "out")]
    force: bool,
}

pub fn run(args: &LayoutArgs) -> Result<(), CliError> {
    if let Some(path) = &args.out {
        out::file(path, &["json"], &[&args.path])?;
    }
    let layout = if args.path.extension().is_some_and(|extension| extension == "toml") {
        layout_for_scenario(scenario::load(&args.path, &args.set, None)?, &args.path)?
    } else if args.set.is_empty() {
        layout_for_log(&args.path)?
    } else {
        let path = args.path.display();
        return Err(CliError::Arguments(format!("--set: {path} is a log, whose scenario is what was run")));
    };
    let layout = layout.to_json();
    match &args.out {
        Some(path) => files::write(path, layout.as_bytes(), args.force),
        None => print(layout.as_bytes()),
    }
}

/// Returns the layout for a scenario's log with a scene; a simulation determines the range of each value.
fn layout_for_scenario(scenario: Scenario, path: &Path) -> Result<Layout, CliError> {
    let layout = Layout::for_scenario(&scenario).for_detail(Detail::Scene);
    let cost = scenario.cost(Some(Detail::Full), true);
    if cost.seconds > LONGEST || cost.memory > LARGEST {
        return Ok(layout);
    }
    Ok(layout.with_limits(&logged(scenario, path, Detail::Full)?)?)
}

fn layout_for_log(path: &Path) -> Result<Layout, CliError> {
    let log = Log::open(path)?;
    let scenario = Scenario::parse_logged(&path.display().to_string(), log.require_scenario()?, &log)?;
    let layout = Layout::for_log(&scenario, &log)?;
    Ok(layout.with_limits(&log)?)
}
