//! SIMD tasks of the kernel, one for each damping rule.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use std::marker::PhantomData;

#[cfg(feature = "damped")]
use flexsc_dynamics::damping::Damped;
use flexsc_dynamics::damping::{DampingRule, Undamped};
use flexsc_numerics::lanes::{LaneFloat, Processor, SimdTask};

use crate::host::{LaneHost, LaneShape};
use crate::kernel::RelayKernel;

/// Damping rule for every type of lanes.
pub trait LaneDamping {
    /// Rule for lanes of type `R`.
    type Rule<R: LaneFloat>: DampingRule<R>;
}

impl LaneDamping for Undamped {
    type Rule<R: LaneFloat> = Self;
}

/// Marker of runs with damped modes.
#[cfg(feature = "damped")]
pub struct WithDamping;

#[cfg(feature = "damped")]
impl LaneDamping for WithDamping {
    type Rule<R: LaneFloat> = Damped<R>;
}

/// SIMD task that computes all runs of a host.
struct LaneRunTask<'a, D> {
    structure: LaneShape,
    host: &'a mut dyn LaneHost,
    damping: PhantomData<D>,
}

impl<D: LaneDamping> SimdTask for LaneRunTask<'_, D> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        RelayKernel::<R, D::Rule<R>>::run(kind, self.structure, self.host);
    }
}

/// Computes all runs of a host in SIMD lanes, with `GROUPS` registers per number.
pub fn run_lanes<const GROUPS: usize, D: LaneDamping>(
    processor: Processor,
    structure: LaneShape,
    host: &mut dyn LaneHost,
) {
    processor.run::<GROUPS, _>(LaneRunTask { structure, host, damping: PhantomData::<D> });
}

/// Computes the single run of a host.
pub fn run_single<D: LaneDamping>(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    processor.run_scalar(LaneRunTask { structure, host, damping: PhantomData::<D> });
}
