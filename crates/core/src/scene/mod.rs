//! Three-dimensional scene of a run for viewers.
//!
//! The geometry is schematic. A scenario describes how a body moves, not its appearance: a hub with panels, or a boom
//! to each point and two wings, stand for it. Bending and turning are magnified, by factors that the scene itself
//! shows.

mod magnification;
mod one_axis;
mod panels;
mod plume;
mod pose;
mod primitives;
mod three_axis;
mod wheel;

use flexsc_numerics::time::Span;
use flexsc_record::foxglove::{FrameTransforms, SceneUpdate};
use flexsc_record::row::LogDate;
use flexsc_spacecraft::body::BodyAxes;

use crate::scenario::Scenario;

pub use one_axis::{OneAxisPose, OneAxisScene};
pub use three_axis::ThreeAxisScene;

/// Scene of a run.
#[derive(Clone, Debug)]
pub enum Scene {
    /// Scene of a one-axis body.
    Planar(OneAxisScene),
    /// Scene of a three-axis body.
    Spatial(ThreeAxisScene),
}

impl Scene {
    /// Creates the scene of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        match scenario.model.axes() {
            BodyAxes::One(body) => Self::Planar(OneAxisScene::new(scenario, body)),
            BodyAxes::Three(body) => Self::Spatial(ThreeAxisScene::new(scenario, body)),
        }
    }

    /// Period of the frames.
    pub fn period(&self) -> Span {
        match self {
            Self::Planar(scene) => scene.period,
            Self::Spatial(scene) => scene.period,
        }
    }

    /// Returns the entities of the scene.
    pub fn parts(&self, stamp: LogDate) -> SceneUpdate {
        match self {
            Self::Planar(scene) => scene.parts(stamp),
            Self::Spatial(scene) => scene.parts(stamp),
        }
    }

    fn extent(&self) -> Extent {
        match self {
            Self::Planar(scene) => scene.extent(),
            Self::Spatial(scene) => scene.extent(),
        }
    }
}

/// Size of a scene and the names of its frames, which a viewer needs for its layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// Distance of the farthest part (m).
    pub reach: f64,
    /// Names of the moving frames.
    pub frames: Vec<String>,
}

impl Extent {
    /// Returns the extent of a scenario's scene.
    pub fn from_scenario(scenario: &Scenario) -> Self {
        Scene::new(scenario).extent()
    }

    fn new(reach: f64, frames: &FrameTransforms) -> Self {
        let frames = frames.transforms.iter().map(|frame| frame.child_frame_id.clone());
        Self { reach, frames: frames.collect() }
    }
}
