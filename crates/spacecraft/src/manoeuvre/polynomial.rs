//! Commands whose angle is a smooth polynomial of odd degree.

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};

use super::task::RestToRestTask;

/// Degrees that the angle may have.
pub const DEGREES: [u32; 6] = [3, 5, 7, 9, 11, 13];

/// Plans the command: with m = (degree - 1)/2, x = t/T, P the impulse and E the excess travel over that of the mean
/// command,
///
/// u = (x (1 - x))^(m-1) [ (2m-1)!/(m-1)!² P/T + (2m+1)!/m!² m (1 - 2x) E/T² ],
///
/// so that the second to (m-1)th derivatives of the angle vanish at both ends.
pub fn plan(task: &RestToRestTask, degree: u32) -> Waveform {
    let m = ((degree - 1) / 2) as usize;
    let t = task.time;
    let factorial = |n: usize| (1..=n).fold(1.0, |product, k| product * k as f64);
    let square = |v: f64| v * v;
    let constant = factorial(2 * m - 1) / square(factorial(m - 1)) * task.impulse / t;
    let slope = factorial(2 * m + 1) / square(factorial(m)) * m as f64 * task.excess_travel() / (t * t);
    // Coefficients of (1 - x)^(m-1) times constant + slope (1 - 2x), shifted by x^(m-1), each power over T.
    let mut coefficients = vec![0.0; 2 * m];
    let mut binomial = 1.0;
    for k in 0..m {
        coefficients[m - 1 + k] += binomial * (constant + slope);
        coefficients[m + k] -= binomial * 2.0 * slope;
        binomial *= -((m - 1 - k) as f64) / (k + 1) as f64;
    }
    let mut scale = 1.0;
    for c in &mut coefficients {
        *c *= scale;
        scale /= t;
    }
    Waveform { terms: vec![Term { from: 0.0, to: t, shape: TermShape::Polynomial(coefficients) }] }
}
