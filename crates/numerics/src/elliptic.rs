//! Incomplete elliptic integral of the second kind, by Carlson's duplication (\[Carlson95\]).

use std::array::from_fn;
use std::f64::consts::PI;

/// Sine and cosine of pi/2 as a double.
const QUARTER: (f64, f64) = (1.0, 6.123_233_995_736_766e-17);

/// Returns E(to | m) - E(from | m), the integral of sqrt(1 - m sin² t) over from..to, for any real ends and m in [0,
/// 1].
///
/// The argument is the complement 1 - m, to keep accuracy near m = 1. The relative error of each E is about 1e-15.
pub fn second_kind(from: f64, to: f64, complement: f64) -> f64 {
    let (turns, rest) = half_turns(to);
    let (turns_before, rest_before) = half_turns(from);
    let (end, begin) = (libm::sincos(rest), libm::sincos(rest_before));
    if turns == 0.0 && turns_before == 0.0 {
        let [part, part_before] = principal([end, begin], complement);
        return part - part_before;
    }
    let [part, part_before, quarter] = principal([end, begin, QUARTER], complement);
    let whole = |turns: f64, part: f64| if turns == 0.0 { part } else { part + 2.0 * turns * quarter };
    whole(turns, part) - whole(turns_before, part_before)
}

/// Splits an angle into a multiple of pi and a rest in [-pi/2, pi/2].
fn half_turns(phi: f64) -> (f64, f64) {
    let turns = libm::round(phi / PI);
    (turns, phi - turns * PI)
}

/// Returns E for angles in [-pi/2, pi/2], given by sine and cosine.
fn principal<const N: usize>(angles: [(f64, f64); N], complement: f64) -> [f64; N] {
    let m = 1.0 - complement;
    let x = angles.map(|(_, cos)| cos * cos);
    let z = angles.map(|(sin, cos)| cos * cos + complement * (sin * sin));
    let carlson = carlson(Triples { x, y: [1.0; N], z, sum: [0.0; N], power: [1.0; N] });
    from_fn(|lane| {
        let ((sin, cos), (rf, rd)) = (angles[lane], carlson[lane]);
        // By DLMF 19.25.10: no two terms have different signs, so nothing cancels near m = 1.
        let s2 = sin * sin;
        sin * (complement * (rf + m * s2 * rd / 3.0) + m * cos / f64::sqrt(z[lane]))
    })
}

/// Returns Carlson's R_F and R_D of N triples at once: the processor computes the square roots and divisions of
/// several together.
///
/// The duplication theorem contracts the differences of the arguments by a factor 4 per round; a Taylor series
/// completes the result (\[Carlson95\]).
fn carlson<const N: usize>(mut triples: Triples<N>) -> [(f64, f64); N] {
    loop {
        let apart = triples.needs_duplication();
        if !apart.contains(&true) {
            return from_fn(|lane| triples.series(lane));
        }
        triples = triples.doubled(apart);
    }
}

/// Arguments of R_F and R_D during duplication; at most one of x, y is zero at the start.
#[derive(Copy, Clone)]
struct Triples<const N: usize> {
    x: [f64; N],
    y: [f64; N],
    z: [f64; N],
    /// Contribution of the rounds to R_D / 3, and the weight of the next round.
    sum: [f64; N],
    power: [f64; N],
}

impl<const N: usize> Triples<N> {
    fn mean(&self, lane: usize) -> f64 {
        (self.x[lane] + self.y[lane] + 3.0 * self.z[lane]) / 5.0
    }

    /// Returns which triples are too far apart for the series.
    fn needs_duplication(&self) -> [bool; N] {
        from_fn(|lane| {
            let mean = self.mean(lane);
            let [x, y, z] =
                [self.x[lane], self.y[lane], self.z[lane]].map(|argument| (mean - argument).abs());
            x.max(y).max(z) >= 0.002 * mean
        })
    }

    /// Returns the triples after one more duplication of the selected ones.
    #[expect(clippy::needless_range_loop, reason = "the compiler takes several at once")]
    fn doubled(&self, lanes_to_double: [bool; N]) -> Self {
        let mut next = *self;
        for lane in 0..N {
            let (x, y, z) = (self.x[lane], self.y[lane], self.z[lane]);
            let (rx, ry, rz) = (f64::sqrt(x), f64::sqrt(y), f64::sqrt(z));
            let lambda = rx * (ry + rz) + ry * rz;
            let sum = self.sum[lane] + self.power[lane] / (rz * (z + lambda));
            let choose = |new: f64, old: f64| if lanes_to_double[lane] { new } else { old };
            next.x[lane] = choose(0.25 * (x + lambda), x);
            next.y[lane] = choose(0.25 * (y + lambda), y);
            next.z[lane] = choose(0.25 * (z + lambda), z);
            next.sum[lane] = choose(sum, self.sum[lane]);
            next.power[lane] = choose(0.25 * self.power[lane], self.power[lane]);
        }
        next
    }

    fn series(&self, lane: usize) -> (f64, f64) {
        let (x, y, z) = (self.x[lane], self.y[lane], self.z[lane]);
        let rd = 3.0 * self.sum[lane] + self.power[lane] * rd_series(x, y, z, self.mean(lane));
        (rf_series(x, y, z), rd)
    }
}

fn rf_series(x: f64, y: f64, z: f64) -> f64 {
    let mean = (x + y + z) / 3.0;
    let (dx, dy) = ((mean - x) / mean, (mean - y) / mean);
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
    series / f64::sqrt(mean)
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
    series / (mean * f64::sqrt(mean))
}

#[cfg(test)]
#[allow(clippy::excessive_precision)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Values `ellipe(phi, m)` with m = 1 - complement, by mpmath 1.3 with 30 digits.
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
            let value = second_kind(0.0, phi, complement);
            assert!((value - exact).abs() <= 4e-15 * exact.abs(), "E({phi}): {value} {exact}");
            assert_eq!(second_kind(phi, 0.0, complement), -value);
        }
    }
}
