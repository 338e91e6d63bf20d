//! Load of a machine during a run, held from step to step: broadband, or lines.

use std::f64::consts::TAU;

use flexsc_dynamics::wrench::ForceEffect;
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Span;

use crate::load_lines::LoadLines;
use crate::random_lines::RandomLines;
use crate::shaped_load::ShapedLoad;

/// State of a load.
#[derive(Clone, Debug)]
pub enum MachineLoad {
    /// Broadband load between corners.
    Shaped(ShapedLoad),
    /// Broadband load by a table.
    Random(RandomLines),
    /// Lines.
    Tones(ToneLoad),
}

/// Lines of a machine at the frequency of a run.
#[derive(Clone, Debug)]
pub struct ToneLoad {
    harmonics: Vec<Tone>,
    /// Phase of the machine at the start, and steps since.
    start: f64,
    steps: u64,
    step: Span,
}

/// Harmonic: its effect at its amplitude, its turn in a step and its phase (rad).
#[derive(Clone, Debug)]
struct Tone {
    effect: ForceEffect,
    multiple: f64,
    turn: f64,
    phase: f64,
}

impl ToneLoad {
    /// Creates the lines at a frequency within the tolerance and a phase of the machine, both drawn; `unit` has the effect of a unit of
    /// each component.
    pub fn new(lines: &LoadLines, unit: impl Fn(usize) -> ForceEffect, draws: &mut Stream) -> Self {
        let [from, to] = lines.range();
        let frequency = from + (to - from) * draws.uniform();
        let start = TAU * draws.uniform();
        let step = lines.step();
        let units: [ForceEffect; 6] = std::array::from_fn(unit);
        let harmonics = lines.harmonics.iter().map(|harmonic| {
            let multiple = lines.multiple(harmonic);
            let turn = multiple * frequency * step.seconds();
            // A sine that is held at the middle of each step has less of its amplitude.
            let held = libm::sin(0.5 * turn) / (0.5 * turn);
            let mut effect = ForceEffect::default();
            for (unit, amplitude) in units.iter().zip(harmonic.amplitudes()) {
                effect.add_scaled(unit, amplitude / held);
            }
            Tone { effect, multiple, turn, phase: harmonic.phase.get() }
        });
        Self { harmonics: harmonics.collect(), start, steps: 0, step }
    }

    /// Returns the effect of the load on the body.
    fn effect(&self) -> ForceEffect {
        let mut sum = ForceEffect::default();
        for Tone { effect, multiple, turn, phase } in &self.harmonics {
            let angle = multiple * self.start + turn * (self.steps as f64 - 0.5) + phase;
            sum.add_scaled(effect, libm::cos(angle));
        }
        sum
    }
}

impl MachineLoad {
    /// Returns the time for which the load is held.
    pub fn step(&self) -> Span {
        match self {
            Self::Shaped(load) => load.step(),
            Self::Random(load) => load.step(),
            Self::Tones(load) => load.step,
        }
    }

    /// Goes on by a step.
    pub fn advance(&mut self, draws: &mut Stream) {
        match self {
            Self::Shaped(load) => load.advance(draws),
            Self::Random(load) => load.advance(),
            Self::Tones(load) => load.steps += 1,
        }
    }

    /// Returns the effect of the load on the body.
    pub fn effect(&self) -> ForceEffect {
        match self {
            Self::Shaped(load) => load.effect(),
            Self::Random(load) => load.effect(),
            Self::Tones(load) => load.effect(),
        }
    }
}
