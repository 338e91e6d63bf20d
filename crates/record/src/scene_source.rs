//! Scene of a run: entities and moving frames that a record may supply, and the poses from which the engine asks for them.

use std::fmt::Debug;

use flexsc_dynamics::ModeState;
use flexsc_numerics::time::Span;
use nalgebra::Quaternion;

use crate::foxglove::{FrameTransforms, Plumes, SceneUpdate};
use crate::row::LogDate;

/// Three-dimensional scene of a run, drawn for viewers. A record supplies it by `Record::scene`; the engine gives it the
/// pose of the body at each frame and records the result.
pub trait SceneSource: Debug + Send + Sync {
    /// Returns the period of the frames.
    fn period(&self) -> Span;

    /// Returns the entities of the scene.
    fn parts(&self, stamp: LogDate) -> SceneUpdate;

    /// Returns the frames of the entities for a pose of the body.
    fn frames(&mut self, stamp: LogDate, pose: ScenePose<'_>) -> &FrameTransforms;

    /// Returns the plumes of the thrusters if they have changed.
    fn plumes(&mut self, stamp: LogDate, thrust: SceneThrust) -> Option<Plumes>;

    /// Copies the scene for the copy of a run.
    fn copy(&self) -> Box<dyn SceneSource>;
}

impl Clone for Box<dyn SceneSource> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Pose of a body at the instant of a frame.
#[derive(Copy, Clone, Debug)]
pub enum ScenePose<'a> {
    /// Pose of a one-axis body.
    OneAxis(OneAxisPose<'a>),
    /// Pose of a three-axis body.
    ThreeAxis(ThreeAxisPose<'a>),
}

/// Pose of a one-axis body.
#[derive(Copy, Clone, Debug)]
pub struct OneAxisPose<'a> {
    /// Time since the start (s).
    pub time: f64,
    /// Angle of the hub, elastic part included (rad).
    pub angle: f64,
    /// Angle of the body as if it were rigid (rad).
    pub rigid_angle: f64,
    /// States of the modes.
    pub modes: &'a [ModeState],
    /// Angles of the sections relative to the hub (rad); empty for a body without sections.
    pub sections: &'a [f64],
}

/// Pose of a three-axis body.
#[derive(Copy, Clone, Debug)]
pub struct ThreeAxisPose<'a> {
    /// Unit quaternion that rotates vectors from the drawn body's axes into inertial axes.
    pub attitude: &'a Quaternion<f64>,
    /// States of the modes; empty if they are not drawn.
    pub modes: &'a [ModeState],
    /// Angles of the drives and then of the hinges (rad).
    pub angles: &'a [f64],
}

/// Thrust that plumes show.
#[derive(Clone, Debug)]
pub enum SceneThrust {
    /// Torque on a one-axis body (N m).
    Torque(f64),
    /// Jets of a three-axis body: the sign of their torque about each axis, and the open part of each thruster (0 to 1)
    /// if thrusters fire on their own.
    Jets {
        /// Signs about the axes; 0 where no jet burns.
        signs: [f64; 3],
        /// Open part of each thruster; empty if pairs of groups fire.
        open: Vec<f64>,
    },
}
