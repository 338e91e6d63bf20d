//! Kernels of runs without damped modes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_dynamics::damping::Undamped;
use flexsc_numerics::lanes::{LaneFloat, Processor, SimdTask};

use crate::host::{LaneHost, LaneShape};
use crate::kernel::RelayKernel;

/// SIMD task that computes all runs of a host.
struct Runs<'a> {
    structure: LaneShape,
    host: &'a mut dyn LaneHost,
}

impl SimdTask for Runs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        RelayKernel::<R, Undamped>::run(kind, self.structure, self.host);
    }
}

/// Computes all runs of a host in SIMD lanes.
pub fn fly_beside(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    processor.run::<2, _>(Runs { structure, host });
}

/// Computes the single run of a host.
pub fn fly_alone(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    processor.run_scalar(Runs { structure, host });
}
