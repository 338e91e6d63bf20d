//! Runs of a relay law on a body with modes: motions, crossings and envelopes of many runs in SIMD lanes, or of a
//! single run.
//!
//! The kernel is independent of scenarios and logs: the host of the runs, a [`Crew`], supplies them as plain numbers
//! and is notified of events. The results of a lane equal, to the bit, those of the run loop of `flexsc-core`. The
//! kernels are a separate crate because they take as long to compile as the rest of the engine, and compile in
//! parallel with it.

mod chatter;
mod clock;
mod crew;
#[cfg(feature = "damped")]
mod damped;
mod kernel;
mod track;
mod undamped;

use flexsc_motion::lanes::Processor;

pub use chatter::{SWITCHINGS, shortest_window};
pub use crew::{Crew, CyclePlace, LaneRest, LaneSight, Searched, Setup, Structure};
pub use kernel::MOST;

/// Returns true if there is a kernel for runs of a structure.
pub fn flies(structure: Structure) -> bool {
    Processor::best().is_some() && (cfg!(feature = "damped") || !structure.is_damped)
}

/// Computes all runs of a host in SIMD lanes; the structure must be supported ([`flies`]).
pub fn fly_beside(processor: Processor, structure: Structure, crew: &mut dyn Crew) {
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return damped::fly_beside(processor, structure, crew);
    }
    undamped::fly_beside(processor, structure, crew);
}

/// Computes the single run of a host; the structure must be supported ([`flies`]).
pub fn fly_alone(structure: Structure, crew: &mut dyn Crew) {
    let Some(processor) = Processor::best() else { return };
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return damped::fly_alone(processor, structure, crew);
    }
    undamped::fly_alone(processor, structure, crew);
}
