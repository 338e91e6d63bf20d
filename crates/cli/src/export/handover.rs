//! Options of the export of a whole run in a format of other programs.

use crate::error::CliError;
use crate::quantity::in_unit;

#[derive(clap::Args)]
pub struct HandoverArgs {
    /// Date of the start for aem, oem and vizard, such as 2026-03-20T14:46:00Z [default: the scenario's `epoch`]
    #[arg(long, value_name = "DATE")]
    pub(super) epoch: Option<String>,
    /// Frame of aem and oem: EME2000, GCRF, ICRF, TEME or TOD [default: TEME with a `tle`, else EME2000]
    #[arg(long, value_name = "FRAME")]
    pub(super) frame: Option<String>,
    /// Planet of the orbit in oem and vizard, such as MARS [default: EARTH]
    #[arg(long, value_name = "NAME")]
    pub(super) center: Option<String>,
    /// International designator in aem and oem, such as 2026-012A [default: UNKNOWN]
    #[arg(long, value_name = "ID")]
    pub(super) object_id: Option<String>,
    /// Speed of the animation in glb relative to real time [default: such that it lasts at most a minute]
    #[arg(long, value_name = "FACTOR", value_parser = in_unit(""))]
    pub(super) speed: Option<f64>,
    /// Add an animation of each mode's shape to glb
    #[arg(long)]
    pub(super) modes: bool,
}

impl HandoverArgs {
    /// Returns an error if an option of whole runs is given for a table or for requirements.
    pub fn refuse(&self) -> Result<(), CliError> {
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
}
