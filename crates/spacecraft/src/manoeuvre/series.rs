//! Commands as series of sines or of cosines that leave chosen modes at rest (\[Rotation\], equations (19) to (30)).
//!
//! With T the time of the manoeuvre and sigma = 2 pi/T the command is a constant A0, a series with the harmonics
//! kappa that carries the travel, and, if A0 is not zero, a series of k sigma that cancels the effect of A0 on the
//! modes. The Laplace transform of each is a factor that has no pole, times a rational function whose numerator holds
//! the chosen zeros, so that every amplitude is a product:
//!
//! ```text
//! q_j(s) = (s² + 2 zeta_j w_j s + w_j²)/w_j²         one factor for each zero
//! G_k    = prod_j q_j(i kappa_k) / prod_(j != k) (kappa_j² - kappa_k²)/kappa_j²
//! sine:     (1 - e^(-sT)) C prod q_j / prod (1 + s²/kappa²)        kappa = k sigma,          k = 1..p+1
//! cosine:   (1 + e^(-sT)) C s prod q_j / prod (1 + s²/kappa²)      kappa = (k - 1/2) sigma,  k = 1..p+1
//! constant: (1 - e^(-sT)) A0/s prod q_j / prod (1 + s²/kappa²)     kappa = k sigma,          k = 1..p
//! ```
//!
//! A linear solve would lose all digits beyond some eight zeros; the products lose none. For undamped modes G_k is
//! real, and these are the paper's series, except that the paper's 2p + 1 sines (or cosines) cannot satisfy two
//! equations in one scalar for each mode unless A0 is zero: the constant needs the even series.

use std::f64::consts::PI;

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};
use flexsc_numerics::phasor::Phasor;

use super::suppression::Zero;
use super::task::RestToRestTask;

/// Amplitudes of a series, in units of the command.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeriesCoefficients {
    /// Constant A0 of the series.
    pub constant: f64,
    /// Amplitudes of sin(k sigma t), or of cos((k - 1/2) sigma t), k = 1, 2, ...: antisymmetric about T/2.
    pub odd: Vec<f64>,
    /// Amplitudes of cos(k sigma t), k = 1, 2, ...: symmetric about T/2. Empty if the constant is zero and no zero is
    /// damped.
    pub even: Vec<f64>,
}

/// Family of functions of a series.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum SeriesFamily {
    /// Functions sin(k sigma t): the command begins and ends at zero.
    Sine,
    /// Functions cos((k - 1/2) sigma t): smaller command for the same travel.
    Cosine,
}

/// Plans the command, and returns it with its amplitudes.
pub fn plan(family: SeriesFamily, task: &RestToRestTask, zeros: &[Zero]) -> (Waveform, SeriesCoefficients) {
    let sigma = 2.0 * PI / task.time;
    let constant = task.mean();
    // With damping the even series is no longer symmetric: it contributes to the travel.
    let lag: f64 = zeros.iter().map(|zero| 2.0 * zero.damping / zero.frequency).sum();
    let travel = task.excess_travel() - constant * task.time * lag;

    // Numbers k and phasors c of the harmonics Re(c exp(i kappa t)).
    let count = zeros.len();
    let (half, carry): (f64, Vec<Phasor>) = match family {
        SeriesFamily::Sine => {
            let coefficient = |k| {
                Phasor::new(0.0, -travel / task.time * k as f64 * sigma)
                    * gain(k, count + 1, 0.0, sigma, zeros)
            };
            (0.0, (1..=count + 1).map(coefficient).collect())
        }
        SeriesFamily::Cosine => {
            let coefficient = |k| {
                let kappa = (k as f64 - 0.5) * sigma;
                gain(k, count + 1, 0.5, sigma, zeros) * (0.5 * travel * kappa * kappa)
            };
            (0.5, (1..=count + 1).map(coefficient).collect())
        }
    };
    let even: Vec<Phasor> = if constant == 0.0 {
        Vec::new()
    } else {
        (1..=count).map(|k| gain(k, count, 0.0, sigma, zeros) * -constant).collect()
    };

    let mut terms = Vec::new();
    let mut push = |shape| terms.push(Term { from: 0.0, to: task.time, shape });
    if constant != 0.0 {
        push(TermShape::Polynomial(vec![constant]));
    }
    let mut harmonics = |half: f64, phasors: &[Phasor]| {
        for (index, c) in phasors.iter().enumerate() {
            let frequency = ((index + 1) as f64 - half) * sigma;
            push(TermShape::Harmonic { frequency, cosine: c.re, sine: -c.im });
        }
    };
    let coefficients = match family {
        SeriesFamily::Sine => {
            let zip = |k: usize| carry[k] + even.get(k).copied().unwrap_or_default();
            let all: Vec<Phasor> = (0..carry.len()).map(zip).collect();
            harmonics(half, &all);
            let mut even: Vec<f64> = all.iter().map(|c| c.re).collect();
            if zeros.iter().all(|zero| zero.damping == 0.0) {
                even.truncate(if constant == 0.0 { 0 } else { count });
            }
            SeriesCoefficients { constant, odd: all.iter().map(|c| -c.im).collect(), even }
        }
        SeriesFamily::Cosine => {
            harmonics(half, &carry);
            harmonics(0.0, &even);
            let real = |c: &[Phasor]| c.iter().map(|c| c.re).collect();
            SeriesCoefficients { constant, odd: real(&carry), even: real(&even) }
        }
    };
    (Waveform { terms }, coefficients)
}

/// Returns G_k for a series of `harmonics` harmonics (k - half) sigma.
fn gain(k: usize, harmonics: usize, half: f64, sigma: f64, zeros: &[Zero]) -> Phasor {
    let own = k as f64 - half;
    let kappa = own * sigma;
    let mut others = (1..=harmonics).filter(|j| *j != k);
    // One factor of each product at a time: the complete products would overflow.
    let mut product = Phasor::new(1.0, 0.0);
    for zero in zeros {
        let w = zero.frequency;
        let q = Phasor::new((w - kappa) * (w + kappa), 2.0 * zero.damping * w * kappa) / (w * w);
        let other = others.next().map_or(1.0, |j| {
            let other = j as f64 - half;
            (other - own) * (other + own) / (other * other)
        });
        product *= q / other;
    }
    product
}
