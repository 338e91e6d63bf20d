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

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Positive;
use crate::record::foxglove::FrameTransforms;
use crate::scenario::Scenario;
use crate::time::Span;

pub use planar::{PlanarScene, PlanarView};
pub use spatial::SpatialScene;

/// No frames are nearer than this (s), unless a scenario asks for it: viewers show no more.
const SHORTEST_PERIOD: f64 = 0.04;

/// How a run is drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneSpec {
    /// Period of the frames (s); left out, that of the log, and at least 0.04 s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// How many times the elastic motion is drawn as large as it is; left out, so many times that what the actuator or the
    /// initial state excites shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending: Option<Positive>,
    /// How many times the rotation of the body is drawn as large as it is; left out, so many times that it shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turning: Option<Positive>,
}

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

impl SceneSpec {
    /// Whether the scenario leaves everything out.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The period of the frames, where a log has this one.
    fn period(&self, log: Span) -> Span {
        self.period.unwrap_or_else(|| log.max(Span::from_seconds(SHORTEST_PERIOD)))
    }
}
