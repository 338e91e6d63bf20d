//! Flights: runs of a relay law about a body with modes, with motions, crossings and envelopes of many in the lanes of a
//! processor, or of one alone.
//!
//! Nothing here knows a scenario or a log: who has the runs, a [`Crew`], gives them as plain numbers and is told what happens.
//! What a lane comes to is, to the bit, what the loops of `flexsc-core` come to. The kernels are in a crate of their own because
//! they take as long to compile as the rest of the engine, and can do so beside it.

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

/// Whether there is a kernel for runs of a structure.
pub fn flies(structure: Structure) -> bool {
    Processor::best().is_some() && (cfg!(feature = "damped") || !structure.is_damped)
}

/// Makes all runs of a crew, of a structure that [`flies`], side by side.
pub fn fly_beside(processor: Processor, structure: Structure, crew: &mut dyn Crew) {
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return damped::fly_beside(processor, structure, crew);
    }
    undamped::fly_beside(processor, structure, crew);
}

/// Makes the one run of a crew, of a structure that [`flies`].
pub fn fly_alone(structure: Structure, crew: &mut dyn Crew) {
    let Some(processor) = Processor::best() else { return };
    #[cfg(feature = "damped")]
    if structure.is_damped {
        return damped::fly_alone(processor, structure, crew);
    }
    undamped::fly_alone(processor, structure, crew);
}
