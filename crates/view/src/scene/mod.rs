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

use flexsc_core::Scenario;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::foxglove::{FrameTransforms, Plumes, SceneUpdate};
use flexsc_core::record::row::LogDate;
use flexsc_core::record::{Detail, Record, RecordError, Sample, ScenePose, SceneSource, SceneThrust};
use flexsc_core::spacecraft::body::BodyAxes;

use one_axis::OneAxisScene;
use three_axis::ThreeAxisScene;

pub use plume::ScenePlume;

/// Scene of a run: a record that stores nothing and supplies the engine with the scene.
#[derive(Clone, Debug)]
pub struct Scene(BodyScene);

/// Scene of a body, by the number of its axes.
#[derive(Clone, Debug)]
enum BodyScene {
    OneAxis(OneAxisScene),
    ThreeAxis(ThreeAxisScene),
}

impl Scene {
    /// Creates the scene of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self(match scenario.model.axes() {
            BodyAxes::One(body) => BodyScene::OneAxis(OneAxisScene::new(scenario, body)),
            BodyAxes::Three(body) => BodyScene::ThreeAxis(ThreeAxisScene::new(scenario, body)),
        })
    }

    /// Returns the scene for a log in this detail; `None` if the log has none.
    pub fn for_detail(scenario: &Scenario, detail: Detail) -> Option<Self> {
        (detail >= Detail::Scene).then(|| Self::new(scenario))
    }

    /// Returns the factors by which the elastic motion and the rotation of the body are magnified.
    pub fn magnification(&self) -> SceneMagnification {
        let (bending, turning) = match &self.0 {
            BodyScene::OneAxis(scene) => (scene.bending, scene.turning),
            BodyScene::ThreeAxis(scene) => (scene.bending, scene.turning),
        };
        SceneMagnification { bending, turning }
    }

    /// Returns the scene with the true rotation of the body, for viewers in which it is seen against a planet.
    #[must_use]
    pub fn with_true_rotation(mut self) -> Self {
        match &mut self.0 {
            BodyScene::OneAxis(scene) => scene.turning = 1.0,
            BodyScene::ThreeAxis(scene) => scene.turning = 1.0,
        }
        self
    }

    /// Returns the nozzles of the thrusters, and the length of a full plume (m).
    pub fn nozzles(&self) -> (&[ScenePlume], f64) {
        let plumes = match &self.0 {
            BodyScene::OneAxis(scene) => scene.plumes.as_ref(),
            BodyScene::ThreeAxis(scene) => Some(&scene.plumes),
        };
        plumes.map_or((&[], 0.0), |plumes| (plumes.nozzles(), plumes.length()))
    }

    fn extent(&self) -> Extent {
        match &self.0 {
            BodyScene::OneAxis(scene) => scene.extent(),
            BodyScene::ThreeAxis(scene) => scene.extent(),
        }
    }
}

impl SceneSource for Scene {
    fn period(&self) -> Span {
        match &self.0 {
            BodyScene::OneAxis(scene) => scene.period,
            BodyScene::ThreeAxis(scene) => scene.period,
        }
    }

    fn parts(&self, stamp: LogDate) -> SceneUpdate {
        match &self.0 {
            BodyScene::OneAxis(scene) => scene.parts(stamp),
            BodyScene::ThreeAxis(scene) => scene.parts(stamp),
        }
    }

    /// Returns the frames for a pose; those of the last pose if this one is of a body with another number of axes.
    fn frames(&mut self, stamp: LogDate, pose: ScenePose<'_>) -> &FrameTransforms {
        match &mut self.0 {
            BodyScene::OneAxis(scene) => {
                if let ScenePose::OneAxis(pose) = pose {
                    scene.set_pose(stamp, pose);
                }
                &scene.frames
            }
            BodyScene::ThreeAxis(scene) => {
                if let ScenePose::ThreeAxis(pose) = pose {
                    scene.set_pose(stamp, pose);
                }
                &scene.frames
            }
        }
    }

    fn plumes(&mut self, stamp: LogDate, thrust: SceneThrust) -> Option<Plumes> {
        match (&mut self.0, thrust) {
            (BodyScene::OneAxis(scene), SceneThrust::Torque(torque)) => scene.plumes(stamp, torque),
            (BodyScene::ThreeAxis(scene), SceneThrust::Jets { signs, open }) => {
                scene.plumes(stamp, signs, open)
            }
            _ => None,
        }
    }

    fn copy(&self) -> Box<dyn SceneSource> {
        Box::new(self.clone())
    }
}

impl Record for Scene {
    fn wants_switchings(&self) -> bool {
        false
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        Some(self.copy())
    }

    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }
}

/// Factors by which a scene magnifies the motion.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SceneMagnification {
    /// Factor of the elastic motion.
    pub bending: f64,
    /// Factor of the rotation of the body.
    pub turning: f64,
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
