//! Consent of the user to long computations.

use flexsc_core::scenario::Cost;

use crate::failure::Failure;

/// Whether long work is wanted.
#[derive(clap::Args, Copy, Clone)]
#[group(skip)]
pub struct Consent {
    /// Run even if it is estimated to take over 10 h on one core, 4 GB of memory or 20 GB of logs
    #[arg(long)]
    yes: bool,
}

impl Consent {
    /// Returns an error if the work costs too much and the user has not consented.
    pub fn to(self, cost: &Cost) -> Result<(), Failure> {
        match cost.excess() {
            Some(why) if !self.yes => {
                Err(Failure::Arguments(format!("{why}\n\nhint: `--yes` runs it anyway")))
            }
            _ => Ok(()),
        }
    }
}
