//! `flexsc export-fmu` in a build without the feature `fmu`.

use crate::error::CliError;
pub use crate::unavailable::VerbArgs as ExportFmuArgs;

pub fn run(args: &ExportFmuArgs) -> Result<(), CliError> {
    args.refuse("export-fmu", "fmu")
}
