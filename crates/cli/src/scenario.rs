//! Selection of a scenario and its keys by command-line arguments.

use std::io::Read;
use std::path::{Path, PathBuf};

use flexsc_core::requirement_verdict::validate_metrics;
use flexsc_core::{Document, LONGEST, Scenario};

use crate::error::CliError;
use crate::examples;

/// Largest integer of TOML.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// One scenario to analyse.
#[derive(clap::Args)]
#[group(skip)]
pub struct ScenarioArgs {
    /// Scenario file
    pub scenario: PathBuf,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Mode of operation that acts throughout, of a scenario with several; of a law with stages, the index of one
    #[arg(long, value_name = "NAME")]
    pub mode: Option<String>,
    /// Print one JSON object to stdout
    #[arg(long)]
    pub json: bool,
}

/// Seed and number of threads of runs.
#[derive(Copy, Clone, Debug, clap::Args)]
#[group(skip)]
pub struct RunArgs {
    /// Seed of all random numbers [default: the scenario's]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    pub seed: Option<u64>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

impl RunArgs {
    /// Returns the number of threads; 0 for one per core.
    pub fn threads(self) -> u16 {
        self.jobs.unwrap_or(0)
    }
}

impl ScenarioArgs {
    /// Loads the scenario.
    pub fn load(&self) -> Result<Scenario, CliError> {
        self.in_mode(load(&self.scenario, &self.set, None)?)
    }

    /// Returns a scenario in the chosen mode of operation, if one is chosen.
    pub fn in_mode(&self, scenario: Scenario) -> Result<Scenario, CliError> {
        Ok(match &self.mode {
            Some(name) => scenario.in_mode(name)?,
            None => scenario,
        })
    }
}

/// Reads a scenario file with some keys set.
pub fn load(path: &Path, set: &[String], seed: Option<u64>) -> Result<Scenario, CliError> {
    with(document(path)?, set, seed)
}

/// Reads a document; `-` is stdin.
pub fn document(path: &Path) -> Result<Document, CliError> {
    if path != Path::new("-") {
        return Document::load(path).map_err(|fault| match examples::copy_hint(path) {
            Some(hint) => CliError::Arguments(format!("{fault}\n\nhint: {hint}")),
            None => fault.into(),
        });
    }
    let unread =
        |why: std::io::Error| CliError::Arguments(format!("cannot read a scenario from stdin: {why}"));
    let mut text = Vec::new();
    std::io::stdin().lock().take(LONGEST + 1).read_to_end(&mut text).map_err(unread)?;
    Ok(Document::read_bytes(Path::new("stdin"), text)?)
}

/// Returns a document's scenario with some keys set.
pub fn with(mut document: Document, set: &[String], seed: Option<u64>) -> Result<Scenario, CliError> {
    for text in set {
        let Some((key, value)) = text.split_once('=') else {
            return Err(CliError::Arguments(format!(
                "--set {text}: not a KEY=VALUE, such as law.relay.k_t=0.34"
            )));
        };
        document.set_text(key.trim(), value.trim())?;
    }
    let mut scenario = Scenario::from_document(&document)?;
    validate_metrics(&scenario).map_err(|fault| document.at_key(&fault))?;
    scenario.written.seed = seed.unwrap_or(scenario.seed);
    Ok(scenario)
}
