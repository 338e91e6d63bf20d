//! The scene: what viewers in three dimensions show of a run.
//!
//! The geometry is schematic. A scenario tells how a body moves, and not what it looks like: a hub with panels, or a boom to
//! each point and two wings, stand for it. Bending and turning are magnified, by factors that the scene itself shows.

mod magnification;
mod panels;
mod part;
mod planar;
mod plume;
mod pose;
mod spatial;
mod wheel;

use crate::record::foxglove::FrameTransforms;
use crate::scenario::Scenario;

pub use planar::{PlanarScene, PlanarView};
pub use spatial::SpatialScene;

/// What a viewer has to know of a scene before it looks: how far it reaches (m), and the names of its frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// Distance of the farthest part (m).
    pub reach: f64,
    /// The frames that move.
    pub frames: Vec<String>,
}

impl Extent {
    /// That of a scenario's scene.
    pub fn of(scenario: &Scenario) -> Self {
        match &scenario.spatial {
            None => PlanarScene::new(scenario).extent(),
            Some(spatial) => SpatialScene::new(scenario, spatial).extent(),
        }
    }

    fn new(reach: f64, frames: &FrameTransforms) -> Self {
        let frames = frames.transforms.iter().map(|frame| frame.child_frame_id.clone());
        Self { reach, frames: frames.collect() }
    }
}
