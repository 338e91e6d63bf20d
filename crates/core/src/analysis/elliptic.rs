//! The incomplete elliptic integral of the second kind, by Carlson's duplication.

use std::f64::consts::{FRAC_PI_2, PI};

/// E(phi | m), the integral of sqrt(1 - m sin² t) over 0..phi, for any real `phi` and m in [0, 1].
///
/// Takes the complement 1 - m, so that nothing is lost near m = 1. Relative error about 1e-15.
pub fn second_kind(phi: f64, complement: f64) -> f64 {
    let turns = libm::round(phi / PI);
    let rest = phi - turns * PI;
    let part = principal(rest, complement);
    if turns == 0.0 { part } else { part + 2.0 * turns * principal(FRAC_PI_2, complement) }
}

/// The same for phi in [-pi/2, pi/2].
fn principal(phi: f64, complement: f64) -> f64 {
    let (sin, cos) = libm::sincos(phi);
    let m = 1.0 - complement;
    let (c2, s2) = (cos * cos, sin * sin);
    let y = c2 + complement * s2;
    let (rf, rd) = carlson(c2, 1.0, y);
    // DLMF 19.25.10: no two terms of different sign, so nothing cancels near m = 1.
    sin * (complement * (rf + m * s2 * rd / 3.0) + m * cos / libm::sqrt(y))
}

/// Carlson's R_F and R_D of the same arguments. At most one of x, y is zero.
///
/// The duplication theorem brings the arguments together by a factor 4 a round; what is left is a Taylor
/// series (B. C. Carlson, Numerical computation of real or complex elliptic integrals, 1995).
fn carlson(mut x: f64, mut y: f64, mut z: f64) -> (f64, f64) {
    let mut sum = 0.0;
    let mut power = 1.0;
    loop {
        let (rx, ry, rz) = (libm::sqrt(x), libm::sqrt(y), libm::sqrt(z));
        let lambda = rx * (ry + rz) + ry * rz;
        let mean = (x + y + 3.0 * z) / 5.0;
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        if spread < 0.002 * mean {
            return (rf_series(x, y, z), 3.0 * sum + power * rd_series(x, y, z, mean));
        }
        sum += power / (rz * (z + lambda));
        power *= 0.25;
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
    }
}

fn rf_series(x: f64, y: f64, z: f64) -> f64 {
    let mean = (x + y + z) / 3.0;
    let (dx, dy) = ((mean - x) / mean, (mean - y) / mean);
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
    series / libm::sqrt(mean)
}

fn rd_series(x: f64, y: f64, z: f64, mean: f64) -> f64 {
    let (dx, dy, dz) = ((mean - x) / mean, (mean - y) / mean, (mean - z) / mean);
    let ea = dx * dy;
    let eb = dz * dz;
    let e2 = ea - 6.0 * eb;
    let e3 = (3.0 * ea - 8.0 * eb) * dz;
    let e4 = 3.0 * (ea - eb) * eb;
    let e5 = ea * eb * dz;
    let series =
        1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
            + 3.0 * e5 / 26.0;
    series / (mean * libm::sqrt(mean))
}

#[cfg(test)]
#[allow(clippy::excessive_precision)]
mod tests {
    use super::*;

    /// mpmath 1.3, 30 digits: `ellipe(phi, m)` with m = 1 - complement.
    const ORACLE: [(f64, f64, f64); 8] = [
        (0.3, 0.5, 0.297_775_371_953_160_21),
        (1.2, 0.9, 1.178_119_934_598_459_41),
        (-1.5, 0.01, -1.008_366_245_703_958_26),
        (FRAC_PI_2, 1e-12, 1.000_000_000_007_350_9),
        (7.0, 0.3, 5.642_682_813_850_744_22),
        (-40.0, 1e-6, -25.254_988_053_818_972_3),
        (2.0, 0.0, 1.090_702_573_174_318_3),
        (2.0, 1.0, 2.0),
    ];

    #[test]
    fn agrees_with_mpmath() {
        for (phi, complement, exact) in ORACLE {
            let value = second_kind(phi, complement);
            assert!((value - exact).abs() <= 4e-15 * exact.abs(), "E({phi}): {value} {exact}");
        }
    }
}
