//! Motion of the exact planar chain under one input, integrated to a tolerance, and its Taylor series.

use flexsc_numerics::extrapolation::{RightHandSide, Trajectory};
use flexsc_numerics::polynomial::{Series, TERMS};
use nalgebra::DVector;

use super::waveform_response::{ActiveWaveform, SegmentInput};
use crate::chain_model::Chain;
use crate::polynomial_piece::{REACH, SeriesExpansion};
use crate::{AngleObservation, AxisState};

/// Equations of motion of a chain under one input.
struct ChainEquations<'a> {
    chain: &'a Chain,
    input: &'a SegmentInput,
}

impl ChainEquations<'_> {
    /// Returns the accelerations of all angles (rad/s²) at `t` seconds after the input began.
    fn acceleration(&self, t: f64, y: &[f64]) -> DVector<f64> {
        let Chain { inertia, stiffness, damping, load, .. } = self.chain;
        let n = inertia.nrows();
        let (angle, rate) = (DVector::from_column_slice(&y[..n]), DVector::from_column_slice(&y[n..]));
        let mut force = -(stiffness * &angle) - damping * &rate;
        let waveform = self.input.waveform.as_ref().map_or(0.0, |forced| forced.at(t));
        let torque = self.input.constant + waveform;
        force.iter_mut().zip(load).for_each(|(force, part)| *force += part * torque);
        let mut coupling = inertia.clone();
        for i in 0..n {
            for j in 0..i {
                let (sin, cos) = libm::sincos(angle[i] - angle[j]);
                let centrifugal = inertia[(i, j)] * sin;
                force[i] -= centrifugal * rate[j] * rate[j];
                force[j] += centrifugal * rate[i] * rate[i];
                coupling[(i, j)] *= cos;
                coupling[(j, i)] *= cos;
            }
        }
        // The kinetic energy is positive at all angles; a NaN is passed on.
        coupling.cholesky().map_or_else(|| DVector::repeat(n, f64::NAN), |factor| factor.solve(&force))
    }
}

impl RightHandSide for ChainEquations<'_> {
    fn rate(&self, t: f64, y: &[f64], rate: &mut [f64]) {
        let n = y.len() / 2;
        rate[..n].copy_from_slice(&y[n..]);
        rate[n..].copy_from_slice(self.acceleration(t, y).as_slice());
    }
}

/// Motion of a chain under one input.
#[derive(Clone, Debug)]
pub struct ChainMotion {
    chain: Chain,
    input: SegmentInput,
    /// Trajectory of angles and rates.
    trajectory: Trajectory,
    /// Angles and rates at departure.
    start: Vec<f64>,
}

impl ChainMotion {
    /// Creates the motion of a straight chain from an angle (rad) and a rate (rad/s), under no input.
    pub fn new(chain: &Chain, angle: f64, rate: f64) -> Self {
        let step = 0.05 / chain.frequencies.iter().copied().fold(1e-3, f64::max);
        let trajectory = Trajectory::new(chain.tolerance, chain.start(angle, rate), step);
        let start = trajectory.current().to_vec();
        Self { chain: chain.clone(), input: SegmentInput::default(), trajectory, start }
    }

    /// Begins a motion under another input, from the current state.
    pub fn depart(&mut self, input: &SegmentInput) {
        self.input = input.clone();
        self.trajectory.depart();
        self.start.copy_from_slice(self.trajectory.current());
    }

    /// Advances by one integration step towards `h` seconds after departure; returns true if that time is reached.
    pub fn approach(&mut self, h: f64) -> bool {
        self.trajectory.step_towards(&ChainEquations { chain: &self.chain, input: &self.input }, h)
    }

    /// Writes the state at `h` seconds after departure, which must not precede an earlier request; returns the hub's
    /// motion as a sensor measures it.
    pub fn at(&mut self, h: f64, state: &mut AxisState) -> AngleObservation {
        self.trajectory.at(&ChainEquations { chain: &self.chain, input: &self.input }, h);
        self.see(h, state)
    }

    fn see(&self, h: f64, state: &mut AxisState) -> AngleObservation {
        let n = self.chain.inertia.nrows();
        let (angle, rate) = self.trajectory.current().split_at(n);
        let modal = &self.chain.modal * DVector::from_column_slice(angle);
        let modal_rate = &self.chain.modal * DVector::from_column_slice(rate);
        (state.rigid_angle, state.rigid_rate) = (modal[0], modal_rate[0]);
        for (index, (phase, w)) in state.modes.iter_mut().zip(&self.chain.frequencies).enumerate() {
            (phase.displacement, phase.quadrature) = (modal[index + 1], modal_rate[index + 1] / w);
        }
        let driven = ChainEquations { chain: &self.chain, input: &self.input };
        AngleObservation {
            angle: angle[0],
            rate: rate[0],
            acceleration: driven.acceleration(h, self.trajectory.current())[0],
        }
    }

    /// Returns value and rate of each output: the angle of each section relative to the hub.
    pub fn outputs(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let n = self.chain.inertia.nrows();
        let y = self.trajectory.current();
        (1..n).map(move |k| (y[k] - y[0], y[n + k] - y[n]))
    }

    /// Returns the number of angles, which may exceed the number of modes kept.
    pub fn coordinates(&self) -> usize {
        self.chain.inertia.nrows()
    }

    /// Returns the Taylor expansion of the motion from its departure on.
    pub fn expansion(&self) -> ChainExpansion<'_> {
        let (angles, rates) = self.start.split_at(self.chain.inertia.nrows());
        let begin = |(angle, rate): (&f64, &f64)| {
            let mut series = [0.0; TERMS];
            (series[0], series[1]) = (*angle, *rate);
            series
        };
        ChainExpansion { flight: self, begins: 0.0, angles: angles.iter().zip(rates).map(begin).collect() }
    }

    /// Returns the kinetic and strain energy (J).
    pub fn energy(&self) -> f64 {
        let Chain { inertia, stiffness, .. } = &self.chain;
        let n = inertia.nrows();
        let (angle, rate) = self.trajectory.current().split_at(n);
        let angles = DVector::from_column_slice(angle);
        let mut twice = (stiffness * &angles).dot(&angles);
        for i in 0..n {
            for j in 0..n {
                twice += inertia[(i, j)] * libm::cos(angle[i] - angle[j]) * rate[i] * rate[j];
            }
        }
        0.5 * twice
    }
}

/// Chain motion as Taylor series of its angles, each coefficient computed from the previous ones.
#[derive(Debug)]
pub struct ChainExpansion<'a> {
    flight: &'a ChainMotion,
    /// Origin of the series, after departure (s).
    begins: f64,
    angles: Vec<Series>,
}

impl ChainExpansion<'_> {
    /// Expands all coordinates at `h` seconds after departure, which must not precede an earlier request, and returns
    /// the time for which the series are valid (s). The waveform must have no break until 2 `middle` after departure
    /// (s).
    pub fn expand(&mut self, h: f64, middle: f64, into: &mut SeriesExpansion) -> f64 {
        let after = h - self.begins;
        for angle in &mut self.angles {
            let (x, v) = angle.iter().rev().fold((0.0, 0.0), |(x, v), c| (x * after + c, v * after + x));
            (angle[0], angle[1]) = (x, v);
        }
        self.begins = h;
        if let Some(forced) = &self.flight.input.waveform {
            into.command = forced.series(middle, h);
        }
        let mut torque = into.command;
        torque[0] += self.flight.input.constant;
        self.fill(&torque);
        into.coordinates.copy_from_slice(&self.angles);
        let command = self.flight.input.waveform.as_ref().map_or(0.0, ActiveWaveform::fastest);
        let fastest = self.flight.chain.frequencies.iter().copied().fold(command, f64::max);
        reach(&self.angles, fastest)
    }

    /// Computes the series from their first two terms, under a commanded torque.
    fn fill(&mut self, torque: &Series) {
        let Chain { inertia, stiffness, damping, load, .. } = &self.flight.chain;
        let (n, angles) = (inertia.nrows(), &mut self.angles);
        let zero = vec![[0.0; TERMS]; n];
        // Sine and cosine of the angle between each pair of sections; squares of the rates; accelerations.
        let (mut sines, mut cosines) = (vec![zero.clone(); n], vec![zero.clone(); n]);
        let (mut squares, mut accelerations) = (zero.clone(), zero);
        let mut mass = inertia.clone();
        for i in 0..n {
            for j in 0..n {
                let (sin, cos) = libm::sincos(angles[i][0] - angles[j][0]);
                (sines[i][j][0], cosines[i][j][0]) = (sin, cos);
                mass[(i, j)] *= cos;
            }
        }
        let Some(factor) = mass.cholesky() else { return };
        let mut force = DVector::zeros(n);
        for k in 0..TERMS - 2 {
            let rate = |angle: &Series, m: usize| (m + 1) as f64 * angle[m + 1];
            for (square, angle) in squares.iter_mut().zip(angles.iter()) {
                square[k] = (0..=k).map(|m| rate(angle, m) * rate(angle, k - m)).sum();
            }
            for i in 0..n {
                for j in (0..n).filter(|j| *j != i && k > 0) {
                    let (mut sin, mut cos) = (0.0, 0.0);
                    for m in 1..=k {
                        let turn = m as f64 * (angles[i][m] - angles[j][m]) / k as f64;
                        sin += turn * cosines[i][j][k - m];
                        cos -= turn * sines[i][j][k - m];
                    }
                    (sines[i][j][k], cosines[i][j][k]) = (sin, cos);
                }
            }
            for i in 0..n {
                let mut sum = load[i] * torque[k];
                for j in 0..n {
                    sum -= stiffness[(i, j)] * angles[j][k] + damping[(i, j)] * rate(&angles[j], k);
                    let (sine, cosine) = (&sines[i][j], &cosines[i][j]);
                    let turned: f64 = (0..=k).map(|m| sine[m] * squares[j][k - m]).sum();
                    let carried: f64 = (1..=k).map(|m| cosine[m] * accelerations[j][k - m]).sum();
                    sum -= inertia[(i, j)] * (turned + carried);
                }
                force[i] = sum;
            }
            factor.solve_mut(&mut force);
            for (i, (angle, acceleration)) in angles.iter_mut().zip(&mut accelerations).enumerate() {
                acceleration[k] = force[i];
                angle[k + 2] = force[i] / ((k + 1) * (k + 2)) as f64;
            }
        }
    }
}

/// Returns the time (s) for which series are exact to rounding: [`REACH`] radians of the fastest mode or command, and
/// if large angles make the motion faster, a part of the radius of convergence by the last terms, as for drifting
/// frequencies.
fn reach(angles: &[Series], fastest: f64) -> f64 {
    const SAFETY: f64 = 7.389_056_098_930_65;
    let largest = |n: usize| angles.iter().map(|c| c[n].abs()).fold(0.0, f64::max);
    // The size is of all terms: a chain may begin at rest, under a torque that begins at 0.
    let (size, _) =
        (0..TERMS).fold((0.0_f64, 1.0), |(size, unit), n| (size.max(largest(n) * unit), unit / fastest));
    let radius = |n: usize| match largest(n) {
        0.0 => f64::INFINITY,
        term => libm::pow(size / term, 1.0 / n as f64),
    };
    (radius(TERMS - 1).min(radius(TERMS - 2)) / SAFETY).min(REACH / fastest)
}
