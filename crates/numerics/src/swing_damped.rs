//! Integral over time of a damped mode's envelope under a constant torque, by quadrature, for single numbers and SIMD
//! lanes.
//!
//! The mode's phasor is Z(h) = c + W exp(-(s + i w) h), and the integrand abs(Z). Its singularities are the zeros of
//! Z, at a distance of |ln |W/c|| radians from the real axis: the more |W| and |c| differ, the longer the panels.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]
#![allow(clippy::excessive_precision, reason = "more digits than a double has")]

use super::exp_branch_free::exp;
use super::trig::{nearest, sincos};
use crate::lanes::{LaneFloat, Mask};

/// Number of pairs of nodes.
const PAIRS: usize = 6;
/// Positive abscissae and weights of the 12-point Gauss-Legendre rule on [-1, 1].
const NODES: [(f64, f64); PAIRS] = [
    (0.125_233_408_511_468_915, 0.249_147_045_813_402_785),
    (0.367_831_498_998_180_194, 0.233_492_536_538_354_809),
    (0.587_317_954_286_617_447, 0.203_167_426_723_065_922),
    (0.769_902_674_194_304_687, 0.160_078_328_543_346_226),
    (0.904_117_256_370_474_857, 0.106_939_325_995_318_431),
    (0.981_560_634_246_719_251, 0.047_175_336_386_511_827_2),
];
/// Length of a panel (rad) per radian of the zeros' distance from the real axis.
const RATIO: f64 = 2.0;
/// Lengths of the shortest and longest panel (rad).
const SHORTEST: f64 = 0.4;
const LONGEST: f64 = 6.0;
/// Largest number of panels.
const MOST: f64 = 1e6;

/// Number of terms of the arc tangent series, with an error of 0.04^9/19.
const ARC: usize = 9;
/// Lagrange polynomials of x² that are 1 at one abscissa and 0 at the others.
const LAGRANGE: [[f64; PAIRS]; PAIRS] = lagrange();

const fn lagrange() -> [[f64; PAIRS]; PAIRS] {
    let mut coefficients = [[0.0; PAIRS]; PAIRS];
    let mut j = 0;
    while j < PAIRS {
        let abscissa = NODES[j].0 * NODES[j].0;
        let (mut polynomial, mut m) = ([0.0; PAIRS], 0);
        polynomial[0] = 1.0;
        while m < PAIRS {
            if m != j {
                let root = NODES[m].0 * NODES[m].0;
                let mut k = PAIRS - 1;
                while k > 0 {
                    polynomial[k] = (polynomial[k - 1] - root * polynomial[k]) / (abscissa - root);
                    k -= 1;
                }
                polynomial[0] = -root * polynomial[0] / (abscissa - root);
            }
            m += 1;
        }
        coefficients[j] = polynomial;
        j += 1;
    }
    coefficients
}

/// Returns the integral over [0, h] of abs(c + W exp(-(s + i w) t)), from c and from W at both ends.
///
/// Composite Gauss-Legendre, 12 nodes in panels of 0.4 to 6 radians. In a panel near a zero of Z the factor of that
/// zero is integrated with its moments in closed form. The error is 3e-12 of h times the larger of |c| and |W|.
#[inline(always)]
pub fn damped<R: LaneFloat>(centre: [R; 2], [from, to]: [[R; 2]; 2], decay: R, frequency: R, h: R) -> R {
    let (zero, one) = (h.splat(0.0), h.splat(1.0));
    let radians = radians(centre, [from, to]);
    let panels = (frequency + decay) * h / radians;
    let near = nearest(panels);
    let count = R::select(near.lt(panels), near + one, near).max(one).min(h.splat(MOST));
    let half = h.splat(0.5) * h / count;
    let (mut after, mut before) = ([[zero; 2]; PAIRS], [[zero; 2]; PAIRS]);
    for pair in 0..PAIRS {
        let t = half * NODES[pair].0;
        let ((sin, cos), decay_factor) = (sincos(frequency * t), exp(-(decay * t)));
        let more = one / decay_factor;
        after[pair] = [decay_factor * cos, -(decay_factor * sin)];
        before[pair] = [more * cos, more * sin];
    }
    let ((sin, cos), decay_factor) = (sincos(frequency * half), exp(-(decay * half)));
    let middle = [decay_factor * cos, -(decay_factor * sin)];
    let across = times(middle, middle);
    let mut deviation = times(from, middle);
    let rate = [decay * half, frequency * half];
    let short = radians.le(zero + SHORTEST);
    let (mut sum, mut panel) = (zero, zero);
    loop {
        let continuing = panel.lt(count);
        if !continuing.any() {
            break;
        }
        let mut sizes = [[zero; 2]; PAIRS];
        let mut part = zero;
        for pair in 0..PAIRS {
            let earlier = size(centre, times(deviation, before[pair]));
            let later = size(centre, times(deviation, after[pair]));
            sizes[pair] = [earlier, later];
            part = part + (earlier + later) * NODES[pair].1;
        }
        if short.any() {
            let (root, near) = root(centre, deviation, rate);
            let near = short & near;
            if near.any() {
                part = R::select(near, end_integral(root, &sizes), part);
            }
        }
        sum = sum + R::select(continuing, part, zero);
        deviation = times(deviation, across);
        panel = panel + one;
    }
    sum * half
}

/// Returns the zero of c + W exp(-L x), and the lanes in which it is close enough to the panel from -1 to 1 to be
/// treated separately.
#[inline(always)]
fn root<R: LaneFloat>(centre: [R; 2], deviation: [R; 2], rate: [R; 2]) -> ([R; 2], R::Mask) {
    let one = rate[0].splat(1.0);
    // By L x = ln(-W/c) = 2 artanh((W + c)/(W - c)).
    let below = [deviation[0] - centre[0], deviation[1] - centre[1]];
    let u = over([deviation[0] + centre[0], deviation[1] + centre[1]], below);
    let z = times(u, u);
    let mut series = [one * (1.0 / (2 * ARC + 1) as f64), one * 0.0];
    for n in (0..ARC).rev() {
        let [re, im] = times(series, z);
        series = [re + 1.0 / (2 * n + 1) as f64, im];
    }
    let [re, im] = over(times(u, series), rate);
    let root = [re + re, im + im];
    (root, square(u).le(one * 0.05) & square(root).le(one * 4.0))
}

/// Returns the integral from -1 to 1 of a function with the given values at the nodes, and a zero with its conjugate.
///
/// Without the factor |x - zero| the function is a polynomial of degree 11, to rounding. The moments M_k = int x^k S
/// dx with S = |x - zero|, zero = a + i b, follow from the derivative of x^(k-1) S³: (k + 2) M_k = [x^(k-1) S³] + (2
/// k + 1) a M_(k-1) - (k - 1) (a² + b²) M_(k-2).
#[inline(always)]
fn end_integral<R: LaneFloat>([a, b]: [R; 2], sizes: &[[R; 2]; PAIRS]) -> R {
    let (zero, half) = (a.splat(0.0), a.splat(0.5));
    let b = b * b + 1e-60;
    let (mut even, mut odd) = ([zero; PAIRS], [zero; PAIRS]);
    for pair in 0..PAIRS {
        let x = a.splat(NODES[pair].0);
        let (before_shift, after_shift) = (x + a, x - a);
        let earlier = sizes[pair][0] / (before_shift * before_shift + b).sqrt();
        let later = sizes[pair][1] / (after_shift * after_shift + b).sqrt();
        let (sum, difference) = (half * (later + earlier), half * (later - earlier) / x);
        for k in 0..PAIRS {
            even[k] = even[k] + sum * LAGRANGE[pair][k];
            odd[k] = odd[k] + difference * LAGRANGE[pair][k];
        }
    }
    // Positions of the ends relative to the zero.
    let (before, after) = (-a - 1.0, -a + 1.0);
    let (first, last) = ((before * before + b).sqrt(), (after * after + b).sqrt());
    let reach = |x: R, size: R| R::select(zero.lt(x), x + size, b / (size - x));
    let angle = logarithm(reach(after, last) / reach(before, first));
    let (low, high) = (first * first * first, last * last * last);
    let (up, across, square) = (high + low, high - low, a * a + b);
    let mut previous = half * (after * last - before * first + b * angle);
    let mut moment = across * (1.0 / 3.0) + a * previous;
    let mut sum = previous * even[0] + moment * odd[0];
    for k in 2..2 * PAIRS {
        let n = k as f64;
        let ends = if k % 2 == 0 { up } else { across };
        let next = (ends + a * moment * (2.0 * n + 1.0) - square * previous * (n - 1.0)) * (1.0 / (n + 2.0));
        (previous, moment) = (moment, next);
        sum = sum + moment * if k % 2 == 0 { even[k / 2] } else { odd[k / 2] };
    }
    sum
}

/// Returns the natural logarithm, lane by lane.
#[inline(always)]
fn logarithm<R: LaneFloat>(x: R) -> R {
    let mut all = [1.0; 16];
    x.store(&mut all);
    for lane in 0..R::LANES {
        all[lane] = libm::log(all[lane]);
    }
    x.load(&all)
}

/// Returns the length of the panels (rad).
#[inline(always)]
fn radians<R: LaneFloat>(centre: [R; 2], [from, to]: [[R; 2]; 2]) -> R {
    let (zero, one) = (from[0].splat(0.0), from[0].splat(1.0));
    let (c, first, last) = (square(centre), square(from), square(to));
    // Squares of the larger and smaller of |c| and |W| where they are nearest to each other; equal if one passes the
    // other.
    let (inside, outside) = (first.lt(c), c.lt(last));
    let large = R::select(inside, c, R::select(outside, last, one));
    let small = R::select(inside, first, R::select(outside, c, one));
    let ratio = (small / R::select(zero.lt(large), large, one)).sqrt();
    // Lower bound of -ln(ratio), the beginning of a series of positive terms.
    let part = (one - ratio) / (one + ratio);
    let z = part * part;
    let distance = (part + part) * (one + z * (z.splat(1.0 / 3.0) + z * 0.2));
    (distance * RATIO).max(one * SHORTEST).min(one * LONGEST)
}

#[inline(always)]
fn times<R: LaneFloat>([a, b]: [R; 2], [c, d]: [R; 2]) -> [R; 2] {
    [a * c - b * d, a * d + b * c]
}

#[inline(always)]
fn over<R: LaneFloat>(above: [R; 2], [re, im]: [R; 2]) -> [R; 2] {
    let inverse = re.splat(1.0) / square([re, im]);
    times(above, [inverse * re, -(inverse * im)])
}

#[inline(always)]
fn square<R: LaneFloat>([re, im]: [R; 2]) -> R {
    re * re + im * im
}

/// Returns the absolute value of a sum.
#[inline(always)]
fn size<R: LaneFloat>([a, b]: [R; 2], [c, d]: [R; 2]) -> R {
    square([a + c, b + d]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference values by `tests/golden/swing_damped_oracle.py`.
    const ORACLE: &str = include_str!("../../../tests/golden/swing_damped.csv");

    /// Returns the deviation after the time `t`.
    fn later([re, im]: [f64; 2], decay: f64, frequency: f64, t: f64) -> [f64; 2] {
        let ((sin, cos), decay_factor) = (libm::sincos(frequency * t), libm::exp(-decay * t));
        times([re, im], [decay_factor * cos, -decay_factor * sin])
    }

    fn over(centre: [f64; 2], from: [f64; 2], decay: f64, frequency: f64, h: f64) -> f64 {
        damped(centre, [from, later(from, decay, frequency, h)], decay, frequency, h)
    }

    #[test]
    fn integrals_agree_with_quadrature_in_many_digits() {
        let mut count = 0;
        for row in ORACLE.lines().skip(1) {
            let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let [re, im, x, y, decay, frequency, h, exact] = numbers[..] else { panic!("{row}") };
            let value = over([re, im], [x, y], decay, frequency, h);
            let large = square([re, im]).max(square([x, y])).sqrt();
            assert!((value - exact).abs() < 5e-13 * large * h, "{row}: {value}");
            count += 1;
        }
        assert!(count > 100, "{count}");
        let value = over([1.0, 0.05], [0.5, 0.2], 0.02, 0.44, 37.0);
        assert!((value - 38.726_802_273_600_3).abs() < 1e-12 * value, "{value}");
        assert_eq!(over([0.0; 2], [0.0; 2], 0.1, 2.0, 5.0), 0.0);
    }

    #[test]
    fn many_pieces_make_the_whole() {
        for c in [0.01, 0.3, 0.7, 0.755, 0.7615, 0.77, -1.5] {
            for decay in [1e-3, 0.05] {
                let (centre, from) = ([c, 0.1 * c], [0.3, -0.7]);
                let piece =
                    |i: i32| over(centre, later(from, decay, 1.44, 0.01 * f64::from(i)), decay, 1.44, 0.01);
                let (sum, whole) = ((0..2000).map(piece).sum::<f64>(), over(centre, from, decay, 1.44, 20.0));
                assert!((sum - whole).abs() < 1e-12 * whole, "{c} {decay}: {sum} {whole}");
            }
        }
    }
}
