//! Export of a whole run in a format of other programs.

use std::io::{self, IsTerminal, Write};

use flexsc_core::Scenario;
use flexsc_core::record::Log;
use flexsc_core::scenario::date_from_text;
use flexsc_handover::{HandoverError, HandoverFormat, HandoverOptions, fret_requirements, hand_over};

use super::handover::HandoverArgs;
use super::{ExportArgs, ExportFormat};
use crate::error::CliError;
use crate::{files, out, say, scenario};

/// Returns the options, or an error if one is out of range.
fn options(given: &HandoverArgs) -> Result<HandoverOptions, CliError> {
    let date = |text: &String| {
        date_from_text(text).ok_or_else(|| {
            let accepted = "a date and time from 1970 to 2500, such as 2026-03-20T14:46:00Z";
            CliError::Arguments(format!("--epoch: must be {accepted}, got `{text}`"))
        })
    };
    if let Some(speed) = given.speed.filter(|speed| !(1e-6..=1e9).contains(speed)) {
        return Err(CliError::Arguments(format!("--speed: must be from 1e-6 to 1e9, got {speed}")));
    }
    Ok(HandoverOptions {
        epoch_ns: given.epoch.as_ref().map(date).transpose()?,
        frame: given.frame.clone(),
        center: given.center.clone(),
        object_id: given.object_id.clone(),
        speed: given.speed,
        mode_shapes: given.modes,
    })
}

impl ExportFormat {
    /// Returns the format of a whole run; `None` for a table.
    fn handover(self) -> Option<HandoverFormat> {
        match self {
            Self::Csv | Self::Jsonl | Self::Fret => None,
            Self::Aem => Some(HandoverFormat::Aem),
            Self::Oem => Some(HandoverFormat::Oem),
            Self::Glb => Some(HandoverFormat::Glb),
            Self::Vizard => Some(HandoverFormat::Vizard),
        }
    }
}

/// Exports the run of a log, or the requirements of its scenario.
pub fn run(args: &ExportArgs, format: ExportFormat) -> Result<(), CliError> {
    let Some(format) = format.handover() else { return requirements(args) };
    let options = options(&args.handover)?;
    if args.out.is_none() && format.is_binary() && io::stdout().is_terminal() {
        let why = "this format is not text\n\nhint: name a file with -o";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let bytes = hand_over(&Log::open(&args.log)?, format, &options)?;
    write(args, &bytes)
}

/// Exports the requirements of a scenario, or of that of a log.
fn requirements(args: &ExportArgs) -> Result<(), CliError> {
    args.handover.refuse()?;
    let scenario = if out::ending(&args.log) == Some("toml") {
        scenario::load(&args.log, &[], None)?
    } else {
        let log = Log::open(&args.log)?;
        Scenario::parse_logged(&args.log.display().to_string(), log.require_scenario()?, &log)?
    };
    let found = fret_requirements(&scenario)?;
    for (id, why) in &found.as_text {
        say!("note: {id} is text alone: {why}");
    }
    write(args, found.json.as_bytes())
}

/// Writes to the file or to stdout.
fn write(args: &ExportArgs, bytes: &[u8]) -> Result<(), CliError> {
    match &args.out {
        Some(path) => files::write(path, bytes, args.force),
        None => io::stdout().lock().write_all(bytes).map_err(CliError::Stdout),
    }
}

impl From<HandoverError> for CliError {
    fn from(error: HandoverError) -> Self {
        match error {
            HandoverError::Log(error) => Self::Log(error),
            HandoverError::Scenario(error) => Self::Scenario(error),
            HandoverError::Refused(why) => Self::Arguments(why),
        }
    }
}
