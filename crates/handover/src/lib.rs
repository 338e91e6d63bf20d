//! Hand-over of runs: a log in the formats of other programs.
//!
//! Everything follows from the log and its scenario, so that two exports of a log have equal bytes.

mod aem;
mod calendar;
mod error;
mod fret;
mod glb;
mod motion_rows;
mod oem;
mod options;
mod placement;
mod scene_rows;
mod vizard;

use flexsc_core::Scenario;
use flexsc_core::record::Log;

pub use error::HandoverError;
pub use fret::{FretRequirements, fret_requirements};
pub use options::{HandoverFormat, HandoverOptions};

/// Returns the file of a log in a format of other programs.
///
/// # Errors
/// A log that lacks what the format needs, or options that contradict the run.
pub fn hand_over(
    log: &Log,
    format: HandoverFormat,
    options: &HandoverOptions,
) -> Result<Vec<u8>, HandoverError> {
    let scenario = Scenario::parse_logged(&log.path().display().to_string(), log.require_scenario()?, log)?;
    hand_over_run(log, &scenario, format, options)
}

/// Returns the file of a log of this scenario in a format of other programs.
///
/// # Errors
/// A log that lacks what the format needs, or options that contradict the run.
pub fn hand_over_run(
    log: &Log,
    scenario: &Scenario,
    format: HandoverFormat,
    options: &HandoverOptions,
) -> Result<Vec<u8>, HandoverError> {
    let run = motion_rows::RunLog { log, scenario };
    let made = match format {
        HandoverFormat::Aem => aem::write(&run, options).map(String::into_bytes),
        HandoverFormat::Oem => oem::write(&run, options).map(String::into_bytes),
        HandoverFormat::Glb => glb::write(&run, options),
        HandoverFormat::Vizard => vizard::to_vizard(&run, options),
    };
    made.map_err(|error| error.in_log(log.path()))
}
