//! Disturbances that another crate provides: torques and forces at points as functions of time, motion and sky.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use crate::part::Part;
use crate::sensor::Truth;

/// Settings of a disturbance that another crate provides.
pub trait DisturbanceSpec: Send + Sync {
    /// Names of the points of a three-axis body at which it acts. Without any, it acts at one place: its torque at the point
    /// of the actuators, its force at the body's first point.
    fn points(&self) -> &[String];

    /// Returns the run-time state of the disturbance on a body with `axes` axes.
    fn start(&self, axes: usize, seed: Seed) -> Box<dyn DisturbanceRun>;
}

/// Torque and force at a point, in body axes.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PointLoad {
    /// Torque (N m).
    pub torque: [f64; 3],
    /// Force (N).
    pub force: [f64; 3],
}

/// Disturbance during a run. It acts at the start and at each instant at which it is due, and its loads stay constant until
/// then.
pub trait DisturbanceRun: Part {
    /// Writes the loads from `now` on, one for each of its points, given the true state.
    fn act(&mut self, now: Instant, truth: &Truth, loads: &mut [PointLoad]);

    /// Returns a copy of the whole state.
    fn copy(&self) -> Box<dyn DisturbanceRun>;
}

impl Clone for Box<dyn DisturbanceRun> {
    fn clone(&self) -> Self {
        self.copy()
    }
}
