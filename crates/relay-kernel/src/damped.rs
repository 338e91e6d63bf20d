//! Kernels of runs with damped modes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_dynamics::damping::Damped;
use flexsc_numerics::lanes::{LaneFloat, Processor, SimdTask};

use crate::host::{LaneHost, LaneShape};
use crate::kernel::RelayKernel;

/// SIMD task that computes all runs of a host.
struct LaneRunTask<'a> {
    structure: LaneShape,
    host: &'a mut dyn LaneHost,
}

impl SimdTask for LaneRunTask<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        RelayKernel::<R, Damped<R>>::run(kind, self.structure, self.host);
    }
}

/// Computes all runs of a host in SIMD lanes.
pub fn run_lanes(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    processor.run::<1, _>(LaneRunTask { structure, host });
}

/// Computes the single run of a host.
pub fn run_single(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    processor.run_scalar(LaneRunTask { structure, host });
}
