//! Measured path from a force or a torque at a point to a line of sight, which takes the place of the model in linear tools.

use std::f64::consts::TAU;
use std::path::Path;

use flexsc_formats::document::{ConfigError, units_ratio};
use flexsc_formats::response_table::{POLAR, ResponseTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::requirement::ErrorAxis;

/// Reason for which a scenario with a measured path has no run.
pub const PATH_HAS_NO_RUN: &str =
    "has no run: it is a response over frequency, which linear tools such as `spectrum` have";

/// Response of a line of sight to a force along, or a torque about, an axis at a point, measured over frequency: by a shaker, or by the
/// frequency response of a structural solver. Before a fine mirror.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredPath {
    /// Point at which the load acts.
    pub point: String,
    /// Axis of the body along which the force acts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<ErrorAxis>,
    /// Axis of the body about which the torque acts, in place of a force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<ErrorAxis>,
    /// Axis of the body about which the line of sight turns.
    pub about: ErrorAxis,
    /// Response over frequency, or the path of a .csv file: frequency (Hz), and its real and imaginary part.
    pub table: ResponseTable,
    /// Unit of the phase, `rad` or `deg`, of a table with magnitude and phase in place of real and imaginary part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<String>,
    /// Unit of the response, such as `arcsec/N`; default: rad per N of a force, rad per N m of a torque.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

impl MeasuredPath {
    /// Returns the number of the component of the load: the force along x, y and z, then the torque.
    pub fn part(&self) -> usize {
        match (self.force, self.torque) {
            (Some(axis), _) => axis as usize,
            (None, axis) => 3 + axis.map_or(0, |axis| axis as usize),
        }
    }

    /// Reads the file of the table relative to `directory`; returns the key and the reason.
    pub fn read(&mut self, directory: &Path) -> Option<ConfigError> {
        let why = self.table.read(directory).err()?;
        Some(ConfigError::new("table", why))
    }

    /// Returns an inconsistent key of the path, with the reason.
    pub fn validate(&self) -> Option<ConfigError> {
        let refused = |key: &str, why: String| Some(ConfigError::new(key, why));
        if self.force.is_some() == self.torque.is_some() {
            return refused("force", "must be given, or `torque`: the axis of one of them".to_owned());
        }
        if let Some(unit) = self.unit.as_ref().filter(|_| self.size().is_none()) {
            return refused(
                "unit",
                format!(
                    "must be an angle per {}, such as rad/{}, got `{unit}`",
                    self.load_unit(),
                    self.load_unit()
                ),
            );
        }
        let is_polar = self.table.header().map(|header| header == POLAR);
        match (&self.phase, is_polar) {
            (Some(unit), _) if !["rad", "deg"].contains(&unit.as_str()) => {
                return refused("phase", format!("must be `rad` or `deg`, got `{unit}`"));
            }
            (None, Some(true)) => {
                let why = "is missing: the unit of the phase in the table, `rad` or `deg`";
                return refused("phase", why.to_owned());
            }
            (Some(_), Some(false)) => {
                let why = "is that of a table with magnitude and phase, and this has real and imaginary part";
                return refused("phase", why.to_owned());
            }
            _ => {}
        }
        self.table.fault().and_then(|why| refused("table", why))
    }

    /// Returns the unit of the load.
    fn load_unit(&self) -> &'static str {
        if self.force.is_some() { "N" } else { "(N m)" }
    }

    /// Returns the size of the unit of the response in rad/N or rad/(N m); `None` if it has none.
    fn size(&self) -> Option<f64> {
        self.unit.as_ref().map_or(Some(1.0), |unit| units_ratio(unit, &format!("rad/{}", self.load_unit())))
    }

    /// Returns the frequencies (rad/s) with the real and imaginary part of the response (rad/N or rad/(N m)).
    pub fn responses(&self) -> Vec<(f64, [f64; 2])> {
        let size = self.size().unwrap_or(1.0);
        let angle = match self.phase.as_deref() {
            Some("deg") => Some(std::f64::consts::PI / 180.0),
            Some(_) => Some(1.0),
            None => None,
        };
        let response = |row: &Vec<f64>| match angle {
            Some(angle) => {
                [size * row[1] * libm::cos(angle * row[2]), size * row[1] * libm::sin(angle * row[2])]
            }
            None => [size * row[1], size * row[2]],
        };
        self.table.rows().iter().map(|row| (TAU * row[0], response(row))).collect()
    }
}
