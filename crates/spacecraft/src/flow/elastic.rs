//! The elastic modes of a spatial body: their exact flow under constant modal forces, their energy, what a gyro sees.

use super::ModeFlow;
use crate::attitude::Vector;
use crate::body::Mode;
use crate::body::spatial::{Spatial, SpatialMode};
use crate::motion::Phase;
use crate::quantity::Finite;

/// The flows of all modes. A phase holds the displacement q (m sqrt(kg)) and q'/w.
#[derive(Clone, Debug)]
pub struct Elastic {
    flows: Vec<ModeFlow>,
    /// A span that comes again and again, and its multiples too (s).
    cycle: f64,
    /// Of the spans near each multiple the one that came last (s), and the transitions of all modes over each.
    spans: Vec<f64>,
    transitions: Vec<[f64; 4]>,
}

/// Transitions are known over so many cycles.
const KNOWN: usize = 128;

impl Elastic {
    /// The modes of a body that is often moved on by `cycle` seconds.
    pub fn new(body: &Spatial, cycle: f64) -> Self {
        let flow = |mode: &SpatialMode| {
            ModeFlow::new(&Mode::at_rest(mode.frequency, Finite::default(), mode.damping))
        };
        Self {
            flows: body.modes.iter().map(flow).collect(),
            cycle,
            spans: Vec::new(),
            transitions: Vec::new(),
        }
    }

    /// The phases at the start.
    pub fn start(body: &Spatial) -> Vec<Phase> {
        let of = |mode: &SpatialMode| Phase {
            displacement: mode.displacement.get(),
            quadrature: mode.rate.get() / mode.frequency.get(),
        };
        body.modes.iter().map(of).collect()
    }

    /// Moves on by `h` seconds under constant modal forces (N/sqrt(kg), one for each mode; none at all if there are
    /// none): a mode turns about the equilibrium f/w².
    pub fn advance(&mut self, phases: &mut [Phase], forces: &[f64], h: f64) {
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

    /// The place of the first mode's transition over `h` seconds, which is known from now on; none of a span that is too long.
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

    /// No mode changes faster (rad/s).
    pub fn fastest(&self) -> f64 {
        self.flows.iter().map(ModeFlow::fastest).fold(0.0, f64::max)
    }

    /// Rates q' of the modes (m sqrt(kg)/s).
    pub fn rates<'a>(&'a self, phases: &'a [Phase]) -> impl Iterator<Item = f64> + 'a {
        phases.iter().zip(&self.flows).map(|(phase, flow)| flow.frequency * phase.quadrature)
    }

    /// The elastic part of the rates at a point (rad/s), at which the modes turn by these rotations.
    pub fn rate_at(&self, rotations: &[Vector], phases: &[Phase]) -> Vector {
        self.rates(phases).zip(rotations).fold(Vector::zeros(), |sum, (rate, shape)| sum + shape * rate)
    }

    /// Energy of motion and deformation of each mode (J): (q'² + w² q²)/2.
    pub fn energies<'a>(&'a self, phases: &'a [Phase]) -> impl Iterator<Item = f64> + 'a {
        phases.iter().zip(&self.flows).map(|(Phase { displacement: x, quadrature: y }, flow)| {
            0.5 * flow.frequency * flow.frequency * (x * x + y * y)
        })
    }
}

/// Turns a mode about its equilibrium under a modal force (N/sqrt(kg)), by its transition over a span.
#[inline]
fn turn(phase: &mut Phase, flow: &ModeFlow, &[a, b, c, d]: &[f64; 4], force: f64) {
    let centre = force / (flow.frequency * flow.frequency);
    let (x, y) = (phase.displacement - centre, phase.quadrature);
    *phase = Phase { displacement: centre + a * x + b * y, quadrature: c * x + d * y };
}
