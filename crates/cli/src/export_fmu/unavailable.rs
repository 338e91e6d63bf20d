//! `flexsc export-fmu` in a build without the feature `fmu`.

use crate::error::CliError;
use crate::unavailable::HINT;

#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub struct ExportFmuArgs {
    /// Whatever is given
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    given: Vec<String>,
}

pub fn run(args: &ExportFmuArgs) -> Result<(), CliError> {
    let words = [&["flexsc export-fmu".to_owned()], &args.given[..]].concat().join(" ");
    Err(CliError::Arguments(format!(
        "{words}: needs the feature `fmu`, which this build leaves out\n\n{HINT}"
    )))
}
