//! Formats of a hand-over, and what they need beyond the log.

use flexsc_core::Scenario;
use flexsc_core::formats::celestial_frame::CelestialFrame;
use flexsc_core::spacecraft::environment::{OrbitPath, SurroundingsState, to_mean_of_date};
use nalgebra::UnitQuaternion;

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

/// Axes of a message.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct MessageAxes {
    /// Frame of the axes.
    pub frame: CelestialFrame,
    /// Unit quaternion that rotates components along the run's inertial axes into those along these axes.
    pub turn: UnitQuaternion<f64>,
}

/// Returns true if a frame can be named in a message.
fn is_written(frame: CelestialFrame) -> bool {
    frame != CelestialFrame::Mod
}

/// Options of a hand-over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HandoverOptions {
    /// Date of the start (ns since 1970 UTC), for a run whose scenario has none.
    pub epoch_ns: Option<u64>,
    /// Name of the frame of the message; by default EME2000, or the frame of two-line elements.
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

    /// Returns the axes of a message. An environment of the Earth with a date has known axes, those of the equator and
    /// equinox of that date, which are rotated into the axes of 2000, or those of two-line elements; any others are those that the
    /// option says.
    pub(crate) fn axes(&self, run: &RunLog<'_>) -> Result<MessageAxes, HandoverError> {
        let around = run.scenario.environment.as_ref().filter(|_| other_gravity(run.scenario).is_none());
        let known = around.zip(run.scenario.date_ns()).map(|(around, date)| (around.frame(), date));
        let default = match known {
            Some((frame @ (CelestialFrame::Teme | CelestialFrame::Tod), _)) => frame,
            _ => CelestialFrame::Eme2000,
        };
        let given = self.frame.as_deref();
        let frame = given.map_or(Some(default), |given| {
            CelestialFrame::named(given).filter(|frame| is_written(*frame) && frame.names().0 == given)
        });
        let Some(frame) = frame else {
            let all = CelestialFrame::ALL.into_iter().filter(|(frame, ..)| is_written(*frame));
            let accepted = all.map(|(_, name, _)| name).collect::<Vec<_>>().join(", ");
            let given = given.unwrap_or_default();
            return Err(HandoverError::Refused(format!("--frame: must be one of {accepted}, got `{given}`")));
        };
        let turn = match known {
            Some((own, date)) if own != frame => {
                let to_own = to_mean_of_date(frame, date).filter(|_| own == CelestialFrame::Mod);
                to_own.map(|to_own| UnitQuaternion::new_normalize(to_own).inverse())
            }
            _ => Some(UnitQuaternion::identity()),
        };
        turn.map(|turn| MessageAxes { frame, turn }).ok_or_else(|| {
            let (own, name) = (default.names().0, frame.names().0);
            HandoverError::refused(
                &format!("--frame: {name} differs from the axes of this run by the nutation, which flexsc leaves out"),
                &format!("leave out --frame, for {own}"),
            )
        })
    }
}

/// Gravitational parameter of the Earth (m³/s²), and the relative difference up to which a planet is the Earth.
const EARTH: f64 = 3.986_004_418e14;
const NEAR: f64 = 0.01;

/// Returns the gravitational parameter of the orbit's planet (m³/s²), if that is not the Earth.
pub(crate) fn other_gravity(scenario: &Scenario) -> Option<f64> {
    let sky = scenario.study.surroundings.as_ref().map(SurroundingsState::sky);
    let gravity = sky.and_then(|sky| sky.orbit()).map_or(EARTH, OrbitPath::gravity);
    ((gravity / EARTH - 1.0).abs() >= NEAR).then_some(gravity)
}

/// Returns a text as the value of a keyword: printable ASCII characters on one line, and `_` for all others.
pub fn keyword_value(text: &str) -> String {
    let plain = |c: char| if c == ' ' || c.is_ascii_graphic() { c } else { '_' };
    let value: String = text.trim().chars().take(64).map(plain).collect();
    if value.is_empty() { "UNKNOWN".to_owned() } else { value }
}
