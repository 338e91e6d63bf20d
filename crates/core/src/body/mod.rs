//! What is controlled: the ways to describe a body, and its exact flow under a constant input.

mod chain;
mod coupled;
pub mod craft;
mod damping;
mod drift;
mod drifting;
mod forced;
#[cfg(test)]
mod guess_tests;
mod hub;
mod matrices;
mod mode;
mod output;
mod panels;
mod planar;
mod reduction;
mod segment;
mod series;
pub mod spatial;
mod weights;
mod wheeled;

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Fault;
use crate::motion::turning::Flexible;
use crate::quantity::Finite;

pub use chain::{Chain, Flight, Flown};
pub use coupled::Coupled;
pub use craft::Craft;
pub use damping::Damping;
pub use drift::{Drift, Point, Profile, Ramp, SERIES, Sinusoid};
pub use drifting::Drifting;
pub use forced::{Forced, Input, Push, Wrench};
pub use matrices::{Matrices, Sum};
pub(crate) use mode::Flow;
pub use mode::Mode;
pub use output::Output;
pub use panels::{Kinematics, Panels, Section};
pub use planar::{Drive, Planar};
pub use segment::Segment;
pub use series::{Ratio, Springs};
pub use spatial::Spatial;
pub use weights::Weights;
pub use wheeled::{Constant, Coupling, Lent, Unfolding};

/// The kinds of body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// One angle and any number of elastic modes.
    Planar(Planar),
    /// The matrices of a structure.
    Matrices(Matrices),
    /// A hub with panels of hinged sections.
    Panels(Panels),
    /// Three axes, and elastic modes with shapes at points of the structure.
    Spatial(Spatial),
    /// The body built from `[spacecraft]` and `[[appendage]]`, which are keys of their own.
    #[serde(skip)]
    Spacecraft(Box<Craft>),
}

impl Default for Body {
    /// A spacecraft that is still to be put together.
    fn default() -> Self {
        Self::Spacecraft(Box::default())
    }
}

impl Body {
    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Planar(_) => "planar",
            Self::Matrices(_) => "matrices",
            Self::Panels(_) => "panels",
            Self::Spatial(_) => "spatial",
            Self::Spacecraft(_) => "spacecraft",
        }
    }

    /// The key of its table.
    pub fn key(&self) -> String {
        if self.is_spacecraft() { self.kind().to_owned() } else { format!("body.{}", self.kind()) }
    }

    /// Whether it is put together from `[spacecraft]`.
    pub fn is_spacecraft(&self) -> bool {
        matches!(self, Self::Spacecraft(_))
    }

    /// Makes the paths of files absolute: relative ones begin at a directory.
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
            Self::Planar(_) | Self::Panels(_) | Self::Spacecraft(_) => {}
        }
    }

    /// Reads the modes of a spatial body that are in a file; those of another body from the same file are taken over.
    ///
    /// # Errors
    /// What is wrong with the file: a key within the body, and why.
    pub fn read(&mut self, other: Option<&Self>) -> Result<(), Fault> {
        let Self::Spatial(spatial) = self else { return Ok(()) };
        let other =
            other.and_then(|other| if let Self::Spatial(other) = other { Some(&other.modes) } else { None });
        spatial.modes.read(other).map_err(|why| Fault::new("modes", why))
    }

    /// The body in free modes, if it has three axes.
    pub fn spatial(&self) -> Option<&Spatial> {
        match self {
            Self::Spatial(spatial) => Some(spatial),
            Self::Spacecraft(craft) => Some(&craft.spatial),
            Self::Planar(_) | Self::Matrices(_) | Self::Panels(_) => None,
        }
    }

    /// The modes of a body with three axes as a command is planned for them: frequencies and damping ratios.
    pub fn free_modes(&self) -> Vec<Mode> {
        let modes = self.spatial().map_or(&[][..], |spatial| &spatial.modes[..]);
        modes.iter().map(|mode| Mode::at_rest(mode.frequency, Finite::default(), mode.damping)).collect()
    }

    /// The spacecraft, if it is put together from parts.
    pub fn craft(&self) -> Option<&Craft> {
        if let Self::Spacecraft(craft) = self { Some(craft) } else { None }
    }

    /// The coupling of rotation and modes in both directions, where the body has it: of a spacecraft.
    pub fn flexible(&self) -> Option<&Flexible> {
        self.craft().map(|craft| &craft.flexible)
    }

    /// The planar body that moves; of a spatial body, which is checked alone, one without modes.
    ///
    /// # Errors
    /// What is wrong with the body: a key within it, and why.
    pub fn solve(&self) -> Result<Planar, Fault> {
        let model = match self {
            Self::Planar(planar) => planar.clone(),
            Self::Matrices(matrices) => matrices.solve()?,
            Self::Panels(panels) => panels.solve()?,
            Self::Spatial(spatial) => spatial.check().map(|()| Planar::default())?,
            Self::Spacecraft(_) => Planar::default(),
        };
        model.inconsistency().map_or(Ok(model), Err)
    }

    /// The exact chain behind the planar body, where the scenario asks for it.
    pub fn chain(&self, model: &Planar) -> Option<Chain> {
        match self {
            Self::Panels(panels) => panels.chain(model),
            Self::Planar(_) | Self::Matrices(_) | Self::Spatial(_) | Self::Spacecraft(_) => None,
        }
    }
}
