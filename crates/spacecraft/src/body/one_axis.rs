//! The planar body: one angle, any number of elastic modes, driven by one moment.
//!
//! x_r'' = m, x_i'' + 2 zeta_i w_i x_i' + w_i² x_i = k_i m, x = x_r + sum x_i, with m = torque / inertia (\[Silaev\],
//! equation (1); hybrid coordinates, \[Likins70\]). Under a constant torque the rigid part is a parabola and every mode
//! turns about its shifted equilibrium, so that no step size is needed.

use flexsc_dynamics::AxisState;
use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Mode, Output};

/// A planar body: one angle and elastic modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Planar {
    /// Moment of inertia (kg m²); default: 1, and every torque is a reduced moment (rad/s²).
    #[serde(default = "unit")]
    pub inertia: Positive,
    /// Rigid angle at the start (rad).
    #[serde(default)]
    pub angle: Finite,
    /// Rigid rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
    /// Quantity that the actuator commands.
    #[serde(default)]
    pub drive: CommandedQuantity,
    /// Damping that couples the modes (1/s): it adds -sum_j `damping_matrix`\[i\]\[j\] x_j' to x_i'', beside the damping ratios.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping_matrix: Vec<Vec<Finite>>,
    /// Elastic modes.
    #[serde(default)]
    pub modes: Vec<Mode>,
    /// Coordinates that are observed in addition to the hub's angle.
    #[serde(default)]
    pub outputs: Vec<Output>,
}

/// Quantity that the actuator commands.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Drive")]
pub enum CommandedQuantity {
    /// A torque (N m): the modes are those of the free body and contribute to the hub's angle.
    #[default]
    Torque,
    /// The hub's own motion, as an acceleration (rad/s²): the modes are those of the body clamped at the hub and do not
    /// contribute to the hub's angle (\[Rotation\], equations (17) and (18)).
    Motion,
}

/// Second half of the message about a damping matrix on a body that does not turn freely.
pub const HUB_FREE: &str = "couples the modes of a body whose hub turns freely, not one whose hub's motion is given (`drive = \"motion\"`)";

fn unit() -> Positive {
    Positive::ONE
}

impl Default for Planar {
    /// Returns a rigid body of unit inertia at rest.
    fn default() -> Self {
        Self {
            inertia: unit(),
            angle: Finite::default(),
            rate: Finite::default(),
            drive: CommandedQuantity::default(),
            damping_matrix: Vec::new(),
            modes: Vec::new(),
            outputs: Vec::new(),
        }
    }
}

impl Planar {
    /// Returns an inconsistency between values: the key, and the reason.
    pub fn inconsistency(&self) -> Option<ConfigError> {
        let modes = self.modes.len();
        self.damping_inconsistency().or_else(|| {
            self.outputs.iter().enumerate().find_map(|(index, output)| {
                let position =
                    |key: &str, why: String| Some(ConfigError::new(format!("outputs[{index}].{key}"), why));
                if output.modes.len() != modes {
                    let found = output.modes.len();
                    return position(
                        "modes",
                        format!("must have one number for each of {}, got {found}", counted(modes, "mode")),
                    );
                }
                let before = self.outputs[..index].iter();
                if before.map(|other| &other.name).any(|name| *name == output.name) {
                    return position(
                        "name",
                        format!("must differ from the other names, got `{}` again", output.name),
                    );
                }
                None
            })
        })
    }

    fn damping_inconsistency(&self) -> Option<ConfigError> {
        let modes = self.modes.len();
        let rows = &self.damping_matrix;
        if rows.is_empty() {
            return None;
        }
        if self.drive == CommandedQuantity::Motion {
            return Some(ConfigError::new("damping_matrix", HUB_FREE));
        }
        if rows.len() != modes {
            let why = format!("must have one row for each of {}, got {}", counted(modes, "mode"), rows.len());
            return Some(ConfigError::new("damping_matrix", why));
        }
        let index = rows.iter().position(|row| row.len() != modes)?;
        let why =
            format!("must have one number for each of {}, got {}", counted(modes, "mode"), rows[index].len());
        Some(ConfigError::new(format!("damping_matrix[{index}]"), why))
    }

    /// Returns true if the damping matrix couples the modes.
    pub fn is_coupled(&self) -> bool {
        !self.damping_matrix.is_empty()
    }

    /// Returns the ratio of the command to the rigid acceleration (kg m²): 1 if the motion itself is commanded.
    pub fn commanded_inertia(&self) -> f64 {
        match self.drive {
            CommandedQuantity::Torque => self.inertia.get(),
            CommandedQuantity::Motion => 1.0,
        }
    }

    /// Returns true if the inertia is 1, as of a body that is described without one.
    pub fn has_unit_inertia(&self) -> bool {
        self.inertia == Positive::ONE
    }

    /// Returns true if the command is an acceleration (rad/s²) and not a torque (N m): the motion of the hub, or the
    /// reduced moment of a body without inertia.
    pub fn commands_acceleration(&self) -> bool {
        self.drive == CommandedQuantity::Motion || self.has_unit_inertia()
    }

    /// Returns the unit of a torque on the body.
    pub fn torque_unit(&self) -> &'static str {
        if self.has_unit_inertia() { "rad/s²" } else { "N m" }
    }

    /// Returns the name of the commanded quantity and its unit.
    pub fn commanded(&self) -> (&'static str, &'static str) {
        if self.commands_acceleration() { ("acceleration", "rad/s²") } else { ("torque", "N m") }
    }

    /// Returns the state at the start of a run.
    pub fn initial_state(&self) -> AxisState {
        AxisState {
            rigid_angle: self.angle.get(),
            rigid_rate: self.rate.get(),
            modes: self.modes.iter().map(Mode::start).collect(),
        }
    }
}
