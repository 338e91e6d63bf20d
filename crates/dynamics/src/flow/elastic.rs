//! Elastic modes of a spatial body: exact flow under constant modal forces, energy, and rates at a point.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Finite;

use super::ModeFlow;
use crate::ModeState;
use crate::axis_model::AxisMode;
use crate::three_axis_model::{ThreeAxisMode, ThreeAxisModel};

/// Flows of all modes. A phase holds the displacement q (m sqrt(kg)) and q'/w.
#[derive(Clone, Debug)]
pub struct ElasticModes {
    flows: Vec<ModeFlow>,
    /// Frequent time step (s); transitions over its multiples are cached.
    cycle: f64,
    /// Last time step near each multiple of the cycle (s); `transitions` holds those of all modes over each.
    spans: Vec<f64>,
    transitions: Vec<[f64; 4]>,
}

/// Number of multiples of the cycle, from 0, for which transitions are cached.
const KNOWN: usize = 128;

impl ElasticModes {
    /// Creates the flows of a body's modes, which are often advanced by `cycle` seconds.
    pub fn new(body: &ThreeAxisModel, cycle: f64) -> Self {
        let flow = |mode: &ThreeAxisMode| {
            ModeFlow::new(&AxisMode::at_rest(mode.frequency, Finite::default(), mode.damping))
        };
        Self {
            flows: body.modes.iter().map(flow).collect(),
            cycle,
            spans: Vec::new(),
            transitions: Vec::new(),
        }
    }

    /// Returns the phases at the start of a run.
    pub fn start(body: &ThreeAxisModel) -> Vec<ModeState> {
        let of = |mode: &ThreeAxisMode| ModeState {
            displacement: mode.displacement.get(),
            quadrature: mode.rate.get() / mode.frequency.get(),
        };
        body.modes.iter().map(of).collect()
    }

    /// Advances the phases by `h` seconds under constant modal forces (N/sqrt(kg), one for each mode, or empty if there
    /// are none): a mode rotates about the equilibrium f/w².
    pub fn advance(&mut self, phases: &mut [ModeState], forces: &[f64], h: f64) {
        let known = self.learn(h);
        let force = |index: usize| forces.get(index).copied().unwrap_or(0.0);
        let modes = phases.iter_mut().zip(&self.flows).enumerate();
        if let Some(first) = known {
            for ((index, (phase, flow)), transition) in modes.zip(&self.transitions[first..]) {
                turn(phase, flow, transition, force(index));
            }
        } else {
            for (index, (phase, flow)) in modes {
                turn(phase, flow, &flow.transition(h), force(index));
            }
        }
    }

    /// Returns the index of the first mode's cached transition over `h` seconds, computing it if necessary; `None` if
    /// `h` is too long for the cache.
    fn learn(&mut self, h: f64) -> Option<usize> {
        let cycles = libm::round(h / self.cycle);
        if cycles.is_nan() || cycles >= KNOWN as f64 {
            return None;
        }
        let (place, modes) = (cycles as usize, self.flows.len());
        if self.spans.len() <= place {
            self.spans.resize(place + 1, f64::NAN);
            self.transitions.resize((place + 1) * modes, [0.0; 4]);
        }
        let first = place * modes;
        if self.spans[place].to_bits() != h.to_bits() {
            self.spans[place] = h;
            for (transition, flow) in self.transitions[first..].iter_mut().zip(&self.flows) {
                *transition = flow.transition(h);
            }
        }
        Some(first)
    }

    /// Returns an upper bound of the rate of change of the modes (rad/s).
    pub fn fastest(&self) -> f64 {
        self.flows.iter().map(ModeFlow::fastest).fold(0.0, f64::max)
    }

    /// Returns the rates q' of the modes (m sqrt(kg)/s).
    pub fn rates<'a>(&'a self, phases: &'a [ModeState]) -> impl Iterator<Item = f64> + 'a {
        phases.iter().zip(&self.flows).map(|(phase, flow)| flow.frequency * phase.quadrature)
    }

    /// Returns the elastic part of the rates at a point (rad/s), where the modes have the shapes `rotations`.
    pub fn rate_at(&self, rotations: &[Vector], phases: &[ModeState]) -> Vector {
        self.rates(phases).zip(rotations).fold(Vector::zeros(), |sum, (rate, shape)| sum + shape * rate)
    }

    /// Returns the kinetic and strain energy of each mode (J): (q'² + w² q²)/2.
    pub fn energies<'a>(&'a self, phases: &'a [ModeState]) -> impl Iterator<Item = f64> + 'a {
        phases.iter().zip(&self.flows).map(|(ModeState { displacement: x, quadrature: y }, flow)| {
            0.5 * flow.frequency * flow.frequency * (x * x + y * y)
        })
    }
}

/// Advances a mode about its equilibrium under a modal force (N/sqrt(kg)), by its transition over a time step.
#[inline]
fn turn(phase: &mut ModeState, flow: &ModeFlow, &[a, b, c, d]: &[f64; 4], force: f64) {
    let centre = force / (flow.frequency * flow.frequency);
    let (x, y) = (phase.displacement - centre, phase.quadrature);
    *phase = ModeState { displacement: centre + a * x + b * y, quadrature: c * x + d * y };
}
