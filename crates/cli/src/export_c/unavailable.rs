//! `flexsc export-c` and `flexsc vectors` in a build without the feature `flight-code`.

use crate::error::CliError;
pub use crate::unavailable::{VerbArgs as ExportCArgs, VerbArgs as VectorsArgs};

pub fn run(args: &ExportCArgs) -> Result<(), CliError> {
    args.refuse("export-c", "flight-code")
}

pub fn run_vectors(args: &VectorsArgs) -> Result<(), CliError> {
    args.refuse("vectors", "flight-code")
}
