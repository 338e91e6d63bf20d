//! What a sensor from outside of this crate tells of itself before a run.

use std::any::Any;

use super::Sense;
use crate::random::Seed;
use crate::time::Span;

/// What a sensor from outside tells of itself before a run.
pub trait Instrument: Send + Sync {
    /// The sensor in a run of a body with so many axes.
    fn start(&self, axes: usize, seed: Seed) -> Box<dyn Sense>;

    /// The period of its samples.
    fn period(&self) -> Span;

    /// Standard deviation of the measured angle (rad).
    fn angle_noise(&self) -> f64 {
        0.0
    }

    /// Standard deviation of the measured rate (rad/s), if rates are measured.
    fn rate_noise(&self) -> Option<f64> {
        None
    }

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}
