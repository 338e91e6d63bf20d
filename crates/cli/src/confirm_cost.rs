//! Consent of the user to long computations.

use std::io::Write;

use flexsc_core::scenario::Cost;

use crate::error::CliError;
use crate::say;

/// Whether long work is wanted.
#[derive(clap::Args, Copy, Clone)]
#[group(skip)]
pub struct CostConfirmation {
    /// Run even if it is estimated to take over 10 h on one core, 4 GB of memory or 20 GB of logs
    #[arg(long)]
    yes: bool,
}

impl CostConfirmation {
    /// Returns an error if the work costs too much and the user has not consented; prints the estimate of work that takes
    /// noticeably long.
    pub fn check(self, cost: &Cost) -> Result<(), CliError> {
        match cost.limit_exceeded() {
            Some(why) if !self.yes => {
                Err(CliError::Arguments(format!("{why}\n\nhint: `--yes` runs it anyway")))
            }
            _ => {
                if let Some(work) = cost.notice() {
                    say!("note: {work}");
                }
                Ok(())
            }
        }
    }
}
