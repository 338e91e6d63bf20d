//! Motion of a linear plant under one constant input: residues at the start of the segment, from which later motion
//! follows.

use std::sync::Arc as Shared;

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::DVector;

use super::cluster::moved;
use super::flow::{LinearFlow, ModalState};
use crate::AngleObservation;

/// Motion of a linear plant under one constant input.
#[derive(Clone, Debug)]
pub struct LinearSegment {
    pub(super) flow: Shared<LinearFlow>,
    from: ModalState,
    /// Modal rates at the start of the segment.
    rates: Vec<Phasor>,
    cluster_rates: Vec<DVector<Phasor>>,
    /// Residues of the acceleration, per output and pole, and their absolute values times the pole's weight.
    pub(super) residues: Vec<Phasor>,
    pub(super) sizes: Vec<f64>,
    /// Value and rate of each output at the start of the segment.
    pub(super) origins: Vec<(f64, f64)>,
}

/// Outputs at one instant, with bounds of their later derivatives.
#[derive(Clone, Debug, Default)]
pub struct LinearOutput {
    /// Value, rate and acceleration of each output.
    pub outputs: Vec<AngleObservation>,
    /// Bound of |y''| of each output within the window.
    pub curvature: Vec<f64>,
    /// Bound of |y'''| of each output within the window.
    pub jerk: Vec<f64>,
    /// Time for which the bounds are valid (s).
    pub window: f64,
    /// Values of e^(lambda h) and its absolute value, per pole.
    pub(super) exponentials: Vec<(Phasor, f64)>,
    /// Current rates of the clusters.
    pub(super) rates: Vec<DVector<Phasor>>,
}

impl LinearSegment {
    /// Creates a motion of a flow; call `depart` before use.
    pub fn new(flow: Shared<LinearFlow>) -> Self {
        let (outputs, poles) = (flow.outputs(), flow.poles.len());
        Self {
            from: ModalState::default(),
            rates: vec![Phasor::default(); poles],
            cluster_rates: Vec::new(),
            residues: vec![Phasor::default(); outputs * poles],
            sizes: vec![0.0; outputs * poles],
            origins: vec![(0.0, 0.0); outputs],
            flow,
        }
    }

    /// Begins a new segment from a state, under a constant input.
    pub fn depart(&mut self, from: &ModalState, input: &[f64]) {
        self.from.clone_from(from);
        let (flow, count) = (&*self.flow, self.flow.poles.len());
        for (j, origin) in self.origins.iter_mut().enumerate() {
            let rigid = flow.rigid.row(j);
            *origin = (rigid.iter().zip(&from.cyclic).map(|(c, theta)| c * theta).sum(), 0.0);
        }
        for (k, (simple, w)) in flow.poles.iter().zip(&from.simple).enumerate() {
            let pushed = simple.push.iter().zip(input).fold(Phasor::default(), |sum, (b, u)| sum + b * *u);
            let rate = simple.pole.lambda * w + pushed;
            self.rates[k] = rate;
            for (j, output) in simple.outputs.iter().enumerate() {
                let residue = output.residue * rate;
                self.residues[j * count + k] = residue;
                self.sizes[j * count + k] = simple.weight * abs(residue);
                let (y, v) = &mut self.origins[j];
                *y += simple.weight * real(output.angle, *w);
                *v += simple.weight * (real(output.rate, *w) + real(output.angle, rate));
            }
        }
        self.cluster_rates.clear();
        for (cluster, w) in flow.clusters.iter().zip(&from.clusters) {
            let input = DVector::from_iterator(input.len(), input.iter().map(|u| Phasor { re: *u, im: 0.0 }));
            let rates = &cluster.block.triangle * w + &cluster.push * input;
            let (angle, rate) = (&cluster.angle * w, &cluster.rate * w + &cluster.angle * &rates);
            for (j, (y, v)) in self.origins.iter_mut().enumerate() {
                *y += cluster.block.weight * angle[j].re;
                *v += cluster.block.weight * rate[j].re;
            }
            self.cluster_rates.push(rates);
        }
    }

    /// Evaluates the outputs at `h` (s) since the start of the segment.
    pub fn at(&self, h: f64, output: &mut LinearOutput) {
        let (flow, count) = (&*self.flow, self.flow.poles.len());
        output.fit(self);
        for (sensed, (y, v)) in output.outputs.iter_mut().zip(&self.origins) {
            *sensed = AngleObservation { angle: y + v * h, rate: *v, acceleration: 0.0 };
        }
        for (k, simple) in flow.poles.iter().enumerate() {
            let phi = simple.pole.phi(h);
            let shrunk = if simple.pole.lambda.re == 0.0 { 1.0 } else { abs(phi.exp) };
            output.exponentials[k] = (phi.exp, shrunk);
            for (j, sensed) in output.outputs.iter_mut().enumerate() {
                let residue = self.residues[j * count + k];
                sensed.acceleration += simple.weight * real(residue, phi.exp);
                sensed.rate += simple.weight * real(residue, phi.first);
                sensed.angle += simple.weight * real(residue, phi.second);
            }
        }
        for (k, (cluster, rates)) in flow.clusters.iter().zip(&self.cluster_rates).enumerate() {
            let moved = moved(&cluster.block.triangle, rates, h);
            let [acceleration, rate, angle] =
                [&moved.exp, &moved.first, &moved.second].map(|vector| &cluster.residue * vector);
            for (j, sensed) in output.outputs.iter_mut().enumerate() {
                sensed.acceleration += cluster.block.weight * acceleration[j].re;
                sensed.rate += cluster.block.weight * rate[j].re;
                sensed.angle += cluster.block.weight * angle[j].re;
            }
            output.rates[k] = moved.exp;
        }
        flow.bound(self, output);
    }

    /// Evaluates the outputs at the start of the segment, which needs no exponential.
    pub fn initial_output(&self, output: &mut LinearOutput) {
        let (flow, count) = (&*self.flow, self.flow.poles.len());
        output.fit(self);
        output.exponentials.fill((Phasor { re: 1.0, im: 0.0 }, 1.0));
        for (j, (sensed, (angle, rate))) in output.outputs.iter_mut().zip(&self.origins).enumerate() {
            let residues = flow.poles.iter().zip(&self.residues[j * count..]);
            let mut acceleration: f64 = residues.map(|(simple, a)| simple.weight * a.re).sum();
            for (cluster, rates) in flow.clusters.iter().zip(&self.cluster_rates) {
                acceleration += cluster.block.weight * (cluster.residue.row(j) * rates)[0].re;
            }
            *sensed = AngleObservation { angle: *angle, rate: *rate, acceleration };
        }
        output.rates.clone_from(&self.cluster_rates);
        flow.bound(self, output);
    }

    /// Evaluates the state at `h` (s) since the start of the segment.
    pub fn state_at(&self, h: f64, state: &mut ModalState) {
        state.clone_from(&self.from);
        for (k, simple) in self.flow.poles.iter().enumerate() {
            let phi = simple.pole.phi(h);
            let (w, rate) = (self.from.simple[k], self.rates[k]);
            state.simple[k] = w + phi.first * rate;
            for (theta, carry) in state.cyclic.iter_mut().zip(&simple.carry) {
                *theta += simple.weight * (h * real(*carry, w) + real(*carry, phi.second * rate));
            }
        }
        for (k, (cluster, rates)) in self.flow.clusters.iter().zip(&self.cluster_rates).enumerate() {
            let moved = moved(&cluster.block.triangle, rates, h);
            let carried =
                &cluster.carry * (&self.from.clusters[k] * Phasor { re: h, im: 0.0 } + &moved.second);
            for (theta, carried) in state.cyclic.iter_mut().zip(carried.iter()) {
                *theta += cluster.block.weight * carried.re;
            }
            state.clusters[k] += &moved.first;
        }
    }
}

impl LinearOutput {
    fn fit(&mut self, segment: &LinearSegment) {
        let outputs = segment.origins.len();
        if self.outputs.len() != outputs || self.exponentials.len() != segment.rates.len() {
            self.outputs = vec![AngleObservation::default(); outputs];
            self.curvature = vec![0.0; outputs];
            self.jerk = vec![0.0; outputs];
            self.exponentials = vec![Default::default(); segment.rates.len()];
            self.rates.clone_from(&segment.cluster_rates);
        }
    }
}

/// Returns Re(a b).
#[inline]
pub fn real(a: Phasor, b: Phasor) -> f64 {
    a.re * b.re - a.im * b.im
}
