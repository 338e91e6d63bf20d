//! Load of a machine during a run, held from step to step: broadband, or lines.

use flexsc_dynamics::wrench::ForceEffect;
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Span;

use crate::held_lines::HeldLines;
use crate::shaped_load::ShapedLoad;

/// State of a load.
#[derive(Clone, Debug)]
pub enum MachineLoad {
    /// Broadband load between corners.
    Shaped(ShapedLoad),
    /// Lines of a machine, or of a broadband load by a table.
    Lines(HeldLines),
}

impl MachineLoad {
    /// Returns the time for which the load is held.
    pub fn step(&self) -> Span {
        match self {
            Self::Shaped(load) => load.step(),
            Self::Lines(load) => load.step(),
        }
    }

    /// Goes on by a step.
    pub fn advance(&mut self, draws: &mut Stream) {
        match self {
            Self::Shaped(load) => load.advance(draws),
            Self::Lines(load) => load.advance(),
        }
    }

    /// Returns the effect of the load on the body.
    pub fn effect(&self) -> ForceEffect {
        match self {
            Self::Shaped(load) => load.effect(),
            Self::Lines(load) => load.effect(),
        }
    }
}
