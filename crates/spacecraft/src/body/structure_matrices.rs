//! A body given by the mass and the stiffness matrix of its structure.

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::{Matrix, Structure};
use flexsc_numerics::quantity::Finite;
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::output::radians;
use super::reduction::{ModalReduction, ObservedCoordinate};
use super::{CoordinateWeights, DampingRatios, Drive, Load};

/// A body given by its matrices: M q'' + C q' + K q = Q, where one coordinate is the hub's angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Matrices")]
pub struct MatrixBody {
    /// Mass matrix, symmetric and positive definite, up to order 2000 (kg m² for angles, kg for displacements):
    /// rows, or a file.
    pub mass: Matrix,
    /// Stiffness matrix, symmetric; only the rigid rotation is free of strain (N m/rad for angles, N/m for
    /// displacements): rows, or a file.
    pub stiffness: Matrix,
    /// Names of the coordinates; default: `q0`, `q1` and so on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coordinates: Vec<String>,
    /// Index of the coordinate that is the hub's angle, counted from 0.
    #[serde(default)]
    pub hub: u32,
    /// Displacement of each coordinate under a unit rigid rotation; default: 1 for the hub's angle and 0 for all other
    /// coordinates, which are relative to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Vec<Finite>>,
    /// Quantity that the actuator commands.
    #[serde(default)]
    pub drive: Drive,
    /// Damping ratio of all modes, or a list with one for each mode that is kept.
    #[serde(default)]
    pub damping: DampingRatios,
    /// Damping matrix, symmetric, without resistance to the rigid rotation (N m s/rad for angles, N s/m for displacements).
    /// It adds to the damping ratios and may couple the modes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_matrix: Option<Matrix>,
    /// Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep: Option<u32>,
    /// Rigid angle at the start (rad).
    #[serde(default)]
    pub angle: Finite,
    /// Rigid rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
    /// Sums of coordinates that are observed in addition to the hub's angle.
    #[serde(default)]
    pub outputs: Vec<WeightedSum>,
}

/// A sum of coordinates that is observed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Sum")]
pub struct WeightedSum {
    /// Name, such as `tip`.
    pub name: String,
    /// Unit.
    #[serde(default = "radians")]
    pub unit: String,
    /// Weight of each coordinate, or a table of weights by the names of coordinates.
    pub weights: CoordinateWeights,
}

impl MatrixBody {
    /// Returns the structure, with its matrices read from their files.
    pub fn structure(&self) -> Result<Structure, ConfigError> {
        let rotation: Option<Vec<f64>> =
            self.rotation.as_ref().map(|rotation| rotation.iter().map(|r| r.get()).collect());
        let (mass, stiffness) = (read("mass", &self.mass)?, read("stiffness", &self.stiffness)?);
        Structure::new(mass, stiffness, self.hub as usize, rotation.as_deref())
    }

    /// Returns the planar body with the modes of the structure, under a torque on the hub or under a load.
    pub fn solve(&self, load: Option<&Load>) -> Result<AxisModel, ConfigError> {
        let structure = self.structure()?;
        let names = self.names(structure.mass().nrows())?;
        let observed = |(index, sum): (usize, &WeightedSum)| {
            let weights = sum.weights.resolve(&names);
            let weights =
                weights.map_err(|why| ConfigError::new(format!("outputs[{index}].weights"), why))?;
            Ok(ObservedCoordinate { name: sum.name.clone(), unit: sum.unit.clone(), weights })
        };
        let Self { drive, damping, keep, angle, rate, .. } = self;
        let outputs = self.outputs.iter().enumerate().map(observed).collect::<Result<_, ConfigError>>()?;
        let damping_matrix = self.damping_matrix.as_ref();
        let damping_matrix = damping_matrix.map(|matrix| structure.damping(read("damping_matrix", matrix)?));
        let damping_matrix = damping_matrix.transpose()?;
        ModalReduction {
            drive: (*drive).into(),
            damping,
            damping_matrix,
            keep: *keep,
            angle: *angle,
            rate: *rate,
            outputs,
            load: load.map(|load| load.on_coordinates(&names)).transpose()?,
        }
        .axis_model(&structure)
    }

    fn names(&self, order: usize) -> Result<Vec<String>, ConfigError> {
        if self.coordinates.is_empty() {
            return Ok((0..order).map(|index| format!("q{index}")).collect());
        }
        let found = self.coordinates.len();
        if found != order {
            let why = format!("must have one name for each of {order} coordinates, got {found}");
            return Err(ConfigError::new("coordinates", why));
        }
        let again = (1..order).find(|i| self.coordinates[..*i].contains(&self.coordinates[*i]));
        if let Some(index) = again {
            let why = format!("must differ from the other names, got `{}` again", self.coordinates[index]);
            return Err(ConfigError::new(format!("coordinates[{index}]"), why));
        }
        Ok(self.coordinates.clone())
    }
}

fn read(key: &str, matrix: &Matrix) -> Result<DMatrix<f64>, ConfigError> {
    matrix.read().map_err(|fault| fault.within(key))
}
