//! The spatial body: three axes, and elastic modes with their shapes at named points of the structure.
//!
//! J w' + w x J w = M, Q' = 1/2 Q o (0, w), and q_i'' + 2 zeta_i w_i q_i' + w_i² q_i = sum_j f_i(r_j) . F_j +
//! phi_i(r_j) . M_j (\[Timakov14\], equations (1) and (2); hybrid coordinates, \[Likins70\]): mass-normalised modes,
//! which the forces of the jets excite and a gyro measures.
//! The modes do not act back on the rigid motion. Q transforms vectors from the body's axes to inertial axes: v = Q o
//! v_body o Q*.

mod disturbance;
mod modes;

use std::collections::BTreeMap;

use flexsc_dynamics::three_axis_model::{ModelPoint, ThreeAxisMode, ThreeAxisModel};
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Shape;
use flexsc_numerics::attitude::{Attitude, asymmetry, tensor, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{InitialMotion, SmallAngles, StartValue};

pub use disturbance::Periodic;
pub use modes::SpatialModes;

/// A spatial body: three axes and elastic modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spatial {
    /// Inertia tensor about the centre of mass (kg m²), row by row: symmetric, positive definite.
    pub inertia: [[Finite; 3]; 3],
    /// Attitude at the start, a unit quaternion \[w, x, y, z\] that turns vectors of the body into inertial ones, or
    /// `"target"` for that of the target.
    #[serde(default)]
    pub attitude: StartValue<Attitude>,
    /// Rotation vector (rad) from `attitude` to the attitude at the start, in the body's axes, each component from
    /// -2π to 2π; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude_error: Option<[Finite; 3]>,
    /// Rates at the start (rad/s), in the body's axes, or `"target"` for those of the target.
    #[serde(default)]
    pub rate: StartValue<[Finite; 3]>,
    /// Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_error: Option<[Finite; 3]>,
    /// Small rotations about a fixed target, in closed form, in place of any rotation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub small_angles: Option<SmallAngles>,
    /// Named points of the structure, at which jets and sensors are mounted.
    #[serde(default)]
    pub points: Vec<NamedPoint>,
    /// Elastic modes: a table, or the path of a CSV file. Each mode has a shape at every point.
    #[serde(default)]
    pub modes: SpatialModes,
    /// Torque of the environment; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<Periodic>,
}

/// A point of the structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamedPoint {
    /// Name.
    pub name: String,
    /// Position (m): from the centre of mass; on a spacecraft's hub from its point O, on an appendage from its root.
    #[serde(default)]
    pub position: [Finite; 3],
}

/// A mass-normalised elastic mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpatialMode {
    /// Natural frequency w (rad/s).
    pub frequency: Frequency,
    /// Damping ratio zeta: 0 undamped, 1 critical.
    #[serde(default)]
    pub damping: NonNegative,
    /// Modal displacement at the start (m sqrt(kg)).
    #[serde(default)]
    pub displacement: Finite,
    /// Modal rate at the start (m sqrt(kg)/s).
    #[serde(default)]
    pub rate: Finite,
    /// Shape of the mode at each point, by the name of the point.
    #[serde(default)]
    pub shapes: BTreeMap<String, Shape>,
}

impl From<&Spatial> for ThreeAxisModel {
    fn from(body: &Spatial) -> Self {
        let mode = |mode: &SpatialMode| ThreeAxisMode {
            frequency: mode.frequency,
            damping: mode.damping,
            displacement: mode.displacement,
            rate: mode.rate,
        };
        let shape = |mode: &SpatialMode, point: &NamedPoint| {
            let shape = mode.shapes.get(&point.name).copied().unwrap_or_default();
            (vector(&shape.translation), vector(&shape.rotation))
        };
        let point = |point: &NamedPoint| ModelPoint {
            name: point.name.clone(),
            position: vector(&point.position),
            shapes: body.modes.iter().map(|mode| shape(mode, point)).collect(),
        };
        let (attitude, rate) = body.initial_motion().as_written();
        Self {
            inertia: tensor(&body.inertia),
            attitude,
            rate,
            points: body.points.iter().map(point).collect(),
            modes: body.modes.iter().map(mode).collect(),
            small_angles: body.small_angles.map(Into::into),
            disturbance: body.disturbance.as_ref().map(Into::into),
            coupling: None,
            articulation: None,
        }
    }
}

impl Spatial {
    /// Returns the attitude and rates at the start, as written.
    pub const fn initial_motion(&self) -> InitialMotion {
        InitialMotion::new((self.attitude, self.attitude_error), (self.rate, self.rate_error))
    }

    /// Returns the model of the body, after checking that its values are consistent with each other.
    ///
    /// # Errors
    /// A key within the body, and the reason.
    pub fn solve(&self) -> Result<ThreeAxisModel, ConfigError> {
        let model = ThreeAxisModel::from(self);
        let refused = |key: &str, why: String| Err(ConfigError::new(key, why));
        if let Some(fault) = self.initial_motion().fault() {
            return Err(fault);
        }
        if let Some(why) = asymmetry(&model.inertia) {
            return refused("inertia", why);
        }
        if model.inertia.cholesky().is_none() {
            return refused("inertia", "must be positive definite".to_owned());
        }
        for (index, point) in self.points.iter().enumerate() {
            if self.points[..index].iter().any(|other| other.name == point.name) {
                let why = format!("must differ from the other names, got `{}` again", point.name);
                return refused(&format!("points[{index}].name"), why);
            }
        }
        for (index, mode) in self.modes.iter().enumerate() {
            if let Some(name) = mode.shapes.keys().find(|name| model.point(name).is_none()) {
                let key =
                    format!("modes[{index}].shapes.{}", flexsc_formats::document::key::bare_or_quoted(name));
                return refused(&key, format!("must be one of the points, {}", model.point_names()));
            }
            if let Some(point) = self.points.iter().find(|point| !mode.shapes.contains_key(&point.name)) {
                let why = format!("must have a shape at each point, and `{}` is missing", point.name);
                return refused(&format!("modes[{index}].shapes"), why);
            }
        }
        Ok(model)
    }
}
