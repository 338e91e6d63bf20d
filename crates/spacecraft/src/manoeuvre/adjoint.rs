//! Adjoint functions of a body: a command brings rigid body and modes to the wanted final state if its products with
//! them have given values.
//!
//! The argument is the remaining part rho = (T - t)/T of the time. The functions are 1, rho - 1/2, and for each zero
//! the real and the imaginary part of exp(pole T rho), times rho, rho², ... if it is repeated.

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};
use flexsc_numerics::phasor::Phasor;
use flexsc_numerics::phi::{exp, moment};
use nalgebra::{DMatrix, DVector};

use super::suppression::Zero;
use super::task::RestToRestTask;

/// Function Re(exp(pole rho) sum c\[n\] rho^n).
struct AdjointFunction {
    pole: Phasor,
    coefficients: Vec<Phasor>,
}

/// Adjoint functions of a task, and the products that its command must have with them.
pub struct Adjoint {
    time: f64,
    functions: Vec<AdjointFunction>,
}

impl Adjoint {
    /// Creates the adjoint functions of a rigid body and the given zeros, which are in order of frequency.
    pub fn new(time: f64, zeros: &[Zero]) -> Self {
        let real = |c: &[f64]| AdjointFunction {
            pole: Phasor::default(),
            coefficients: c.iter().map(|c| Phasor::new(*c, 0.0)).collect(),
        };
        let mut functions = vec![real(&[1.0]), real(&[-0.5, 1.0])];
        let mut times = 0;
        for (index, zero) in zeros.iter().enumerate() {
            times = if index > 0 && zeros[index - 1] == *zero { times + 1 } else { 0 };
            for unit in [Phasor::new(1.0, 0.0), Phasor::new(0.0, -1.0)] {
                let mut coefficients = vec![Phasor::default(); times];
                coefficients.push(unit);
                functions.push(AdjointFunction { pole: zero.pole() * time, coefficients });
            }
        }
        Self { time, functions }
    }

    /// Returns the number of functions.
    pub fn len(&self) -> usize {
        self.functions.len()
    }

    /// Returns the products that the command must have with the functions, over rho from 0 to 1.
    pub fn products(&self, task: &RestToRestTask) -> DVector<f64> {
        let mut products = DVector::zeros(self.len());
        products[0] = task.mean();
        products[1] = task.excess_travel() / (task.time * task.time);
        products
    }

    /// Returns the Gram matrix: the products of the functions with each other.
    pub fn gram(&self) -> DMatrix<f64> {
        let product = |a: &AdjointFunction, b: &AdjointFunction| {
            let mut sum = 0.0;
            for (n, c) in a.coefficients.iter().enumerate() {
                for (m, d) in b.coefficients.iter().enumerate() {
                    if *c != Phasor::default() && *d != Phasor::default() {
                        sum += 0.5 * (c * d * moment(n + m, a.pole + b.pole)).re;
                        sum += 0.5 * (c * d.conj() * moment(n + m, a.pole + b.pole.conj())).re;
                    }
                }
            }
            sum
        };
        DMatrix::from_fn(self.len(), self.len(), |i, j| {
            // Symmetric to the last bit.
            let (i, j) = (i.min(j), i.max(j));
            product(&self.functions[i], &self.functions[j])
        })
    }

    /// Computes the weights of the functions whose sum has the given products: the command of minimum energy.
    pub fn least(&self, products: &DVector<f64>) -> Option<DVector<f64>> {
        let gram = self.gram();
        let scale = gram.diagonal().map(|d| 1.0 / f64::sqrt(d));
        let scaled = DMatrix::from_fn(self.len(), self.len(), |i, j| gram[(i, j)] * scale[i] * scale[j]);
        let factor = scaled.clone().cholesky()?;
        let right_hand_side = products.component_mul(&scale);
        let mut weights = factor.solve(&right_hand_side);
        for _ in 0..2 {
            weights += factor.solve(&(&right_hand_side - &scaled * &weights));
        }
        let gap = (&right_hand_side - &scaled * &weights).amax();
        // If the functions are dependent within rounding, the solution is not reliable.
        (gap <= 1e-10 * right_hand_side.amax()).then(|| weights.component_mul(&scale))
    }

    /// Returns the values of the functions at rho.
    pub fn at(&self, rho: f64) -> impl Iterator<Item = f64> {
        self.functions.iter().map(move |f| (exp(f.pole * rho) * f.polynomial(rho)).re)
    }

    /// Returns the derivatives of the functions with rho; valid without repeated zeros.
    pub fn slopes(&self, rho: f64) -> impl Iterator<Item = f64> {
        self.functions.iter().map(move |f| match f.coefficients.as_slice() {
            [c] => (exp(f.pole * rho) * f.pole * c).re,
            c => c[1].re,
        })
    }

    /// Returns the integrals of the functions from 0 to rho; valid without repeated zeros.
    pub fn integrals(&self, rho: f64) -> impl Iterator<Item = f64> {
        self.functions.iter().map(move |f| match f.coefficients.as_slice() {
            [c] if f.pole == Phasor::default() => c.re * rho,
            [c] => ((exp(f.pole * rho) - 1.0) / f.pole * c).re,
            c => (c[0].re + 0.5 * c[1].re * rho) * rho,
        })
    }

    /// Returns the highest frequency of the functions in rho (rad).
    pub fn fastest(&self) -> f64 {
        self.functions.iter().map(|f| f.pole.im).fold(0.0, f64::max)
    }

    /// Returns the command that is a weighted sum of the functions.
    pub fn waveform(&self, weights: &DVector<f64>) -> Waveform {
        let term = |shape| Term { from: 0.0, to: self.time, shape };
        let slope = weights[1] / self.time;
        let mut terms = vec![term(TermShape::Polynomial(vec![weights[0] + 0.5 * weights[1], -slope]))];
        for (pair, weights) in
            self.functions[2..].chunks_exact(2).zip(weights.as_slice()[2..].chunks_exact(2))
        {
            let f = &pair[0];
            let power = f.coefficients.len() - 1;
            let c = Phasor::new(weights[0], -weights[1]) * exp(f.pole);
            if power == 0 && f.pole.re == 0.0 {
                terms.push(term(TermShape::Harmonic {
                    frequency: f.pole.im / self.time,
                    cosine: c.re,
                    sine: c.im,
                }));
                continue;
            }
            // The power rho^power is (1 - t/T)^power.
            let mut coefficients = Vec::new();
            let mut binomial = 1.0;
            for k in 0..=power {
                coefficients.push(c * binomial);
                binomial *= -((power - k) as f64) / (k + 1) as f64 / self.time;
            }
            terms.push(term(TermShape::Exponential { pole: -f.pole / self.time, coefficients }));
        }
        Waveform { terms }
    }
}

impl AdjointFunction {
    fn polynomial(&self, rho: f64) -> Phasor {
        self.coefficients.iter().rev().fold(Phasor::default(), |sum, c| sum * rho + c)
    }
}
