//! `flexsc simulate --live` in a build without the feature `live`.

use flexsc_core::campaign::CampaignRun;
use flexsc_core::metrics::Metrics;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Record, RecordError, Sample};

use crate::error::CliError;
use crate::unavailable::HINT;

#[derive(clap::Args)]
#[command(next_help_heading = "Live runs")]
#[group(skip)]
pub struct LiveArgs {
    #[arg(long, hide = true, num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub live: Option<String>,
    #[arg(long, hide = true, requires = "live")]
    speed: Option<String>,
    #[arg(long, hide = true, requires = "live")]
    wait: bool,
    #[arg(long, hide = true, requires = "live")]
    paused: bool,
    #[arg(long, hide = true, requires = "live")]
    allow_origin: Vec<String>,
}

/// Placeholder for a live run, which cannot exist in this build.
pub enum Live {}

impl LiveArgs {
    /// Returns an error if a live run is requested.
    pub fn serve(&self, _: &CampaignRun) -> Result<Option<Live>, CliError> {
        match self.live {
            None => Ok(None),
            Some(_) => Err(CliError::Arguments(format!(
                "flexsc simulate --live: needs the feature `live`, which this build leaves out\n\n{HINT}"
            ))),
        }
    }
}

impl Live {
    pub fn finish(self, _: &Metrics) {
        match self {}
    }
}

impl Record for Live {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        match *self {}
    }
}
