//! Built-in scenarios of the papers, by the paths in their commands: an installed command has no checkout beside it.

use std::path::Path;

use flexsc_core::{Document, Scenario};

use crate::error::CliError;
use crate::examples;

/// Loads a scenario with some keys set, like the command's options `--set` and `--seed`.
pub fn load(path: &Path, set: &[String], seed: Option<u64>) -> Result<Scenario, CliError> {
    let name = path.display().to_string();
    let text = examples::text(&name)?.to_owned();
    crate::scenario::with(Document::parse(&name, text)?, set, seed)
}
