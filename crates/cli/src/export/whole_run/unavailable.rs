//! Export of a whole run in a build without the feature `handover`.

use clap::ValueEnum;

use super::{ExportArgs, ExportFormat};
use crate::error::CliError;
use crate::unavailable::HINT;

/// Returns the error that the format needs the feature.
pub fn run(_: &ExportArgs, format: ExportFormat) -> Result<(), CliError> {
    let value = format.to_possible_value();
    let name = value.as_ref().map_or("this format", |value| value.get_name());
    Err(CliError::Arguments(format!(
        "{name} needs the feature `handover`, which this build leaves out\n\n{HINT}"
    )))
}
