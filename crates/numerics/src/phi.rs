//! Exponential integrals phi_n, the building blocks of all exact responses.

use crate::phasor::{Phasor, abs, polar};

/// Returns exp(z).
pub fn exp(z: Phasor) -> Phasor {
    polar(libm::exp(z.re), z.im)
}

/// Returns phi_n(z) = sum z^k/(n + k)! = the integral of exp(z (1 - t)) t^(n-1)/(n-1)! from 0 to 1, for n >= 1.
pub fn phi(n: usize, z: Phasor) -> Phasor {
    if abs(z) < (n + 1) as f64 {
        // Each term is smaller than the previous one: little cancels.
        let mut term = Phasor::new((1..=n).fold(1.0, |product, k| product / k as f64), 0.0);
        let mut sum = term;
        let mut k = n;
        while abs(term) > 1e-18 * abs(sum) {
            k += 1;
            term = term * z / k as f64;
            sum += term;
        }
        return sum;
    }
    // Recurrence upwards from exp; with |z| > n errors do not grow.
    let mut factorial = 1.0;
    let mut value = exp(z);
    for k in 0..n {
        value = (value - 1.0 / factorial) / z;
        factorial *= (k + 1) as f64;
    }
    value
}

/// Returns exp(z) and phi_1 to phi_3, at the cost of one of them.
pub fn phi_1_to_3(z: Phasor) -> [Phasor; 4] {
    let whole = exp(z);
    if abs(z) < 4.0 {
        // The term 4^26/29! is below the last bit of 1/6, and so are all later ones.
        let third =
            (4..30).rev().fold(Phasor::new(1.0, 0.0), |sum, k| z * sum * (1.0 / f64::from(k)) + 1.0) / 6.0;
        let second = z * third + 0.5;
        return [whole, z * second + 1.0, second, third];
    }
    let inverse = z.conj() / z.norm_sqr();
    let first = (whole - 1.0) * inverse;
    let second = (first - 1.0) * inverse;
    [whole, first, second, (second - 0.5) * inverse]
}

/// Returns the integral of t^n exp(z t) from 0 to 1.
pub fn moment(n: usize, z: Phasor) -> Phasor {
    if abs(z) < (n + 2) as f64 {
        let factorial = (1..=n).fold(1.0, |product, k| product * k as f64);
        return exp(z) * phi(n + 1, -z) * factorial;
    }
    let end = exp(z);
    let first = (end - 1.0) / z;
    (1..=n).fold(first, |value, k| (end - value * k as f64) / z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phi_and_moments_meet_their_recurrences_and_known_values() {
        for (re, im) in [(0.0, 0.0), (1e-9, 1e-7), (-0.5, 1.5), (-3.0, 12.9), (0.0, 13.1), (-40.0, 300.0)] {
            let z = Phasor::new(re, im);
            let mut factorial = 1.0;
            for n in 1..13 {
                // Recurrence z phi_(n+1) = phi_n - 1/n!
                factorial *= f64::from(n);
                let n = n as usize;
                let gap = abs(z * phi(n + 1, z) - phi(n, z) + 1.0 / factorial);
                assert!(gap * factorial < 2e-14, "n {n}, z {z}: {gap:e}");
            }
            for (n, value) in phi_1_to_3(z).into_iter().enumerate() {
                let exact = if n == 0 { exp(z) } else { phi(n, z) };
                assert!(abs(value - exact) < 1e-15, "n {n}, z {z}: {value} {exact}");
            }
            for n in 0..3 {
                // Simpson's rule with steps of 1/8192.
                let f = |t: f64| exp(z * t) * (0..n).fold(1.0, |p, _| p * t);
                let m = 8192;
                let sum = (0..=m).fold(Phasor::default(), |sum, i| {
                    let weight = if i == 0 || i == m { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                    sum + f(f64::from(i) / f64::from(m)) * weight
                }) / (3.0 * f64::from(m));
                assert!(abs(sum - moment(n, z)) < 2e-8, "n {n}, z {z}");
            }
        }
        // Exact value 1 - (1 + 1)/e, the integral of t exp(-t).
        assert!((moment(1, Phasor::new(-1.0, 0.0)).re - (1.0 - 2.0 / std::f64::consts::E)).abs() < 1e-15);
    }
}
