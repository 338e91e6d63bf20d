//! Command of the smallest peak that leaves modes at rest: bang-bang with many switchings.
//!
//! The command is A sign(f) with f a weighted sum of the adjoint functions g, and its products with them are S h, where
//! S is the integral of |f|, and h that of g sign(f). They are the gradient of S²/2, which is convex: the weights
//! minimise S²/2 - lambda b, where b are the required products, and A is S there. Newton's method with the exact second
//! derivatives h h^T + 2 S sum g g^T/|f'| over the switchings finds them.

use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;
use nalgebra::{DMatrix, DVector};

use super::adjoint::Adjoint;
use super::bang_bang::pieces;
use super::minimum_energy::too_short;
use super::suppression::Zero;
use super::task::RestToRestTask;

/// Largest number of Newton steps; some thirty are needed.
const STEPS: usize = 400;
/// Number of samples in the shortest period of f.
const SAMPLES: f64 = 64.0;

/// Plans the command.
pub fn plan(task: &RestToRestTask, zeros: &[Zero]) -> Result<Waveform, ConfigError> {
    let search = SwitchingSearch::new(task, zeros);
    let size = search.products.norm();
    if size == 0.0 {
        return Ok(pieces(&[0.0, task.time], 0.0));
    }
    let refused = || too_short(task.time);
    let bang = search.solve().ok_or_else(refused)?;
    let mut times = vec![0.0];
    times.extend(bang.switchings.iter().rev().map(|rho| task.time * (1.0 - rho)));
    times.push(task.time);
    let last = if bang.switchings.len() % 2 == 0 { bang.first } else { -bang.first };
    Ok(pieces(&times, last * bang.amplitude * size))
}

/// Search for the weights, with the required products scaled to length 1.
struct SwitchingSearch {
    adjoint: Adjoint,
    products: DVector<f64>,
    target: DVector<f64>,
    grid: Vec<f64>,
    /// Adjoint functions on the grid, one row for each function.
    samples: DMatrix<f64>,
}

/// Bang-bang function A sign(f): the switchings in rho, in order, and the sign before the first.
struct SwitchingCommand {
    amplitude: f64,
    first: f64,
    switchings: Vec<f64>,
}

impl SwitchingSearch {
    fn new(task: &RestToRestTask, zeros: &[Zero]) -> Self {
        let adjoint = Adjoint::new(task.time, zeros);
        let products = adjoint.products(task);
        let periods = adjoint.fastest() / std::f64::consts::TAU;
        let count = (SAMPLES * (periods + 4.0)).min(2e5) as usize;
        let grid: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
        let mut samples = DMatrix::zeros(adjoint.len(), grid.len());
        for (rho, mut column) in grid.iter().zip(samples.column_iter_mut()) {
            column.iter_mut().zip(adjoint.at(*rho)).for_each(|(sample, value)| *sample = value);
        }
        let target = &products / products.norm();
        Self { adjoint, products, target, grid, samples }
    }

    fn solve(&self) -> Option<SwitchingCommand> {
        let mut weights = self.adjoint.least(&self.target)?;
        let start = self.bang(&weights);
        weights *= weights.dot(&self.target) / (start.amplitude * start.amplitude);
        let mut bang = self.bang(&weights);
        let mut value = self.value(&weights, &bang);
        let mut gradient = self.gap(&bang);
        // With fewer switchings than functions the second derivatives leave directions flat, and if two switchings
        // merge they are unbounded: the steps are damped (Levenberg).
        let mut damping = 1e-2;
        for _ in 0..STEPS {
            if gradient.amax() < 1e-14 || damping > 1e8 {
                break;
            }
            let mut curvature = self.curvature(&weights, &bang);
            let ridge = damping * curvature.trace() / self.adjoint.len() as f64;
            (0..self.adjoint.len()).for_each(|j| curvature[(j, j)] += ridge);
            let step = curvature.cholesky().map(|factor| factor.solve(&-&gradient));
            let next = step.map(|step| &weights + step);
            let reached = next.map(|weights| (self.bang(&weights), weights));
            damping *= 10.0;
            if let Some((next, next_weights)) = reached {
                let (next_value, next_gradient) = (self.value(&next_weights, &next), self.gap(&next));
                // Near the end the value no longer decides, but the gradient does.
                if next_value < value || next_gradient.norm() < 0.5 * gradient.norm() {
                    (weights, bang, value, gradient) = (next_weights, next, next_value, next_gradient);
                    damping = (damping * 1e-2).max(1e-15);
                }
            }
        }
        self.polished(bang, &gradient)
    }

    /// Returns the bang-bang function of the weights, with S for its amplitude.
    fn bang(&self, weights: &DVector<f64>) -> SwitchingCommand {
        let f = self.samples.tr_mul(weights);
        let value_at = |rho: f64| self.adjoint.at(rho).zip(weights.iter()).map(|(g, w)| g * w).sum::<f64>();
        let mut switchings = Vec::new();
        for i in 1..f.len() {
            let (a, b) = (self.grid[i - 1], self.grid[i]);
            if (f[i - 1] > 0.0) != (f[i] > 0.0) {
                switchings.push(root(value_at, (a, f[i - 1]), (b, f[i])));
            } else if i + 1 < f.len() && f[i].abs() < f[i - 1].abs() && f[i].abs() <= f[i + 1].abs() {
                // Between samples there may be two switchings near the sample closest to zero.
                let (before, now, after) = (f[i - 1], f[i], f[i + 1]);
                let bend = before - 2.0 * now + after;
                let middle = b + 0.5 * (b - a) * (before - after) / bend;
                let value = value_at(middle);
                if bend != 0.0 && (value > 0.0) != (now > 0.0) && (after > 0.0) == (now > 0.0) {
                    let (low, high) = ((a, before), (self.grid[i + 1], after));
                    switchings.push(root(value_at, low, (middle, value)));
                    switchings.push(root(value_at, (middle, value), high));
                }
            }
        }
        let first = if f[0] > 0.0 { 1.0 } else { -1.0 };
        let mut bang = SwitchingCommand { amplitude: 1.0, first, switchings };
        bang.amplitude = self.products_of(&bang).dot(weights);
        bang
    }

    /// Returns h: the products of a bang-bang function of amplitude 1 with the adjoint functions.
    fn products_of(&self, bang: &SwitchingCommand) -> DVector<f64> {
        let mut h = DVector::zeros(self.adjoint.len());
        let mut sign = bang.first;
        let mut from = vec![0.0; self.adjoint.len()];
        for rho in bang.switchings.iter().copied().chain([1.0]) {
            for (j, integral) in self.adjoint.integrals(rho).enumerate() {
                h[j] += sign * (integral - from[j]);
                from[j] = integral;
            }
            sign = -sign;
        }
        h
    }

    fn value(&self, weights: &DVector<f64>, bang: &SwitchingCommand) -> f64 {
        0.5 * bang.amplitude * bang.amplitude - weights.dot(&self.target)
    }

    /// Returns the gradient: the products minus the required ones.
    fn gap(&self, bang: &SwitchingCommand) -> DVector<f64> {
        self.products_of(bang) * bang.amplitude - &self.target
    }

    fn curvature(&self, weights: &DVector<f64>, bang: &SwitchingCommand) -> DMatrix<f64> {
        let h = self.products_of(bang);
        let mut curvature = &h * h.transpose();
        for rho in &bang.switchings {
            let g = DVector::from_iterator(self.adjoint.len(), self.adjoint.at(*rho));
            let slope: f64 = self.adjoint.slopes(*rho).zip(weights.iter()).map(|(g, w)| g * w).sum();
            let floor = 1e-9 * bang.amplitude;
            curvature += &g * g.transpose() * (2.0 * bang.amplitude / slope.abs().max(floor));
        }
        curvature
    }

    /// Corrects amplitude and switchings by the last rounding errors of the weights; `None` if they are not small.
    fn polished(&self, mut bang: SwitchingCommand, gradient: &DVector<f64>) -> Option<SwitchingCommand> {
        if gradient.amax() > 1e-8 {
            return None;
        }
        for _ in 0..3 {
            let gap = self.gap(&bang);
            let mut columns = vec![self.products_of(&bang)];
            let mut sign = bang.first;
            for rho in &bang.switchings {
                let g = DVector::from_iterator(self.adjoint.len(), self.adjoint.at(*rho));
                columns.push(g * (2.0 * bang.amplitude * sign));
                sign = -sign;
            }
            let jacobian = DMatrix::from_columns(&columns);
            let Some(factor) = (&jacobian * jacobian.transpose()).cholesky() else { break };
            let step = jacobian.tr_mul(&factor.solve(&gap));
            let mut moved = bang.switchings.clone();
            moved.iter_mut().zip(step.iter().skip(1)).for_each(|(rho, d)| *rho -= d);
            let next = SwitchingCommand {
                amplitude: bang.amplitude - step[0],
                first: bang.first,
                switchings: moved,
            };
            let ordered = next.switchings.windows(2).all(|pair| pair[0] < pair[1]);
            if !ordered || self.gap(&next).norm() >= gap.norm() {
                break;
            }
            bang = next;
        }
        Some(bang)
    }
}

/// Finds the root of a function between two points at which it has different signs, to the last bit.
fn root(f: impl Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64)) -> f64 {
    // Regula falsi that halves the value of an end that stays (Illinois).
    let mut stayed = 0;
    for _ in 0..100 {
        let x = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        if !(x > low.0 && x < high.0) {
            break;
        }
        let y = f(x);
        if y == 0.0 {
            return x;
        }
        if (y > 0.0) == (high.1 > 0.0) {
            high = (x, y);
            if stayed == -1 {
                low.1 *= 0.5;
            }
            stayed = -1;
        } else {
            low = (x, y);
            if stayed == 1 {
                high.1 *= 0.5;
            }
            stayed = 1;
        }
    }
    if low.1.abs() < high.1.abs() { low.0 } else { high.0 }
}
