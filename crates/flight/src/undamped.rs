//! Kernels of runs without damped modes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_motion::damping::Undamped;
use flexsc_motion::lanes::{LaneWork, Processor, Real};

use crate::crew::{Crew, Structure};
use crate::kernel::Flight;

/// SIMD task that computes all runs of a host.
struct Runs<'a> {
    structure: Structure,
    crew: &'a mut dyn Crew,
}

impl LaneWork for Runs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        Flight::<R, Undamped>::fly(kind, self.structure, self.crew);
    }
}

/// Computes all runs of a host in SIMD lanes.
pub fn fly_beside(processor: Processor, structure: Structure, crew: &mut dyn Crew) {
    processor.run::<2, _>(Runs { structure, crew });
}

/// Computes the single run of a host.
pub fn fly_alone(processor: Processor, structure: Structure, crew: &mut dyn Crew) {
    processor.run_alone(Runs { structure, crew });
}
