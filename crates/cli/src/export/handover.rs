//! Export of a whole run in a format of other programs.

use std::io::{self, IsTerminal, Write};

use flexsc_core::record::Log;
use flexsc_core::scenario::date_from_text;
use flexsc_handover::{HandoverError, HandoverFormat, HandoverOptions, hand_over};

use super::ExportArgs;
use crate::error::CliError;
use crate::files;

#[derive(clap::Args)]
pub struct HandoverArgs {
    /// Date of the start for aem, oem and vizard, such as 2026-03-20T14:46:00Z [default: the scenario's `epoch`]
    #[arg(long, value_name = "DATE")]
    epoch: Option<String>,
    /// Frame of the inertial axes in aem and oem: EME2000, GCRF, ICRF, TEME or TOD [default: TOD for an environment with
    /// a date, else EME2000]
    #[arg(long, value_name = "FRAME")]
    frame: Option<String>,
    /// Planet of the orbit in oem and vizard, such as MARS [default: EARTH]
    #[arg(long, value_name = "NAME")]
    center: Option<String>,
    /// International designator in aem and oem, such as 2026-012A [default: UNKNOWN]
    #[arg(long, value_name = "ID")]
    object_id: Option<String>,
    /// Speed of the animation in glb relative to real time [default: such that it lasts at most a minute]
    #[arg(long, value_name = "FACTOR")]
    speed: Option<f64>,
    /// Add an animation of each mode's shape to glb
    #[arg(long)]
    modes: bool,
}

impl HandoverArgs {
    /// Returns an error if an option of whole runs is given for a table.
    pub fn refuse_for_table(&self) -> Result<(), CliError> {
        let given = [
            ("--epoch", self.epoch.is_some()),
            ("--frame", self.frame.is_some()),
            ("--center", self.center.is_some()),
            ("--object-id", self.object_id.is_some()),
            ("--speed", self.speed.is_some()),
            ("--modes", self.modes),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((name, _)) => Err(CliError::Arguments(format!(
                "{name}: is for whole runs\n\nhint: `--format aem`, oem, glb or vizard exports one"
            ))),
            None => Ok(()),
        }
    }

    fn options(&self) -> Result<HandoverOptions, CliError> {
        let date = |text: &String| {
            date_from_text(text).ok_or_else(|| {
                let accepted = "a date and time from 1970 to 2500, such as 2026-03-20T14:46:00Z";
                CliError::Arguments(format!("--epoch: must be {accepted}, got `{text}`"))
            })
        };
        if let Some(speed) = self.speed.filter(|speed| !(1e-6..=1e9).contains(speed)) {
            return Err(CliError::Arguments(format!("--speed: must be from 1e-6 to 1e9, got {speed}")));
        }
        Ok(HandoverOptions {
            epoch_ns: self.epoch.as_ref().map(date).transpose()?,
            frame: self.frame.clone(),
            center: self.center.clone(),
            object_id: self.object_id.clone(),
            speed: self.speed,
            mode_shapes: self.modes,
        })
    }
}

/// Exports the run of a log.
pub fn run(args: &ExportArgs, format: HandoverFormat) -> Result<(), CliError> {
    let options = args.handover.options()?;
    if args.out.is_none() && format.is_binary() && io::stdout().is_terminal() {
        let why = "this format is not text\n\nhint: name a file with -o";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let bytes = hand_over(&Log::open(&args.log)?, format, &options)?;
    match &args.out {
        Some(path) => files::write(path, &bytes, args.force),
        None => io::stdout().lock().write_all(&bytes).map_err(CliError::Stdout),
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
