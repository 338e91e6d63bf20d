//! `flexsc reproduce` in a build without the feature `papers`.

use crate::error::CliError;
use crate::unavailable::HINT;

#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub struct ReproduceArgs {
    /// Whatever is given
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    given: Vec<String>,
}

pub fn run(args: &ReproduceArgs) -> Result<(), CliError> {
    let words = [&["flexsc reproduce".to_owned()], &args.given[..]].concat().join(" ");
    Err(CliError::Arguments(format!(
        "{words}: needs the feature `papers`, which this build leaves out\n\n{HINT}"
    )))
}
