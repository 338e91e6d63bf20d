//! The scene: what viewers in three dimensions show of a run.
//!
//! The geometry is schematic. A scenario tells how a body moves, and not what it looks like: a hub with panels, or a boom to
//! each point and two wings, stand for it. Bending and turning are magnified, by factors that the scene itself shows.

mod magnification;
mod part;
mod planar;
mod plume;
mod pose;
mod spatial;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Positive;
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
