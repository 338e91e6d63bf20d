//! Runs of a relay law on a body with modes: motions, crossings and envelopes of many runs in SIMD lanes, or of a
//! single run.
//!
//! The kernel is independent of scenarios and logs: the host of the runs, a [`LaneHost`], supplies them as plain numbers
//! and is notified of events. The results of a lane equal, to the bit, those of the run loop of `flexsc-core`. The
//! kernels are a separate crate because they take long to compile, and compile in parallel with the engine.

mod chatter;
mod envelope_lanes;
mod host;
mod kernel;
mod lane_runs;
mod lane_time;

use flexsc_dynamics::damping::Undamped;
use flexsc_numerics::lanes::Processor;

pub use chatter::{SWITCHINGS, shortest_window};
pub use host::{CyclePhase, FoundCrossing, LaneHandover, LaneHost, LaneShape, LaneState, RunSetup};
pub use kernel::MOST;

/// Returns true if there is a kernel for runs of a structure.
pub fn is_supported(structure: LaneShape) -> bool {
    Processor::best().is_some() && (cfg!(feature = "damped") || !structure.is_damped)
}

/// Computes all runs of a host in SIMD lanes; the structure must be supported ([`is_supported`]).
pub fn run_lanes(processor: Processor, structure: LaneShape, host: &mut dyn LaneHost) {
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return lane_runs::run_lanes::<1, lane_runs::WithDamping>(processor, structure, host);
    }
    lane_runs::run_lanes::<2, Undamped>(processor, structure, host);
}

/// Computes the single run of a host; the structure must be supported ([`is_supported`]).
pub fn run_single(structure: LaneShape, host: &mut dyn LaneHost) {
    let Some(processor) = Processor::best() else { return };
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return lane_runs::run_single::<lane_runs::WithDamping>(processor, structure, host);
    }
    lane_runs::run_single::<Undamped>(processor, structure, host);
}
