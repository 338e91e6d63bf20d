//! The integral of |1 + z| while z runs on a circle about 0: its Fourier series, and Landen's substitution, which makes the
//! circle smaller.
//!
//! With z = k e^(i t) and 1 + z = p e^(i a), the angle b = t - a between z and 1 + z gives dt = p db/cos a, sin a = k sin b and
//! p = cos a + k cos b. Hence integrals over t are complete in b, and with the smaller modulus m = (1 - k')/(1 + k'),
//! k' = sqrt(1 - k²), on the circle z_2 = m e^(2 i b):
//!
//! ```text
//! int |1 + z| dt   = (int |1 + z_2| dt_2 - (1 - m)²/2 int dt_2/|1 + z_2|)/(1 + m) + 2 [Im u]
//! int dt/|1 + z|   = (1 + m)/2 int dt_2/|1 + z_2|
//! u = k e^(i b) = (z + k²)/|1 + z|,   z_2 = u² (1 + m)²/4,   dt_2 = 2 (dt - da)
//! ```
//!
//! All of it is algebraic at both ends, but for one arc tangent, of half the angle between the two 1 + z.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use super::trig::arc;
use crate::lanes::Real;

/// The series alone takes moduli below this.
pub const SMALL: f64 = 0.1;
/// Two steps of Landen's take moduli below this, three the next.
pub const MIDDLE: f64 = 0.9;
/// Beyond this three are not enough.
pub const LARGE: f64 = 0.998;

/// Powers of k² in a coefficient, and binomial coefficients in it.
const POWERS: usize = 6;
const BINOMIALS: usize = 20;
/// The power of k after which the series alone leaves all out, which is below 2e-14; so does that after steps of Landen's,
/// whose modulus is below 0.045.
const ALONE: usize = 10;
const AFTER: usize = 9;

/// The coefficients of Im z^n, n > 0, in the integral of |1 + z|^power over t, as powers of k²; for n = 0 those of t.
const fn fourier(power: f64) -> [[f64; POWERS]; ALONE + 1] {
    let mut binomial = [1.0; BINOMIALS];
    let mut k = 1;
    while k < BINOMIALS {
        binomial[k] = binomial[k - 1] * (0.5 * power - (k - 1) as f64) / k as f64;
        k += 1;
    }
    let mut of = [[0.0; POWERS]; ALONE + 1];
    let mut n = 0;
    while n < ALONE + 1 {
        let twice = if n == 0 { 1.0 } else { 2.0 / n as f64 };
        let mut k = 0;
        while k < POWERS {
            of[n][k] = twice * binomial[k] * binomial[k + n];
            k += 1;
        }
        n += 1;
    }
    of
}

const LENGTH: [[f64; POWERS]; ALONE + 1] = fourier(1.0);
const INVERSE: [[f64; POWERS]; ALONE + 1] = fourier(-1.0);

/// A loop that is written out.
macro_rules! each {
    ($n:ident in [$($value:literal),+] $body:block) => {
        $({
            const $n: usize = $value;
            $body
        })+
    };
}

/// A motion of z on a circle.
#[derive(Copy, Clone)]
pub struct Circle<R> {
    /// What |1 + z| is to be multiplied by.
    pub scale: R,
    /// The circle's radius k, at most 1.
    pub modulus: R,
    /// z at both ends.
    ends: [[R; 2]; 2],
    /// The angle between them, all turns counted (rad).
    angle: R,
    /// The weights of the integrals of |1 + z| and 1/|1 + z|, and what is known already.
    length: R,
    inverse: R,
    sum: R,
}

impl<R: Real> Circle<R> {
    /// The motion of c + W e^(-i t) over an angle (rad), by the centre c and W at both ends.
    #[inline(always)]
    pub fn new(centre: R, [from, to]: [[R; 2]; 2], angle: R) -> Self {
        let (zero, one) = (centre.of(0.0), centre.of(1.0));
        let square = from[0] * from[0] + from[1] * from[1];
        let (radius, distance) = (square.sqrt(), centre.abs());
        // |c + W| = |c| |1 + W*/c| = |W| |1 + c/W|.
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

    /// The same integral on a smaller circle. One that is not `WIDE` has a modulus below 0.4.
    #[inline(always)]
    #[must_use]
    pub fn landen<const WIDE: bool>(&self) -> Self {
        let k = self.modulus;
        let (one, two, half) = (k.of(1.0), k.of(2.0), k.of(0.5));
        let complement = ((one - k) * (one + k)).sqrt();
        let root = k / (one + complement);
        let modulus = root * root;
        let above = one + modulus;
        let (ratio, quarter) = (one / above, half * above);
        let turn = quarter * quarter;
        let [a, b] = self.ends;
        let (a_re, b_re) = (one + a[0], one + b[0]);
        let (a_abs, b_abs) = ((a_re * a_re + a[1] * a[1]).sqrt(), (b_re * b_re + b[1] * b[1]).sqrt());
        let both = one / (a_abs * b_abs);
        let (a_in, b_in) = (both * b_abs, both * a_abs);
        let square = k * k;
        let (a_u, b_u) = ([a_in * (a[0] + square), a_in * a[1]], [b_in * (b[0] + square), b_in * b[1]]);
        // Half the angle between both 1 + z; a fourth part of that, on a large circle.
        let (across, along) = (a_re * b[1] - b_re * a[1], a_abs * b_abs + (a_re * b_re + a[1] * b[1]));
        let square_across = across * across;
        let part = if WIDE {
            let along = along + (along * along + square_across).sqrt();
            let along = along + (along * along + square_across).sqrt();
            k.of(8.0) * arc(across / along)
        } else {
            two * arc(across / along)
        };
        let difference = one - modulus;
        Self {
            scale: self.scale,
            modulus,
            ends: [
                [turn * (a_u[0] * a_u[0] - a_u[1] * a_u[1]), two * turn * a_u[0] * a_u[1]],
                [turn * (b_u[0] * b_u[0] - b_u[1] * b_u[1]), two * turn * b_u[0] * b_u[1]],
            ],
            angle: two * (self.angle - part),
            length: self.length * ratio,
            inverse: self.inverse * quarter - half * difference * difference * (self.length * ratio),
            sum: self.sum + two * self.length * (b_u[1] - a_u[1]),
        }
    }

    /// One or the other, of the same motion.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        let mut one = *yes;
        one.modulus = R::select(mask, yes.modulus, no.modulus);
        for end in 0..2 {
            for part in 0..2 {
                one.ends[end][part] = R::select(mask, yes.ends[end][part], no.ends[end][part]);
            }
        }
        one.angle = R::select(mask, yes.angle, no.angle);
        one.length = R::select(mask, yes.length, no.length);
        one.inverse = R::select(mask, yes.inverse, no.inverse);
        one.sum = R::select(mask, yes.sum, no.sum);
        one
    }

    /// The integral over the angle, for a modulus below [`SMALL`], before any step.
    #[inline(always)]
    pub fn alone(&self) -> R {
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

    /// The integral over the angle, after enough steps.
    #[inline(always)]
    pub fn after(&self) -> R {
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

/// So many terms of a polynomial.
#[inline(always)]
fn polynomial<R: Real, const TERMS: usize>(coefficients: &[f64; POWERS], x: R) -> R {
    let mut sum = x.of(coefficients[TERMS - 1]);
    for k in (0..TERMS - 1).rev() {
        sum = x.of(coefficients[k]) + x * sum;
    }
    sum
}

/// The sum of b_n Im z^n, by Clenshaw's recurrence from the last term on.
#[derive(Copy, Clone)]
struct Clenshaw<R> {
    twice: R,
    imaginary: R,
    square: R,
    last: R,
    before: R,
}

impl<R: Real> Clenshaw<R> {
    #[inline(always)]
    fn new([re, im]: [R; 2], square: R) -> Self {
        let zero = re.of(0.0);
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
