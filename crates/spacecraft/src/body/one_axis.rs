//! The planar body as a scenario describes it: the keys of `[body.planar]`.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Load, Mode, Output, load};

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
    pub drive: Drive,
    /// Damping that couples the modes (1/s): it adds -sum_j `damping_matrix`\[i\]\[j\] x_j' to x_i'', beside the damping ratios.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping_matrix: Vec<Vec<Finite>>,
    /// Elastic modes.
    #[serde(default)]
    pub modes: Vec<Mode>,
    /// Coordinates that are observed in addition to the hub's angle: y = rigid x_r + sum of `modes`\[i\] x_i.
    #[serde(default)]
    pub outputs: Vec<Output>,
}

/// Quantity that the actuator commands.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
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
            drive: Drive::default(),
            damping_matrix: Vec::new(),
            modes: Vec::new(),
            outputs: Vec::new(),
        }
    }
}

impl Planar {
    /// Returns the model of the body, under a torque on the hub or under a load: a generalised torque on the rigid angle and
    /// one on the displacement of each mode, which are all 1 for a torque on the hub.
    ///
    /// # Errors
    /// A load that does not fit, or that comes beside the gains of another one.
    pub fn solve(&self, load: Option<&Load>) -> Result<AxisModel, ConfigError> {
        let mut model = AxisModel::from(self);
        let Some(load) = load else { return Ok(model) };
        if let Some(mode) = self.modes.iter().position(|mode| mode.hub_gain.is_some()) {
            let why = format!(
                "must be left out where a mode has a `hub_gain`, as mode {mode}: its `gain` is that of a load"
            );
            return Err(ConfigError::new("load", why));
        }
        let (rigid, modes) = load.on_parts("rigid", "modes", self.modes.len(), "mode")?;
        let torque = load::torque(&[rigid], &[1.0])?;
        for (mode, load) in model.modes.iter_mut().zip(modes) {
            let gain = Finite::new(mode.hub_gain.get() * (load / torque));
            mode.gain = gain.ok_or_else(|| ConfigError::new("load", "must give the modes finite gains"))?;
        }
        Ok(model)
    }
}

/// Returns an inconsistency between the values of a model: the key, and the reason.
pub fn inconsistency(model: &AxisModel) -> Option<ConfigError> {
    let modes = model.modes.len();
    damping_inconsistency(model).or_else(|| {
        model.outputs.iter().enumerate().find_map(|(index, output)| {
            let position =
                |key: &str, why: String| Some(ConfigError::new(format!("outputs[{index}].{key}"), why));
            if output.modes.len() != modes {
                let found = output.modes.len();
                return position(
                    "modes",
                    format!("must have one number for each of {}, got {found}", counted(modes, "mode")),
                );
            }
            let before = model.outputs[..index].iter();
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

fn damping_inconsistency(model: &AxisModel) -> Option<ConfigError> {
    let modes = model.modes.len();
    let rows = &model.damping_matrix;
    if rows.is_empty() {
        return None;
    }
    if model.drive == CommandedQuantity::Motion {
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

impl From<Drive> for CommandedQuantity {
    fn from(drive: Drive) -> Self {
        match drive {
            Drive::Torque => Self::Torque,
            Drive::Motion => Self::Motion,
        }
    }
}

impl From<CommandedQuantity> for Drive {
    fn from(commanded: CommandedQuantity) -> Self {
        match commanded {
            CommandedQuantity::Torque => Self::Torque,
            CommandedQuantity::Motion => Self::Motion,
        }
    }
}

impl From<&Planar> for AxisModel {
    fn from(body: &Planar) -> Self {
        Self {
            inertia: body.inertia,
            angle: body.angle,
            rate: body.rate,
            drive: body.drive.into(),
            damping_matrix: body.damping_matrix.clone(),
            modes: body.modes.iter().map(Into::into).collect(),
            outputs: body.outputs.iter().map(Into::into).collect(),
        }
    }
}

impl From<&AxisModel> for Planar {
    fn from(model: &AxisModel) -> Self {
        Self {
            inertia: model.inertia,
            angle: model.angle,
            rate: model.rate,
            drive: model.drive.into(),
            damping_matrix: model.damping_matrix.clone(),
            modes: model.modes.iter().map(Into::into).collect(),
            outputs: model.outputs.iter().map(Into::into).collect(),
        }
    }
}
