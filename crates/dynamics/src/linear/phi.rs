//! Exponential of a pole and its integrals: e^z, h phi_1(z), h² phi_2(z) with z = lambda h.
//!
//! phi_1(z) = (e^z - 1)/z and phi_2(z) = (phi_1(z) - 1)/z. Below |z| = 1 they are computed by a series, to avoid
//! cancellation.

use flexsc_numerics::phasor::{Phasor, abs};

/// Pole lambda (1/s) with its reciprocal, which is 0 for a pole at 0.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Pole {
    pub lambda: Phasor,
    pub inverse: Phasor,
    /// Absolute value |lambda| (1/s).
    pub size: f64,
}

/// Values of e^z, h phi_1(z) and h² phi_2(z).
#[derive(Copy, Clone, Debug)]
pub struct Phi {
    pub exp: Phasor,
    pub first: Phasor,
    pub second: Phasor,
}

impl Pole {
    pub fn new(lambda: Phasor) -> Self {
        let size = abs(lambda);
        let inverse = if size > 0.0 { lambda.conj() / (size * size) } else { Phasor::default() };
        Self { lambda, inverse, size }
    }

    /// Returns the functions at the time `h` (s).
    #[inline]
    pub fn phi(&self, h: f64) -> Phi {
        if self.size * h < 1.0 {
            return self.series(h);
        }
        let exp = exponential(self.lambda * h);
        let first = (exp - 1.0) * self.inverse;
        Phi { exp, first, second: (first - h) * self.inverse }
    }

    fn series(&self, h: f64) -> Phi {
        let (z, size) = (self.lambda * h, self.size * h);
        // The first omitted term is below the last bit of the sum.
        let terms = if size < 0.02 {
            8
        } else if size < 0.2 {
            11
        } else {
            18
        };
        let mut sum = Phasor { re: 1.0, im: 0.0 };
        for n in (3..=terms + 1).rev() {
            sum = z * sum * RECIPROCALS[n] + 1.0;
        }
        let second = sum * 0.5;
        let first = z * second + 1.0;
        Phi { exp: z * first + 1.0, first: first * h, second: second * (h * h) }
    }
}

/// Reciprocals 1/n.
const RECIPROCALS: [f64; 20] = {
    let mut table = [1.0; 20];
    let mut n = 1;
    while n < 20 {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// Returns e^z.
#[inline]
pub fn exponential(z: Phasor) -> Phasor {
    let size = if z.re == 0.0 { 1.0 } else { libm::exp(z.re) };
    if z.im == 0.0 {
        return Phasor { re: size, im: 0.0 };
    }
    let (sin, cos) = libm::sincos(z.im);
    Phasor { re: size * cos, im: size * sin }
}
