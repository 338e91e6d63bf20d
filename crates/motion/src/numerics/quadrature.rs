//! Gauss-Legendre quadrature of functions that are smooth between breaks.

/// Nodes of a panel: exact to degree 31.
const NODES: usize = 16;

/// The integral of `f(middle, t)` over the pieces between these breaks, `middle` being a time inside the piece that t
/// belongs to. Panels are at most `panel` long; over a panel of four radians the integral is exact to rounding.
pub fn integral(breaks: &[f64], panel: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let rule = rule();
    let mut total = 0.0;
    for ends in breaks.windows(2) {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        let middle = from + 0.5 * length;
        let count = (length / panel).ceil().clamp(1.0, 1e5) as usize;
        let half = 0.5 * length / count as f64;
        for i in 0..count {
            let centre = from + half * (2 * i + 1) as f64;
            total += rule.iter().map(|(x, weight)| weight * f(middle, centre + half * x)).sum::<f64>() * half;
        }
    }
    total
}

/// Nodes and weights on [-1, 1]: the roots of the Legendre polynomial, by Newton's method.
fn rule() -> [(f64, f64); NODES] {
    std::array::from_fn(|i| {
        let n = NODES as f64;
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        for _ in 0..6 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=NODES {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_to_degree_31_and_four_radians_are_exact() {
        let power = |t: f64, n: i32| (0..n).fold(1.0, |p, _| p * t);
        assert!(
            (integral(&[0.0, 2.0], 9.0, |_, t| power(t, 31)) / (power(2.0, 32) / 32.0) - 1.0).abs() < 1e-13
        );
        let sine = integral(&[0.0, 1.0, 40.0], 4.0, |_, t| libm::sin(t));
        assert!((sine - (1.0 - libm::cos(40.0))).abs() < 1e-13);
    }
}
