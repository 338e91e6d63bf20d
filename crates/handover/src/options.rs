//! Formats of a hand-over, and what they need beyond the log.

use crate::error::HandoverError;
use crate::motion_rows::RunLog;

/// Format of a hand-over.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum HandoverFormat {
    /// CCSDS attitude ephemeris message, as text.
    Aem,
    /// CCSDS orbit ephemeris message, as text.
    Oem,
    /// Animated scene in one file, glTF 2.0.
    Glb,
    /// Messages for Vizard, the viewer of Basilisk.
    Vizard,
}

impl HandoverFormat {
    /// All formats with their names.
    pub const ALL: [(&'static str, Self); 4] =
        [("aem", Self::Aem), ("oem", Self::Oem), ("glb", Self::Glb), ("vizard", Self::Vizard)];

    /// Returns the format of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(own, _)| *own == name).map(|(_, format)| format)
    }

    /// Returns true if the file is not text.
    pub fn is_binary(self) -> bool {
        !matches!(self, Self::Aem | Self::Oem)
    }
}

/// Inertial frames that a message may name as the run's inertial axes, each with its name in attitude messages: their
/// registry of frames is another one than that of orbit messages.
pub const REFERENCE_FRAMES: [(&str, &str); 5] = [
    ("EME2000", "EME2000"),
    ("GCRF", "GCRF"),
    ("ICRF", "ICRF"),
    ("TEME", "TEMEOFDATE"),
    ("TOD", "TOD_EARTH"),
];

/// Options of a hand-over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HandoverOptions {
    /// Date of the start (ns since 1970 UTC), for a run whose scenario has none.
    pub epoch_ns: Option<u64>,
    /// Name of the frame of the run's inertial axes.
    pub frame: Option<String>,
    /// Name of the orbited body; the default is EARTH.
    pub center: Option<String>,
    /// International designator of the spacecraft; the default is UNKNOWN.
    pub object_id: Option<String>,
    /// Speed of an animation relative to real time; by default it lasts at most a minute.
    pub speed: Option<f64>,
    /// True if an animated scene also has an animation of each mode's shape.
    pub mode_shapes: bool,
}

impl HandoverOptions {
    /// Returns the date of the run's start (ns since 1970 UTC).
    pub(crate) fn date(&self, run: &RunLog<'_>) -> Result<u64, HandoverError> {
        match (run.scenario.date_ns(), self.epoch_ns) {
            (Some(own), Some(given)) if own != given => Err(HandoverError::refused(
                "--epoch: the scenario has another `epoch`, for which its environment was computed",
                "leave out --epoch",
            )),
            (Some(date), _) | (None, Some(date)) => Ok(date),
            (None, None) => Err(HandoverError::refused(
                "the scenario has no `epoch`, and the format needs the date of the start",
                "give it as `--epoch 2026-03-20T14:46:00Z`, or as the scenario's key `epoch`",
            )),
        }
    }

    /// Returns the names of the frame of the run's inertial axes, in orbit and in attitude messages: if the option is left
    /// out, TOD for an environment with a date, whose Sun, field and sites are in axes of the equator and equinox of date,
    /// else EME2000.
    pub(crate) fn frame(&self, run: &RunLog<'_>) -> Result<(&'static str, &'static str), HandoverError> {
        let of_date = run.scenario.environment.is_some() && run.scenario.date_ns().is_some();
        let given = self.frame.as_deref().unwrap_or(if of_date { "TOD" } else { "EME2000" });
        REFERENCE_FRAMES.into_iter().find(|(name, _)| *name == given).ok_or_else(|| {
            let accepted = REFERENCE_FRAMES.map(|(name, _)| name).join(", ");
            HandoverError::Refused(format!("--frame: must be one of {accepted}, got `{given}`"))
        })
    }
}

/// Returns a text as the value of a keyword: printable ASCII characters on one line, and `_` for all others.
pub fn keyword_value(text: &str) -> String {
    let plain = |c: char| if c == ' ' || c.is_ascii_graphic() { c } else { '_' };
    let value: String = text.trim().chars().take(64).map(plain).collect();
    if value.is_empty() { "UNKNOWN".to_owned() } else { value }
}
