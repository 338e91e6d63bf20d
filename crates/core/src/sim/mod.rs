//! Runs: the loop of a body with one angle, and that of a spatial one.
//!
//! In both, at one instant: the body arrives, the sensor measures, the estimator follows, the law decides, the actuator acts,
//! the record is told. `docs/events.md` states the rules.

mod journal;
mod planar;
mod spatial;

use thiserror::Error;

use crate::record::{Record, RecordError};
use crate::scenario::Scenario;
use crate::scene::{PlanarScene, SpatialScene};
use crate::time::Instant;

pub use planar::PlanarRun;
pub use spatial::SpatialRun;

/// A simulation that cannot go on.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The state of the body is no longer a finite number.
    #[error("the state is no longer finite at t = {at} s")]
    NonFinite {
        /// When.
        at: Instant,
    },
    /// The law switches without end at one instant.
    #[error("chatter: the law decided {count} times at t = {at} s")]
    Chatter {
        /// When.
        at: Instant,
        /// How often.
        count: u32,
    },
    /// The record could not be kept.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// All that moves in a run.
#[derive(Clone, Debug)]
pub enum Simulation {
    /// Of a body with one angle.
    Planar(Box<PlanarRun>),
    /// Of a body with three axes.
    Spatial(Box<SpatialRun>),
}

impl Simulation {
    /// A run of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        match &scenario.spatial {
            None => Self::Planar(Box::new(PlanarRun::new(scenario, run))),
            Some(spatial) => Self::Spatial(Box::new(SpatialRun::new(scenario, spatial, run))),
        }
    }

    /// Makes the run draw its scene for records that want it; before it begins.
    pub fn draw(&mut self, scenario: &Scenario) {
        match (self, &scenario.spatial) {
            (Self::Planar(run), _) => run.draw(PlanarScene::new(scenario)),
            (Self::Spatial(run), Some(spatial)) => run.draw(SpatialScene::new(scenario, spatial)),
            (Self::Spatial(_), None) => {}
        }
    }

    /// Runs to the end of the scenario.
    pub fn run(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        self.run_until(Instant::END, record)
    }

    /// Runs to an instant, or to the end of the scenario if that is earlier, everything that is due then included.
    pub fn run_until(&mut self, until: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        match self {
            Self::Planar(run) => run.run_until(until, record),
            Self::Spatial(run) => run.run_until(until, record),
        }
    }
}
