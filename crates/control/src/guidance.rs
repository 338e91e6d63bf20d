//! Guidance that another crate provides: the reference motion of a three-axis body as a function of time and sky.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::EnvironmentObservation;
use flexsc_spacecraft::manoeuvre::AttitudeMotion;

use crate::part::Part;

/// Settings of a guidance that another crate provides.
pub trait GuidanceSpec: Send + Sync {
    /// Returns the run-time state of the guidance.
    fn start(&self, seed: Seed) -> Box<dyn GuidanceRun>;
}

/// Guidance during a run.
pub trait GuidanceRun: Part {
    /// Returns the reference motion at an instant under a sky. It must be the same for the same instant, whenever it is asked.
    fn aim(&self, now: Instant, sky: &EnvironmentObservation) -> AttitudeMotion;

    /// Returns a copy of the whole state.
    fn copy(&self) -> Box<dyn GuidanceRun>;
}

/// Guidance in a profile of targets.
#[derive(Debug)]
pub struct OwnGuidance(pub Box<dyn GuidanceRun>);

impl Clone for OwnGuidance {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

/// The settings of two scenarios decide whether their guidance is equal, and not the state of a run.
impl PartialEq for OwnGuidance {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
