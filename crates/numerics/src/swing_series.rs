//! Integral of |1 + z| while z moves on a circle about 0: its Fourier series, and Landen's transformation, which
//! reduces the circle.
//!
//! With z = k e^(i t) and 1 + z = p e^(i a), the angle b = t - a between z and 1 + z gives dt = p db/cos a, sin a = k
//! sin b and p = cos a + k cos b. Hence integrals over t are complete in b, and with the smaller modulus m = (1 -
//! k')/(1 + k'), k' = sqrt(1 - k²), on the circle z_2 = m e^(2 i b):
//!
//! ```text
//! int |1 + z| dt   = (int |1 + z_2| dt_2 - (1 - m)²/2 int dt_2/|1 + z_2|)/(1 + m) + 2 [Im u]
//! int dt/|1 + z|   = (1 + m)/2 int dt_2/|1 + z_2|
//! u = k e^(i b) = (z + k²)/|1 + z|,   z_2 = u² (1 + m)²/4,   dt_2 = 2 (dt - da)
//! ```
//!
//! All terms are algebraic at both ends, except for the angle between the two values of 1 + z. With the other
//! modulus, 1 + m = 2/(1 + k'), the next k' is 2 sqrt(k')/(1 + k') and |1 + z_2| = (|1 + z| + k'^2/|1 + z|)/(1 + k'):
//! a second step needs one root, and one arc tangent suffices for the angles of both.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use super::trig::argument;
use crate::lanes::LaneFloat;

/// Modulus below which the series suffices without Landen steps.
pub const SMALL: f64 = 0.1;
/// Modulus below which two Landen steps suffice; three suffice up to the next limit.
pub const MIDDLE: f64 = 0.9;
/// Modulus beyond which three Landen steps do not suffice.
pub const LARGE: f64 = 0.998;

/// Number of powers of k² in a coefficient, and of binomial coefficients.
const POWERS: usize = 6;
const BINOMIALS: usize = 20;
/// Largest power of k in the series alone, and in the series after Landen steps (modulus below 0.045); the truncation
/// error is below 2e-14.
const ALONE: usize = 10;
const AFTER: usize = 9;

/// Returns the coefficients of Im z^n, n > 0, in the integral of |1 + z|^power over t, as powers of k²; for n = 0
/// those of t.
const fn fourier(power: f64) -> [[f64; POWERS]; ALONE + 1] {
    let mut binomial = [1.0; BINOMIALS];
    let mut k = 1;
    while k < BINOMIALS {
        binomial[k] = binomial[k - 1] * (0.5 * power - (k - 1) as f64) / k as f64;
        k += 1;
    }
    let mut coefficients = [[0.0; POWERS]; ALONE + 1];
    let mut n = 0;
    while n < ALONE + 1 {
        let twice = if n == 0 { 1.0 } else { 2.0 / n as f64 };
        let mut k = 0;
        while k < POWERS {
            coefficients[n][k] = twice * binomial[k] * binomial[k + n];
            k += 1;
        }
        n += 1;
    }
    coefficients
}

const LENGTH: [[f64; POWERS]; ALONE + 1] = fourier(1.0);
const INVERSE: [[f64; POWERS]; ALONE + 1] = fourier(-1.0);

/// Unrolls a loop over literal values.
macro_rules! each {
    ($n:ident in [$($value:literal),+] $body:block) => {
        $({
            const $n: usize = $value;
            $body
        })+
    };
}

/// Motion of z on a circle, with the integral along it.
#[derive(Copy, Clone)]
pub struct Circle<R> {
    /// Factor by which |1 + z| is multiplied.
    pub scale: R,
    /// Radius k of the circle, at most 1.
    pub modulus: R,
    /// Values of z at both ends.
    ends: [[R; 2]; 2],
    /// Angle between the ends, full turns included (rad).
    angle: R,
    /// Weights of the integrals of |1 + z| and 1/|1 + z|, and the part of the result that is already known.
    length: R,
    inverse: R,
    sum: R,
}

impl<R: LaneFloat> Circle<R> {
    /// Creates the motion of c + W e^(-i t) over an angle (rad), from the centre c and W at both ends.
    #[inline(always)]
    pub fn new(centre: R, [from, to]: [[R; 2]; 2], angle: R) -> Self {
        let (zero, one) = (centre.splat(0.0), centre.splat(1.0));
        let square = from[0] * from[0] + from[1] * from[1];
        let (radius, distance) = (square.sqrt(), centre.abs());
        // Uses |c + W| = |c| |1 + W*/c| = |W| |1 + c/W|.
        let outside = radius.lt(distance);
        let below = R::select(outside, centre, square);
        let factor = R::select(outside, one, centre) / R::select(below.abs().le(zero), one, below);
        Self {
            scale: R::select(outside, distance, radius),
            modulus: radius * factor.abs(),
            ends: [[factor * from[0], -factor * from[1]], [factor * to[0], -factor * to[1]]],
            angle,
            length: one,
            inverse: zero,
            sum: zero,
        }
    }

    /// Transforms the integral to a smaller circle by one Landen step, for a modulus near 1.
    #[inline(always)]
    #[must_use]
    pub fn landen_step(&self) -> Self {
        let (step, mut smaller) = self.step(self.complement(), self.sizes());
        smaller.angle = (self.angle - argument(step.between)) * 2.0;
        smaller
    }

    /// Transforms the integral by two Landen steps, for a modulus below [`MIDDLE`]; the new modulus is below 0.042.
    #[inline(always)]
    #[must_use]
    pub fn two_landen_steps(&self) -> Self {
        let (complement, sizes) = (self.complement(), self.sizes());
        let (first, once) = self.step(complement, sizes);
        // For the smaller circle, complement and sizes follow without a root of values that depend on the ends.
        let square = complement * complement;
        let next = complement.sqrt() * first.inverse * 2.0;
        let [a, b] = first.sizes_inverse;
        let sizes = [first.inverse * (sizes[0] + square * a), first.inverse * (sizes[1] + square * b)];
        let (second, mut twice) = once.step(next, sizes);
        // Both angles in one arc tangent: that of the first step, and half that of the second.
        let ([re, im], [along, across]) = (first.between, second.between);
        let along = sizes[0] * sizes[1] + along;
        let part = argument([re * along - im * across, re * across + im * along]);
        twice.angle = (self.angle - part) * 4.0;
        twice
    }

    /// Returns k' of the modulus.
    #[inline(always)]
    fn complement(&self) -> R {
        let one = self.modulus.splat(1.0);
        ((one - self.modulus) * (one + self.modulus)).sqrt()
    }

    /// Returns |1 + z| at both ends.
    #[inline(always)]
    fn sizes(&self) -> [R; 2] {
        let [a, b] = self.ends;
        let (a_re, b_re) = (a[0] + 1.0, b[0] + 1.0);
        [(a_re * a_re + a[1] * a[1]).sqrt(), (b_re * b_re + b[1] * b[1]).sqrt()]
    }

    /// Performs a Landen step, given k' and |1 + z| at both ends; sets all of the new circle but its angle.
    #[inline(always)]
    fn step(&self, complement: R, sizes: [R; 2]) -> (LandenStep<R>, Self) {
        let step = LandenStep::new(self, complement, sizes);
        // The new modulus (1 - k')/(1 + k') is the square of this.
        let root = self.modulus * step.inverse;
        let smaller = Self {
            scale: self.scale,
            modulus: root * root,
            ends: step.ends,
            angle: self.angle,
            length: self.length * ((complement.splat(1.0) + complement) * 0.5),
            inverse: step.inverse * (self.inverse - self.length * (complement * complement)),
            sum: self.sum + self.length * step.rise * 2.0,
        };
        (step, smaller)
    }

    /// Selects one of two circles with the same scale, per lane.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, chosen: &Self, otherwise: &Self) -> Self {
        let mut one = *chosen;
        one.modulus = R::select(mask, chosen.modulus, otherwise.modulus);
        for end in 0..2 {
            for part in 0..2 {
                one.ends[end][part] = R::select(mask, chosen.ends[end][part], otherwise.ends[end][part]);
            }
        }
        one.angle = R::select(mask, chosen.angle, otherwise.angle);
        one.length = R::select(mask, chosen.length, otherwise.length);
        one.inverse = R::select(mask, chosen.inverse, otherwise.inverse);
        one.sum = R::select(mask, chosen.sum, otherwise.sum);
        one
    }

    /// Returns the integral over the angle by the series alone, for a modulus below [`SMALL`].
    #[inline(always)]
    pub fn integrate_small(&self) -> R {
        let square = self.modulus * self.modulus;
        let mut sums = [Clenshaw::new(self.ends[0], square), Clenshaw::new(self.ends[1], square)];
        each!(N in [10, 9, 8, 7, 6, 5, 4, 3, 2, 1] {
            let b = polynomial::<R, { (ALONE - N) / 2 + 1 }>(&LENGTH[N], square);
            sums[0].add(b);
            sums[1].add(b);
        });
        let mean = polynomial::<R, { ALONE / 2 + 1 }>(&LENGTH[0], square);
        self.scale * (mean * self.angle + (sums[1].sum() - sums[0].sum()))
    }

    /// Returns the integral over the angle by the series after Landen steps.
    #[inline(always)]
    pub fn integrate_after(&self) -> R {
        let square = self.modulus * self.modulus;
        let mut sums = [Clenshaw::new(self.ends[0], square), Clenshaw::new(self.ends[1], square)];
        each!(N in [8, 7, 6, 5, 4, 3, 2, 1] {
            let length = polynomial::<R, { (AFTER - N) / 2 + 1 }>(&LENGTH[N], square);
            let inverse = polynomial::<R, { (AFTER - N) / 2 + 1 }>(&INVERSE[N], square);
            let b = self.length * length + self.inverse * inverse;
            sums[0].add(b);
            sums[1].add(b);
        });
        let length = polynomial::<R, { AFTER / 2 + 1 }>(&LENGTH[0], square);
        let inverse = polynomial::<R, { AFTER / 2 + 1 }>(&INVERSE[0], square);
        let mean = self.length * length + self.inverse * inverse;
        self.scale * (self.sum + mean * self.angle + (sums[1].sum() - sums[0].sum()))
    }
}

/// Result of a Landen step at both ends.
struct LandenStep<R> {
    /// Factor 1/(1 + k').
    inverse: R,
    /// Values of 1/|1 + z| at both ends.
    sizes_inverse: [R; 2],
    /// Values of z_2 at both ends.
    ends: [[R; 2]; 2],
    /// Increase of Im u from the first to the second end.
    rise: R,
    /// Complex number whose argument is the angle between both values of 1 + z.
    between: [R; 2],
}

impl<R: LaneFloat> LandenStep<R> {
    /// Computes the step of a circle from k' and |1 + z| at both ends.
    #[inline(always)]
    fn new(circle: &Circle<R>, complement: R, [a_size, b_size]: [R; 2]) -> Self {
        let square = circle.modulus * circle.modulus;
        let [a, b] = circle.ends;
        // One division serves all three.
        let (above, sizes) = (complement + 1.0, a_size * b_size);
        let all = square.splat(1.0) / (above * sizes);
        let (inverse, both) = (all * sizes, all * above);
        let sizes_inverse = [both * b_size, both * a_size];
        let a_u = [sizes_inverse[0] * (a[0] + square), sizes_inverse[0] * a[1]];
        let b_u = [sizes_inverse[1] * (b[0] + square), sizes_inverse[1] * b[1]];
        let (a_v, b_v) = ([inverse * a_u[0], inverse * a_u[1]], [inverse * b_u[0], inverse * b_u[1]]);
        let (a_re, b_re) = (a[0] + 1.0, b[0] + 1.0);
        Self {
            inverse,
            sizes_inverse,
            ends: [
                [a_v[0] * a_v[0] - a_v[1] * a_v[1], a_v[0] * a_v[1] * 2.0],
                [b_v[0] * b_v[0] - b_v[1] * b_v[1], b_v[0] * b_v[1] * 2.0],
            ],
            rise: b_u[1] - a_u[1],
            between: [a_re * b_re + a[1] * b[1], a_re * b[1] - b_re * a[1]],
        }
    }
}

/// Evaluates the first `TERMS` terms of a polynomial.
#[inline(always)]
fn polynomial<R: LaneFloat, const TERMS: usize>(coefficients: &[f64; POWERS], x: R) -> R {
    let mut sum = x.splat(coefficients[TERMS - 1]);
    for k in (0..TERMS - 1).rev() {
        sum = x.splat(coefficients[k]) + x * sum;
    }
    sum
}

/// Sum of b_n Im z^n, by Clenshaw's recurrence from the last term on.
#[derive(Copy, Clone)]
struct Clenshaw<R> {
    twice: R,
    imaginary: R,
    square: R,
    last: R,
    before: R,
}

impl<R: LaneFloat> Clenshaw<R> {
    #[inline(always)]
    fn new([re, im]: [R; 2], square: R) -> Self {
        let zero = re.splat(0.0);
        Self { twice: re + re, imaginary: im, square, last: zero, before: zero }
    }

    #[inline(always)]
    fn add(&mut self, b: R) {
        let next = (b - self.square * self.before) + self.twice * self.last;
        (self.before, self.last) = (self.last, next);
    }

    #[inline(always)]
    fn sum(&self) -> R {
        self.imaginary * self.last
    }
}
