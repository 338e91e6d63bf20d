//! `flexsc reproduce` in a build without the feature `papers`.

use crate::error::CliError;
pub use crate::unavailable::VerbArgs as ReproduceArgs;

pub fn run(args: &ReproduceArgs) -> Result<(), CliError> {
    args.refuse("reproduce", "papers")
}
