//! The controlled body, and the ways to describe it.

mod coordinate_weights;
pub mod craft;
mod damping_ratios;
mod drift;
mod free_and_clamped;
mod initial_motion;
mod load;
mod mode;
mod model;
mod one_axis;
mod output;
mod panels;
mod reduction;
mod small_angles;
pub mod spatial;
mod structure_matrices;

use std::path::Path;
use std::sync::Arc;

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use coordinate_weights::CoordinateWeights;
pub use craft::AssembledSpacecraft;
pub use damping_ratios::DampingRatios;
pub use drift::{Drift, DriftProfile, ProfilePoint, Ramp, Sinusoid};
pub use free_and_clamped::{clamped_frequencies, free_frequencies};
pub use initial_motion::{InitialMotion, StartValue};
pub use load::{Load, LoadPart};
pub use mode::Mode;
pub use model::{BodyAxes, BodyModel};
pub use one_axis::{Drive, Planar};
pub use output::Output;
pub use panels::{Kinematics, Panels, Section};
pub use small_angles::SmallAngles;
pub use spatial::Spatial;
pub use structure_matrices::{MatrixBody, WeightedSum};

/// The kinds of body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// One angle and any number of elastic modes.
    Planar(Planar),
    /// The matrices of a structure.
    Matrices(MatrixBody),
    /// A hub with panels of hinged sections.
    Panels(Panels),
    /// Three axes, and elastic modes with shapes at points of the structure.
    Spatial(Spatial),
}

impl Body {
    /// Returns the kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Planar(_) => "planar",
            Self::Matrices(_) => "matrices",
            Self::Panels(_) => "panels",
            Self::Spatial(_) => "spatial",
        }
    }

    /// Makes the paths of files absolute, relative to `directory`.
    pub fn locate(&mut self, directory: &Path) {
        match self {
            Self::Matrices(matrices) => {
                matrices.mass.locate(directory);
                matrices.stiffness.locate(directory);
                if let Some(damping) = &mut matrices.damping_matrix {
                    damping.locate(directory);
                }
            }
            Self::Spatial(spatial) => spatial.modes.locate(directory),
            Self::Planar(_) | Self::Panels(_) => {}
        }
    }

    /// Reads the modes of a spatial body from their file; copies them from `other` if that has read the same file.
    ///
    /// # Errors
    /// A key within the body, and the error in its file.
    pub fn read(&mut self, other: Option<&Self>) -> Result<(), ConfigError> {
        let Self::Spatial(spatial) = self else { return Ok(()) };
        let other =
            other.and_then(|other| if let Self::Spatial(other) = other { Some(&other.modes) } else { None });
        spatial.modes.read(other).map_err(|why| ConfigError::new("modes", why))
    }

    /// Returns the number of axes.
    pub fn axis_count(&self) -> usize {
        match self {
            Self::Planar(_) | Self::Matrices(_) | Self::Panels(_) => 1,
            Self::Spatial(_) => 3,
        }
    }

    /// Returns the commanded quantity of a body about one axis.
    fn drive(&self) -> Option<Drive> {
        match self {
            Self::Planar(planar) => Some(planar.drive),
            Self::Matrices(matrices) => Some(matrices.drive),
            Self::Panels(panels) => Some(panels.drive),
            Self::Spatial(_) => None,
        }
    }

    /// Assembles the model of the body that a run uses, whose commanded torque acts on the hub, or is distributed over the
    /// body as a load.
    ///
    /// # Errors
    /// An inconsistent key within the body, or `load` or a key within it, and the reason.
    pub fn assemble(&self, load: Option<&Load>) -> Result<BodyModel, ConfigError> {
        if load.is_some() && self.drive() == Some(Drive::Motion) {
            return Err(ConfigError::new(
                "load",
                "needs a commanded torque: with `drive = \"motion\"` the hub follows its command, and nothing else drives the body",
            ));
        }
        let body: AxisModel = match self {
            Self::Planar(planar) => planar.solve(load)?,
            Self::Matrices(matrices) => matrices.solve(load)?,
            Self::Panels(panels) => panels.solve(load)?,
            Self::Spatial(spatial) => {
                return Ok(BodyModel::ThreeAxis(Arc::new(spatial.solve()?)));
            }
        };
        if let Some(fault) = one_axis::inconsistency(&body) {
            return Err(fault);
        }
        let chain = if let Self::Panels(panels) = self { panels.chain(&body, load) } else { None };
        let body = Arc::new(body);
        Ok(chain.map_or(BodyModel::OneAxis(body.clone()), |chain| BodyModel::Chain(body, Arc::new(chain))))
    }
}
